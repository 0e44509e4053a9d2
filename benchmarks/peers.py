"""flowtex beside its peers: ``python benchmarks/peers.py``.

On the same meshes and views, in one run: VTK's enhanced Surface LIC, rlic with two passes on the
image's own grid, ``vtkStreamTracer`` seeded at random, PyVista's evenly spaced streamlines, and
flowtex with its defaults, grey and coloured by speed. For each the time to the first picture, the
least time of a frame whose camera has moved a little, the mean angle between texture and flow in
degrees, the coherence of its streaks, and the memory that the process has taken. The last columns
divide by flowtex's own times. Every case runs in a separate process, so that memory is its own.

``--size`` and ``--meshes`` choose others; on a graphics card the run says its name.

``--surfaces`` draws surfaces of triangles instead (all, or those that are named; see surfaces.py),
by flowtex and by Surface LIC, and tells how the pattern sticks as well: the correlation of two
pictures at the same points of the surface, between which the camera has moved.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

#: Rows and columns of nodes; "c" stands for a grid whose lines are crooked.
MESHES = ("70x120", "70x120c", "250x500", "250x500c", "500x1000", "500x1000c", "2000x4000")
FRAMES = 4
#: Seeds of streamlines, and the separation of evenly spaced ones as a share of the height.
SEEDS, SEPARATION = 2000, 0.01
#: Passes and taps of rlic.
PASSES, TAPS = 2, 25

#: Draws a view of scenes.py.
Draw = Callable[[Any], Any]


def place(view: Any) -> dict[str, Any]:
    """Zoom and focus of a view."""
    return {"zoom": view.options["zoom"], "focus": view.options["focus"]}


def flow(mesh: str) -> Any:
    """Return the double gyre on a sheared, stretched grid, or on a crooked one."""
    from scenes import gyre_field

    rows, columns = (int(n) for n in mesh.removesuffix("c").split("x"))
    return gyre_field(columns, rows, crooked=mesh.endswith("c"))


def flowtex_grey(field: Any, size: tuple[int, int]) -> Draw:
    """Draw with flowtex, without colours."""
    from scenes import Stage

    stage = Stage(field, size)
    return lambda view: stage.picture(**place(view))


def flowtex_speed(field: Any, size: tuple[int, int]) -> Draw:
    """Draw with flowtex, coloured by speed."""
    from scenes import Stage

    stage = Stage(field, size)
    stage.handle.remove(render=False)
    stage.handle = stage.plotter.flowtex.add(field, show_scalar_bar=False)
    return lambda view: stage.picture(**place(view))


def surface_lic(field: Any, size: tuple[int, int]) -> Draw:
    """Draw with VTK's Surface LIC at its enhanced setting."""
    from scenes import Stage

    stage = Stage(field, size, surface_lic=True)
    return lambda view: stage.picture(**place(view))


def two_passes(field: Any, size: tuple[int, int]) -> Draw:
    """Draw with rlic on the pixels of the view."""
    import rlic

    noise = np.random.default_rng(0).uniform(size=size[::-1])
    kernel = np.ones(TAPS)

    def draw(view: Any) -> Any:
        picture = rlic.convolve(noise, view.u, -view.v, kernel=kernel, iterations=PASSES)
        return (255 * picture / TAPS**PASSES).astype(np.uint8)

    return draw


def _lines(field: Any, size: tuple[int, int], make: Callable[[Any, float], Any]) -> Draw:
    """Draw lines that ``make`` gives of a mesh and its height."""
    import pyvista as pv

    from flowtex.plotting.vtk_camera import point_camera
    from flowtex.scene.options import ViewOptions

    rows, columns = field.shape
    grid = pv.StructuredGrid()
    grid.points, grid.dimensions = field.points.reshape(-1, 3), (columns, rows, 1)
    grid["velocity"] = field.velocity[0].reshape(-1, 3)
    plotter: Any = pv.Plotter(off_screen=True, window_size=list(size))
    plotter.disable_anti_aliasing()
    plotter.set_background("white")
    plotter.add_mesh(make(grid, float(np.ptp(field.points[..., 1]))), color="black")

    def draw(view: Any) -> Any:
        point_camera(plotter, field.surface, ViewOptions(**place(view)))
        plotter.render()
        return np.asarray(plotter.screenshot(return_img=True))

    return draw


