"""The examples, shorter than people run them."""

import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

import tandem
from rooms import CONFIGS

EXAMPLES = os.path.join(os.path.dirname(CONFIGS), "examples", "python")


class Examples(unittest.TestCase):
    def learn(self, program, *options):
        """What the program printed for each of its rounds; its network drives robots."""
        with tempfile.TemporaryDirectory() as folder:
            policy = os.path.join(folder, "policy.json")
            done = subprocess.run([sys.executable, os.path.join(EXAMPLES, program), "--policy", policy, *options],
                                  capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            world = tandem.World(os.path.join(CONFIGS, "epuck_neural.xml"),
                                 parameters={"controllers.neural[avoid].params.policy": policy})
            world.run(until=1)
            self.assertEqual(world.incidents["controllers_thrown"], 0)
        return [float(one) for one in re.findall(r"mean (?:reward )?(-?[0-9.]+)", done.stdout)]

    def test_an_evolution_finds_better_networks(self):
        means = self.learn("evolve.py", "--generations", "6", "--population", "8", "--seeds", "1", "--seconds", "10")
        self.assertEqual(len(means), 6)
        self.assertGreater(means[-1], means[0] + 0.05)

    def test_a_policy_gradient_finds_better_networks(self):
        means = self.learn("policy_gradient.py", "--updates", "12", "--worlds", "4", "--seconds", "5")
        self.assertEqual(len(means), 12)
        self.assertGreater(sum(means[-3:]) / 3, means[0] + 0.1)

    def test_the_cells_of_the_notebook_run(self):
        with open(os.path.join(EXAMPLES, "swarm.ipynb")) as file:
            cells = json.load(file)["cells"]
        program = "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
        done = subprocess.run([sys.executable, "-c", program], cwd=EXAMPLES, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("['ep0', 'ep1', 'ep2'] (50, 8)", done.stdout)


if __name__ == "__main__":
    unittest.main()
