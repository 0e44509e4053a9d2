"""Levels, versions, flags, gaps and reversed grids in any combination are right at every node."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
import xarray as xr
from form_table import read
from hypothesis import given
from hypothesis import strategies as st
from known_flow import (
    DEGREES,
    EAST,
    EAST_AT_SEA,
    NORTH,
    NORTH_AT_SEA,
    Truth,
    check,
    dates,
    on_earth,
    wind,
)
from strategies import property_test

from flowtex._util.array_types import Bools, Floats

pytestmark = pytest.mark.hypothesis
pytest.importorskip("pyproj")

HYBRID = "atmosphere_hybrid_sigma_pressure_coordinate"
#: Levels by their kind: the name, the value at the surface, another one, and attributes.
LEVELS: dict[str, tuple[str, float, float, dict[str, str]]] = {
    "": ("", 0.0, 0.0, {}),
    "hPa": ("plev", 1000.0, 500.0, {"units": "hPa"}),
    "mb": ("lev", 1000.0, 50.0, {"units": "mb"}),
    "Pa without a unit": ("plev", 100_000.0, 25_000.0, {}),
    "height without a unit": ("height", 20.0, 250.0, {}),
    "altitude": ("altitude", 10.0, 1000.0, {"units": "m"}),
    "depth": ("depth", 5.0, 100.0, {"units": "m", "positive": "down"}),
    "negative depth": ("z", -0.5, -100.0, {"units": "m", "positive": "up"}),
    "dbar": ("pressure", 5.0, 800.0, {"units": "dbar", "standard_name": "sea_water_pressure"}),
    "hybrid": ("lev", 91.0, 1.0, {"units": "1", "positive": "down", "standard_name": HYBRID}),
    "sigma": ("sigma", 0.995, 0.2, {}),
    "s_rho": ("s_rho", -0.05, -0.95, {}),
}
#: Kinds of levels in the air, and at sea.
IN_AIR = ("hPa", "mb", "Pa without a unit", "altitude", "hybrid", "sigma")
AT_SEA = ("depth", "negative depth", "dbar", "s_rho")
#: Flags by their kind: the value of hidden and of shown nodes, and attributes.
FLAGS: dict[str, tuple[int, int, dict[str, Any]]] = {
    "": (0, 0, {}),
    "values": (2, 1, {"flag_values": np.array([1, 2], "i1"), "flag_meanings": "water land"}),
    "bits": (
        2,
        9,
        {"flag_masks": np.array([1, 2, 4, 8], "i1"), "flag_meanings": "water land lake ice"},
    ),
    "mask and value": (
        4,
        0,
        {
            "flag_masks": np.array([6, 6], "i1"),
            "flag_values": np.array([0, 4], "i1"),
            "flag_meanings": "sea land",
        },
    ),
    "standard name": (1, 0, {"standard_name": "land_binary_mask"}),
    "quality": (
        4,
        0,
        {"flag_masks": np.array([1, 2, 4], "i1"), "flag_meanings": "interpolated suspect bad"},
    ),
    "status": (
        3,
        1,
        {
            "flag_values": np.array([1, 2, 3], "i1"),
            "flag_meanings": "good probably_good bad_data",
            "standard_name": "sea_water_velocity status_flag",
        },
    ),
}
#: Flags that a component must name.
OF_QUALITY = ("quality",)
#: Error of components that are turned by the positions of neighbours.
TURNED = 4e-3


@dataclass(frozen=True)
class Declared:
    """A dataset whose attributes and names must be read."""

    steps: int
    count: tuple[int, int]
    level: str
    falling: bool  #: Whether the level at the surface is the last one.
    versions: int  #: Step from which on another version has the data; 0 for one version.
    flags: str
    late: str  #: What a corner has from the second step on: nothing, ``"gap"`` or ``"fill"``.
    curved: bool  #: Whether components lie along the rows and columns of a curved grid.
    turned_over: str  #: Axis along which a curved grid was reversed.
    order: tuple[str, ...]
    chunked: bool
    at_sea: bool


def mostly(usual: Any, *rare: Any) -> Any:
    return st.one_of(st.just(usual), st.just(usual), st.sampled_from(rare))


DECLARED = st.builds(
    Declared,
    steps=st.integers(1, 4),
    count=st.tuples(st.integers(8, 11), st.integers(9, 12)),
    level=st.sampled_from([*LEVELS]),
    falling=st.booleans(),
    versions=mostly(0, 1, 2),
    flags=st.sampled_from([*FLAGS]),
    late=st.sampled_from(["", "gap", "fill"]),
    curved=st.booleans(),
    turned_over=st.sampled_from(["", "y", "x"]),
    order=st.permutations(["time", "level", "y", "x", "expver"]).map(tuple),
    chunked=mostly(False, True),
    at_sea=st.booleans(),
)


def flow_on_grid(form: Declared, hours: Any) -> tuple[xr.Dataset, Floats, Floats]:
    """Return u and v (time, y, x) on lines or on a curved grid, and longitudes and latitudes."""
    rows, columns = form.count
    j, i = np.mgrid[0:rows, 0:columns].astype(float)
    lon, lat = 5 + 0.4 * i, 41 + 0.3 * j
    if form.curved:
        lon, lat = lon + 0.1 * j, lat - 0.12 * i
    east, north = np.stack([np.stack(wind(lon, lat, hour)) for hour in hours], axis=1)
    if not form.curved:
        lines = {"x": ("x", lon[0], DEGREES["lon"]), "y": ("y", lat[:, 0], DEGREES["lat"])}
        dims = ("time", "y", "x")
        return xr.Dataset({"u": (dims, east), "v": (dims, north)}, lines), lon, lat
    # Unit vectors along rows and columns, which are oblique.
    narrow = np.cos(np.radians(lat))
    along_i = np.stack([0.4 * narrow, np.full_like(lat, -0.12)])
    along_j = np.stack([0.1 * narrow, np.full_like(lat, 0.3)])
    along_i /= np.hypot(*along_i)
    along_j /= np.hypot(*along_j)
    area = along_i[0] * along_j[1] - along_i[1] * along_j[0]
    u = (east * along_j[1] - north * along_j[0]) / area
    v = (north * along_i[0] - east * along_i[1]) / area
    places = {"XLONG": (("y", "x"), lon, DEGREES["lon"]), "XLAT": (("y", "x"), lat, DEGREES["lat"])}
    dims = ("time", "y", "x")
    return xr.Dataset({"u": (dims, u), "v": (dims, v)}, places), lon, lat


def attributes(form: Declared) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the attributes of both components."""
    is_sea = form.at_sea
    if form.level in IN_AIR:
        is_sea = False
    elif form.level in AT_SEA:
        is_sea = True
    if form.curved:
        word = "current" if is_sea else "wind"
        named = [{"units": "m s-1", "long_name": f"{axis} {word} velocity"} for axis in "xy"]
        return named[0], named[1]
    if is_sea:
        return {**EAST_AT_SEA}, {**NORTH_AT_SEA}
    return {**EAST}, {**NORTH}


