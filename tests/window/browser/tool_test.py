"""The page as a tool, in a real browser: plots, films, links, questions, confirmations, the emergency stop, a phone's width.

  python3 tool_test.py PROGRAM [options of unittest]
"""
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

from page import Keys, Page, eventually
from page_test import ARENA, PROGRAM, ROOT, WithBrowser, view

SAID = "document.querySelector('.said').textContent"
COVERED = """(() => {
    const stop = document.querySelector('.estop'), box = stop.getBoundingClientRect();
    const clipped = box.left < 0 || box.top < 0 || box.right > innerWidth || box.bottom > innerHeight || stop.scrollWidth > stop.clientWidth;
    const points = [[0.5, 0.5], [0.05, 0.1], [0.95, 0.1], [0.05, 0.9], [0.95, 0.9]].map(([x, y]) => [box.left + x * box.width, box.top + y * box.height]);
    return clipped || points.some(([x, y]) => document.elementFromPoint(x, y) !== stop);
})()"""
# Texts of less than 4.5:1 (3:1 where they are large), as [ratio, text]; of what is seen and not disabled.
FAINT = """(() => {
    const rgba = (text) => (text.match(/[\\d.]+/g) ?? [0, 0, 0, 0]).map(Number).map((v, i) => (text.startsWith('color(') && i < 3 ? 255 * v : v)).concat([1]);
    const light = ([r, g, b]) => [r, g, b].map((v) => v / 255).map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)).reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
    const ground = (element) => {
      for (let at = element; at; at = at.parentElement) {
        const color = rgba(getComputedStyle(at).backgroundColor);
        if (color[3] > 0.5) return color;
      }
      return [255, 255, 255, 1];
    };
    const faint = [];
    for (const element of document.querySelectorAll('body *')) {
      const own = [...element.childNodes].some((node) => node.nodeType === 3 && node.data.trim() !== '');
      if (!own || !element.checkVisibility({ checkVisibilityCSS: true, checkOpacity: true }) || element.matches(':disabled, option, :disabled *')) continue;
      const style = getComputedStyle(element);
      const [a, b] = [light(rgba(style.color)), light(ground(element))].sort((x, y) => y - x);
      const ratio = (a + 0.05) / (b + 0.05);
      const large = parseFloat(style.fontSize) >= 24 || (parseFloat(style.fontSize) >= 18.6 && style.fontWeight >= 700);
      if (ratio < (large ? 3 : 4.5)) faint.push([ratio.toFixed(2), element.className + ': ' + element.textContent.trim().slice(0, 40)]);
    }
    return faint;
})()"""
NAMELESS = """[...document.querySelectorAll('button, input, select, summary, canvas:not([aria-hidden]), [role=toolbar], dialog')].filter((e) => e.checkVisibility()
    && !(e.getAttribute('aria-label') || e.title || e.textContent.trim() || e.closest('label')?.textContent.trim())).map((e) => e.outerHTML)"""
TWICE = "[...document.querySelectorAll('[id]')].map((e) => e.id).filter((id, i, all) => all.indexOf(id) !== i)"


def axe_core():
    """The checks of accessibility of axe-core, as a script; skips the test where npm cannot get them."""
    npm = shutil.which("npm")
    if npm is None:
        raise unittest.SkipTest("npm is missing (apt install npm)")
    folder = tempfile.mkdtemp(prefix="tandem-axe-")
    got = subprocess.run([npm, "install", "--no-audit", "--no-fund", "--ignore-scripts", "--prefix", folder, "axe-core@4.14.1"], capture_output=True, timeout=120)
    if got.returncode != 0:
        raise unittest.SkipTest("npm cannot get axe-core")
    with open(os.path.join(folder, "node_modules", "axe-core", "axe.min.js"), encoding="utf-8") as file:
        return file.read()


