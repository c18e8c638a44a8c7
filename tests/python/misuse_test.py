"""What is wrong becomes an exception that says what; never a crash."""

import gc
import threading
import unittest
import warnings

import numpy as np

import tandem
from rooms import room


class Misuse(unittest.TestCase):
    def test_arrays_of_a_wrong_shape_or_kind(self):
        world = tandem.World(room(), driven=True)
        wheels = world.swarm.actuator("differential_steering")
        for bad, error, why in (
                (np.zeros(5), ValueError, r"'differential_steering.left' is an array of shape \(6,\), .* has the shape \(5,\)"),
                (np.zeros((6, 2)), ValueError, r"has the shape \(6, 2\)"),
                ("fast", TypeError, r"takes numbers \(float64\), and this is of type str"), ("3", TypeError, "str"),
                (None, TypeError, "NoneType"), ([{}], TypeError, "list"), ([[1], [2, 3]], TypeError, "list"),
                (np.zeros(6) + 1j, TypeError, "an array of complex128")):
            with self.assertRaisesRegex(error, why, msg=repr(bad)):
                wheels.left = bad
        self.assertEqual(wheels.left.tolist(), [0] * 6)
        lamps = world.swarm.actuator("leds")
        name = next(one for one in dir(lamps) if lamps[one].dtype.kind == "u")
        setattr(lamps, name, 1.0)
        for bad in (-1, 0.5, 1000, float("nan")):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # numpy's, of the last
                with self.assertRaisesRegex(ValueError, "'leds." + name + "' takes whole numbers", msg=bad):
                    setattr(lamps, name, bad)
        self.assertTrue((lamps[name] == 1).all())
        with self.assertRaisesRegex(AttributeError, "Did you mean 'left'"):
            wheels.lef
        with self.assertRaisesRegex(AttributeError, "Did you mean 'left'"):
            wheels.lef = 3
        with self.assertRaisesRegex(AttributeError, "sensor"):
            world.swarm.sensor("proximity").distance = 3
        with self.assertRaises(ValueError):
            world.swarm.sensor("proximity").distance[:] = 3
        with self.assertRaisesRegex(KeyError, "Did you mean 'proximity'"):
            world.swarm.sensor("proximty")

    def test_a_world_after_its_end(self):
        world = tandem.World(room())
        swarm = world.swarm
        distance = swarm.sensor("proximity").distance
        world.step(5)
        then = distance.copy()
        moment = world.snapshot()
        world.close()
        world.close()
        for use in (world.step, world.snapshot, lambda: world.poses, lambda: world.swarms, lambda: world.restore(moment),
                    world.reset, world.picture, world.finish, lambda: world.tick):
            with self.assertRaisesRegex(RuntimeError, "closed"):
                use()
        with self.assertRaisesRegex(RuntimeError, "closed"):
            swarm.poses
        self.assertEqual((world.state, repr(world)), ("closed", "<tandem.World, closed>"))
        del world, swarm, moment
        gc.collect()
        np.testing.assert_array_equal(distance, then)  # memory lives as long as somebody looks at it

    def test_arrays_and_snapshots_outlive_their_world(self):
        world = tandem.World(room())
        distance = world.swarm.sensor("proximity").distance
        moment = world.snapshot()
        del world
        gc.collect()
        self.assertEqual(distance.shape, (6, 8))
        with self.assertRaisesRegex(RuntimeError, "another world"):
            tandem.World(room()).restore(moment)

    def test_a_world_from_two_threads(self):
        refused = []
        inside, done = threading.Event(), threading.Event()

        class Hook:
            def after_step(self, world):
                inside.set()
                done.wait(20)

        world = tandem.World(room(), hooks=[Hook()])

        def other():
            inside.wait(20)
            for use in (world.step, lambda: world.poses, world.close):
                try:
                    use()
                except RuntimeError as error:
                    refused.append(str(error))
            done.set()

        thread = threading.Thread(target=other)
        thread.start()
        world.step()
        thread.join()
        self.assertEqual(len(refused), 3, refused)
        self.assertIn("another thread is using this world", refused[0])
        world.step()  # and nothing is the worse for it

    def test_a_world_that_is_stepped_by_its_own_hook(self):
        class Hook:
            def before_step(self, world):
                world.step()

        world = tandem.World(room(), hooks=[Hook()])
        with self.assertRaisesRegex(tandem.RunFailed, "while the same world steps"):
            world.step()

    def test_devices_that_are_taken_too_late(self):
        class Late:
            def __init__(self, robot, params):
                self.robot = robot

            def step(self):
                self.robot.sensor("proximity")

        world = tandem.World(room(), controllers={"d": Late})
        world.step()
        self.assertRegex(world.incidents["first"][0], "are taken while its controller is made")

    def test_ports_of_a_robot_whose_world_is_gone(self):
        kept = []

        class Keeps:
            def __init__(self, robot, params):
                kept.append(robot.actuator("differential_steering"))

            def step(self):
                pass

        world = tandem.World(room(), controllers={"d": Keeps})
        world.step()
        kept[0].left = 0.01
        world.close()
        with self.assertRaisesRegex(RuntimeError, "gone"):
            kept[0].left

    def test_arguments_that_are_none(self):
        with self.assertRaisesRegex(TypeError, "an experiment is a path"):
            tandem.World(None)
        with self.assertRaisesRegex(TypeError, "an experiment is a path"):
            tandem.World(3)
        with self.assertRaisesRegex(tandem.ExperimentError, "there is no such file"):
            tandem.World("nowhere.xml")
        with self.assertRaisesRegex(tandem.ExperimentError, "Did you mean 'd'|there are: d"):
            tandem.World(room(), driven="e")
        world = tandem.World(room(length=0))
        with self.assertRaisesRegex(ValueError, "no length"):
            world.run()
        for end in (float("nan"), float("inf"), 1e300):
            with self.assertRaisesRegex(ValueError, "a time in s"):
                world.run(until=end)
        with self.assertRaises(ValueError):
            world.step(-1)
        for wrong in ("controllers.d=3", 3):
            with self.assertRaisesRegex(TypeError, "parameters are"):
                tandem.World(room(), parameters=wrong)
        for wrong in (-1, 2**64):
            with self.assertRaisesRegex(ValueError, "seed is 0 or more"):
                world.reset(seed=wrong)
        with self.assertRaisesRegex(ValueError, "'arena.size' cannot change"):
            world.reset(parameters={"arena.size": (9, 9, 1)})
        with self.assertRaisesRegex(tandem.ExperimentError, "Did you mean 'velocity'"):
            world.reset(parameters={"controllers.epuck_diffusion[d].params.velocty": 3})
        world.step(3)
        with self.assertRaisesRegex(KeyError, "there is no robot"):
            world.pose("ep99")
        with self.assertRaises(ValueError):
            world.set_pose("ep0", float("nan"), 0)
        for wrong in ({"policies": {"d": 3}}, {"controllers": {"d": 3}}, {"controllers": {3: dict}}, {"hooks": [3]}, {"seed": "one"}):
            with self.assertRaises(TypeError, msg=wrong):
                tandem.World(room(), **wrong)
        for wrong in ({"seed": -1}, {"seed": 2**64}, {"threads": -1}):
            with self.assertRaises(ValueError, msg=wrong):
                tandem.World(room(), **wrong)
        with self.assertRaises(TypeError):
            tandem.Group([world, None])
        with self.assertRaisesRegex(ValueError, "twice"):
            tandem.Group([world, world])

    def test_calls_with_arguments_that_are_not_there_say_what_is(self):
        world = tandem.World(room())
        for call, words in ((lambda: world.step("ten"), r"World.step was called with \('ten'\); it takes \(ticks: int = 1\)"),
                            (lambda: world.run(util=3), r"World.run has no argument 'util'; .*until.* Did you mean 'until'\?"),
                            (lambda: world.pose(3), r"World.pose was called with \(3\); it takes \(robot: str\)"),
                            (lambda: world.swarm.sensor(), r"Swarm.sensor was called with \(\); it takes \(name: str\)"),
                            (lambda: world.picture(width=3), "World.picture has no argument 'width'"),
                            (lambda: world.snapshot(3), r"it takes \(nothing\)")):
            with self.assertRaisesRegex(TypeError, words):
                call()
        with self.assertRaisesRegex(ValueError, "e-puk.*Did you mean 'e-puck'"):
            world.add_robot("new", "d", 0, 0, kind="e-puk")
        with self.assertRaisesRegex(TypeError, "no argument 'sed'.*Did you mean 'seed'"):
            tandem.World(room(), sed=3)

    def test_a_world_is_left_as_it_was_by_a_refused_reset(self):
        world, same = tandem.World(room()), tandem.World(room())
        with self.assertRaises(tandem.ExperimentError):
            world.reset(parameters={"controllers.epuck_diffusion[d].params.velocity": "five"})
        world.step(10)
        same.step(10)
        self.assertEqual(world.fingerprint, same.fingerprint)


if __name__ == "__main__":
    unittest.main()
