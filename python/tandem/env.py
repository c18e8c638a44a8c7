"""Environments of the field's conventions: Gymnasium's vector environments and PettingZoo's parallel ones.

Neither package is needed; where one is installed, its base class is used, and the spaces are Gymnasium's.
"""

import operator

import numpy as np

from .policy import Inputs, Outputs, save_policy
from .world import Group, World

try:
    from gymnasium.spaces import Box
    from gymnasium.vector import VectorEnv as _VectorBase
except ImportError:
    _VectorBase = object

    class Box:
        """Arrays of a shape between two bounds, as Gymnasium has it."""

        def __init__(self, low, high, shape, dtype=np.float32):
            self.shape, self.dtype = tuple(shape), np.dtype(dtype)
            self.low = np.broadcast_to(np.asarray(low, self.dtype), self.shape)
            self.high = np.broadcast_to(np.asarray(high, self.dtype), self.shape)
            self._random = np.random.default_rng()

        def seed(self, seed=None):
            self._random = np.random.default_rng(seed)
            return [seed]

        def sample(self, mask=None):
            low = np.where(np.isfinite(self.low), self.low, -1.0)
            high = np.where(np.isfinite(self.high), self.high, 1.0)
            return self._random.uniform(low, high).astype(self.dtype)

        def contains(self, x):
            x = np.asarray(x)
            return x.shape == self.shape and bool(np.all((x >= self.low) & (x <= self.high)))

        __contains__ = contains

        def __eq__(self, other):
            return (isinstance(other, Box) and self.shape == other.shape and self.dtype == other.dtype
                    and np.array_equal(self.low, other.low) and np.array_equal(self.high, other.high))

        def __repr__(self):
            return f"Box({self.low.min() if self.low.size else 0}, {self.high.max() if self.high.size else 0}, {self.shape}, {self.dtype})"

try:
    from gymnasium.vector import AutoresetMode as _AutoresetMode

    _NEXT_STEP = _AutoresetMode.NEXT_STEP
except ImportError:  # not there, or before its version 1.1, where this was the only way
    _NEXT_STEP = "NextStep"
try:
    from pettingzoo import ParallelEnv as _ParallelBase
except ImportError:
    _ParallelBase = object


def _bounds(inputs):
    low, high = [], []
    for signal in inputs.signals:
        ends = sorted((signal.scale * signal.low + signal.offset, signal.scale * signal.high + signal.offset))
        low += [min(ends[0], 0.0)] * signal.count
        high += [max(ends[1], 0.0)] * signal.count
    return np.array(low, dtype=np.float32), np.array(high, dtype=np.float32)


_RENDERED = {"svg": lambda picture: picture.svg, "rgb_array": lambda picture: picture.pixels()}


def _render_mode(mode):
    if mode not in _RENDERED:
        raise ValueError(f"there is no render_mode {mode!r}; there are {', '.join(map(repr, _RENDERED))}")
    return mode


def _checked(actions, shape):
    """Actions as numbers; clear errors for what is none."""
    try:
        actions = np.asarray(actions, dtype=float)
    except (TypeError, ValueError) as error:
        raise TypeError(f"actions are numbers in an array of shape {shape}: {error}") from None
    if actions.shape != shape:
        raise ValueError(f"actions have the shape {shape}, not {actions.shape}")
    return actions


class _Arena:
    """One world of an environment."""

    def __init__(self, experiment, observe, act, controller, world):
        world.setdefault("driven", [controller] if controller else True)
        self.inputs, self.outputs = Inputs(observe), Outputs(act)
        self.world = World(experiment, **world)
        driven = [one for one in self.world.swarms if controller in (None, one.controller)]
        if len(driven) != 1:
            raise ValueError("an environment is about robots of one kind under one controller; say which: "
                             + ", ".join(repr(one.controller) for one in self.world.swarms))
        self.swarm = driven[0]
        self.robots = len(self.swarm)

    def reset(self, seed, parameters=None):
        """Begins anew; one tick in which nothing moves fills the sensors."""
        self.world.reset(seed, parameters)
        self.world.step()

    def read(self):
        """Observations (robots, values)."""
        return self.inputs.read(self.swarm)

    def act(self, actions):
        self.outputs.write(self.swarm, actions)


