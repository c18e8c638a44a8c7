"""Worlds: made from a file, a text or a dictionary, stepped, looked into, put back."""

import operator
import os
import subprocess
import tempfile

from . import _tandem
from .calls import hinted
from .experiment import assignments, source

_HOOK_METHODS = ("before_run", "before_step", "after_step", "is_done", "after_run", "floor")


class World(_tandem.World):
    """A simulated world.

    experiment   a path, XML text, or a dictionary (see to_xml)
    seed         overrides the experiment's
    threads      overrides the experiment's; 0 is the caller alone
    parameters   {path: value} on top of the experiment, as `tandem run --set path=value` has them
    controllers  {id: class}: configurations whose robots are driven by a class of Python, called robot by robot
    policies     {id: function}: configurations that are driven by function(swarm), called once a step with all robots
    driven       ids of configurations whose commands are written from outside, between steps; True: all
    hooks        objects, or classes, with any of before_run(world), before_step(world), after_step(world),
                 is_done(world), after_run(world), reset(seed), floor(x, y), save(), restore(saved)
    plugins      libraries to be opened besides those that the experiment names
    record       a path: a record of the run, until finish, reset or close

    A world is used by one thread at a time. It steps without Python's lock, so other threads go on.
    """

    @hinted
    def __init__(self, experiment, *, seed=None, threads=None, parameters=None, controllers=None, policies=None, driven=(),
                 hooks=(), plugins=(), record=None):
        file, text = source(experiment)
        _check_number("seed", seed)
        _check_number("threads", threads)
        for name, guest in (controllers or {}).items():
            if not isinstance(name, str) or not callable(guest):
                raise TypeError(f"controllers are classes by the id of their configuration, and {name!r}: {guest!r} is none")
        for hook in hooks:
            if not any(hasattr(hook, one) for one in _HOOK_METHODS):
                raise TypeError(f"a hook has any of {', '.join(_HOOK_METHODS)}, and {hook!r} has none")
        policies = dict(policies or {})
        if driven is True:
            driven = ["*"]
        elif isinstance(driven, str):
            driven = [driven]
        elif driven is False:
            driven = []
        driven = list(driven) + [one for one in policies if one not in driven and "*" not in driven]
        self._file, self._text = file, text
        super().__init__(file, text, seed, threads, assignments(parameters), dict(controllers or {}), driven, list(hooks),
                         [str(one) for one in plugins], _path(record))
        for controller, policy in policies.items():
            self.add_policy(controller, policy)
        self._start()

    def reset(self, seed=None, parameters=None, record=None):
        """Begins the run anew, as a new world of this seed would, without building one.

        parameters: on top of those that the world was made with; None leaves them as they are. Those of controllers
        (…params.…), those of hooks (loop_functions.…) and the length can change. Arrays stay the same memory, but their
        rows may be other robots (swarm.ids). record: a path, for a record of the new run.
        """
        _check_number("seed", seed)
        self._reset(seed, None if parameters is None else assignments(parameters), _path(record))

    @property
    def swarm(self):
        """The robots, where all are of one kind and under one controller; else see swarms."""
        all_of_them = self.swarms
        if len(all_of_them) != 1:
            kinds = ", ".join(repr(one) for one in all_of_them) or "no robots"
            raise ValueError(f"this world has no single swarm, but {kinds}; choose of world.swarms")
        return all_of_them[0]

    def view(self, *options, **popen):
        """Opens the window: `tandem view` on this world's experiment and seed, from the beginning, in a process of its own.

        options are those of the command, popen those of subprocess.Popen. What Python does to a world cannot be shown that
        way; use picture(). Returns the process.
        """
        if self.has_guests:
            raise RuntimeError("Python takes part in this world, and the window is a process of its own: use picture()")
        program, experiment = program_path(), self._file
        if self._text:
            with tempfile.NamedTemporaryFile("w", suffix=".xml", prefix=f"{self.name}-", delete=False) as file:
                file.write(self._text)
            experiment = file.name
        changes = [word for one in self.parameters for word in ("--set", one)]
        return subprocess.Popen([program, "view", experiment, "--seed", str(self.seed), *changes, *options], **popen)

    def _repr_svg_(self):
        return None if self.closed else self.picture().svg

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def _path(path):
    return "" if path is None else os.fspath(path)


def _check_number(what, number):
    if number is not None and not 0 <= operator.index(number) < 2**64:
        raise ValueError(f"{what} is 0 or more and below 2**64, not {number}")


class Group(_tandem.Group):
    """Worlds that are stepped side by side on threads of their own, without Python's lock."""

    def __init__(self, worlds, threads=None):
        worlds = list(worlds)
        for one in worlds:
            if not isinstance(one, _tandem.World):
                raise TypeError(f"a group is of worlds, and {one!r} is none")
        super().__init__(worlds, cores() if threads is None else threads)


def cores():
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0))


def program_path():
    """The program `tandem`: TANDEM_PROGRAM, else that of this build, else the one on the path."""
    import shutil

    here = os.path.dirname(os.path.abspath(__file__))
    built = os.path.join(os.path.dirname(os.path.dirname(here)), "bin", "tandem")
    for candidate in (os.environ.get("TANDEM_PROGRAM"), built, shutil.which("tandem")):
        if candidate and os.access(candidate, os.X_OK):
            return candidate
    raise FileNotFoundError("the program tandem is not here; name it in TANDEM_PROGRAM")
