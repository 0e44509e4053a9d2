"""Values at points of a store are those of its finest level, at any time and on every map."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from earth_data import components, winds
from flows import ring

import flowtex
from flowtex import FieldError, FlowField
from flowtex.errors import Notice
from flowtex.field.quantities import PointValues, values_at
from flowtex.pyramid import build, open_store
from flowtex.pyramid.finest import FinestOfRegions
from flowtex.scene.probe import locate

zarr = pytest.importorskip("zarr")

#: Share of the greatest speed by which thirteen bits change it.
ROUNDING = 2.0**-11


@pytest.fixture(scope="module", autouse=True)
def _small_roots(small_tiles: None) -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 300)
        for module in ("others", "source"):
            patch.setattr(f"flowtex.pyramid.{module}.WHOLE_NODES", 2000)
        yield


@pytest.fixture(scope="module")
def striped(_small_roots: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store of :func:`stripes`, which is built once."""
    place = tmp_path_factory.mktemp("striped") / "flow.zarr"
    build(stripes(), place, progress=False)
    return place


def stripes() -> FlowField:
    """Return a series on a bent grid whose rows alternate, so that coarse levels are nearly 0."""
    y, x = np.mgrid[0:70, 0:75].astype(float)
    points = np.stack([x + 0.1 * np.sin(y / 3), y + 0.1 * np.sin(x / 4), 0 * x], axis=-1)
    flow = np.stack([(-1) ** y * (1 + x / 50), 0.5 * (-1) ** x, 0 * x], axis=-1)
    land = np.hypot(x - 30, y - 40) < 7
    return FlowField.from_arrays(
        points,
        np.stack([flow, -2 * flow, 3 * flow]),
        times=[1.0, 2.0, 4.0],
        valid=~land,
        scalars={"depth": (-1) ** y * x, "tide": np.stack([x, y, x + y])},
        periodic="",
        length_unit="m",
        time_unit="s",
    )


def earth(name: str) -> Callable[[], FlowField]:
    def made() -> FlowField:
        lon, lat = np.arange(-180.0, 180.0, 7.5), np.linspace(-90.0, 90.0, 33)
        data = winds(lon, lat)
        sign = xr.DataArray((-1.0) ** np.arange(33), dims="lat")
        for key in "uv":
            data[key] = (data[key] * sign).assign_attrs(data[key].attrs)
        data["height"] = (data["u"] * 0 + data["lat"] * sign).assign_attrs(
            units="m", standard_name="height"
        )
        return FlowField.from_xarray(data, projection=name)

    return made


def region() -> FlowField:
    """Return a curvilinear region."""
    i, j = np.meshgrid(np.linspace(-20, 20, 60), np.linspace(-15, 15, 50))
    lon, lat = 100 + i + 0.3 * j, 40 + j - 0.2 * i
    u, v = components(lon, lat)
    dims, units = ("y", "x"), {"units": "m s-1"}
    waves = np.cos(np.pi * np.arange(60))
    data = xr.Dataset(
        {
            "u": (dims, u * waves, {"standard_name": "eastward_wind", **units}),
            "v": (dims, v * waves, {"standard_name": "northward_wind", **units}),
        },
        {
            "lon": (dims, lon, {"units": "degrees_east"}),
            "lat": (dims, lat, {"units": "degrees_north"}),
        },
    )
    return FlowField.from_xarray(data)


FIELDS: dict[str, Callable[[], FlowField]] = {
    "stripes": stripes,
    "ring": ring,
    "region": region,
    **{name: earth(name) for name in ("globe", "platecarree", "mercator", "robinson", "south")},
}


def places(field: FlowField, count: int) -> list[tuple[float, ...]]:
    """Return random places in cells with data, as ``at`` takes them."""
    rng = np.random.default_rng(1)
    cells = np.argwhere(field.surface.cells)
    found = []
    for j, i in cells[rng.integers(len(cells), size=count)] + rng.uniform(size=(count, 2)):
        position = field.surface.at(np.array([i, j]))
        if field.projection is not None:
            position = np.array(field.projection.lonlat(position))
        found.append(tuple(position.tolist()))
    return found


def assert_same(got: PointValues | None, wanted: PointValues | None, field: FlowField) -> None:
    if wanted is None:
        assert got is None
        return
    assert got is not None
    speed = 3 * float(np.max(np.asarray(field.speed[0])))
    vectors = [[at.eastward, at.northward] for at in (got, wanted)]
    if field.projection is None:
        vectors = [at.velocity.tolist() for at in (got, wanted)]
    assert vectors[0] == pytest.approx(vectors[1], abs=2 * ROUNDING * speed + 1e-9)
    assert got.speed == pytest.approx(wanted.speed, abs=2 * ROUNDING * speed)
    assert got.scalars == pytest.approx(wanted.scalars, rel=1e-3, abs=0.05)
    assert got.position == pytest.approx(wanted.position, rel=1e-9, abs=1e-6)
    assert (got.time, got.speed_unit) == (wanted.time, wanted.speed_unit)


