"""Datasets of which each task reads a region make the same store as the field in memory."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from store_contents import contents

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.field.options import FieldOptions
from flowtex.pyramid import build, layout, open_store
from flowtex.pyramid.layout import sealed
from flowtex.pyramid.levels import Levels
from flowtex.pyramid.places import ChangedError, PyramidError
from flowtex.pyramid.source import RegionSource, source_of
from flowtex.rendering.webgl.protocol import file_infos
from flowtex.scene.fields import read_field
from flowtex.scene.scene import Scene
from flowtex.sources.datasets.values import Regions
from flowtex.textures.texture_set import UNCERTAIN_LAYER
from flowtex.textures.tiles.pyramid import TileKey
from flowtex.textures.tiles.shared import shared_pyramid

zarr = pytest.importorskip("zarr")
xr = pytest.importorskip("xarray")


@pytest.fixture(autouse=True)
def _small(monkeypatch: pytest.MonkeyPatch, small_tiles: None) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 1250)


def dataset(lon: Floats, lat: Floats, *, steps: int = 1, plane: bool = False) -> Any:
    a, b = np.radians(lon)[None], np.radians(lat)[:, None]
    turns = np.arange(steps)[:, None, None] / 10
    u = 0.5 * np.cos(5 * b) * np.sin(6 * a + turns) + 0.4
    v = 0.4 * np.sin(7 * a) * np.cos(4 * b - turns)
    u[:, np.sin(5 * a) * np.cos(6 * b) > 0.8] = np.nan
    x, y = ("x", "y") if plane else ("lon", "lat")
    words = ("x", "y") if plane else ("eastward", "northward")
    degrees = ("m", "m") if plane else ("degrees_east", "degrees_north")
    dims = ("time", y, x)
    names = [f"sea_water_{word}_velocity" for word in words]
    if not plane:
        names = [f"{word}_sea_water_velocity" for word in words]
    return xr.Dataset(
        {
            "u": (dims, u, {"standard_name": names[0], "units": "m/s"}),
            "v": (dims, v, {"standard_name": names[1], "units": "m/s"}),
            "ssh": (dims, u * v, {"units": "m"}),
            "error": (dims, np.abs(u * v)),
        },
        {
            x: (x, lon, {"units": degrees[0]}),
            y: (y, lat, {"units": degrees[1]}),
            "time": np.datetime64("2000-01-01", "ns")
            + np.arange(steps) * np.timedelta64(6 * 3600, "s"),
        },
    )


def around(steps: int = 1) -> Any:
    return dataset(np.arange(0, 360, 3.6), np.linspace(80, -80, 36), steps=steps)


CASES: dict[str, tuple[Any, dict[str, Any]]] = {
    "globe": (around, {"globe": True}),
    "mercator": (
        lambda: dataset(np.linspace(50, 20, 75), np.linspace(-40, 10, 48)),
        {"projection": "mercator", "u": "u", "v": "v"},
    ),
    "plane": (lambda: dataset(np.linspace(0, 9, 75), np.linspace(0, 5, 48), plane=True), {}),
    "uncertain": (around, {"uncertainty": "error"}),
}


def assert_same(one: Path, other: Path) -> None:
    first, second = contents(one), contents(other)
    assert first.keys() == second.keys()
    for name, values in first.items():
        assert values == second[name], name
    about = [{**Levels(store).about} for store in (one, other)]
    for some in about:
        some.pop("seal")
    assert about[0] == about[1]


@pytest.mark.parametrize("name", CASES)
def test_tasks_write_what_the_field_in_memory_has(tmp_path: Path, name: str) -> None:
    make, options = CASES[name]
    data = make()
    assert isinstance(source_of(data, **options), RegionSource)
    # The finest tiles too of one of them.
    more: dict[str, Any] = {"progress": False}
    build(data, tmp_path / "a.zarr", **more, **options)
    build(FlowField.from_xarray(data, **options), tmp_path / "b.zarr", **more)
    assert_same(tmp_path / "a.zarr", tmp_path / "b.zarr")


def test_a_store_has_the_uncertainty_of_its_source(tmp_path: Path) -> None:
    store, data = tmp_path / "a.zarr", around()
    build(data, store, progress=False, uncertainty="error")
    field = FlowField.from_xarray(data, uncertainty="error")
    opened = read_field(store, FieldOptions(uncertainty="error"))
    assert opened.uncertainty == field.uncertainty == "error"
    layers = []
    for one in (field, opened):
        textures = shared_pyramid(one, "arclength").textures(TileKey(0, 0, 0))
        assert textures is not None
        layers.append(textures.layers()[UNCERTAIN_LAYER].astype(float))
    assert np.ptp(layers[0][..., 3]) > 0.1
    np.testing.assert_allclose(layers[0], layers[1], atol=2e-3)
    # Browsers read it with the flow.
    file = zarr.open_group(store)["0/flow"][0, 0, 0, : layout.FILE_CHUNK]
    assert [info["shape"][-1] for info in file_infos(file.tobytes())[0][1:]] == [5]
    for other, words in (("ssh", "ssh"), (np.ones(data.u.shape), "an array")):
        with pytest.raises(FieldError, match=f"uncertainty is {words}, but .* built with error"):
            open_store(store, uncertainty=other)
    with pytest.raises(PyramidError, match="uncertainty differ"):
        build(data, store, progress=False)
    with pytest.raises(FieldError, match=r"uncertainty is 'eror', which is not a scalar; .*error"):
        source_of(data, uncertainty="eror")


def test_a_store_of_an_ensemble_has_its_mean_and_spread(tmp_path: Path) -> None:
    data = around()
    members = xr.concat([data * share for share in (0.8, 1.2)], "number", combine_attrs="override")
    build(members, tmp_path / "a.zarr", progress=False, uncertainty="number")
    opened = open_store(tmp_path / "a.zarr", uncertainty="number")
    assert opened.uncertainty == "spread over number"
    np.testing.assert_allclose(opened.scalars[opened.uncertainty][0][opened.valid], 0.2, atol=1e-3)


def test_several_files_of_a_series_are_read_by_regions(tmp_path: Path) -> None:
    pytest.importorskip("dask")
    data = around(2)
    paths = [tmp_path / f"flow{step}.nc" for step in range(2)]
    for step, path in enumerate(paths):
        data.isel(time=[step]).to_netcdf(path)
    source = source_of(paths)
    assert isinstance(source, RegionSource)
    assert all(part.variable.chunks for part in source.regions.values.components)
    at = (slice(3, 30), slice(5, 60))
    whole = FlowField.from_xarray(data).velocity
    np.testing.assert_array_equal(source.nodes(1, *at).velocity, np.asarray(whole[1])[at])


def test_a_build_from_regions_goes_on(tmp_path: Path) -> None:
    store, data = tmp_path / "a.zarr", around()
    first = build(data, store, progress=False)
    whole = contents(store)
    group = zarr.open_group(store, mode="r+")
    told: Any = group.attrs["flowtex"]
    group.attrs["flowtex"] = sealed({**told, "ranges": {}})
    gone = [*(store / "0" / "velocity").rglob("c/*/*/*/*"), *(store / "samples").rglob("c/0/0/*/*")]
    (next(file for file in gone if file.is_file())).unlink()
    again = build(data, store, progress=False)
    assert (again.made, again.kept) == (1, first.made - 1)
    for name, values in contents(store).items():
        assert values == whole[name]


def small(steps: int = 1) -> Any:
    return dataset(np.linspace(0, 9, 36), np.linspace(0, 5, 36), steps=steps, plane=True)


@pytest.fixture
def reads(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Time steps of the regions that are read."""
    found, nodes = list[int](), Regions.nodes

    def counted(self: Regions, step: int, *given: Any) -> Any:
        found.append(step)
        return nodes(self, step, *given)

    monkeypatch.setattr(Regions, "nodes", counted)
    return found


