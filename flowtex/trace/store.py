"""Trace slices by destination time, traced when they are first requested.

Only the steps around the time that is drawn are traced, and those used last are cached; unless all
of them fit in memory and can be composed, which is quicker.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from flowtex._util.arguments import brief
from flowtex._util.array_types import Bools, Indices
from flowtex._util.cache import ByteCache, WeakCache, digest
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.steps import LazySteps
from flowtex.trace.compose import landings
from flowtex.trace.slices import FIRST_CELLS, TraceSlices, drawn_lags, longest_path
from flowtex.trace.trace import trace

CACHE_BYTES = 512_000_000  #: Size of the slices that are cached, besides the ones in use.
HELD_BYTES = 500_000_000  #: Most bytes of late steps in memory for tracing paths to one time.
STEP_BYTES = 72  #: Bytes per node of a step: velocity, speed, and samples.
LEAST_HELD = 8  #: Least number of steps that remain when they are thinned out.
STREAK_EXTENTS = 0.05  #: Length of a streak, as a share of the surface.
MOST_CHANGE = 0.5  #: Greatest relative change of velocity along a streak.
MOST_CHANGING = 0.05  #: Most nodes where it changes by more, as a share, for pathlines.
MOST_JUDGED = 100  #: Most nodes along each axis, and pairs of steps, that are sampled.


class SliceStore:
    """Slices of one field, one destination time at a time.

    With ``lines="streamlines"`` each destination time of a field that varies is traced as a steady
    field; only then the parameter, that of :func:`flowtex.trace`, counts. With ``slices`` of all
    steps nothing is traced. ``compose`` allows composing all steps together, which is slower for
    one or two of them. ``longest`` is the greatest length that is traced, in the mesh's units,
    ``first_cells`` the first lag in cells, ``cell`` the size of small cells of the surface that the
    field is a part of, and ``nodes`` (J, I) are those to follow.
    """

    def __init__(
        self,
        field: FlowField,
        *,
        parameter: str = "arclength",
        lines: str = "pathlines",
        slices: TraceSlices | None = None,
        compose: bool = True,
        longest: float | None = None,
        first_cells: float = FIRST_CELLS,
        cell: float | None = None,
        nodes: Bools | None = None,
    ) -> None:
        if slices is not None:
            check_slices(field, slices)
        self.field = field
        #: Whether each destination time is traced as a steady field.
        self.streamlines = field.steady or chosen_lines(field, lines) == "streamlines"
        self.given = slices is not None  #: Whether the slices were traced elsewhere.
        self._whole = slices
        self._compose = compose
        self._nodes = nodes
        self._cache: ByteCache[int, TraceSlices] = ByteCache(CACHE_BYTES, min_count=2)
        if slices is None:
            if self.streamlines:
                self.parameter = parameter
            else:
                self.parameter = "time"
            self.lags, self.unit = drawn_lags(field, self.parameter, longest, cell, first_cells)
            # Where cells differ in size, small ones need many times the lags of large ones.
            if np.ptp(self.unit):
                self.long_enough = longest or longest_path(field)
            else:
                self.long_enough = np.inf
        else:
            self.parameter = slices.parameter
            self.lags = slices.lags
            self.unit = slices.unit

    @property
    def steps(self) -> int:
        """Number of destination times."""
        return len(self.field.times)

    @property
    def traced(self) -> list[TraceSlices]:
        """Slices in the cache, of the steps that were requested last."""
        return self._cache.values()

    @property
    def nbytes(self) -> int:
        """Bytes of the slices in memory."""
        nbytes = self._cache.nbytes
        if self._whole is not None:
            nbytes += self._whole.nbytes
        return nbytes

    @property
    def two_sided(self) -> bool:
        """Whether paths lead forward too."""
        return self._whole is None or self._whole.forward is not None

    def at(self, step: int) -> TraceSlices:
        """Return slices of one destination time, T = 1."""
        return self._cache.get(step, lambda: self._trace(step))

    def forget(self) -> None:
        """Drop the slices that can be traced again."""
        self._cache.clear()

    def _trace(self, step: int) -> TraceSlices:
        """Return the slices of a time step, traced along its lines."""
        if self._whole is not None:
            return self._whole.at_step(step)
        if self.streamlines:
            compose = self._compose and not self.field.sign_free
            moment = self.field.at_step(step)
            return self._trace_with(moment, parameter=self.parameter, compose=compose)
        if isinstance(self.field.velocity, LazySteps):
            # Only the steps that paths to this time can meet are read.
            reach = float(self.lags[-1] * self.unit.max())
            near = np.flatnonzero(np.abs(self.field.times - self.field.times[step]) <= reach)
            first = max(int(near[0]) - 1, 0)
            last = min(int(near[-1]) + 2, self.steps)
            # Every n-th of them where they are many.
            most = max(HELD_BYTES // (STEP_BYTES * self.unit.size), LEAST_HELD)
            apart = -(-(last - first) // most)
            some = range(first + (step - first) % apart, last, apart)
            steps = sorted({first, *some, last - 1})
            part = self.field.at_steps(steps)
            return self._trace_with(part, steps=[steps.index(step)])
        size = self.steps * len(self.lags) * self.unit.size * 4 * np.float32().nbytes
        if (
            self._compose
            and size < CACHE_BYTES
            and landings(self.field, self.lags, self.unit) is not None
        ):
            # Composed, all steps together take about as long as four that are integrated.
            self._whole = self._trace_with(self.field, compose=True)
            return self._whole.at_step(step)
        return self._trace_with(self.field, steps=[step])

    def _trace_with(self, field: FlowField, **options: Any) -> TraceSlices:
        """Return slices with the lags of the store; those of a whole surface are shared."""
        # A part of a surface is one of many, so it has no progress bar.
        alone = self._nodes is None
        arguments = {**options, "nodes": self._nodes, "longest": self.long_enough}
        follow = partial(trace, field, lags=self.lags, unit=self.unit, progress=alone, **arguments)
        if alone:
            return _slices.get(self._key(field, options), follow)
        return follow()

    def _key(self, field: FlowField, options: dict[str, Any]) -> bytes:
        """Return a hash of all numbers that determine the slices of a field."""
        arrays = [field.points, field.valid, *field.velocity, field.times, self.lags, self.unit]
        if field.has_position is not None:
            arrays.append(field.has_position)
        if field.triangles is not None:
            arrays.append(field.triangles)
        choices = (field.periodic, field.sign_free, field.has_position is None, self.long_enough)
        return digest(*arrays, words=(choices, *sorted(options.items())))


def check_slices(field: FlowField, slices: TraceSlices) -> None:
    """Raise a FieldError when a field cannot be drawn with slices."""
    if not isinstance(slices, TraceSlices):
        raise FieldError(
            f"slices is {brief(slices)}; expected TraceSlices, from flowtex.trace or "
            "TraceSlices.open"
        )
    if field.sign_free and slices.forward is None:
        raise FieldError("the slices have only the backward side; a sign-free field needs both")
    slices.check_origin(field)


_stores: WeakCache[SliceStore] = WeakCache()
#: Slices in use by the hash of their data: reading these again gives the same slices.
_slices: WeakCache[TraceSlices] = WeakCache()


def shared_store(field: FlowField, parameter: str, lines: str = "pathlines") -> SliceStore:
    """Return the store of a field, one for all that show the field at the same time."""
    # A store keeps its field alive, so the id stays unique.
    lines = chosen_lines(field, lines)
    key = (id(field), parameter, lines)
    return _stores.get(key, lambda: SliceStore(field, parameter=parameter, lines=lines))


def chosen_lines(field: FlowField, lines: str = "auto") -> str:
    """Return ``"pathlines"`` or ``"streamlines"``; with ``"auto"`` the data decide.

    Where the flow turns while a particle goes the length of a streak, pathlines through
    neighbouring points cross, and the picture is speckle.
    """
    if lines != "auto":
        return lines
    if changing_share(field) > MOST_CHANGING:
        return "streamlines"
    return "pathlines"


def changing_share(field: FlowField) -> float:
    """Return the share of sampled nodes where the flow changes by half within a streak."""
    if field.steady:
        return 0.0
    j, i = judged_lines(field.shape)
    t = _sample(len(field.times) - 1, MOST_JUDGED)
    if isinstance(field.velocity, LazySteps):
        t = t[:1]
    valid = field.valid[np.ix_(j, i)]
    if not valid.any():
        return 0.0
    velocity = field.velocity[:, j[:, None], i]
    before = np.asarray(velocity[t])[:, valid]
    after = np.asarray(velocity[t + 1])[:, valid]
    spans = (field.times[t + 1] - field.times[t])[:, None]
    change = np.linalg.norm(after - before, axis=-1) / spans
    square = np.sum((0.5 * (before + after)) ** 2, axis=-1)
    extent = float(np.linalg.norm(np.ptp(field.points[np.ix_(j, i)][valid], axis=0)))
    return float(np.mean(STREAK_EXTENTS * extent * change > MOST_CHANGE * square))


def judged_lines(shape: tuple[int, int]) -> tuple[Indices, Indices]:
    """Return the rows and columns at which a field with nodes (J, I) is sampled."""
    rows, columns = shape
    if rows == 1:  # the nodes of triangles
        return _sample(rows, MOST_JUDGED), _sample(columns, MOST_JUDGED**2)
    return _sample(rows, MOST_JUDGED), _sample(columns, MOST_JUDGED)


def _sample(count: int, most: int) -> Indices:
    return np.arange(0, count, -(-count // most))
