"""How quickly a widget follows data that change: ``python benchmarks/changing.py``.

In a JupyterLab a slider of ipywidgets is dragged for some seconds, whose value makes another mesh,
``widget.field = mesh``. What is counted are different data that were drawn. Chromium draws with
Mesa's OpenGL; browser, kernel and this program share the processors.
"""

from __future__ import annotations

import argparse
import itertools
import shutil
import statistics
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from lab import Lab, lab

MESHES = ("60x40", "120x70", "250x120")
SIZE = {"width": 900, "height": 800}
MESA = ["--use-angle=gl-egl", "--ignore-gpu-blocklist"]
CELL = """import flowtex, ipywidgets, numpy as np, pyvista as pv
x, y = np.meshgrid(np.linspace(0, 2, {columns}), np.linspace(0, 1, {rows}), indexing="ij")
made = []
def mesh(turn):
    grid = pv.StructuredGrid(x, y, 0 * x)
    px, py, _ = grid.points.T
    swirl = np.sin(np.pi * (px + turn / 50)) * np.cos(np.pi * py)
    grid["velocity"] = np.stack([swirl, -np.cos(np.pi * px) * np.sin(np.pi * py), 0 * px], axis=-1)
    made.append(turn)
    return grid
widget = flowtex.FlowWidget(mesh(0), size=(480, 320))
slider = ipywidgets.IntSlider(max=1000, layout={{"width": "800px"}})
slider.observe(lambda change: setattr(widget, "field", mesh(change["new"])), "value")
ipywidgets.VBox([slider, widget])"""
SHARP = '.flowtex[data-sharp="true"]'
#: Notes when data that are new are drawn.
COUNT = """() => {
  const { first } = document.querySelector(".flowtex-views");
  const { renderer } = first;
  const draft = renderer.draft.bind(renderer);
  window.seen = [];
  let last = first.header.generation;
  renderer.draft = (...values) => {
    if (first.header.generation !== last) window.seen.push(performance.now());
    last = first.header.generation;
    return draft(...values);
  };
}"""


def drag(page: Any, seconds: float) -> None:
    """Drag the slider there and back."""
    box = page.locator(".noUi-handle").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    begun, step = time.perf_counter(), 0
    while time.perf_counter() - begun < seconds:
        step += 1
        page.mouse.move(x + 3 * (step % 100 if step % 200 < 100 else 100 - step % 100), y)
        page.wait_for_timeout(16)
    page.mouse.up()


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=5.0, help="of dragging")
    parser.add_argument("--meshes", nargs="*", default=MESHES, help="columns x rows")
    given = parser.parse_args()
    from playwright.sync_api import sync_playwright

    names = ("meshes made in a second", "drawn in a second", "gap, 95 %", "sharp after")
    table = Table("nodes", *names, title="widget.field by a slider")
    with (
        tempfile.TemporaryDirectory() as folder,
        lab(Path(folder)) as server,
        sync_playwright() as playwright,
    ):
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=MESA)
        for mesh in given.meshes:
            page = browser.new_page(viewport=SIZE)
            notebook = Lab(page, server)
            columns, rows = map(int, mesh.split("x"))
            notebook.run(CELL.format(columns=columns, rows=rows))
            page.wait_for_selector(SHARP, timeout=120_000)
            page.evaluate(COUNT)
            before = int(notebook.said("len(made)"))
            page.wait_for_timeout(1000)
            drag(page, given.seconds)
            end = time.perf_counter()
            seen = page.evaluate("window.seen")
            page.wait_for_selector(SHARP, timeout=120_000)
            sharp = time.perf_counter() - end
            made = int(notebook.said("len(made)")) - before
            gaps = [b - a for a, b in itertools.pairwise(seen)]
            late = statistics.quantiles(gaps, n=20)[-1] if len(gaps) > 2 else float("nan")
            rates = (f"{count / given.seconds:.1f}" for count in (made, len(seen)))
            table.add_row(mesh.replace("x", " × "), *rates, f"{late:.0f} ms", f"{sharp:.1f} s")
            page.close()
        browser.close()
    Console().print(table)


if __name__ == "__main__":
    main()
