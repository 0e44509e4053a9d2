"""One analytic flow on the Earth and one in the plane, and a comparison of fields with them."""

from __future__ import annotations

import datetime
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any

import numpy as np
import xarray as xr
from scipy.spatial import KDTree

from flowtex import FlowField
from flowtex._util.array_types import AnyArray, Floats

EAST = {"units": "m s-1", "standard_name": "eastward_wind"}
NORTH = {"units": "m s-1", "standard_name": "northward_wind"}
EAST_AT_SEA = {"units": "m s-1", "standard_name": "eastward_sea_water_velocity"}
NORTH_AT_SEA = {"units": "m s-1", "standard_name": "northward_sea_water_velocity"}
DEGREES = {"lat": {"units": "degrees_north"}, "lon": {"units": "degrees_east"}}
#: The date at hour 0.
EPOCH = datetime.datetime(2024, 1, 1)
#: Distance in degrees, or as a share of the extent of a plane, up to which places are the same.
NEAR = 2e-3
#: Error as a share of the greatest speed.
EXACT = 2e-4
#: Error of means of two values half a cell away, for cells of a degree.
AVERAGED = 2e-3


def wind(lon: Any, lat: Any, hours: Any = 0.0) -> tuple[Floats, Floats]:
    """Eastward and northward velocity in m/s, at degrees and hours since the epoch."""
    a, b, t = np.radians(lon), np.radians(lat), np.asarray(hours) / 9
    east = 9 * np.cos(b) + 4 * np.sin(3 * a - t) + 2 * np.sin(b)
    return east, 5 * np.cos(a + t) * np.cos(b) + 3 * np.sin(2 * b + 0.4)


def plane(x: Any, y: Any, t: Any = 0.0) -> tuple[Floats, Floats]:
    """Velocity along x and y in lengths per second, at places a few lengths wide."""
    return 1 + 0.5 * np.sin(2 * x - t) + 0.2 * y, 0.8 * np.cos(1.5 * y + 0.5 * t) + 0.3 * x


Flow = Callable[..., tuple[Floats, Floats]]


@dataclass(frozen=True, eq=False)
class Truth:
    """The nodes of a form, and the flow there; everything else would be wrong.

    ``times`` are hours since the epoch, or seconds in the plane; ``scale`` a factor of the flow,
    or one for each time. Nodes outside ``core`` may be absent, as at the edge of a C grid.
    ``absent`` marks nodes without data at some times, (T, N). ``undated`` times are compared as
    numbers, whatever their unit.
    """

    places: Floats  #: Longitude and latitude in degrees, or positions in the plane, (N, 2).
    times: tuple[float, ...] = (0.0,)
    on_earth: bool = True
    flow: Flow = wind
    scale: Any = 1.0
    core: AnyArray | None = None
    absent: AnyArray | None = None
    undated: bool = False
    tolerance: float = EXACT
    unit: str = ""  #: Unit of the positions in the plane.
    speed_unit: str = "m/s"
    axes: tuple[int, int] = (0, 1)  #: Coordinates of the points that span the plane.
    scalars: Mapping[str, Callable[..., Any]] = field(default_factory=dict)
    any_place: bool = False  #: Whether nodes may lie elsewhere, if the flow is right there.


def grid(a: Any, b: Any) -> Floats:
    """Return places (N, 2) of the nodes of lines, or of arrays of positions."""
    if np.ndim(a) == 1 and np.ndim(b) == 1:
        a, b = np.meshgrid(a, b)
    return np.stack([np.ravel(a), np.ravel(b)], axis=-1).astype(float)


def on_earth(lon: Any, lat: Any, times: Any = (0.0,), **more: Any) -> Truth:
    """Return the truth of the flow on the Earth."""
    return Truth(grid(lon, lat), tuple(np.atleast_1d(times).tolist()), **more)


def in_plane(x: Any, y: Any, times: Any = (0.0,), **more: Any) -> Truth:
    """Return the truth of the flow in the plane, by default without units."""
    more = {"flow": plane, "speed_unit": "", **more}
    return Truth(grid(x, y), tuple(np.atleast_1d(times).tolist()), on_earth=False, **more)


def at_points(points: Any, **more: Any) -> Truth:
    """Return the truth of the flow in the plane at points, (N, 2)."""
    more = {"flow": plane, "speed_unit": "", **more}
    return Truth(np.asarray(points, dtype=float), on_earth=False, **more)


