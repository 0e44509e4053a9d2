"""Time of the browser client: ``python benchmarks/client.py``.

Frames of the WebGL2 client against pixels, samples and nodes, measured in Chromium: from a
change of the view until the full picture is there. On a graphics card start with ``--gpu``,
which takes Chromium's own choice of driver; without one Mesa's software driver is taken.
``--first`` measures from a mesh of 500 x 500 nodes to the first textures that a notebook is sent.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import time
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

import flowtex
from flowtex.options import Options
from flowtex.web.view import web_views

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from webgl_page import ClientPage, packed

#: Software drawing: Mesa's, which is several times as fast as Chromium's own.
MESA = ["--use-angle=gl-egl", "--ignore-gpu-blocklist"]
CASES = [
    ((640, 480), 100, 25),
    ((1280, 960), 100, 25),
    ((640, 480), 100, 49),
    ((640, 480), 250, 25),
    ((1920, 1080), 100, 25),
]
FRAME = """async ([n, zoom]) => {
  const viewer = viewers[n];
  const start = performance.now();
  const { cameraState: camera } = viewer;
  viewer.setCamera({ ...camera, parallel_scale: camera.parallel_scale / zoom });
  while (!viewer.sharp) await new Promise(requestAnimationFrame);
  return performance.now() - start;
}"""
DRIVER = """() => {
  const gl = document.createElement("canvas").getContext("webgl2");
  const found = gl.getExtension("WEBGL_debug_renderer_info");
  return found ? gl.getParameter(found.UNMASKED_RENDERER_WEBGL) : "unknown";
}"""


def scene(nodes: int, samples: int) -> Any:
    """Pack a double gyre of ``nodes`` by twice as many nodes as JSON."""
    field = flowtex.examples.double_gyre_field(shape=(nodes, 2 * nodes))
    view = web_views(field, Options.split(samples=samples))[0]
    whole = view.data()
    settings = flowtex.Settings(samples=samples)
    return packed(whole, whole.header(settings, camera=whole.first_camera(4 / 3).to_dict()))


def frames(*, gpu: bool, repeats: int) -> tuple[str, Table]:
    """Least time of a full picture in each case."""
    from playwright.sync_api import sync_playwright

    table = Table("size", "nodes", "samples", "ms a frame", "over the first")
    first = 0.0
    with sync_playwright() as driver:
        browser = driver.chromium.launch(
            executable_path=shutil.which("chromium") or shutil.which("google-chrome"),
            args=[] if gpu else MESA,
        )
        page = ClientPage(browser.new_page(viewport={"width": 1960, "height": 1120}))
        drawn_by = page.page.evaluate(DRIVER)
        for size, nodes, samples in CASES:
            viewer = page.mount(scene(nodes, samples), size=size, controls=False, smooth=False)
            page.sharp(viewer)
            times = [page.page.evaluate(FRAME, [viewer, 1.01]) for _ in range(repeats)]
            first = first or min(times)
            cells = (f"{min(times):.0f}", f"{min(times) / first:.2f}")
            table.add_row(f"{size[0]} x {size[1]}", f"{nodes} x {2 * nodes}", str(samples), *cells)
            page.clear()
        browser.close()
    return drawn_by, table


def first_parts() -> float:
    """Seconds from a mesh of 500 x 500 nodes to the first textures for a notebook."""
    field = flowtex.examples.double_gyre_field(shape=(500, 500))
    start = time.perf_counter()
    coarse = web_views(field, Options.split())[0].coarse_data(40_000)
    coarse.surface()
    coarse.step(0)
    return time.perf_counter() - start


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--gpu", action="store_true", help="Chromium's own choice of driver")
    parser.add_argument("--first", action="store_true", help="time to the first textures")
    parser.add_argument("--repeats", type=int, default=3)
    arguments = parser.parse_args()
    console = Console()
    if arguments.first:
        console.print(f"500 x 500 nodes, mesh to first textures: {first_parts():.2f} s")
        return
    drawn_by, table = frames(gpu=arguments.gpu, repeats=arguments.repeats)
    console.print(f"[bold]{drawn_by}[/]")
    console.print(table)


if __name__ == "__main__":
    main()
