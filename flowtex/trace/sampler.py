"""The velocity between the nodes and between the time steps.

A sampler gives the rate of change of a particle's position in index space, (di, dj) per unit of
lag: bilinear in space, linear in time, constant beyond the border and before the first time step.
Blanked nodes take the velocity of the nearest valid one, so a path that grazes a blanked region
bends as its neighbours do until it is ended there.
"""

from __future__ import annotations

from copy import copy
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from flowtex._util.array_types import AnyArray, Bools, Bytes, Floats, Indices
from flowtex.field import FlowField
from flowtex.field.grids.grid_nodes import corner_signs
from flowtex.field.grids.poles import Pole, Poles
from flowtex.field.interpolation import bracket, fill_blanked

#: A particle slower than this share of the greatest speed has stopped.
STOPPED_SPEED = 1e-7
#: Pairs of tangents whose products make the metric.
METRIC = ((0, 0), (0, 1), (1, 1))
#: By arc length, a particle this slow, in cells over one unit of lag, is at a critical point.
RESTING_CELLS = 1e-3
#: By time, a particle is at rest that goes no further than this, in cells, until the last lag.
STILL_CELLS = 1e-5
Numbers = NDArray[np.int8]
LEAST_NEAR_CELLS = 6  #: Least distance in cells from a pole that the tangent plane covers.
NEAR_ASPECT = 0.5  #: Greatest ratio of width to length of the cells that it covers.
#: Cells from a pole within which slices are not interpolated between nodes.
CLOSE_CELLS = 4
LEAVE_CELLS = 1  #: Further cells after which a path leaves the plane again.
SPARE_CELLS = 3  #: Further cells with data in the plane.
#: Cells that rounding may carry a path over a border that it follows.
BORDER_ROUNDING_CELLS = 1e-6
MOST_ROOM_CELLS = 4  #: Longest step in cells far from blanked ones.
LEAST_ROOM_CELLS = 1  #: Longest step in cells next to a blanked one.


