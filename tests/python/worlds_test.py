"""Worlds: made, stepped, looked into as arrays, put back, begun anew."""

import json
import subprocess
import os
import sys
import tempfile
import unittest

import numpy as np

try:
    import h5py
except ImportError:  # a reader of HDF5 that is none of ours
    h5py = None

import tandem
from rooms import CONFIGS, DIFFUSION, FOOTBOTS, room

PROGRAM = os.environ["TANDEM_PROGRAM"]


def told(record):
    """What the command says of a record."""
    return subprocess.run([PROGRAM, "export", record], capture_output=True, text=True, check=True).stdout


VELOCITY = "controllers.epuck_diffusion[d].params.velocity"

# An e-puck's way in 0.1 s when told 5 cm/s: 388 steps a second, each of them trunc(10000 / 388) = 25 periods of 0.1 ms, and
# 1,000 steps to the turn of a wheel of 20.5 mm.
STEPPED_M = 0.1 * 10000 / (10000 // 388) / 1000 * 2 * np.pi * 0.0205


class Worlds(unittest.TestCase):
    def test_are_those_of_the_command(self):
        report = subprocess.run([os.environ["TANDEM_PROGRAM"], "run", DIFFUSION, "--seed", "7", "--set",
                                 "framework.experiment.length=10", "--quiet", "--report", "-"], capture_output=True, text=True)
        world = tandem.World(DIFFUSION, seed=7)
        world.run(until=10)
        self.assertEqual(report.returncode, 0, report.stderr)
        self.assertIn(f"{world.fingerprint:#018x}", report.stdout)

    def test_that_run_long_say_how_far_they_are(self):
        script = """import sys, time, tandem
class Slow:
    def before_step(self, world):
        time.sleep(0.05)
world = tandem.World(sys.argv[1], seed=1, hooks=[Slow])
world.run(until=6)
world.reset(seed=1)
world.run(until=6, progress=False)
"""
        ended = subprocess.run([sys.executable, "-c", script, DIFFUSION], capture_output=True, text=True)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertRegex(ended.stderr, r"^(run: \d+ %, about .* left\n)+$")

    def test_may_be_made_of_a_dictionary_or_a_text(self):
        one = tandem.World(room())
        other = tandem.World(tandem.to_xml(room()))
        one.run()
        other.run()
        self.assertEqual(one.fingerprint, other.fingerprint)
        self.assertEqual((one.tick, one.time, one.state), (200, 20.0, "finished"))
        self.assertEqual(one.ids, [f"ep{i}" for i in range(6)])

    def test_show_ports_as_arrays_that_follow_them(self):
        world = tandem.World(room(robots=600, side=8.0))  # three blocks
        swarm = world.swarm
        self.assertEqual(len(swarm), 600)
        distance = swarm.sensor("proximity").distance
        self.assertEqual((distance.dtype, distance.flags.writeable), (np.float32, False))
        before = distance.copy()
        world.step()
        self.assertFalse(np.array_equal(distance, before))
        self.assertTrue((swarm.sensor("proximity").validity == 2).all())
        self.assertIs(swarm.sensor("proximity").distance, distance)

    def test_have_arrays_as_wide_as_the_devices_of_their_robots(self):
        world = tandem.World(room(robots=3))
        swarm = world.swarm
        self.assertEqual(swarm.sensor("proximity").distance.shape, (3, 8))
        world = tandem.World(FOOTBOTS)
        swarm = world.swarm
        self.assertEqual(swarm.sensor("proximity").distance.shape, (len(swarm), 24))
        seen = []

        class Sees:
            def __init__(self, robot, params):
                seen.append((robot.sensor("proximity").distance.shape, robot.actuator("leds").rgb.shape))

            def step(self):
                pass

        tandem.World(room(robots=1), controllers={"d": Sees})
        self.assertEqual(seen, [((8,), (24,))])

    def test_have_their_robots_in_the_order_of_the_file(self):
        world = tandem.World(room(robots=300, side=8.0))
        swarm = world.swarm
        distance = swarm.sensor("proximity").distance
        for seed in (None, 8):
            if seed is not None:
                world.reset(seed)
            world.step(5)
            self.assertEqual(swarm.ids, [f"ep{i}" for i in range(300)])
            self.assertEqual(swarm.ids, world.ids)
            np.testing.assert_array_equal(swarm.poses, world.poses)
            self.assertEqual(world.pose("ep17"), tuple(swarm.poses[17]))
            # Readings are of the robots of their rows.
            apart = np.hypot(*(world.poses[:, None, :2] - world.poses[None, :, :2]).transpose(2, 0, 1)) + 9 * np.eye(300)
            alone = (apart.min(axis=1) > 0.3) & (abs(world.poses[:, :2]).max(axis=1) < 3.7)
            close = apart.min(axis=1) < 0.1
            self.assertTrue(alone.any() and close.any())
            self.assertTrue((distance[alone] > 0.09).all())
            self.assertLess(np.median(distance[close].min(axis=1)), 0.06)

    def test_give_each_robot_its_own_command(self):
        world = tandem.World(room(robots=300, side=8.0), driven=True)
        wheels = world.swarm.actuator("differential_steering")
        wheels.left = wheels.right = np.where(np.arange(300) == 17, 0.05, 0.0)
        before = world.poses
        world.step(1)
        self.assertEqual(np.flatnonzero((world.poses != before).any(axis=1)).tolist(), [17])

    def test_keep_commands_over_snapshots_and_hooks(self):
        seen = []

        class Writes:
            def before_step(self, world):
                wheels = world.swarm.actuator("differential_steering")
                seen.append(wheels.left[4])
                wheels.right[:] = 0.02

        world = tandem.World(room(robots=6), driven=True, hooks=[Writes])
        left, right = (getattr(world.swarm.actuator("differential_steering"), side) for side in ("left", "right"))
        left[4] = 0.01
        moment = world.snapshot()
        world.step(2)
        self.assertEqual((seen, right.tolist()), ([0.01, 0.01], [0.02] * 6))
        left[4] = 0.03
        world.restore(moment)
        self.assertEqual((left[4], right[4]), (0.01, 0.0))

    def test_take_commands_from_arrays(self):
        world = tandem.World(room(robots=300, side=8.0), driven=True)
        wheels = world.swarm.actuator("differential_steering")
        wheels.left = 0.05
        wheels.right[:] = 0.05
        before = world.swarm.poses
        world.step(1)
        moved = np.hypot(*(world.swarm.poses - before)[:, :2].T)
        self.assertAlmostEqual(np.median(moved), STEPPED_M, places=6)

    def test_limit_commands_as_controllers_are_limited(self):
        world = tandem.World(room(robots=4), driven="d")
        wheels = world.swarm.actuator("differential_steering")
        wheels.left = [50.0, np.nan, 0.0, 0.0]
        world.step()
        self.assertLess(wheels.left[0], 0.2)
        self.assertEqual(wheels.left[1], 0.0)
        self.assertEqual((world.incidents["commands_clamped"], world.incidents["commands_not_finite"]), (1, 1))

    def test_go_back_to_snapshots(self):
        world = tandem.World(FOOTBOTS)
        world.step(30)
        moment = world.snapshot()
        world.step(40)
        then = world.fingerprint
        world.restore(moment)
        self.assertEqual((world.tick, moment.tick), (30, 30))
        world.step(40)
        self.assertEqual(world.fingerprint, then)

    def test_begin_anew_as_new_worlds_would(self):
        world = tandem.World(FOOTBOTS, seed=1)
        distance = world.swarm.sensor("proximity").distance
        world.step(20)
        world.reset(5)
        new = tandem.World(FOOTBOTS, seed=5)
        world.step(30)
        new.step(30)
        self.assertEqual(world.fingerprint, new.fingerprint)
        np.testing.assert_array_equal(distance, new.swarm.sensor("proximity").distance)  # the same memory as ever

    def test_write_records_that_the_command_reads(self):
        with tempfile.TemporaryDirectory() as folder:
            first, second, third = (os.path.join(folder, f"{n}.record") for n in ("first", "second", "third"))
            world = tandem.World(DIFFUSION, seed=7, record=first, parameters={"framework.experiment.length": 10})
            world.run()
            self.assertFalse(os.path.exists(first + ".part"))
            world.reset(8, record=second)
            world.step(40)
            moment = world.snapshot()
            world.step(20)
            world.restore(moment)  # the branch of 20 ticks is left
            world.step(5)
            world.reset(9, record=third)
            world.close()
            self.assertIn("ticks 0 to 99, 100 of them, 50 rows each", told(first))
            self.assertIn("seed 7", told(first))
            self.assertIn("ticks 0 to 44, 45 of them", told(second))
            self.assertIn("interrupted", told(second))
            self.assertIn("seed 9", told(third))
            repeated = subprocess.run([PROGRAM, "run", DIFFUSION, "--seed", "7", "--repeat", first, "--seconds", "10"],
                                      capture_output=True, text=True)
            self.assertEqual(repeated.returncode, 0, repeated.stderr)

    def test_are_in_their_records_as_arrays(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "run.record")
            world = tandem.World(FOOTBOTS, seed=3, record=path, parameters={"record.ports": "proximity"})
            poses, times = [], []
            for _ in range(20):
                world.step()
                poses.append(world.poses)
                times.append(world.time)
            last = world.picture(size=300).svg
            world.finish()
            record = tandem.Record(path)
            pose = record["pose"]
            self.assertEqual(sorted(pose["ids"]), sorted(world.ids))
            rows = [pose["ids"].index(one) for one in world.ids]
            np.testing.assert_allclose(pose["time"], times)
            np.testing.assert_array_equal(pose["tick"], np.arange(20))
            np.testing.assert_allclose(np.stack([pose["x"], pose["y"]], axis=2)[:, rows], np.array(poses)[:, :, :2], atol=1e-6)
            some = record.table("sensor proximity", fields=["distance"], entities=[world.ids[1]], first=4, last=9, every=2)
            self.assertEqual((some["distance"].shape, some["ids"]), ((3, 1, 24), [world.ids[1]]))
            self.assertEqual(set(some), {"distance", "ids", "tick", "time"})
            self.assertEqual((record.name, record.seed, record.cut, record.damage), (world.name, 3, False, []))
            self.assertEqual(record.picture(size=300).svg.count("<"), last.count("<"))
            self.assertNotEqual(record.picture(time=0.5, size=300).svg, record.picture(size=300).svg)
            with self.assertRaisesRegex(ValueError, "has no table 'poses'; it has .*'pose'"):
                record["poses"]
            with self.assertRaisesRegex(ValueError, "nowhere"):
                tandem.Record("/nowhere/run.record")

    @unittest.skipUnless(h5py, "no python3-h5py here")
    def test_have_the_same_tables_in_python_as_in_the_hdf5_file_of_their_record(self):
        with tempfile.TemporaryDirectory() as folder:
            path, exported = (os.path.join(folder, name) for name in ("run.record", "run.h5"))
            world = tandem.World(FOOTBOTS, seed=3, record=path, parameters={"record.ports": "*"})
            world.step(10)
            moment = world.snapshot()
            world.step(5)
            world.restore(moment)  # the branch of 5 ticks is left
            world.step(4)
            world.finish()
            chosen = {"entities": [world.ids[1]], "first": 2, "last": 11, "every": 3}
            for options, of_python in ([], {}), (["--entities", world.ids[1], "--from", "2", "--until", "11", "--every", "3"], chosen):
                subprocess.run([PROGRAM, "export", path, "--hdf5", exported, *options], check=True)
                with h5py.File(exported) as file:
                    record = tandem.Record(path)
                    here = {title.replace(" ", "/"): title for title in record}
                    groups = {}

                    def note(name, item):
                        if isinstance(item, h5py.Dataset):
                            group, field = name.rsplit("/", 1)
                            groups.setdefault(group, {})[field] = item

                    file.visititems(note)
                    groups.pop("events")
                    self.assertLessEqual(set(groups), set(here))
                    self.assertIn("sensor/proximity", groups)
                    for group, sets in groups.items():
                        table = record.table(here[group], **of_python)
                        self.assertEqual(set(table), set(sets), group)
                        self.assertEqual(list(table["ids"]), list(sets["ids"].asstr()[:]), group)
                        for name in set(sets) - {"ids"}:
                            self.assertEqual(table[name].dtype, sets[name].dtype, f"{group}/{name}")
                            np.testing.assert_array_equal(table[name], sets[name][:], f"{group}/{name}")

    def test_say_where_a_record_cannot_be(self):
        with self.assertRaisesRegex(tandem.ExperimentError, "nowhere"):
            tandem.World(DIFFUSION, record="/nowhere/run.record")

    def test_have_the_parts_that_their_experiment_names(self):
        def joined(what):
            return tandem.World(DIFFUSION, plugins=["test_trouble"], parameters={"run.joiner.at": 3, "run.joiner.what": what})
        world = joined("end")
        self.assertEqual((world.step(10), world.tick, world.state), (3, 3, "done"))
        with self.assertRaisesRegex(tandem.RunFailed, "part 'joiner', before_tick: cannot go on"):
            joined("before").step(10)
        with self.assertRaisesRegex(tandem.RunFailed, "part 'joiner', join: will not join"):
            joined("join")
        world = joined("finish")
        with self.assertRaisesRegex(tandem.RunFailed, "part 'joiner', finish: cannot let go"):
            world.run()
        world.reset(1)
        self.assertEqual(world.step(2), 2)

    def test_begin_anew_with_other_parameters(self):
        world = tandem.World(room(), seed=1)
        world.step(20)
        world.reset(2, {VELOCITY: "2 cm/s", "framework.experiment.length": 3})
        new = tandem.World(room(), seed=2, parameters={VELOCITY: "2 cm/s"})
        self.assertEqual(world.run(), 30)
        new.step(30)
        self.assertEqual(world.fingerprint, new.fingerprint)
        world.reset(2, {})  # as it was made
        world.step(30)
        self.assertNotEqual(world.fingerprint, new.fingerprint)

    def test_are_independent_of_each_other(self):
        worlds = [tandem.World(room(), seed=i) for i in range(5)]
        group = tandem.Group(worlds, threads=2)
        group.step(50)
        for seed, world in enumerate(worlds):
            alone = tandem.World(room(), seed=seed)
            alone.step(50)
            self.assertEqual(world.fingerprint, alone.fingerprint)

    def test_are_the_same_for_any_number_of_threads(self):
        one, two = (tandem.World(room(robots=600, side=8.0), threads=n) for n in (0, 3))
        one.step(30)
        two.step(30)
        self.assertEqual(one.fingerprint, two.fingerprint)

    def test_show_robots_that_come_and_go(self):
        world = tandem.World(room(robots=300, side=6.0), driven=True)
        swarm = world.swarm
        start = world.snapshot()
        left = swarm.actuator("differential_steering").left
        world.remove_robot("ep3")
        world.set_pose("ep4", *world.pose("ep4"))
        row = swarm.ids.index("ep5")
        x, y, _ = world.pose("ep5")
        world.remove_robot("ep5")
        world.step()
        world.add_robot("new", "d", x, y)
        world.add_robot("newer", "d", *next(p[:2] for p in np.mgrid[-2.8:2.8:0.2, -2.8:2.8:0.2].reshape(2, -1).T
                                            if np.hypot(*(world.poses[:, :2] - p).T).min() > 0.15))
        self.assertEqual((len(world.ids), world.swarms[0].alive.sum(), len(swarm), len(left)), (300, 300, 300, 300))
        far = [p for p in np.mgrid[-2.8:2.8:0.2, -2.8:2.8:0.2].reshape(2, -1).T if np.hypot(*(world.poses[:, :2] - p).T).min() > 0.15]
        world.add_robot("newest", "d", *far[0])  # there is no row left
        self.assertEqual([len(one) for one in world.swarms], [300, 1])
        late = world.swarms[1].actuator("differential_steering")
        late.left = late.right = 0.05
        left[row] = 0.01
        world.step()
        self.assertAlmostEqual(world.pose("newest")[0], far[0][0] + STEPPED_M)
        gone = world.swarms[1]
        world.restore(start)
        late.left = 0.02  # memory of nobody, still there
        with self.assertRaisesRegex(RuntimeError, "are gone"):
            gone.poses
        self.assertEqual(len(world.swarms), 1)

    def test_show_themselves(self):
        world = tandem.World(room())
        self.assertIn("<svg", world._repr_svg_())
        self.assertEqual(world.picture(size=200).png()[:4], b"\x89PNG")
        pixels = world.picture(size=300).pixels()
        self.assertEqual((pixels.dtype, pixels.shape[2]), (np.uint8, 3))
        self.assertEqual(pixels[0, 0].tolist(), [255, 255, 255])
        self.assertIn("<experiment", world.settings)
        self.assertIn("6 robots", repr(world))

    def test_show_what_controllers_publish(self):
        world = tandem.World(os.path.join(CONFIGS, "footbot_foraging.xml"))
        world.step(3)
        swarm = world.swarms[0]
        for name in swarm.published_names:
            self.assertEqual(len(swarm.published(name)), len(swarm))

    def test_give_up_with_all_problems_of_a_file(self):
        wrong = room()
        wrong["arena"]["distribute"]["entity"]["quantty"] = 3
        wrong["controllers"]["epuck_diffusion"]["params"]["velocty"] = 3
        with self.assertRaisesRegex(tandem.ExperimentError, "Did you mean 'quantity'"):
            tandem.World(wrong)


if __name__ == "__main__":
    unittest.main()
