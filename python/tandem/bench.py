"""How fast Python drives worlds: `./tandem bench python`, or `./tandem python -m tandem.bench [arrays|runs]`, a JSON object a line."""

import argparse
import json
import os
import statistics
import sys
import time

import numpy as np

from . import World, rollouts
from .world import cores


def _experiments():
    here = os.path.dirname(os.path.abspath(__file__))
    for folder in (os.getcwd(), *(os.path.join(here, *[".."] * n) for n in range(1, 6)),
                   os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..")):
        if os.path.exists(os.path.join(folder, "configs", "epuck_benchmark.xml")):
            return os.path.join(folder, "configs")
    sys.exit("tandem.bench: run it in Tandem's checkout: it needs configs/")


_CHUNK = 10  # ticks that are timed at once


def arrays(configs, robots, ticks):
    """Processor time of an array step above the tick: commands written, readings read, one call of step; and with a policy."""
    world = World(os.path.join(configs, "epuck_benchmark.xml"), seed=1, threads=0, driven=True,
                  parameters={"arena.distribute.entity.quantity": robots})
    swarm = world.swarm
    wheels, proximity = swarm.actuator("differential_steering"), swarm.sensor("proximity")
    left, right = wheels.left, wheels.right
    wanted_left, wanted_right = np.full(robots, 0.05), np.full(robots, 0.04)
    read = np.empty((robots, 8), dtype=np.float32)
    left[:], right[:] = wanted_left, wanted_right

    def tick_alone():
        world.step(_CHUNK)

    def array_step():
        for _ in range(_CHUNK):
            left[:] = wanted_left
            right[:] = wanted_right
            world.step()
            proximity.distance

    def copying_step():
        for _ in range(_CHUNK):
            left[:] = wanted_left
            right[:] = wanted_right
            world.step()
            read[:] = proximity.distance

    kinds = {"tick": tick_alone, "array_step": array_step, "array_step_copied": copying_step}
    world.step(_CHUNK)
    start, prints = world.snapshot(), set()
    for body in kinds.values():  # all do the same to the world
        world.restore(start)
        body()
        prints.add(world.fingerprint)
    took = {name: [] for name in kinds}
    for _ in range(max(1, ticks // _CHUNK)):  # in turns, so that what else the machine does meets all
        for name, body in kinds.items():
            began = time.thread_time()
            body()
            took[name].append((time.thread_time() - began) / _CHUNK / robots * 1e9)
    above = {name: statistics.median(one - tick for one, tick in zip(took[name], took["tick"])) for name in kinds}
    return {"bench": "python arrays", "robots": robots, "ticks": ticks,
            "tick_ns_robot": round(statistics.median(took["tick"]), 2),
            "array_step_above_ns_robot": round(above["array_step"], 2),
            "with_readings_copied_above_ns_robot": round(above["array_step_copied"], 2),
            "same_fingerprints": len(prints) == 1}


def runs(configs, count, workers):
    """Runs of 10 s of 30 foot-bots in dynamics2d, a second."""
    began = time.perf_counter()
    cpu, before = time.process_time(), os.times()  # the launcher's children count as this process' own
    made = rollouts(os.path.join(configs, "footbot_diffusion.xml"), seeds=range(1, count + 1), until=10, workers=workers)
    took = time.perf_counter() - began
    after = os.times()
    children = after.children_user - before.children_user + after.children_system - before.children_system
    return {"bench": "python runs", "runs": count, "workers": cores() if workers is None else workers, "failed": len(made.failed),
            "runs_per_s": round(count / took, 1), "cpu_ms_per_run": round(1e3 * children / count, 3),
            "parent_cpu_ms_per_run": round(1e3 * (time.process_time() - cpu) / count, 3),
            "fingerprint": f"{sum(one.fingerprint for one in made) % 2**64:#018x}"}


def main():
    parser = argparse.ArgumentParser(prog="python -m tandem.bench", description=__doc__)
    parser.add_argument("what", nargs="?", choices=["arrays", "runs", "all"], default="all")
    parser.add_argument("--robots", type=int, nargs="+", default=[10000])
    parser.add_argument("--ticks", type=int, default=400)
    parser.add_argument("--runs", type=int, default=600)
    parser.add_argument("--workers", type=int)
    options = parser.parse_args()
    configs = _experiments()
    if options.what in ("arrays", "all"):
        for robots in options.robots:
            print(json.dumps(arrays(configs, robots, options.ticks)), flush=True)
    if options.what in ("runs", "all"):
        print(json.dumps(runs(configs, options.runs, options.workers)), flush=True)


if __name__ == "__main__":
    main()
