"""The times of a series of meshes: which of them have the velocity, and those around a moment.

A solver writes some arrays at some times only, such as the stress on walls, which the initial
values lack.
"""

from __future__ import annotations

import bisect
import math
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import chain
from typing import Any

import numpy as np

from flowtex._util.arrays import is_nonzero
from flowtex.errors import FieldError
from flowtex.field.dates import ENDS
from flowtex.field.field_arrays import (
    Reading,
    ReadingStep,
    SourceArrays,
)
from flowtex.field.interpolation import at_moment, steps_around
from flowtex.field.options import FieldOptions
from flowtex.remedies import Remedy
from flowtex.sources.meshes import parts
from flowtex.sources.meshes.parts import TimeStep
from flowtex.sources.meshes.vectors import (
    MeshArray,
    candidates,
    catalogue,
    select_velocity,
    values_of,
)
from flowtex.sources.notices import Record

#: Names of the stress that a flow exerts on a wall.
WALL_STRESS = re.compile(r"(wall[ _.-]?)?shear[ _.-]?stress.*|skin[ _.-]?friction.*", re.IGNORECASE)
#: Times that a message lists.
MOST_LISTED = 8
#: Most times whose arrays are listed before a field is read.
MOST_EXAMINED = 16


class SomeTimes:
    """A reader of PyVista's, limited to some of its times."""

    def __init__(self, reader: Any, times: Sequence[float]) -> None:
        self._reader = reader
        self.time_values = list(times)
        self.active_time_value = self.time_values[0]

    def set_active_time_value(self, time: float) -> None:
        """Set the time to read."""
        self.active_time_value = time

    def read(self) -> Any:
        """Read the mesh at the active time, and restore the time of the reader."""
        before = self._reader.active_time_value
        self._reader.set_active_time_value(self.active_time_value)
        try:
            return self._reader.read()
        finally:
            self._reader.set_active_time_value(before)


def times_of(source: Any) -> list[float]:
    """Return the times of a reader, or of a list of steps; empty if there are none."""
    if not isinstance(source, list):
        return parts.times_of(source)
    times = []
    for number, step in enumerate(parts.time_steps(source)):
        if step.time is None:
            times.append(float(number))
        else:
            times.append(step.time)
    return times


def limited(source: Any, times: Sequence[float]) -> Any:
    """Return a reader or a list of steps with some of its times."""
    if not isinstance(source, list):
        return SomeTimes(source, times)
    found = []
    for time, step in zip(times_of(source), source, strict=True):
        if time in times:
            found.append(step)
    return found


def examined(reader: Any) -> Any:
    """Return a reader of the times whose arrays are listed: the first, the last, and others."""
    times = parts.times_of(reader)
    count = min(len(times), MOST_EXAMINED)
    numbers = np.linspace(0, len(times) - 1, count).round().astype(int)
    return SomeTimes(reader, [times[number] for number in numbers])


def with_velocity(
    source: Any, options: FieldOptions, record: Record
) -> tuple[str | None, Iterator[TimeStep]]:
    """Return the name of the velocity, if it is known, and the steps that have it."""
    vectors = options.vectors
    cut = is_cut(options)
    steps = parts.time_steps(source, options.block, cut=cut, plane=options.plane, record=record)
    if vectors is None and not is_cut(options):
        first = next(steps, None)
        if first is not None:
            # The first step usually moves: then no step is read twice.
            steps = chain([first], steps)
            if _may_be_wall(first.grid):
                again = parts.time_steps(source, options.block, plane=options.plane)
                vectors = wall_stress(again, record)
    return vectors, having(steps, vectors, record)


def is_cut(options: FieldOptions) -> bool:
    """Return whether a volume is cut."""
    return options.slice is not None or options.contour is not None


def wall_stress(steps: Iterator[TimeStep], record: Record) -> str | None:
    """Return the name of the stress on a surface where the velocity is always zero, if any."""
    for step in steps:
        grid = step.grid
        if not _may_be_wall(grid):
            return None
        stresses, others = _stresses_and_others(grid)
        for array in stresses:
            if others and is_nonzero(values_of(grid, array)):
                name = others[0].name
                text = f'"{name}" is zero on this wall, so "{array.name}" is drawn'
                other = Remedy("vectors", name, "to draw the other one,")
                record("select", text, other, notable=True)
                return array.name
    return None


def _may_be_wall(grid: Any) -> bool:
    """Return whether no velocity moves on a surface, or whether a mesh has no vectors."""
    stresses, others = _stresses_and_others(grid)
    if (stresses or others) and grid.max_cell_dimensionality != 2:
        return False
    return not any(is_nonzero(values_of(grid, array)) for array in others)


def _stresses_and_others(grid: Any) -> tuple[list[MeshArray], list[MeshArray]]:
    """Return the vectors that are a stress on a wall by their names, and the other ones."""
    stresses = []
    others = []
    for array in candidates(grid):
        if WALL_STRESS.fullmatch(array.name):
            stresses.append(array)
        else:
            others.append(array)
    return stresses, others


