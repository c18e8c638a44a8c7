"""Makes wheels of the built package, without pip: `python -m tandem.wheel [FOLDER]`, one for each Python that it was built for.

The libraries of the system that it is linked with are those of Debian's packages, as for the program.
"""

import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

from . import _tandem


def _modules(package):
    """The module's file for each minor release of Python, (3, 11) say: this Python's own has no release in its name."""
    for name in sorted(os.listdir(package), key=lambda one: (len(one), one)):
        if named := re.fullmatch(r"_tandem(?:\.cpython-(\d)(\d+)-.*)?\.so", name):
            yield (int(named[1]), int(named[2])) if named[1] else sys.version_info[:2], name


def _files(package, module):
    """(path in the wheel, file): the package with one of its modules, then the plug-ins that the build lists beside it."""
    for name in sorted(os.listdir(package)):
        if name == module or name.endswith((".py", ".pyi", ".typed")):
            yield f"tandem/{name}", os.path.join(package, name)
    with open(os.path.join(os.path.dirname(package), "libraries.txt")) as listed:
        folder, *libraries = listed.read().split("\n")
    for library in sorted(filter(None, libraries)):
        yield f"tandem/lib/{os.path.relpath(library, folder)}", library


def _stripped(path):
    """The bytes of a shared object without what debuggers want, where binutils is there."""
    with tempfile.TemporaryDirectory() as folder:
        copy = os.path.join(folder, "library.so")
        try:
            subprocess.run(["strip", "--strip-debug", "-o", copy, path], check=True, capture_output=True)
            path = copy
        except (OSError, subprocess.CalledProcessError):
            pass
        with open(path, "rb") as source:
            return source.read()


def write(folder=".", package=os.path.dirname(os.path.abspath(__file__))):
    """Writes tandem-VERSION-….whl into the folder for each Python that the package was built for; returns their paths."""
    return [_write(folder, package, release, module) for release, module in _modules(package)]


def _write(folder, package, release, module):
    major, minor = release
    python = f"cp{major}{minor}"
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    tag = f"{python}-{python}-{platform}"
    name = f"tandem-{_tandem.version}"
    info = f"{name}.dist-info"
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, f"{name}-{tag}.whl")
    record = []
    with zipfile.ZipFile(path + ".part", "w", zipfile.ZIP_DEFLATED) as wheel:

        def add(inside, data, executable=False):
            entry = zipfile.ZipInfo(inside, (1980, 1, 1, 0, 0, 0))  # the same bytes of the same files
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o755 if executable else 0o644) << 16
            wheel.writestr(entry, data)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record.append(f"{inside},sha256={digest},{len(data)}")

        for inside, file in _files(package, module):
            if file.endswith(".so"):
                add(inside, _stripped(file), executable=True)
            else:
                with open(file, "rb") as source:
                    add(inside, source.read())
        add(f"{info}/METADATA", (
            "Metadata-Version: 2.1\n"
            f"Name: tandem\nVersion: {_tandem.version}\n"
            "Summary: Co-simulation hub for robot swarms\n"
            "License: MIT\n"
            f"Requires-Python: =={major}.{minor}.*\n"
            "Requires-Dist: numpy\n").encode())
        add(f"{info}/WHEEL", f"Wheel-Version: 1.0\nGenerator: tandem.wheel\nRoot-Is-Purelib: false\nTag: {tag}\n".encode())
        record.append(f"{info}/RECORD,,")
        wheel.writestr(zipfile.ZipInfo(f"{info}/RECORD", (1980, 1, 1, 0, 0, 0)), "\n".join(record) + "\n")
    os.replace(path + ".part", path)
    return path


if __name__ == "__main__":
    print(*write(*sys.argv[1:2]), sep="\n")
