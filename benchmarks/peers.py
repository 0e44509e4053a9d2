"""flowtex beside its peers: ``python benchmarks/peers.py``.

On every surface of surfaces.py, in two or three sizes: flowtex with its defaults, grey, and VTK's
enhanced Surface LIC, in PyVista's default plotter. The table has the time from the mesh in memory
to the first picture, and the least time of a frame while the camera turns about its focal point by
half a degree; in brackets the time of the processor. ``per tenfold`` is the time of a frame over
that of the smallest size, for ten times the nodes. Of the last frame it has the mean angle between
texture and flow in degrees, the coherence of its streaks, and ``sticking``: the correlation with a
picture at the same points of the surface, for which the camera has moved farther.

Every case runs in a separate process, one after the other in turn; ``--repeats`` takes the least of
several. ``--surfaces`` and ``--nodes`` choose others, ``--large`` up to four million nodes of grids
and five million triangles. ``--methods`` draws one plane by other
methods as well: ``vtkStreamTracer`` seeded at random, and PyVista's evenly spaced streamlines.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

FRAMES = 4
#: Degrees by which the camera turns for a frame.
TURN = 0.5
#: How far the camera moves to the right and up, as a share of the window, to see what sticks.
MOVE = (0.03, 0.02)
#: Seeds of streamlines, and the separation of evenly spaced ones as a share of the height.
SEEDS, SEPARATION = 2000, 0.01
#: The plane of ``--methods``, and its nodes.
PLANE, PLANE_NODES = "crooked plane", 100_000
#: Seconds for a case.
TIMEOUT_S = 300.0
#: Figures of a case.
Row = dict[str, Any]


def flowtex_grey(plotter: Any, mesh: Any) -> None:
    """Draw with flowtex, without colours."""
    plotter.flowtex.add(mesh, scalars=False)


def flowtex_speed(plotter: Any, mesh: Any) -> None:
    """Draw with flowtex, coloured by speed."""
    plotter.flowtex.add(mesh, show_scalar_bar=False)


def surface_lic(plotter: Any, mesh: Any) -> None:
    """Draw with VTK's Surface LIC at its enhanced setting."""
    from scenes import lic_actor

    plotter.add_actor(lic_actor(mesh.extract_surface(algorithm="dataset_surface")))


def stream_tracer(plotter: Any, mesh: Any) -> None:
    """Draw streamlines of VTK from random nodes."""
    nodes = np.random.default_rng(0).choice(mesh.n_points, SEEDS)
    lines = mesh.streamlines_from_source(
        mesh.extract_points(nodes, include_cells=False),
        vectors="velocity",
        surface_streamlines=True,
        max_length=float(np.ptp(mesh.points[:, 1])),
    )
    plotter.add_mesh(lines, color="black")


def evenly_spaced(plotter: Any, mesh: Any) -> None:
    """Draw PyVista's evenly spaced streamlines."""
    separation = SEPARATION * float(np.ptp(mesh.points[:, 1]))
    lines = mesh.streamlines_evenly_spaced_2D(
        vectors="velocity",
        start_position=mesh.center,
        separating_distance=separation,
        separating_distance_ratio=0.5,
        step_length=0.3 * separation,
        step_unit="l",
    )
    plotter.add_mesh(lines, color="black")


#: What draws; the first two are compared on every surface.
CASES: dict[str, Callable[[Any, Any], None]] = {
    "flowtex": flowtex_grey,
    "Surface LIC": surface_lic,
    "flowtex, by speed": flowtex_speed,
    "vtkStreamTracer": stream_tracer,
    "evenly spaced lines": evenly_spaced,
}
OURS, LIC = list(CASES)[:2]