class Sampler:
    """The field as the integrator samples it, by arc length or by its own time.

    Positions and rates are (2, N): as (i, j), or on the charts (N,) that are given with them. By
    arc length a steady field has unit speed in space. Beside a critical point the velocity is
    divided by the interpolated speed of the nodes, so a path comes to rest there instead of passing
    it.
    """

    def __init__(self, field: FlowField, *, by_length: bool) -> None:
        flow = field.index_velocity
        data = np.asarray(flow.components)
        #: Speed below which a particle has stopped, by arc length.
        self._floor = 0.0
        if by_length:
            data = np.concatenate([data, flow.speed[..., None]], axis=-1)
            self._floor = max(STOPPED_SPEED * float(flow.speed.max()), np.finfo(float).tiny)
        # Lags count from the destination time.
        self.times, self.destination = field.times, float(field.times[-1])
        #: Longest step in units of lag, which misses no change in time.
        if field.steady:
            self.longest = np.inf
        else:
            self.longest = float(np.diff(field.times).max())
        data = fill_blanked(data, field.valid, data.ndim - 3)
        parts = list(map(np.ravel, np.moveaxis(data, -1, 0)))
        grid = NodeGrid.of(field)
        self._poles = poles = field.surface.poles
        #: The charts of a surface that has poles.
        if poles is None:
            self.charts = None
        else:
            self.charts = Charts(poles)
        #: Whether particles are inside the domain, in a cell that is not blanked.
        self.alive = grid.alive
        self.grid = grid
        self._patches = [Patch(grid, parts)]
        if poles is not None and self.charts is not None:
            self._patches += [cap(pole, grid, parts, self.charts.near) for pole in poles]
        #: The metric at the nodes of a sign-free field, by ``METRIC``.
        self._metric: list[Floats] = []
        if field.sign_free:
            tangents = field.surface.tangents
            for first, second in METRIC:
                products = np.sum(tangents[first] * tangents[second], axis=-1)
                self._metric.append(products.ravel())
            flat, *caps = self._patches
            flat = flat.without_sign(fill_blanked(field.velocity[0], field.valid))
            self._patches = [flat, *(patch.without_sign() for patch in caps)]

    def rate(
        self,
        position: Floats,
        lag: Floats,
        direction: Floats,
        chart: Numbers | None = None,
        ahead: Floats | None = None,
    ) -> Floats:
        """Return rates of change of positions by lag for particles at ``lag`` (N,).

        Direction (N,) is -1 for those that are followed backward, 1 forward. In a sign-free field
        with ``ahead`` (2, N) it is the one of both rates that leads ahead, in either direction.
        """
        moment = self.destination + direction * lag
        if chart is None or not chart.any():
            result = self._rate(self._patches[0], position, moment)
        else:
            result = np.empty_like(position)
            for number, patch in enumerate(self._patches):
                at = np.flatnonzero(chart == number)
                if len(at):
                    result[:, at] = self._rate(patch, position[:, at], moment[at])
        if self._poles is not None and chart is not None:
            # Beyond a pole index space runs the other way.
            turned = (chart == 0) & self._poles.mirrored(position)
            result[self._poles.component, turned] *= -1
        if self._metric and ahead is not None:
            result *= self._sign(position, result, ahead, chart)
            return result
        result *= direction
        return result

    def _sign(self, position: Floats, one: Floats, two: Floats, chart: Numbers | None) -> Floats:
        """Return 1, or -1 where rates (2, N) form an angle above 90 degrees in space, (N,)."""
        along = one[0] * two[0] + one[1] * two[1]
        flat: Any = slice(None)
        if chart is not None:
            flat = np.flatnonzero(chart == 0)
        flat_position = position[:, flat]
        (a, b) = one[:, flat]
        (c, d) = two[:, flat]
        at = self.grid.corners(flat_position).at
        ii, ij, jj = (part[at] for part in self._metric)
        if self._poles is not None:
            ij = np.where(self._poles.mirrored(flat_position), -ij, ij)
        along[flat] = ii * a * c + ij * (a * d + b * c) + jj * b * d
        return np.where(along < 0, -1.0, 1.0)

    def room(self, position: Floats) -> AnyArray | int:
        """Return the cells that particles at positions (2, N) may move at once, for all or (N,)."""
        if self.charts is not None:
            return LEAST_ROOM_CELLS
        if self.grid.open is None:
            return MOST_ROOM_CELLS
        return np.maximum(self.grid.room[self.grid.corners(position).at], LEAST_ROOM_CELLS)

    def since(self, destination: float) -> Sampler:
        """Return this sampler with lags counted from another destination time."""
        other = copy(self)
        other.destination = destination
        return other

    def rest(self, unit: Floats, last: float) -> Floats:
        """Return rates (N,) below which a particle is at rest, for lags up to ``last * unit``.

        By arc length moving ones cover a cell per unit; in a flow that varies none stays at rest.
        """
        if self._floor:
            return RESTING_CELLS / unit
        if len(self.times) > 1:
            return np.zeros(len(unit))
        return STILL_CELLS / (unit * last)

    def _rate(self, patch: Patch, position: Floats, moment: Floats) -> Floats:
        """Return the rate on one chart, forward, at times (N,)."""
        corners = patch.corners(position)
        if len(self.times) == 1:
            result = np.stack([patch.blend(0, corners), patch.blend(1, corners)])
            if self._floor:
                speed = patch.blend(2, corners)
                speed[speed <= self._floor] = np.inf
                result /= speed
            return result
        step, late = bracket(self.times, moment, side="left")
        np.clip(late, 0, 1, out=late)
        result = np.empty((2, len(moment)))
        for component, row in enumerate(result):
            before = patch.blend(component, corners, step)
            row[:] = patch.blend(component, corners, step + 1)
            row -= before
            row *= late
            row += before
        return result


