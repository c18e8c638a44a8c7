#!/usr/bin/python3
"""Gathers a swarm with many seeds and tells how it ends: clusters, mean distance from the centroid.

    swarm.py PROJECT --tandem PROGRAM [--seeds 30] [--experiment swarm_lua]
    swarm.py PROJECT --argos3 PROGRAM …             the same by ARGoS 3 itself

80 foot-bots, 60 s, range and bearing alone (experiments/swarm.argos in C++, swarm_lua.argos in Lua). Exit code 1 when a swarm ends in
more than one cluster (links of 0.85 m), or with a mean distance that is not within --least and --most.
"""
import argparse
import concurrent.futures
import math
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

AT = re.compile(r"RESULT \S+\.at (\S+) (\S+)")
LINK_M = 0.85


def clusters(places):
    """How many parts there are of robots that are nearer to one another than a link."""
    left, parts = set(range(len(places))), 0
    while left:
        open_ones, parts = [left.pop()], parts + 1
        while open_ones:
            at = places[open_ones.pop()]
            near = {i for i in left if math.dist(at, places[i]) < LINK_M}
            left -= near
            open_ones += near
    return parts


def gather(project, program, by_argos, experiment, seed, folder):
    """Clusters and mean distance in m of one run."""
    text = (project / f"experiments/{experiment}.argos").read_text()
    file, log = folder / f"{seed}.argos", folder / f"{seed}.log"
    file.write_text(re.sub(r'random_seed="\d+"', f'random_seed="{seed}"', text))
    words = [program, "-n", "-z", "-c", str(file)] if by_argos else [program, "run", str(file), "--quiet", "--log", str(log)]
    done = subprocess.run(words, cwd=project, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"seed {seed}: exit code {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    output = done.stdout if by_argos else log.read_text()
    places = [(float(x), float(y)) for x, y in AT.findall(output)]
    if not places:
        sys.exit(f"seed {seed}: no robot says where it is")
    centroid = [statistics.fmean(p[i] for p in places) for i in (0, 1)]
    return clusters(places), statistics.fmean(math.dist(p, centroid) for p in places), len(places)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("project", type=pathlib.Path)
    parser.add_argument("--tandem")
    parser.add_argument("--argos3")
    parser.add_argument("--experiment", default="swarm_lua")
    parser.add_argument("--seeds", type=int, default=30)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--least", type=float, default=0.9)
    parser.add_argument("--most", type=float, default=1.4)
    given = parser.parse_args()
    program = given.tandem or given.argos3
    if not program:
        parser.error("one of --tandem and --argos3 is needed")
    program = str(pathlib.Path(program).resolve())
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        runs = [pool.submit(gather, given.project.resolve(), program, bool(given.argos3), given.experiment, seed,
                            pathlib.Path(folder)) for seed in range(1, given.seeds + 1)]
        ends = [r.result() for r in runs]
    split = sum(parts > 1 for parts, _, _ in ends)
    radii = sorted(radius for _, radius, _ in ends)
    for seed, (parts, radius, robots) in enumerate(ends, 1):
        print(f"seed {seed:3}  {robots} robots  {parts} cluster{'s' if parts > 1 else ' '}  {radius:.3f} m")
    print(f"{len(ends)} seeds: {split} split; mean distance {radii[0]:.2f} to {radii[-1]:.2f} m, mean {statistics.fmean(radii):.3f}")
    sys.exit(1 if split or radii[0] < given.least or radii[-1] > given.most else 0)


if __name__ == "__main__":
    main()
