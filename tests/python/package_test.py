"""The package: its stubs, its wheel, its documentation."""

import ast
import base64
import csv
import hashlib
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
import zipfile

import tandem
from rooms import CONFIGS, room
from tandem import wheel

TOP = os.path.dirname(CONFIGS)


class Package(unittest.TestCase):
    def test_has_stubs_for_every_port(self):
        with open(os.path.join(os.path.dirname(tandem.__file__), "__init__.pyi")) as file:
            stubs = ast.parse(file.read())
        classes = {one.name: one for one in stubs.body if isinstance(one, ast.ClassDef)}
        from tandem.stubs import class_name

        for port in tandem.ports():
            self.assertIn(class_name(port), classes)
            self.assertEqual(ast.get_docstring(classes[class_name(port)]), port["doc"])
            fields = [one.target.id for one in classes[class_name(port)].body if isinstance(one, ast.AnnAssign)]
            self.assertEqual(fields, [one["name"] for one in port["fields"]])
        public = {one.name for one in stubs.body if isinstance(one, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(set(tandem.__all__) - public, set())
        for name, there in (("_World", tandem.World), ("World", tandem.World), ("Swarm", tandem.Swarm), ("Policy", tandem.Policy)):
            stubbed = {one.name for one in classes[name].body if isinstance(one, ast.FunctionDef)}
            self.assertEqual([one for one in stubbed if not hasattr(there, one)], [])
            if name in ("_World", "Swarm"):
                public = {one for one in vars(there if name == "Swarm" else there.__mro__[1]) if not one.startswith("_")}
                self.assertEqual(public - stubbed, set())

    def test_is_a_wheel_that_works_on_its_own(self):
        with tempfile.TemporaryDirectory() as folder:
            path = wheel.write(folder)[0]
            with zipfile.ZipFile(path) as file:
                names = file.namelist()
                record = next(one for one in names if one.endswith("RECORD"))
                rows = list(csv.reader(file.read(record).decode().splitlines()))
                self.assertEqual(sorted(row[0] for row in rows), sorted(names))
                for name, digest, size in rows[:-1]:
                    data = file.read(name)
                    wanted = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
                    self.assertEqual((digest, int(size)), (f"sha256={wanted}", len(data)), name)
                self.assertIn("tandem/lib/libneural.so", names)
                self.assertFalse([one for one in names if "test" in one])
                target = os.path.join(folder, "there")
                file.extractall(target)
            program = ("import tandem; w = tandem.World(%r, seed=1); w.run(until=2); "
                       "assert tandem.__file__.startswith(%r); w.picture().png(); print(w.fingerprint)"
                       % (os.path.join(CONFIGS, "footbot_diffusion.xml"), target))
            done = subprocess.run([sys.executable, "-c", program], env={"PYTHONPATH": target, "PATH": os.environ["PATH"]},
                                  capture_output=True, text=True, cwd=folder)
            world = tandem.World(os.path.join(CONFIGS, "footbot_diffusion.xml"), seed=1)
            world.run(until=2)
            self.assertEqual((done.stdout.strip(), done.stderr), (str(world.fingerprint), ""))

    def test_is_a_wheel_for_each_python_that_it_was_built_for(self):
        with tempfile.TemporaryDirectory() as folder:
            package = os.path.join(folder, "python", "tandem")
            os.makedirs(package)
            for name in ("__init__.py", "_tandem.so", "_tandem.cpython-39-x86_64-linux-gnu.so", "_tandem.cpython-312-x86_64-linux-gnu.so"):
                with open(os.path.join(package, name), "w") as file:
                    file.write(name)
            with open(os.path.join(folder, "python", "libraries.txt"), "w") as file:
                file.write(folder + "\n")
            named = {}
            for path in wheel.write(os.path.join(folder, "wheels"), package):
                with zipfile.ZipFile(path) as file:
                    self.assertIn("tandem/__init__.py", file.namelist())
                    named[os.path.basename(path).split("-")[2]] = [one for one in file.namelist() if one.endswith(".so")]
            own = "cp%d%d" % sys.version_info[:2]
            self.assertEqual(named, {own: ["tandem/_tandem.so"], "cp39": ["tandem/_tandem.cpython-39-x86_64-linux-gnu.so"],
                                     "cp312": ["tandem/_tandem.cpython-312-x86_64-linux-gnu.so"]})

    def test_opens_the_window_on_the_same_run(self):
        world = tandem.World(room(), seed=5, parameters={"framework.experiment.length": 3})
        process = world.view("--no-browser", stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        try:
            told = ""
            while "http://" not in told:
                line = process.stdout.readline()
                self.assertTrue(line, told)
                told += line
        finally:
            process.terminate()
            process.wait()
            process.stdout.close()
        with self.assertRaisesRegex(RuntimeError, "picture"):
            tandem.World(room(), driven=True).view()

    def test_does_what_its_documentation_shows(self):
        with open(os.path.join(TOP, "docs", "python.md")) as file:
            blocks = re.findall(r"```python[^\n]*\n(.*?)```", file.read(), re.S)
        self.assertGreater(len(blocks), 5)
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(CONFIGS, os.path.join(folder, "configs"))
            done = subprocess.run([sys.executable, "-c", "\n".join(blocks)], cwd=folder, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_is_measured_by_the_program(self):
        program = [os.environ["TANDEM_PROGRAM"], "bench", "python", "--robots", "20,30", "--ticks", "20", "--repeat", "2"]
        done = subprocess.run(program, cwd=TOP, env={**os.environ, "TANDEM_PYTHON": sys.executable}, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        lines = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertEqual([(one["bench"], one.get("robots")) for one in lines],
                         [("python arrays", 20), ("python arrays", 30), ("python runs", None)])
        self.assertTrue(lines[0]["same_fingerprints"])
        self.assertEqual(lines[2]["failed"], 0)
        done = subprocess.run(program, env={**os.environ, "TANDEM_PYTHON": "/nowhere/python3"}, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (3, ""))
        self.assertIn("cannot start '/nowhere/python3'", done.stderr)

    def test_has_stubs_that_fit_its_documentation(self):
        try:
            import mypy.api
        except ImportError:
            self.skipTest("no python3-mypy here")
        with open(os.path.join(TOP, "docs", "python.md")) as file:
            blocks = re.findall(r"```python[^\n]*\n(.*?)```", file.read(), re.S)
        with tempfile.TemporaryDirectory() as folder:
            program = os.path.join(folder, "shown.py")
            with open(program, "w") as file:
                file.write("\n".join(blocks))
            told, errors, code = mypy.api.run(["--check-untyped-defs", "--cache-dir", os.path.join(folder, "cache"), program])
        self.assertEqual((code, errors), (0, ""), told)


if __name__ == "__main__":
    unittest.main()
