"""Colours, time and camera while a page goes to another part of the same data."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv

pytest.importorskip("trame_rca")

from earth_data import winds
from small_pages import playing, small_page
from waiting import until

import flowtex
from flowtex.app import Choice, FlowApp, Library
from flowtex.scene.scene import Scene
from flowtex.sources.open_source import MeshSource

pytestmark = [
    pytest.mark.usefixtures("opengl"),
    pytest.mark.filterwarnings("ignore::flowtex.errors.Notice"),
]
PENDULUM = "y; -sin(x) - b*y; x=-7,7; y=-4,4; b=0.2,0,2"


def volume(factor: float = 1.0) -> Any:
    """A box whose flow is faster with z, and turns from x to y."""
    mesh: Any = pv.ImageData(dimensions=(9, 8, 7), spacing=(0.2, 0.2, 0.2))
    x, y, z = np.asarray(mesh.points).T
    mesh["v"] = factor * np.stack([(0.3 + z) * (1 + y), x, 0.1 * z], axis=-1)
    return mesh


def series(folder: Path) -> Path:
    """Three steps of two boxes, the second of which is slower."""
    rows = []
    for step in range(3):
        blocks = pv.MultiBlock()
        blocks["fast"], blocks["slow"] = volume(1 + step), volume(0.2 * (1 + step))
        blocks.save(folder / f"step{step}.vtm")
        rows.append(f'<DataSet timestep="{step}" part="0" file="step{step}.vtm"/>')
    head = '<?xml version="1.0"?><VTKFile type="Collection" version="0.1"><Collection>'
    path = folder / "series.pvd"
    path.write_text(head + "".join(rows) + "</Collection></VTKFile>")
    return path


@asynccontextmanager
async def page(flow: Any, **options: Any) -> AsyncIterator[FlowApp]:
    app = small_page(flow, 3, **options)
    async with playing(app):
        yield app


async def opened(app: FlowApp, plane: str = "", block: str | None = None) -> Scene:
    """Go to a plane or a block as the controls of the page do, and return what is shown."""
    choice = app.data.choice
    app.data.open(app.data.name, Choice(choice.vectors, plane, block or choice.block))
    return await read(app)


async def read(app: FlowApp) -> Scene:
    await until(lambda: app.data._opening is not None and app.data._opening.done())
    assert app.state.get("problem") == ""
    return app.area.scene


@pytest.mark.parametrize("suffix", ["vti", "vtu"])
async def test_every_plane_has_the_colours_of_the_volume(tmp_path: Path, suffix: str) -> None:
    mesh = volume() if suffix == "vti" else volume().cast_to_unstructured_grid()
    path = tmp_path / f"box.{suffix}"
    mesh.save(path)
    across = np.linalg.norm(mesh["v"][:, :2], axis=1)
    beside = np.linalg.norm(mesh["v"][:, 1:], axis=1)
    async with page(path) as app:
        for plane in ("z=0.1", "z=1.1", "z=0.6"):
            limits = (await opened(app, plane)).scalar_limits
            assert limits == pytest.approx((across.min(), across.max()))
        # Another axis has other speeds in its planes.
        for plane in ("x=1.5", "x=0.1"):
            limits = (await opened(app, plane)).scalar_limits
            assert limits == pytest.approx((beside.min(), beside.max()))
        app.area.take_colours({"clim": [0.5, 2.0]})
        assert (await opened(app, "x=0.7")).scalar_limits == (0.5, 2.0)
        # A range that fits the data is that of the volume again.
        app.area.take_colours({"clim": None})
        assert app.area.scene.scalar_limits == pytest.approx((beside.min(), beside.max()))


async def test_levels_keep_the_colours_until_they_are_fitted(tmp_path: Path) -> None:
    pytest.importorskip("xarray")
    lon, lat = np.arange(-180.0, 180.0, 30.0), np.arange(-60.0, 61.0, 30.0)
    ds = winds(lon, lat)
    ds = ds.expand_dims(level=[1000.0, 500.0]).copy(deep=True)
    for name in ds.data_vars:
        ds[name].loc[{"level": 500.0}] *= 0.3
    ds.to_netcdf(tmp_path / "levels.nc")
    async with page(tmp_path / "levels.nc") as app:
        first = app.area.scene.scalar_limits
        scene = await opened(app, "level=1")
        assert scene.scalar_limits == first
        app.area.take_colours({"clim": None})
        assert scene.scalar_limits[1] == pytest.approx(0.3 * first[1])


async def test_block_keeps_time_and_chosen_colours(tmp_path: Path) -> None:
    async with page(series(tmp_path)) as app:
        app.area.take_time(1.5)
        fast, slow = app.state.get("blocks")
        assert app.data.choice.block == fast
        scene = await opened(app, block=slow)
        assert app.data.choice.block == slow
        assert scene.time == 1.5
        assert app.area._present()["time"] == 1.5
        # As on a new page with this block.
        expected = Scene.of(app.field).scalar_limits
        assert scene.scalar_limits == expected
        app.area.take_colours({"clim": [0.0, 3.0]})
        scene = await opened(app, block=fast)
        assert (scene.time, scene.scalar_limits) == (1.5, (0.0, 3.0))


async def test_map_keeps_time_and_colours(tmp_path: Path) -> None:
    xr = pytest.importorskip("xarray")
    ds = winds(np.arange(-180.0, 180.0, 30.0), np.arange(-60.0, 61.0, 30.0))
    steps = xr.concat([ds, 2 * ds, 3 * ds], "time", coords="minimal", join="exact")
    steps["time"] = ("time", np.arange(3.0), {"units": "days since 2001-01-01"})
    steps.to_netcdf(tmp_path / "winds.nc")
    async with page(tmp_path / "winds.nc") as app:
        app.area.take_time(86_400.0)
        await until(lambda: app.area.scene.time == 86_400.0)
        limits = app.area.scene.scalar_limits
        for projection in ("robinson", "globe"):
            scene = await opened(app, block=projection)
            assert scene.time == 86_400.0
            assert scene.scalar_limits == pytest.approx(limits)


async def test_colours_follow_the_parameter_of_a_formula() -> None:
    library = Library({PENDULUM: lambda: MeshSource(flowtex.formula("pendulum"))}, typed=True)
    async with page(library) as app:
        app.data.open(PENDULUM + ";", Choice())
        await read(app)
        for b in (2.0, 0.0, 1.0):
            app.area.take_setting(["formula.b", b])
            scene = await read(app)
            assert app.field.formula is not None
            assert app.field.formula.parameters["b"].value == b
            expected = Scene.of(flowtex.formula("pendulum", b=b)).scalar_limits
            assert scene.scalar_limits == pytest.approx(expected)
        app.area.take_colours({"clim": [0.0, 3.0]})
        app.area.take_setting(["formula.b", 2.0])
        assert (await read(app)).scalar_limits == (0.0, 3.0)


async def test_planes_across_each_other_are_seen_straight_on(tmp_path: Path) -> None:
    """Their centre is the same, so a page would keep the camera from which they are edge-on."""
    volume().save(tmp_path / "box.vti")
    async with page(tmp_path / "box.vti") as app:
        app.area.begin("browser")
        for plane in ("z=0.6", "x=0.8", "y=0.7"):
            before = app.area._place
            scene = await opened(app, plane)
            assert app.area._place == before + 1
            assert not app.viewport.camera.sees_edge_on(scene.field.surface)
        app.viewport.home(zoom=3.0)
        camera = app.viewport.camera
        scene = await opened(app, "y=1.3")
        assert app.viewport.camera == camera
        app.area.field = flowtex.FlowField.from_pyvista(volume(), slice="x=0.8")
        assert not app.viewport.camera.sees_edge_on(app.field.surface)
