"""Opens a notebook in JupyterLab as people do, runs its cells, and looks whether the mechanism moves and a slider changes an input.

    python benches/python/notebook.py [--pictures FOLDER]

needs the package as `pip install ".[notebook]"` makes it, jupyterlab, playwright, and Chromium (the variable CHROMIUM, else `chromium`).
"""

import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.request

from playwright.sync_api import sync_playwright

CELLS = [
    """import holonom as hm
m = hm.Model(title="Crane", plane="xz")
m.input("push", unit="N", meaning="along the track")
cart = m.body("cart", mass=20, inertia=1, shape=hm.Box(0.6, 0.2, 0.3), position=[0, 0])
load = m.body("load", mass=5, inertia=0.05, shape=hm.Box(0.3, 0.3, 0.3), position=[0, -1.5])
m.prismatic("track", m.ground, cart, at=[0, 0], axis=[1, 0])
m.revolute("rope", cart, load, at=[0, 0])
m.expression("motor", point="cart", force=["push - 5*cart.vx", 0])
sim = hm.Simulation(m, step=1e-3)
live = sim.live(limits={"push": (-50, 50)})
live""",
    """m.simulate(end=3, step=1e-2)""",
]
#: Says what the kernel knows, after the page was used.
ASKED = """print("ASKED", sim.time, sim.inputs["push"], sim["cart.x"])"""

#: A fingerprint of what a canvas shows.
PICTURE = """
(canvas) => {
  const copy = document.createElement("canvas");
  [copy.width, copy.height] = [canvas.width, canvas.height];
  const brush = copy.getContext("2d");
  brush.drawImage(canvas, 0, 0);
  return brush.getImageData(0, 0, copy.width, copy.height).data.reduce((hash, value) => (31 * hash + value) | 0, 7);
}
"""


def notebook(path):
    cell = lambda text: {"cell_type": "code", "id": f"c{abs(hash(text))}", "metadata": {}, "execution_count": None, "outputs": [], "source": text}
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    path.write_text(json.dumps({"cells": [cell(text) for text in [*CELLS, ASKED]], "metadata": kernel, "nbformat": 4, "nbformat_minor": 5}))


def wait_for(address):
    for _ in range(300):
        try:
            return urllib.request.urlopen(address, timeout=1).read()
        except OSError:
            time.sleep(0.1)
    raise TimeoutError(f"JupyterLab does not answer at {address}")


def look(page, pictures):
    def keep(name, of=page):
        if pictures:
            of.screenshot(path=str(pictures / f"{name}.png"))

    def run_cell():
        page.keyboard.press("Shift+Enter")

    page.locator(".jp-Notebook-cell").first.wait_for()
    page.locator(".jp-Notebook-ExecutionIndicator[data-status=idle]").wait_for(timeout=60_000)
    page.locator(".jp-Notebook-cell .cm-content").first.click()
    run_cell()
    widget = page.locator(".live")
    widget.wait_for(timeout=60_000)
    canvas = widget.locator("canvas")
    page.wait_for_timeout(500)
    start = canvas.evaluate(PICTURE)
    keep("start")
    widget.locator(".play").click()
    slider = widget.locator(".inputs input")
    box = slider.bounding_box()
    page.mouse.click(box["x"] + 0.9 * box["width"], box["y"] + 0.5 * box["height"])
    page.wait_for_timeout(1500)
    moved = canvas.evaluate(PICTURE)
    keep("moving")
    keep("notebook", widget)
    told, now = widget.locator(".inputs output").inner_text(), widget.locator("output.now").inner_text()
    widget.locator(".play").click()
    page.locator(".jp-Notebook-cell .cm-content").nth(1).click()
    run_cell()
    report = page.frame_locator("iframe[title^='Report of']")
    report.locator(".stage canvas").wait_for(timeout=60_000)
    page.wait_for_timeout(500)
    keep("report")
    has_report = report.locator(".plot canvas").count() > 0
    page.locator(".jp-Notebook-cell .cm-content").nth(2).click()
    run_cell()
    asked = page.locator("pre:has-text('ASKED')").last
    asked.wait_for(timeout=30_000)
    t, push, x = map(float, asked.inner_text().split()[1:])
    print(f"in the page: {now}, push {told}; in the kernel: {t:.3f} s, push {push:.3f} N, cart at {x:.3f} m")
    checks = {
        "the picture moves": start != moved,
        "the slider sets the input": push > 30 and told.startswith(f"{push:.4g}"),
        "the mechanism follows it": x > 0.2,
        "time goes on at its own speed": 0.8 < t < 3,
        "a run shows its report": has_report,
    }
    for check, holds in checks.items():
        print(f"{check}: {'yes' if holds else 'NO'}")
    return all(checks.values())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pictures", type=pathlib.Path)
    parser.add_argument("--port", type=int, default=8931)
    options = parser.parse_args()
    if options.pictures:
        options.pictures.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        notebook(pathlib.Path(folder) / "crane.ipynb")
        flags = ["--no-browser", "--allow-root", f"--port={options.port}", "--IdentityProvider.token=", f"--notebook-dir={folder}"]
        lab = subprocess.Popen([sys.executable, "-m", "jupyterlab", *flags], stderr=subprocess.DEVNULL, cwd=folder)
        try:
            wait_for(f"http://127.0.0.1:{options.port}/api")
            browser = os.environ.get("CHROMIUM") or shutil.which("chromium")
            with sync_playwright() as play:
                software = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
                page = play.chromium.launch(executable_path=browser, args=software).new_page(viewport={"width": 1300, "height": 1000})
                page.goto(f"http://127.0.0.1:{options.port}/lab/tree/crane.ipynb?reset")
                return look(page, options.pictures)
        finally:
            lab.terminate()
            lab.wait()


if __name__ == "__main__":
    sys.exit(not main())