def measure(case: str, name: str, nodes: int, size: tuple[int, int]) -> Row:
    """Measure one case in this process."""
    import pyvista as pv
    from camera_moves import pan, rotate
    from surfaces import GRIDS, TRIANGLES

    import flowtex.plotting.component  # noqa: F401 plotter.flowtex
    from flowtex.rendering.camera import apply_camera, read_camera
    from flowtex.rendering.diagnostics import prefer_headless

    prefer_headless()
    mesh = (GRIDS | TRIANGLES)[name](nodes)
    plotter: Any = pv.Plotter(off_screen=True, window_size=list(size))
    plotter.set_background("white")
    plotter.add_mesh(pv.Cube())  # so that the driver has loaded
    plotter.render()
    plotter.clear_actors()

    def picture() -> Any:
        plotter.render()
        plotter.render_window.WaitForCompletion()
        return np.asarray(plotter.screenshot(return_img=True))

    began = time.perf_counter(), time.process_time()
    CASES[case](plotter, mesh)
    flat, aspect = np.ptp(mesh.points[:, 2]) == 0, size[0] / size[1]
    plotter.camera_position = "xy" if flat else "iso"
    plotter.reset_camera(render=False)
    shown, spent = picture(), [spent_since(began)]
    for _ in range(FRAMES):
        plotter.camera.Azimuth(TURN)
        began = time.perf_counter(), time.process_time()
        shown = picture()
        spent.append(spent_since(began))
    camera = read_camera(plotter.camera)
    moved = (pan if flat else rotate)(camera, *MOVE, aspect)
    apply_camera(moved, plotter.camera)
    return {
        "nodes": mesh.n_points,
        "cells": mesh.n_cells,
        "first": spent[0],
        "frame": np.min(spent[1:], axis=0).tolist(),
        **judge(mesh, shown, camera, picture(), moved),
    }


def spent_since(began: tuple[float, float]) -> tuple[float, float]:
    """Return seconds elapsed, and of the processor."""
    return time.perf_counter() - began[0], time.process_time() - began[1]


def judge(mesh: Any, shown: Any, camera: Any, later: Any, moved: Any) -> Row:
    """Measure the quality of a picture, and how it sticks in a later one; both have a camera."""
    from measures import grey, streaks
    from scipy.ndimage import map_coordinates
    from surfaces import surface_view

    import flowtex

    height, width = shown.shape[:2]
    view = surface_view(flowtex.FlowField.from_pyvista(mesh), camera, (width, height))
    there = moved.project(view.place[view.mask], width / height)
    at = [(1 - there[:, 1]) / 2 * height - 0.5, (1 + there[:, 0]) / 2 * width - 0.5]
    carried = map_coordinates(grey(later), at, order=1, mode="nearest")
    sticking = np.corrcoef(carried, grey(shown)[view.mask])[0, 1]
    return {**streaks(shown, view.u, view.v, view.mask), "sticking": float(sticking)}


