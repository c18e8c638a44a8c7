"""Controllers, policies and hooks of Python."""

import unittest

import numpy as np

import tandem
from rooms import room


class Turner:
    """Turns away from what is near, with a memory and a chance of its own."""

    def __init__(self, robot, params):
        self.proximity = robot.sensor("proximity")
        self.wheels = robot.actuator("differential_steering")
        self.random = robot.random()
        self.distance = self.proximity.distance  # an array without a copy
        self.history = []
        self.speed = float(params.get("velocity", "5 cm/s").split()[0]) / 100

    def step(self):
        near = self.distance.min() < 0.03
        self.history.append(bool(near))
        self.wheels.left = -0.02 if near else self.speed
        self.wheels.right = self.speed * (1.0 if len(self.history) < 30 else self.random.uniform(0.9, 1.0))


def turn(swarm):
    near = swarm.sensor("proximity").distance.min(axis=1) < 0.03
    wheels = swarm.actuator("differential_steering")
    wheels.left = np.where(near, -0.02, 0.05)
    wheels.right = 0.05


class Guests(unittest.TestCase):
    def test_controllers_drive_robots(self):
        world = tandem.World(room(), controllers={"d": Turner})
        world.step(20)
        self.assertTrue((world.swarm.actuator("differential_steering").right > 0).all())
        self.assertEqual(world.incidents["controllers_thrown"], 0)

    def test_policies_are_controllers_by_the_swarm(self):
        one = tandem.World(room(robots=300, side=4.0), controllers={"d": Turner})
        other = tandem.World(room(robots=300, side=4.0), policies={"d": turn})
        one.step(29)
        other.step(29)
        np.testing.assert_array_equal(one.poses, other.poses)

    def test_controllers_go_back_with_the_world(self):
        world = tandem.World(room(), controllers={"d": Turner})
        world.step(40)
        moment = world.snapshot()
        world.step(40)
        then = world.poses
        for _ in range(2):
            world.restore(moment)
            world.step(40)
            np.testing.assert_array_equal(world.poses, then)

    def test_controllers_begin_anew(self):
        world = tandem.World(room(), controllers={"d": Turner}, seed=4)
        world.step(60)
        then = world.poses
        world.reset()
        world.step(60)
        np.testing.assert_array_equal(world.poses, then)
        world.reset(parameters={"controllers.epuck_diffusion[d].params.velocity": "1 cm/s"})
        world.step()
        self.assertLessEqual(world.swarm.actuator("differential_steering").right.max(), 0.01)

    def test_a_controller_that_raises_stops_its_robot_by_name(self):
        class Bad(Turner):
            def step(self):
                if self.robot_id == "ep2":
                    raise ValueError("too bad")
                super().step()

            def __init__(self, robot, params):
                super().__init__(robot, params)
                self.robot_id = robot.id

        world = tandem.World(room(), controllers={"d": Bad})
        world.step(3)
        self.assertEqual(world.incidents["controllers_thrown"], 1)
        self.assertRegex(world.incidents["first"][0], "'ep2' threw at tick 0: ValueError: too bad")

    def test_a_controller_may_ask_for_listed_devices_only(self):
        class Wants(Turner):
            def __init__(self, robot, params):
                robot.sensor("proximty")

        with self.assertRaisesRegex(tandem.ExperimentError, "Did you mean 'proximity'"):
            tandem.World(room(), controllers={"d": Wants})

    def test_hooks_look_measure_and_end_the_run(self):
        calls = []

        class Hook:
            def __init__(self):
                self.steps = 0

            def before_run(self, world):
                calls.append(("before_run", world.tick))

            def after_step(self, world):
                self.steps += 1
                world.set_measure("steps", self.steps)

            def is_done(self, world):
                return self.steps >= 12

            def after_run(self, world):
                calls.append(("after_run", world.tick))

        world = tandem.World(room(), hooks=[Hook])
        self.assertEqual(world.run(), 12)
        self.assertEqual((world.measures, world.state), ({"steps": 12.0}, "done"))
        self.assertEqual(calls, [("before_run", 0), ("after_run", 12)])
        world.reset(9)
        world.step(3)
        self.assertEqual(world.measures, {"steps": 3.0})

    def test_a_hook_that_raises_ends_the_run(self):
        class Hook:
            def before_step(self, world):
                raise RuntimeError("no")

        world = tandem.World(room(), hooks=[Hook()])
        with self.assertRaisesRegex(tandem.RunFailed, "before_step at tick 0: RuntimeError: no"):
            world.step()
        self.assertEqual(world.state, "failed")

    def test_a_policy_that_raises_is_an_exception_of_step(self):
        def bad(swarm):
            swarm.actuator("differential_steering").left = np.zeros(3)

        world = tandem.World(room(), policies={"d": bad})
        with self.assertRaisesRegex(ValueError, "what is written has the shape"):
            world.step(10)
        self.assertEqual(world.tick, 1)

    def test_nothing_stays_of_worlds_that_are_gone(self):
        import gc
        import weakref

        alive = []

        class Seen(Turner):
            def __init__(self, robot, params):
                super().__init__(robot, params)
                alive.append(weakref.ref(self))

        world = tandem.World(room(), controllers={"d": Seen})
        world.step(3)
        del world
        gc.collect()
        self.assertEqual([one() for one in alive], [None] * 6)

    def test_a_hook_that_keeps_its_world_goes_with_it(self):
        import gc
        import weakref

        class Keeper:
            def before_step(self, world):
                self.world = world

        for as_class in (True, False):
            seen = []

            class Kept(Keeper):
                def __init__(self):
                    seen.append(weakref.ref(self))

            world = tandem.World(room(), hooks=[Kept if as_class else Kept()])
            world.step(3)
            self.assertIsNotNone(seen[0]())
            self.assertIs(seen[0]().world, world)
            del world
            gc.collect()
            self.assertIsNone(seen[0]())

    def test_a_hook_that_keeps_its_world_keeps_it_while_somebody_has_the_hook(self):
        import gc

        class Keeper:
            def before_step(self, world):
                self.world = world

        hook = Keeper()
        tandem.World(room(), hooks=[hook]).step(3)
        gc.collect()
        self.assertEqual(hook.world.tick, 3)
        hook.world.step(2)
        self.assertEqual(hook.world.tick, 5)


if __name__ == "__main__":
    unittest.main()