class TestTool(WithBrowser):
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
        self.page.until("the start", "tandem.world.frame && tandem.world.frame.tick === 0 && tandem.world.state.paused && tandem.world.state.latest === 0")

    def tearDown(self):
        self.assertEqual(self.page.errors(), [])

    def test_commands_are_confirmed_and_refused_in_sight(self):
        page = self.page
        page.press(" ")
        page.until("that it goes on", f"{SAID} === '✓ the run goes on'")
        page.press(" ")
        page.until("the pause", f"/^✓ paused at tick \\d+$/.test({SAID})")
        page.press("n")
        page.until("the choice", "tandem.selection.last === 'ep1'")
        page.press("x")
        page.until("the halt", f"{SAID} === '✓ ep1 halted'")
        page.press("u")
        page.until("the undo", f"{SAID}.startsWith('✓ undone: ep1 halted; back at tick')")
        page.press("u")
        page.until("the refusal", f"{SAID}.startsWith('✗ refused: there is nothing to undo')")
        box = page.js("(({ left, right, bottom }) => [left, right, bottom])(document.querySelector('.said').getBoundingClientRect())")
        self.assertTrue(box[0] >= 0 and box[1] <= page.js("innerWidth") and box[2] <= page.js("innerHeight"), box)

    def test_touching_the_past_asks_and_undo_brings_back_what_it_dropped(self):
        page = self.page
        self.walk_to(30)
        there = self.poses()
        self.go_to(10)
        page.until("the past", "tandem.world.state.tick === 10 && tandem.world.state.latest === 30")
        page.press("nx")
        page.until("the question", "document.querySelector('dialog[open]')?.textContent.includes('Drop 20 ticks?')")
        page.screenshot("window_drop.png")
        page.press(Keys.ESCAPE)
        page.until("no question", "document.querySelector('dialog[open]') === null")
        self.assertEqual(page.js("tandem.world.halted.size"), 0)
        self.assertEqual(page.js("tandem.world.state.latest"), 30)
        page.press("x")
        page.until("the question", "document.querySelector('dialog[open] button.main')")
        page.find("dialog[open] button.main").click()
        page.until("the halt", "tandem.world.halted.size === 1 && tandem.world.state.latest === 10")
        page.until("what was dropped", f"{SAID}.includes('20 later ticks dropped, undo (u) brings them back')")
        self.walk_to(15)
        page.press("u")
        page.until("all of it again", "tandem.world.state.latest === 30 && tandem.world.frame.tick === 10")
        page.press(Keys.END)
        page.until("the newest tick", "tandem.world.frame.tick === 30")
        self.assertEqual(self.poses(), there)

    def test_the_log_speaks_in_words(self):
        page = self.page
        page.press("n")
        page.ask({"do": "move", "robot": "ep1", "x": 0.1, "y": -0.6})
        page.ask({"do": "add", "light": {"x": 0.5, "y": 0.5, "z": 1, "intensity": 2, "color": "#ffff00"}})
        self.walk_to(2)
        page.press("l")
        page.until("two entries", "document.querySelectorAll('.entry.action').length >= 2")
        text = page.js("[...document.querySelectorAll('.entry.action .what')].map((e) => e.textContent).join('\\n')")
        self.assertIn("ep1 moved to x 0.100 m, y -0.600 m", text)
        self.assertRegex(text, r"lamp \w+ added at x 0.500 m, y 0.500 m, z 1 m")
        self.assertNotIn("address", text)

    def plot(self, field, choice):
        self.page.until("its place", "document.querySelector(arguments[0])", f'article.robot button.value[data-field="{field}"]')
        self.page.js("document.querySelector(arguments[0]).click()", f'article.robot button.value[data-field="{field}"]')
        self.page.js("[...document.querySelectorAll('.menu button')].find((b) => b.textContent === arguments[0]).click()", choice)

    def test_plots_stand_one_under_the_other_and_stay_without_the_choice(self):
        page = self.page
        page.press("n")
        self.plot("pose.pose.y.0", "Plot")
        self.plot("pose.pose.x.0", "Plot in a new one")
        self.plot("pose.pose.heading.0", "Plot")
        self.assertEqual(page.js("tandem.plots.list.map((plot) => plot.series.size)"), [1, 2])
        page.press(Keys.ESCAPE)
        page.until("no choice", "tandem.selection.ids.size === 0 && document.querySelectorAll('canvas.plot').length === 2")
        self.walk_to(20)
        page.until("values", "tandem.plots.list.every((plot) => [...plot.series.values()].every((line) => line.ticks.at(-1) === 20))")
        page.js("tandem.plots.loadPast()")
        page.until("the past", "tandem.plots.list.every((plot) => [...plot.series.values()].every((line) => line.ticks[0] === 0))")
        page.js("document.querySelector('canvas.plot').scrollIntoView()")
        box = page.js("(({ left, top, width, height }) => [left + width / 2, top + height / 2])(document.querySelector('canvas.plot').getBoundingClientRect())")
        page.click_at(*map(round, box))  # the pointer rests there
        page.until("one line in both", "tandem.plots.list.every((plot) => plot.marked > 5 && plot.marked < 15)")
        page.until("that tick", "tandem.world.frame.tick === tandem.plots.list[0].marked")
        shown = float(page.js("document.querySelector('.legend output').textContent").split()[0])
        line = page.js("(({ ticks, values }) => values[ticks.indexOf(tandem.plots.list[0].marked)])([...tandem.plots.list[0].series.values()][0])")
        self.assertAlmostEqual(shown, line, 2)
        page.screenshot("window_plots.png")

    def test_axes_show_whole_numbers_of_small_and_large_values(self):
        page = self.page
        page.press("n")
        self.plot("pose.pose.y.0", "Plot")
        for values in ([0.30000001, 0.30000004], [1e-7, 3e-7], [123456789, 123456999], [-40, 90]):
            drawn = page.driver.execute_script("""
                const plot = tandem.plots.list[0], line = [...plot.series.values()][0], texts = [];
                Object.assign(line, { ticks: [0, 1], values: arguments[0] });
                const own = CanvasRenderingContext2D.prototype.fillText;
                CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {
                  if (this.textAlign === 'right') texts.push([text, x - this.measureText(text).width]);
                  return own.call(this, text, x, y);
                };
                plot.draw();
                CanvasRenderingContext2D.prototype.fillText = own;
                return texts;""", values)
            self.assertGreaterEqual(len(drawn), 2, values)
            self.assertEqual([text for text, left in drawn if left < 0], [], values)
            self.assertEqual(len({text for text, _ in drawn}), len(drawn), drawn)

    def test_a_film_is_recorded_and_saved(self):
        page = self.page
        folder = tempfile.mkdtemp(prefix="tandem-film-")
        page.driver.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": folder})
        page.press("w")
        page.until("it records", "tandem.film.button.getAttribute('aria-pressed') === 'true'")
        page.press(" ")
        page.until("three seconds of it", "tandem.world.frame.tick > 30")
        page.press(" w")
        film = eventually("the file", lambda: [f for f in glob.glob(os.path.join(folder, "*.webm")) if os.path.getsize(f) > 1000])[0]
        with open(film, "rb") as file:
            self.assertEqual(file.read(4), b"\x1a\x45\xdf\xa3", "a Matroska film")
        page.until("it has ended", "tandem.film.button.textContent === 'Film'")

    def test_a_layout_is_shared_as_a_link_that_commands_nothing(self):
        page = self.page
        page.press("nt++")
        self.plot("pose.pose.y.0", "Plot")
        page.find("[data-layer=proximity]").click()
        link, distance = page.js("tandem.layout.link"), page.js("tandem.camera.distance")
        page.js("tandem.layout.open()")
        page.until("the link", "document.querySelector('dialog[open] input').value === arguments[0]", link)
        self.assertNotIn(re.search(r"token=(\w+)", self.run_.address).group(1), link)
        page.driver.get("about:blank")
        page.open(link)
        page.until("the layout", """tandem.camera.isTop && tandem.selection.last === 'ep1' && tandem.plots.list.length === 1
            && tandem.layers.on.has('proximity') && Math.abs(tandem.camera.distance - arguments[0]) < 0.001""", distance)
        self.assertFalse(page.ask({"do": "play"})["ok"])
        page.driver.get("about:blank")
        page.open(self.run_.address + "#layout=%F0nonsense")
        page.until("that it cannot be read", "document.querySelector('.toast.error')?.textContent.includes('cannot be read')")

    def test_a_phone_has_room(self):
        page = self.page
        page.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 390, "height": 844, "deviceScaleFactor": 1, "mobile": True})
        try:
            page.open(self.run_.address)
            page.until("the width", "tandem.camera.width_px === 390")
            self.assertEqual(page.js("document.documentElement.scrollWidth"), 390)
            wide = page.js("""[...document.querySelectorAll('#top *, #bottom *, #tools *')].filter((e) => e.checkVisibility() && e.getBoundingClientRect().right > 391)
                .map((e) => e.outerHTML.slice(0, 80))""")
            self.assertEqual(wide, [])
            self.assertGreater(page.js("tandem.camera.height_px"), 400)
            page.screenshot("window_phone.png")
        finally:
            page.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})

    def test_texts_have_contrast_controls_names_and_elements_their_own_ids(self):
        page = self.page
        for scheme in ("light", "dark"):
            page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
            page.press("nlm")
            page.js("document.querySelectorAll('details').forEach((e) => (e.open = true))")
            page.until("a robot's inside", "document.querySelectorAll('article.robot .port').length > 2")
            self.assertEqual(page.js(FAINT), [], scheme)
            page.press("?")
            self.assertEqual(page.js(FAINT), [], f"{scheme}, keys")
            self.assertEqual(page.js(NAMELESS), [])
            self.assertEqual(page.js(TWICE), [])
            page.press(Keys.ESCAPE)
            page.press("lm")
        page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})

    def test_axe_finds_nothing(self):
        page, axe = self.page, axe_core()
        page.driver.execute_script(axe)
        for keys in ("", "nl", "?"):
            page.press(keys)
            page.js("document.querySelectorAll('details').forEach((e) => (e.open = true))")
            page.until("it stands", "document.querySelectorAll('article.robot .port').length > 2 || tandem.selection.ids.size === 0")
            found = page.driver.execute_async_script("""const done = arguments[0];
                axe.run(document, { runOnly: ['wcag2a', 'wcag2aa', 'wcag21aa'] }).then(({ violations }) =>
                  done(violations.map((v) => [v.id, v.nodes.slice(0, 5).map((node) => node.html.slice(0, 160))])));""")
            self.assertEqual(found, [], f"after '{keys}'")

    def test_a_lost_context_is_said_and_the_rest_goes_on(self):
        page = self.page
        page.js("(window.lose = tandem.view.renderer.getContext().getExtension('WEBGL_lose_context')).loseContext()")
        page.until("that it is lost", "document.getElementById('banner').textContent.includes('picture')")
        answer = page.ask({"do": "step", "ticks": 30})
        self.assertTrue(answer["ok"], answer)
        page.until("the ticks", "tandem.world.frame.tick === 30")
        pictures = page.js("tandem.view.pictures")
        page.js("window.lose.restoreContext()")
        page.until("a picture again", "document.getElementById('banner').hidden && tandem.view.pictures > arguments[0]", pictures)
        page.errors()  # three.js tells of it


