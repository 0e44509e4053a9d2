"""Paths, critical points and vorticity against exact solutions: ``python benchmarks/exact.py``.

The velocity of the double gyre and of the rotation of a sphere is known in closed form. Paths,
composed as for a picture, are compared with those of an eighth-order solver in the exact velocity,
in cells and as a share of their length. The last column is for slices in half precision, as
textures store them.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import flowtex
from flowtex.examples import double_gyre_field, double_gyre_velocity

Floats = NDArray[np.float64]
Exact = Callable[[Floats, float], Floats]

#: Cells along the shorter side of the grids, and the time step of a series to compare.
SIZES, STEP = (25, 50, 100, 200), 20
#: Axis of the rotation, which carries particles over both poles of the grid.
AXIS = np.array([1.0, 0.0, 0.0])


def gyre(points: Floats, lag: float, end: float, epsilon: float) -> Floats:
    """Return where particles at ``points`` (N, 3) were, by the exact velocity, (N, 2)."""

    def rate(t: float, flat: Floats) -> Floats:
        here = flat.reshape(-1, 2)
        return np.asarray(-double_gyre_velocity(here, end - t, epsilon=epsilon).ravel())

    way = solve_ivp(rate, (0, lag), points[:, :2].ravel(), method="DOP853", rtol=1e-10, atol=1e-12)
    return np.asarray(way.y[:, -1].reshape(-1, 2))


def compare(field: flowtex.FlowField, exact: Exact, lag: float, step: int = 0) -> list[str]:
    """Return the median and the 95th percentile of the distance, and medians as shares."""
    cell = float(np.median(field.surface.cell_size))
    lags = lag * 2.0 ** np.arange(-6.0, 1.0)
    slices = flowtex.trace(field, lags=lags, unit=1.0, parameter="time", compose=True)
    chosen = np.isinf(slices.reach[step]) & field.valid
    start = field.points[chosen]
    there = exact(start, lag)
    found = []
    for moved in (
        slices.displacement[step, -1],
        (slices.displacement[step, -1] / lag).astype(np.float16).astype(float) * lag,
    ):
        place = field.surface.at(slices.nodes + moved)[chosen][:, : there.shape[1]]
        found.append(np.linalg.norm(place - there, axis=-1))
    way = np.linalg.norm(there - start[:, : there.shape[1]], axis=-1)
    moving = way > cell
    percent = [100 * np.median(away[moving] / way[moving]) for away in found]
    middle, most = np.quantile(found[0] / cell, [0.5, 0.95])
    return [f"{middle:.4f}", f"{most:.4f}", *(f"{share:.3f}" for share in percent)]


def paths_table() -> Table:
    """Return errors of paths of up to a quarter of the surface."""
    table = Table(
        "flow", "cells", "median, cells", "95 %, cells", "median, % of path", "half precision, %"
    )
    for size in SIZES:
        shape = (size + 1, 2 * size + 1)
        field = double_gyre_field(shape=shape)
        row = compare(field, partial(gyre, end=0.0, epsilon=0.0), 2.0)
        table.add_row("double gyre, steady", f"{2 * size} x {size}", *row)
    for size in SIZES[1:3]:
        field = double_gyre_field(time_varying=True, shape=(size + 1, 2 * size + 1))
        end = float(field.times[STEP])
        row = compare(field, partial(gyre, end=end, epsilon=0.25), 2.0, STEP)
        table.add_row("double gyre, 41 steps a period", f"{2 * size} x {size}", *row)
    for rows in (37, 73):
        lon, lat = np.meshgrid(
            np.linspace(0, 2 * np.pi, 2 * rows - 1), np.linspace(-1, 1, rows) * np.pi / 2
        )
        points = np.stack(
            [np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)], axis=-1
        )
        field = flowtex.FlowField.from_arrays(points, np.cross(AXIS, points))
        row = compare(field, lambda p, lag: Rotation.from_rotvec(-lag * AXIS).apply(p), 1.0)
        table.add_row("rotation over the poles", f"{2 * rows - 2} x {rows - 1}", *row)
    return table


def points_table() -> Table:
    """Return errors of critical points, and of vorticity."""
    table = Table(
        "cells", "centres, cells", "vorticity, % of its largest value", "of the row above"
    )
    before = None
    for size in SIZES:
        shape = (size + 1, 2 * size + 1)
        varying = double_gyre_field(time_varying=True, shape=shape).at_step(10)  # at time 2.5
        found = flowtex.critical_points(varying).of_kind("centre")
        exact = np.array([[np.sqrt(3.0) - 1, 0.5], [np.sqrt(7.0) - 1, 0.5]])
        places = np.array(sorted(tuple(point.position[:2]) for point in found))
        away = np.linalg.norm(places - exact, axis=1).max() * size
        field = double_gyre_field(shape=shape)
        known = np.asarray(field.scalars["vorticity"])
        errors = np.abs(np.asarray(field.derive("vorticity")) - known)
        worst = 100 * float(np.nanmax(errors) / np.abs(known).max())
        ratio = "" if before is None else f"{before / worst:.1f}"
        table.add_row(f"{2 * size} x {size}", f"{away:.5f}", f"{worst:.4f}", ratio)
        before = worst
    return table


if __name__ == "__main__":
    console = Console(width=110)
    console.print(paths_table(), points_table())