def stream_tracer(field: Any, size: tuple[int, int]) -> Draw:
    """Draw streamlines of VTK from random nodes."""

    def make(grid: Any, height: float) -> Any:
        nodes = np.random.default_rng(0).choice(grid.n_points, SEEDS)
        seeds = grid.extract_points(nodes, include_cells=False)
        return grid.streamlines_from_source(
            seeds, vectors="velocity", surface_streamlines=True, max_length=height
        )

    return _lines(field, size, make)


def evenly_spaced(field: Any, size: tuple[int, int]) -> Draw:
    """Draw PyVista's evenly spaced streamlines."""

    def make(grid: Any, height: float) -> Any:
        return grid.streamlines_evenly_spaced_2D(
            vectors="velocity",
            start_position=grid.center,
            separating_distance=SEPARATION * height,
            separating_distance_ratio=0.5,
            step_length=0.3 * SEPARATION * height,
            step_unit="l",
        )

    return _lines(field, size, make)


CASES: dict[str, Callable[[Any, tuple[int, int]], Draw]] = {
    "flowtex, grey": flowtex_grey,
    "flowtex, by speed": flowtex_speed,
    "Surface LIC": surface_lic,
    "rlic, two passes": two_passes,
    "vtkStreamTracer": stream_tracer,
    "evenly spaced lines": evenly_spaced,
}
#: What the others are compared with.
OURS = "flowtex, grey"


def measure(case: str, mesh: str, size: tuple[int, int]) -> dict[str, float]:
    """Measure one case in this process."""
    from measures import streaks
    from scenes import gyre_view

    import flowtex.plotting.component  # noqa: F401 plotter.flowtex
    from flowtex.rendering.diagnostics import prefer_headless

    prefer_headless()
    field = flow(mesh)
    views = [gyre_view(field, 1.0 - 1e-4 * n, size) for n in range(FRAMES + 1)]
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    start = time.perf_counter()
    draw = CASES[case](field, size)
    picture = draw(views[0])
    first, frames = time.perf_counter() - start, []
    for view in views[1:]:
        start = time.perf_counter()
        picture = draw(view)
        frames.append(time.perf_counter() - start)
    found = streaks(picture, views[-1].u, views[-1].v, views[-1].mask)
    taken = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    return {
        "first": first,
        "frame": min(frames),
        "angle": found["angle"],
        "coherence": found["coherence"],
        "MB": taken / 1024,
    }


def picture_of(case: str, field: Any, size: tuple[int, int]) -> Draw:
    """Return what draws a surface of triangles for a camera."""
    import pyvista as pv
    from scenes import lic_actor
    from surfaces import as_polydata

    from flowtex.plotting.vtk_camera import apply_camera

    plotter: Any = pv.Plotter(off_screen=True, window_size=list(size))
    plotter.disable_anti_aliasing()
    plotter.set_background("white")
    if case == "Surface LIC":
        plotter.add_actor(lic_actor(as_polydata(field)))
    else:
        plotter.flowtex.add(field, scalars=False, lighting=False)

    def draw(camera: Any) -> Any:
        apply_camera(camera, plotter.camera)
        plotter.camera_set = True
        plotter.renderer.reset_camera_clipping_range()
        plotter.render()
        return np.asarray(plotter.screenshot(return_img=True))

    return draw


def measure_surface(case: str, name: str, size: tuple[int, int]) -> dict[str, float]:
    """Measure one case on a surface of triangles in this process."""
    from measures import grey, streaks
    from scipy.ndimage import map_coordinates
    from surfaces import SURFACES, surface_view

    import flowtex.plotting.component  # noqa: F401 plotter.flowtex
    from flowtex.rendering.camera import Camera
    from flowtex.rendering.diagnostics import prefer_headless

    prefer_headless()
    field = SURFACES[name]()
    aspect = size[0] / size[1]
    camera = Camera.fit(field.surface, aspect)
    start = time.perf_counter()
    draw = picture_of(case, field, size)
    picture = draw(camera)
    first, frames = time.perf_counter() - start, []
    for n in range(FRAMES):
        camera = Camera.fit(field.surface, aspect, zoom=1 - 1e-4 * (n + 1))
        start = time.perf_counter()
        picture = draw(camera)
        frames.append(time.perf_counter() - start)
    view = surface_view(field, camera, size)
    found = streaks(picture, view.u, view.v, view.mask)
    flat = field.surface.frame is not None
    moved = (camera.pan if flat else camera.rotate)(0.03, 0.02, aspect)
    there = moved.project(view.place[view.mask], aspect)
    at = [(1 - there[:, 1]) / 2 * size[1] - 0.5, (1 + there[:, 0]) / 2 * size[0] - 0.5]
    carried = map_coordinates(grey(draw(moved)), at, order=1, mode="nearest")
    found["sticking"] = float(np.corrcoef(carried, grey(picture)[view.mask])[0, 1])
    count = 0 if field.triangles is None else len(field.triangles)
    return {"first": first, "frame": min(frames), "triangles": count, **found}