def having(steps: Iterator[TimeStep], vectors: str | None, record: Record) -> Iterator[TimeStep]:
    """Yield the steps that have the velocity; a notice names the times that lack it.

    Raises
    ------
    FieldError
        If no step has it. The message lists the arrays of all times.
    """
    lacking: list[TimeStep] = []
    count = 0
    times: dict[str, list[str]] = {}
    for step in steps:
        # A series without times has no moments to leave out.
        if step.time is None or _has(step.grid, vectors):
            count += 1
            yield step
            continue
        if not lacking:
            first = step
        lacking.append(replace(step, grid=None))
        for array in catalogue(step.grid):
            times.setdefault(str(array), []).append(when(step))
    if not lacking:
        return
    if not count and len(lacking) == 1:
        yield first
        return
    if not count:
        _refuse(first, vectors, len(lacking), times)
    lack = f"no array {vectors!r}"
    if vectors is None:
        lack = "no vectors that could be the velocity"
    times_without = listed(map(when, lacking))
    record("align", f"{lack} at {times_without}, which is left out", notable=True)


def _has(grid: Any, vectors: str | None) -> bool:
    """Return whether a mesh has vectors with a name, or any that can be a velocity."""
    if vectors is None:
        return bool(candidates(grid))
    try:
        select_velocity(grid, vectors, Record())
    except FieldError:
        return False
    return True


def _refuse(first: TimeStep, vectors: str | None, count: int, times: dict[str, list[str]]) -> None:
    """Raise the error for a series whose steps lack the velocity."""
    try:
        select_velocity(first.grid, vectors, Record())
    except FieldError as error:
        partial = []
        for name, at in times.items():
            if len(at) < count:
                partial.append(f"{name} at {listed(at)}")
        if not partial:
            raise
        text = f"{error}; other times have {', '.join(partial)}"
        raise FieldError(text) from error


def when(step: TimeStep) -> str:
    """Return the time of a step as text, or its label."""
    if step.time is None:
        return step.label
    return f"time {step.time:g}"


def listed(texts: Iterable[str]) -> str:
    """Return some of many texts as a list."""
    every = list(texts)
    shown = every[:MOST_LISTED]
    if len(every) > len(shown):
        shown.append("...")
    return ", ".join(shown)


def around(source: Any, time: float | str, options: FieldOptions) -> tuple[Any, float]:
    """Return the part of a source that has the one or two times around a time, and its number.

    Only times that have the named vectors count, or the stress on a wall where nothing moves.
    """
    moment, chosen = _bracket(time, times_of(source), "the file has")
    part = limited(source, chosen)

    def steps_of(some: Any) -> Iterator[TimeStep]:
        return parts.time_steps(some, options.block, cut=is_cut(options))

    vectors = options.vectors
    if vectors is None and not is_cut(options):
        vectors = wall_stress(chain(steps_of(part), steps_of(source)), Record())
    if vectors is None or all(_has(step.grid, vectors) for step in steps_of(part)):
        return part, moment
    having_it = [step.time for step in steps_of(source) if _has(step.grid, vectors)]
    known = []
    for each in having_it:
        if each is not None:
            known.append(each)
    if known:
        moment, chosen = _bracket(time, known, f"{vectors!r} has")
    return limited(source, chosen), moment


def _bracket(time: float | str, times: Sequence[float], owner: str) -> tuple[float, list[float]]:
    """Return a time as a number, and the one or two of some times around it."""
    ordered = sorted(times)
    if ordered and time in ENDS:
        end = ordered[ENDS[str(time)]]
        return end, [end]
    if isinstance(time, str):
        text = 'a number, within the times of the file, or "first" or "last"'
        raise FieldError(f"time is {time!r}; expected {text}")
    for value in ordered:
        if math.isclose(value, time, rel_tol=1e-6, abs_tol=1e-12):
            return value, [value]
    number = bisect.bisect(ordered, time)
    if 0 < number < len(ordered):
        return float(time), ordered[number - 1 : number + 1]
    if not ordered:
        raise FieldError(f"time is {time!r}; {owner} no times")
    known = listed(f"{value:g}" for value in ordered)
    raise FieldError(f"time is {time!r}; {owner} the times {known}")


def interpolated(arrays: SourceArrays, time: float) -> SourceArrays:
    """Return the arrays of two times as those of a time between them."""
    times = np.asarray(arrays.times, dtype=np.float64)
    moment = steps_around(times, time)
    text = f"interpolated between the times {times[0]:g} and {times[1]:g}"
    scalars = {name: at_moment(steps, moment)[None] for name, steps in arrays.scalars.items()}
    flat = {name: at_moment(steps, moment)[None] for name, steps in arrays.cell_scalars.items()}
    return replace(
        arrays,
        velocity=at_moment(arrays.velocity, moment)[None],
        scalars=scalars,
        cell_scalars=flat,
        times=[time],
        reading=Reading((*arrays.reading, ReadingStep("align", text))),
    )
