"""How many pictures a second the page draws while the camera turns, in a browser without a graphics processor, 800 x 600:

  python3 frames.py PROGRAM [ROBOTS]...     by default: 1000 100000
"""
import os
import sys
import time

TICKS_PER_S = os.sysconf("SC_CLK_TCK")

from page import Page, Run

SECONDS = 10.0
SETTLING_S = 25.0  # quality goes down step by step
EXPERIMENT = """<?xml version="1.0"?>
<tandem>
  <framework><experiment length="0" ticks_per_second="10" random_seed="3"/></framework>
  <controllers>
    <footbot_diffusion id="drive" library="footbot_diffusion">
      <actuators><differential_steering implementation="default"/></actuators>
      <sensors><footbot_proximity implementation="default"/></sensors>
      <params alpha="7.5" delta="0.1" velocity="5 cm/s"/>
    </footbot_diffusion>
  </controllers>
  <arena size="{size},{size},1" center="0,0,0.5" escape="stop">
    <distribute>
      <position method="uniform" min="-{half},-{half},0" max="{half},{half},0"/>
      <orientation method="uniform" min="0,0,0" max="360,0,0"/>
      <entity quantity="{robots}" max_trials="1000"><foot-bot id="fb"><controller config="drive"/></foot-bot></entity>
    </distribute>
  </arena>
  <physics_engines><kinematics2d id="plane"/></physics_engines>
</tandem>
"""


def processor_s(root):
    """Of a process and all that it started."""
    parents, used = {}, {}
    for entry in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{entry}/stat", encoding="utf-8", errors="replace") as file:
                fields = file.read().rsplit(")", 1)[1].split()
        except OSError:
            continue  # it has just ended
        parents[int(entry)] = int(fields[1])
        used[int(entry)] = (int(fields[11]) + int(fields[12])) / TICKS_PER_S

    def below(pid):
        while pid not in (0, 1, root):
            pid = parents.get(pid, 0)
        return pid == root
    return sum(seconds for pid, seconds in used.items() if below(pid))


TURN = """
    for (const id of ['top', 'left', 'bottom']) document.getElementById(id).hidden = true;
    Object.assign(document.getElementById('stage').style, { position: 'fixed', width: '800px', height: '600px' });
    window.drawing = [];
    const turn = () => {
      tandem.camera.orbit(0.004, 0);
      drawing.push(tandem.view.drawing_ms);
      requestAnimationFrame(turn);
    };
    turn();"""
COUNT = """(() => {
    const { calls, triangles } = tandem.view.renderer.info.render, ms = drawing.splice(0);
    return { pictures: tandem.view.pictures, now: performance.now(), calls, triangles, script_ms: ms.reduce((a, b) => a + b, 0) / ms.length };
})()"""


def tell(page, what):
    root = page.driver.service.process.pid
    used_s = processor_s(root)
    begin = page.js(COUNT)
    time.sleep(SECONDS)
    end = page.js(COUNT)
    used_s = processor_s(root) - used_s
    shown = page.js("tandem.robots.shown")
    pictures = max(1, end["pictures"] - begin["pictures"])
    print(f"{what} ({shown['full']} in full, {shown['coarse']} as discs): {1000.0 * pictures / (end['now'] - begin['now']):.1f} pictures a second, "
          f"{1000.0 * used_s / pictures:.0f} ms of processor time each in the browser, {end['script_ms']:.1f} ms of it in the page; "
          f"{end['calls']} draw calls, {end['triangles']} triangles. {page.js('tandem.view.quality.text')}", flush=True)


def measure(program, robots):
    size = round(0.6 * robots**0.5 + 1.0, 1)
    path = os.path.join(os.getcwd(), f"frames_{robots}.xml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(EXPERIMENT.format(size=size, half=round(size / 2 - 0.3, 2), robots=robots))
    run = Run(program, "view", path, "--no-browser", "--paused")
    page = Page(800, 600)
    try:
        page.open(run.address)
        page.driver.execute_script(TURN)
        page.until("the size", "tandem.camera.width_px === 800 && tandem.camera.height_px === 600")
        for pinned in (True, False):
            page.driver.execute_script("tandem.view.quality.pin(arguments[0])", pinned)
            time.sleep(2.0 if pinned else SETTLING_S)
            tell(page, f"{robots} robots, {'everything' if pinned else 'as quality allows'}")
    finally:
        page.close()
        run.stop()
        os.remove(path)


if __name__ == "__main__":
    for robots_ in sys.argv[2:] or ["1000", "100000"]:
        measure(os.path.abspath(sys.argv[1]), int(robots_))