def run(words: list[str], timeout: float) -> dict[str, float] | str:
    """Measure in a separate process; in words what kept it from that."""
    try:
        done = subprocess.run(
            [sys.executable, __file__, *words],
            capture_output=True,
            text=True,
            timeout=timeout,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return f"more than {timeout:g} s"
    if done.returncode:
        return (done.stderr.strip().splitlines() or ["failed"])[-1][:60]
    row: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    return row


def compare_surfaces(names: list[str], size: tuple[int, int], timeout: float) -> Table:
    """Measure both on every surface."""
    heads = ("", "triangles", "first, s", "frame, s", "angle", "coherence", "sticking")
    table = Table("surface", *heads, "frame / ours")
    for name in names:
        ours = None
        for case in (OURS, "Surface LIC"):
            words = ["--one", case, "--surfaces", name, "--size", *map(str, size)]
            row = run(words, timeout)
            if isinstance(row, str):
                table.add_row(name, case, row)
                continue
            ours = ours or row["frame"]
            figures = [f"{row['triangles']:,.0f}", f"{row['first']:.2f}", f"{row['frame']:.3f}"]
            figures += [f"{row['angle']:.1f}", f"{row['coherence']:.2f}", f"{row['sticking']:.2f}"]
            table.add_row(name, case, *figures, f"{row['frame'] / ours:.1f}")
    return table


def compare(mesh: str, size: tuple[int, int], timeout: float) -> Table:
    """Measure every case on a mesh, each in a separate process."""
    rows: dict[str, dict[str, float] | str] = {}
    for case in CASES:
        words = ["--one", case, "--meshes", mesh, "--size", *map(str, size)]
        rows[case] = run(words, timeout)
    names = ("first, s", "frame, s", "angle", "coherence", "MB", "first / ours", "frame / ours")
    table = Table(f"{mesh} nodes, {size[0]} x {size[1]}", *names)
    ours = rows[OURS]
    for case, row in rows.items():
        if isinstance(row, str) or isinstance(ours, str):
            table.add_row(case, str(row))
            continue
        table.add_row(
            case,
            f"{row['first']:.2f}",
            f"{row['frame']:.3f}",
            f"{row['angle']:.1f}",
            f"{row['coherence']:.2f}",
            f"{row['MB']:.0f}",
            f"{row['first'] / ours['first']:.1f}",
            f"{row['frame'] / ours['frame']:.1f}",
        )
    return table


def main() -> None:
    """Print a table for each mesh."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--meshes", nargs="*", default=list(MESHES), help="rows x columns, and c for a crooked grid"
    )
    parser.add_argument("--size", nargs=2, type=int, default=(800, 600))
    parser.add_argument("--timeout", type=float, default=120.0, help="seconds for a case")
    parser.add_argument("--one", choices=list(CASES), help=argparse.SUPPRESS)
    parser.add_argument("--surfaces", nargs="*", help="surfaces of triangles")
    arguments = parser.parse_args()
    size = (arguments.size[0], arguments.size[1])
    if arguments.one and arguments.surfaces:
        print(json.dumps(measure_surface(arguments.one, arguments.surfaces[0], size)))  # noqa: T201
        return
    if arguments.one:
        print(json.dumps(measure(arguments.one, arguments.meshes[0], size)))  # noqa: T201
        return
    from flowtex.rendering.diagnostics import require_opengl

    console = Console(width=120)
    console.print(f"[bold]{require_opengl().renderer}[/]")
    if arguments.surfaces is not None:
        from surfaces import SURFACES

        names = arguments.surfaces or list(SURFACES)
        console.print(compare_surfaces(names, size, arguments.timeout))
        return
    for mesh in arguments.meshes:
        console.print(compare(mesh, size, arguments.timeout))


if __name__ == "__main__":
    main()