class Patch(NamedTuple):
    """Nodal data on one chart: flat arrays of consecutive sets."""

    grid: NodeGrid
    data: list[Floats]
    pole: Pole | None = None
    #: First line of the grid that counts from the pole.
    offset: int = 0
    #: Signs of the corners of each cell, (4, J * I), where the first two arrays are sign-free.
    signs: NDArray[np.int8] | None = None

    def without_sign(self, vectors: Floats | None = None) -> Patch:
        """Return the patch for sign-free data, by default for the vectors (J, I, C) of itself."""
        if vectors is None:
            shape = (self.grid.rows, self.grid.columns, 2)
            vectors = np.stack(self.data[:2], axis=-1).reshape(shape)
        signs = corner_signs(vectors)
        if signs is None:
            return self._replace(signs=None)
        return self._replace(signs=signs.reshape(4, -1))

    def corners(self, position: Floats) -> Corners:
        """Return cells of positions (2, N) of the chart."""
        if self.pole is not None:
            position = self.pole.index(position)
            position[self.pole.component] -= self.offset
        return self.grid.corners(position)

    def blend(self, number: int, corners: Corners, step: Indices | int = 0) -> Floats:
        """Interpolate one of the arrays in the set number ``step``."""
        result = self.grid.blend(self.data[number], corners, step * self.grid.size)
        if self.signs is not None and number < 2:
            cut = np.flatnonzero((self.signs[:, corners.at] < 0).any(axis=0))
            crossed = Corners(*(part[cut] for part in corners))
            result[cut] = self._aligned(self.data[number], crossed)
        return np.asarray(result)

    def _aligned(self, data: Floats, corners: Corners) -> Floats:
        """Interpolate in cells whose corners are given the sign of the nearest one."""
        at, s, t = corners
        weights = ((1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t)
        result = np.zeros(len(at))
        if self.signs is not None:
            offsets = (0, 1, self.grid.columns, self.grid.columns + 1)
            for sign, weight, offset in zip(self.signs, weights, offsets, strict=True):
                result += sign[at] * weight * data[at + offset]
            result *= self.signs[(s >= 0.5) + 2 * (t >= 0.5), at]
        return result


class Charts:
    """The charts of a surface with poles: index space, 0, and next to each pole the tangent plane.

    In index space the velocity at a pole has no bound. So a path that comes within a few cells of a
    pole is followed in the plane that touches the surface there, in cells towards the pole, across
    it if need be. Its positions are stored in index space again.
    """

    def __init__(self, poles: Poles) -> None:
        self._poles = poles
        cells = next(iter(poles)).cells
        #: Cells from a pole within which its plane is used.
        self.near = min(
            max(LEAST_NEAR_CELLS, int(NEAR_ASPECT * cells / (2 * np.pi))),
            max((poles.lines - 1) // 3, 1),
        )

    def choose(self, index: Floats, chart: Numbers | None = None) -> Numbers:
        """Return charts (N,) for positions (2, N) in index space, with hysteresis by ``chart``."""
        index = self._poles.fold(index)
        result = np.zeros(index.shape[1], np.int8)
        for number, pole in enumerate(self._poles, 1):
            if chart is None:
                stay = 0
            else:
                stay = LEAVE_CELLS * (chart == number)
            result[pole.depth(index) < self.near + stay] = number
        return result

    def close(self, index: Floats) -> Bools:
        """Return whether positions (2, N) in index space are close to a pole, (N,)."""
        index = self._poles.fold(index)
        close = np.zeros(index.shape[1], bool)
        for pole in self._poles:
            close |= pole.depth(index) < min(CLOSE_CELLS, self.near)
        return close

    def enter(self, index: Floats, chart: Numbers) -> Floats:
        """Return coordinates (2, N) on charts (N,) of positions (2, N) in index space."""
        result = np.array(index)
        for number, pole in enumerate(self._poles, 1):
            mask = chart == number
            if mask.any():
                result[:, mask] = pole.place(self._poles.fold(index[:, mask]))
        return result

    def index(self, position: Floats, chart: Numbers, near: Floats | None = None) -> Floats:
        """Return positions (2, N) in index space of coordinates (2, N) on charts (N,).

        With positions ``near`` (2, N), those on the planes are as close to them as possible, if
        necessary beyond the pole.
        """
        result = np.array(position)
        for number, pole in enumerate(self._poles, 1):
            mask = chart == number
            if mask.any():
                inside = pole.index(position[:, mask])
                if near is not None:
                    # A position as far as the other pole is folded back.
                    beside = near[:, mask]
                    far = np.abs(pole.depth(beside)) >= self._poles.lines - 1
                    beside = np.where(far, self._poles.fold(beside), beside)
                    inside = pole.nearest(inside, beside)
                result[:, mask] = inside
        return result


def cap(pole: Pole, grid: NodeGrid, data: list[Floats], near: int) -> Patch:
    """Lay out the data around a pole on its plane, up to ``near`` cells from it and some more.

    The data are components along i and j, in cells, and other values, (sets * J * I,) each.
    """
    shape = (-1, grid.rows, grid.columns)
    if pole.component:
        lines = grid.rows
    else:
        lines = grid.columns
    depth = min(near + LEAVE_CELLS + SPARE_CELLS, lines - 1)
    if pole.inward > 0:
        first = pole.line
    else:
        first = pole.line - depth
    # The second axis counts the lines around the pole.
    strips = []
    for values in data:
        lines_of_values = pole.lines(values.reshape(shape), 1)
        strips.append(lines_of_values[:, first : first + depth + 1])
    strips[:2] = _to_plane(pole, strips[1 - pole.component], strips[pole.component])
    strips = [pole.lines(a, 1) for a in strips]
    rows, columns = strips[0].shape[1:]
    cells = np.ones((rows - 1, columns - 1), bool)
    return Patch(
        NodeGrid((rows, columns), grid.periodic, cells),
        list(map(np.ravel, strips)),
        pole,
        first,
    )


def _to_plane(pole: Pole, around: Floats, across: Floats) -> list[Floats]:
    """Return velocities in the plane, two of (T, lines, n + 1), from those along the lines."""
    rays = pole.rays / pole.size
    turn = (np.roll(rays[:-1], -1, axis=0) - np.roll(rays[:-1], 1, axis=0)) / 2
    turn = np.concatenate([turn, turn[:1]])
    if pole.inward > 0:
        at = 0
    else:
        at = -1
    depth = np.arange(around.shape[1], dtype=float)[:, None]
    if not (pole.inward > 0):
        depth = depth[::-1]
    at_pole = pole.vector(across[:, at]) / pole.size
    components = []
    for c in range(2):
        v = pole.inward * across * rays[:, c] + around * depth * turn[:, c]
        v[:, at] = at_pole[:, c, None]
        components.append(v)
    return components


class Corners(NamedTuple):
    """Where particles lie: lower corner of the cell, and the fractions along i and j, (N,)."""

    at: Indices
    s: AnyArray
    t: AnyArray


class NodeGrid:
    """Nodes of a surface in index space, (J, I), continued beyond its poles; ``cells`` are open.

    Every component is its own array: a gather of scalars costs a tenth of one of short rows.
    """

    def __init__(
        self,
        shape: tuple[int, int],
        periodic: tuple[bool, bool],
        cells: Bools,
        poles: Poles | None = None,
    ) -> None:
        self.rows, self.columns = shape
        self.periodic = periodic
        self.poles = poles
        # One entry for each lower corner, so that Corners.at finds it.
        if cells.all():
            self.open = None
        else:
            self.open = np.pad(cells, ((0, 1), (0, 1))).ravel()

    @classmethod
    def of(cls, field: FlowField) -> NodeGrid:
        """Make the grid of a field's nodes."""
        surface = field.surface
        return NodeGrid(field.shape, field.periodic, surface.cells, surface.poles)

    @property
    def size(self) -> int:
        """Number of nodes."""
        return self.rows * self.columns

    @cached_property
    def endless(self) -> bool:
        """Whether no path can leave the domain: there are neither borders nor blanked cells."""
        closed = list(self.periodic)
        if self.poles is not None and self.poles.both:
            closed[1 - self.poles.component] = True
        return self.open is None and all(closed)

    def corners(self, position: AnyArray) -> Corners:
        """Return the cells of positions (2, N); those beyond a border are moved onto it."""
        if self.poles is not None:
            position = self.poles.fold(position)
        i, s = _cell(position[0], self.columns - 1, closed=self.periodic[1])
        j, t = _cell(position[1], self.rows - 1, closed=self.periodic[0])
        j *= self.columns
        j += i
        return Corners(j, s, t)

    @cached_property
    def room(self) -> Bytes:
        """Cells that a particle may move at once from each cell, (J * I,), 0 if it is blanked.

        In longer steps it might pass a blanked cell unnoticed.
        """
        assert self.open is not None
        around = MOST_ROOM_CELLS
        cells = self.open.reshape(self.rows, self.columns)[:-1, :-1]
        for axis, closed in enumerate(self.periodic):
            width = [(0, 0), (0, 0)]
            width[axis] = (around, around)
            if closed:
                cells = np.pad(cells, width, mode="wrap")
            else:
                cells = np.pad(cells, width, mode="edge")
        far = scipy.ndimage.distance_transform_cdt(cells, "chessboard")[
            around:-around, around:-around
        ]
        room = np.minimum(far, MOST_ROOM_CELLS)
        return np.pad(room, ((0, 1), (0, 1))).astype(np.uint8).ravel()

    def blend(self, data: AnyArray, corners: Corners, base: Indices | int = 0) -> AnyArray:
        """Interpolate nodal data of consecutive sets, (sets * J * I,).

        The set of each particle begins at index ``base``.
        """
        if np.ndim(base):
            at = corners.at + base
            first = 0
        else:
            at = corners.at
            first = int(base)
        # Products of complex numbers with complex ones are several times as fast.
        s = corners.s.astype(data.dtype, copy=False)
        t = corners.t.astype(data.dtype, copy=False)
        low = _between(data[first:], at, s)
        high = _between(data[first + self.columns :], at, s)
        high -= low
        high *= t
        high += low
        return high

    def alive(self, position: AnyArray, edge: float = BORDER_ROUNDING_CELLS) -> Bools:
        """Return whether positions (2, N) are in open cells, or ``edge`` cells beyond a border."""
        result = np.ones(position.shape[1], dtype=bool)
        if self.poles is not None:
            position = self.poles.fold(position)
        for x, cells, closed in zip(
            position, (self.columns - 1, self.rows - 1), self.periodic[::-1], strict=True
        ):
            if not closed:
                result &= (x >= -edge) & (x <= cells + edge)
        if self.open is not None:
            result &= self.open[self.corners(position).at]
        return result


def _cell(x: AnyArray, cells: int, *, closed: bool) -> tuple[Indices, AnyArray]:
    """Return the number of the cell along one axis, and the fraction inside it."""
    if closed:
        inside = x - cells * np.floor(x * x.dtype.type(1 / cells))
        # Rounding can leave the result outside, by more the further away the position is.
        np.clip(inside, 0, cells, out=inside)
    else:
        inside = np.clip(x, 0, cells)
    number = inside.astype(np.intp)
    np.minimum(number, cells - 1, out=number)
    inside -= number.astype(x.dtype)
    return number, inside


def _between(data: AnyArray, at: Indices, s: AnyArray) -> AnyArray:
    """Interpolate between each node and the next one along i."""
    # The indices are in range by construction; "clip" only spares NumPy's own check.
    low = data.take(at, mode="clip")
    high = data[1:].take(at, mode="clip")
    high -= low
    high *= s
    high += low
    return high
