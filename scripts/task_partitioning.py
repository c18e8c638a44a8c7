#!/usr/bin/env python3
"""Draws the case study of docs/task-partitioning.md: throughput with and without the noise of the treels, what it
depends on, and where a foot-bot is that believes to have come home. Needs Python 3 and gnuplot.

    scripts/task_partitioning.py                         30 seeds of each; writes into reports/task_partitioning
    scripts/task_partitioning.py --seeds 6 --carries ""  fewer, and only carries of 2 m
"""
import argparse
import csv
import math
import pathlib
import shutil
import statistics
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

TOP = pathlib.Path(__file__).resolve().parent.parent
Z = 1.959964  # of the normal distribution, for 95 %
KINDS = ("ideal", "noise")
POSITIONS = 61  # as many as the article's noise model was derived from
TREELS = {"ideal": "ideal treels", "noise": "slanted treels"}
LINES = 8  # of the shuttle's ways that are drawn
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


def throughput(options, folder, kind, carry, seed):
    """The samples of one run, as [(minutes, objects)]."""
    path = folder / f"throughput_{kind}_{carry:g}_{seed}.csv"
    tandem(options.program, f"footbot_task_partitioning_{kind}.xml", "--seed", str(seed),
           "--seconds", str(options.seconds), "--set", f"loop_functions.output={path}",
           "--set", f"controllers.footbot_task_partitioning[carry].params.carry={carry}")
    return [(float(r["time_s"]) / 60.0, int(r["throughput"])) for r in rows(path)]


def all_throughputs(options, folder):
    """The samples of all runs, by (kind, carry, seed)."""
    jobs = [(kind, carry, seed) for seed in range(1, options.seeds + 1)
            for carry in sorted({options.carry, *options.carries}) for kind in KINDS]
    with ThreadPoolExecutor(options.jobs) as pool:
        return dict(zip(jobs, pool.map(lambda job: throughput(options, folder, *job), jobs)))


def student(v):
    """Quantile 0.975 of Student's t with v degrees of freedom, within 1 % [Abramowitz and Stegun, 26.7.5]."""
    if v == 1:
        return math.tan(0.475 * math.pi)
    if v == 2:
        return 0.95 * math.sqrt(2.0 / (1.0 - 0.95**2))
    return (Z + (Z**3 + Z) / (4 * v) + (5 * Z**5 + 16 * Z**3 + 3 * Z) / (96 * v**2) +
            (3 * Z**7 + 19 * Z**5 + 17 * Z**3 - 15 * Z) / (384 * v**3))


def mean_and_band(values):
    """Mean with its 95 % confidence interval."""
    mean = statistics.fmean(values)
    half = student(len(values) - 1) * statistics.stdev(values) / math.sqrt(len(values))
    return mean, mean - half, mean + half


def signed_rank(differences):
    """Hodges and Lehmann's estimate of the shift with the 95 % confidence interval of Wilcoxon's signed-rank test, by
    its normal approximation. Of fewer than six pairs it is the whole range, which is less than 95 %."""
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


