"""Quantities of a field: derived from its velocity, and at one point as in a tooltip."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.arguments import brief, check_field, checked_array
from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.field.dates import time_within
from flowtex.field.derived.gradient import true_positions
from flowtex.field.earth.projection import Projection
from flowtex.field.field_data import Data, FieldData
from flowtex.field.finer import finest_of
from flowtex.field.grids.grid_nodes import weighted_axis
from flowtex.field.interpolation import at_moment, nearer_step, steps_around
from flowtex.field.locate import (
    CURVED_TOLERANCE,
    EARTH,
    FLAT_TOLERANCE,
    SurfacePoint,
    locate,
    locate_lonlat,
    lonlats,
    surface_point,
    turned,
    value_point,
)
from flowtex.field.scalars import Scalars
from flowtex.field.steps import LazySteps, Steps

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
    on the map. Between two time steps the speed is interpolated like a scalar, as in pictures: it
    is the mean of the speeds at both, which is more than the magnitude of the mean velocity where
    the flow turns.

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


def values_at(field: FieldData, index: ArrayLike, time: Any = None) -> PointValues:
    """Return the values of a field at a point of its surface.

    They are bilinear in cells that are parallelograms, in longitude and latitude or in space,
    elsewhere linear in the triangles of the drawn surface; and linear in time, as the speed is too.
    Scalars that belong to cells have the value of the cell.

    Parameters
    ----------
    field
        The flow.
    index
        (j, i) in cells; :func:`~flowtex.scene.probe.locate` returns it for a point in space.
    time
        Time in the field's unit; or a date, as text, ``numpy.datetime64``, ``datetime`` or of
        cftime, if the times are dates. The first one by default, as in pictures.

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
    check_field(field, FieldData)
    finest = finest_of(field)
    if finest is None:
        return _values_at(field, index, time)
    position = surface_point(field.surface, index).interpolate(field.surface.points)
    part = finest.near(true_positions(position, field.projection)).field
    nearest = locate(part, position, tolerance=np.inf)
    if nearest is None:  # all nodes around it are blank at the finest level
        return _values_at(field, index, time)
    at = checked_array("index", index, expected="two finite numbers (j, i), in cells")
    time = _moment(field, time)
    return _with_others(_values_at(part, nearest, time), field, (float(at[0]), float(at[1])), time)


def _moment(field: FieldData, time: Any) -> Any:
    """Return a time for the finest level of a field that may itself have only one step."""
    if time is None or field.steady:
        return field.first_time
    return time


def _with_others(
    values: PointValues, field: FieldData, index: tuple[float, float], time: Any
) -> PointValues:
    """Return values of the finest level for (j, i) in the coarse field, which may have others."""
    scalars = values.scalars
    if set(field.scalars) - set(scalars) - {"speed"}:
        scalars = Scalars({**_values_at(field, index, time).scalars, **scalars})
    return replace(values, index=index, scalars=scalars)


def _values_at(field: FieldData, index: ArrayLike, time: Any) -> PointValues:
    """Return the values at (j, i) from the nodes that are in memory."""
    point = value_point(field, index)
    moment, between = _known_steps(field, point, time)

    def value(steps: Steps, corners: Callable[[Floats], Floats] = point.corners) -> Floats:
        return at_moment(steps, between, corners)

    def mean(vectors: Floats) -> Floats:
        if field.sign_free:
            return weighted_axis(vectors, weights)
        return np.asarray(weights @ vectors)

    def speed(step: Floats) -> Floats:
        return np.asarray(np.linalg.norm(mean(point.corners(step))))

    scale = field.speed_scale
    weights = point.weights
    values: dict[str, Any] = {
        "position": point.interpolate(field.surface.points),
        "velocity": mean(scale * value(field.velocity)),
        "speed": float(scale * value(field.velocity, speed)),
        "scalars": Scalars(),
    }
    for name in field.scalars:
        values["scalars"][name] = _scalar_at(field, name, point, between)
    if field.leaves_surface:
        values["speed"] = float(weights @ value(field.index_velocity.speed) * scale)
    if field.projection is not None:
        values |= _on_earth(field, field.projection, point, values, partial(value, field.velocity))
    if not _is_known(field, point, between):
        values |= _without_velocity(values)
    return PointValues(
        index=point.index,
        time=moment,
        length_unit=field.length_unit,
        time_unit=field.time_unit,
        speed_unit=field.speed_unit,
        speed_label=field.speed_label,
        **values,
    )


def _known_steps(
    field: FieldData, point: SurfacePoint, time: Any
) -> tuple[float, tuple[int, int, float]]:
    """Return a time as a number, the steps around it and the share of the later one.

    Where one of the steps has no data, it is the nearer of both alone.
    """
    moment = field.first_time
    if time is not None and not field.steady:
        moment = time_within(field.start, field.times, time)
    between = steps_around(field.times, moment)
    if not _is_known(field, point, between):
        between = nearer_step(between)
    return moment, between