class TestMeasures(WithBrowser):
    def test_measures_are_plotted(self):
        page = self.page
        run = view(os.path.join(ROOT, "configs", "footbot_foraging.xml"), "--paused")
        self.addCleanup(run.stop)
        page.open(run.address)
        self.walk_to(3)
        page.until("measures", "document.querySelector('[data-measure]') !== null")
        self.assertNotIn("measures", page.js("[...document.querySelectorAll('[data-layer]')].map((e) => e.dataset.layer)"))
        page.js("document.querySelector('[data-measure]').click()")
        page.find(".menu button").click()
        self.walk_to(20)
        page.until("its values", "[...tandem.plots.list[0].series.values()][0].ticks.at(-1) === 20")
        page.js("[...document.querySelectorAll('#controls button')].find((button) => button.textContent === 'scatter').click()")
        page.until("a press of a paused run", f"{SAID} === '✓ hook foraging: scatter pressed; the run is paused: it may show at the next tick'")
        page.screenshot("window_measures.png")
        self.assertEqual(page.errors(), [])


class TestHostileNames(WithBrowser):
    def test_names_with_markup_are_texts(self):
        page = self.page
        folder = tempfile.mkdtemp(prefix="tandem-window-")
        name = "&lt;img src=x onerror=&quot;window.hit=1&quot;&gt;"
        with open(ARENA, encoding="utf-8") as file:
            text = file.read().replace('id="ep1"', f'id="{name}"').replace('id="crate"', 'id="&lt;b&gt;crate&lt;/b&gt;&quot;"')
        path = os.path.join(folder, "names.xml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        run = view(path, "--paused", folder=folder)
        self.addCleanup(run.stop)
        page.open(run.address)
        page.js("tandem.selection.choose(tandem.world.members.ids.find((id) => id.includes('<')))")
        page.until("its inside", "document.querySelectorAll('article.robot .port').length > 2")
        self.assertIn("<img", page.find("article.robot h3").text)
        page.js("tandem.layers.toggle('ids', true)")
        page.press("x")
        page.until("the halt", f"{SAID}.includes('<img')")
        page.press(".l/img")
        page.until("found", "document.querySelectorAll('.found button').length === 1")
        self.assertFalse(page.js("window.hit === 1 || document.querySelector('img') !== null"))
        self.assertEqual(page.errors(), [])


class TestEmergencyStop(WithBrowser):
    def test_it_is_whole_bright_and_in_front_at_any_width_and_over_dialogs(self):
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
        for width in (1600, 1024, 768, 390, 320):
            page.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 800})
            page.until("the width", "innerWidth === arguments[0]", width)
            page.js("tandem.showPanels(true)")
            page.until(f"it is whole at {width}", f"!{COVERED}")
            under = page.js("""[...document.querySelectorAll('#top > *')].filter((e) => {
                const box = e.getBoundingClientRect(), stop = document.querySelector('.estop').getBoundingClientRect();
                return e.checkVisibility() && box.width > 0 && box.right > stop.left && box.bottom > stop.top && box.top < stop.bottom;
            }).map((e) => e.id)""")
            self.assertEqual(under, [], f"nothing lies under it at {width}")
            place = page.js("JSON.stringify(document.querySelector('.estop').getBoundingClientRect())")
            page.js("tandem.real.preflight()")
            page.until("preflight", "document.querySelectorAll('dialog[open] .preflight tr').length > 4")
            self.assertFalse(page.js(COVERED), f"{width}, with a dialog")
            self.assertEqual(page.js("JSON.stringify(document.querySelector('.estop').getBoundingClientRect())"), place)
            self.assertEqual(page.js("document.querySelector('dialog[open]').scrollTop"), 0, "it begins at its beginning")
            page.screenshot(f"window_stop_{width}.png")
            page.press(Keys.ESCAPE)
            page.until("no dialog", "document.querySelector('dialog[open]') === null")
        page.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
        page.press("?")
        page.find(".estop").click()
        page.until("the stop", f"{state}.driving === false && tandem.real.stop.classList.contains('on')")
        page.until("it is said", f"{SAID} === '✓ emergency stop of all real robots'")
        page.press(Keys.ESCAPE)
        clipped = page.js("[...document.querySelectorAll('.real .badge, #top .badge')].filter((e) => e.checkVisibility() && (e.scrollWidth > e.clientWidth + 1 || e.getBoundingClientRect().right > e.closest('aside, header').getBoundingClientRect().right)).map((e) => e.textContent)")
        self.assertEqual(clipped, [])
        page.find("#real .row button:nth-child(2)").click()
        page.until("it drives again", f"{state}.driving === true")
        page.press("?e")
        page.until("the stop by key, from within a dialog", f"{state}.driving === false")
        self.assertEqual(page.js(FAINT), [])
        page.press(Keys.ESCAPE)
        self.assertEqual(page.js(FAINT), [])
        self.assertEqual(page.errors(), [])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
