#!/usr/bin/python3
"""Lists what ARGoS 3 users' code calls (entries.txt), and where the corpus uses each.

    entries.py            each entry, in how many repositories it was found, and its first places
    entries.py --unused   the entries without a place alone

Exit code 1 when one that two repositories or more use, or one of Lua, has no place.
"""
import argparse
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
COMMENTS = re.compile(r"/\*.*?\*/|//[^\n]*", re.S)


def code_of(file):
    """A file's text with its lines, without comments of C++."""
    text = file.read_text()
    return COMMENTS.sub(lambda m: "\n" * m.group().count("\n"), text) if file.suffix != ".lua" else text


def places(pattern, sources):
    for name, lines in sources.items():
        for number, line in enumerate(lines, 1):
            if pattern.search(line):
                yield f"{name}:{number}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--unused", action="store_true")
    only_unused = parser.parse_args().unused
    project = HERE / "project"
    files = [f for f in sorted(project.rglob("*")) if f.suffix in (".h", ".cpp", ".lua")]
    sources = {str(f.relative_to(project)): code_of(f).splitlines() for f in files}
    lua = {name: lines for name, lines in sources.items() if name.endswith(".lua")}
    cpp = {name: lines for name, lines in sources.items() if name not in lua}
    missing = 0
    for line in (HERE / "entries.txt").read_text().splitlines():
        if not line or line.startswith("#"):
            continue
        group, name, repositories, *rest = line.split("\t")
        if rest and rest[0].startswith("not ours"):
            if not only_unused:
                print(f"{group:15} {name:42} {repositories:>2}  {rest[0]}")
            continue
        pattern = re.compile(rest[0] if rest else r"\b" + re.escape(name) + r"\b")
        found = list(places(pattern, lua if group == "lua" else cpp))
        missing += not found and (repositories == "-" or int(repositories) >= 2)
        if not found or not only_unused:
            print(f"{group:15} {name:42} {repositories:>2}  {' '.join(found[:3]) or 'not used'}")
    sys.exit(1 if missing else 0)


if __name__ == "__main__":
    main()
