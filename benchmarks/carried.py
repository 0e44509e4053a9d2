"""What is carried to a browser: ``python benchmarks/carried.py``.

Pages of a steady gyre on a crooked grid, of a cylinder's wake at 31 times and of winds on the
globe, with the velocity, which the browser traces, and with slices: bytes of the page and of a node
at one time, processor time of writing it, and seconds from opening it in headless Chromium until
the picture is whole. ``--meshes`` chooses others, as rows x columns, ``wake``, ``globe``, or the
path of data that are shown on the globe. Compare within one run.
"""

from __future__ import annotations

import argparse
import shutil
import tempfile
import time
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table
from scenes import gyre_field

from flowtex import examples
from flowtex.scene.options import Options

#: Rows and columns of nodes, the cylinder's wake along pathlines, and winds.
MESHES = ("70x120", "250x500", "500x1000", "wake", "globe")
SIZE = {"width": 800, "height": 600}
#: Software drawing: Mesa's, which is several times as fast as Chromium's own.
MESA = ["--use-angle=gl-egl", "--ignore-gpu-blocklist"]
#: A view whose picture is whole.
COMPLETE = '.flowtex[data-sharp="true"][data-tiles="0"]'


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--meshes", nargs="*", default=list(MESHES), help="such as 70x120 globe")
    arguments = parser.parse_args()
    from playwright.sync_api import sync_playwright

    from flowtex.host.export import page_text
    from flowtex.host.view import web_views
    from flowtex.rendering.webgl import velocity

    can_trace = velocity.can_trace
    names = ("page, MB", "bytes a node", "written in, s of processor", "drawn after, s")
    table = Table("nodes, and what a page has", *names)
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=MESA)
        for mesh in arguments.meshes:
            data, options = _flow(mesh)
            field = web_views(data, options)[0].field
            name = " × ".join(map(str, field.shape[::-1]))
            if len(field.times) > 1:
                name += f", {len(field.times)} times"
            for traces in (True, False):
                velocity.can_trace = can_trace if traces else lambda _: False
                path = Path(folder) / f"{mesh}.html"
                start = time.process_time()
                views = web_views(data, options)
                path.write_text(page_text(views), encoding="utf-8")
                written = time.process_time() - start
                page = browser.new_page(viewport=SIZE)
                start = time.perf_counter()
                page.goto(path.as_uri())
                page.wait_for_selector(COMPLETE, timeout=300_000)
                drawn = time.perf_counter() - start
                page.close()
                size = path.stat().st_size
                table.add_row(
                    f"{name}, {'velocity' if traces else 'slices'}",
                    f"{size / 1e6:.2f}",
                    f"{size / field.valid.size / len(field.times):.1f}",
                    f"{written:.2f}",
                    f"{drawn:.1f}",
                )
        browser.close()
    Console(width=110).print(table)


def _flow(mesh: str) -> tuple[Any, Options]:
    """Return what is drawn, and the options with which it is."""
    if mesh == "wake":
        return examples.cylinder_field(), Options.split(lines="pathlines")
    if mesh == "globe":
        return examples.weather(), Options.split(globe=True, level=250)
    if Path(mesh).exists():
        return mesh, Options.split(globe=True)
    rows, columns = (int(n) for n in mesh.split("x"))
    return gyre_field(columns, rows, crooked=True), Options.split()


if __name__ == "__main__":
    main()
