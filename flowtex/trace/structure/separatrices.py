"""Separatrices: the lines that leave saddles, along which the flow parts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from flowtex._util.arguments import checked_number
from flowtex._util.array_types import Bools, Floats
from flowtex.field import FlowField
from flowtex.field.locate import locator
from flowtex.trace.structure.critical_points import (
    CriticalPoint,
    CriticalPoints,
    critical_points,
)
from flowtex.trace.trace import paths

#: Distance from the saddle at which a line begins, and between its points, in cells.
BEGIN_CELLS, POINT_CELLS = 0.05, 0.5
#: Length of a line, as a share of the surface's extent, and points of one at most.
LENGTH_EXTENTS, MOST_POINTS = 3.0, 4000
#: Points of a line before others may end it, and distance in cells from a critical point at which
#: one is followed no longer.
FIRST_POINTS, REST_CELLS = 4, 0.25
#: Distance in cells between two turns of a line at which it is a closed orbit.
CLOSED_CELLS = 0.02
#: Distance in cells at which a line ends at a critical point, and least points of a turn.
END_CELLS, LEAST_TURN = 0.75, 8


@dataclass(frozen=True, eq=False)
class Separatrix:
    """A line along which the flow leaves a saddle, or comes to one.

    ``points`` are (N, 3), from the saddle on, in the mesh's units; ``forward`` says whether the
    flow leaves the saddle along the line; ``closed`` whether the line ends on a closed orbit, which
    is then its last turn.
    """

    points: Floats
    saddle: CriticalPoint
    forward: bool
    closed: bool = False


class Separatrices(list[Separatrix]):
    """Separatrices of a field, in the order of times and saddles.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.double_gyre_field(shape=(41, 81))
    >>> lines = flowtex.separatrices(field)
    >>> lines.to_pyvista().n_cells == len(lines)
    True
    """

    def to_pyvista(self) -> Any:
        """Return lines as a ``pyvista.PolyData``, with ``forward`` and ``time`` of each."""
        import pyvista as pv

        counts = np.array([len(line.points) for line in self], dtype=int)
        firsts = np.cumsum(counts) - counts
        cells = [[n, *range(first, first + n)] for n, first in zip(counts, firsts, strict=True)]
        points = np.concatenate([np.empty((0, 3)), *(line.points for line in self)])
        mesh = pv.PolyData(points, lines=np.concatenate(cells) if cells else None)
        mesh.cell_data["forward"] = np.array([line.forward for line in self], dtype=np.uint8)
        mesh.cell_data["time"] = np.array([line.saddle.time for line in self])
        return mesh


def separatrices(
    field: FlowField, *, steps: Sequence[int] | None = None, length: float | None = None
) -> Separatrices:
    """Follow the lines that leave the saddles of a field, four from each.

    Parameters
    ----------
    field
        The flow; of a field that varies the streamlines of each step.
    steps
        Numbers of the time steps; all by default.
    length
        Longest line, in the mesh's units; three times the extent of the surface by default.

    Returns
    -------
    Separatrices
        A list of :class:`Separatrix`. A line ends at another critical point, at a border or a gap,
        where it joins a closed orbit, or where it is as long as was asked for.

    Raises
    ------
    FieldError
        When the vectors have no sign, the length is not positive, or there is no such step.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.double_gyre_field(shape=(41, 81))
    >>> lines = flowtex.separatrices(field)
    >>> any(abs(line.points[-1, 0] - 1) < 0.02 for line in lines)
    True
    """
    most = LENGTH_EXTENTS * field.surface.extent
    if length is not None:
        expected = "a positive length in the mesh's units"
        most = checked_number("length", length, np.nextafter(0, 1), expected=expected)
    numbers = range(len(field.times)) if steps is None else [field.step_number(n) for n in steps]
    lines = Separatrices()
    for number in numbers:
        part = field.at_step(number)
        points = critical_points(part)
        for forward in (True, False):
            lines += _lines(part, points, most, forward=forward)
    return lines


def _lines(
    field: FlowField, points: CriticalPoints, most: float, *, forward: bool
) -> list[Separatrix]:
    """Return the lines that leave saddles, or those that come to them."""
    saddles = points.of_kind("saddle")
    if not saddles:
        return []
    cells = np.array([_cell(field, saddle) for saddle in saddles])
    ways = [saddle.eigenvectors[0 if forward else 1].real for saddle in saddles]
    centers = np.array([saddle.position for saddle in saddles])
    offsets = BEGIN_CELLS * cells[:, None] * np.array(ways)
    begin, _ = locator(field).nearest(np.concatenate([centers + offsets, centers - offsets]))
    begin = np.asarray(begin)[:, ::-1]
    spacing = POINT_CELLS * float(np.median(cells))
    lags = np.arange(1, min(int(most / spacing), MOST_POINTS) + 1) * spacing
    positions, reach = _followed(field, points, begin, lags, forward=forward)
    ends = KDTree([point.position for point in points])
    result = []
    for n, first in enumerate(begin):
        saddle, cell = saddles[n % len(saddles)], cells[n % len(saddles)]
        shown = positions[: int(np.searchsorted(lags, reach[n])), n]
        if not len(shown):  # it points out of the surface
            continue
        line = field.surface.at(np.concatenate([first[None], shown]))
        distance, which = (np.asarray(a) for a in ends.query(line))
        away = np.flatnonzero(distance > 2 * END_CELLS * cell)
        arrived = np.flatnonzero(distance < END_CELLS * cell)
        arrived = arrived[arrived > away[0]] if len(away) else arrived[:0]
        end = int(arrived[0]) if len(arrived) else len(line)
        turned = _turned(line[:end], spacing, CLOSED_CELLS * cell)
        closed = turned is not None
        if turned is not None:
            line = line[: turned + 1]
        elif len(arrived):
            line = np.concatenate([line[: end + 1], points[int(which[end])].position[None]])
        line = np.concatenate([saddle.position[None], line])
        result.append(Separatrix(line, saddle, forward, closed))
    return result


def _followed(
    field: FlowField, points: CriticalPoints, begin: Floats, lags: Floats, *, forward: bool
) -> tuple[Floats, Floats]:
    """Follow paths from positions (N, 2); return positions (M, N, 2), and how far they lead, (N,).

    Once away from their saddles they end beside critical points, where steps become ever shorter.
    """
    follow = partial(paths, field, parameter="arclength", forward=forward)
    first = follow(begin, lags[:FIRST_POINTS])
    positions, reach = np.repeat(first.positions[-1:], len(lags), axis=0), first.reach.copy()
    positions[:FIRST_POINTS] = first.positions
    away = np.flatnonzero(np.isinf(reach))
    if len(away) and len(lags) > FIRST_POINTS:
        near = KDTree([point.index[::-1] for point in points])

        def within(index: Floats) -> Bools:
            return np.isinf(near.query(index.T, distance_upper_bound=REST_CELLS)[0])

        left = lags[FIRST_POINTS:] - lags[FIRST_POINTS - 1]
        later = follow(first.positions[-1, away], left, within=within)
        positions[FIRST_POINTS:, away] = later.positions
        reach[away] = lags[FIRST_POINTS - 1] + later.reach
    return positions, reach


def _cell(field: FlowField, point: CriticalPoint) -> float:
    """Return the size of a cell at a point."""
    j, i = field.surface.node_near(point.index)
    return float(field.surface.cell_size[j, i])


def _turned(line: Floats, spacing: float, near: float) -> int | None:
    """Return the number of the first of points (N, 3) on the last turn, or ``None``."""
    pairs = KDTree(line).query_pairs(0.75 * spacing, output_type="ndarray")
    pairs = pairs[pairs[:, 1] - pairs[:, 0] > LEAST_TURN]
    if not len(pairs):
        return None
    before, after = pairs[np.argsort(pairs[:, 1])].T
    way = line[np.minimum(before + 1, len(line) - 1)] - line[np.maximum(before - 1, 0)]
    way /= np.maximum(np.linalg.norm(way, axis=1, keepdims=True), np.finfo(float).tiny)
    gap = line[after] - line[before]
    beside = np.linalg.norm(gap - np.einsum("nc,nc->n", gap, way)[:, None] * way, axis=1)
    close = np.flatnonzero(beside < near)
    return int(after[close[0]]) if len(close) else None
