"""Closed orbits: lines that end where they began, and that other lines approach or leave.

A closed orbit in a plane turns around a critical point that is not a saddle, so it crosses every
ray from there. Where the flow returns to a ray one turn later shows the side of an orbit: from both
sides it comes nearer, or moves away. :func:`isolation` distinguishes an orbit from a centre. Orbits
of a formula in the plane are then integrated from the formula.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, partial

import numpy as np
import scipy

from flowtex._util.arguments import check_field
from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.field import FlowField
from flowtex.field.formula.rates import Rates
from flowtex.field.locate import locator, surface_point
from flowtex.trace.structure.critical_points import (
    CriticalPoints,
    cell_sizes,
    critical_points,
    gradient_and_error,
    steady_parts,
)
from flowtex.trace.structure.formula_lines import follower, formula_orbit, plane_rates

POINT_CELLS = 0.5  #: Distance between the points of a line, in cells.
CHUNK = 50  #: Points that are computed at once.
TURN_EXTENTS = 3.0  #: Greatest length of a turn, as a share of the surface's extent.
MOST_POINTS = 3000  #: Most points of a turn.
FIRST_CELLS = 1.0  #: Distance of the first point of a ray, in cells.
RATIO = 1.2  #: Ratio of successive distances on a ray.
EXTENT_SHARE = 0.03  #: Greatest distance between points of a ray, as a share of the extent.
MOVED_CELLS = 0.05  #: Least radial displacement in a turn, in cells.
MOVED_SHARE = 0.05  #: Least radial displacement in a turn, as a share of the radius.
MOVED_EXACT = 1e-6  #: This share for the lines of a formula.
CLOSED_CELLS = 0.1  #: Greatest gap of a closed orbit, in cells.
PARTS = 64  #: Parts of a section of a ray with an orbit.
ROUNDS = 2  #: Number of times that the section is divided.
REST_CELLS = 0.25  #: Distance from a critical point at which a line ends, in cells.
WALL_CELLS = 0.05  #: Distance from a wall at which a line ends, in cells.
MOST_RAYS = 8  #: Critical points around which orbits are searched for, the strongest ones.


@dataclass(frozen=True, eq=False)
class ClosedOrbit:
    """A line that ends where it began.

    Attributes
    ----------
    points
        The line, (N, 3), in the mesh's units and in the direction of the flow; its last point is
        the first one.
    stable
        Whether neighbouring lines converge to the orbit; they leave it otherwise.
    period
        Time for one revolution.
    time
        When, in the unit of time of the field.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.formula("y", "(1 - x**2) * y - x", x=(-3, 3), y=(-4, 4), resolution=65)
    >>> flowtex.closed_orbits(field)[0].stable
    True
    """

    points: Floats
    stable: bool
    period: float
    time: float


def closed_orbits(field: FlowField, *, steps: Sequence[int] | None = None) -> list[ClosedOrbit]:
    """Find closed orbits that lines come to or leave, such as limit cycles.

    Parameters
    ----------
    field
        The flow; of a time-varying one, the streamlines of each step.
    steps
        Indices of the time steps; all by default.

    Returns
    -------
    list of ClosedOrbit

    Raises
    ------
    FieldError
        When the field is sign-free, or a step does not exist.

    Notes
    -----
    The search covers the 8 strongest critical points that are not saddles. Orbits closer together
    than a thirtieth of the surface may be missed. Divergence-free flows have only neutral orbits,
    which are not reported: attraction or repulsion must exceed the interpolation error. Orbits of a
    formula in the plane are computed from the formula itself; their periods have a relative error
    below 1e-6.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.formula("y", "(1 - x**2) * y - x", x=(-3, 3), y=(-4, 4))
    >>> (orbit,) = flowtex.closed_orbits(field)
    >>> orbit.stable, round(orbit.period, 1), round(float(orbit.points[:, 0].max()), 1)
    (True, 6.7, 2.0)
    """
    check_field(field, FlowField)
    orbits: list[ClosedOrbit] = []
    for part in steady_parts(field, steps, "Finding closed orbits"):
        orbits += orbits_around(part, critical_points(part))
    return orbits


def orbits_around(field: FlowField, points: CriticalPoints) -> list[ClosedOrbit]:
    """Find the closed orbits of a steady field whose critical points are known."""
    rates = plane_rates(field)
    around = CriticalPoints()
    for point in points:
        # On a grid, lines must approach the point or leave it by enough in a turn.
        growth = abs(point.eigenvalues[0].real)
        rotation = abs(point.eigenvalues[0].imag)
        if point.poincare_index > 0 and (rates or 2 * np.pi * growth > MOVED_SHARE * rotation):
            around.append(point)
    around = around.strongest(MOST_RAYS)
    if not around:
        return []
    rays = _Rays(field, points, around, rates)
    low, high, ray, stable = rays.turns()
    orbits: list[ClosedOrbit] = []
    for forward in (True, False):
        chosen = stable == forward
        for orbit in rays.orbits(low[chosen], high[chosen], ray[chosen], forward=forward):
            if not _is_known(orbit, orbits, 2 * rays.spacing):
                orbits.append(orbit)
    return orbits


def _is_known(orbit: ClosedOrbit, known: Sequence[ClosedOrbit], distance: float) -> bool:
    """Return whether the first point of an orbit is closer to a known orbit than a distance."""
    for other in known:
        nearest, _ = scipy.spatial.KDTree(other.points).query(orbit.points[0])
        if nearest < distance:
            return True
    return False


class _Rays:
    """Rays from critical points; starts on them are distances and numbers of rays, (N,)."""

    def __init__(
        self, field: FlowField, points: CriticalPoints, around: CriticalPoints, rates: Rates | None
    ) -> None:
        self._field = field
        self._rates = rates
        surface = field.surface
        self._is_isolated = isolation(field)
        self._middle = np.array([point.position for point in around])
        self._cell = cell_sizes(around, field)
        self.spacing = POINT_CELLS * float(np.median(self._cell))
        vectors = np.array([point.eigenvectors for point in around])
        plane = np.linalg.svd(np.concatenate([vectors.real, vectors.imag], axis=1))[2]
        self._along = plane[:, 0]
        self._across = plane[:, 1]
        near = scipy.spatial.KDTree([point.index[::-1] for point in points])

        # Along a wall lines continue in ever shorter steps.
        ends = np.subtract(field.shape[::-1], 1.0)
        ends[list(field.periodic[::-1])] = np.inf
        low = np.where(np.isinf(ends), -np.inf, WALL_CELLS)
        high = ends - WALL_CELLS

        def within(index: Floats) -> Bools:
            position = surface.wrap(index.T)
            is_away = np.isinf(near.query(position, distance_upper_bound=REST_CELLS)[0])
            return np.asarray(is_away & ((low < index.T) & (high > index.T)).all(axis=1))

        self._follow = partial(follower(field, rates), within=within)

    def turns(self) -> tuple[Floats, Floats, Indices, Bools]:
        """Return stretches of rays with an orbit: both ends, the ray, and whether it is stable."""
        extent = self._field.surface.extent
        starts: list[tuple[float, int]] = []
        for which, cell in enumerate(self._cell):
            place = FIRST_CELLS * cell
            while place < extent:
                starts.append((place, which))
                place += min((RATIO - 1) * place, max(EXTENT_SHARE * extent, cell))
        places, number, index = self._put(*map(np.array, zip(*starts, strict=True)))
        moved = self._returns(index, number, forward=True) - places
        lost = np.isnan(moved)
        moved[lost] = places[lost] - self._returns(index[lost], number[lost], forward=False)
        with np.errstate(invalid="ignore"):
            least = np.maximum(MOVED_CELLS * self._cell[number], MOVED_SHARE * places)
            if self._rates is not None:  # what steps of fourth order may do
                least = np.maximum(MOVED_EXACT, (self.spacing / places) ** 4) * places
            measured = np.flatnonzero(np.abs(moved) > least)
        first = measured[:-1]
        second = measured[1:]
        gaps = np.cumsum(np.isnan(moved))
        turned = (moved[first] * moved[second] < 0) & (number[first] == number[second])
        turned &= gaps[first] == gaps[second]
        first = first[turned]
        second = second[turned]
        return places[first], places[second], number[first], moved[first] > 0

    def orbits(
        self, low: Floats, high: Floats, ray: Indices, *, forward: bool
    ) -> list[ClosedOrbit]:
        """Return the orbits between two places of rays, which lines join in a direction."""
        low = low.copy()
        high = high.copy()
        if self._rates is None:
            for _ in range(ROUNDS):
                self._narrow(low, high, ray, forward=forward)
        places, kept, index = self._put(0.5 * (low + high), np.arange(len(ray)), ray)
        lines: list[Floats] = [at[None] for at in index]
        end = self._returns(index, ray[kept], forward=forward, lines=lines)
        if self._rates is not None:
            exact = []
            for line in lines:
                orbit = self._exact(self._rates, line, forward=forward)
                if orbit is not None:
                    exact.append(orbit)
            return exact
        # Where lines jump from one side to the other there is no orbit.
        closed = np.abs(end - places) < CLOSED_CELLS * self._cell[ray[kept]]
        made = []
        for turn in itertools.compress(lines, closed):
            if self._is_isolated(turn):
                made.append(self._orbit(turn, stable=forward))
        return made

    def _exact(self, rates: Rates, turn: Floats, *, forward: bool) -> ClosedOrbit | None:
        """Return the orbit of a formula near a turn, indices (N, 2)."""
        near = self._orbit(turn, stable=forward)
        found = formula_orbit(rates, near.points[0, :2], near.period, forward=forward)
        if found is None or np.ptp(found[0]) < 0.5 * np.ptp(near.points):
            return None  # a point
        plane, period, stable = found
        points = np.column_stack([plane, np.zeros(len(plane))])
        return ClosedOrbit(points, stable, period, near.time)

    def _put(
        self, places: Floats, number: Indices, ray: Indices | None = None
    ) -> tuple[Floats, Indices, Floats]:
        """Return places (N,) on the surface, numbers of rays or of ``ray``, and indices (N, 2)."""
        if ray is None:
            rays = number
        else:
            rays = ray[number]
        if not len(places):
            return places, number, np.empty((0, 2))
        targets = self._middle[rays] + places[:, None] * self._along[rays]
        index, _ = locator(self._field).nearest(targets)
        index = np.array(index[:, ::-1], dtype=float)
        along, across = self._offsets(self._field.surface.at(index)[None], rays)
        reached = np.abs(along[0] - places) < 0.5 * self._cell[rays] + 0.1 * places
        on_ray = reached & (np.abs(across[0]) < 0.05 * self._cell[rays])
        return along[0][on_ray], number[on_ray], index[on_ray]

    def _offsets(self, points: Floats, ray: Indices) -> tuple[Floats, Floats]:
        """Return offsets of points (M, N, 3) along the rays and across them, (M, N) each."""
        offsets = points - self._middle[ray]
        return (
            np.einsum("mnc,nc->mn", offsets, self._along[ray]),
            np.einsum("mnc,nc->mn", offsets, self._across[ray]),
        )

    def _narrow(self, low: Floats, high: Floats, ray: Indices, *, forward: bool) -> None:
        """Replace stretches of rays by the part of each that contains the orbit.

        Where rounding hides the orbit, the stretch stays as it is.
        """
        share = np.linspace(0, 1, PARTS + 1)
        distances = low[:, None] + (high - low)[:, None] * share
        number = np.repeat(np.arange(len(ray)), PARTS + 1)
        places, kept, index = self._put(distances.ravel(), number, ray)
        moved = self._returns(index, ray[kept], forward=forward) - places
        first = np.flatnonzero((moved[:-1] >= 0) & (moved[1:] < 0) & (kept[:-1] == kept[1:]))
        low[kept[first]] = places[first]
        high[kept[first]] = places[first + 1]

    def _returns(
        self, index: Floats, ray: Indices, *, forward: bool, lines: list[Floats] | None = None
    ) -> Floats:
        """Return where lines from indices (N, 2) meet rays again; ``lines`` gets the points."""
        result = np.full(len(index), np.nan)
        going = np.arange(len(index))
        side = np.zeros(len(index))
        begin = index
        most = int(min(TURN_EXTENTS * self._field.surface.extent / self.spacing, MOST_POINTS))
        lags = self.spacing * np.arange(1.0, CHUNK + 1)
        for done in range(0, most, CHUNK):
            if not len(going):
                break
            found = self._follow(begin, lags, forward=forward)
            positions = np.concatenate([begin[None], found.positions])
            along, across = self._offsets(self._field.surface.at(positions), ray[going])
            if not done:
                side = np.where(across[1] > across[0], 1.0, -1.0)
            across = across * side
            alive = np.arange(1, CHUNK + 1)[:, None] <= np.searchsorted(lags, found.reach)
            back = (across[:-1] < 0) & (across[1:] >= 0) & (along[1:] > 0) & alive
            if not done:
                back[:2] = False
            at = np.argmax(back, axis=0)
            returned = np.asarray(back.any(axis=0))
            n = np.arange(len(going))
            share = across[at, n] / np.where(returned, across[at, n] - across[at + 1, n], 1.0)
            ends = along[at, n] + share * (along[at + 1, n] - along[at, n])
            result[going[returned]] = ends[returned]
            for column, k in enumerate(going):
                if lines is not None:
                    if returned[column]:
                        last = at[column] + 1
                    else:
                        last = CHUNK + 1
                    lines[k] = np.concatenate([lines[k], positions[1:last, column]])
            left = ~returned & alive.all(axis=0)
            going = going[left]
            side = side[left]
            begin = positions[-1, left]
        return result

    def _orbit(self, line: Floats, *, stable: bool) -> ClosedOrbit:
        """Make an orbit of a turn, indices (N, 2)."""
        surface = self._field.surface
        nodal = self._field.velocity[0]
        points = surface.at(np.concatenate([line, line[:1]]))
        velocity = _interpolated(self._field, nodal, line)
        # A component of the velocity is linear in a cell, and the speed is not.
        chord = np.roll(points[:-1], -1, axis=0) - np.roll(points[:-1], 1, axis=0)
        along = np.abs(np.einsum("nc,nc->n", velocity, chord)) / np.linalg.norm(chord, axis=1)
        slow = 1 / along
        lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
        period = float(np.sum(lengths * 0.5 * (slow + np.roll(slow, -1))))
        if stable:
            ordered = points
        else:
            ordered = points[::-1]
        return ClosedOrbit(ordered, stable, period, float(self._field.times[0]))


def _interpolated(field: FlowField, nodal: Floats, line: Floats) -> Floats:
    """Return nodal values (J, I, C) at indices (N, 2) as (i, j), (N, C)."""
    values = []
    for index in line:
        point = surface_point(field.surface, index[::-1])
        values.append(point.interpolate(nodal))
    return np.array(values)


def isolation(field: FlowField) -> Callable[[Floats], bool]:
    """Return a test of closed lines of a steady field, indices (N, 2) as (i, j), for limit cycles.

    Over a turn, the distance of a line beside a closed one grows by the exponential of the
    divergence of the velocity, integrated over the time. So the integral must exceed its error by
    interpolation.
    """

    @cache
    def nodal() -> Floats:
        """Divergence, its error, and the velocity at the nodes, (J, I, 5)."""
        first, error = gradient_and_error(field)
        divergence = np.stack([first[0, 0] + first[1, 1], error], axis=-1)
        return np.concatenate([divergence, field.velocity[0]], axis=-1)

    def is_isolated(turn: Floats) -> bool:
        places = field.surface.at(np.concatenate([turn, turn[:1]]))
        rates = _interpolated(field, nodal(), turn)
        lengths = np.linalg.norm(np.diff(places, axis=0), axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            times = 0.5 * (lengths + np.roll(lengths, 1)) / np.linalg.norm(rates[:, 2:], axis=1)
            growth, error = times @ rates[:, :2]
        return bool(abs(growth) > error)

    return is_isolated
