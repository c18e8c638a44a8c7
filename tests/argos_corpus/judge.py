#!/usr/bin/python3
"""Runs the corpus' experiments and compares what they print with what their files say must come out.

    judge.py PROJECT --tandem PROGRAM [NAME…]    by `tandem run`, from the folder PROJECT, which is built in PROJECT/build
    judge.py PROJECT --argos3 PROGRAM [NAME…]    the same by ARGoS 3 itself

The first comment of an experiment has lines after "expect": a key and a value, or numbers with "+- TOLERANCE". Runs print
lines "RESULT key value"; a key's last value counts. "fails TEXT" says instead that the run must end with an exit code that is
not 0, and print that text. "run PROGRAM ARGUMENT…" names a program of the project that runs the
file (FILE), "tandem OPTION…" options that Tandem alone needs, "needs NAME" a library of the project without which the experiment is left out, and "limit N" the seconds
that it may take. Exit code 1 when a value differs or is missing, or a run does not end well.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile

COLOR = re.compile(r"\x1b\[[0-9;]*m")
MOST = 8  # problems of one experiment that are told
RESULT = re.compile(r"RESULT (\S+)[ \t]*(.*?)\s*$")


class Experiment:
    """An experiment file and its comment."""

    def __init__(self, file):
        self.file, self.name = file, file.stem
        self.expected, self.errors, self.program, self.options, self.needs, self.limit_s = {}, [], None, [], None, 100
        comment = re.search(r"<!--(.*?)-->", file.read_text(), re.S)
        expecting = False
        for line in (comment.group(1) if comment else "").splitlines():
            words = line.split()
            if not words:
                continue
            if words[0] == "run" and not expecting:
                self.program = words[1:]
            elif words[0] == "tandem" and not expecting:
                self.options = ["--" + w for w in words[1:]]  # XML permits no -- in a comment
            elif words[0] == "needs" and not expecting:
                self.needs = words[1]
            elif words[0] == "limit" and not expecting:
                self.limit_s = int(words[1])
            elif words[0] == "fails" and not expecting:
                self.errors.append(" ".join(words[1:]))
            elif words == ["expect"]:
                expecting = True
            elif expecting:
                self.expected[words[0]] = " ".join(words[1:])

    def there(self, build):
        return self.needs is None or any(build.rglob(f"libcorpus_{self.needs}.so"))


def differs(expected, printed):
    """Whether a printed value is another than the expected one, which may have a tolerance."""
    if "+-" not in expected:
        return expected != printed
    values, tolerance = expected.split("+-")
    wanted, got = values.split(), printed.split()
    try:
        return len(wanted) != len(got) or any(
            not abs(float(a) - float(b)) <= float(tolerance) for a, b in zip(wanted, got))
    except ValueError:
        return True


def run(experiment, project, command, log):
    """Problems of one run, its values, and its output; a terminal would be shown the first messages alone, `log` has all."""
    words = command + (["--log", str(log), *experiment.options] if log else []) + [str(experiment.file.relative_to(project))]
    if experiment.program:
        words = [str(project / "build" / experiment.program[0])] + [
            str(experiment.file.relative_to(project)) if w == "FILE" else w for w in experiment.program[1:]]
    try:
        done = subprocess.run(words, cwd=project, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=experiment.limit_s, errors="replace")
    except subprocess.TimeoutExpired:
        return [f"has not ended after {experiment.limit_s} s"], {}, ""
    except OSError as error:
        return [str(error)], {}, ""
    text = COLOR.sub("", done.stdout + (log.read_text(errors="replace") if log and log.exists() else ""))
    values = {m.group(1): " ".join(m.group(2).split()) for m in map(RESULT.search, text.splitlines()) if m}
    well = done.returncode > 0 if experiment.errors else done.returncode == 0
    problems = [] if well else [f"ended with exit code {done.returncode}"]
    problems += [f"does not say: {error}" for error in experiment.errors if error not in text]
    for key, expected in experiment.expected.items():
        if key not in values:
            problems.append(f"{key}: {expected} is expected, nothing is printed")
        elif differs(expected, values[key]):
            problems.append(f"{key}: {expected} is expected, {values[key]} is printed")
    return problems, values, text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("project", type=pathlib.Path)
    parser.add_argument("names", nargs="*", help="experiments; all without one")
    parser.add_argument("--tandem", help="runs them by this program")
    parser.add_argument("--argos3", help="runs them by this program")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--verbose", action="store_true", help="prints every value, and the output of runs that are wrong")
    given = parser.parse_intermixed_args()
    if bool(given.tandem) == bool(given.argos3):
        parser.error("one of --tandem and --argos3 is needed")
    project = given.project.resolve()
    command = [given.tandem, "run", "--quiet"] if given.tandem else [given.argos3, "-n", "-z", "-c"]
    command[0] = str(pathlib.Path(command[0]).resolve()) if "/" in command[0] else command[0]
    all_of_them = [Experiment(f) for f in sorted((project / "experiments").glob("*.argos"))]
    unknown = set(given.names) - {e.name for e in all_of_them}
    if unknown:
        parser.error("there is no experiment " + ", ".join(sorted(unknown)))
    chosen = [e for e in all_of_them if (e.expected or e.errors) and (not given.names or e.name in given.names)]
    wrong = 0
    with tempfile.TemporaryDirectory() as logs, concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        runs = {e.name: pool.submit(run, e, project, command, given.tandem and pathlib.Path(logs) / e.name)
                for e in chosen if e.there(project / "build")}
        for experiment in chosen:
            if experiment.name not in runs:
                print(f"left out  {experiment.name}: libcorpus_{experiment.needs}.so was not built")
                continue
            problems, values, text = runs[experiment.name].result()
            wrong += bool(problems)
            print(f"{'wrong' if problems else 'right':8}  {experiment.name} ({len(experiment.expected) + len(experiment.errors)} values)")
            errors = [line.strip() for line in text.splitlines() if re.search(r"\berror\b|\[FATAL\]", line)]
            for problem in problems[:MOST] + ([f"and {len(problems) - MOST} more"] if len(problems) > MOST else []):
                print(f"            {problem}")
            for error in errors[:3] if problems and "ended" in problems[0] else []:
                print(f"            it says: {error}")
            if given.verbose:
                print("".join(f"            {k} {v}\n" for k, v in values.items()), end="")
                if problems:
                    print(text)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
