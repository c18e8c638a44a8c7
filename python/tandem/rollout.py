"""Many runs on all cores: parameter sets times seeds."""

import collections.abc
import dataclasses
import inspect
import multiprocessing
import multiprocessing.connection
import operator
import os
import signal
import traceback
import typing

import numpy as np

from . import _tandem
from .experiment import assignments, source
from .world import World, cores


@dataclasses.dataclass
class Rollout:
    """One run. failure is None where it went well."""

    set: int
    seed: int
    parameters: typing.Any
    value: typing.Any = None
    measures: dict = dataclasses.field(default_factory=dict)
    ticks: int = 0
    fingerprint: int = 0
    state: str = "failed"
    failure: typing.Optional[str] = None


class Rollouts(collections.abc.Sequence):
    """The runs, set by set, and each with all seeds in their order, however many workers made them."""

    def __init__(self, runs, sets, seeds):
        self.runs, self.sets, self.seeds = runs, sets, seeds

    def __len__(self):
        return len(self.runs)

    def __getitem__(self, index):
        return self.runs[index]

    def __repr__(self):
        return f"<tandem.Rollouts of {self.sets} sets x {self.seeds} seeds, {len(self.failed)} failed>"

    @property
    def failed(self):
        """Runs that went wrong; their failure says why."""
        return [one for one in self.runs if one.failure is not None]

    def array(self, measure=None):
        """(sets, seeds): a measure of every run, or its value; NaN for those that failed."""
        made = np.full((self.sets, self.seeds), np.nan)
        for number, one in enumerate(self.runs):
            if one.failure is None:
                if measure is not None and measure not in one.measures:
                    there = ", ".join(map(repr, one.measures)) or "none"
                    raise KeyError(f"a run has no measure {measure!r}; it has: {there}")
                made[number // self.seeds, number % self.seeds] = one.value if measure is None else one.measures[measure]
        return made


class _Maker:
    """Makes runs in one process; a world is used again as long as a reset is enough."""

    def __init__(self, experiment, sets, seeds, until, measure, setup, options):
        self.experiment, self.sets, self.seeds = experiment, sets, seeds
        self.until, self.measure, self.setup, self.options = until, measure, setup, options
        self.world = self.built = self.last = None

    def ready(self, number, seed):
        own = [] if self.setup is not None else assignments(self.sets[number])
        built = [one for one in own if not _tandem.changes_at_reset(one)]
        if self.world is None or built != self.built:
            self.close()
            options = dict(self.options)
            options["parameters"] = assignments(options.get("parameters")) + built
            self.world, self.built, self.last = World(self.experiment, seed=seed, **options), built, []
            if built == own:
                return
        changed = [one for one in own if one not in built]
        self.world.reset(seed, changed if changed != self.last else None)
        self.last = changed

    def close(self):
        if self.world is not None:
            self.world.close()
        self.world = None

    def run(self, index):
        number, seed = index // len(self.seeds), self.seeds[index % len(self.seeds)]
        made = Rollout(number, seed, self.sets[number])
        try:
            self.ready(number, seed)
            world = self.world
            if self.setup is not None:
                self.setup(world, self.sets[number])
            world.run(self.until, progress=False)
            if self.until is not None:
                world.finish()
            made.ticks, made.state, made.fingerprint = world.tick, world.state, world.fingerprint
            made.measures = world.measures
            if self.measure is not None:
                made.value = self.measure(world)
            incidents = world.incidents
            if incidents["controllers_thrown"]:
                made.failure = incidents["first"][0] if incidents["first"] else "a controller threw"
        except KeyboardInterrupt:
            raise
        except (_tandem.ExperimentError, _tandem.RunFailed) as error:
            made.failure = str(error)
        except SystemExit as end:
            made.failure = f"it ended the program: exit({end.code!r})"
        except Exception:
            made.failure = traceback.format_exc()
        if made.failure is not None:
            made.state = "failed"
            self.close()
        return made


def _work(maker, tasks):
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent is asked, and ends its workers
    while True:
        try:
            index = tasks.recv()
        except EOFError:
            return
        if index is None:
            return
        made = maker.run(index)
        made.parameters = None  # the parent has them
        try:
            tasks.send((index, made))
        except Exception as error:  # what measure gave cannot be sent
            tasks.send((index, Rollout(made.set, made.seed, None, failure=f"the value of measure cannot be sent: {error}")))


class _Worker:
    def __init__(self, context, maker):
        self.tasks, theirs = context.Pipe()
        self.process = context.Process(target=_work, args=(maker, theirs), daemon=True)
        self.process.start()
        theirs.close()
        self.given = collections.deque()

    def give(self, index):
        self.given.append(index)
        try:
            self.tasks.send(index)
        except OSError:
            pass  # it is gone, and will be noticed

    def end(self):
        self.tasks.close()
        self.process.kill()
        self.process.join()


def rollouts(experiment, parameter_sets=({},), seeds=(1,), *, until=None, measure=None, setup=None, workers=None, **world):
    """Runs an experiment with every parameter set and every seed, on all cores, and gives the runs in that order.

    parameter_sets  dictionaries {path: value}; with setup, whatever that takes (a vector of weights, say)
    until           time in s at which a run ends; None: as the experiment says
    measure         function(world), asked at the end; what it gives is the run's value
    setup           function(world, parameters), called before every run
    workers         processes; None: one a core; 0: this process alone
    world           further arguments of tandem.World

    Workers are forked, so functions and classes need no names. The same arguments give the same runs for any number of
    workers. A run that fails is a Rollout with its failure; a worker that dies costs the run that it was making.
    """
    if isinstance(parameter_sets, (dict, str)):
        raise TypeError("parameter_sets are several, one behind the other: write [{…}]")
    sets, seeds = list(parameter_sets), [operator.index(one) for one in seeds]
    total = len(sets) * len(seeds)
    if "seed" in world:
        raise TypeError("seeds=… says the seeds of rollouts")
    inspect.signature(World.__init__).bind(None, experiment, **world)  # what no run could be made with is said at once
    source(experiment)
    if setup is None:
        for one in sets:
            assignments(one)
    world.setdefault("threads", 0)
    maker = _Maker(experiment, sets, seeds, until, measure, setup, world)
    runs = [None] * total
    progress = _tandem.Progress(total, 1, "rollouts", "runs") if total else None
    workers = min(cores() if workers is None else int(workers), total)
    if workers <= 0:
        for index in range(total):
            progress.step(index)
            runs[index] = maker.run(index)
        maker.close()
        return Rollouts(runs, len(sets), len(seeds))

    context = multiprocessing.get_context("fork")
    team = []
    waiting = collections.deque(range(total))
    left = total

    def feed(worker):
        ahead = 2 if len(waiting) > 2 * workers else 1
        while waiting and len(worker.given) < ahead:
            worker.give(waiting.popleft())

    try:
        for _ in range(workers):
            team.append(_Worker(context, maker))
            feed(team[-1])
        while left:
            progress.step(total - left)
            ready = multiprocessing.connection.wait([one.tasks for one in team if one.given])
            for worker in [one for one in team if one.tasks in ready]:
                try:
                    index, made = worker.tasks.recv()
                except (EOFError, OSError):
                    worker.process.join()
                    code = worker.process.exitcode
                    why = f"signal {-code}" if code is not None and code < 0 else f"exit code {code}"
                    index = worker.given.popleft()
                    number = index // len(seeds)
                    made = Rollout(number, seeds[index % len(seeds)], None, failure=f"the process that made it ended: {why}")
                    waiting.extendleft(reversed(worker.given))
                    worker.end()
                    team[team.index(worker)] = worker = _Worker(context, maker)
                else:
                    worker.given.popleft()
                made.parameters = sets[made.set]
                runs[index] = made
                left -= 1
                feed(worker)
            if waiting:
                for worker in team:
                    feed(worker)
    finally:
        for worker in team:
            worker.end()
    return Rollouts(runs, len(sets), len(seeds))
