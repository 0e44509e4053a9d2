"""Separatrices: the lines that leave saddles, along which the flow parts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy

from flowtex._util.arguments import checked_count, checked_number
from flowtex._util.array_types import Bools, Floats
from flowtex.field import FlowField
from flowtex.field.locate import locator
from flowtex.trace.structure.critical_points import (
    CriticalPoint,
    CriticalPoints,
    cell_sizes,
    critical_points,
    steady_parts,
)
from flowtex.trace.structure.formula_lines import follower, plane_rates
from flowtex.trace.structure.orbits import isolation

if TYPE_CHECKING:
    import pyvista as pv

BEGIN_CELLS = 0.05  #: Distance from the saddle at which a line begins, in cells.
POINT_CELLS = 0.5  #: Distance between the points of a line, in cells.
LENGTH_EXTENTS = 3.0  #: Length of a line, as a share of the surface's extent.
MOST_POINTS = 4000  #: Most points of a line.
FIRST_POINTS = 4  #: Points of a line that cannot end at a critical point.
REST_CELLS = 0.25  #: Distance from a critical point at which tracing stops, in cells.
CLOSED_CELLS = 0.02  #: Distance in cells between two turns of a line at which it is a closed orbit.
WOUND_POINTS = 2.0  #: The same where it winds up, in distances of its points.
END_CELLS = 0.75  #: Distance from a critical point at which a line is joined to it, in cells.
LEAST_TURN = 8  #: Least number of points in a turn.


@dataclass(frozen=True, eq=False)
class Separatrix:
    """A line along which the flow leaves a saddle, or comes to one.

    ``points`` are (N, 3), from the saddle on, in the mesh's units; ``forward`` says whether the
    flow leaves the saddle along the line; ``closed`` whether the line ends on a closed orbit, which
    is then its last turn, the points from number ``turn`` on. ``lonlat`` are longitudes and
    latitudes of the points in degrees, (N, 2), for a field of the Earth.
    """

    points: Floats
    saddle: CriticalPoint
    forward: bool
    closed: bool = False
    turn: int | None = None
    lonlat: Floats | None = None

    @property
    def orbit(self) -> Floats | None:
        """Points of the closed orbit on which the line ends, (N, 3), or ``None``."""
        if self.turn is None:
            return None
        return self.points[self.turn :]

    @cached_property
    def unwound(self) -> Floats:
        """The points up to the second turn that lies close beside the one before, (N, 3).

        A picture has no room for more turns.
        """
        spacing = float(np.median(np.linalg.norm(np.diff(self.points, axis=0), axis=1)))
        turn = _turned(self.points, spacing, WOUND_POINTS * spacing)
        if turn is None:
            return self.points
        return self.points[: 2 * turn[1] - turn[0] + 1]


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

    def records(self) -> list[dict[str, Any]]:
        """Return a dictionary for each line: its saddle, end, length and direction."""
        rows = []
        for line in self:
            row: dict[str, Any] = {"time": line.saddle.time, "strength": line.saddle.strength}
            row |= {"forward": line.forward, "closed": line.closed}
            row["length"] = float(np.linalg.norm(np.diff(line.points, axis=0), axis=1).sum())
            for end, position in (("saddle", line.points[0]), ("end", line.points[-1])):
                for axis, value in zip("xyz", position.tolist(), strict=True):
                    row[f"{end}_{axis}"] = value
            rows.append(row)
        return rows

    def to_pyvista(self) -> pv.PolyData:
        """Return lines as a ``pyvista.PolyData``.

        Its cell arrays are ``forward``, ``closed``, ``time``, and the saddle's ``strength``.
        """
        import pyvista as pv

        points = [np.empty((0, 3))]
        cells: list[int] = []
        first = 0
        for line in self:
            count = len(line.points)
            points.append(line.points)
            cells += [count, *range(first, first + count)]
            first += count
        mesh = pv.PolyData(np.concatenate(points), lines=cells or None)
        mesh.cell_data["forward"] = np.array([line.forward for line in self], dtype=np.uint8)
        mesh.cell_data["closed"] = np.array([line.closed for line in self], dtype=np.uint8)
        mesh.cell_data["time"] = np.array([line.saddle.time for line in self])
        mesh.cell_data["strength"] = np.array([line.saddle.strength for line in self])
        return mesh


def separatrices(
    field: FlowField,
    *,
    steps: Sequence[int] | None = None,
    length: float | None = None,
    strongest: int | None = None,
) -> Separatrices:
    """Follow the lines that leave the saddles of a field, four from each.

    Parameters
    ----------
    field
        The flow; of a time-varying one, the streamlines of each step are followed.
    steps
        Indices of the time steps; all by default.
    length
        Maximum length of a line, in the mesh's units; by default three times the extent of the
        surface.
    strongest
        Number of saddles of each step to start from, the strongest first; all by default.

    Returns
    -------
    Separatrices
        A sequence of ``Separatrix``. A line ends at another critical point, at a border or a
        gap, where it joins a closed orbit, or at the maximum length.

    Raises
    ------
    FieldError
        When the field is sign-free, the length or the number of saddles is not positive, or a step
        does not exist.

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
    if strongest is not None:
        checked_count("strongest", strongest, expected="a number of saddles, 1 or more")
    lines = Separatrices()
    for part in steady_parts(field, steps, "Following separatrices"):
        lines += separatrices_between(part, critical_points(part), most, strongest)
    return lines


