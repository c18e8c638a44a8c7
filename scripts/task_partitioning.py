#!/usr/bin/env python3
"""Draws the case study of docs/task-partitioning.md: throughput with and without the noise of the treels, and where a
foot-bot is that believes to have come home. Needs Python 3 and gnuplot.

    scripts/task_partitioning.py                        30 seeds of each; writes into results/task_partitioning
    scripts/task_partitioning.py --seeds 6 --carry 10   fewer; every robot goes all the way
"""
import argparse
import csv
import math
import pathlib
import statistics
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

TOP = pathlib.Path(__file__).resolve().parent.parent
Z = 1.959964  # of the normal distribution, for 95 %
COLOURS = {"ideal": "#0072B2", "noise": "#D55E00"}  # told apart with any colour vision [Okabe and Ito 2008]


def tandem(program, config, *arguments):
    """Runs an experiment; its messages are shown when it fails."""
    run = subprocess.run([program, "run", str(TOP / "configs" / config), "--quiet", *arguments],
                         capture_output=True, text=True, check=False)
    if run.returncode != 0:
        sys.exit(f"{config} failed:\n{run.stdout}{run.stderr}")


def rows(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(file))


def throughput(options, folder, kind, seed):
    """The samples of one run, as [(minutes, objects)]."""
    path = folder / f"throughput_{kind}_{seed}.csv"
    tandem(options.program, f"footbot_task_partitioning_{kind}.xml", "--seed", str(seed),
           "--seconds", str(options.seconds), "--set", f"loop_functions.output={path}",
           "--set", f"controllers.footbot_task_partitioning[carry].params.carry={options.carry}")
    return [(float(r["time_s"]) / 60.0, int(r["throughput"])) for r in rows(path)]


def mean_and_band(values):
    """Mean with its 95 % confidence interval by Student's t (quantile: Abramowitz and Stegun 26.7.5)."""
    mean = statistics.fmean(values)
    v = len(values) - 1
    t = Z + (Z**3 + Z) / (4 * v) + (5 * Z**5 + 16 * Z**3 + 3 * Z) / (96 * v**2)
    half = t * statistics.stdev(values) / math.sqrt(len(values))
    return mean, mean - half, mean + half


def signed_rank(differences):
    """Hodges and Lehmann's estimate of the shift with the 95 % confidence interval of Wilcoxon's signed-rank test, by
    its normal approximation."""
    n = len(differences)
    walsh = sorted((a + b) / 2.0 for i, a in enumerate(differences) for b in differences[i:])
    cut = n * (n + 1) / 4.0 - Z * math.sqrt(n * (n + 1) * (2 * n + 1) / 24.0)
    low = max(0, math.floor(cut))
    return statistics.median(walsh), walsh[low], walsh[-1 - low]


def write_table(path, header, table):
    with open(path, "w", encoding="utf-8") as file:
        file.write(",".join(header) + "\n")
        for row in table:
            file.write(",".join(f"{value:.6g}" for value in row) + "\n")


def gnuplot(folder, name, script):
    text = (f"set terminal svg size 900,620 font 'sans-serif,16' background '#ffffff'\nset output '{name}.svg'\n"
            "set datafile separator ','\nset grid lc rgb '#dddddd'\n" + script + "unset output\n")
    (folder / f"{name}.gp").write_text(text, encoding="utf-8")
    done = subprocess.run(["gnuplot", "-d", f"{name}.gp"], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"gnuplot failed: {done.stderr}")