class VectorEnv(_VectorBase):
    """Many worlds as one Gymnasium vector environment.

    observe, act   signals (tandem.Signal, "port.field", …) that each robot reads and writes
    reward         function(world, swarm): a number
    terminated     function(world, swarm): whether the episode is over; None: never before its time
    episode        its length in s
    ticks          simulation ticks a step
    controller     id of the configuration that is driven, where there are several
    threads        for stepping the worlds side by side; None: one a core
    render_mode    what render() gives of each world: "svg", a text; "rgb_array", an array (height, width, 3)
    world          further arguments of tandem.World

    Observations have the shape (num_envs, robots, values), actions (num_envs, robots, outputs); robots are in the order
    of the file. An environment whose episode ended begins the next one in the step that follows, as Gymnasium's
    NEXT_STEP does: the action is not used then, and its reward is 0.
    """

    metadata = {"render_modes": list(_RENDERED), "autoreset_mode": _NEXT_STEP}
    spec, closed = None, False

    def __init__(self, experiment, num_envs, *, observe, act, reward, terminated=None, episode=60.0, ticks=1, controller=None,
                 threads=None, render_mode="svg", **world):
        if num_envs < 1:
            raise ValueError("a vector environment has at least one world")
        self.render_mode = _render_mode(render_mode)
        world.setdefault("threads", 0)
        self.num_envs = num_envs
        self._arenas = [_Arena(experiment, observe, act, controller, dict(world)) for _ in range(num_envs)]
        self._group = Group([one.world for one in self._arenas], threads)
        first = self._arenas[0]
        self.robots = first.robots
        self._reward, self._terminated, self._ticks = reward, terminated, int(ticks)
        self._last_tick = int(episode * first.world.ticks_per_second + 0.5)
        low, high = _bounds(first.inputs)
        shape = (self.robots, first.inputs.size)
        self.single_observation_space = Box(np.broadcast_to(low, shape), np.broadcast_to(high, shape), shape, np.float32)
        self.single_action_space = Box(-1.0, 1.0, (self.robots, first.outputs.size), np.float32)
        self.observation_space = Box(np.broadcast_to(low, (num_envs, *shape)), np.broadcast_to(high, (num_envs, *shape)),
                                     (num_envs, *shape), np.float32)
        self.action_space = Box(-1.0, 1.0, (num_envs, *self.single_action_space.shape), np.float32)
        self._done = np.zeros(num_envs, dtype=bool)
        self._episode = np.zeros(num_envs, dtype=np.int64)
        self._seeds = list(range(num_envs))

    @property
    def worlds(self):
        return [one.world for one in self._arenas]

    @property
    def unwrapped(self):
        return self

    def _begin(self, number, parameters=None):
        self._arenas[number].reset(self._seeds[number] + self.num_envs * int(self._episode[number]), parameters)
        self._episode[number] += 1

    def _observations(self):
        made = np.empty(self.observation_space.shape, dtype=np.float32)
        for number, arena in enumerate(self._arenas):
            made[number] = arena.read()
        return made

    def reset(self, *, seed=None, options=None):
        """options: {"parameters": {path: value}} for all worlds. World i begins with seed + i, or with seed[i] of a list.

        Each further episode of a world has a seed num_envs higher than its last.
        """
        if seed is not None:
            one = not hasattr(seed, "__len__")
            seeds = [operator.index(seed) + number for number in range(self.num_envs)] if one else list(seed)
            if len(seeds) != self.num_envs:
                raise ValueError(f"there are {self.num_envs} worlds, and {len(seeds)} seeds")
            for number, own in enumerate(seeds):
                if own is not None:
                    self._seeds[number], self._episode[number] = operator.index(own), 0
        for number in range(self.num_envs):
            self._begin(number, (options or {}).get("parameters"))
        self._done[:] = False
        return self._observations(), {}

    def step(self, actions):
        actions = _checked(actions, self.action_space.shape)
        rewards = np.zeros(self.num_envs)
        terminated = np.zeros(self.num_envs, dtype=bool)
        truncated = np.zeros(self.num_envs, dtype=bool)
        fresh = self._done.copy()
        for number, arena in enumerate(self._arenas):
            if not fresh[number]:
                arena.act(actions[number])
        if fresh.any():
            for number in np.flatnonzero(~fresh):
                self._arenas[number].world.step(self._ticks)
            for number in np.flatnonzero(fresh):
                self._begin(int(number))
        else:
            self._group.step(self._ticks)
        for number, arena in enumerate(self._arenas):
            if fresh[number]:
                continue
            world = arena.world
            rewards[number] = self._reward(world, arena.swarm)
            over = self._terminated is not None and bool(self._terminated(world, arena.swarm))
            terminated[number] = over or world.state != "running"
            truncated[number] = not terminated[number] and world.tick >= self._last_tick
        self._done = terminated | truncated
        return self._observations(), rewards, terminated, truncated, {}

    def render(self):
        return tuple(_RENDERED[self.render_mode](one.world.picture()) for one in self._arenas)

    def close(self, **_):
        for one in self.__dict__.get("_arenas", ()):
            one.world.close()
        self.closed = True

    def save_policy(self, path, layers):
        """The network for the controller `neural`: what it reads and writes is this environment's."""
        save_policy(path, self._arenas[0].inputs.signals, self._arenas[0].outputs.signals, layers)