def separatrices_between(
    field: FlowField,
    points: CriticalPoints,
    length: float,
    strongest: int | None = None,
    *,
    most: int = MOST_POINTS,
) -> Separatrices:
    """Follow the lines of a steady field whose critical points are known.

    They have at most ``most`` points; the other arguments are as for :func:`separatrices`.
    """
    saddles = points.of_kind("saddle", "degenerate")
    if strongest is not None:
        saddles = saddles.strongest(strongest)
    lines = Separatrices()
    if saddles:
        for forward in (True, False):
            lines += _lines(field, points, saddles, length, most, forward=forward)
    return lines


def _lines(
    field: FlowField,
    points: CriticalPoints,
    saddles: CriticalPoints,
    length: float,
    most: int,
    *,
    forward: bool,
) -> list[Separatrix]:
    """Return the lines that leave saddles, or those that come to them."""
    starts: list[CriticalPoint] = []
    ways: list[Floats] = []
    for saddle in saddles:
        for way in saddle.ways(forward=forward):
            starts.append(saddle)
            ways.append(way)
    if not starts:
        return []
    cells = cell_sizes(starts, field)
    offsets = BEGIN_CELLS * cells[:, None] * np.array(ways)
    positions_of_saddles = np.array([saddle.position for saddle in starts])
    begin, _ = locator(field).nearest(positions_of_saddles + offsets)
    begin = np.array(begin[:, ::-1], dtype=float)
    spacing = POINT_CELLS * float(np.median(cells))
    lags = spacing * np.arange(1.0, min(int(length / spacing), most) + 1)
    positions, reach = _followed(field, points, begin, lags, forward=forward)
    ends = scipy.spatial.KDTree([point.position for point in points])
    is_isolated = isolation(field)
    result = []
    for n, saddle in enumerate(starts):
        shown = positions[: int(np.searchsorted(lags, reach[n])), n]
        if not len(shown):  # it points out of the surface
            continue
        index = np.concatenate([begin[n : n + 1], shown])
        line = field.surface.at(index)
        end, point = _arrival(line, ends, cells[n])
        turned = _turned(line[:end], spacing, CLOSED_CELLS * cells[n])
        turn = None
        if turned is not None and is_isolated(index[slice(*turned)]):
            turn = turned[0] + 1
            line = line[: turned[1] + 1]
        elif point is not None:
            line = np.concatenate([line[: end + 1], points[point].position[None]])
        line = np.concatenate([saddle.position[None], line])
        places = None
        if field.projection is not None:
            places = np.stack(field.projection.lonlat(line), axis=-1)
        result.append(Separatrix(line, saddle, forward, turn is not None, turn, places))
    return result


def _arrival(line: Floats, ends: Any, cell: float) -> tuple[int, int | None]:
    """Return where a line reaches a critical point, and which; its length and ``None`` if nowhere.

    ``ends`` is the tree of the points, and ``cell`` the size of the cell at the saddle. A line
    must have left the surroundings of its saddle before.
    """
    distance, which = ends.query(line)
    away = np.flatnonzero(distance > 2 * END_CELLS * cell)
    if not len(away):
        return len(line), None
    arrived = np.flatnonzero(distance < END_CELLS * cell)
    arrived = arrived[arrived > away[0]]
    if not len(arrived):
        return len(line), None
    end = int(arrived[0])
    return end, int(which[end])


def _followed(
    field: FlowField, points: CriticalPoints, begin: Floats, lags: Floats, *, forward: bool
) -> tuple[Floats, Floats]:
    """Follow paths from (N, 2); return positions (M, N, 2), and how far they lead, (N,)."""
    follow = partial(follower(field, plane_rates(field)), forward=forward)
    first = follow(begin, lags[:FIRST_POINTS])
    positions = np.repeat(first.positions[-1:], len(lags), axis=0)
    reach = first.reach.copy()
    positions[:FIRST_POINTS] = first.positions
    away = np.flatnonzero(np.isinf(reach))
    if len(away) and len(lags) > FIRST_POINTS:
        near = scipy.spatial.KDTree([point.index[::-1] for point in points])

        def within(index: Floats) -> Bools:
            # Paths go on beyond a seam.
            index = field.surface.wrap(index.T)
            distances, _ = near.query(index, distance_upper_bound=REST_CELLS)
            is_far: Bools = np.isinf(np.asarray(distances, dtype=float))
            return is_far

        left = lags[FIRST_POINTS:] - lags[FIRST_POINTS - 1]
        later = follow(first.positions[-1, away], left, within=within)
        positions[FIRST_POINTS:, away] = later.positions
        reach[away] = lags[FIRST_POINTS - 1] + later.reach
    return positions, reach


def _turned(line: Floats, spacing: float, near: float) -> tuple[int, int] | None:
    """Return the numbers of points (N, 3) between which a line turns once, or ``None``."""
    around = max(0.75 * spacing, 1.25 * near)
    pairs = scipy.spatial.KDTree(line).query_pairs(around, output_type="ndarray")
    pairs = pairs[pairs[:, 1] - pairs[:, 0] > LEAST_TURN]
    # Points may be dense where the flow is slow, on a straight line.
    along = np.cumsum(np.linalg.norm(np.diff(line, axis=0, prepend=line[:1]), axis=1))
    pairs = pairs[along[pairs[:, 1]] - along[pairs[:, 0]] > 2 * around]
    if not len(pairs):
        return None
    before, after = pairs[np.argsort(pairs[:, 1])].T
    tangent = line[np.minimum(before + 1, len(line) - 1)] - line[np.maximum(before - 1, 0)]
    tangent /= np.maximum(np.linalg.norm(tangent, axis=1, keepdims=True), np.finfo(float).tiny)
    gap = line[after] - line[before]
    beside = np.linalg.norm(gap - np.einsum("nc,nc->n", gap, tangent)[:, None] * tangent, axis=1)
    close = np.flatnonzero(beside < near)
    if len(close):
        return (int(before[close[0]]), int(after[close[0]]))
    return None
