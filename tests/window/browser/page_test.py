"""The page in a real browser, joined to the real program: loads, draws, plays, goes back, is touched.

  python3 page_test.py PROGRAM [options of unittest]

TANDEM_SCREENSHOTS=FOLDER writes the pictures of the documentation there; TANDEM_RENEW_PICTURES=1 renews those that are compared with.
"""
import glob
import json
import math
import os
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

from frames import EXPERIMENT
from page import HERE, Keys, Page, Run, difference, eventually, read_ppm, write_ppm

PROGRAM = os.path.abspath(sys.argv[1]) if len(sys.argv) > 1 else ""
ARENA = os.path.join(HERE, "arena.xml")
ROOT = os.path.abspath(os.path.join(HERE, "..", "..", ".."))
GROUND = (245, 244, 240)


def view(experiment, *options, **more):
    return Run(PROGRAM, "view", experiment, "--no-browser", *options, **more)


def far(color, other):
    return max(abs(a - b) for a, b in zip(color, other))


class WithBrowser(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.page = Page()
        cls.addClassCleanup(cls.page.close)

    def tick(self):
        return self.page.js("tandem.world.tick")

    def go_to(self, tick):
        answer = self.page.ask({"do": "go_to", "tick": tick})
        self.assertTrue(answer["ok"], answer)
        self.page.until(f"tick {tick}", "tandem.world.frame.tick === arguments[0]", tick)

    def walk_to(self, tick):
        """Steps until so many ticks are done."""
        answer = self.page.ask({"do": "step", "ticks": tick - self.tick()})
        self.assertTrue(answer["ok"], answer)
        self.page.until(f"tick {tick}", "tandem.world.frame.tick === arguments[0]", tick)

    def poses(self):
        return self.page.js("Object.fromEntries(tandem.world.members.ids.map((id) => [id, tandem.world.poseOf(id)]))")


class TestRun(WithBrowser):
    """One run for all; each test starts it anew."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.run_ = view(ARENA, "--paused")
        cls.addClassCleanup(cls.run_.stop)

    def setUp(self):
        self.page.open(self.run_.address)
        self.page.until("the link", "tandem.connection.isOpen")
        answer = self.page.ask({"do": "reset", "seed": 5})
        self.assertTrue(answer["ok"], answer)
        self.page.until("the start", "tandem.world.frame && tandem.world.frame.tick === 0 && tandem.world.state.paused")

    def tearDown(self):
        self.assertEqual(self.page.errors(), [])

    def test_draws_robots_where_they_are(self):
        page = self.page
        self.assertEqual(sorted(page.js("tandem.world.members.ids")), ["ep1", "ep2"])
        pose = page.js("tandem.world.poseOf('ep1')")
        self.assertAlmostEqual(pose["x"], 0.4, 3)
        self.assertAlmostEqual(pose["y"], 0.3, 3)
        self.assertGreater(far(page.pixel(*page.place("ep1")), GROUND), 40)
        self.assertLess(far(page.pixel(*page.floor_at(0.13, -0.27)), GROUND), 12)
        self.assertGreater(far(page.pixel(*page.floor_at(-0.4, -0.5)), GROUND), 40, "the crate")

    def test_a_picture_from_the_top_is_the_one_that_is_kept(self):
        page = self.page
        page.press("th")
        page.until("the top view", "tandem.camera.isTop")
        picture = page.pixels(96, 64)
        kept = os.path.join(HERE, "pictures", "top.ppm")
        if os.environ.get("TANDEM_RENEW_PICTURES"):
            os.makedirs(os.path.dirname(kept), exist_ok=True)
            write_ppm(kept, picture)
        self.assertLess(difference(picture, read_ppm(kept)), 0.02)
        page.js("tandem.colors.set('kind')")  # colours are another matter than shapes
        page.ask({"do": "move", "robot": "ep1", "x": 0.1, "y": -0.6})
        page.until("the move", "Math.abs(tandem.world.poseOf('ep1').y + 0.6) < 0.01")
        self.assertGreater(difference(page.pixels(96, 64), picture), 0.0003, "it sees a robot that is elsewhere")

    def test_plays_and_pauses_by_key(self):
        page = self.page
        page.press(" ")
        page.until("ticks", "tandem.world.frame.tick > 5")
        page.press(" ")
        page.until("the pause", "tandem.world.state.paused && tandem.world.state.tick === tandem.world.frame.tick")
        tick = self.tick()
        page.press(".")
        page.until("one tick more", "tandem.world.frame.tick === arguments[0]", tick + 1)
        self.assertTrue(page.js("tandem.world.state.paused"))

    def test_goes_back_to_the_same_and_on_from_there(self):
        page = self.page
        self.walk_to(40)
        self.go_to(25)
        there, picture = self.poses(), page.pixels()
        self.go_to(3)
        self.assertNotEqual(self.poses(), there)
        self.assertIn("Looking back", page.find(".timeline-why").text)
        page.press(Keys.END)
        page.until("the newest tick", "tandem.world.frame.tick === 40")
        self.go_to(25)
        self.assertEqual(self.poses(), there)
        self.assertLess(difference(page.pixels(), picture), 1e-5, "not the same picture: more than some pixels on edges differ")
        self.walk_to(45)
        self.assertEqual(page.js("tandem.world.state.latest"), 45)

    def test_the_bar_chooses_a_tick(self):
        page = self.page
        self.walk_to(30)
        page.find(".bar input").send_keys(Keys.HOME)
        page.until("the first tick", "tandem.world.frame.tick === 0")
        page.find(".bar input").send_keys(Keys.ARROW_RIGHT * 4)
        page.until("the fourth", "tandem.world.frame.tick === 4")

    def test_a_click_chooses_a_robot_and_shows_its_inside(self):
        page = self.page
        page.click_in_picture(*page.place("ep2"))
        page.until("the choice", "tandem.selection.last === 'ep2'")
        page.until("its ports", "document.querySelectorAll('article.robot[data-robot=ep2] .port').length > 2")
        text = page.find("article.robot").text
        for word in ("proximity", "differential_steering", "parameters"):
            self.assertIn(word, text)
        page.js("tandem.selection.choose('ep1', true)")
        page.until("two side by side", "document.querySelectorAll('article.robot').length === 2")

    def test_a_field_is_plotted_with_its_past(self):
        page = self.page
        self.walk_to(20)
        page.press("n")
        value = 'article.robot button.value[data-field="pose.pose.y.0"]'
        page.until("its place", "document.querySelector(arguments[0])", value)
        page.find(value).click()
        page.find(".menu button").click()
        page.until("a value", "tandem.plots.list.length === 1 && tandem.plots.list[0].series.size === 1")
        self.walk_to(30)
        page.until("values as they come", "[...tandem.plots.list[0].series.values()][0].ticks.includes(30)")
        page.js("tandem.plots.loadPast()")
        page.until("the past", "[...tandem.plots.list[0].series.values()][0].ticks[0] === 0")
        values = page.js("[...tandem.plots.list[0].series.values()][0].values")
        self.assertAlmostEqual(values[0], 0.3, 6)
        self.assertGreater(values[-1], 0.3, "it drove north")

    def test_a_condition_stops_the_run(self):
        page = self.page
        page.press("n")
        value = 'article.robot button.value[data-field="pose.pose.y.0"]'
        page.until("its place", "document.querySelector(arguments[0])", value)
        page.find(value).click()
        page.find(".menu button:nth-child(2)").click()
        page.js("(document.querySelector('.stop select').value = '>', document.querySelector('.stop input[type=number]').value = 0.34)")
        self.addCleanup(page.ask, {"do": "stop_when", "clear": True})  # else it stops the runs of the other tests
        page.find(".stop button.main").click()
        page.until("it is set", "document.querySelector('.stop').hidden")
        page.ask({"do": "play", "speed": None})
        page.until("the stop", "tandem.world.state.paused && tandem.world.state.stopped_by")
        page.until("where it stopped", "tandem.world.frame.tick === tandem.world.state.tick")  # it may come behind the state
        self.assertGreater(page.js("tandem.world.poseOf('ep1').y"), 0.34)

    def test_a_robot_is_dragged_and_the_drag_undone(self):
        page = self.page
        page.press("tm")
        page.until("the mode", "tandem.touch.on && tandem.camera.isTop")
        page.drag_in_picture(page.place("ep1"), page.floor_at(0.5, -0.4))
        page.until("the move", "Math.hypot(tandem.world.poseOf('ep1').x - 0.5, tandem.world.poseOf('ep1').y + 0.4) < 0.02")
        page.press("u")
        page.until("the undo", "Math.hypot(tandem.world.poseOf('ep1').x - 0.4, tandem.world.poseOf('ep1').y - 0.3) < 0.002")

    def test_a_drag_into_a_wall_is_refused_with_the_reason(self):
        page = self.page
        page.press("tm")
        page.until("the mode", "tandem.touch.on && tandem.camera.isTop")
        page.drag_in_picture(page.place("ep1"), page.floor_at(0.95, 0.3))
        page.until("the reason", "document.querySelector('.toast.error')")
        self.assertAlmostEqual(page.js("tandem.world.poseOf('ep1').x"), 0.4, 3)

    def test_objects_are_dragged_and_lamps_switched(self):
        page = self.page
        page.press("tm")
        page.until("the mode", "tandem.touch.on && tandem.camera.isTop")
        page.drag_in_picture(page.floor_at(-0.4, -0.5), page.floor_at(0.2, -0.5))
        crate = "tandem.world.scene.objects.find((o) => o.id === 'crate')"
        page.until("the move", f"Math.abs({crate}.x - 0.2) < 0.03")
        page.press("m")
        page.js("tandem.touch.choose({ light: 'lamp' })")
        page.until("its switch", "document.querySelector('.thing button')")
        page.find(".thing button").click()
        page.until("the dark", "tandem.world.scene.lights[0].intensity === 0")

    def test_robots_are_added_halted_and_removed(self):
        page = self.page
        page.js("tandem.touch.element.open = true")
        page.find("#touch form.add button.main").click()
        page.until("a third robot, chosen", "tandem.world.members.count === 3 && tandem.selection.last && !['ep1', 'ep2'].includes(tandem.selection.last)")
        page.press("x")
        page.until("the halt", "tandem.world.halted.size === 1")
        page.js("tandem.touch.remove({ robot: tandem.selection.last })")
        page.until("two again", "tandem.world.members.count === 2")

    def test_layers_are_drawn_when_they_are_switched_on(self):
        page = self.page
        self.assertIn("proximity", page.js("tandem.layers.layers.map((layer) => layer.name)"))
        self.walk_to(3)  # sensors have sensed
        page.find("[data-layer=proximity]").click()
        page.until("rays", "tandem.layers.segmentsShown > 0")
        page.find("[data-layer=proximity]").click()
        page.until("none", "tandem.layers.segmentsShown === 0")

    def test_everything_goes_by_keys(self):
        page = self.page
        page.press("?")
        page.until("the help", "document.querySelector('dialog.help').open")
        page.press(Keys.ESCAPE)
        page.until("no help", "!document.querySelector('dialog.help').open")
        page.press("n")
        page.until("the first robot", "tandem.selection.last === 'ep1'")
        page.press("n")
        page.until("the second", "tandem.selection.last === 'ep2'")
        page.press("f")
        page.until("following", "tandem.camera.followed === 'ep2'")
        distance = page.js("tandem.camera.distance")
        page.press("+")
        page.until("nearer", "tandem.camera.distance < arguments[0]", distance)
        page.press("m" + Keys.ARROW_RIGHT)
        page.until("a nudge", "Math.abs(tandem.world.poseOf('ep2').x + 0.29) < 0.002")
        page.press("m/ep1" + Keys.ENTER + Keys.ESCAPE)
        page.until("found by its id", "tandem.selection.last === 'ep1'")
        nameless = page.js("""[...document.querySelectorAll('button, input, select')].filter((e) => !e.closest('[hidden]')
            && !(e.getAttribute('aria-label') || e.title || e.textContent.trim() || e.closest('label')?.textContent.trim())).map((e) => e.outerHTML)""")
        self.assertEqual(nameless, [])
        # The whole page is reached by the tabulator, and its focus is seen.
        seen = set()
        page.js("document.activeElement.blur()")
        for _ in range(80):
            page.press(Keys.TAB)
            if page.js("document.activeElement === document.body"):
                continue
            seen.add(page.js("document.activeElement.id || document.activeElement.getAttribute('aria-label') || document.activeElement.textContent"))
            outline = page.js("getComputedStyle(document.activeElement).outlineStyle")
            self.assertNotEqual(outline, "none", page.js("document.activeElement.outerHTML"))
            if {"view", "find", "Tick"} <= seen:
                break
        self.assertTrue({"view", "find", "Tick"} <= seen, seen)

    def test_near_robots_are_made_of_their_parts_and_far_ones_of_fewer(self):
        page = self.page
        triangles = []
        for distance in (0.4, 3.0, 12.0, 60.0):
            page.js("(tandem.camera.lookAt(tandem.world.poseOf('ep1'), 1e9), tandem.camera.distance = arguments[0], tandem.camera.place(), tandem.view.render())", distance)
            triangles.append(page.js("tandem.robots.shown.triangles"))
        self.assertEqual(page.js("tandem.robots.shown.coarse"), 2, "two discs")
        self.assertEqual(triangles, sorted(triangles, reverse=True))
        self.assertGreater(triangles[0], 1500)
        self.assertLess(triangles[2], 500)
        links = page.js("tandem.world.body(0).look.links")
        wheels = [link for link in links if link["shape"] == "wheel"]
        self.assertAlmostEqual(max(link["high"][2] for link in wheels), 0.041, 6, "an e-puck's wheels are 41 mm high")

    def test_things_throw_shadows_away_from_the_sun(self):
        page = self.page
        page.press("t")
        page.until("the top view", "tandem.camera.isTop")
        pose = page.js("tandem.world.poseOf('ep1')")
        behind, before = (pose["x"] - 0.045, pose["y"] + 0.05), (pose["x"] + 0.07, pose["y"] - 0.075)
        self.assertGreater(far(page.pixel(*page.floor_at(*behind)), GROUND), 30, "north-west of it")
        self.assertLess(far(page.pixel(*page.floor_at(*before)), GROUND), 12)

    def test_a_wall_before_the_arena_is_cut_away(self):
        page = self.page
        page.js("(tandem.camera.goHome(), tandem.camera.orbit(0, -0.35))")
        inside = page.floor_at(0.2, -0.75)  # behind the wall in the south, which is 20 cm high
        self.assertLess(sum(abs(a - b) for a, b in zip(page.pixel(*inside), GROUND)), 150)
        page.js("(tandem.scene.boxes.material.uniforms.cut.value = 0, tandem.scene.update = () => {})")
        self.assertGreater(sum(abs(a - b) for a, b in zip(page.pixel(*inside), GROUND)), 150)

    def test_late_frames_drop_something_and_say_so(self):
        page = self.page
        page.js("tandem.view.quality.pin(false)")
        note = "Array.from({ length: arguments[2] }, (_, i) => tandem.view.quality.note(arguments[0], arguments[1] + i * arguments[0]))"
        page.js(f"(tandem.view.invalidate = tandem.view.render = () => {{}}, tandem.view.quality.start(), {note})", 90, 0, 72)
        text = page.js("document.getElementById('dropped').textContent")
        self.assertIn("shadows", text)
        self.assertFalse(page.js("document.getElementById('dropped').hidden"))
        dropped = page.js("tandem.view.quality.dropped")
        page.js(note, 10, 1e5, 12)
        self.assertEqual(page.js("tandem.view.quality.dropped"), dropped - 1, "it comes back when there is time")
        page.js("tandem.view.quality.pin(true)")
        self.assertTrue(page.js("document.getElementById('dropped').hidden"))

    def test_a_still_picture_is_drawn_once_more_with_smooth_edges(self):
        page = self.page
        page.until("twice the pixels", "tandem.view.pixelRatio === 2")
        page.js("(tandem.view.afterPicture.push(() => { window.ratioOfMoved = tandem.view.pixelRatio; }), tandem.camera.orbit(0.1, 0))")
        page.until("as many as the screen while it moves", "window.ratioOfMoved === 1")

    def test_colours_say_the_kind_or_how_dense_robots_stand(self):
        page = self.page
        page.js("tandem.colors.set('kind')")
        self.assertIn("e-puck", page.find("#legend").text)
        page.js("tandem.colors.set('density')")
        page.until("its legend", "document.getElementById('legend').textContent.startsWith('robots per m²')")
        page.press("c")
        self.assertEqual(page.js("tandem.colors.mode"), "led")
        self.assertTrue(page.js("document.getElementById('legend').hidden"))

    def test_names_stand_beside_each_other_and_once(self):
        page = self.page
        answer = page.ask({"do": "move", "robot": "ep2", "x": 0.4, "y": 0.2})
        self.assertTrue(answer["ok"], answer)
        page.js("(tandem.selection.choose('ep1'), tandem.selection.choose('ep2', true))")
        page.find("[data-layer=ids]").click()
        page.until("the layer's names", "[...tandem.layers.texts.values()].some((texts) => texts.length === 2)")
        page.js("tandem.view.render()")
        boxes = page.js("tandem.view.pen.taken.map((box) => ({ box: [...box], text: box.text }))")
        self.assertEqual(sorted(b["text"] for b in boxes), ["ep1", "ep2"])
        (a, b) = (b["box"] for b in boxes)
        self.assertFalse(a[0] < b[2] and a[2] > b[0] and a[1] < b[3] and a[3] > b[1], boxes)
        page.find("[data-layer=ids]").click()

    def test_layers_of_sensors_that_no_robot_has_are_folded_away(self):
        page = self.page
        folded = "document.querySelector('#layers details [data-layer=' + arguments[0] + ']') !== null"
        self.assertTrue(page.js(folded, "cameras"))
        self.assertFalse(page.js(folded, "proximity"))

    def test_starts_anew_with_another_seed(self):
        page = self.page
        self.walk_to(10)
        page.press("R")
        page.until("the question", "document.querySelector('#reset-seed')")
        page.js("(document.querySelector('#reset-seed').value = 77)")
        page.find("dialog[open] button.main").click()
        page.until("the start", "tandem.world.state.seed === 77 && tandem.world.frame.tick === 0")

    def test_without_webgl_there_is_a_plain_picture(self):
        page = self.page
        page.open(self.run_.address + "&flat=1")
        self.assertGreater(far(page.pixel(*page.place("ep1")), GROUND), 40)
        self.assertLess(far(page.pixel(*page.floor_at(0.13, -0.27)), GROUND), 12)

    def test_a_tablet_and_the_dark_have_room(self):
        page = self.page
        page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": "dark"}]})
        page.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 768, "height": 1024, "deviceScaleFactor": 1, "mobile": True})
        try:
            page.open(self.run_.address)
            page.until("the width", "tandem.camera.width_px === 768")
            self.assertLess(sum(page.pixel(*page.floor_at(0.13, -0.27))), 250)
            self.assertLessEqual(page.js("document.scrollingElement.scrollWidth"), 768)
            self.assertTrue(page.js("document.getElementById('left').hidden"))
            page.screenshot("window_tablet.png")
        finally:
            page.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
            page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})


class TestLimits(unittest.TestCase):
    def test_a_picture_costs_no_more_than_the_documentation_says(self):
        folder = tempfile.mkdtemp(prefix="tandem-limits-")
        path = os.path.join(folder, "many.xml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(EXPERIMENT.format(size=20, half=9.7, robots=1000))
        run = view(path, "--paused")
        self.addCleanup(run.stop)
        page = Page(800, 600)
        self.addCleanup(page.close)
        page.open(run.address)
        page.js("tandem.camera.orbit(0.3, 0)")
        most = 0
        for nearer in (1.0, 0.6, 0.6, 0.6, 0.6):
            cost = page.js("(tandem.camera.zoom(arguments[0]), tandem.view.render(), tandem.view.renderer.info.render)", nearer)
            most = max(most, page.js("tandem.robots.shown.full"))
            self.assertLessEqual(cost["calls"], 12 + 6)  # one kind, no lamp
            self.assertLessEqual(cost["triangles"], 700_000)
        self.assertGreater(most, 100)


class TestLink(WithBrowser):
    def test_a_wrong_token_is_named(self):
        run = view(ARENA, "--paused")
        self.addCleanup(run.stop)
        page = self.page
        page.driver.get(run.address[:-4] + "0000")
        page.until("the reason", "!document.getElementById('banner').hidden && document.getElementById('banner').textContent.includes('token')")
        page.errors()  # the browser itself complains of the refusal

    def test_a_run_that_ends_is_told_and_a_new_one_is_found(self):
        run = view(ARENA, "--paused")
        page = self.page
        page.open(run.address)
        self.assertEqual(run.stop(), 0)
        page.until("the end", "!document.getElementById('banner').hidden && document.body.classList.contains('unlinked')")
        again = view(ARENA, "--paused", "--port", run.port)
        self.addCleanup(again.stop)
        page.until("the new one, which has another token", "document.getElementById('banner').textContent.includes('token')")
        page.errors()


class TestRecord(WithBrowser):
    def test_a_record_is_looked_at_like_a_run(self):
        page = self.page
        run = view(ARENA, "--paused", "--record", "run.rec")
        page.open(run.address)
        self.walk_to(30)
        there = self.poses()
        self.assertEqual(run.stop(), 0)
        record = view("run.rec", "--paused", folder=run.folder)
        self.addCleanup(record.stop)
        page.errors()
        page.open(record.address)
        self.assertEqual(page.js("tandem.world.hello.mode"), "record")
        self.assertEqual(sorted(page.js("tandem.world.members.ids")), ["ep1", "ep2"])
        latest = page.js("tandem.world.state.latest")
        self.go_to(latest)
        here = self.poses()
        for robot, was in there.items():
            self.assertAlmostEqual(was["x"], here[robot]["x"], 2)
            self.assertAlmostEqual(was["y"], here[robot]["y"], 2)
        self.go_to(10)
        page.press(" ")
        page.until("it plays", "tandem.world.frame.tick > 12")
        self.assertEqual(page.errors(), [])


class TestReal(WithBrowser):
    def test_the_emergency_stop_holds_a_real_robot_until_it_is_armed(self):
        page = self.page
        folder = tempfile.mkdtemp(prefix="tandem-window-")
        robot = subprocess.Popen([PROGRAM, "emulate", "epuck", "--link", "pty:ep0"], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                 stderr=subprocess.DEVNULL)
        self.addCleanup(robot.wait)
        self.addCleanup(robot.terminate)
        eventually("the emulated robot", lambda: os.path.lexists(os.path.join(folder, "ep0")))
        run = view(os.path.join(ROOT, "configs", "epuck_mixed.xml"), "--set", "framework.experiment.length=0", folder=folder)
        self.addCleanup(run.stop)
        page.open(run.address)
        state = "(tandem.real.states.get('ep0') || {})"
        page.until("its state", f"{state}.driving === true")
        self.assertEqual(page.js("[...tandem.world.members.real].map((i) => tandem.world.members.ids[i])"), ["ep0"])
        page.screenshot("window_mixed.png")
        page.press(" ")
        page.until("the pause", f"tandem.world.state.paused && {state}.state === 'paused'")
        tick = page.js("tandem.world.state.tick")
        page.press(" ")
        page.until("it goes on", f"tandem.world.state.tick > arguments[0] && {state}.driving === true", tick)
        page.find("#real .row button").click()
        page.until("what is in the way", "document.querySelectorAll('dialog[open] .preflight tr').length > 4")
        page.screenshot("window_preflight.png")
        page.find("dialog[open] button.main").click()
        page.js("tandem.real.openReplace('ep0')")
        page.until("who comes", "document.querySelector('dialog[open] form')")
        page.find("dialog[open] button[type=button]").click()
        page.press("e")
        page.until("the stop", f"{state}.driving === false && tandem.real.stop.classList.contains('on')")
        page.find("#real .row button:nth-child(2)").click()
        page.until("it drives again", f"{state}.driving === true")
        self.assertEqual(page.errors(), [])


class TestFirstMotion(WithBrowser):
    def test_one_robot_of_a_held_run_turns_when_told_and_the_panel_says_how(self):
        page = self.page
        folder = tempfile.mkdtemp(prefix="tandem-window-")
        log = os.path.join(folder, "robot.log")
        robot = subprocess.Popen([PROGRAM, "emulate", "epuck", "--link", "pty:ep0", "--log", log], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                 stderr=subprocess.DEVNULL)
        self.addCleanup(robot.wait)
        self.addCleanup(robot.terminate)
        eventually("the emulated robot", lambda: os.path.lexists(os.path.join(folder, "ep0")))
        run = view(os.path.join(ROOT, "configs", "epuck_mixed.xml"), "--paused", "--set", "framework.experiment.length=0", folder=folder)
        self.addCleanup(run.stop)
        page.open(run.address)
        page.until("its button", "document.querySelector('[data-key=\"ep0 move\"]')")

        def wheels():
            with open(log) as lines:
                return [(event["left"], event["right"]) for event in map(json.loads, lines) if event.get("event") == "wheels"]

        def ask():
            page.js("document.querySelector('[data-key=\"ep0 move\"]').click()")
            page.until("what will move", "(document.querySelector('dialog[open]') || {textContent: ''}).textContent.includes(\"'ep0' turns on the spot\")")

        ask()
        page.find("dialog[open] button[type=button]").click()
        page.until("no dialog", "document.querySelector('dialog[open]') === null")
        self.assertEqual([w for w in wheels() if w != (0, 0)], [], "nobody said yes")
        for attempt in range(3):  # on a busy machine the robot may answer too late to be moved; a person tries again then
            ask()
            page.find("dialog[open] button.main").click()
            page.until("the emergency stop is not covered", "document.querySelector('dialog[open]') === null")
            page.until("a verdict", "document.querySelector('.motion.ok, .motion.fail, .motion.warn')")
            if page.js("document.querySelector('.motion.ok') !== null"):
                break
        self.assertRegex(page.js("document.querySelector('.motion').textContent"), r"moved as told: turned \d.* deg by .*wheels")
        page.screenshot("window_first_motion.png")
        moved = [w for w in wheels() if w != (0, 0)]
        self.assertTrue(moved)
        self.assertEqual([w for w in moved if w[0] != -w[1]], [], "it turns on the spot")
        self.assertEqual(wheels()[-1], (0, 0), "and stands")
        self.assertEqual(page.js("tandem.world.state.tick"), 0)
        self.assertTrue(page.ask({"do": "play"})["ok"])
        page.until("the run", "tandem.world.state.tick > 3 && document.querySelector('[data-key=\"ep0 move\"]') === null")
        self.assertIn("the run has begun", page.ask({"do": "first_motion", "robot": "ep0"})["error"])
        self.assertEqual(page.errors(), [])


class TestProjector(WithBrowser):
    """The virtual world on the floor: four clicks, and each corner of the arena is where it was clicked."""

    CORNERS = [(220, 130), (1010, 90), (1120, 640), (160, 560)]  # north-west, north-east, south-east, south-west

    def show(self, run):
        page = self.page
        page.driver.get(run.address.replace("/?", "/projector?"))
        page.until("a picture", "window.tandem && tandem.world.frame && tandem.pictures > 0 && tandem.map")

    def colour(self, picture, x_m, y_m):
        """Of the window where a point of the floor is, by the test's own homography."""
        width, height = self.page.js("[innerWidth, innerHeight]")
        at = projected([(-1, 1), (1, 1), (1, -1), (-1, -1)], self.CORNERS, (x_m, y_m))
        scale = picture[0] / width
        offset = 3 * (round(at[1] * scale) * picture[0] + round(at[0] * scale))
        return tuple(picture[2][offset:offset + 3])

    def test_four_clicks_fit_the_picture_and_are_kept(self):
        page = self.page
        folder = tempfile.mkdtemp(prefix="tandem-projector-")
        experiment = os.path.join(folder, "arena.xml")
        with open(ARENA, encoding="utf-8") as file, open(experiment, "w", encoding="utf-8") as copy:
            copy.write(file.read())
        state = unittest.mock.patch.dict(os.environ, {"XDG_STATE_HOME": os.path.join(folder, "state")})
        state.start()
        self.addCleanup(state.stop)
        run = view(experiment, "--paused", "--projector", folder=folder)
        self.addCleanup(run.stop)
        self.show(run)
        self.assertTrue(page.js("tandem.fitting"), "nobody has fitted it yet")
        for x, y in self.CORNERS:
            page.click_at(x, y)
        page.press(Keys.ENTER)
        page.until("it is kept", "!tandem.fitting && document.getElementById('help').textContent === ''")
        eventually("the file", lambda: glob.glob(os.path.join(folder, "state/tandem/projector/arena-*.json")))
        picture = page.window_pixels()
        poses = page.js("tandem.world.members.ids.map((id) => tandem.world.poseOf(id))")
        self.assertEqual(len(poses), 2)
        for pose in poses:  # behind its middle, where no line to the front is drawn
            behind = (pose["x"] - 0.02 * math.cos(pose["heading"]), pose["y"] - 0.02 * math.sin(pose["heading"]))
            self.assertGreater(max(self.colour(picture, *behind)), 60, "a robot is lit where it stands")
        self.assertGreater(max(self.colour(picture, -0.4, -0.5)), 60, "the crate")
        self.assertEqual(self.colour(picture, 0.13, -0.27), (0, 0, 0), "the empty floor is dark")
        self.assertEqual(tuple(picture[2][:3]), (0, 0, 0), "nothing around the arena")
        self.show(run)
        self.assertFalse(page.js("tandem.fitting"), "the corners are there again")
        self.assertEqual(page.window_pixels()[2][:3], picture[2][:3])
        self.assertEqual(page.errors(), [])


def projected(source, target, point):
    """The homography of four points, by least squares and no code of the page."""
    rows, right = [], []
    for (x, y), (u, v) in zip(source, target):
        rows += [[x, y, 1, 0, 0, 0, -x * u, -y * u], [0, 0, 0, x, y, 1, -x * v, -y * v]]
        right += [u, v]
    n = 8
    for i in range(n):  # elimination with pivots
        best = max(range(i, n), key=lambda k: abs(rows[k][i]))
        rows[i], rows[best], right[i], right[best] = rows[best], rows[i], right[best], right[i]
        for k in range(n):
            if k != i:
                share = rows[k][i] / rows[i][i]
                rows[k] = [a - share * b for a, b in zip(rows[k], rows[i])]
                right[k] -= share * right[i]
    a, b, c, d, e, f, g, h = [right[i] / rows[i][i] for i in range(n)]
    x, y = point
    w = g * x + h * y + 1
    return (a * x + b * y + c) / w, (d * x + e * y + f) / w


class TestFigures(WithBrowser):
    """Experiments of the project as the documentation shows them."""

    def setUp(self):
        self.page.errors()

    def show(self, experiment, ticks, *options):
        run = view(os.path.join(ROOT, "configs", experiment), "--paused", *options)
        self.addCleanup(run.stop)
        self.page.open(run.address)
        self.walk_to(ticks)
        return run

    def test_foraging_with_a_robot_from_the_inside(self):
        page = self.page
        self.show("footbot_foraging.xml", 400)
        page.js("tandem.selection.choose(tandem.world.members.ids[0])")
        value = 'article.robot button.value[data-field^="actuator.differential_steering."]'
        page.until("its wheels", "document.querySelectorAll(arguments[0]).length >= 2", value)
        for number in (0, 1):
            page.js("document.querySelectorAll(arguments[0])[arguments[1]].click()", value, number)
            page.find(".menu button").click()
        page.js("tandem.plots.loadPast()")
        page.until("the past", "[...tandem.plots.list[0].series.values()].every((line) => line.ticks.length > 100)")
        page.js("(tandem.camera.zoom(0.9), tandem.inspector.host.scrollTop = 0)")
        page.until("all robots", "tandem.robots.shown.full === 10")
        page.screenshot("window.png")
        self.assertEqual(page.errors(), [])

    def test_lit_lamps_glow_and_states_have_colours(self):
        page = self.page
        self.show("footbot_foraging.xml", 300)
        lit = page.js("tandem.world.members.ids.findIndex((_, i) => new Uint16Array(tandem.world.frame.words.buffer, 32)[8 * i + 6] === 31)")
        self.assertGreaterEqual(lit, 0, "one looks for its nest, with a blue beacon")
        page.js("(tandem.camera.lookAt(tandem.world.pose(arguments[0]), 0.9), tandem.view.render())", lit)
        pose = page.js("tandem.world.pose(arguments[0])", lit)
        away = [page.pixel(*page.floor_at(pose["x"] + 0.1 * math.cos(a), pose["y"] + 0.1 * math.sin(a))) for a in range(6)]
        self.assertGreater(max(blue - red for red, _, blue in away), 60, "the floor beside it")
        page.screenshot("window_near.png")
        page.js("tandem.colors.set('state state')")
        page.until("its words", "/search|rest|bring/.test(document.getElementById('legend').textContent)")
        self.assertEqual(page.errors(), [])

    def test_without_webgl_the_floor_is_there(self):
        page = self.page
        run = self.show("footbot_foraging.xml", 5)
        page.open(run.address + "&flat=1")
        page.until("the floor", "tandem.scene.floorTexture !== undefined")
        nest, field = page.pixel(*page.floor_at(-2.1, 0.3)), page.pixel(*page.floor_at(0.3, 2.0))
        self.assertGreater(far(nest, field), 60)

    def test_flying_robots_lean_over_a_floor(self):
        page = self.page
        self.show("eyebot_flocking.xml", 120)
        page.until("robots in the air", "tandem.world.pose(0).z > 0.3")
        page.screenshot("window_eyebots.png")
        self.assertEqual(page.errors(), [])

    def test_rays_and_links_over_a_swarm(self):
        page = self.page
        self.show("footbot_flocking.xml", 100)
        for name in ("cameras", "trails", "velocity"):
            page.js("document.querySelector(`[data-layer=${arguments[0]}]`).click()", name)
        page.until("arrows", "tandem.layers.segmentsShown > 0")
        self.walk_to(200)
        page.until("trails", "tandem.layers.drawings.get(tandem.layers.layers.findIndex((layer) => layer.name === 'trails'))?.geometry.attributes.position.count > 500")
        page.js("tandem.camera.lookAt(tandem.world.poseOf('fb0') || tandem.world.pose(0), 4.5)")
        page.screenshot("window_layers.png")
        self.assertEqual(page.errors(), [])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
