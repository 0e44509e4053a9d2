"""Any combination of forms is right at every node and time, or an error with a cause."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from form_table import read
from hypothesis import given
from hypothesis import strategies as st
from known_flow import (
    AVERAGED,
    DEGREES,
    EXACT,
    Truth,
    check,
    current,
    dates,
    earth,
    in_plane,
    on_earth,
    plane,
    ratio,
    without,
)
from strategies import property_test

from flowtex._util.array_types import Bools, Floats
from flowtex.errors import FieldError

pytestmark = pytest.mark.hypothesis
pytest.importorskip("pyproj")

DIMS = ("time", "lat", "lon")
#: Steps of the axes in hours and degrees, so small that means of neighbours are accurate.
STEPS = (3.0, 0.75, 1.0)
#: Names of masks, and their value on land.
MASKS = {"lsm": 1, "landmask": 1, "mask": 0, "wet": 0, "tmask": 0}
#: Values on land that mark it.
MARKS = {"NaN": np.nan, "not declared": -999.0, "valid range": 70.0, "_FillValue": -77.0}
#: Error of the components by the way they are stored.
LOSS = {"": 0.0, "single": 1e-6, "packed": 2e-3}
Lines = list[Any]


@dataclass(frozen=True)
class Changes:
    """The differences between a component and the plain one."""

    order: tuple[str, ...]
    reverse: frozenset[str]
    origin: str  #: How longitudes are counted.
    in_order: bool  #: Whether longitudes are sorted once they are counted so.
    shuffled: bool  #: Whether latitudes go to and fro.
    single: bool  #: Whether coordinates have single precision.
    chunked: bool
    falling: bool  #: Whether the level at the surface is the last one.


@dataclass(frozen=True)
class Form:
    """The form of two components; offsets of v are in steps of (time, lat, lon)."""

    first: tuple[float, float]  #: Southernmost latitude and westernmost longitude.
    count: tuple[int, int, int]
    offset: tuple[float, float, float]
    staggered: bool
    land: str
    storage: str
    levels: bool  #: Whether there is another level, whose flow differs.
    changes: tuple[Changes, Changes]
    calendar: str
    names: tuple[str, str]
    cut: int  #: Step from which on the data are in other files; 0 for none.
    turn: int  #: By how much the list of files is turned.
    together: bool  #: Whether both components are in one dataset, where that is possible.


def mostly(usual: Any, *rare: Any, of: int = 3) -> Any:
    """Draw the usual value, and in one case of some another one."""
    return st.integers(1, of).flatmap(
        lambda n: st.sampled_from(rare) if n == of else st.just(usual)
    )


CHANGES = st.builds(
    Changes,
    order=st.permutations(DIMS).map(tuple),
    reverse=st.frozensets(st.sampled_from(DIMS)),
    origin=mostly("", "0 to 360", "-180 to 180", "a turn more"),
    in_order=st.booleans(),
    shuffled=mostly(False, True),
    single=mostly(False, True),
    chunked=mostly(False, True),
    falling=st.booleans(),
)
FORMS = st.builds(
    Form,
    first=st.tuples(
        st.sampled_from([-8.0, 30.0, 61.0]), st.sampled_from([2.0, -6.0, 172.0, 350.0])
    ),
    count=st.tuples(st.integers(1, 4), st.integers(7, 11), st.integers(8, 12)),
    # Whole steps leave labels in common; without any there is no pair.
    offset=st.tuples(
        mostly(0.0, 1.0, -1.0, 0.5, 20.0, of=5),
        mostly(0.0, -2.0, 1.0, 0.25, of=6),
        mostly(0.0, 1.0, 0.3, 40.0, of=6),
    ),
    staggered=mostly(False, True),
    land=st.sampled_from(["", *MARKS, *MASKS]),
    storage=mostly(*LOSS),
    levels=mostly(False, True),
    changes=st.tuples(CHANGES, CHANGES),
    calendar=mostly("", "noleap", "360_day", "numbers", "text"),
    names=st.sampled_from([("u", "v"), ("uo", "vo"), ("U10", "V10"), ("water_u", "water_v")]),
    cut=mostly(0, 1, 2),
    turn=st.integers(0, 3),
    together=st.booleans(),
)


def made(form: Form) -> tuple[list[xr.Dataset], Truth | None]:
    """Return the datasets of a form, and the truth; ``None`` where only an error is right."""
    first = (6.0, *form.first)
    plain: Lines = [a + s * np.arange(n) for a, s, n in zip(first, STEPS, form.count, strict=True)]
    of_v: Lines = [a + k * s for a, k, s in zip(plain, form.offset, STEPS, strict=True)]
    of_u = list(plain)
    if form.staggered:
        of_u[2] = of_u[2] + STEPS[2] / 2
        of_v[1] = of_v[1] + STEPS[1] / 2
    parts = [
        earth(lon, lat, hours)[[name]]
        for name, (hours, lat, lon) in zip("uv", (of_u, of_v), strict=True)
    ]
    truth = expected(of_u, of_v, staggered=form.staggered)
    if form.land and not form.staggered and form.offset[1:] == (0.0, 0.0):
        parts, land = masked(parts, form.land)
        # The columns of the truth are then those of the data.
        blank = np.ravel(land)
        truth = None if truth is None else without(truth, blank)
    if truth is not None:
        truth = replace(truth, tolerance=truth.tolerance + LOSS[form.storage])
    parts = [stored(ds, form.storage) for ds in parts]
    parts = [with_levels(ds) for ds in parts] if form.levels else parts
    parts = [changed(ds, c) for ds, c in zip(parts, form.changes, strict=True)]
    parts = [with_calendar(ds, form.calendar) for ds in parts]
    names = dict(zip("uv", form.names, strict=True))
    parts = [ds.rename({k: n for k, n in names.items() if k in ds}) for ds in parts]
    return in_files(parts, form), truth


def expected(of_u: Lines, of_v: Lines, *, staggered: bool) -> Truth | None:
    """Return the truth at the labels that both components have, or between them."""
    hours, lat, lon = map(common, of_u, of_v)
    if staggered:
        # Means of u lie at longitudes of v, and means of v at latitudes of u.
        lat, lon = common(of_u[1], between(of_v[1])), common(between(of_u[2]), of_v[2])
    if min(len(lat), len(lon)) < 2 or not len(hours):
        return None
    return on_earth(lon, lat, hours, tolerance=AVERAGED if staggered else EXACT)


def between(line: Floats) -> Floats:
    return (line[1:] + line[:-1]) / 2


def common(a: Floats, b: Floats) -> Floats:
    return np.intersect1d(np.round(a, 6), np.round(b, 6))


def masked(parts: list[xr.Dataset], kind: str) -> tuple[list[xr.Dataset], Bools]:
    """Blank a corner in one of the ways that files have."""
    _, rows, columns = parts[0].u.shape
    land = np.zeros((rows, columns), dtype=bool)
    land[: rows // 3, : columns // 3] = True
    over = xr.DataArray(land, {k: parts[0][k] for k in DIMS[1:]}, DIMS[1:])
    found = []
    for ds, name in zip(parts, "uv", strict=True):
        values = np.where(land, MARKS.get(kind, 0.341), ds[name].values)
        ds = ds.copy(data={name: values})
        if kind == "valid range":
            ds[name].attrs.update(valid_min=-50.0, valid_max=50.0)
        elif kind == "_FillValue":
            ds[name].attrs["_FillValue"] = MARKS[kind]
        found.append(ds)
    if kind in MASKS:
        found = [current(ds) for ds in found]
        found[0] = found[0].assign({kind: (over if MASKS[kind] else ~over).astype("i1")})
    return found, land


def stored(ds: xr.Dataset, storage: str) -> xr.Dataset:
    """Store a component in single precision, or as integers if it has no marks of its own."""
    (name,) = set("uv") & set(ds)
    array = ds[name]
    if storage == "single":
        return ds.assign({name: array.astype("f4").assign_attrs(array.attrs)})
    own = {"valid_min", "_FillValue"} & set(array.attrs) or array.isnull().any()
    if storage != "packed" or own:
        return ds
    number = ((array - 5.0) / 0.002).round().astype("i4")
    return ds.assign({name: number.assign_attrs(array.attrs, scale_factor=0.002, add_offset=5.0)})


def with_levels(ds: xr.Dataset) -> xr.Dataset:
    """Return a component at 1000 hPa, with a copy at 500 hPa whose rows are at wrong places."""
    (name,) = {"u", "v"} & set(ds)
    both = xr.concat([ds[name], ds[name].roll(lat=1)], "plev").assign_attrs(ds[name].attrs)
    return ds.assign({name: both}).assign_coords(plev=("plev", [1000.0, 500.0], {"units": "hPa"}))


def changed(ds: xr.Dataset, changes: Changes) -> xr.Dataset:
    """Change the order of dimensions, and the direction, origin and precision of lines."""
    lon, lat = ds.lon.values, ds.lat.values
    lon = {
        "": lon,
        "0 to 360": lon % 360,
        "-180 to 180": (lon + 180) % 360 - 180,
        "a turn more": lon + (360 if lon.max() < 300 else -360),
    }[changes.origin]
    kind = "f4" if changes.single else "f8"
    ds = ds.assign_coords(
        lon=("lon", lon.astype(kind), DEGREES["lon"]), lat=("lat", lat.astype(kind), DEGREES["lat"])
    )
    if changes.origin and changes.in_order:
        ds = ds.sortby("lon")
    ds = ds.isel({dim: slice(None, None, -1) for dim in changes.reverse})
    if changes.shuffled:
        ds = ds.isel(lat=np.random.default_rng(5).permutation(ds.sizes["lat"]))
    if "plev" in ds.dims and changes.falling:
        ds = ds.isel(plev=slice(None, None, -1))
    ds = ds.transpose(*changes.order, ...)
    return ds.chunk(time=1) if changes.chunked else ds


def with_calendar(ds: xr.Dataset, calendar: str) -> xr.Dataset:
    """Give times as dates of a calendar, as numbers with a unit, or as text."""
    if not calendar:
        return ds
    if calendar == "text":
        texts = ds.time.dt.strftime("%Y-%m-%dT%H:%M").values.astype(str)
        return ds.assign_coords(time=("time", texts))
    hours = (ds.time.values - dates([0.0])[0]) / np.timedelta64(1, "h")
    attrs = {"units": "hours since 2024-01-01"}
    ds = ds.assign_coords(time=("time", hours, attrs))
    if calendar == "numbers":
        return ds
    ds.time.attrs["calendar"] = calendar
    coder = xr.coders.CFDatetimeCoder(use_cftime=True)
    return ds.assign_coords(time=xr.decode_cf(ds[["time"]], decode_times=coder).time)


def in_files(parts: list[xr.Dataset], form: Form) -> list[xr.Dataset]:
    """Return one dataset, one for each component, or some for each component and time."""
    one, other = parts
    same = all(one[d].equals(other[d]) and one[d].dtype == other[d].dtype for d in DIMS)
    found = [one.merge(other, join="outer")] if form.together and same else parts
    if 0 < form.cut < form.count[0]:
        halves = slice(form.cut), slice(form.cut, None)
        found = [ds.isel(time=half) for ds in found for half in halves]
    turn = form.turn % len(found)
    return found[turn:] + found[:turn]


@property_test(30, fuzz=400)
@given(FORMS)
def test_a_combination_is_right_or_one_error(form: Form) -> None:
    datasets, truth = made(form)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", xr.SerializationWarning)
        try:
            field = read(datasets[0] if len(datasets) == 1 else datasets)
        except FieldError as error:
            assert truth is None, f"refused: {error}"
            assert any(word in str(error) for word in ("time", "lon", "lat")), str(error)
            return
        assert truth is not None, f"drawn as {field!r}, of components without common labels"
        check(field, truth)


# --- in the plane -------------------------------------------------------------------------------

LENGTHS, SPEEDS = ("m", "mm", "km", "inch"), ("m/s", "cm/s", "knot", "mm/s", "km/h")


@dataclass(frozen=True)
class Sheet:
    """The form of a flow in the plane."""

    count: tuple[int, int, int]  #: Of times, rows and columns; one time is none.
    lengths: tuple[str, str]  #: Units of x and y.
    speeds: tuple[str, str]  #: Units of the components.
    bare: str  #: What has no unit: ``"positions"``, ``"velocity"``, ``"both"``, or nothing.
    time: str  #: Unit of the times.
    bent: bool  #: Whether x and y have two dimensions.
    axis: bool  #: Whether components lie along an axis.
    names: tuple[str, str]
    order: tuple[str, ...]
    reverse: frozenset[str]
    single: bool


SHEETS = st.builds(
    Sheet,
    count=st.tuples(st.integers(1, 4), st.integers(6, 11), st.integers(5, 12)),
    lengths=st.tuples(st.sampled_from(LENGTHS), st.sampled_from(LENGTHS)),
    speeds=st.tuples(st.sampled_from(SPEEDS), st.sampled_from(SPEEDS)),
    bare=mostly("", "positions", "velocity", "both"),
    time=st.sampled_from(["s", "ms", "min", ""]),
    bent=mostly(False, True),
    axis=mostly(False, True),
    names=st.sampled_from([("u", "v"), ("vx", "vy"), ("U", "V"), ("u_x", "u_y")]),
    order=st.permutations(["t", "y", "x", "component"]).map(tuple),
    reverse=st.frozensets(st.sampled_from(["t", "y", "x", "component"])),
    single=mostly(False, True),
)


def laid_out(sheet: Sheet) -> tuple[xr.Dataset | xr.DataArray, Truth]:
    """Return the data of a form in the plane, and the truth in metres and seconds."""
    steps, rows, columns = sheet.count
    x, y = np.meshgrid(np.linspace(0, 3, columns), np.linspace(0.2, 2, rows))
    if sheet.bent:
        x, y = x + 0.2 * y, y - 0.1 * x
    times = 0.3 * np.arange(steps)
    values = np.stack([np.stack(plane(x, y, t)) for t in times], axis=1)
    no_length, no_speed = (sheet.bare in (kind, "both") for kind in ("positions", "velocity"))
    lengths = ("", "") if no_length else sheet.lengths
    if no_speed or sheet.axis:  # one unit for both
        lengths = lengths[:1] * 2
    speeds = ("", "") if no_speed else sheet.speeds[:1] * 2 if sheet.axis else sheet.speeds
    # Other names are those of a velocity only where the unit is one.
    names = ("u", "v") if no_speed else sheet.names
    dims = ("t", "j", "i") if sheet.bent else ("t", "y", "x")
    data: Any = xr.Dataset()
    for name, value, unit in zip(names, values, speeds, strict=True):
        data[name] = (dims, value * ratio("m/s", unit), {"units": unit} if unit else {})
    data = data.astype("f4", keep_attrs=True) if sheet.single else data
    for name, place, unit in zip("xy", (x, y), lengths, strict=True):
        line = (dims[1:], place) if sheet.bent else (name, place[0] if name == "x" else place[:, 0])
        data[name] = (line[0], line[1] * ratio("m", unit), {"units": unit} if unit else {})
    attrs = {"units": sheet.time} if sheet.time else {}
    data = data.set_coords(["x", "y"]).assign_coords(t=("t", times * ratio("s", sheet.time), attrs))
    data = data.isel(t=0, drop=True) if steps == 1 else data
    if sheet.axis:
        attrs = data[names[0]].attrs
        data = data.to_dataarray("component", name="velocity").assign_attrs(attrs)
        data = data.assign_coords(component=["x", "y"])
    mine = dict(zip(("t", "y", "x"), dims, strict=True)) | {"component": "component"}
    present = [mine[d] for d in sheet.order if mine[d] in data.dims]
    reverse = {mine[d]: slice(None, None, -1) for d in sheet.reverse if mine[d] in data.dims}
    data = data.transpose(*present).isel(reverse)
    truth = in_plane(
        x,
        y,
        times,
        unit=lengths[0] and "m",
        speed_unit=speeds[0] and "m/s",
        undated=not sheet.time,
        tolerance=1e-5 if sheet.single else 1e-9,
    )
    return data, truth


@property_test(30, fuzz=400)
@given(SHEETS)
def test_a_form_in_the_plane_is_right(sheet: Sheet) -> None:
    data, truth = laid_out(sheet)
    check(read(data), truth)