def _without_velocity(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return NaN for each part of the velocity among the values at a point."""
    unknown: dict[str, Any] = {"speed": np.nan, "velocity": np.full(3, np.nan)}
    for name in ("eastward", "northward"):
        if name in values:
            unknown[name] = np.nan
    return unknown


def _is_known(field: FieldData, point: SurfacePoint, between: tuple[int, int, float]) -> bool:
    """Return whether all nodes that have a share in the values at a point have data."""
    first, last, share = between
    if share == 0:
        last = first
    elif share == 1:
        first = last
    known = point.corners(field.known_nodes(first, last))
    return bool(known[point.weights > 0].all())


def _scalar_at(
    field: FieldData, name: str, point: SurfacePoint, between: tuple[int, int, float]
) -> float:
    """Return a scalar at a point between two time steps; one on cells has the cell's value."""
    steps = field.scalars[name]
    if name in field.on_cells:
        return float(at_moment(steps, between, lambda step: np.ravel(step)[point.cell]))
    return float(point.weights @ at_moment(steps, between, point.corners))


def _mean_lonlat(weights: Floats, lon: Floats, lat: Floats) -> Floats:
    """Return the weighted mean of places, longitude and latitude in degrees, (2,)."""
    if len(weights) == 4:
        return weights @ np.stack([lon, lat], axis=-1)
    return np.array(EARTH.lonlat(weights @ EARTH.positions(lon, lat)))


def _on_earth(
    field: FieldData,
    projection: Projection,
    point: SurfacePoint,
    values: Mapping[str, Any],
    at_time: Callable[[Callable[[Floats], Floats]], Floats],
) -> dict[str, Any]:
    """Return place and velocity on the Earth, which do not depend on the map."""
    corners = point.corners(field.surface.points)
    weights = point.weights
    lon, lat = lonlats(field, corners).T
    here = _mean_lonlat(weights, lon, lat)
    # Corners at the edge of a map have the directions of the side where the cell is.
    middle = lon.mean()
    origin = projection.origin or projection.center[0]
    side = origin + turned(middle - origin) + (1 - INWARD) * (lon - middle)

    def components(nodal: Floats) -> Floats:
        east, north = projection.components(side, lat, point.corners(nodal))
        return np.asarray(np.stack([east, north], axis=-1) * field.speed_scale)

    def mean(nodal: Floats) -> Floats:
        if len(weights) == 4:
            return np.asarray(weights @ nodal)
        # Directions differ between the corners, as around a pole.
        vector = weights @ EARTH.vectors(lon, lat, *nodal.T)
        return np.array(EARTH.components(here[0], here[1], vector))

    def speed(nodal: Floats) -> Floats:
        return np.asarray(np.linalg.norm(mean(components(nodal))))

    eastward, northward = mean(at_time(components))
    # On the map, or on the sphere; beyond the edge of a map the surface continues.
    position = projection.positions(here[0], here[1])
    about = values["position"]
    if np.abs(position - about).max() > np.ptp(corners, axis=0).max():
        position = about
    scalars = {**values["scalars"]}
    if not projection.is_globe:
        scalars.pop("speed", None)  # which is that on the Earth
    return {
        "position": position,
        "scalars": scalars,
        "lonlat": (float(turned(here[0])), float(here[1])),
        "eastward": float(eastward),
        "northward": float(northward),
        "speed": float(at_time(speed)),
    }


def values_near(field: FieldData, x: float, y: float, z: Any, time: Any) -> PointValues | None:
    """Return the values at a place, as :meth:`flowtex.FlowField.at` does.

    Raises
    ------
    FieldError
        As there.
    """
    if field.projection is not None and z is not None:
        if time is not None:
            raise FieldError(f"z is {z}, but the field lies on the Earth; omit z")
        z, time = None, z
    place = [x, y]
    if z is not None:
        place.append(z)
    expected = "finite numbers, those of one place"
    at = checked_array("the place", place, expected=expected)
    if at.ndim != 1 or not np.isfinite(at).all():
        raise FieldError(f"the place is {brief(place)}; expected {expected}")
    frame = field.surface.frame
    tolerance = CURVED_TOLERANCE
    if field.projection is None and frame is not None:
        tolerance = FLAT_TOLERANCE
        if len(at) == 2 and not frame[:, 2].any():
            at = np.append(at, field.surface.center[2])
    finest = finest_of(field)
    if finest is None:
        index = _located(field, at, tolerance)
        if index is None:
            return None
        return _values_at(field, index, time)
    part = finest.near(_in_space(field, at))
    if not len(part.field.surface.drawn):  # nothing around the place has data
        return None
    index = _located(part.field, at, tolerance)
    if index is None:
        return None
    time = _moment(field, time)
    values = _values_at(part.field, index, time)
    return _with_others(values, field, part.coarse_index(index), time)


def with_speed_on_earth(field: Data) -> Data:
    """Return a field on a flat map with the speed on the Earth, which the map distorts."""
    projection = field.projection
    if projection is None or projection.is_globe:
        return field
    lon, lat = projection.lonlat(field.points)
    on_map = field.scalars.get("speed")  # missing where only some steps have no data

    def read(number: int) -> Floats:
        east, north = projection.components(lon, lat, field.velocity[number])
        speed: Floats = np.hypot(east, north) * field.speed_scale
        if on_map is not None:
            speed[np.isnan(on_map[number])] = np.nan
        return speed

    steps: Steps = LazySteps(len(field.velocity), read)
    if not isinstance(field.velocity, LazySteps):
        steps = np.asarray(steps)
    scalars = {**field.scalars, "speed": steps}
    units = {**field.units, "speed": field.speed_unit}
    return field.same_flow(scalars=scalars, units=units)


def _located(field: FieldData, at: Floats, tolerance: float) -> tuple[float, float] | None:
    """Return (j, i) of a longitude and latitude, or of a position."""
    if field.projection is not None:
        return locate_lonlat(field, *at.tolist())
    return locate(field, at, tolerance=tolerance)


def _in_space(field: FieldData, at: Floats) -> Floats:
    """Return the position (3,) of a longitude and latitude on the globe, or of a place."""
    if field.projection is not None:
        position: Floats = EARTH.positions(at[:1], at[1:2])[0]
        return position
    return np.append(at, np.zeros(3 - len(at)))
