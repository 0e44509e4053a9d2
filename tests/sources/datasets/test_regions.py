"""A region of a dataset is what the whole has there, bit for bit, and nothing else is read."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.field.field_arrays import GridArrays
from flowtex.field.options import FieldOptions
from flowtex.field.validation import NO_DATA
from flowtex.sources.datasets.read_datasets import read_datasets
from flowtex.sources.datasets.values import Regions

xr = pytest.importorskip("xarray")


def dataset(lon: Floats, lat: Floats, *, steps: int = 1, plane: bool = False) -> Any:
    """Waves with gaps, fill values that nothing tells, and other variables."""
    a, b = np.radians(lon)[None], np.radians(lat)[:, None]
    turns = np.arange(steps)[:, None, None]
    u = (np.cos(3 * b) * np.sin(2 * a + turns)).astype("f4")
    v = (np.sin(4 * a) * np.cos(2 * b - turns)).astype("f4")
    land = np.sin(3 * a) * np.cos(4 * b)
    u[:, land > 0.7], v[:, land > 0.72] = np.nan, 1e20
    u[1:, 5:7, 5:9] = np.nan
    x, y = ("x", "y") if plane else ("lon", "lat")
    words = ("sea_water_x_velocity", "sea_water_y_velocity")
    if not plane:
        words = ("eastward_sea_water_velocity", "northward_sea_water_velocity")
    units = ("m", "m") if plane else ("degrees_east", "degrees_north")
    dims = ("time", y, x)
    return xr.Dataset(
        {
            "u": (dims, u, {"standard_name": words[0], "units": "cm/s"}),
            "v": (dims, v, {"standard_name": words[1], "units": "cm/s"}),
            "ssh": (dims, u + v, {"units": "m", "long_name": "height of the sea"}),
            "depth": (dims[1:], a * b),
        },
        {
            x: (x, lon, {"units": units[0]}),
            y: (y, lat, {"units": units[1]}),
            "time": np.datetime64("2000-01-01", "ns") + turns.ravel() * np.timedelta64(3600, "s"),
        },
    )


LONGITUDES = {
    "from zero": np.arange(0, 360, 1.5),
    "from -180": np.arange(-180, 180, 1.5) + 0.75,
    "repeated": np.arange(0, 361, 1.5),
    "region": np.arange(10, 80, 0.7),
    "date line": np.arange(150, 230, 0.7),
    "westward": np.arange(80, 10, -0.7),
}
LATITUDES = {"north": np.linspace(-78, 80, 61), "south": np.linspace(90, -90, 61)}


def both(data: Any, **options: Any) -> tuple[FlowField, Regions]:
    """Return a field, and its regions as they come to a worker."""
    field = FlowField.from_xarray(data, **options)
    name = options.pop("name", "")
    regions = read_datasets(data, FieldOptions.of_dataset(options), name=name, regions=True)
    assert isinstance(regions, Regions)
    return field, pickle.loads(pickle.dumps(regions))


def assert_same(field: FlowField, regions: Regions) -> None:
    rows, columns = field.shape
    assert regions.lines.shape == field.shape
    assert (False, regions.lines.periodic == "i") == field.periodic
    assert regions.lines.projection == field.projection
    derived = set() if "speed" in regions.names else {"speed"}
    assert regions.names == tuple(n for n in field.scalars if n not in {NO_DATA, *derived})
    for name in ("name", "length_unit", "start", "long_names"):
        assert regions.words[name] == getattr(field, name)
    units = {name: unit for name, unit in field.units.items() if name not in derived}
    assert regions.words["units"] == units
    np.testing.assert_array_equal(regions.words["times"], field.times)
    some: list[tuple[Any, Any]] = [
        (slice(0, 20), slice(0, 30)),
        (slice(17, rows), slice(30, columns)),
        (np.arange(0, rows, 7), np.arange(0, columns, 5)),
    ]
    for j, i in some:
        at = (j, i) if isinstance(j, slice) else np.ix_(j, i)
        for step in range(len(field.times)):
            nodes = regions.nodes(step, j, i, field.valid[at] if step else None)
            np.testing.assert_array_equal(nodes.points, field.points[at])
            np.testing.assert_array_equal(nodes.valid, field.valid[at])
            np.testing.assert_array_equal(nodes.velocity, np.asarray(field.velocity[step])[at])
            for name, values in nodes.scalars.items():
                np.testing.assert_array_equal(values, np.asarray(field.scalars[name][step])[at])


@pytest.mark.parametrize(
    ("lon", "lat", "projection"),
    [
        *zip(LONGITUDES, [*LATITUDES] * 3, [None, "mercator", "globe"] * 2, strict=True),
        *zip(LONGITUDES, [*LATITUDES] * 3, ["globe", None, "mercator"] * 2, strict=True),
    ],
)
def test_a_region_of_a_map_is_that_of_the_field(lon: str, lat: str, projection: str | None) -> None:
    data = dataset(LONGITUDES[lon], LATITUDES[lat], steps=2)
    data = data.isel(time=[1]) if projection == "mercator" else data.chunk()
    assert_same(*both(data, projection=projection))


def test_a_region_of_a_plane_is_that_of_the_field() -> None:
    data = dataset(np.geomspace(1, 300, 80), LATITUDES["south"], steps=3, plane=True)
    assert_same(*both(data))
    assert_same(*both(data, sel={"time": "2000-01-01T01"}, name="waves"))


def test_what_is_masked_is_masked_in_a_region() -> None:
    data = dataset(LONGITUDES["region"], LATITUDES["north"])
    data["tmask"] = (("lat", "lon"), np.indices((61, 100)).sum(axis=0) % 7 > 1)
    field, regions = both(data, u="u", v="v")
    assert_same(field, regions)
    assert field.valid.mean() < 0.75


def test_levels_are_chosen_as_in_a_field() -> None:
    data = dataset(LONGITUDES["region"], LATITUDES["north"])
    deep = xr.concat([data, data * 0.5], xr.Variable("depth_m", [0.0, 10.0], {"axis": "Z"}))
    for options in ({"level": 10.0}, {"isel": {"depth_m": 1}}):
        with_level = both(deep.drop_vars("depth"), u="u", v="v", **options)
        assert_same(*with_level)


@pytest.mark.parametrize("projection", ["north", "robinson", "lambert"])
def test_maps_that_end_where_all_nodes_tell_are_read_whole(projection: str) -> None:
    data = dataset(LONGITUDES["region"], LATITUDES["north"])
    assert isinstance(
        read_datasets(data, FieldOptions(projection=projection), regions=True), GridArrays
    )


def test_grids_that_are_no_lines_are_read_whole() -> None:
    data = dataset(LONGITUDES["region"], LATITUDES["north"])
    lon, lat = np.meshgrid(data.lon, data.lat)
    curved = data.drop_vars(["lon", "lat"]).rename(lon="i", lat="j")
    curved = curved.assign_coords(
        lon=(("j", "i"), lon, {"units": "degrees_east"}),
        lat=(("j", "i"), lat, {"units": "degrees_north"}),
    )
    assert isinstance(read_datasets(curved, FieldOptions(), regions=True), GridArrays)
    flat = dataset(np.arange(0.0, 360, 1.5), LATITUDES["north"], plane=True)
    assert isinstance(
        read_datasets(flat, FieldOptions(), regions=True), GridArrays
    )  # it may close, as longitude does


def test_the_largest_models_are_recognised_by_their_lines() -> None:
    dask = pytest.importorskip("dask.array")
    zeros = dask.zeros((50_000, 200_000), chunks=10_000, dtype="f4")
    names = {"u": "eastward_sea_water_velocity", "v": "northward_sea_water_velocity"}
    data = xr.Dataset(
        {
            key: (("lat", "lon"), zeros, {"standard_name": name, "units": "m/s"})
            for key, name in names.items()
        },
        {
            "lon": ("lon", np.arange(200_000) * 360 / 200_000, {"units": "degrees_east"}),
            "lat": ("lat", np.linspace(-80, 80, 50_000), {"units": "degrees_north"}),
        },
    )
    regions = read_datasets(data, FieldOptions(), regions=True)
    assert isinstance(regions, Regions)
    assert regions.lines.shape == (50_000, 200_001) and regions.lines.periodic == "i"
    nodes = regions.nodes(0, slice(49_000, 49_100), slice(199_990, 200_001))
    assert nodes.velocity.shape == (100, 11, 3) and not nodes.velocity.any()
