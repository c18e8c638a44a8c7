"""How many pictures a second the page draws (20 at most: the server's rate), and what one costs, in a browser without a graphics processor, 800 x 600:

  python3 frames.py PROGRAM [ROBOTS LEVEL]...     by default: 1000 full 10000 coarse
"""
import os
import sys
import time

TICKS_PER_S = os.sysconf("SC_CLK_TCK")

from page import Page, Run

SECONDS = 10.0
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


def measure(program, robots, level):
    size = round(0.6 * robots**0.5 + 1.0, 1)
    path = os.path.join(os.getcwd(), f"frames_{robots}.xml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(EXPERIMENT.format(size=size, half=round(size / 2 - 0.3, 2), robots=robots))
    run = Run(program, "view", path, "--no-browser")
    page = Page(800, 600)
    try:
        page.open(run.address)
        page.driver.execute_script("""
            for (const id of ['top', 'left', 'bottom']) document.getElementById(id).hidden = true;
            Object.assign(document.getElementById('stage').style, { position: 'fixed', width: '800px', height: '600px' });
            tandem.robots.setLevel(arguments[0]);""", level)
        page.until("the size", "tandem.camera.width_px === 800 && tandem.camera.height_px === 600")
        page.ask({"do": "play", "speed": 4})  # more ticks than pictures
        root = page.driver.service.process.pid
        page.until("some pictures", "tandem.framesDrawn > 10")
        used_s = processor_s(root)
        begin = page.js("[tandem.framesDrawn, performance.now()]")
        time.sleep(SECONDS)
        end = page.js("[tandem.framesDrawn, performance.now()]")
        used_s = processor_s(root) - used_s
        shown = page.js("tandem.robots.shown")
        print(f"{robots} robots, {level} ({shown['full']} in full, {shown['coarse']} as discs): "
              f"{1000.0 * (end[0] - begin[0]) / (end[1] - begin[1]):.1f} frames a second, "
              f"{1000.0 * used_s / (end[0] - begin[0]):.0f} ms of processor time a frame in the browser", flush=True)
    finally:
        page.close()
        run.stop()
        os.remove(path)


if __name__ == "__main__":
    wanted = sys.argv[2:] or ["1000", "full", "10000", "coarse"]
    for number, level_ in zip(wanted[::2], wanted[1::2]):
        measure(os.path.abspath(sys.argv[1]), int(number), level_)
