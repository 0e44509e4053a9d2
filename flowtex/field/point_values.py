"""The values of a field at one point of its surface, as in a tooltip."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.arguments import brief, check_field
from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.field.constructors import FieldConstructors
from flowtex.field.dates import time_within
from flowtex.field.earth import Projection
from flowtex.field.grids.arrays import weighted_axis
from flowtex.field.interpolation import steps_around
from flowtex.field.locate import (
    CURVED_TOLERANCE,
    EARTH,
    FLAT_TOLERANCE,
    SurfacePoint,
    locate,
    locate_lonlat,
    lonlats,
    turned,
    value_point,
)
from flowtex.field.steps import Steps

#: Share of the way to the middle of a cell by which its corners are moved to one side of a map.
INWARD = 1e-6


@dataclass(frozen=True, eq=False)
class PointValues:
    """The values of a field at one point of the surface and one time.

    ``index`` is (j, i) in cells, and ``position`` (3,) in the mesh's units. ``velocity``, (3,), and
    its magnitude, ``speed``, are in ``speed_unit``, that of the data; where a notable part of the
    flow leaves the surface, the speed is that along it, and ``speed_label`` says so. For a field
    with a projection, ``lonlat`` are longitude and latitude in degrees, ``eastward`` and
    ``northward`` the velocity on the Earth and ``speed`` its magnitude, while ``velocity`` is that
    on the map.

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
    speed_unit: str = ""
    speed_label: str = "speed"
    lonlat: tuple[float, float] | None = None
    eastward: float = 0.0
    northward: float = 0.0


def values_at(field: Any, index: ArrayLike, time: Any = None) -> PointValues:
    """Return the values of a field at a point of its surface.

    They are bilinear in cells that are parallelograms, in longitude and latitude or in space,
    elsewhere linear in the triangles of the drawn surface; and linear in time. Scalars that belong
    to cells have the value of the cell.

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
    check_field(field, FieldConstructors)
    point = value_point(field, index)
    moment = float(field.times[-1])
    if time is not None and not field.steady:
        moment = time_within(field.start, field.times, time)
    before, after, share = steps_around(field.times, moment)

    def value(steps: Steps, corners: Callable[[Floats], Floats] = point.corners) -> Floats:
        if len(steps) == 1:
            return corners(steps[0])
        return corners(steps[before]) * (1 - share) + corners(steps[after]) * share

    def scalar(name: str) -> float:
        steps = field.scalars[name]
        if name in field.on_cells:
            return float(value(steps, lambda step: np.ravel(step)[point.cell]))
        return float(weights @ value(steps))

    scale, weights = field.speed_scale, point.weights
    vectors = scale * value(field.velocity)
    velocity = weighted_axis(vectors, weights) if field.sign_free else weights @ vectors
    values: dict[str, Any] = {
        "position": point.interpolate(field.surface.points),
        "velocity": velocity,
        "speed": float(np.linalg.norm(velocity)),
        "scalars": {name: scalar(name) for name in field.scalars},
    }
    if field.leaves_surface:
        values["speed"] = float(weights @ value(field.index_velocity.speed) * scale)
    if field.projection is not None:
        values |= _on_earth(field, field.projection, point, values, partial(value, field.velocity))
    return PointValues(
        index=point.index,
        time=moment,
        length_unit=field.length_unit,
        time_unit=field.time_unit,
        speed_unit=field.speed_unit,
        speed_label=field.speed_label,
        **values,
    )


def point_at(field: Any, place: ArrayLike, time: Any = None) -> PointValues | None:
    """Return the values at a place in the coordinates of the data; ``None`` outside the data."""
    at = np.asarray(place, dtype=float)
    if not np.isfinite(at).all():
        raise FieldError(f"the place is {brief(place)}; expected finite numbers")
    if field.projection is not None:
        index = locate_lonlat(field, *at.tolist())
    else:
        frame = field.surface.frame
        if len(at) == 2 and frame is not None and not frame[:, 2].any():
            at = np.append(at, field.surface.center[2])
        index = locate(field, at, tolerance=CURVED_TOLERANCE if frame is None else FLAT_TOLERANCE)
    return None if index is None else values_at(field, index, time)


def _on_earth(
    field: Any,
    projection: Projection,
    point: SurfacePoint,
    values: Mapping[str, Any],
    at_time: Callable[[Callable[[Floats], Floats]], Floats],
) -> dict[str, Any]:
    """Return place and velocity on the Earth, which do not depend on the map."""
    corners, weights = point.corners(field.surface.points), point.weights
    places = lonlats(field, corners)
    lon, lat = places.T
    if len(weights) == 4:
        here = weights @ places
    else:
        here = np.array(EARTH.lonlat(weights @ EARTH.positions(lon, lat)))
    # Corners at the edge of a map have the directions of the side where the cell is.
    middle, origin = lon.mean(), projection.origin or projection.center[0]
    side = origin + turned(middle - origin) + (1 - INWARD) * (lon - middle)

    def components(nodal: Floats) -> Floats:
        east, north = projection.components(side, lat, point.corners(nodal))
        return np.asarray(np.stack([east, north], axis=-1) * field.speed_scale)

    east, north = at_time(components).T
    if len(weights) == 4:
        eastward, northward = weights @ east, weights @ north
    else:  # directions differ between the corners, as around a pole
        vector = weights @ EARTH.vectors(lon, lat, east, north)
        eastward, northward = EARTH.components(here[0], here[1], vector)
    # On the map, or on the sphere; beyond the edge of a map the surface continues.
    position = projection.positions(here[0], here[1])
    about, size = values["position"], np.ptp(corners, axis=0).max()
    scalars = {**values["scalars"]}
    if not projection.is_globe:
        scalars.pop("speed", None)  # which is that on the Earth
    return {
        "position": position if np.abs(position - about).max() <= size else about,
        "scalars": scalars,
        "lonlat": (float(turned(here[0])), float(here[1])),
        "eastward": float(eastward),
        "northward": float(northward),
        "speed": float(np.hypot(eastward, northward)),
    }