def draw_throughput(options, folder, kinds):
    jobs = [(kind, seed) for kind in kinds for seed in range(1, options.seeds + 1)]
    with ThreadPoolExecutor(options.jobs) as pool:
        samples = dict(zip(jobs, pool.map(lambda job: throughput(options, folder, *job), jobs)))
    times = [time for time, _ in samples[jobs[0]]]
    of = {kind: [[samples[kind, seed][i][1] for seed in range(1, options.seeds + 1)] for i in range(len(times))]
          for kind in kinds}
    for kind in kinds:
        write_table(folder / f"{kind}.csv", ["minutes", "mean", "low", "high"],
                    [(t, *mean_and_band(values)) for t, values in zip(times, of[kind])])
    shifts = [signed_rank([a - b for a, b in zip(ideal, noise)]) for ideal, noise in zip(of["ideal"], of["noise"])]
    write_table(folder / "difference.csv", ["minutes", "shift", "low", "high"],
                [(t, *shift) for t, shift in zip(times, shifts)])
    plots = []
    for kind in kinds:
        look = f"lc rgb '{COLOURS[kind]}'"
        plots.append(f"'{kind}.csv' skip 1 using 1:3:4 with filledcurves {look} fs transparent solid 0.25 notitle")
        plots.append(f"'{kind}.csv' skip 1 using 1:2 with lines {look} lw 2 title '{kind} treels'")
    gnuplot(folder, "throughput",
            "set multiplot layout 2,1\nset key bottom right\nset yrange [0:*]\n"
            f"set title 'Six foot-bots, carries of {options.carry:g} m, {options.seeds} seeds; bands: 95 % confidence'\n"
            "set ylabel 'objects in 15 min'\nplot " + ", ".join(plots) + "\n"
            "unset title\nset yrange [*:*]\nset xlabel 'time (min)'\nset ylabel 'ideal − slanted'\n"
            "plot 'difference.csv' skip 1 using 1:3:4 with filledcurves lc rgb '#777777' fs transparent solid 0.25 "
            "notitle, '' skip 1 using 1:2 with lines lc rgb '#000000' lw 2 title 'shift, Wilcoxon signed-rank', "
            "0 lc rgb '#000000' dt 2 notitle\nunset multiplot\n")
    means = {kind: statistics.fmean(of[kind][-1]) for kind in kinds}
    shift, low, high = shifts[-1]
    print(f"objects in the last 15 of {times[-1]:g} minutes, mean of {options.seeds} seeds: "
          f"ideal {means['ideal']:.1f}, slanted {means['noise']:.1f}; difference {shift:.1f} (95 %: {low:.1f} to {high:.1f})")


def draw_shuttle(options, folder):
    plots, misses = [], []
    seeds = range(1, min(options.seeds, 10) + 1)
    for seed in seeds:
        path = folder / f"shuttle_{seed}.csv"
        tandem(options.program, "footbot_shuttle.xml", "--seed", str(seed), "--set", f"loop_functions.output={path}")
        end = rows(path)[-1]
        misses.append(math.dist((float(end["x_m"]), float(end["y_m"])),
                                (float(end["odometry_x_m"]), float(end["odometry_y_m"]))))
        title = "where it is, a line a seed" if seed == 1 else ""
        plots.append(f"'shuttle_{seed}.csv' skip 1 using 3:4 with lines lc rgb '{COLOURS['noise']}' lw 1 title '{title}'")
    path = folder / "shuttle_ideal.csv"
    tandem(options.program, "footbot_shuttle.xml", "--set", f"loop_functions.output={path}", "--set",
           "controllers.footbot_shuttle[shuttle].actuators.differential_steering.implementation=ideal")
    plots.append(f"'shuttle_ideal.csv' skip 1 using 3:4 with lines lc rgb '{COLOURS['ideal']}' lw 5 "
                 "title 'where it is with ideal treels'")
    plots.append("'shuttle_1.csv' skip 1 using 6:7 with lines lc rgb '#000000' dt 2 lw 2 title 'where it thinks that it is'")
    gnuplot(folder, "shuttle", "set size ratio -1\nset key outside bottom center\nset xlabel 'x (m)'\nset ylabel 'y (m)'\n"
            "set title 'A foot-bot that goes 4 m there and 4 m back by odometry'\nplot " + ", ".join(plots) + "\n")
    print(f"error after 4 m there and 4 m back, mean of {len(misses)} seeds: {statistics.fmean(misses):.2f} m")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=30, help="runs of each kind, at least 2")
    parser.add_argument("--seconds", type=float, default=3600.0, help="length of a run, at least 120")
    parser.add_argument("--carry", type=float, default=2.0, help="metres that one robot carries an object at a time")
    parser.add_argument("--jobs", type=int, default=2, help="runs side by side")
    parser.add_argument("--program", default=str(TOP / "tandem"), help="the tandem command")
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("results/task_partitioning"),
                        help="folder for tables and figures")
    options = parser.parse_args()
    if options.seeds < 2 or options.seconds < 120.0:
        parser.error("two seeds and 120 seconds are the least that there is something to draw of")
    folder = options.output.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    draw_throughput(options, folder, ("ideal", "noise"))
    draw_shuttle(options, folder)
    print(f"figures: {folder / 'throughput.svg'}, {folder / 'shuttle.svg'}")


if __name__ == "__main__":
    main()
