"""Poles: lines of nodes that lie at one point, with the surface closed around them.

The first or the last line of an axis is a pole where all its nodes coincide, the other axis
closes on itself, and the next line goes once around the point: the ends of a sphere, the middle of
a disc. Index space continues beyond it on the far side: (i, -j) is the point (i + n / 2, j) for n
even cells around j = 0, so a path over the pole has a continuous position. Next to a pole, where
cells have no width, positions in a touching plane are used: :meth:`Pole.place`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Floats

#: Nodes closer than this share of the distance to the next line lie at one point.
SAME_POINT_SHARE = 1e-3
EVEN_CELLS = 1e-6  #: Distance in cells from evenly spread lines up to which lines are even.


@dataclass(frozen=True, eq=False)
class Pole:
    """One pole, where one component of positions (i, j) is constant."""

    component: int  #: That component, 0 or 1.
    line: int  #: Its value.
    inward: int  #: 1 where the component grows away from the pole, -1 where it falls.
    #: Two orthonormal rows that span the plane at the pole, (2, 3); lines around it turn from the
    #: first to the second.
    plane: Floats
    #: First cell of each line from the pole as a vector in that plane, (n + 1, 2), in the mesh's
    #: units; the last repeats the first.
    rays: Floats

    @property
    def cells(self) -> int:
        """Number of cells around the pole."""
        return len(self.rays) - 1

    @cached_property
    def size(self) -> float:
        """Length of one cell towards the pole, the unit of positions in the plane."""
        return float(np.linalg.norm(self.rays, axis=-1).mean())

    @cached_property
    def _angles(self) -> Floats:
        angles = np.unwrap(np.arctan2(self.rays[:, 1], self.rays[:, 0]))
        angles[-1] = angles[0] + 2 * np.pi
        return angles

    @cached_property
    def _lengths(self) -> Floats:
        return np.asarray(np.linalg.norm(self.rays, axis=-1) / self.size)

    @cached_property
    def _even(self) -> bool:
        away = self._angles - self._angles[0] - self._step * self._lines
        return bool(np.abs(away).max() < EVEN_CELLS * self._step)

    @cached_property
    def _is_round(self) -> bool:
        return float(np.ptp(self._lengths)) < EVEN_CELLS

    @property
    def _step(self) -> float:
        """Angle between two lines around the pole that lie evenly."""
        return 2 * np.pi / self.cells

    def _length_along(self, around: Floats) -> Floats | float:
        """Return the lengths of the first cells along lines around the pole, 1 in the mean."""
        if self._is_round:
            return 1.0
        return np.asarray(np.interp(around, self._lines, self._lengths))

    @cached_property
    def _lines(self) -> Floats:
        return np.arange(self.cells + 1.0)

    def lines(self, nodal: AnyArray, axis: int = 0) -> AnyArray:
        """Return a view (..., lines, n + 1, ...) of data, (..., J, I, ...) from ``axis`` on."""
        if self.component:
            return nodal
        return np.swapaxes(nodal, axis, axis + 1)

    def depth(self, position: AnyArray) -> AnyArray:
        """Return cells between the pole and positions (2, N) that are not beyond it, (N,)."""
        return np.asarray((position[self.component] - self.line) * self.inward)

    def opposite(self, around: AnyArray) -> AnyArray:
        """Return the index, up to one turn further, of the line straight ahead beyond the pole."""
        if self._even:
            return np.asarray(around + around.dtype.type(self.cells / 2))
        turns = np.floor(around / self.cells)
        ahead = np.interp(around - turns * self.cells, self._lines, self._angles) + np.pi
        past = ahead > self._angles[-1]
        line = np.interp(ahead - 2 * np.pi * past, self._angles, self._lines)
        return np.asarray(line + (turns + past) * self.cells, dtype=around.dtype)

    def place(self, position: Floats) -> Floats:
        """Return points of the plane at the pole, (2, N) in cells.

        They lie where positions (2, N) in index space, (i, j) before the pole, do on the surface.
        """
        around = position[1 - self.component]
        around = around - self.cells * np.floor(around / self.cells)
        length = self.depth(position) * self._length_along(around)
        if self._even:
            angle = self._angles[0] + self._step * around
        else:
            angle = np.interp(around, self._lines, self._angles)
        return np.stack([length * np.cos(angle), length * np.sin(angle)])

    def index(self, place: Floats) -> Floats:
        """Return positions (2, N) in index space of points of the plane at the pole."""
        angle = np.arctan2(place[1], place[0])
        angle += 2 * np.pi * np.ceil((self._angles[0] - angle) / (2 * np.pi))
        if self._even:
            around = (angle - self._angles[0]) / self._step
        else:
            around = np.interp(angle, self._angles, self._lines)
        depth = np.hypot(place[0], place[1]) / self._length_along(around)
        result = np.empty_like(place)
        result[1 - self.component] = around
        result[self.component] = self.line + self.inward * depth
        return result

    def nearest(self, position: Floats, near: Floats) -> Floats:
        """Return positions (2, N) in the form, before or beyond the pole, nearest to others."""
        a = 1 - self.component
        c = self.component
        beyond = self.depth(near) < 0
        depth = self.depth(position) * self.inward
        straight = position[a]
        across = self.opposite(position[a])
        straight = straight + self.cells * np.rint((near[a] - straight) / self.cells)
        across = across + self.cells * np.rint((near[a] - across) / self.cells)
        closer = np.abs(across - near[a]) - np.abs(straight - near[a])
        over = np.where(np.abs(closer) > EVEN_CELLS, closer < 0, beyond)
        result = np.empty_like(position)
        # At the pole itself all lines meet.
        result[a] = np.where(depth == 0, near[a], np.where(over, across, straight))
        result[c] = self.line + np.where(over, -depth, depth)
        return result

    def along(self, vectors: Floats) -> Floats:
        """Return components (..., n + 1) of vectors (..., 3) along lines at the pole, per cell."""
        flat = vectors @ self.plane.T
        square = np.sum(self.rays**2, axis=-1)
        return np.asarray(flat @ self.rays.T / square * self.inward)

    def vector(self, along: Floats) -> Floats:
        """Return vectors (..., 2) in the plane from components (..., n + 1) by :meth:`along`."""
        rays = self.rays[:-1]
        parts = along[..., :-1] * self.inward
        square = np.sum(rays**2, axis=-1, keepdims=True)
        return np.asarray(parts @ rays @ np.linalg.inv((rays / square).T @ rays))


@dataclass(frozen=True, eq=False)
class Poles:
    """The poles of a surface, one or two, at the ends of one axis."""

    first: Pole | None
    last: Pole | None
    lines: int

    def __iter__(self) -> Iterator[Pole]:
        for pole in (self.first, self.last):
            if pole is not None:
                yield pole

    @property
    def both(self) -> bool:
        """Whether the surface is closed at both ends."""
        return self.first is not None and self.last is not None

    @cached_property
    def component(self) -> int:
        """Component of a position (i, j) that leads from pole to pole."""
        return next(iter(self)).component

    def fold(self, position: AnyArray) -> AnyArray:
        """Return positions (2, N), those beyond a pole as positions on the far side."""
        end = self.lines - 1
        outside = np.flatnonzero(self._outside(position))
        if not len(outside):
            return position
        result = np.array(position)
        c = self.component
        a = 1 - self.component
        x = result[c][outside]
        y = result[a][outside]
        if self.both:
            # Twice over the poles is once around.
            x -= (2 * end * np.rint((x - end / 2) / (2 * end))).astype(x.dtype)
        for pole in self:
            past = (x - pole.line) * pole.inward < 0
            x[past] = 2 * pole.line - x[past]
            y[past] = pole.opposite(y[past])
        result[c][outside] = x
        result[a][outside] = y
        return result

    def mirrored(self, position: AnyArray) -> Bools:
        """Return where positions (2, N) lie on the far side, so that index space runs backward."""
        outside = self._outside(position)
        if self.both and outside.any():
            numbers = np.flatnonzero(outside)
            turns = np.floor(position[self.component][numbers] / (self.lines - 1))
            outside[numbers] = turns % 2 != 0
        return outside

    def _outside(self, position: AnyArray) -> Bools:
        """Return which positions (2, N) lie beyond a pole, (N,)."""
        across = position[self.component]
        if self.both:
            return np.asarray((across < 0) | (across > self.lines - 1))
        if self.first is not None:
            return np.asarray(across < 0)
        return np.asarray(across > self.lines - 1)


def find_poles(
    points: Floats, usable: Bools, valid: Bools, periodic: tuple[bool, bool]
) -> Poles | None:
    """Find the poles of nodes (J, I, 3); where a pole is not ``valid`` there is a hole."""
    if periodic[0] == periodic[1]:
        return None
    if periodic[1]:
        axis = 0
    else:
        axis = 1
    p = np.swapaxes(points, 0, axis)
    has_position = np.swapaxes(usable, 0, axis)
    data = np.swapaxes(valid, 0, axis)
    if len(p) < 3:
        return None
    ends = []
    for at, beside in ((0, 1), (-1, -2)):
        pole = None
        if data[at].all() and has_position[at].all() and has_position[beside].all():
            pole = _pole(p[at], p[beside], 1 - axis, at % len(p))
        ends.append(pole)
    if ends == [None, None]:
        return None
    return Poles(ends[0], ends[1], len(p))


def _pole(line: Floats, ring: Floats, component: int, at: int) -> Pole | None:
    """Return the pole at a line of nodes, (n + 1, 3), given the next one; ``None`` for no pole."""
    middle = line[:-1].mean(axis=0)
    spokes = ring - middle
    lengths = np.linalg.norm(spokes, axis=-1)
    if (
        len(line) < 4
        or np.linalg.norm(line - middle, axis=-1).max() > SAME_POINT_SHARE * lengths.min()
    ):
        return None
    if np.linalg.norm(spokes[-1] - spokes[0]) > SAME_POINT_SHARE * lengths.min():
        return None  # longitude on a flat map
    spokes[-1] = spokes[0]
    normal = np.cross(spokes[:-1], spokes[1:]).sum(axis=0)
    area = np.linalg.norm(normal)
    if area <= SAME_POINT_SHARE * lengths.min() ** 2:
        return None
    normal /= area
    right = spokes[0] - (spokes[0] @ normal) * normal
    if np.linalg.norm(right) <= SAME_POINT_SHARE * lengths[0]:
        return None
    right /= np.linalg.norm(right)
    plane = np.stack([right, np.cross(normal, right)])
    rays = spokes @ plane.T
    turned = np.diff(np.unwrap(np.arctan2(rays[:, 1], rays[:, 0])))
    if not ((turned > 0).all() and abs(turned.sum() - 2 * np.pi) < 1):
        return None
    inward = 1
    if at:
        inward = -1
    return Pole(component, at, inward, plane, rays)
