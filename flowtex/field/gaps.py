"""Nodes that have data only at some times, as of a radar, or of a level below the ground.

A field has one mask for all times, so the velocity of such nodes is zero while they lack data. They
are drawn without streaks, as the uncertainty of their direction is 1, and in the colour of NaN.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from flowtex._util.array_types import Bools, Floats
from flowtex.errors import FieldError
from flowtex.field.dates import as_seconds
from flowtex.field.steps import LazySteps, map_steps, typical_steps
from flowtex.field.units import speed_unit, velocity_units
from flowtex.field.validation import with_gaps

#: The scalar that is 1 where there are no data, 0 elsewhere.
NO_DATA = "no data"


class Filled(NamedTuple):
    """Arguments of a field; ``uncertainty`` is empty without gaps in time."""

    velocity: Any
    scalars: Mapping[str, Any]
    units: Mapping[str, str]
    uncertainty: str


def filled_gaps(
    velocity: Any,
    scalars: Mapping[str, Any] | None,
    units: Mapping[str, str] | None,
    *,
    axes: int,
    unit: str,
) -> Filled:
    """Return a velocity (T, ..., 2 or 3) that is zero where only some times have no data.

    ``axes`` is the number of axes of the nodes, ``unit`` the unit of the speed. Of lazy steps the
    first, the middle and the last one are compared if the first one has missing data.
    """
    unchanged = Filled(velocity, {} if scalars is None else scalars, units or {}, "")
    if isinstance(velocity, LazySteps):
        numbers = typical_steps(len(velocity)) if not _known(velocity[0]).all() else []
        masks: list[Bools] | Bools = [_known(velocity[number]) for number in numbers]
    else:
        try:
            velocity = with_gaps("velocity", velocity)
        except FieldError:  # the field lists all faults later
            return unchanged
        masks = _known(velocity) if velocity.ndim == axes + 2 else []
    if len(masks) < 2 or not isinstance(unchanged.scalars, Mapping):
        return unchanged
    sometimes: Bools = np.any(masks, axis=0)
    if np.array_equal(sometimes, np.all(masks, axis=0)):
        return unchanged

    def filled(step: Floats) -> Floats:
        return np.where((sometimes & ~_known(step))[..., None], 0.0, step)

    def lacking(step: Floats) -> Floats:
        return np.where(_known(step), 0.0, 1.0)

    def speed(step: Floats) -> Floats:
        with np.errstate(over="ignore", invalid="ignore"):  # the field refuses such values later
            return np.where(_known(step), np.linalg.norm(step, axis=-1), np.nan)

    additions = {NO_DATA: map_steps(velocity, lacking), "speed": map_steps(velocity, speed)}
    return Filled(
        map_steps(velocity, filled),
        {**unchanged.scalars, **{k: v for k, v in additions.items() if k not in unchanged.scalars}},
        {"speed": unit, **(units or {})},
        NO_DATA,
    )


def known_nodes(field: Any, first: int, last: int) -> Bools:
    """Return the valid nodes of a field that have data at all steps of a range, (J, I)."""
    known: Bools = field.valid.copy()
    if field.uncertainty == NO_DATA:
        for step in range(first, last + 1):
            known &= np.asarray(field.scalars[NO_DATA][step]) < 1
    return known


def _known(step: Floats) -> Bools:
    return np.asarray(np.isfinite(step).all(axis=-1))


def prepared(
    times: Any, texts: tuple[str, str, str], velocity: Any, scalars: Any, units: Any, *, axes: int
) -> tuple[Floats | None, float, Filled, dict[str, Any]]:
    """Return times, a factor of the velocity, data without gaps in time, and units of a field.

    The texts are the units of length, time and velocity; ``axes`` counts those of the nodes.
    """
    times, time_unit, start = as_seconds(times, texts[1])
    t = None if times is None else with_gaps("times", times)
    scale, time_unit, velocity_unit = velocity_units(texts[0], time_unit, texts[2])
    unit = velocity_unit or speed_unit(texts[0], time_unit)
    filled = filled_gaps(velocity, scalars, units, axes=axes, unit=unit)
    words: dict[str, Any] = {
        "length_unit": texts[0],
        "time_unit": time_unit,
        "velocity_unit": velocity_unit,
    }
    words |= {"start": start, "units": dict(filled.units), "uncertainty": filled.uncertainty}
    return t, scale, filled, words
