"""Puts a Debian package into a root that has nothing but what it depends on, and runs its program there.

    clean_root.py PACKAGE.deb FOLDER COMMAND…

The root is made of the files of packages that are installed here, so no network is needed: the dependencies that the package
names, and theirs. One that is not installed is an error, as is what the package forgot to name: its program will not start.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys


def said(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def installed():
    """Of each package: what it depends on, by lists of alternatives; and who provides what."""
    depends, provides = {}, {}
    fields = "${db:Status-Abbrev}\t${Package}\t${Architecture}\t${Pre-Depends}\t${Depends}\t${Provides}\n"
    for line in said("dpkg-query", "-W", "-f", fields).splitlines():
        status, name, _, first, then, provided = line.split("\t")
        if status.strip() != "ii":
            continue
        depends[name] = alternatives(first) + alternatives(then)
        for other in alternatives(provided):
            provides.setdefault(other[0], name)
    return depends, provides


def alternatives(field):
    return [[re.sub(r"[ (:].*", "", word.strip()) for word in one.split("|")] for one in field.split(",") if one.strip()]


def closure(wanted, depends, provides):
    todo, there = list(wanted), set()
    while todo:
        names = [provides.get(name, name) if name not in depends else name for name in todo.pop()]
        found = [name for name in names if name in depends]
        if not found:
            sys.exit(f"the package depends on {' or '.join(names)}, which is not installed here")
        if not there.isdisjoint(found):
            continue
        there.add(found[0])
        todo += depends[found[0]]
    return there


def main():
    package, root, command = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3:]
    depends, provides = installed()
    wanted = alternatives(said("dpkg-deb", "-f", package, "Depends").strip())
    packages = closure(wanted, depends, provides)
    for link in ("bin", "lib", "lib64", "sbin"):  # as Debian has them
        (root / "usr" / link).mkdir(parents=True, exist_ok=True)
        (root / link).symlink_to("usr/" + link)
    for path in sorted(set(said("dpkg-query", "-L", *packages).splitlines())):
        if not path.startswith("/") or path.startswith("/usr/share/doc/"):
            continue
        target = root / path.lstrip("/")
        if os.path.islink(path):
            if not os.path.lexists(target):
                target.parent.mkdir(parents=True, exist_ok=True)
                target.symlink_to(os.readlink(path))
        elif os.path.isdir(path):
            target.mkdir(parents=True, exist_ok=True)
        elif os.path.isfile(path):
            target.parent.mkdir(parents=True, exist_ok=True)
            if not os.path.lexists(target):
                shutil.copy2(path, target)
    subprocess.run(["dpkg-deb", "--extract", package, str(root)], check=True)
    for folder in ("tmp", "proc", "dev"):
        (root / folder).mkdir(exist_ok=True)
    (root / "dev/null").touch()
    shell = f'mount --rbind /proc "{root}/proc" && exec chroot "{root}" "$@"'
    inside = ["unshare", "--mount", *([] if os.geteuid() == 0 else ["-r"]), "sh", "-c", shell, "sh", *command]
    print(f"a root of {len(packages)} packages")
    sys.stdout.flush()
    sys.exit(subprocess.run(inside, check=False, env={"PATH": "/usr/sbin:/usr/bin", "HOME": "/tmp"}).returncode)


main()