def corrected(data: Any, step: int = 0) -> Any:
    """The same but for one value, which no sample of 16 by 16 nodes has."""
    other = data.copy(deep=True)
    other.u[step, 17, 23] += 0.25
    return other


def test_another_source_is_refused(tmp_path: Path) -> None:
    store, data = tmp_path / "a.zarr", small(2)
    build(data, store, progress=False)
    assert build(data, store, progress=False).made == 0
    for other in (corrected(data), corrected(data, 1), data.assign_coords(x=data.x * 1.01)):
        with pytest.raises(FieldError, match=r"another field.* fresh=True"):
            build(other, store, progress=False)
    # Nor is it mixed with what is made again.
    (store / "0/velocity/c/1/0/0/0").unlink()
    with pytest.raises(ChangedError, match="earlier version"):
        build(corrected(data, 1), store, progress=False)
    with pytest.raises(FieldError, match="incomplete"):
        open_store(store)


def test_robust_ranges_of_large_data_are_those_of_a_sample(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("flowtex.pyramid.source.MOST_SAMPLES", 1000)
    field = FlowField.from_xarray(around())
    build(around(), tmp_path / "a.zarr", progress=False)
    ranges = Levels(tmp_path / "a.zarr").about["ranges"]
    assert set(ranges) == {"ssh", "error", "speed"}
    for name, (whole, robust) in ranges.items():
        values = np.asarray(field.scalars[name])[:, field.valid]
        values = values[np.isfinite(values)]
        assert np.abs(np.subtract(whole, [values.min(), values.max()])).max() < 0.05 * np.ptp(
            values
        )
        away = np.abs(np.percentile(values, (2, 98)) - robust).max()
        assert 0 < away < 0.02 * np.ptp(values)


def test_a_mesh_makes_the_pyramid_of_its_field(tmp_path: Path) -> None:
    x, y = np.meshgrid(np.linspace(0, 3, 40), np.linspace(0, 2, 30))
    angle = np.sin(2 * x)
    mesh = pv.StructuredGrid(x, y, 0 * x)
    # Its speed is the same everywhere, and stored with half precision.
    both = np.stack([10 * np.cos(angle), 10 * np.sin(angle), 0 * x], axis=-1)
    mesh["wind"] = both.reshape(-1, 3, order="F")
    build(mesh, tmp_path / "a.zarr", progress=False, vectors="wind")
    build(FlowField.from_pyvista(mesh), tmp_path / "b.zarr", progress=False)
    one, other = (open_store(tmp_path / name) for name in ("a.zarr", "b.zarr"))
    np.testing.assert_array_equal(one.velocity, other.velocity)
    assert np.ptp(one.speed) > 0
    assert Scene(one).scalar_limits == pytest.approx((9.5, 10.5), abs=0.01)
    with pytest.raises(FieldError, match="level applies to datasets, but"):
        build(mesh, tmp_path / "c.zarr", progress=False, level=500)


def test_what_cannot_be_built_is_told(tmp_path: Path) -> None:
    data = around()
    with pytest.raises(FieldError, match="no node has data"):
        build(data.where(data.u > 9), tmp_path / "a.zarr", progress=False, u="u", v="v")
    field, times = FlowField.from_xarray(data), np.arange(2.0)
    refused: dict[str, Any] = {"globe": True, "level": 0, "name": "flow", "times": times}
    for name, value in refused.items():
        with pytest.raises(FieldError, match=f"^{name} applies to the data of a field"):
            build(field, tmp_path / "b.zarr", progress=False, **{name: value})
    corners = [[0, 0], [1, 0], [0, 1]]
    with pytest.raises(FieldError, match="on triangles"):
        build(FlowField.from_triangles(corners, [[0, 1, 2]], corners), tmp_path / "b.zarr")
    build(data, tmp_path / "c.zarr", progress=False)
    with pytest.raises(FieldError, match="is already a pyramid"):
        build(tmp_path / "c.zarr", tmp_path / "d.zarr", progress=False)