class ParallelEnv(_ParallelBase):
    """One world as a PettingZoo parallel environment: each robot is an agent, by its id.

    reward      function(world, swarm): a number for all, or an array in the order of possible_agents
    All else as VectorEnv has it.
    """

    metadata = {"render_modes": list(_RENDERED), "name": "tandem"}

    def __init__(self, experiment, *, observe, act, reward, terminated=None, episode=60.0, ticks=1, controller=None,
                 render_mode="svg", **world):
        self.render_mode = _render_mode(render_mode)
        self._arena = _Arena(experiment, observe, act, controller, dict(world))
        self._reward, self._terminated, self._ticks = reward, terminated, int(ticks)
        self._last_tick = int(episode * self._arena.world.ticks_per_second + 0.5)
        self.possible_agents = self._arena.swarm.ids
        self.agents = []
        low, high = _bounds(self._arena.inputs)
        self._space = Box(low, high, low.shape, np.float32)
        self._actions = Box(-1.0, 1.0, (self._arena.outputs.size,), np.float32)
        self.observation_spaces = {one: self._space for one in self.possible_agents}
        self.action_spaces = {one: self._actions for one in self.possible_agents}
        self._seed = 0

    @property
    def world(self):
        return self._arena.world

    @property
    def unwrapped(self):
        return self

    @property
    def num_agents(self):
        return len(self.agents)

    @property
    def max_num_agents(self):
        return len(self.possible_agents)

    def observation_space(self, agent):
        return self.observation_spaces[agent]

    def action_space(self, agent):
        return self.action_spaces[agent]

    def reset(self, seed=None, options=None):
        self._seed = self._seed + 1 if seed is None else int(seed)
        self._arena.reset(self._seed, (options or {}).get("parameters"))
        self.agents = list(self.possible_agents)
        return self._observations(), {one: {} for one in self.agents}

    def _observations(self):
        return dict(zip(self.possible_agents, self._arena.read().astype(np.float32)))

    def state(self):
        """All observations as one array."""
        return self._arena.read().astype(np.float32)

    def step(self, actions):
        if not self.agents:
            raise RuntimeError("no episode is going on; reset() begins the next")
        missing = [one for one in self.agents if one not in actions]
        if missing:
            raise KeyError(f"no action for {', '.join(missing[:5])}")
        self._arena.act(_checked([actions[one] for one in self.possible_agents],
                                 (len(self.possible_agents), self._arena.outputs.size)))
        world, swarm = self._arena.world, self._arena.swarm
        world.step(self._ticks)
        rewards = np.broadcast_to(np.asarray(self._reward(world, swarm), dtype=float), (len(self.possible_agents),))
        over = world.state != "running" or (self._terminated is not None and bool(self._terminated(world, swarm)))
        late = not over and world.tick >= self._last_tick
        agents, observations = self.agents, self._observations()
        if over or late:
            self.agents = []
        return (observations, dict(zip(agents, rewards.tolist())), {one: over for one in agents},
                {one: late for one in agents}, {one: {} for one in agents})

    def render(self):
        return _RENDERED[self.render_mode](self._arena.world.picture())

    def close(self):
        self._arena.world.close()

    def save_policy(self, path, layers):
        save_policy(path, self._arena.inputs.signals, self._arena.outputs.signals, layers)
