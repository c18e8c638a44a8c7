"""Policies, environments, many runs."""

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import numpy as np

import tandem
from rooms import room
from tandem import env

OBSERVE = [("proximity", "distance", {"count": 8, "high": 0.1, "scale": 10.0})]
ACT = [("differential_steering", "left", {"scale": 0.1}), ("differential_steering", "right", {"scale": 0.1})]
VELOCITY = "controllers.epuck_diffusion[d].params.velocity"


def some_layers(seed=1, hidden=5):
    random = np.random.default_rng(seed)
    return [tandem.Layer(random.normal(size=(hidden, 8)), random.normal(size=hidden), "tanh"),
            tandem.Layer(random.normal(size=(2, hidden)), random.normal(size=2), "tanh")]


def neural_room(path, **more):
    made = room(**more)
    config = made["controllers"].pop("epuck_diffusion")
    config.update(library="neural", params={"policy": path})
    made["controllers"]["neural"] = config
    return made


class Policies(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = os.path.join(self.folder.name, "policy.json")

    def test_run_in_the_controller_neural_as_they_do_here(self):
        policy = tandem.Policy(OBSERVE, ACT, some_layers())
        policy.save(self.path)
        here = tandem.World(room(robots=20), policies={"d": policy})
        there = tandem.World(neural_room(self.path, robots=20))
        here.step(20)
        there.step(20)
        np.testing.assert_allclose(there.poses, here.poses, atol=1e-9)
        self.assertGreater(np.abs(there.poses - tandem.World(room(robots=20)).poses).max(), 0.01)

    def test_drive_a_robot_that_is_not_simulated(self):
        tandem.save_policy(self.path, OBSERVE, [("differential_steering", "left"), ("differential_steering", "right")],
                           [(np.zeros((2, 8)), np.array([0.05, 0.04]), "identity")])
        with open(os.path.join(self.folder.name, "robot.xml"), "w") as file:
            file.write(tandem.to_xml({
                "framework": {"experiment": {"length": 0, "ticks_per_second": 10}},
                "controllers": {"neural": {"id": "d", "actuators": {"differential_steering": {}}, "sensors": {"epuck_proximity": {}},
                                           "params": {"policy": "policy.json"}}},
                "arena": {"size": (4, 4, 1), "e-puck": {"id": "ep0", "body": {"position": (0, 0, 0)}, "controller": {"config": "d"},
                                                        "bridge": {"link": "serial:ep0"}}}}))
        told = {"cwd": self.folder.name, "env": {**os.environ, "XDG_RUNTIME_DIR": self.folder.name}, "stderr": subprocess.STDOUT}
        program, log = os.environ["TANDEM_PROGRAM"], os.path.join(self.folder.name, "log")
        with open(log, "w") as nowhere:
            robot = subprocess.Popen([program, "emulate", "epuck", "--link", "pty:ep0", "--log", "events"], stdout=nowhere, **told)
        self.addCleanup(robot.wait)
        self.addCleanup(robot.kill)
        for _ in range(600):
            if os.path.lexists(os.path.join(self.folder.name, "tandem", "ep0")) or os.path.exists(os.path.join(self.folder.name, "events")):
                break
            time.sleep(0.05)
        done = subprocess.run([program, "robot", "robot.xml", "--seconds", "2"], stdout=subprocess.PIPE, text=True, timeout=60, **told)
        self.assertEqual(done.returncode, 0, done.stdout)
        with open(os.path.join(self.folder.name, "events")) as file:
            wheels = [json.loads(line) for line in file if '"wheels"' in line]
        self.assertTrue(any(one["left"] > one["right"] > 0 for one in wheels), wheels)

    def test_may_look_at_more_sensors_than_a_robot_has(self):
        wide = [("proximity", "distance", {"count": 24, "high": 0.1, "scale": 10.0})]
        layers = [(np.ones((2, 24)) * 0.01, np.zeros(2), "tanh")]
        policy, world = tandem.Policy(wide, ACT, layers), tandem.World(room())
        world.step(3)
        read = policy.inputs.read(world.swarm)
        self.assertTrue((read[:, :8] > 0).all() and (read[:, 8:] == 0).all())
        with self.assertRaisesRegex(ValueError, "has 8 elements, and the signal wants 0 to 24"):
            tandem.Policy([("proximity", "distance", {"count": 25})], ACT, [(np.ones((2, 25)), np.zeros(2))])(world.swarm)

    def test_come_back_from_their_file(self):
        policy = tandem.Policy(OBSERVE, ACT, some_layers())
        policy.save(self.path)
        read = tandem.load_policy(self.path)
        np.testing.assert_array_equal(read.parameters, policy.parameters)
        self.assertEqual(read.inputs.signals, policy.inputs.signals)
        read.parameters = np.zeros(policy.parameters.size)
        self.assertTrue((read.evaluate(np.ones((3, 8))) == 0.0).all())

    def test_that_do_not_fit_are_refused(self):
        for layers in ([(np.zeros((2, 7)), np.zeros(2))], [(np.zeros((3, 8)), np.zeros(3))], [(np.zeros((2, 8)), np.zeros(3))],
                       [(np.zeros((2, 8)), np.zeros(2), "cos")], [(np.full((2, 8), np.nan), np.zeros(2))], []):
            with self.assertRaises(ValueError):
                tandem.save_policy(self.path, OBSERVE, ACT, layers)
        tandem.save_policy(self.path, ["proximity.distnce"], ["differential_steering.left"], [(np.zeros((1, 1)), np.zeros(1))])
        with self.assertRaisesRegex(tandem.ExperimentError, "has a policy with the field 'distnce'.*it has: "):
            tandem.World(neural_room(self.path))
        with open(self.path, "w") as file:
            file.write('{"tandem_policy": 1, "inputs": 3}')
        with self.assertRaisesRegex(tandem.ExperimentError, "has no list 'inputs'"):
            tandem.World(neural_room(self.path))


class Rollouts(unittest.TestCase):
    def test_are_the_same_for_any_number_of_workers(self):
        sets = [{VELOCITY: f"{v} cm/s"} for v in (2, 4, 6)] + [{"arena.distribute.entity.quantity": 3}]
        made = {n: tandem.rollouts(room(), sets, range(1, 6), until=5, workers=n, measure=lambda w: w.poses[:, 0].max())
                for n in (0, 1, 3)}
        for n in (1, 3):
            self.assertEqual([one.fingerprint for one in made[n]], [one.fingerprint for one in made[0]])
            np.testing.assert_array_equal(made[n].array(), made[0].array())
        one = made[3][7]
        self.assertEqual((one.set, one.seed, one.parameters, one.ticks), (1, 3, sets[1], 50))
        alone = tandem.World(room(), seed=3, parameters=sets[1])
        alone.run(until=5)
        self.assertEqual(one.fingerprint, alone.fingerprint)

    def test_take_candidates_of_any_form(self):
        policy = tandem.Policy(OBSERVE, ACT, some_layers())

        def setup(world, vector):
            policy.parameters = vector

        vectors = [np.full(policy.parameters.size, v) for v in (0.0, 0.1)]
        made = tandem.rollouts(room(), vectors, [1, 2], until=3, setup=setup, policies={"d": policy}, workers=2,
                               measure=lambda w: float(np.abs(w.swarm.actuator("differential_steering").left).sum()))
        self.assertEqual([one.failure for one in made], [None] * 4)
        self.assertTrue((made.array()[0] == 0).all() and (made.array()[1] > 0).all())

    def test_lose_only_what_fails(self):
        def measure(world):
            if world.seed == 3:
                os.kill(os.getpid(), signal.SIGKILL)
            if world.seed == 5:
                raise ValueError("what a pity")
            return world.tick

        made = tandem.rollouts(room(), [{}, {VELOCITY: "fast"}], range(1, 7), until=1, workers=2, measure=measure)
        self.assertEqual([one.value for one in made[:6]], [10, 10, None, 10, None, 10])
        self.assertIn("signal 9", made[2].failure)
        self.assertIn("what a pity", made[4].failure)
        self.assertTrue(all("velocity" in one.failure for one in made[6:]))
        self.assertEqual(len(made.failed), 8)

    def test_say_at_once_what_no_run_can_be_made_with(self):
        for wrong in ({"parameter_sets": {VELOCITY: 3}}, {"parameter_sets": [{}, 3]}, {"colour": "red"}, {"seeds": ["one"]}, {"seed": 3}):
            with self.assertRaises(TypeError, msg=wrong):
                tandem.rollouts(room(), **wrong)
        with self.assertRaises(TypeError):
            tandem.rollouts(3)
        made = tandem.rollouts(room(), until=1, workers=0, measure=lambda world: sys.exit(2))
        self.assertIn("exit(2)", made[0].failure)
        made = tandem.rollouts(room(), until=1, workers=0)
        with self.assertRaisesRegex(KeyError, "no measure 'items'; it has: none"):
            made.array("items")


class Environments(unittest.TestCase):
    def make(self, worlds=3, **more):
        return env.VectorEnv(room(robots=4), worlds, observe=OBSERVE, act=ACT, episode=2.0, threads=2,
                             reward=lambda world, swarm: float(swarm.poses[:, 0].mean()), **more)

    def test_follow_gymnasiums_conventions_for_vectors(self):
        vector = self.make()
        self.assertEqual((vector.num_envs, vector.observation_space.shape, vector.action_space.shape), (3, (3, 4, 8), (3, 4, 2)))
        observations, infos = vector.reset(seed=5)
        self.assertEqual((observations.dtype, infos), (np.float32, {}))
        self.assertIn(observations, vector.observation_space)
        self.assertTrue((observations > 0).any())
        for step in range(19):
            observations, rewards, terminated, truncated, infos = vector.step(vector.action_space.sample())
        self.assertEqual((rewards.shape, terminated.dtype, truncated.all(), terminated.any()), ((3,), bool, True, False))
        observations, rewards, terminated, truncated, infos = vector.step(vector.action_space.sample())
        self.assertTrue((rewards == 0).all() and not truncated.any())
        self.assertEqual([world.tick for world in vector.worlds], [1, 1, 1])
        vector.close()

    def test_do_the_same_again_with_the_same_seed(self):
        def play(worlds):
            vector = self.make(worlds)
            random = np.random.default_rng(1)
            seen = [vector.reset(seed=8)[0][:2]]
            for _ in range(50):
                actions = random.uniform(-1, 1, (3, 4, 2))
                seen.append(vector.step(actions[:worlds])[0][:2])
            return np.array(seen)

        np.testing.assert_array_equal(play(2), play(2))

    def test_render_text_or_pixels(self):
        self.assertIn("<svg", self.make(1).render()[0])
        pixels = self.make(2, render_mode="rgb_array").render()
        self.assertEqual((len(pixels), pixels[0].dtype, pixels[0].ndim), (2, np.uint8, 3))
        with self.assertRaisesRegex(ValueError, "'human'; there are 'svg', 'rgb_array'"):
            self.make(render_mode="human")

    def test_refuse_actions_of_a_wrong_shape(self):
        vector = self.make()
        vector.reset(seed=1)
        with self.assertRaisesRegex(ValueError, r"have the shape \(3, 4, 2\), not \(3, 2\)"):
            vector.step(np.zeros((3, 2)))
        with self.assertRaisesRegex(TypeError, "numbers"):
            vector.step("go")

    def test_follow_pettingzoos_conventions_for_agents(self):
        def reward(world, swarm):
            return swarm.poses[:, 0]

        parallel = env.ParallelEnv(room(robots=4), observe=OBSERVE, act=ACT, reward=reward, episode=1.0)
        observations, infos = parallel.reset(seed=2)
        self.assertEqual((parallel.agents, list(observations), infos["ep1"]), (["ep0", "ep1", "ep2", "ep3"],) * 2 + ({},))
        self.assertIn(observations["ep2"], parallel.observation_space("ep2"))
        while parallel.agents:
            actions = {agent: np.array([1.0, 1.0]) for agent in parallel.agents}
            observations, rewards, terminations, truncations, infos = parallel.step(actions)
            self.assertEqual(rewards["ep3"], parallel.world.pose("ep3")[0])
        self.assertEqual((truncations["ep0"], terminations["ep0"], parallel.world.tick), (True, False, 10))
        with self.assertRaisesRegex(RuntimeError, "reset"):
            parallel.step({})

    def test_take_a_seed_for_each_world(self):
        vector = self.make()
        vector.reset(seed=[30, 4, 8])
        self.assertEqual([world.seed for world in vector.worlds], [30, 4, 8])
        vector.reset(seed=[None, 4, None])
        self.assertEqual([world.seed for world in vector.worlds], [33, 4, 11])
        vector.reset(seed=2)
        self.assertEqual([world.seed for world in vector.worlds], [2, 3, 4])
        with self.assertRaisesRegex(ValueError, "3 worlds, and 2 seeds"):
            vector.reset(seed=[1, 2])
        self.assertIs(vector.unwrapped, vector)

    def test_are_gymnasiums_where_it_is_installed(self):
        with tempfile.TemporaryDirectory() as folder:  # what they take of it
            for name, text in {"__init__": "", "spaces": "from fake import Box", "vector": "from fake import AutoresetMode, VectorEnv"}.items():
                os.makedirs(os.path.join(folder, "gymnasium"), exist_ok=True)
                with open(os.path.join(folder, "gymnasium", name + ".py"), "w") as file:
                    file.write(text)
            with open(os.path.join(folder, "pettingzoo.py"), "w") as file:
                file.write("class ParallelEnv: pass\n")
            with open(os.path.join(folder, "fake.py"), "w") as file:
                file.write("import enum\n"
                           "class AutoresetMode(enum.Enum):\n  NEXT_STEP = 'NextStep'\n"
                           "class VectorEnv:\n  closed = False\n  def __del__(self): self.close()\n"
                           "class Box:\n"
                           "  def __init__(self, low, high, shape=None, dtype=float, seed=None): self.shape, self.dtype = shape, dtype\n")
            program = ("import fake, numpy, rooms\nfrom tandem import env\n"
                       f"vector = env.VectorEnv(rooms.room(robots=4), 2, observe={OBSERVE!r}, act={ACT!r}, reward=lambda w, s: 0.0)\n"
                       "assert isinstance(vector, fake.VectorEnv) and isinstance(vector.action_space, fake.Box)\n"
                       "assert vector.metadata['autoreset_mode'] is fake.AutoresetMode.NEXT_STEP\n"
                       "vector.reset(seed=1); vector.step(numpy.zeros((2, 4, 2)))\n"
                       "import pettingzoo\nassert issubclass(env.ParallelEnv, pettingzoo.ParallelEnv)\n"
                       "try: env.VectorEnv(rooms.room(), 0, observe=[], act=[], reward=None)\n"
                       "except ValueError: pass\n")
            path = os.pathsep.join([folder, os.path.dirname(os.path.abspath(__file__)), os.environ["PYTHONPATH"]])
            done = subprocess.run([sys.executable, "-c", program], env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_a_policy_of_an_environment_drives_robots(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "policy.json")
            vector = self.make(1)
            vector.save_policy(path, some_layers())
            world = tandem.World(neural_room(path))
            world.step(10)
            self.assertEqual(world.incidents["controllers_thrown"], 0)


if __name__ == "__main__":
    unittest.main()
