"""Stores that others wrote are drawn and built from, in a folder and on the web."""

from __future__ import annotations

import pickle
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from range_server import range_server

import flowtex
from flowtex import FlowField
from flowtex.cli import main
from flowtex.errors import FieldError, Notice
from flowtex.pyramid import is_store, open_store
from flowtex.pyramid.places import MOST_REPEATS
from flowtex.pyramid.source import has_parts
from flowtex.sources.datasets.values import Regions
from flowtex.textures.tiles.grid_levels import level_lines
from flowtex.textures.tiles.shared import shared_pyramid

zarr = pytest.importorskip("zarr")
xr = pytest.importorskip("xarray")

ROWS, COLUMNS = 64, 96
#: As ndpyramid tells its levels, and as the convention of zarr-conventions does.
TOLD: dict[str, Any] = {
    "ndpyramid": [{"datasets": [{"path": str(n)} for n in range(3)]}],
    "convention": {"layout": [{"asset": str(n)} for n in range(3)]},
}


@pytest.fixture(autouse=True, scope="module")
def _small(small_tiles: None) -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 500)
        for module in ("others", "source"):
            patch.setattr(f"flowtex.pyramid.{module}.WHOLE_NODES", 2000)
        yield


def dataset(*, earth: bool = False) -> Any:
    """Return a flow that is linear in x and y, so that means of cells are its values there."""
    x, y = (np.arange(n) / 20 + 0.1 for n in (COLUMNS, ROWS))
    names = ("lat", "lon") if earth else ("y", "x")
    units = ("degrees_north", "degrees_east") if earth else ("m", "m")
    u = 1 + 0.2 * x + 0 * y[:, None]
    v = 0.3 * y[:, None] - 0.1 * x
    return xr.Dataset(
        {
            k: (names, one.astype(np.float32), {"units": "m/s"})
            for k, one in zip("uv", (u, v), strict=True)
        },
        {n: (n, line, {"units": unit}) for n, line, unit in zip(names, (y, x), units, strict=True)},
    )


def write(place: Path, told: Any, *, reverse: bool) -> None:
    """Write three levels; those of ndpyramid begin with the coarsest one."""
    finest, factors = dataset(), [1, 2, 4]
    for n, factor in enumerate(reversed(factors) if reverse else factors):
        one = finest.coarsen(dict.fromkeys(finest.dims, factor)).mean()
        chunks = {name: {"chunks": (16, 16)} for name in finest.data_vars}
        one.to_zarr(place, group=str(n), encoding=chunks, consolidated=False, zarr_format=3)
    zarr.open_group(place, mode="r+").attrs["multiscales"] = told
    with pytest.warns(UserWarning, match="Consolidated metadata"):
        zarr.consolidate_metadata(place)