@pytest.mark.parametrize("name", FIELDS)
def test_points_of_a_store_are_those_of_its_field(name: str, tmp_path: Path) -> None:
    field: Any = FIELDS[name]()
    build(field, tmp_path / "flow.zarr", progress=False)
    store: Any = open_store(tmp_path / "flow.zarr")
    assert store.valid.size < field.valid.size / 3
    times = [field.times[0], field.times[-1], np.mean(field.times)]
    for number, place in enumerate(places(field, 8)):
        time = times[number % 3]
        got = store.at(*place, time=time)
        assert_same(got, field.at(*place, time=time), field)
        if got is not None:  # the index is that in the coarse field
            assert np.all(np.array(got.index) <= np.array(store.shape) - 1)
    assert store.at(*places(field, 1)[0]).time == field.times[0]


def test_an_index_and_a_copy_of_a_store_have_the_finest_values(striped: Path) -> None:
    field = stripes()
    store: Any = open_store(striped)
    place = (50.3, 20.2)
    wanted = field.at(*place, time=3.0)
    index = locate(store, place)
    assert index is not None
    for copy in (store, pickle.loads(pickle.dumps(store)), store.same_flow(name="other")):
        assert_same(values_at(copy, index, 3.0), wanted, field)
        assert values_at(copy, index).index == index
    assert_same(store.at_step(1).at(*place), field.at(*place, time=2.0), field)
    assert store.at(30.0, 40.0) is None
    assert store.at(-50.0, 20.0) is None


def test_only_the_tiles_of_a_place_are_read(striped: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store: Any = open_store(striped)
    counts = []
    original = flowtex.pyramid.levels.Levels.nodes

    def nodes(levels: object, level: int, rows: object, columns: object, **more: object) -> object:
        counts.append((level, len(rows) * len(columns)))  # type: ignore[arg-type]
        return original(levels, level, rows, columns, **more)  # type: ignore[arg-type]

    monkeypatch.setattr(flowtex.pyramid.levels.Levels, "nodes", nodes)
    store.at(50.3, 20.2)
    ((level, size),) = counts
    assert level == 0
    assert size < 300


def test_what_is_derived_needs_all_nodes(striped: Path, tmp_path: Path) -> None:
    field = stripes()
    store: Any = open_store(striped)
    for name, horizon in (("vorticity", None), ("ftle", 1.0)):
        with pytest.raises(FieldError, match=rf"{name} needs all nodes.*with_derived\(\"{name}"):
            store.derive(name, horizon=horizon)
    with pytest.raises(FieldError, match="with_derived"):
        flowtex.render(store, scalars="vorticity", size=(30, 20))
    derived = field.with_derived("vorticity")
    build(derived, tmp_path / "more.zarr", progress=False)
    more: Any = open_store(tmp_path / "more.zarr")
    for place in places(field, 10):
        longitude, latitude = place[:2]
        got = more.at(longitude, latitude, time=1.5)
        wanted = derived.at(longitude, latitude, time=1.5)
        if wanted is not None and np.isfinite(wanted.scalars["vorticity"]):
            assert got is not None
            assert got.scalars["vorticity"] == pytest.approx(wanted.scalars["vorticity"], rel=1e-3)


def test_what_is_derived_of_a_small_store_is_drawn(tmp_path: Path) -> None:
    field = flowtex.examples.double_gyre_field(shape=(11, 21))
    build(field, tmp_path / "flow.zarr", progress=False)
    store: Any = open_store(tmp_path / "flow.zarr")
    assert store.derive("shear") == pytest.approx(np.asarray(field.derive("shear")), abs=0.05)
    one, other = (
        flowtex.render(flow, scalars="divergence", size=(60, 40), samples=5)
        for flow in (field, store)
    )
    assert one.shape == other.shape


@pytest.mark.parametrize("earthly", [True, False])
def test_points_between_the_drawn_lines_of_another_store(tmp_path: Path, *, earthly: bool) -> None:
    x, y = np.arange(96) / 20 + 0.1, np.arange(64) / 20 + 0.1
    names, units = ("lat", "lon"), ("degrees_north", "degrees_east")
    if not earthly:
        names, units = ("y", "x"), ("m", "m")
    flow = (-1.0) ** np.arange(64)[:, None] * (1 + x)
    data = xr.Dataset(
        {key: (names, flow * (1 + (key == "v")), {"units": "m/s"}) for key in "uv"},
        {
            names[0]: (names[0], y, {"units": units[0]}),
            names[1]: (names[1], x, {"units": units[1]}),
        },
    )
    data["heat"] = (names, flow * 10)
    data.to_zarr(tmp_path / "flow.zarr", zarr_format=3, consolidated=False)
    with pytest.warns(Notice):
        store: Any = open_store(tmp_path / "flow.zarr")
    whole = FlowField.from_xarray(data)
    assert store.valid.size < whole.valid.size / 2
    assert isinstance(vars(store)["_finest"], FinestOfRegions)
    for place in ((1.23, 2.34), (3.3, 0.5), (0.11, 3.2), (4.8, 3.24)):
        assert_same(store.at(*place), whole.at(*place), whole)
