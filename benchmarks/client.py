"""Time of the browser client: ``python benchmarks/client.py``.

Frames of the WebGL2 client against pixels, samples and nodes, measured in Chromium: from a
change of the view until the full picture is there. On a graphics card start with ``--gpu``,
which takes Chromium's own choice of driver; without one Mesa's software driver is taken.
``--first`` measures from a mesh of 500 x 500 nodes to the first textures that a notebook is sent,
``--large`` compares 4000 x 2000 nodes, drawn in tiles, with 120 x 70.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

import flowtex
from flowtex.host.view import TileSource, web_views
from flowtex.rendering.camera import Camera
from flowtex.rendering.webgl.client_data import ClientData
from flowtex.rendering.webgl.protocol import Parts
from flowtex.scene.options import Options
from flowtex.textures.tiles.pyramid import TileKey

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


def large(*, gpu: bool, repeats: int) -> Table:
    """Least time of a full picture of many nodes and of few, whole and close up."""
    from playwright.sync_api import sync_playwright

    table = Table("nodes", "zoom", "tiles", "s until complete", "ms a frame", "over few nodes")
    few: dict[float, float] = {}
    with sync_playwright() as driver:
        browser = driver.chromium.launch(
            executable_path=shutil.which("chromium") or shutil.which("google-chrome"),
            args=[] if gpu else MESA,
        )
        page = ClientPage(browser.new_page(viewport={"width": 1320, "height": 1000}))
        for shape in ((70, 120), (2000, 4000)):
            field = flowtex.examples.double_gyre_field(shape=shape)
            view = web_views(field, Options.split(samples=25))[0]
            whole = view.data()
            page.tile = _tiles(whole)
            for zoom in (1.0, 8.0, 40.0):
                camera = Camera.fit(field.surface, 4 / 3, zoom=zoom)
                given = packed(whole, whole.header(view.scene.settings, camera=camera.to_dict()))
                start = time.perf_counter()
                viewer = page.mount(given, size=(1280, 960), controls=False, smooth=False)
                page.complete(viewer)
                waited = time.perf_counter() - start
                times = [page.page.evaluate(FRAME, [viewer, 1.01]) for _ in range(repeats)]
                few.setdefault(zoom, min(times))
                tiles = page.page.evaluate("(n) => viewers[n].tiles.layers.length - 1", viewer)
                cells = (f"{shape[1]} x {shape[0]}", f"{zoom:g}", str(tiles), f"{waited:.1f}")
                table.add_row(*cells, f"{min(times):.0f}", f"{min(times) / few[zoom]:.2f}")
                page.clear()
        browser.close()
    return table


def _tiles(whole: ClientData) -> Callable[[Any, Any], Parts]:
    """Return what gives the page the tiles of a scene."""
    source = TileSource(whole)
    return lambda key, steps: source.parts(TileKey(*key), steps)


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
    parser.add_argument("--large", action="store_true", help="many nodes against few")
    parser.add_argument("--repeats", type=int, default=3)
    arguments = parser.parse_args()
    console = Console()
    if arguments.large:
        console.print(large(gpu=arguments.gpu, repeats=arguments.repeats))
        return
    if arguments.first:
        console.print(f"500 x 500 nodes, mesh to first textures: {first_parts():.2f} s")
        return
    drawn_by, table = frames(gpu=arguments.gpu, repeats=arguments.repeats)
    console.print(f"[bold]{drawn_by}[/]")
    console.print(table)


if __name__ == "__main__":
    main()
