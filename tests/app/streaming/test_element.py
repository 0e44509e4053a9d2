"""What a page is handed, and what is done there."""

from __future__ import annotations

import asyncio
from typing import Any

import numpy as np
import pytest
import pyvista as pv

pytest.importorskip("trame_rca")

from aiohttp import web
from camera_moves import pan
from small_pages import small, small_page
from trame.app import get_server

import flowtex
from flowtex.app import FlowApp, FlowArea
from flowtex.rendering.webgl.protocol import file_infos
from flowtex.textures.tiles.grid_pyramid import GridPyramid

pytestmark = pytest.mark.usefixtures("opengl")


def parts_of(answer: web.StreamResponse) -> dict[str, list[int]]:
    """Names and shapes of the arrays in a file."""
    assert isinstance(answer, web.Response)
    body = answer.body
    assert isinstance(body, bytes)
    return {info["name"]: info["shape"] for info in file_infos(body)[0]}


def large(**scalars: Any) -> FlowApp:
    y, x = np.mgrid[-1:1:200j, -1:1:300j]
    points, velocity = np.stack([x, y], -1), np.stack([-y, x], -1)
    scalars = {name: x for name in scalars}
    return small_page(flowtex.FlowField.from_arrays(points, velocity, scalars=scalars), 3, 96, 64)


class Told:
    """What an application calls of the page."""

    def __init__(self, app: FlowApp, monkeypatch: pytest.MonkeyPatch) -> None:
        self.calls: list[tuple[str, Any]] = []
        self._ref = app.area.ref
        monkeypatch.setattr(app.server, "js_call", self)

    def __call__(self, ref: str, method: str, value: Any) -> None:
        assert ref == self._ref
        self.calls.append((method, value))

    def taken(self) -> dict[str, Any]:
        """Return what the page was told since."""
        calls, self.calls = self.calls, []
        return {name: value for _, changes in calls for name, value in changes.items()}


def asking(app: FlowApp, scene: dict[str, Any]) -> Any:
    stem = scene["parts"].rsplit("/", 1)[1]

    def ask(name: str) -> dict[str, list[int]]:
        return parts_of(asyncio.run(app.context.routes.answer(stem + name)))

    return ask


def test_a_tile_is_made_when_it_is_asked_for(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 10_000)
    app = large()
    (scene,) = app.area.begin("browser")["scenes"]
    assert app.stream.paused
    assert scene["header"]["pyramid"]["shapes"] == [[200, 300], [101, 151], [51, 76]]
    ask = asking(app, scene)
    found = ask("0,0,1.0")
    assert found["tile/0/0/1/scalars/0"] == [200, 44]
    assert {"header", "padded", "unit", "flow/0"} <= {name.split("/", 4)[4] for name in found}
    assert {"mesh", "places", "padded"} <= ask("whole").keys()
    assert ask("whole.0").keys() == {"flow/0", "scalars/0"}
    assert ask("separatrices.0").keys() == {"separatrices/0"}
    for name in ("", "0,0.0", "0,0,1.7", "0,0,x.0", "whole.7", "part"):
        with pytest.raises(web.HTTPNotFound):
            ask(name)
    with pytest.raises(web.HTTPNotFound):
        ask("0,5,5.0")
    (record,) = [r for r in caplog.records if r.name.startswith("flowtex")]
    assert "tile (0, 5, 5) does not exist" in record.getMessage()
    with monkeypatch.context() as patch:
        patch.setattr(GridPyramid, "region", None)
        with pytest.raises(web.HTTPNotFound):
            ask("0,0,0.0")
    # What was wrong was the network, which is there again when it is requested later.
    assert "tile/0/0/0/scalars/0" in ask("0,0,0.0")
    app.close()
    with pytest.raises(web.HTTPNotFound):
        ask("0,0,1.0")


