"""The values of a field at one point of its surface, as in a tooltip."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.arguments import check_field
from flowtex._util.array_types import Floats
from flowtex.field.dates import time_within
from flowtex.field.derived import speed_unit
from flowtex.field.field import FlowField
from flowtex.field.grids.signs import weighted_axis
from flowtex.field.interpolation import steps_around
from flowtex.field.locate import surface_point


@dataclass(frozen=True, eq=False)
class PointValues:
    """The values of a field at one point of the surface and one time.

    ``index`` is (j, i) in cells, ``position`` (3,) in the mesh's units, ``velocity`` (3,) in the
    mesh's units per unit of time, ``speed`` its magnitude along the surface, as in colours, and
    ``speed_label`` its name. For a field with a projection, ``lonlat`` are longitude and
    latitude in degrees, and ``eastward`` and ``northward`` the velocity on the Earth.

    Examples
    --------
    >>> import flowtex
    >>> from flowtex.scene.probe import values_at
    >>> values = values_at(flowtex.examples.double_gyre_field(), (25, 50))
    >>> [round(float(x), 2) for x in values.position], round(values.speed, 3)
    ([0.5, 0.25, 0.0], 0.222)
    """

    index: tuple[float, float]
    position: Floats
    velocity: Floats
    speed: float
    scalars: Mapping[str, float]
    time: float
    length_unit: str = ""
    time_unit: str = ""
    speed_label: str = "speed"
    lonlat: tuple[float, float] | None = None
    eastward: float = 0.0
    northward: float = 0.0

    @property
    def speed_unit(self) -> str:
        """Unit of the speed; empty if the unit of length or of time is unknown."""
        return speed_unit(self.length_unit, self.time_unit)


def values_at(field: FlowField, index: ArrayLike, time: Any = None) -> PointValues:
    """Return the values of a field at a point of its surface.

    They are linear in the triangles of the drawn surface, and in time, as are the colours of a
    picture.

    Parameters
    ----------
    field
        The flow.
    index
        (j, i) in cells; :func:`~flowtex.scene.probe.locate` returns it for a point in space.
    time
        Time in the field's unit; or a date, as text, ``numpy.datetime64``, ``datetime`` or of
        cftime, if the times are dates. The last one by default.

    Raises
    ------
    FieldError
        When the point is not on the surface, or the time is outside the field's times.

    Examples
    --------
    >>> import flowtex
    >>> from flowtex.scene.probe import locate, values_at
    >>> field = flowtex.examples.cylinder_field()
    >>> at = locate(field, (2.0, 0.5))
    >>> sorted(values_at(field, at, time=field.times[3]).scalars)
    ['vorticity']
    """
    check_field(field, FlowField)
    point = surface_point(field.surface, index)
    moment = float(field.times[-1])
    if time is not None and not field.steady:
        moment = time_within(field.start, field.times, time)
    before, after, share = steps_around(field.times, moment)

    def value(steps: Floats) -> Floats:
        if len(steps) == 1:
            return point.interpolate(steps[0])
        a, b = (point.interpolate(steps[n]) for n in (before, after))
        return np.asarray(a * (1 - share) + b * share)

    if field.sign_free:
        velocity = weighted_axis(point.corners(field.velocity[0]), point.weights)
    else:
        velocity = value(field.velocity)
    position = point.interpolate(field.surface.points)
    return PointValues(
        index=point.index,
        position=position,
        velocity=velocity,
        speed=float(value(field.speed)),
        scalars={name: float(value(steps)) for name, steps in field.scalars.items()},
        time=moment,
        length_unit=field.length_unit,
        time_unit=field.time_unit,
        speed_label=field.speed_label,
        **_on_earth(field, position, velocity),
    )


def _on_earth(field: FlowField, position: Floats, velocity: Floats) -> dict[str, Any]:
    """Return place and velocity on the Earth, where the field has a projection."""
    if field.projection is None:
        return {}
    lon, lat = field.projection.lonlat(position)
    east, north = field.projection.components(lon, lat, velocity)
    return {"lonlat": (float(lon), float(lat)), "eastward": float(east), "northward": float(north)}