def draw_throughput(options, folder, samples):
    seeds = range(1, options.seeds + 1)
    times = [time for time, _ in samples["ideal", options.carry, 1]]
    of = {kind: [[samples[kind, options.carry, seed][i][1] for seed in seeds] for i in range(len(times))]
          for kind in KINDS}
    for kind in KINDS:
        write_table(folder / f"{kind}.csv", ["minutes", "mean", "low", "high"],
                    [(t, *mean_and_band(values)) for t, values in zip(times, of[kind])])
    shifts = [signed_rank([a - b for a, b in zip(ideal, noise)]) for ideal, noise in zip(of["ideal"], of["noise"])]
    write_table(folder / "difference.csv", ["minutes", "shift", "low", "high"],
                [(t, *shift) for t, shift in zip(times, shifts)])
    plots = []
    for kind in KINDS:
        look = f"lc rgb '{COLOURS[kind]}'"
        plots.append(f"'{kind}.csv' skip 1 using 1:3:4 with filledcurves {look} fs transparent solid 0.25 notitle")
        plots.append(f"'{kind}.csv' skip 1 using 1:2 with lines {look} lw 2 title '{TREELS[kind]}'")
    gnuplot(folder, "throughput",
            "set multiplot layout 2,1\nset lmargin 8\nset key bottom right\nset yrange [0:*]\n"
            f"set title 'Six foot-bots, carries of {options.carry:g} m, {options.seeds} seeds; bands: 95 % confidence'\n"
            "set ylabel 'objects in 15 min'\nplot " + ", ".join(plots) + "\n"
            "unset title\nset key top left\nset yrange [*:*]\nset xlabel 'time (min)'\nset ylabel 'difference'\n"
            "plot 'difference.csv' skip 1 using 1:3:4 with filledcurves lc rgb '#777777' fs transparent solid 0.25 "
            "notitle, '' skip 1 using 1:2 with lines lc rgb '#000000' lw 2 title 'ideal − slanted, Wilcoxon signed-rank', "
            "0 lc rgb '#000000' dt 2 notitle\nunset multiplot\n")


def draw_carries(options, folder, samples):
    """Throughput at the end of the run against the limit of the carries; the numbers are printed as well."""
    table = []
    print(f"objects in the last 15 of {options.seconds / 60.0:g} minutes, mean of {options.seeds} seeds (95 %)")
    print("carry (m)   ideal treels          slanted treels        ideal - slanted, Wilcoxon signed-rank")
    for carry in sorted({options.carry, *options.carries}):
        of = {kind: [samples[kind, carry, seed][-1][1] for seed in range(1, options.seeds + 1)] for kind in KINDS}
        ideal, noise = mean_and_band(of["ideal"]), mean_and_band(of["noise"])
        shift = signed_rank([a - b for a, b in zip(of["ideal"], of["noise"])])
        table.append((carry, *ideal, *noise, *shift))
        print(f"{carry:<9g}" + "".join(f"   {m:5.1f} ({low:.1f} to {high:.1f})  " for m, low, high in (ideal, noise, shift)))
    write_table(folder / "carries.csv", ["carry_m", "ideal", "ideal_low", "ideal_high", "slanted", "slanted_low",
                                         "slanted_high", "shift", "shift_low", "shift_high"], table)
    if len(table) < 2:
        return
    plots = [f"'carries.csv' skip 1 using 1:{column}:{column + 1}:{column + 2} with yerrorlines lc rgb '{COLOURS[kind]}' "
             f"lw 2 pt 7 ps 0.6 title '{TREELS[kind]}'" for kind, column in (("ideal", 2), ("noise", 5))]
    gnuplot(folder, "carries",
            "set key top left\nset yrange [0:*]\nset logscale x 2\n"
            f"set xtics ({', '.join(f'{row[0]:g}' for row in table)})\nset xrange [{table[0][0] / 1.1}:{table[-1][0] * 1.1}]\n"
            f"set title 'Six foot-bots, {options.seeds} seeds; bars: 95 % confidence'\n"
            "set xlabel 'farthest that a robot carries an object (m)'\nset ylabel 'objects in 15 min, at the end'\n"
            "plot " + ", ".join(plots) + "\n")


def shuttle(options, folder, name, *arguments):
    """The places of a shuttle on its way there and back in reverse, as rows of its log."""
    path = folder / f"shuttle_{name}.csv"
    tandem(options.program, "footbot_shuttle.xml", "--set", f"loop_functions.output={path}", "--set",
           "controllers.footbot_shuttle[shuttle].params.reverse=true", *arguments)
    return rows(path)