def without(truth: Truth, blank: Any) -> Truth:
    """Return the truth without nodes, (N,) or in their shape."""
    return replace(truth, places=truth.places[~np.ravel(blank)])


@cache
def units() -> Any:
    """Return a registry of units, apart from the one of the package."""
    import pint

    registry: Any = pint.UnitRegistry(
        preprocessors=[lambda text: text.replace("px", "pixel").replace("s-1", "s**-1")]
    )
    registry.define("frame = [frame]")
    return registry


def ratio(unit: str, wanted: str) -> float:
    """Return the factor from a unit to the wanted one; 1 where one of them is unknown."""
    if not unit or not wanted:
        return 1.0
    return float(units().Quantity(1.0, unit).to(wanted).magnitude)


def check(found: FlowField, truth: Truth) -> None:
    """Compare a field with the truth at every node and time; all faults are in one error."""
    faults = [*_time_faults(found, truth)]
    places = _places(found, truth)
    numbers = _numbers(places, truth)
    if not truth.any_place:
        faults += _coverage_faults(places, numbers, truth)
    if not faults:
        for step, time in enumerate(truth.times):
            faults += _value_faults(found, truth, places, numbers, step, time)
    assert not faults, "\n".join(faults)


def _places(found: FlowField, truth: Truth) -> Floats:
    """Longitude and latitude, or positions in the unit of the truth, of the valid nodes."""
    points = found.points[found.valid]
    if truth.on_earth:
        assert found.projection is not None, "the field is not on the Earth"
        return np.stack(found.projection.lonlat(points), axis=-1)
    assert found.projection is None, "the field is on the Earth"
    if truth.unit:
        assert found.length_unit, f"the unit of length is unknown; expected {truth.unit}"
    return np.asarray(points[:, truth.axes] * ratio(found.length_unit, truth.unit))


def _numbers(places: Floats, truth: Truth) -> AnyArray:
    """Numbers of the true nodes nearest to places, -1 where none is near."""
    here, there = (_comparable(p, truth) for p in (places, truth.places))
    distance, number = KDTree(there).query(here)
    near = np.radians(NEAR) if truth.on_earth else NEAR * np.ptp(there, axis=0).max()
    return np.where(distance <= near, number, -1)


def _comparable(places: Floats, truth: Truth) -> Floats:
    if not truth.on_earth:
        return places
    a, b = np.radians(places).T
    return np.stack([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)], axis=-1)


def _coverage_faults(places: Floats, numbers: AnyArray, truth: Truth) -> list[str]:
    known = np.zeros(len(truth.places), dtype=bool)
    known[numbers[numbers >= 0]] = True
    lost = ~known if truth.core is None else ~known & np.ravel(truth.core)
    wrong = np.flatnonzero(numbers < 0)
    faults = []
    if lost.any():
        one = truth.places[np.flatnonzero(lost)[0]]
        faults.append(f"{lost.sum()} of {len(lost)} nodes are lost, such as {one}")
    if len(wrong):
        one = places[wrong[0]]
        faults.append(f"{len(wrong)} of {len(places)} nodes lie where no data are, such as {one}")
    return faults


def _time_faults(found: FlowField, truth: Truth) -> list[str]:
    if len(found.times) != len(truth.times):
        return [f"{len(found.times)} time steps; expected {len(truth.times)}"]
    if found.steady and (found.start is None or truth.undated):
        return []
    times = np.asarray(found.times, dtype=float)
    if not truth.undated:
        times = times * ratio(found.time_unit, "hour" if truth.on_earth else "second")
    if found.start is not None:
        calendar = getattr(found.start, "calendar", None)
        more = {} if calendar is None else {"calendar": calendar}
        epoch = type(found.start)(EPOCH.year, EPOCH.month, EPOCH.day, **more)
        times = times + (found.start - epoch).total_seconds() / 3600
    if not np.allclose(times, truth.times, atol=1e-6):
        return [f"the times are {times}; expected {truth.times}"]
    return []