def made(form: Declared) -> tuple[xr.Dataset, Truth]:
    """Return the dataset of a form, and the truth."""
    hours = 3.0 * np.arange(form.steps)
    ds, lon, lat = flow_on_grid(form, hours)
    ds = ds.assign_coords(time=dates(hours))
    hidden = np.zeros(lon.shape, dtype=bool)
    gone = np.zeros((form.steps, *lon.shape), dtype=bool)
    if form.late and form.steps > 1 and not form.chunked:
        gone[1:, -3:, -4:] = True
        value = {"gap": np.nan, "fill": -999.0}[form.late]
        ds = ds.where(~xr.DataArray(gone, dims=("time", "y", "x")), value)
    if form.flags:
        hidden[:3, :4] = True
        ds = ds.where(~xr.DataArray(hidden, dims=("y", "x")), 0.21)
    ds = with_levels(ds, form)
    for name, attrs in zip("uv", attributes(form), strict=True):
        ds[name].attrs = attrs
        if form.flags in OF_QUALITY:
            ds[name].attrs["ancillary_variables"] = "mask"
    if form.flags:
        bad, good, words = FLAGS[form.flags]
        ds["mask"] = ("y", "x"), np.where(hidden, bad, good).astype("i1"), words
    ds = in_versions(ds, form)
    if form.curved and form.turned_over:
        ds = ds.isel({form.turned_over: slice(None, None, -1)})
    level = LEVELS[form.level][0]
    order = [level if dim == "level" else dim for dim in form.order]
    ds = ds.transpose(*(dim for dim in order if dim in ds.dims))
    if form.chunked:
        ds = ds.chunk(time=1)
    kept: Bools = ~hidden.ravel()
    absent = None
    if gone.any():
        absent = gone.reshape(form.steps, -1)[:, kept]
    truth = on_earth(
        lon.ravel()[kept][None],
        lat.ravel()[kept][None],
        hours,
        absent=absent,
        tolerance=TURNED if form.curved else 2e-4,
    )
    return ds, truth


def with_levels(ds: xr.Dataset, form: Declared) -> xr.Dataset:
    """Return a dataset with another level, whose rows are at wrong places."""
    name, surface, other, attrs = LEVELS[form.level]
    if not name:
        return ds
    wrong = ds.roll(y=1) * 1.5
    values, parts = [surface, other], [ds, wrong]
    if form.falling:
        values, parts = values[::-1], parts[::-1]
    return xr.concat(parts, xr.DataArray(values, dims=name, name=name, attrs=attrs))


def in_versions(ds: xr.Dataset, form: Declared) -> xr.Dataset:
    """Return a dataset of which two versions have the earlier and the later steps."""
    if not 0 < form.versions < form.steps:
        return ds
    late = xr.DataArray(np.arange(form.steps) >= form.versions, dims="time")
    flows = [ds[["u", "v"]].where(~late), ds[["u", "v"]].where(late)]
    whole = xr.concat(flows, xr.DataArray([1, 5], dims="expver", name="expver"))
    for name in "uv":
        whole[name].attrs = ds[name].attrs
    return whole.assign({name: ds[name] for name in ds.data_vars if name not in ("u", "v")})


@property_test(60, fuzz=600)
@given(DECLARED)
def test_what_is_declared_is_read_in_any_combination(form: Declared) -> None:
    data, truth = made(form)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", xr.SerializationWarning)
        check(read(data), truth)
