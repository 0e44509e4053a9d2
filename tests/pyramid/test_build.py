"""A pyramid in a store: the tiles of the field, built again only where something is missing.

Velocities have thirteen bits there, so layers, which are half floats, differ by their last digits.
"""

from __future__ import annotations

import shutil
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from flows import ring
from store_contents import contents

from flowtex import FlowField
from flowtex._util.array_types import AnyArray, Floats
from flowtex.field.steps import LazySteps
from flowtex.pyramid import Built, PyramidError, build, is_store, open_store
from flowtex.pyramid.layout import about_source, empty_field, sealed
from flowtex.pyramid.levels import Levels
from flowtex.pyramid.source import FieldSource
from flowtex.pyramid.stored import StoredPyramid
from flowtex.scene.scene import Scene
from flowtex.textures.tiles.grid_pyramid import GridPyramid
from flowtex.textures.tiles.pyramid import Pyramid, TileKey
from flowtex.textures.tiles.shared import shared_pyramid
from flowtex.trace.store import shared_store

zarr = pytest.importorskip("zarr")


@pytest.fixture(autouse=True)
def _small_roots(monkeypatch: pytest.MonkeyPatch, small_tiles: None) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 1000)


def grid(rows: int, columns: int) -> tuple[Floats, Floats]:
    y, x = np.mgrid[0:rows, 0:columns].astype(float) / 25
    return x, y


def steady(rows: int = 70, columns: int = 75) -> FlowField:
    """A flow around an island."""
    x, y = grid(rows, columns)
    velocity = np.stack([np.cos(3 * y) + 0.3, np.sin(4 * x)], axis=-1)
    land = np.hypot(x - 1.3, y - 1.2) < 0.5
    return FlowField.from_arrays(
        np.stack([x, y], axis=-1),
        velocity,
        valid=~land,
        periodic="",
        scalars={"depth": x * y},
        units={"depth": "m"},
        name="waves",
        length_unit="m",
        time_unit="s",
    )


def series(steps: int = 3) -> FlowField:
    x, y = grid(40, 70)
    times = np.arange(steps) / 10
    velocity = np.stack([np.stack([np.cos(3 * y + t), np.sin(4 * x - t)], axis=-1) for t in times])
    scalars = {"heat": np.stack([x + step for step in range(steps)])}
    return FlowField.from_arrays(
        np.stack([x, y], axis=-1), velocity, times=times, periodic="", scalars=scalars
    )


def late() -> FlowField:
    """A series whose steps are read when they are requested."""
    field = series(2)
    whole = np.asarray(field.velocity)
    lazy = LazySteps(len(whole), lambda step: whole[step])
    return replace(field, velocity=lazy)


def globe() -> FlowField:
    """Around both poles, where some nodes have no position."""
    lon, lat = np.meshgrid(
        np.radians(np.linspace(0, 360, 67)), np.radians(np.linspace(-90, 90, 34))
    )
    points = np.stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)], axis=-1)
    velocity = np.cross([0.3, 0.1, 1.0], points)
    land = np.hypot(lon - 2, lat - 0.5) < 0.4
    points[np.hypot(lon - 2, lat - 0.5) < 0.2] = np.nan
    return FlowField.from_arrays(points, velocity, valid=~land)


FIELDS = {"globe": globe, "steady": steady, "series": series, "late": late, "ring": ring}


def keys_of(pyramid: Pyramid) -> list[TileKey]:
    keys, found = pyramid.children(None), []
    while keys:
        found += keys
        keys = [child for key in keys for child in pyramid.children(key)]
    return found


def stored(store: Path) -> StoredPyramid:
    pyramid = shared_pyramid(open_store(store), "arclength", lines_of(store))
    assert isinstance(pyramid, StoredPyramid)
    return pyramid


def lines_of(store: Path) -> str:
    return str(Levels(store).about["lines"])


def made(store: Path, field: FlowField, **options: Any) -> Built:
    return build(field, store, progress=False, **options)


