"""Levels that others wrote are drawn as those of the whole field, in a folder and on the web."""

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
from flowtex.textures.tiles.pyramid import TileKey
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
        patch.setattr("flowtex.textures.tiles.pyramid.ROOT_NODES", 500)
        for module in ("stored", "source"):
            patch.setattr(f"flowtex.pyramid.{module}.WHOLE_NODES", 1000)
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


def write(
    place: Path, told: Any, *, reverse: bool = False, consolidated: bool = True, **names: str
) -> None:
    """Write three levels; those of ndpyramid begin with the coarsest one, topozarr's lie apart."""
    finest, factors = dataset().rename(names), [1, 2, 4]
    for n, factor in enumerate(reversed(factors) if reverse else factors):
        one = finest.coarsen(dict.fromkeys(finest.dims, factor)).mean()
        chunks = {name: {"chunks": (16, 16)} for name in finest.data_vars}
        one.to_zarr(place, group=str(n), encoding=chunks, consolidated=False, zarr_format=3)
    zarr.open_group(place, mode="r+").attrs["multiscales"] = told
    if consolidated:
        with pytest.warns(UserWarning, match="Consolidated metadata"):
            zarr.consolidate_metadata(place)


@pytest.fixture(scope="module")
def stores(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    places = {name: tmp_path_factory.mktemp(name) / "flow.zarr" for name in TOLD}
    for name, place in places.items():
        write(place, TOLD[name], reverse=name == "ndpyramid")
    return places


@pytest.mark.parametrize("name", TOLD)
def test_levels_lie_where_those_of_the_field_lie(stores: dict[str, Path], name: str) -> None:
    store = stores[name]
    assert has_parts(store) and not is_store(store)
    field, whole = open_store(store), FlowField.from_xarray(dataset())
    stored, own = (shared_pyramid(one, "arclength", "streamlines") for one in (field, whole))
    assert stored.nodes == own.nodes and stored.depth == own.depth == 2
    for level in range(3):
        some, others = stored.at_level(level), own.at_level(level)
        assert np.allclose(some.points, others.points)
        inside = (slice(1, -1), slice(1, -1))  # at borders a mean of cells lies further in
        exact = whole.velocity[0][np.ix_(*own.line_numbers(level))]
        assert np.allclose(np.asarray(some.velocity[0])[inside], exact[inside], atol=1e-6)
    tile = stored.textures(TileKey(0, 0, 1))
    assert tile is not None and tile.geometry.field.valid.all()


def test_missing_values_are_left_out_at_all_levels(tmp_path: Path) -> None:
    write(tmp_path / "a.zarr", TOLD["convention"])
    for level in range(3):
        part = (slice(32 >> level, 48 >> level), slice(0, 32 >> level))
        zarr.open_group(tmp_path / "a.zarr", mode="r+")[f"{level}/u"][part] = np.nan
    stored = shared_pyramid(open_store(tmp_path / "a.zarr"), "arclength", "streamlines")
    for level in range(3):
        rows, columns = stored.line_numbers(level)
        valid = stored.at_level(level).valid
        hole = ((rows >= 32) & (rows < 48))[:, None] & (columns < 32)
        near = ((rows >= 28) & (rows < 52))[:, None] & (columns < 36)
        assert not valid[hole].all() and valid[~near].all()
        assert (valid != ~hole).mean() < 0.12


@pytest.mark.usefixtures("quick_export")
def test_pictures_pages_and_the_shell(
    opengl: Any, stores: dict[str, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    store = stores["ndpyramid"]
    view: dict[str, Any] = {"size": (200, 120), "samples": 9, "zoom": 6}
    with range_server(store.parent) as server:
        url = server.address + store.name
        pictures = [flowtex.render(one, **view) for one in (dataset(), store, url)]
        page = flowtex.export(url, tmp_path / "a.html")
        assert main(["render", url, "-o", str(tmp_path / "a.png"), "--size", "100x80"]) == 0
        assert main(["info", url]) == 0
    assert np.array_equal(pictures[1], pictures[2])
    away = pictures[0].astype(float) - pictures[1]
    assert np.sqrt(np.mean(away**2)) < 3 and pictures[1].std() > 10
    assert 'data-part="{&quot;name&quot;: &quot;tile/0/' in page.path.read_text()
    said = capsys.readouterr().out
    assert f"{COLUMNS} × {ROWS} nodes" in said and url in said
    with pytest.raises(FieldError) as told:
        flowtex.export(store, tmp_path / "b.html", store="./flow.zarr")
    assert f"`flowtex pyramid {store} -o flow.zarr` and export that" in str(told.value)


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


@pytest.mark.parametrize("names", [None, ("speed_x", "speed_y")])
def test_metadata_may_lie_apart_where_nothing_is_listed(
    tmp_path: Path, names: tuple[str, str] | None
) -> None:
    u, v = names or ("u", "v")
    write(tmp_path / "a.zarr", TOLD["convention"], consolidated=False, u=u, v=v)
    with range_server(tmp_path) as server:
        chosen = {} if names is None else {"u": u, "v": v}
        field = open_store(server.address + "a.zarr", **chosen)
        if names is not None:
            with pytest.raises(FieldError, match=r"or their names .*zarr.consolidate_metadata"):
                open_store(server.address + "a.zarr")
    stored = shared_pyramid(field, "arclength", "streamlines")
    assert stored.nodes == (ROWS, COLUMNS) and stored.depth == 2
    own = shared_pyramid(FlowField.from_xarray(dataset()), "arclength", "streamlines")
    assert np.allclose(stored.at_level(1).points, own.at_level(1).points)


def test_a_map_and_one_level_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flowtex.pyramid.stored.SLOW_BYTES", 1000)
    monkeypatch.setattr("flowtex.pyramid.stored.SLOW_NODES", 1000)
    dataset(earth=True).to_zarr(tmp_path / "a.zarr", consolidated=False, zarr_format=3)
    assert has_parts(tmp_path / "a.zarr")
    with pytest.warns(Notice) as told:
        field = open_store(tmp_path / "a.zarr", globe=True)
    words = " ".join(str(one.message) for one in told)
    assert "chunks of 64 × 96 values" in words and "coarsest level has 96 × 64 nodes" in words
    assert field.projection is not None and field.projection.is_globe
    whole = FlowField.from_xarray(dataset(earth=True), globe=True)
    stored = shared_pyramid(field, "arclength", "streamlines")
    at = np.ix_(*stored.line_numbers(2))
    assert np.allclose(field.points, whole.points[at])
    assert np.allclose(field.velocity[0], whole.velocity[0][at], atol=1e-6)


def test_what_is_no_velocity_is_told(tmp_path: Path) -> None:
    with pytest.raises(FieldError, match=r"contains no (readable )?pyramid .*consolidate_metadata"):
        open_store(tmp_path / "nothing.zarr")
    data = dataset().rename(u="salt", v="heat")
    data.to_zarr(tmp_path / "a.zarr", consolidated=False, zarr_format=3)
    with pytest.raises(FieldError, match="no velocity; expected two variables such as u and v"):
        open_store(tmp_path / "a.zarr")
