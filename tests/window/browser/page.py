"""The program with its window, and a browser that looks at it, for tests and figures.

Needs Debian's chromium, chromium-driver and python3-selenium.
"""
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

MISSING = 77  # exit code for ctest: not tried

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.actions.action_builder import ActionBuilder
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:
    print("not tried: python3-selenium is missing (apt install python3-selenium)", file=sys.stderr)
    sys.exit(MISSING)

# Of all waits: a busy machine without a graphics processor takes its time.
PATIENCE_S = float(os.environ.get("TANDEM_PATIENCE_S", "120"))
HERE = os.path.dirname(os.path.abspath(__file__))


def found(*names):
    for name in names:
        path = shutil.which(name)
        if path:
            return path
    print(f"not tried: {names[0]} is missing (apt install chromium chromium-driver)", file=sys.stderr)
    sys.exit(MISSING)


def eventually(what, condition, patience_s=PATIENCE_S):
    """What `condition()` returns, once that is true."""
    end = time.monotonic() + patience_s
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > end:
            raise AssertionError(f"not within {patience_s:.0f} s: {what}")
        time.sleep(0.05)


class Run:
    """`tandem ARGUMENTS`, which prints the address of its window."""

    def __init__(self, program, *arguments, folder=None):
        self.folder = folder or tempfile.mkdtemp(prefix="tandem-window-")
        self.lines = []
        self.process = subprocess.Popen([program, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                        stderr=subprocess.PIPE, text=True, errors="replace")
        self.reader = threading.Thread(target=lambda: self.lines.extend(iter(self.process.stderr.readline, "")), daemon=True)
        self.reader.start()
        self.address = eventually("the run prints its address", self._address)

    def _address(self):
        match = re.search(r"http://\S+\?token=\w+", "".join(list(self.lines)))
        if match is None and self.process.poll() is not None:
            raise AssertionError("the program ended: " + "".join(self.lines))
        return match and match.group(0)

    @property
    def port(self):
        return re.search(r":(\d+)/", self.address).group(1)

    def stop(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        try:
            code = self.process.wait(PATIENCE_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
            code = self.process.wait()
        self.reader.join()
        self.process.stderr.close()
        return code


class Page:
    """A browser window without a screen."""

    def __init__(self, width=1280, height=860):
        self.profile = tempfile.mkdtemp(prefix="tandem-browser-")
        options = Options()
        options.binary_location = found("chromium", "google-chrome")
        for argument in ("--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
                         "--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-dev-shm-usage",
                         "--force-device-scale-factor=1", f"--window-size={width},{height}", f"--user-data-dir={self.profile}"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service(found("chromedriver")), options=options)
        self.driver.set_script_timeout(PATIENCE_S)

    def close(self):
        self.driver.quit()
        shutil.rmtree(self.profile, ignore_errors=True)

    def open(self, address):
        self.driver.get(address)
        self.until("the first picture", "window.tandem && tandem.world.frame && tandem.view.pictures > 0")
        self.js("tandem.view.quality.pin(true)")  # nothing is left out, however busy the machine is

    def js(self, expression, *arguments):
        return self.driver.execute_script("return " + expression, *arguments)

    def until(self, what, expression, *arguments):
        try:
            return eventually(what, lambda: self.js(expression, *arguments))
        except AssertionError as late:
            seen = self.js("window.tandem && JSON.stringify({ said: document.querySelector('.said')?.textContent, state: tandem.world.state, keys: document.activeElement?.outerHTML.slice(0, 120) })")
            raise AssertionError(f"{late}; the page: {seen}") from late

    def ask(self, command):
        """The answer of the run to a command."""
        return self.driver.execute_async_script("const done = arguments[1]; tandem.connection.ask(arguments[0]).then(done);", command)

    def press(self, keys):
        ActionChains(self.driver).send_keys(keys).perform()

    def find(self, css):
        return self.driver.find_element(By.CSS_SELECTOR, css)

    def click_in_picture(self, x, y):
        canvas = self.find("#view")
        ActionChains(self.driver).move_to_element_with_offset(canvas, *self._from_middle(x, y)).click().perform()

    def click_at(self, x, y):
        """A click at a point of the window."""
        chain = ActionBuilder(self.driver)
        chain.pointer_action.move_to_location(x, y)
        chain.pointer_action.click()
        chain.perform()

    def window_pixels(self):
        """What the browser shows, as (width, height, RGB bytes)."""
        import base64
        text = base64.b64encode(self.driver.get_screenshot_as_png()).decode()
        width, height, rgb = self.driver.execute_async_script("""
            const done = arguments[1], image = new Image();
            image.onload = () => {
              const canvas = document.createElement('canvas');
              [canvas.width, canvas.height] = [image.width, image.height];
              const pen = canvas.getContext('2d');
              pen.drawImage(image, 0, 0);
              const rgba = pen.getImageData(0, 0, image.width, image.height).data;
              let text = '';
              for (let i = 0; i < rgba.length; i += 4) text += String.fromCharCode(rgba[i], rgba[i + 1], rgba[i + 2]);
              done([image.width, image.height, btoa(text)]);
            };
            image.src = 'data:image/png;base64,' + arguments[0];""", text)
        return width, height, base64.b64decode(rgb)

    def drag_in_picture(self, a, b):
        canvas = self.find("#view")
        middle = ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
        chain = ActionChains(self.driver).move_to_element_with_offset(canvas, *self._from_middle(*a)).click_and_hold()
        for at in (middle, b):
            chain = chain.move_to_element_with_offset(canvas, *self._from_middle(*at))
        chain.release().perform()

    def _from_middle(self, x, y):
        width, height = self.js("[tandem.camera.width_px, tandem.camera.height_px]")
        return round(x - width / 2), round(y - height / 2)

    def place(self, robot):
        """Where a robot is in the picture, once that has the size of its place on the page."""
        self.until("the picture in its place", """(() => {
            const box = document.getElementById('view').parentElement.getBoundingClientRect();
            return Math.floor(box.width) === tandem.camera.width_px && Math.floor(box.height) === tandem.camera.height_px;
        })()""")
        at = self.js("tandem.place(arguments[0])", robot)
        return at["x"], at["y"]

    def floor_at(self, x_m, y_m):
        at = self.js("tandem.camera.project(arguments[0], arguments[1], 0)", x_m, y_m)
        return at["x"], at["y"]

    def pixels(self, width=None, height=None):
        """The 3D picture as (width, height, RGB bytes), scaled to that size if one is given."""
        width_, height_, text = self.driver.execute_script("""
            tandem.view.render();
            const from = document.getElementById('view'), to = document.createElement('canvas');
            to.width = arguments[0] || from.width;
            to.height = arguments[1] || from.height;
            const pen = to.getContext('2d');
            pen.imageSmoothingQuality = 'high';
            pen.drawImage(from, 0, 0, to.width, to.height);
            const rgba = pen.getImageData(0, 0, to.width, to.height).data;
            let text = '';
            for (let i = 0; i < rgba.length; i += 4) text += String.fromCharCode(rgba[i], rgba[i + 1], rgba[i + 2]);
            return [to.width, to.height, btoa(text)];""", width, height)
        import base64
        return width_, height_, base64.b64decode(text)

    def pixel(self, x, y):
        width, _, rgb = self.pixels()
        at = 3 * (round(y) * width + round(x))
        return tuple(rgb[at:at + 3])

    def screenshot(self, name):
        """Into the folder that TANDEM_SCREENSHOTS names, if it does."""
        folder = os.environ.get("TANDEM_SCREENSHOTS")
        if folder:
            os.makedirs(folder, exist_ok=True)
            self.driver.save_screenshot(os.path.join(folder, name))

    def errors(self):
        """What the page complained of since the last call."""
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] in ("SEVERE", "WARNING") and "favicon" not in entry["message"]
                and "WebGL" not in entry["message"] and "GL Driver Message" not in entry["message"] and "swiftshader" not in entry["message"].lower()]


def read_ppm(path):
    with open(path, "rb") as file:
        data = file.read()
    magic, width, height, _ = data.split(maxsplit=4)[:4]
    assert magic == b"P6", path
    return int(width), int(height), data[-3 * int(width) * int(height):]


def write_ppm(path, picture):
    width, height, rgb = picture
    with open(path, "wb") as file:
        file.write(b"P6\n%d %d\n255\n" % (width, height) + rgb)


def difference(one, other):
    """Mean difference of two pictures of the same size, 0 to 1."""
    assert one[:2] == other[:2], f"sizes {one[:2]} and {other[:2]}"
    return sum(abs(a - b) for a, b in zip(one[2], other[2])) / (255.0 * len(one[2]))