def _value_faults(
    found: FlowField, truth: Truth, places: Floats, numbers: AnyArray, step: int, time: float
) -> list[str]:
    """Compare the velocity, the speed and scalars at one time."""
    scale = float(np.broadcast_to(truth.scale, len(truth.times))[step])
    u, v = (scale * part for part in truth.flow(*places.T, time))
    velocity = np.asarray(found.velocity[step])[found.valid]
    unit = f"{found.length_unit}/{found.time_unit or 'second'}" if found.length_unit else ""
    velocity = velocity * ratio(unit, truth.speed_unit)
    if truth.on_earth:
        assert found.projection is not None
        a, b = found.projection.components(places[:, 0], places[:, 1], velocity)
    else:
        a, b = (velocity[:, axis] for axis in truth.axes)
    faults = []
    most = max(float(np.hypot(u, v).max()), 1e-12) * truth.tolerance
    there = np.ones(len(u), dtype=bool)
    if truth.absent is not None:
        there = ~truth.absent[step][numbers]
        missing = np.asarray(found.scalars["no data"][step])[found.valid] == 1
        if not np.array_equal(missing, ~there):
            faults.append(f"{missing.sum()} nodes lack data; expected {(~there).sum()}")
    speed, unit = _speed(found, step)
    if truth.speed_unit and not unit:
        faults.append(f"the speed has no unit; expected {truth.speed_unit}")
    speed = speed * ratio(unit, truth.speed_unit)
    compared = [("first component", a, u), ("second component", b, v)]
    compared.append(("speed", speed, np.hypot(u, v)))
    for name, function in truth.scalars.items():
        value = np.asarray(found.scalars[name][min(step, len(found.scalars[name]) - 1)])
        compared.append((name, value[found.valid], function(*places.T, time)))
    for name, one, other in compared:
        error = np.where(there, np.abs(one - other), 0.0)
        if not error.max() <= most:
            worst = int(np.argmax(np.where(np.isfinite(error), error, np.inf)))
            faults.append(
                f"step {step}: the {name} is {one[worst]:.5g} at {places[worst]}, expected "
                f"{other[worst]:.5g}; wrong at {(~(error <= most)).sum()} of {len(error)} nodes"
            )
    return faults


def _speed(found: FlowField, step: int) -> tuple[Floats, str]:
    """Return the speed that legends show, and its unit."""
    steps = found.speed
    if "speed" in found.scalars:
        steps = found.scalars["speed"]
    return np.asarray(steps[step])[found.valid], found.unit_of("speed")


def earth(
    lon: Any, lat: Any, hours: Any = None, dims: tuple[str, str] = ("lat", "lon")
) -> xr.Dataset:
    """Return a plain dataset of the flow on the Earth, of which all forms are changes."""
    a, b = np.meshgrid(lon, lat)
    times = np.atleast_1d(0.0 if hours is None else hours)
    u, v = np.stack([np.stack(wind(a, b, h)) for h in times], axis=1)
    names = dims if hours is None else ("time", *dims)
    coords: dict[str, Any] = {
        dims[0]: (dims[0], np.asarray(lat, dtype=float), DEGREES["lat"]),
        dims[1]: (dims[1], np.asarray(lon, dtype=float), DEGREES["lon"]),
    }
    if hours is None:
        u, v = u[0], v[0]
    else:
        coords["time"] = dates(times)
    return xr.Dataset({"u": (names, u, EAST), "v": (names, v, NORTH)}, coords)


def current(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset whose u and v are a current, for which land is no place."""
    attrs = {"u": EAST_AT_SEA, "v": NORTH_AT_SEA}
    return ds.assign({n: ds[n].assign_attrs(attrs[n]) for n in ("u", "v") if n in ds})


def dates(hours: Any) -> AnyArray:
    """Return dates, (T,), of hours since the epoch."""
    seconds = np.round(np.asarray(hours, dtype=float) * 3600).astype("timedelta64[s]")
    return np.asarray((np.datetime64(EPOCH, "ns") + seconds).astype("datetime64[ns]"))


def lab(x: Any, y: Any, t: Any = None, dims: tuple[str, str] = ("y", "x"), **attrs: Any) -> Any:
    """Return a dataset of the flow in the plane; ``attrs`` are those of u and v."""
    a, b = np.meshgrid(x, y)
    times = np.atleast_1d(0.0 if t is None else t)
    u, v = np.stack([np.stack(plane(a, b, h)) for h in times], axis=1)
    names = dims if t is None else ("t", *dims)
    coords: dict[str, Any] = {dims[0]: np.asarray(y), dims[1]: np.asarray(x)}
    if t is None:
        u, v = u[0], v[0]
    else:
        coords["t"] = times
    return xr.Dataset({"u": (names, u, attrs), "v": (names, v, attrs)}, coords)