@dataclass(frozen=True)
class Stores:
    """Stores of the flows above, of which each is built once."""

    folder: Path
    built: dict[str, Built] = field(default_factory=dict)

    def get(self, name: str) -> Path:
        """Return a store to read."""
        place = self.folder / f"{name}.zarr"
        if place.name not in self.built:
            self.built[place.name] = made(place, FIELDS[name]())
        return place

    def copy(self, to: Path, name: str) -> Path:
        """Return a store that may be broken."""
        return Path(shutil.copytree(self.get(name), to))


@pytest.fixture(scope="module")
def stores(tmp_path_factory: pytest.TempPathFactory) -> Stores:
    return Stores(tmp_path_factory.mktemp("stores"))


def shards(store: Path) -> list[str]:
    files = (p for p in store.rglob("*") if p.is_file() and p.name != "zarr.json")
    return sorted(str(p.relative_to(store)) for p in files)


@pytest.mark.parametrize("name", FIELDS)
def test_tiles_are_those_of_the_field_in_memory(stores: Stores, name: str) -> None:
    field = FIELDS[name]()
    there = stored(stores.get(name))
    memory = GridPyramid(field, "arclength", there.lines)
    assert (there.depth, there.blocks) == (memory.depth, memory.blocks)
    nearly: dict[str, Any] = {"rtol": 2e-3, "atol": 2e-3}
    np.testing.assert_allclose(
        np.asarray(there.root.velocity), np.asarray(memory.root.velocity), **nearly
    )
    np.testing.assert_array_equal(there.root.points, memory.root.points)
    np.testing.assert_array_equal(there.root.valid, memory.root.valid)
    every, empty = range(len(field.times)), 0
    slices = shared_store(memory.root, "arclength", there.lines)
    for step in every:
        own = shared_store(there.root, "arclength", there.lines)
        read = there.root_textures(own).layers(step)
        assert_alike(read, memory.root_textures(slices).layers(step))
    for key in keys_of(memory)[::5]:
        one, other = there.tile(key, every), memory.tile(key, every)
        if one is None or other is None:
            assert one is other is None
            empty += 1
            continue
        for step in every:
            layers = one.layers(step)
            assert_alike(layers, other.layers(step))
        for number in ("unit", "pace", "cell", "critical_cell", "count", "longest"):
            assert getattr(one, number) == pytest.approx(getattr(other, number), rel=1e-3)
        np.testing.assert_array_equal(one.geometry.points, other.geometry.points)
        np.testing.assert_array_equal(one.grid.normal, other.grid.normal)
        for scalar in field.scalars:
            first, second = (np.asarray(t.geometry.field.scalars[scalar]) for t in (one, other))
            np.testing.assert_allclose(first, second, rtol=1e-6, atol=1e-6)


def halves(layers: AnyArray) -> AnyArray:
    return layers.astype(np.float16)


def assert_alike(one: AnyArray, other: AnyArray) -> None:
    """Layers agree to the last digit of a half float, save for some at the edge of a decision."""
    away = np.abs(one - halves(other).astype(np.float32)) / np.maximum(np.abs(one), 1)
    assert np.percentile(away, 99.5) <= 2**-10
    assert np.sqrt(np.mean(away**2)) < 1e-2


def test_what_a_field_is_called_comes_with_it(tmp_path: Path, stores: Stores) -> None:
    field, store = steady(), stores.get("steady")
    root = open_store(store)
    for name in ("name", "length_unit", "time_unit", "units", "periodic", "steady"):
        assert getattr(root, name) == getattr(field, name)
    assert is_store(store)
    assert not is_store(tmp_path)


