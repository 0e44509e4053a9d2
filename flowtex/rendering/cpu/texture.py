"""The sum of equation 2: ``shaders/common/texture.glsl`` for many fragments at once."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from flowtex._util.array_types import Floats
from flowtex._util.arrays import norm
from flowtex.rendering.cpu.cell import CellPath, unit
from flowtex.rendering.cpu.fragments import Fragments
from flowtex.rendering.cpu.path import AxisSlices, Path, Places, Slices, TrianglePlaces, moved
from flowtex.rendering.even import DrawnGrains, even_gain
from flowtex.rendering.shaders import const
from flowtex.rendering.uniforms import Values


@dataclass
class Sums:
    """Sums along the paths of N fragments."""

    values: Floats  #: Of the weighted values, (N, C).
    squares: Floats  #: Of the squared weights, (N,).
    neighbours: Floats  #: Of the products of neighbouring weights, (N,).


class Lookup(Protocol):
    """Values that are summed along the paths of N fragments, and how sums become the texture."""

    spacing: Floats  #: Distance between two samples, (N,), as a length, or a lag in an image.
    level: Floats  #: Level of detail of the values, (N,), to be shown.

    def move(self, slope: Floats, speed: Floats) -> None:
        """Take the slopes at lag zero and the speeds, (N,), before the first look-up."""
        return

    def face(self, tangent: Floats) -> DrawnGrains:
        """Take tangents (N, 3) of the flow, before all else, and return the sizes of grains."""
        one = np.ones(len(tangent))
        return DrawnGrains(one, one)

    def lookup(self, displacement: Floats, length: Floats) -> Floats:
        """Values (N, C) at displacements (N, 3) from the fragments, ``length`` (N,) on the way."""

    def blend(self, sums: Sums) -> Floats:
        """Texture from the sums: (N,), or the colours and opacity of an image, (N, 4)."""


@dataclass(frozen=True, eq=False)
class Side:
    """One side of the paths of N fragments."""

    sign: float  #: -1 behind the particles, 1 ahead of them.
    path: Path  #: The paths, from lag zero outward.
    spacing: Floats  #: Distance between two samples in nominal length, (N,).
    reach: Floats  #: Lag at which each path ends, (N,).
    scale: Floats  #: Nominal length of a unit of lag, (N,).

    def step(self, lag: Floats) -> Floats:
        """Lag to the next sample (equation 3); nearly at rest, as fast as it will soon be."""
        step = self.spacing / self.scale
        least = np.maximum(np.sqrt(self.path.bend * step), const.LEAST_SPEED)
        return np.asarray(step / np.maximum(self.path.speed(lag), least))


#: Makes the look-up of fragments from the uniforms.
LookupMaker = Callable[[Fragments, Values], Lookup]


def weight(side: float, t: float | Floats, parting: Floats, values: Values) -> Floats:
    """Weights (N,) on a side, -1 or 1, at t from 0 to 1; ``parting`` (N,) from 0 to 1."""
    none = 0.0 * parting
    if values["u_kernel"] == const.KERNEL_BOX:
        return none + 1.0
    if values["u_kernel"] != const.KERNEL_RAMP:
        return np.asarray(none + 0.5 + 0.5 * np.cos(const.PI * t))
    if values["u_sides"] == 1:
        return np.asarray(none + 1.0 - t)
    return np.asarray((0.5 + 0.5 * side * parting) * (1.0 - side * t))


def shared(apart: Floats, near: Floats) -> Floats:
    """Variance of a sum, relative to independent samples; ``apart`` in grains, weights ``near``."""
    square = np.square(apart)
    decay = const.BELL * square - np.log(np.maximum(near, const.LEAST_SQUARE))
    bend = const.BELL_BEND * np.square(square)
    bent = bend / np.square(decay)
    many = np.sqrt(np.pi / (decay * (1.0 + bent * (const.BENT - const.BENT_TWICE * bent))))
    few = 1.0 + 2.0 * np.exp(-decay - bend)
    return np.asarray(np.maximum(many, few))


class Summing:
    """The loop over samples of fragments; ``by_lag`` with slopes in image coordinates."""

    def __init__(self, slices: Slices, values: Values, lookup: Lookup, *, by_lag: bool) -> None:
        self._slices = slices
        self._values = values
        self._lookup = lookup
        self._by_lag = by_lag
        self._lags = np.asarray(values["u_lags"])

    def texture(self, coordinate: Places, level: Floats, by: Floats) -> Floats:
        """Texture at places and mip levels (N,); ``by`` is their change by a vector, (N, 2, 3)."""
        value, share = self.shares(coordinate, level, by)
        if value.ndim > 1:  # an image keeps its colours
            return value
        return np.asarray(value * share)

    def shares(self, coordinate: Places, level: Floats, by: Floats) -> tuple[Floats, Floats]:
        """Texture before it fades, and the factor by which it does, (N,) each.

        Where the local mean will be subtracted, the factor has the contrast that this takes.
        """
        values = self._values
        lookup = self._lookup
        base = self._slices.layer(coordinate, 0, level)
        speed = norm(base[:, :3])
        certainty = self.certainty(coordinate, level)
        grains = lookup.face(base[:, :3])
        lookup.move(speed, np.maximum(self._shown(coordinate, level), 0.0))
        count = self.count(grains, certainty)
        cell = self.cell(coordinate, count)
        self._parting = np.zeros(len(base))
        if values["sparse"] and not isinstance(self._slices, AxisSlices):
            sine = self._parted(coordinate, level, by, 0.5 * count * lookup.spacing, cell)
            cosine = np.sqrt(np.maximum(1.0 - sine**2, 0.0))
            self._parting = np.clip(2.0 * sine, 0.0, 1.0)
            sine = np.maximum(np.abs(sine), const.LEAST_SPEED)
            count *= np.minimum(const.TOGETHER * cosine / sine, 1.0)
        # The sample at the fragments themselves.
        middle = np.maximum(weight(1.0, 0.0, self._parting, values), const.LEAST_WEIGHT)
        none = np.zeros((len(base), 3))
        sums = Sums(middle[:, None] * lookup.lookup(none, none[:, 0]), middle**2, none[:, 0].copy())
        for side in self.sides(coordinate, level, base):
            self._add(sums, side, cell, count)
        share = self.faded(coordinate, level, certainty)
        if values["u_even"]:
            near = sums.neighbours / sums.squares
            share = share * even_gain(near, grains, values)
        return lookup.blend(sums), share

    def _parted(
        self, coordinate: Places, level: Floats, by: Floats, half: Floats, cell: CellPath | None
    ) -> Floats:
        """Sines (N,) of the angles to paths half a side's length beside; < 0 where they meet."""
        in_triangles = isinstance(coordinate, TrianglePlaces)
        if in_triangles:
            cells = np.ones(2)
        else:
            cells = np.asarray(self._values["u_slicesSize"])

        def direction(offset: Floats) -> Floats:
            tangent = unit(self._slices.layer(moved(coordinate, offset), 0, level)[:, :3])
            if cell is None:
                return tangent
            return cell.direction(tangent, offset * cells)

        normal = unit(np.cross(*np.moveaxis(by, 1, 0)))
        across = unit(np.cross(normal, direction(np.zeros((len(level), 2)))))
        offset = np.einsum("nkc,nc->nk", by, half[:, None] * across)
        change = np.einsum("nc,nc->n", across, direction(offset) - direction(-offset))
        return np.asarray(0.5 * change)

    def faded(self, coordinate: Places, level: Floats, certainty: Floats) -> Floats:
        """Return the factor of the texture, (N,), less for uncertain or slow flow, 0 at rest.

        It is less where the flow only crosses the surface, too.
        """
        speed = norm(self._slices.layer(coordinate, 0, level)[:, :3])
        share = (speed >= const.LEAST_SPEED) * (const.FADED + (1 - const.FADED) * certainty)
        shown = self._shown(coordinate, level)
        share *= np.clip(1.0 + shown, 0.0, 1.0)
        fade = self._values["u_fade"]
        if fade > 0:
            usual = np.clip(shown, 0, fade) / fade
            share = share * usual**2 * (3 - 2 * usual)
        return np.asarray(share)

    def _shown(self, coordinate: Places, level: Floats) -> Floats:
        """Return the speed, (N,), or below zero the share by which the texture fades."""
        return self._slices.layer(coordinate, 2, level)[:, 3]

    def certainty(self, coordinate: Places, level: Floats) -> Floats:
        """Return the certainty of the direction, (N,): 1 where it is known."""
        if not self._slices.uncertain:
            return np.ones(len(level))
        return 1.0 - self._slices.layer(coordinate, const.UNCERTAIN_LAYER, level)[:, 3]

    def cell(self, coordinate: Places, count: Floats) -> CellPath | None:
        """Paths of ``count`` (N,) samples in the cells of fragments, where the view is so near."""
        if not self._values["near"]:
            return None
        return CellPath(self._slices, coordinate, count * self._lookup.spacing, self._values)

    def sides(self, coordinate: Places, level: Floats, base: Floats) -> Iterator[Side]:
        """Sides of the paths of N fragments, whose layer 0 is ``base``, (N, 4)."""
        speed = norm(base[:, :3])
        if self._by_lag:
            scale = np.ones(len(base))
            spacing = self._lookup.spacing * speed
        else:
            scale = base[:, 3] * self._values["u_unit"]
            spacing = self._lookup.spacing
        sides = ((-1.0, 0), (1.0, len(self._lags)))  # and the layers before their first slices
        for sign, before in sides[: self._values["u_sides"]]:
            next_ = self._slices.layer(coordinate, before + 1, level)
            ends = (base[:, :3], next_[:, :3])
            path = Path(self._slices, coordinate, level, ends, before, self._lags)
            reach = np.where(speed > const.LEAST_SPEED, next_[:, 3], -np.inf)
            yield Side(sign, path, spacing, reach, scale)

    def count(self, grains: DrawnGrains, certainty: Floats) -> Floats:
        """Return the number of samples on a side, (N,), for grains and certainties (N,)."""
        count: int = self._values["u_samples"] - 1
        if self._values["u_sides"] == 2:
            count = self._values["u_samples"] // 2
        return count * certainty * grains.stretch

    def _add(self, sums: Sums, side: Side, cell: CellPath | None, count: Floats) -> None:
        """Add one side of the paths, of this many samples (N,), and where it stays in its cell."""
        values = self._values
        path = side.path
        sign = side.sign
        scale = side.scale
        last = np.minimum(side.reach, self._lags[-1])
        lag = np.zeros(len(scale))
        live = np.isfinite(side.reach)
        if cell is not None:
            cell.leave()
        step = side.step(lag)
        before = weight(sign, 0.0, self._parting, values)
        for k in range(1, int(np.ceil(count.max(initial=0))) + 1):
            lag = np.where(live, lag + step, lag)
            alive = np.clip((last - lag) / step + 1.0, 0.0, 1.0)
            if cell is not None:
                alive = cell.go_on(sign * side.spacing, alive)
            # The last sample counts in part where there is no whole number of them.
            alive = live * alive * np.clip(count - k + 1, 0.0, 1.0)
            live = alive > 0
            if not live.any():
                break
            # Paths that have ended stay at their end, where the weight is zero.
            lag = np.where(live, lag, np.maximum(last, 0.0))
            displacement = path.follow(lag) * (sign * scale)[:, None]
            if cell is not None:
                displacement = cell.mixed(displacement)
            weights = alive * weight(sign, k / (count + 1), self._parting, values)
            sums.values += weights[:, None] * self._lookup.lookup(displacement, sign * lag * scale)
            sums.squares += weights**2
            sums.neighbours += weights * before
            before = weights
            if not self._by_lag:
                # From the speed at this point, so that samples are evenly spaced in length.
                step = side.step(lag)
