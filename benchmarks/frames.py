"""Time of a frame against its pixels, samples and nodes: ``python benchmarks/frames.py``.

Everything is measured in one run, so the ratios mean something on a noisy machine; the figure is
the least of several frames, each with a camera that has moved a little.
``--lic`` measures VTK's enhanced Surface LIC in the same views.
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import pyvista as pv
from rich.console import Console
from rich.table import Table
from scenes import grid_of, lic_actor

import flowtex
from flowtex.rendering.diagnostics import require_opengl


def frame(
    field: flowtex.FlowField,
    size: tuple[int, int],
    repeats: int,
    *,
    lic: bool = False,
    **settings: Any,
) -> float:
    """Least time of a frame in milliseconds."""
    plotter: Any = pv.Plotter(off_screen=True, window_size=list(size))
    plotter.disable_anti_aliasing()
    if lic:
        plotter.add_actor(lic_actor(grid_of(field)))
        plotter.view_xy()
    else:
        plotter.flowtex.add(field, show_scalar_bar=False, **settings)
    plotter.camera.zoom(2.0)
    plotter.screenshot(return_img=True)
    best = float("inf")
    for _ in range(repeats):
        plotter.camera.zoom(1.01)
        start = time.perf_counter()
        plotter.render()
        plotter.render_window.WaitForCompletion()
        best = min(best, time.perf_counter() - start)
    plotter.close()
    return 1e3 * best


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--lic", action="store_true")
    given = parser.parse_args()
    console = Console()
    report = require_opengl()
    console.print(f"[bold]{report.renderer}[/]")
    heads = ("size", "nodes", "samples", "arrows", "ms a frame", "frames a second")
    table = Table(*heads, "over the first", *["Surface LIC, ms", "quotient"][: 2 * given.lic])
    first = 0.0
    for size, nodes, samples, arrows in [
        ((640, 480), 100, 25, False),
        ((1280, 960), 100, 25, False),
        ((640, 480), 100, 50, False),
        ((640, 480), 500, 25, False),
        ((1920, 1080), 100, 25, False),
        ((1920, 1080), 100, 49, False),
        ((1920, 1080), 100, 49, True),
        ((1920, 1080), 500, 25, False),
        ((1920, 1080), 2000, 25, False),
    ]:
        field = flowtex.examples.double_gyre_field(shape=(nodes, 2 * nodes))
        ms = frame(field, size, given.repeats, samples=samples, arrows=arrows)
        first = first or ms
        shape = f"{nodes} x {2 * nodes}"
        cells = [f"{ms:.2f}", f"{1e3 / ms:.1f}", f"{ms / first:.2f}"]
        if given.lic:
            theirs = frame(field, size, given.repeats, lic=True)
            cells += [f"{theirs:.2f}", f"{theirs / ms:.1f}"]
        with_arrows = "yes" if arrows else ""
        table.add_row(f"{size[0]} x {size[1]}", shape, str(samples), with_arrows, *cells)
    console.print(table)


if __name__ == "__main__":
    main()
