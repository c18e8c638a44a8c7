"""Does what the last stage of the Containerfile says in a bare root of its Debian release, made by mmdebstrap; runs its program there.

    bare_root.py CONTAINERFILE FOLDER-OF-PACKAGES ARGUMENTS… [-- OTHER COMMAND…]

The arguments are those of the container's program; the other command is run after it. The packages are installed by apt from the release's own archive. Without root, mmdebstrap, or an archive that answers: exit code 77.
"""
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import urllib.request

ARCHIVE = "http://deb.debian.org/debian"


def skip(why):
    print(f"not tried: {why}")
    sys.exit(77)


def last_stage(path):
    """Of the last FROM on: its image, and the lines (word, rest)."""
    text = re.sub(r"\\\n\s*", "", pathlib.Path(path).read_text())
    lines = [line.split(None, 1) for line in text.splitlines() if line.strip() and not line.startswith("#")]
    begin = max(i for i, (word, _) in enumerate(lines) if word == "FROM")
    return lines[begin][1], lines[begin + 1:]


def main():
    containerfile, packages, *arguments = sys.argv[1:]
    split = arguments.index("--") if "--" in arguments else len(arguments)
    image, lines = last_stage(containerfile)
    release = re.fullmatch(r"debian:(\w+)-slim", image)[1]
    if os.geteuid() != 0 or not shutil.which("mmdebstrap"):
        skip("this needs root and mmdebstrap")
    try:
        urllib.request.urlopen(f"{ARCHIVE}/dists/{release}/Release", timeout=20).close()
    except OSError as error:
        skip(f"{ARCHIVE} does not answer: {error}")
    hooks, folder, entry = [], "/", []
    for word, rest in lines:
        if word == "COPY":
            hooks.append(f'copy-in {shlex.quote(packages)} /')
            there = rest.split()[-1]
            if there != f"/{os.path.basename(packages)}":
                hooks.append(f'mv "$1/{os.path.basename(packages)}" "$1{there}"')
        elif word == "RUN":
            hooks.append(f'chroot "$1" env DEBIAN_FRONTEND=noninteractive sh -c {shlex.quote(rest)}')
        elif word == "WORKDIR":
            folder = rest
        elif word == "ENTRYPOINT":
            entry = json.loads(rest)
    for command in filter(None, (entry + arguments[:split], arguments[split + 1:])):
        hooks.append(f'chroot "$1" sh -c {shlex.quote(f"mkdir -p {folder} && cd {folder} && {shlex.join(command)}")}')
    made = subprocess.run(["mmdebstrap", "--mode=root", "--variant=apt", "--format=null", "--aptopt=Acquire::Languages none",
                           *(f"--customize-hook={one}" for one in hooks), release, "/dev/null", ARCHIVE], check=False)
    sys.exit(made.returncode)


main()
