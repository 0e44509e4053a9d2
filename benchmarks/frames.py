"""Time of a frame against its pixels, samples and nodes: ``python benchmarks/frames.py``.

Everything is measured in one run on one plotter, so the ratios mean something on a noisy
machine; the figure is the least of several frames, each with a camera that has moved a little.
"""

from __future__ import annotations

import argparse
import time

import pyvista as pv
from rich.console import Console
from rich.table import Table

import flowtex
from flowtex.diagnostics import require_opengl


def frame(size: tuple[int, int], nodes: int, samples: int, repeats: int, *, arrows: bool) -> float:
    """Least time of a frame in milliseconds."""
    field = flowtex.examples.double_gyre_field(shape=(nodes, 2 * nodes))
    plotter = pv.Plotter(off_screen=True, window_size=list(size))
    plotter.disable_anti_aliasing()
    handle = plotter.flowtex.add(field, samples=samples, arrows=arrows, show_scalar_bar=False)
    plotter.camera.zoom(2.0)
    plotter.screenshot(return_img=True)
    best = float("inf")
    for _ in range(repeats):
        plotter.camera.zoom(1.01)
        start = time.perf_counter()
        plotter.render()
        plotter.render_window.WaitForCompletion()
        best = min(best, time.perf_counter() - start)
    handle.remove(render=False)
    plotter.close()
    return 1e3 * best


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=5)
    repeats = parser.parse_args().repeats
    console = Console()
    report = require_opengl()
    console.print(f"[bold]{report.renderer}[/]")
    heads = ("size", "nodes", "samples", "arrows", "ms a frame", "frames a second")
    table = Table(*heads, "over the first")
    first = 0.0
    for size, nodes, samples, arrows in [
        ((640, 480), 100, 25, False),
        ((1280, 960), 100, 25, False),
        ((640, 480), 100, 50, False),
        ((640, 480), 500, 25, False),
        ((1920, 1080), 100, 25, False),
        ((1920, 1080), 100, 49, False),
        ((1920, 1080), 100, 49, True),
    ]:
        ms = frame(size, nodes, samples, repeats, arrows=arrows)
        first = first or ms
        shape = f"{nodes} x {2 * nodes}"
        cells = (f"{ms:.1f}", f"{1e3 / ms:.1f}", f"{ms / first:.2f}")
        with_arrows = "yes" if arrows else ""
        table.add_row(f"{size[0]} x {size[1]}", shape, str(samples), with_arrows, *cells)
    console.print(table)


if __name__ == "__main__":
    main()