def run(case: str, name: str, nodes: int, size: tuple[int, int]) -> Row | str:
    """Measure in a separate process; return the reason as text if that failed."""
    words = ["--one", case, "--surfaces", name, "--nodes", str(nodes), "--size", *map(str, size)]
    try:
        done = subprocess.run(
            [sys.executable, __file__, *words],
            capture_output=True,
            text=True,
            timeout=TIMEOUT_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return f"more than {TIMEOUT_S:g} s"
    if done.returncode:
        return (done.stderr.strip().splitlines() or ["failed"])[-1][:60]
    row: Row = json.loads(done.stdout.splitlines()[-1])
    return row


def best(cases: list[str], *where: Any, repeats: int) -> dict[str, Row | str]:
    """Measure cases in turn, and keep the least times of each."""
    found: dict[str, Row | str] = {}
    for case in cases * repeats:
        row, kept = run(case, *where), found.get(case)
        if isinstance(row, dict) and isinstance(kept, dict):
            row |= {n: np.minimum(row[n], kept[n]).tolist() for n in ("first", "frame")}
        found[case] = row
    return found


def line(*cells: str) -> None:
    """Print a row of a table."""
    print("|", " | ".join(cells), "|", flush=True)  # noqa: T201


def times(row: Row, name: str) -> str:
    """Write a time, and that of the processor."""
    return "{:.2f} ({:.2f})".format(*row[name])


def ratio(over: Row, under: Row, name: str) -> str:
    """Write the ratio of two times, and that of the processor's."""
    return "{:.1f} ({:.1f})".format(*np.divide(over[name], under[name]))


def compare(
    names: list[str], sizes: dict[str, Sequence[int]], size: tuple[int, int], repeats: int
) -> None:
    """Print the table of surfaces."""
    head = ["surface", "nodes", "cells", "first, s", "LIC", "ours / LIC"]
    head += ["frame, s", "LIC", "LIC / ours", "per tenfold"]
    line(*head, "angle, LIC", "coherence, LIC", "sticking, LIC")
    line(*["---"] * (len(head) + 3))
    for name in names:
        smallest: Row | None = None
        for nodes in sizes[name]:
            both = best([OURS, LIC], name, nodes, size, repeats=repeats)
            ours, lic = both[OURS], both[LIC]
            if isinstance(ours, str) or isinstance(lic, str):
                line(name, f"{nodes:,}", *(f"{case}: {row}" for case, row in both.items()))
                continue
            smallest = smallest or ours
            growth = math.log10(ours["nodes"] / smallest["nodes"])
            grown = np.divide(ours["frame"], smallest["frame"])
            cells = [name, f"{ours['nodes']:,}", f"{ours['cells']:,}"]
            cells += [times(ours, "first"), times(lic, "first"), ratio(ours, lic, "first")]
            cells += [times(ours, "frame"), times(lic, "frame"), ratio(lic, ours, "frame")]
            cells += ["{:.2f} ({:.2f})".format(*grown ** (1 / growth)) if growth else ""]
            cells += [f"{ours['angle']:.1f}, {lic['angle']:.1f}"]
            line(*cells, *(f"{ours[n]:.2f}, {lic[n]:.2f}" for n in ("coherence", "sticking")))


def compare_methods(size: tuple[int, int], repeats: int) -> None:
    """Print the table of methods on one plane."""
    line(f"{PLANE}, {PLANE_NODES:,} nodes", "first, s", "frame, s", "angle", "coherence")
    line(*["---"] * 5)
    for case, row in best(list(CASES), PLANE, PLANE_NODES, size, repeats=repeats).items():
        if isinstance(row, str):
            line(case, row)
            continue
        figures = f"{row['angle']:.1f}", f"{row['coherence']:.2f}"
        line(case, times(row, "first"), times(row, "frame"), *figures)


def main() -> None:
    """Print a table."""
    from surfaces import (
        GRID_NODES,
        GRIDS,
        LARGE_GRID_NODES,
        LARGE_TRIANGLE_NODES,
        TRIANGLE_NODES,
        TRIANGLES,
    )

    names = list(GRIDS | TRIANGLES)
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--surfaces", nargs="*", choices=names, default=names)
    parser.add_argument("--nodes", nargs="*", type=int, default=[], help="sizes of each")
    parser.add_argument("--large", action="store_true", help="the largest sizes of each")
    parser.add_argument("--size", nargs=2, type=int, default=(800, 600))
    parser.add_argument("--repeats", type=int, default=1)
    parser.add_argument("--methods", action="store_true", help="compare methods on one plane")
    parser.add_argument("--one", choices=list(CASES), help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    size = (arguments.size[0], arguments.size[1])
    if arguments.one:
        row = measure(arguments.one, arguments.surfaces[0], arguments.nodes[0], size)
        print(json.dumps(row))  # noqa: T201
        return
    from flowtex.rendering.diagnostics import require_opengl

    print(f"{require_opengl().renderer}, {size[0]} x {size[1]}\n")  # noqa: T201
    if arguments.methods:
        compare_methods(size, arguments.repeats)
    else:
        grid_nodes: Sequence[int] = arguments.nodes or GRID_NODES
        triangle_nodes: Sequence[int] = arguments.nodes or TRIANGLE_NODES
        if arguments.large:
            grid_nodes = LARGE_GRID_NODES
            triangle_nodes = LARGE_TRIANGLE_NODES
        sizes = dict.fromkeys(GRIDS, grid_nodes) | dict.fromkeys(TRIANGLES, triangle_nodes)
        compare(arguments.surfaces, sizes, size, arguments.repeats)


if __name__ == "__main__":
    main()
