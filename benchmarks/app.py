"""How smooth the page is: ``python benchmarks/app.py``.

A browser drags the view for some seconds, and counts the pictures; then it lets go, and the time
until the full picture is there is taken. The browser draws, then the server, and then whom the
page chooses by itself. The same is done with PyVista's own trame viewer and a plain sphere, where
that is installed (``pip install trame-pyvista``). Server, browser and this program share the
processors, as they do on a small machine.
"""

from __future__ import annotations

import argparse
import itertools
import re
import shutil
import statistics
import subprocess
import sys
import time
from dataclasses import dataclass
from typing import Any

from rich.console import Console
from rich.table import Table

SIZE = {"width": 1000, "height": 700}
FLOWS = ("double_gyre", "cylinder", "delta_wing")
#: A page of ours; the flow is the first argument.
OURS = """
import sys, flowtex, flowtex.app
flow = getattr(flowtex.examples, sys.argv[1] + "_field")()
flowtex.app.serve(flow, open_browser=False, announce=lambda text: print(text, flush=True))
"""
#: PyVista's own page: a sphere of 60 x 60, without edges and without anti-aliasing.
BARE = """
import pyvista as pv
from trame_pyvista.widgets import PyVistaRCAView
from trame.app import get_server
from trame.ui.vuetify3 import SinglePageLayout

server = get_server("bare", client_type="vue3")
pl = pv.Plotter(off_screen=True, theme=pv.themes.DocumentTheme())
pl.disable_anti_aliasing()
pl.add_mesh(pv.Sphere(theta_resolution=60, phi_resolution=60))
with SinglePageLayout(server) as layout, layout.content:
    PyVistaRCAView(pl)
server.controller.on_server_ready.add(
    lambda **_: print(f"http://127.0.0.1:{server.port}/", flush=True))
server.start(port=0, host="127.0.0.1", open_browser=False, show_connection_info=False)
"""
#: A page of ours, and the full picture of it.
VIEW, SHARP = ".flowtex-views", '.flowtex[data-sharp="true"]'
#: Chooses who draws, as *Drawn by* does.
CHOOSE = """
try { sessionStorage["flowtex painter"] = "%s"; } catch { /* a page of no origin */ }"""
PAINTERS = {
    "browser": "by the browser",
    "server": "by the server",
    "": "by whom the page chooses",
}
#: Counts the pictures that a view of ours draws or an <img> shows, with the time of each.
COUNT = """selector => {
  window.seen = [];
  const image = document.querySelector(selector);
  const note = () => window.seen.push(performance.now());
  if (image.first) {
    const { renderer } = image.first;
    for (const name of ["draft", "show"]) {
      const draw = renderer[name].bind(renderer);
      renderer[name] = (...values) => { note(); return draw(...values); };
    }
    return;
  }
  new MutationObserver(note).observe(image, { attributeFilter: ["src"] });
}"""


@dataclass(frozen=True)
class Smoothness:
    """What a drag was like."""

    rate: float
    gap: float
    sharp: float | None


def drag(page: Any, seconds: float) -> tuple[float, float]:
    """Drag in circles, and return pictures in a second and the longest of 20 gaps, in ms."""
    width, height = SIZE["width"], SIZE["height"]
    page.mouse.move(width / 2, height / 2)
    page.mouse.down()
    page.evaluate("window.seen.length = 0")
    begun, turn = time.perf_counter(), 0
    while time.perf_counter() - begun < seconds:
        turn += 1
        x = width / 2 + 4 * (turn % 40 if turn % 80 < 40 else 40 - turn % 40)
        page.mouse.move(x, height / 2 + 2 * (turn % 30))
        page.wait_for_timeout(12)
    seen = page.evaluate("window.seen")
    page.mouse.up()
    gaps = [b - a for a, b in itertools.pairwise(seen)]
    return len(seen) / seconds, statistics.quantiles(gaps, n=20)[-1] if len(gaps) > 2 else 0.0


def measure(
    browser: Any, script: str, words: list[str], image: str, seconds: float, painter: str
) -> Smoothness:
    """Start a page, drag it, and end it; tells what it was like, drawn by the one that is named."""
    process = subprocess.Popen(
        [sys.executable, "-c", script, *words], stdout=subprocess.PIPE, text=True
    )
    try:
        address = next(
            found.group() for line in process.stdout if (found := re.search(r"http://\S+", line))
        )
        page = browser.new_page(viewport=SIZE)
        if painter:
            page.add_init_script(CHOOSE % painter)
        page.goto(address)
        page.wait_for_selector(image, timeout=60_000)
        ours = script is OURS
        if ours:
            page.wait_for_selector(SHARP, timeout=60_000)
        page.wait_for_timeout(1500)
        page.evaluate(COUNT, image)
        rate, gap = drag(page, seconds)
        sharp = None
        if ours:
            before = time.perf_counter()
            page.wait_for_selector(SHARP, timeout=60_000)
            sharp = time.perf_counter() - before
        page.close()
        return Smoothness(rate, gap, sharp)
    finally:
        process.terminate()
        process.wait(20)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=5.0, help="of dragging")
    parser.add_argument("--flows", nargs="*", default=FLOWS)
    given = parser.parse_args()
    from playwright.sync_api import TimeoutError, sync_playwright

    table = Table("page", "pictures in a second", "gap, 95 %", "sharp after", title="Drag")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"))
        cases = [
            (OURS, [flow], VIEW, f"flowtex, {flow}, drawn {by}", painter)
            for painter, by in PAINTERS.items()
            for flow in given.flows
        ]
        cases.append((BARE, [], "img", "PyVista, a sphere", ""))
        for script, words, image, name, painter in cases:
            try:
                found = measure(browser, script, words, image, given.seconds, painter)
            except (StopIteration, TimeoutError) as error:
                table.add_row(name, f"not to be had: {error}"[:60], "", "")
                continue
            sharp = "" if found.sharp is None else f"{1000 * found.sharp:.0f} ms"
            table.add_row(name, f"{found.rate:.1f}", f"{found.gap:.0f} ms", sharp)
        browser.close()
    Console().print(f"{SIZE['width']} x {SIZE['height']}", table)


if __name__ == "__main__":
    main()
