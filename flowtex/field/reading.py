"""What a field says at one place of its surface: what a tip under the pointer shows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flowtex.field.facets import Facet, facet
from flowtex.field.field import FlowField
from flowtex.field.interpolation import steps_around

__all__ = ["Reading", "reading"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Reading:
    """The data at one place of the surface, at one time.

    Attributes
    ----------
    index
        The place as (j, i), in cells.
    position
        The place in space, (3,), in the mesh's own units.
    velocity
        Velocity there, (3,), in the mesh's units per unit of time.
    speed
        Speed along the surface, in the same unit; what colours show.
    scalars
        Values of the field's other arrays, by name.
    time
        The time that they are of, in the field's own unit.
    length_unit, time_unit
        Words for captions; empty when unknown.
    """

    index: tuple[float, float]
    position: Floats
    velocity: Floats
    speed: float
    scalars: Mapping[str, float]
    time: float
    length_unit: str = ""
    time_unit: str = ""

    @property
    def speed_unit(self) -> str:
        """Word for the unit of speed; empty when one of the units is unknown."""
        length, time = self.length_unit, self.time_unit
        if not length or not time:
            return ""
        if time.startswith(f"{length} / "):
            return time.removeprefix(f"{length} / ")
        return f"{length} / ({time})" if "/" in time else f"{length}/{time}"


def reading(field: FlowField, index: ArrayLike, time: float | None = None) -> Reading:
    """Read a field at a place of its surface.

    Values are linear in the triangles that the surface is drawn with, and in time, so they are
    those whose colours a picture shows.

    Parameters
    ----------
    field
        The flow.
    index
        (j, i) in cells, as :func:`~flowtex.field.locate.locate` finds it. An axis that closes on
        itself takes any number.
    time
        When, in the field's own unit; the last time by default. A steady field has one time.

    Raises
    ------
    ValueError
        When the place is not on the surface or the time not within the field's times.
    """
    return _read(field, facet(field.surface, index), time)


def _read(field: FlowField, place: Facet, time: float | None) -> Reading:
    first, last = float(field.times[0]), float(field.times[-1])
    at = last if time is None or field.steady else float(time)
    if not first <= at <= last:
        msg = f"time is {time!r}; expected {first:g} to {last:g}, the times of the field"
        raise ValueError(msg)
    before, after, late = steps_around(field.times, at)

    def value(steps: Floats) -> Floats:
        if len(steps) == 1:
            return place.mix(steps[0])
        a, b = (place.mix(steps[n]) for n in (before, after))
        return np.asarray(a * (1 - late) + b * late)

    return Reading(
        index=place.index,
        position=place.mix(field.surface.points),
        velocity=_axis(field, place) if field.sign_free else value(field.velocity),
        speed=float(value(field.speed)),
        scalars={name: float(value(steps)) for name, steps in field.scalars.items()},
        time=at,
        length_unit=field.length_unit,
        time_unit=field.time_unit,
    )


def _axis(field: FlowField, place: Facet) -> Floats:
    """Vector of a field without a sign: corners that point against the first are turned over."""
    corners = place.corners(field.velocity[0])
    signs = np.where(corners @ corners[0] < 0, -1.0, 1.0)
    return np.asarray((place.weights * signs) @ corners)
