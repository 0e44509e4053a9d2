"""Files and planes that a page opens."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("trame_rca")

import xarray as xr
from earth_data import winds
from lying_files import write_crashing
from small_pages import Streamer, playing, small_page, zoom_of
from waiting import until

from flowtex import examples
from flowtex.app import FlowApp, Library
from flowtex.app.controllers.context import without_folder

pytestmark = pytest.mark.usefixtures("opengl")


def test_a_complaint_does_not_tell_where_a_file_lies() -> None:
    said = "/srv/private/runs/torn.vts: the file is damaged. VTK says: no"
    assert without_folder(said, "runs/torn.vts") == "torn.vts: the file is damaged. VTK says: no"
    assert (
        without_folder("block is 'x'; there are a, b", "torn.vts") == "block is 'x'; there are a, b"
    )
    several = "/srv/private/runs/winds_0.nc: cannot be read: no"
    assert without_folder(several, "winds") == "winds_0.nc: cannot be read: no"


def mean_speed(app: FlowApp) -> float:
    return float(np.linalg.norm(app.field.velocity[-1], axis=-1).mean())


async def test_a_file_is_read_again_when_the_page_asks_for_it(tmp_path: Path) -> None:
    path = tmp_path / "latest.vts"
    examples.double_gyre(0.0).save(path)
    app = small_page(Library.of(path), 5, 120, 80)
    async with playing(app):
        data, source = app.data, app.data._current.source
        assert app.state.get("is_file")
        data.reload()
        await until(lambda: data._opening is not None and data._opening.done())
        shown = app.field
        assert data._current.source is source, "what has not changed is not opened again"
        before, limits = mean_speed(app), app.area.scene.scalar_limits
        mesh = examples.double_gyre(2.5)
        mesh["velocity"] *= 3.0
        mesh.save(path)
        app.viewport.home(zoom=3.0)
        data.reload()
        await until(lambda: app.field is not shown)
        assert mean_speed(app) > 2 * before and zoom_of(app) == pytest.approx(3.0)
        assert app.area.scalars is None or app.area.scene.scalar_limits != limits


async def test_a_file_that_crashes_its_reader_is_a_problem_of_one_page(tmp_path: Path) -> None:
    examples.double_gyre(0.0).save(tmp_path / "flow.vts")
    write_crashing(tmp_path / "torn.case")
    library = Library.of(tmp_path)
    app = small_page(library, 5, 120, 80)
    async with playing(app):
        shown = app.field
        app.state.send(file="torn.case")
        await until(lambda: app.state.get("problem") != "")
        assert app.state.get("problem").startswith("torn.case: the reader of this file crashed")
        assert app.field is shown and app.state.get("file") == "flow.vts"
        assert library.source("flow.vts").alive


async def test_remedy_of_an_error_is_typed_as_a_flag(tmp_path: Path) -> None:
    pytest.importorskip("xarray")
    examples.double_gyre(0.0).save(tmp_path / "flow.vts")
    ds = winds(np.arange(-180.0, 180.0, 20.0), np.arange(-80.0, 81.0, 20.0))
    for name in ds:
        ds[name].attrs = {"units": "m/s"}
    ds.rename(u="vel_1", v="vel_2").to_netcdf(tmp_path / "winds.nc")
    app = small_page(Library.of(tmp_path), 5, 120, 80)
    async with playing(app):
        app.state.send(file="winds.nc")
        await until(lambda: app.state.get("problem") != "")
        problem = app.state.get("problem")
    assert "--vectors vel_1,vel_2 (flags of flowtex show in a shell)" in problem
    assert "vectors=" not in problem


def daily(count: int) -> Any:
    """Winds of so many days."""
    ds = winds(np.arange(-180.0, 180.0, 20.0), np.arange(-80.0, 81.0, 20.0))
    steps = xr.concat([ds] * count, "time", coords="minimal", join="exact")
    steps["time"] = ("time", np.arange(float(count)), {"units": "days since 2001-01-01"})
    return steps


async def test_a_later_step_that_cannot_be_read_is_told_and_the_page_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("xarray")
    monkeypatch.setattr("flowtex.sources.remote.READER", "child_handler:TrickyReader")
    daily(12).to_netcdf(tmp_path / "winds.nc")
    app = FlowApp(tmp_path / "winds.nc", lines="streamlines")
    app.stream.update_size("test", {"w": 120, "h": 80, "p": 1})
    async with playing(app):
        streamer = Streamer(app.stream)
        task = asyncio.create_task(app.stream.run())
        app.stream.changed()
        await until(lambda: streamer.sent)
        app.area.take_time(2 * 86_400.0)  # at which the reader crashes
        await until(lambda: app.state.get("problem") != "")
        assert app.state.get("problem").startswith("winds.nc: the reader of this file crashed")
        assert app.viewport.handle.time == 0.0, "time stands"
        app.state.send(problem="")
        streamer.sent = 0
        app.stream.changed()
        await until(lambda: streamer.sent)
        assert not task.done() and app.state.get("problem") == ""
        task.cancel()