def test_values_of_a_store_have_the_unit_of_the_data(tmp_path: Path) -> None:
    pytest.importorskip("pint")
    x, y = np.meshgrid(np.linspace(-2, 2, 41), np.linspace(-1, 1, 21))
    velocity = np.stack([-y, x], axis=-1)
    points = np.stack([x, y], axis=-1)
    field = FlowField.from_arrays(points, velocity, length_unit="mm", velocity_unit="m/s")
    build(field, tmp_path / "mm.zarr", progress=False)
    root = open_store(tmp_path / "mm.zarr")
    assert root.unit_of("speed") == "m/s"
    fastest = [float(np.max(root.speed)), Scene.of(root).scalar_limits[1]]
    assert fastest == pytest.approx([np.sqrt(5)] * 2, rel=1e-3)
    # Stores of earlier versions do not name it.
    about = {**about_source(FieldSource(field), "arclength", "streamlines")}
    del about["velocity_unit"]
    assert empty_field(about).unit_of("speed") == "mm/s"


def test_a_level_is_a_dataset_of_xarrays(stores: Stores) -> None:
    xr = pytest.importorskip("xarray")
    level = xr.open_zarr(stores.get("steady") / "0", consolidated=False)
    velocity = level["velocity"].isel(time=0)
    assert velocity.dims == ("j", "i", "component")
    there = steady().valid
    np.testing.assert_allclose(
        velocity.values[there], steady().velocity[0][there][:, :2], rtol=2**-11
    )


def test_a_second_run_makes_what_is_missing(tmp_path: Path, stores: Stores) -> None:
    store = stores.copy(tmp_path / "a.zarr", "series")
    first = stores.built["series.zarr"]
    assert first.made and not first.kept
    whole, files = contents(store), shards(store)
    assert made(store, series()) == Built(str(store), first.depth, 0, first.made)
    gone = [name for name in files if "flow" in name or "velocity" in name][::3]
    assert len(gone) > 3
    for name in gone:
        (store / name).unlink()
    again = made(store, series())
    assert again.made >= 1 and again.made + again.kept == first.made
    assert (shards(store), contents(store)) == (files, whole)


def test_shards_of_land_are_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Though of themselves chunks of zeros are not written, and what is not there is missing."""
    monkeypatch.setattr("flowtex.pyramid.layout.SHARD_CHUNKS", (1, 1))
    x, y = grid(40, 140)
    velocity = np.stack([np.cos(3 * y) + 0.3, np.sin(4 * x)], axis=-1)
    land = x > 2
    depth = np.where(land, 0, x)
    flow = FlowField.from_arrays(
        np.stack([x, y], axis=-1), velocity, valid=~land, periodic="", scalars={"depth": depth}
    )
    store = tmp_path / "a.zarr"
    built = made(store, flow)
    assert made(store, flow).kept == built.made
    there, memory = stored(store), GridPyramid(flow, "arclength", lines_of(store))
    np.testing.assert_array_equal(there.root.valid, memory.root.valid)
    tiles = [there.tile(key, [0]) for key in keys_of(memory)]
    assert [tile is None for tile in tiles] == [
        memory.tile(key, [0]) is None for key in keys_of(memory)
    ]
    assert None in tiles


def test_places_that_hold_something_else(tmp_path: Path, stores: Stores) -> None:
    with pytest.raises(PyramidError, match="contains no readable pyramid"):
        open_store(tmp_path / "none.zarr")
    zarr.open_group(tmp_path / "other.zarr", mode="w").create_array("u", shape=(3,), dtype="f4")
    with pytest.raises(PyramidError, match="contains no readable pyramid"):
        open_store(tmp_path / "other.zarr")
    with pytest.raises(PyramidError, match="contains other data"):
        made(tmp_path / "other.zarr", steady())
    stores.copy(tmp_path / "a.zarr", "steady")
    with pytest.raises(PyramidError, match="pyramid of another field"):
        made(tmp_path / "a.zarr", series())
    group = zarr.open_group(tmp_path / "a.zarr", mode="r+")
    group.attrs["flowtex"] = sealed({**Levels(tmp_path / "a.zarr").about, "levels_done": False})
    with pytest.raises(PyramidError, match="incomplete"):
        open_store(tmp_path / "a.zarr")
    group.attrs["flowtex"] = {"format": "flowtex-pyramid-9"}
    with pytest.raises(PyramidError, match="flowtex-pyramid-9"):
        open_store(tmp_path / "a.zarr")
    shutil.rmtree(tmp_path / "a.zarr")