def test_another_mesh_is_read_as_the_first_one_and_the_view_stays() -> None:
    def gyre(turn: float, **arrays: Any) -> pv.ImageData:
        mesh = pv.ImageData(dimensions=(9, 7, 1))
        mesh["wind"] = np.tile([1.0, turn, 0.0], (63, 1))
        mesh["water"] = np.zeros((63, 3))
        return mesh

    area = FlowArea(gyre(1), server=get_server("another mesh"), vectors="wind", samples=3, zoom=3)
    camera = area.viewport.camera
    area.settings.contrast = 0.5
    area.field = gyre(2)
    shown = area.field
    assert shown.velocity[0, 0, 0].tolist() == [1, 2, 0]
    assert (area.viewport.camera, area.settings.contrast) == (camera, 0.5)
    with pytest.raises(flowtex.FieldError):
        area.field = pv.Plane()
    assert area.field is shown
    area.close()


def whirl(speed: float) -> flowtex.FlowField:
    """A rotation whose greatest speed on a square is given."""
    y, x = np.mgrid[-1:1:9j, -1:1:9j]
    velocity = speed / np.sqrt(2) * np.stack([-y, x], axis=-1)
    return flowtex.FlowField.from_arrays(np.stack([x, y], axis=-1), velocity)


def test_colours_follow_an_assigned_flow_unless_their_range_is_chosen() -> None:
    app = small_page(whirl(1.0), 3, 96, 64)
    app.area.field = whirl(3.0)
    assert app.area.scene.scalar_limits == pytest.approx((0.0, 3.0))
    app.area.compare({"contrast": 0.0})
    app.area.field = whirl(2.0)
    for pane in app.viewport.panes:
        assert pane.scene.scalar_limits == pytest.approx((0.0, 2.0))
    app.area.clim = (0.0, 5.0)
    app.area.field = whirl(4.0)
    for pane in app.viewport.panes:
        assert pane.scene.scalar_limits == (0.0, 5.0)


def test_colours_of_both_panes_can_fit_the_present_data() -> None:
    app = small_page(whirl(1.0), 3, 96, 64)
    app.area.compare({"contrast": 0.0})
    app.area.show(whirl(3.0), keep_range=True)
    for limits in ((0.0, 1.0), (0.0, 3.0)):
        for pane in app.viewport.panes:
            assert pane.scene.scalar_limits == pytest.approx(limits)
        app.area.take_colours({"clim": None})


