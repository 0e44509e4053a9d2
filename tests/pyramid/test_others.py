"""Stores that others wrote are drawn and built from, in a folder and on the web."""

from __future__ import annotations

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
from flowtex.pyramid.source import has_parts
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
        for module in ("stored", "source"):
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
    with pytest.warns(Notice, match=r"drawn with 1,536 of its 6,144 nodes; .* -o flow.zarr"):
        field = open_store(store)
    assert field.shape == (ROWS // 2, COLUMNS // 2)
    x, y, _ = np.moveaxis(field.points, -1, 0)
    assert np.allclose(np.asarray(field.velocity[0])[..., 0], 1 + 0.2 * x, atol=1e-6)
    assert np.allclose(np.asarray(field.velocity[0])[..., 1], 0.3 * y - 0.1 * x, atol=1e-6)


@pytest.mark.filterwarnings("ignore:.* is drawn with")
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
    assert f"{COLUMNS // 2} × {ROWS // 2} nodes" in said and url in said
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
        with pytest.raises(FieldError, match=r"its server lists no files.*Name the components"):
            open_store(f"{server.address}b.zarr")


def test_levels_on_a_server_without_a_list(tmp_path: Path) -> None:
    place = tmp_path / "flow.zarr"
    for n, factor in enumerate((1, 2, 4)):
        one = dataset().coarsen(x=factor, y=factor).mean()
        one.to_zarr(place, group=str(n), consolidated=False, zarr_format=3)
    zarr.open_group(place, mode="r+").attrs["multiscales"] = TOLD["ndpyramid"]
    with range_server(tmp_path) as server, pytest.warns(Notice, match="drawn with 1,536 of its"):
        field = open_store(f"{server.address}flow.zarr")
    assert field.shape == (ROWS // 2, COLUMNS // 2)


def test_of_one_large_level_every_nth_node_is_drawn(tmp_path: Path) -> None:
    dataset(earth=True).to_zarr(tmp_path / "a.zarr", consolidated=False, zarr_format=3)
    with pytest.warns(Notice, match="drawn with 1,536 of its 6,144 nodes"):
        field = open_store(tmp_path / "a.zarr", globe=True)
    assert field.projection is not None and field.projection.is_globe
    whole = FlowField.from_xarray(dataset(earth=True), globe=True)
    assert np.allclose(field.points, whole.points[::2, ::2])
    assert np.allclose(field.velocity[0], whole.velocity[0][::2, ::2], atol=1e-6)


def test_what_is_no_velocity_is_told(tmp_path: Path) -> None:
    with pytest.raises(FieldError, match=r"contains no (readable )?pyramid .*consolidate_metadata"):
        open_store(tmp_path / "nothing.zarr")
    data = dataset().rename(u="salt", v="heat")
    data.to_zarr(tmp_path / "a.zarr", consolidated=False, zarr_format=3)
    with pytest.raises(FieldError, match="no velocity; expected two variables such as u and v"):
        open_store(tmp_path / "a.zarr")
