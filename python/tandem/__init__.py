"""Tandem in Python: worlds of robot swarms, stepped and looked into as arrays.

    import tandem

    world = tandem.World("configs/epuck_diffusion.xml", seed=1)
    world.run(until=10)
    print(world.poses)
    world.picture()

docs/python.md of Tandem's sources tells the rest.
"""

import os
import sys

# Plug-ins find what they call in the module: its symbols are everybody's.
_flags = sys.getdlopenflags()
sys.setdlopenflags(os.RTLD_GLOBAL | os.RTLD_NOW)
try:
    from . import _tandem
finally:
    sys.setdlopenflags(_flags)

from ._tandem import ExperimentError, Picture, Port, PortArrays, Random, Robot, RunFailed, Snapshot, Swarm
from .calls import speak_plainly
from .experiment import to_xml
from .world import Group, World
from .record import Record
from .policy import Layer, Policy, Signal, load_policy, save_policy
from .rollout import Rollout, Rollouts, rollouts

__version__ = _tandem.version
speak_plainly(_tandem.World, _tandem.Group, Picture, Random, Robot, Swarm)

__all__ = [
    "ExperimentError", "Group", "Layer", "Picture", "Policy", "Port", "PortArrays", "Random", "Record", "Robot", "Rollout",
    "Rollouts", "RunFailed", "Signal", "Snapshot", "Swarm", "World", "load_policy", "ports", "rollouts", "save_policy",
    "to_xml",
]


def ports():
    """Every port of robots, as its schema describes it: name, role, doc, and fields with type, count and unit."""
    return _tandem.ports()