def draw_shuttle(options, folder):
    """There and back in reverse: the ways, and how far from where it believes to be the robot ends."""
    seeds = range(1, POSITIONS + 1)
    with ThreadPoolExecutor(options.jobs) as pool:
        logs = list(pool.map(lambda seed: shuttle(options, folder, seed, "--seed", str(seed)), seeds))
    shuttle(options, folder, "ideal", "--set",
            "controllers.footbot_shuttle[shuttle].actuators.differential_steering.implementation=ideal")
    place = lambda row: (float(row["x_m"]), float(row["y_m"]))
    write_table(folder / "shuttle_ends.csv", ["x_m", "y_m"], [place(log[-1]) for log in logs])
    misses = [math.dist(place(log[-1]), (float(log[-1]["odometry_x_m"]), float(log[-1]["odometry_y_m"]))) for log in logs]
    plots = []
    for seed in range(1, LINES + 1):
        log = logs[seed - 1]
        turn = max(range(len(log)), key=lambda i: float(log[i]["odometry_x_m"]))
        write_table(folder / f"shuttle_{seed}_there.csv", ["x_m", "y_m"], [place(row) for row in log[:turn + 1]])
        write_table(folder / f"shuttle_{seed}_back.csv", ["x_m", "y_m"], [place(row) for row in log[turn:]])
        for way, look, title in (("there", f"lc rgb '{COLOURS['noise']}'", "forward"), ("back", "lc rgb '#009E73'", "in reverse")):
            plots.append(f"'shuttle_{seed}_{way}.csv' skip 1 using 1:2 with lines {look} lw 1.5 "
                         f"title '{title if seed == 1 else ''}'")
    plots.append(f"'shuttle_ends.csv' skip 1 using 1:2 with points lc rgb '#009E73' pt 7 ps 0.4 title 'ends of {POSITIONS} seeds'")
    plots.append(f"'shuttle_ideal.csv' skip 1 using 3:4 with lines lc rgb '{COLOURS['ideal']}' lw 4 "
                 "title 'ideal treels, and what odometry believes'")
    gnuplot(folder, "shuttle", "set size ratio -1\nset key outside bottom center\nset xlabel 'x (m)'\nset ylabel 'y (m)'\n"
            "set title 'A foot-bot that drives 4 m east and 4 m back in reverse, by odometry'\nplot " + ", ".join(plots) + "\n")
    print(f"error after 4 m there and 4 m back, {len(misses)} seeds: mean {statistics.fmean(misses):.2f} m, "
          f"median {statistics.median(misses):.2f} m, largest {max(misses):.2f} m")


def numbers(text):
    return [float(part) for part in text.split(",") if part.strip()]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=30, help="runs of each kind, at least 2")
    parser.add_argument("--seconds", type=float, default=3600.0, help="length of a run, at least 120")
    parser.add_argument("--carry", type=float, default=2.0,
                        help="metres that one robot carries an object at a time, in the figure over time")
    parser.add_argument("--carries", type=numbers, default=[1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 10.0],
                        help="those that are compared, e.g. 1,2,4; empty: none")
    parser.add_argument("--jobs", type=int, default=2, help="runs side by side")
    parser.add_argument("--program", type=pathlib.Path, help="the program tandem; otherwise this checkout's, built when needed")
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("reports/task_partitioning"),
                        help="folder for tables and figures")
    options = parser.parse_args()
    if options.seeds < 2 or options.seconds < 120.0:
        parser.error("two seeds and 120 seconds are the least that there is something to draw of")
    if shutil.which("gnuplot") is None:
        sys.exit("there is no gnuplot; with Debian: apt install gnuplot-nox")
    if options.program is None:
        subprocess.run([TOP / "tandem", "list"], stdout=subprocess.DEVNULL, check=True)
        options.program = TOP / "build/release/bin/tandem"
    folder = options.output.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    samples = all_throughputs(options, folder)
    draw_throughput(options, folder, samples)
    draw_carries(options, folder, samples)
    draw_shuttle(options, folder)
    print(f"tables and figures: {folder}")


if __name__ == "__main__":
    main()