@pytest.fixture(scope="module")
def stores(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    places = {name: tmp_path_factory.mktemp(name) / "flow.zarr" for name in TOLD}
    for name, place in places.items():
        write(place, TOLD[name], reverse=name == "ndpyramid")
    return places


@pytest.mark.parametrize("name", TOLD)
def test_the_finest_level_of_moderate_size_is_opened(stores: dict[str, Path], name: str) -> None:
    store = stores[name]
    assert has_parts(store) and not is_store(store)
    field = open_store(store)
    # Every second line of the finest level, and the last one.
    assert field.shape == (ROWS // 2 + 1, COLUMNS // 2 + 1)
    assert field.short_size == f"{COLUMNS} × {ROWS} nodes"
    whole = FlowField.from_xarray(dataset())
    lines = [level_lines(count, 1) for count in (ROWS, COLUMNS)]
    np.testing.assert_allclose(field.points, whole.points[np.ix_(*lines)])
    check_linear(field)


def check_linear(field: FlowField) -> None:
    """Check the velocity of a field, also at its edges, which lie outside of means of cells."""
    x, y, _ = np.moveaxis(field.points, -1, 0)
    velocity = np.asarray(field.velocity[0])
    np.testing.assert_allclose(velocity[..., 0], 1 + 0.2 * x, atol=1e-6)
    np.testing.assert_allclose(velocity[..., 1], 0.3 * y - 0.1 * x, atol=1e-6)


@pytest.mark.parametrize("name", TOLD)
def test_each_level_is_read_from_the_coarsest_that_suffices(
    stores: dict[str, Path], name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    read: list[tuple[int, int]] = []
    components = Regions.components

    def counted(self: Regions, step: int, rows: Any, columns: Any) -> Any:
        found = components(self, step, rows, columns)
        read.append(found[0].shape)
        return found

    field = open_store(stores[name])
    pyramid = shared_pyramid(field, "arclength", "streamlines")
    assert pyramid.nodes == (ROWS, COLUMNS) and pyramid.depth == 2
    monkeypatch.setattr(Regions, "components", counted)
    for level in range(2):  # coarser ones are means of these
        check_linear(pyramid.at_level(level))
    # The finest level alone is read; those above it are in memory.
    assert set(read) == {(ROWS, COLUMNS)}


def test_pictures_and_the_shell(
    opengl: Any, stores: dict[str, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    store = stores["ndpyramid"]
    view: dict[str, Any] = {"size": (200, 120), "samples": 9, "zoom": 6}
    with range_server(store.parent) as server:
        url = server.address + store.name
        pictures = [flowtex.render(one, **view) for one in (store, url)]
        assert main(["render", url, "-o", str(tmp_path / "a.png"), "--size", "100x80"]) == 0
        assert main(["info", url]) == 0
    assert np.array_equal(pictures[0], pictures[1]) and pictures[0].std() > 10
    said = capsys.readouterr().out
    assert f"{COLUMNS} × {ROWS} nodes" in said and url in said
    with pytest.raises(FieldError) as told:
        flowtex.export(store, tmp_path / "b.html", store="./flow.zarr")
    assert "`flowtex pyramid FILE -o flow.zarr` and export that" in str(told.value)


@pytest.mark.usefixtures("quick_export")
@pytest.mark.parametrize("name", TOLD)
def test_a_store_is_built_from_what_lies_on_the_web(
    stores: dict[str, Path], tmp_path: Path, name: str
) -> None:
    place = tmp_path / "flow.zarr"
    with range_server(stores[name].parent) as server:
        url = server.address + stores[name].name
        assert main(["pyramid", url, "-o", str(place)]) == 0
        assert main(["export", str(place), "-o", str(tmp_path / "a.html"), "--store", url]) == 0
    own = FlowField.from_xarray(dataset())
    stored, known = (
        shared_pyramid(one, "arclength", "streamlines") for one in (open_store(place), own)
    )
    for level in range(3):
        some, others = stored.at_level(level), known.at_level(level)
        assert np.allclose(some.velocity[0], others.velocity[0], atol=1e-3)


@pytest.mark.parametrize("zarr_format", [2, 3])
def test_store_on_a_server_without_a_list(tmp_path: Path, zarr_format: Any) -> None:
    """Neither the server nor consolidated metadata name the arrays."""
    small = dataset().isel(x=slice(20), y=slice(10))
    options: dict[str, Any] = {"consolidated": False, "zarr_format": zarr_format}
    small.to_zarr(tmp_path / "a.zarr", **options)
    small.rename(u="east", v="north").to_zarr(tmp_path / "b.zarr", **options)
    known = FlowField.from_xarray(small)
    with range_server(tmp_path) as server:
        fields = [
            open_store(f"{server.address}a.zarr"),
            open_store(f"{server.address}b.zarr", u="east", v="north"),
        ]
        for field in fields:
            np.testing.assert_allclose(field.points, known.points)
            np.testing.assert_allclose(field.velocity[0], known.velocity[0])
        # Each store is asked once for a list, which fails and is repeated.
        methods = [method for method, _, _ in server.asked]
        assert methods.count("PROPFIND") == 2 * (1 + MOST_REPEATS)
        with pytest.raises(FieldError, match=r"its server lists no files.*Name the components"):
            open_store(f"{server.address}b.zarr")


def test_levels_on_a_server_without_a_list(tmp_path: Path) -> None:
    place = tmp_path / "flow.zarr"
    for n, factor in enumerate((1, 2, 4)):
        one = dataset().coarsen(x=factor, y=factor).mean()
        one.to_zarr(place, group=str(n), consolidated=False, zarr_format=3)
    zarr.open_group(place, mode="r+").attrs["multiscales"] = TOLD["ndpyramid"]
    with range_server(tmp_path) as server:
        field = open_store(f"{server.address}flow.zarr")
        check_linear(field)
        check_linear(shared_pyramid(field, "arclength", "streamlines").at_level(0))


@pytest.mark.parametrize("projection", ["globe", "platecarree", "mercator"])
def test_one_large_level_has_levels_of_every_second_line(tmp_path: Path, projection: str) -> None:
    dataset(earth=True).to_zarr(tmp_path / "a.zarr", consolidated=False, zarr_format=3)
    with pytest.warns(Notice, match=r"no level of at most 2,000 nodes.*-o flow.zarr"):
        field = open_store(tmp_path / "a.zarr", projection=projection)
    whole = FlowField.from_xarray(dataset(earth=True), projection=projection)
    pyramid = shared_pyramid(field, "arclength", "streamlines")
    for level in range(2):
        part = pyramid.at_level(level)
        lines = np.ix_(*[level_lines(count, level) for count in whole.shape])
        np.testing.assert_allclose(part.points, whole.points[lines])
        np.testing.assert_allclose(part.velocity[0], whole.velocity[0][lines], atol=1e-6)


def test_what_is_no_velocity_is_told(tmp_path: Path) -> None:
    with pytest.raises(FieldError, match=r"contains no (readable )?pyramid .*consolidate_metadata"):
        open_store(tmp_path / "nothing.zarr")
    data = dataset().rename(u="salt", v="heat")
    data.to_zarr(tmp_path / "a.zarr", consolidated=False, zarr_format=3)
    with pytest.raises(FieldError, match="no velocity; expected two variables such as u and v"):
        open_store(tmp_path / "a.zarr")


def series() -> Any:
    """Return a turning flow on the Earth with land, and nodes without data at one time."""
    calm = dataset(earth=True)
    lon, lat = np.meshgrid(calm.lon, calm.lat)
    steps = np.arange(3.0)[:, None, None]
    u = np.cos(lon + steps) + 0.3 * lat
    v = np.sin(lat - steps) + 0 * lon
    land = (lon - 2) ** 2 + (lat - 1.5) ** 2 < 0.3
    u[:, land] = v[:, land] = np.nan
    u[1, 50:, :20] = v[1, 50:, :20] = np.nan
    names = ("time", "lat", "lon")
    data = {"uo": (names, u, {"units": "m/s"}), "vo": (names, v, {"units": "m/s"})}
    data["salt"] = (names, 35 + u, {"units": "1"})
    times = np.array(["2020-01-01", "2020-01-02", "2020-01-03"], dtype="datetime64[ns]")
    return xr.Dataset(data, {"time": times, "lat": calm.lat, "lon": calm.lon})


@pytest.mark.parametrize("projection", ["globe", "platecarree"])
def test_values_of_a_series_are_those_of_the_dataset(tmp_path: Path, projection: str) -> None:
    finest = series()
    for n, factor in enumerate((1, 2, 4)):
        one = finest.coarsen(lat=factor, lon=factor).mean()
        one.to_zarr(tmp_path / "a.zarr", group=str(n), consolidated=False, zarr_format=3)
    zarr.open_group(tmp_path / "a.zarr", mode="r+").attrs["multiscales"] = TOLD["convention"]
    field = open_store(tmp_path / "a.zarr", projection=projection)
    with pytest.warns(Notice, match="lack data at some times"):
        known = FlowField.from_xarray(finest, projection=projection)
    rng = np.random.default_rng(3)
    for lon, lat, time in rng.uniform((0.1, 0.1, 0), (4.8, 3.2, 2 * 86_400), (60, 3)):
        expected = known.at(lon, lat, time=time)
        found = field.at(lon, lat, time=time)
        if expected is None or found is None:  # on land
            assert expected is found
            continue
        for name in ("eastward", "northward", "speed"):
            values = getattr(found, name), getattr(expected, name)
            np.testing.assert_allclose(*values, rtol=1e-5, atol=1e-6)
        np.testing.assert_allclose(found.scalars["salt"], expected.scalars["salt"], rtol=1e-5)
    copy = pickle.loads(pickle.dumps(field))
    np.testing.assert_array_equal(copy.velocity[1], field.velocity[1])
    assert copy.at(4.0, 1.0) is not None and copy.at(2.0, 1.5) is None
    assert flowtex.render(field, size=(120, 90), samples=5, time=86_400.0, zoom=4).std() > 5