def test_a_page_is_told_what_changes_here_and_what_others_say(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    app = small_page(small(steps=4), 3, 96, 64)
    told, element = Told(app, monkeypatch), app.area
    app.area.settings.contrast = 2.0
    assert told.calls == []  # there is no page yet
    begun = element.begin("browser")
    assert begun["camera"] is None and begun["settings"]["contrast"] == 2.0
    camera = pan(app.viewport.camera, 0.1, 0.0, 1.5)
    element.take_camera(camera.to_dict(), "a")
    element.take_time(1.5, "a")
    element.take_clock(0.5, "a")
    element.take_playing(True, "a")
    assert app.viewport.camera == camera
    assert {changes["by"] for _, changes in told.calls} == {"a"}  # which the page itself leaves
    told.calls.clear()
    assert (app.viewport.handle.time, app.area.player.playing) == (1.5, True)
    app.area.reset_camera()
    app.area.player.go_to(2.0)
    app.area.player.playing = False
    assert told.taken() == {"camera": None, "time": 2.0, "playing": False, "by": ""}
    element.take_setting(["samples", 7], "b")
    assert told.taken()["settings"]["samples"] == app.area.settings.samples == 7
    app.close()


def test_what_cannot_be_is_told_and_taken_back(monkeypatch: pytest.MonkeyPatch) -> None:
    app = small_page(small(), 9, 96, 64)
    told, element = Told(app, monkeypatch), app.area
    element.begin("browser")
    element.take_setting(["samples", 1000])
    assert "samples is 1000; expected" in app.state.get("problem")
    assert told.taken()["settings"]["samples"] == 9
    element.take_colours({"scalars": "height", "log_scale": True})
    assert "log_scale is True" in app.state.get("problem")
    assert told.taken()["scenes"][0]["header"]["scalars"]["name"] == "speed"
    app.close()


def test_colours_are_those_that_are_chosen(monkeypatch: pytest.MonkeyPatch) -> None:
    app = small_page(small(), 3, 96, 64)
    told, element = Told(app, monkeypatch), app.area
    element.begin("browser")
    element.take_colours({"scalars": "height", "clim": [0, 2], "cmap": "magma", "opacity": 0.5})
    assert (app.area.scalars, app.area.clim, app.area.cmap) == ("height", (0, 2), "magma")
    header = told.taken()["scenes"][0]["header"]
    assert (header["opacity"], header["scalars"]["high"], header["scalars"]["bar"]) == (
        0.5,
        2,
        True,
    )
    element.take_colours({"clim": "robust"})
    assert app.area.clim == "robust"
    element.take_colours({"clim": None})
    assert app.area.clim is None
    element.take_colours({"scalars": False})
    assert not app.area.scalars
    app.close()


def test_two_panes_are_two_scenes(monkeypatch: pytest.MonkeyPatch) -> None:
    app = small_page(small(steps=4), 3, 96, 64)
    told = Told(app, monkeypatch)
    app.area.begin("browser")
    app.area.compare({"lod": False})
    first, second = (scene["header"] for scene in told.taken()["scenes"])
    assert first["differs"] == second["differs"] == ["lod"]
    assert second["own"] == {"lod": False} and second["timeShift"] == 0
    app.area.compare({"time": 1.0})
    changes = told.taken()
    assert changes["timeBeside"] == 1.0 and changes["scenes"][1]["header"]["timeShift"] is None
    app.area.compare(None)
    assert len(told.taken()["scenes"]) == 1
    app.close()


def test_a_camera_of_the_place_before_is_late() -> None:
    """A page sends its first camera when its parts are there; a link may have led on before."""
    app = small_page(small(steps=3), 3, 96, 64)
    (scene,) = app.area.begin("server")["scenes"]
    before = app.viewport.camera.to_dict()
    place = scene["header"]["place"]
    beside = small(steps=3)
    turned = flowtex.FlowField.from_arrays(
        beside.points[..., [2, 0, 1]], beside.velocity[..., [2, 0, 1]], times=[0.0, 1.0, 2.0]
    )
    app.show(turned)
    shown = app.viewport.camera
    app.area.take_camera(before, "page", place)
    app.area.take_time(1.0, "page", place)
    assert app.viewport.camera == shown
    assert app.viewport.handle.time == 0.0
    (scene,) = app.area.begin("server")["scenes"]
    moved = {**shown.to_dict(), "parallel_scale": 0.5 * shown.parallel_scale}
    app.area.take_camera(moved, "page", scene["header"]["place"])
    assert app.viewport.camera.parallel_scale == pytest.approx(0.5 * shown.parallel_scale)
    # Another surface at the same place does not make a camera late.
    place = scene["header"]["place"]
    app.show(turned.same_flow(name="other"), keep_view=True)
    app.area.take_camera(shown.to_dict(), "page", place)
    assert app.viewport.camera == shown
    app.close()


@pytest.mark.parametrize("name", ["seed", "resolution"])
def test_a_noise_texture_is_sent_again_for_a_seed_and_a_resolution(
    monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    """With other noise they are numbers that the page has by itself."""
    app = small_page(small())
    app.area.begin("browser")
    told = Told(app, monkeypatch)
    settings = app.viewport.settings
    settings.update(**{name: 33})
    app.area.changed()
    assert "scenes" not in told.taken()
    settings.update(noise="texture", resolution=64)
    app.area.changed()
    (before,) = told.taken()["scenes"]
    settings.update(**{name: 128})
    app.area.changed()
    (after,) = told.taken()["scenes"]
    assert before["parts"] != after["parts"]
