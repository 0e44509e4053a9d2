"""Lags of the slices.

A streak is a fixed number of pixels, so its length on the surface doubles with every level of
detail. The lags therefore double too, from a quarter of a cell, where a path between two nodes
is as good as straight, to a quarter of the whole surface.
"""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.field import FlowField

#: First lag in cells, last lag as a share of the surface's extent, greatest number of lags.
FIRST_CELLS, LAST_EXTENTS, MOST_CHOSEN_LAGS = 0.25, 0.25, 24
#: Parts of an octave to which a chosen last lag is rounded.
LAST_PARTS = 8
#: Percentile of the sizes of cells that counts as that of small ones.
SMALL_CELLS = 5
#: Least and greatest size of cells, in multiples of one unit, with which they share it.
LEAST_CELL, MOST_CELL = 0.25, 16.0
#: Quotient of one lag and the one before.
RATIO = 2.0
#: Least number of lags that are drawn; the uncertainty of a flow lies in the layer of one more.
LEAST_LAGS = 2


def lag_unit(field: FlowField, parameter: str) -> Floats:
    """Return one unit of lag at each node, (J, I): the cell size by arc length, or a unit of time.

    On triangles it is the size of small cells everywhere, so that paths can be composed.
    """
    if parameter == "arclength":
        size = field.surface.cell_size
        if field.triangles is None:
            return size
        return np.full(field.shape, np.percentile(size[field.valid], SMALL_CELLS))
    return np.ones(field.shape)


def longest_path(field: FlowField) -> float:
    """Return the default length of the paths; a globe is as wide as a side of its bounding box."""
    poles = field.surface.poles
    closed = poles is not None and poles.both
    return LAST_EXTENTS * field.surface.extent / (np.sqrt(3) if closed else 1)


def choose_lags(
    field: FlowField, parameter: str, longest: float | None = None, first_cells: float = FIRST_CELLS
) -> Floats:
    """Return lags from a quarter of a cell to a quarter of the surface, (M,), in lag units.

    ``first_cells`` sets the first one in cells, ``longest`` the last in the mesh's units.
    """
    if longest is None:
        longest = longest_path(field)
    least = LEAST_LAGS + bool(field.uncertainty)
    if parameter == "arclength":
        first, last = first_cells, longest / small_cell(field)
    else:
        speed = field.typical.index_velocity.speed[:, field.valid]
        moving = speed > 1e-6 * speed.max() if speed.any() else np.zeros_like(speed, dtype=bool)
        if not moving.any():
            return RATIO ** np.arange(float(least))
        size = field.surface.cell_size[field.valid]
        crossing = np.broadcast_to(size, speed.shape)[moving] / speed[moving]
        first = first_cells * float(np.percentile(crossing, 10))
        on_earth = field.projection is not None
        typical = typical_speed(field) if on_earth else np.sqrt(np.mean(speed[moving] ** 2))
        last = longest / float(typical)
        if not field.steady:
            # Long paths can be composed of lags that reach other time steps.
            step = float(np.mean(np.diff(field.times)))
            first = step * RATIO ** np.rint(np.log(first / step) / np.log(RATIO))
    count = max(int(np.ceil(np.log(max(last / first, RATIO)) / np.log(RATIO))) + 1, least)
    return np.asarray(first * RATIO ** np.arange(min(count, MOST_CHOSEN_LAGS)))


def typical_speed(field: FlowField) -> float:
    """Return the root mean square of the speed, on maps that on the Earth; 1 in a flow at rest."""
    typical = field.typical
    on_earth = field.projection is not None and "speed" in field.scalars
    steps = typical.scalars["speed"] if on_earth else typical.speed
    speed = np.asarray(steps)[:, field.valid] / field.speed_scale
    finite = speed[np.isfinite(speed)]
    return float(np.sqrt(np.square(finite).sum() / max(finite.size, 1))) or 1.0


def small_cell(field: FlowField) -> float:
    """Return the size of the small cells of a field."""
    return float(np.percentile(field.surface.cell_size[field.valid], SMALL_CELLS))


def drawn_lags(
    field: FlowField,
    parameter: str,
    longest: float | None = None,
    cell: float | None = None,
    first_cells: float = FIRST_CELLS,
) -> tuple[Floats, Floats]:
    """Return lags to draw with, (M,), and their unit at each node, (J, I).

    Cells of about the same size have one unit, so that a path takes the same slice everywhere, and
    is composed at a single look-up. In a part of a surface it is that surface's ``cell`` times a
    power of two: all parts have the same lags. The last is ``longest``, if set.
    """
    unit = lag_unit(field, parameter)
    if parameter == "time":
        lags = choose_lags(field, parameter, longest, first_cells)
        # Half precision holds lags near one, in any unit of time.
        first = 2.0 ** np.rint(np.log2(lags[0]))
        return lags / first, unit * first
    sizes, even = unit[field.valid], small_cell(field)
    if cell is not None:
        even = cell * 2.0 ** np.rint(np.log2(even / cell))
    alike = LEAST_CELL * even <= sizes.min() and sizes.max() <= MOST_CELL * even
    if not alike or field.triangles is not None:
        return choose_lags(field, parameter, longest, first_cells), unit
    unit = np.full(field.shape, even)
    if longest is None:
        return choose_lags(field, parameter, first_cells=first_cells), unit
    # The last is a sum of few lags that double, as paths are composed of whole slices.
    part = 2.0 ** np.floor(np.log2(longest / even)) / LAST_PARTS
    last = np.ceil(longest / even / part) * part
    doubled = first_cells * RATIO ** np.arange(MOST_CHOSEN_LAGS - 1)
    # A last lag that is hardly longer than the one before replaces it.
    lags = np.append(doubled[doubled < last / np.sqrt(RATIO)], last)
    lacking = LEAST_LAGS + bool(field.uncertainty) - len(lags)
    return np.append(lags, last * RATIO ** np.arange(1.0, lacking + 1)), unit
