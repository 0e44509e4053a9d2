from __future__ import annotations

import asyncio
from collections.abc import Iterator
from html import unescape
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("trame_rca")

from flowtex import FlowField, examples
from flowtex.app import FlowApp
from flowtex.app.streaming.painter import COARSEST_DRAFT, Cost
from flowtex.app.streaming.reprojection import Snapshot, coverage, reproject
from flowtex.settings import GROUPS, TABLE

pytestmark = pytest.mark.usefixtures("opengl")


def small(*, curved: bool = False, steps: int = 1) -> FlowField:
    """A patch of 24 x 16 nodes, flat or bent, in which everything moves along x."""
    x, y = np.meshgrid(np.linspace(0, 3, 24), np.linspace(0, 2, 16))
    z = 0.4 * np.sin(x) if curved else np.zeros_like(x)
    points = np.stack([x, y, z], axis=-1)
    velocity = np.zeros((steps, *points.shape))
    velocity[..., 0] = 1 + 0.1 * np.arange(steps)[:, None, None] + 0.2 * y
    times = np.arange(steps, dtype=float) if steps > 1 else None
    return FlowField.from_arrays(
        points, velocity if steps > 1 else velocity[0], times=times, scalars={"height": x}
    )


@pytest.fixture(scope="module")
def flat() -> Iterator[FlowApp]:
    app = FlowApp(small(), samples=9)
    app.stream.update_size("test", {"w": 240, "h": 160, "p": 1})
    yield app
    app.close()


@pytest.fixture(scope="module")
def bent() -> Iterator[FlowApp]:
    app = FlowApp(small(curved=True), samples=9)
    app.stream.update_size("test", {"w": 240, "h": 160, "p": 1})
    yield app
    app.close()


@pytest.fixture
def series() -> Iterator[FlowApp]:
    app = FlowApp(small(steps=4), samples=5)
    app.stream.update_size("test", {"w": 120, "h": 80, "p": 1})
    yield app
    app.close()


def picture(app: FlowApp) -> Any:
    width, height = app.viewport.size
    return app.viewport.draw(width, height).astype(int)


def difference(one: Any, other: Any) -> float:
    return float(np.abs(np.asarray(one, int) - np.asarray(other, int)).mean())


def test_the_state_has_every_setting_under_a_prefix_of_its_own(
    flat: FlowApp, bent: FlowApp
) -> None:
    grouped = [name for names in GROUPS.values() for name in names]
    assert sorted(grouped) == sorted(TABLE) and len(GROUPS[""]) + 1 == 5
    for name, value in flat.viewport.handle.settings:
        assert flat.state.get(f"set_{name}") == value
    assert flat.state.key("lod") != bent.state.key("lod")
    assert flat.state.get("colours") == ["speed", "height", "none"]


def test_the_page_has_a_control_with_a_hint_for_each_setting(flat: FlowApp) -> None:
    html = unescape(flat.layout.html)
    for row in TABLE.values():
        assert f'data-setting="{row.name}"' in html
        assert row.text in html


def test_a_change_of_the_state_reaches_the_settings(flat: FlowApp) -> None:
    flat.state.set(set_contrast=2, set_lod=False)
    flat.controllers.appearance.take_settings()
    assert (
        flat.viewport.handle.settings.contrast == 2 and flat.viewport.handle.settings.lod is False
    )
    flat.state.set(set_contrast=1.0, set_lod=True)
    flat.controllers.appearance.take_settings()


def test_a_wrong_value_is_told_and_taken_back(flat: FlowApp) -> None:
    flat.state.set(set_samples=1000)
    flat.controllers.appearance.take_settings()
    assert "samples is 1000; expected" in flat.state.get("problem")
    assert flat.state.get("set_samples") == flat.viewport.handle.settings.samples == 9
    flat.state.set(problem="")


def test_colours_and_their_bar_change(flat: FlowApp) -> None:
    speed = picture(flat)
    flat.state.set(colour="height")
    flat.controllers.appearance.take_colour()
    assert flat.state.get("bar")["name"] == "height" and flat.state.get("bar")["high"] == "3"
    assert difference(picture(flat), speed) > 3
    flat.state.set(colour="none")
    flat.controllers.appearance.take_colour()
    grey = picture(flat)
    assert np.ptp(grey[80, 120]) == 0 and flat.state.get("bar")["name"] == ""
    flat.state.set(colour="speed")
    flat.controllers.appearance.take_colour()
    assert difference(picture(flat), speed) == 0


def test_themes_change_the_background(flat: FlowApp) -> None:
    dark = picture(flat)[0, 0]
    flat.state.set(theme="light")
    flat.controllers.appearance.take_background()
    assert picture(flat)[0, 0].min() > 200 > dark.max()
    flat.state.set(theme="dark")
    flat.controllers.appearance.take_background()


@pytest.mark.parametrize("kind", ["flat", "bent"])
def test_tiles_are_the_same_picture(kind: str, request: pytest.FixtureRequest) -> None:
    app: FlowApp = request.getfixturevalue(kind)
    whole = picture(app)
    tile = app.viewport.draw(80, 60, (100, 40, 80, 60)).astype(int)
    # Curved surfaces show a row of pixels of another level where 2 x 2 blocks fall otherwise.
    assert difference(tile, whole[40:100, 100:180]) < 1.0
    assert difference(tile, whole[42:102, 100:180]) > 3.0


def test_a_full_picture_is_the_whole_one(flat: FlowApp) -> None:
    painter = flat.stream.painter.painters[0]
    painter.forget()
    painter.cost.learn(5.0, 240 * 160, 9)
    quick = painter.quick(0.01)
    assert not painter.complete and quick.shape[1] <= 240 * COARSEST_DRAFT + 1
    *_, full = painter.full()
    assert painter.complete and difference(full, picture(flat)) < 0.5
    painter.cost = Cost()


@pytest.mark.parametrize("by", [(30, 20), (-30, 20), (30, -20), (-41, -20), (0, 12), (-12, 0)])
def test_after_a_drag_only_what_came_into_view_is_drawn(
    flat: FlowApp, by: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    painter = flat.stream.painter.painters[0]
    flat.area.reset_camera()
    painter.forget()
    painter.cost.learn(5.0, 240 * 160, 9)
    painter.quick(0.01)
    for _ in painter.full():
        pass
    flat.viewport.pan(-2 * by[0] / 240, 2 * by[1] / 160)
    drawn = []
    draw = type(painter.pane).draw

    def counted(pane: Any, width: int, height: int, part: Any = None) -> Any:
        drawn.append(width * height)
        return draw(pane, width, height, part)

    monkeypatch.setattr(type(painter.pane), "draw", counted)
    painter.quick(0.01)
    drawn.clear()
    *_, full = painter.full()
    exposed = 240 * 160 - (240 - abs(by[0])) * (160 - abs(by[1]))
    assert painter.complete and sum(drawn) == exposed
    assert difference(full, picture(flat)) < 0.5
    painter.cost = Cost()
    flat.area.reset_camera()


def test_the_point_under_the_pointer_stays_at_every_zoom(flat: FlowApp) -> None:
    viewport = flat.viewport
    flat.area.reset_camera()

    def under(x: float, y: float) -> Any:
        camera = viewport.camera
        right, up, _ = camera.axes
        return camera.focal_point + (right * x * viewport.aspect + up * y) * camera.height

    place = under(0.5, -0.3)
    for _ in range(70):
        viewport.zoom_by(1.25, 0.5, -0.3)
        assert np.abs(under(0.5, -0.3) - place).max() < 1e-9 * 3
    assert viewport.zoom == pytest.approx(1e6)
    for _ in range(90):
        viewport.zoom_by(1 / 1.25, 0.5, -0.3)
    assert viewport.zoom == pytest.approx(0.25)
    flat.area.reset_camera()
    assert viewport.zoom == pytest.approx(1.0)


def test_a_drag_carries_a_flat_surface_along(flat: FlowApp) -> None:
    flat.area.reset_camera()
    before = picture(flat)
    event = {"w": 240, "h": 160, "x": 100, "y": 80}
    send = flat.stream.on_interaction
    send("test", {"type": "LeftButtonPress", **event})
    send("test", {"type": "MouseMove", **event, "x": 124, "y": 96})
    send("test", {"type": "LeftButtonRelease", **event})
    moved = picture(flat)
    assert difference(moved[24:100, 64:180], before[40:116, 40:156]) < 1.5
    assert flat.viewport.camera.axes[2] == pytest.approx([0, 0, -1])
    flat.area.reset_camera()


def test_a_drag_turns_a_curved_surface(bent: FlowApp) -> None:
    bent.area.reset_camera()
    before = bent.viewport.camera.axes[2]
    send = bent.stream.on_interaction
    event = {"w": 240, "h": 160, "x": 100, "y": 80}
    send("test", {"type": "LeftButtonPress", **event})
    send("test", {"type": "MouseMove", **event, "x": 140})
    send("test", {"type": "LeftButtonRelease", **event})
    assert bent.viewport.camera.axes[2] @ before < 0.99
    focus = bent.viewport.camera.focal_point
    send("test", {"type": "LeftButtonPress", **event, "shiftKey": 1})
    send("test", {"type": "MouseMove", **event, "x": 140})
    send("test", {"type": "LeftButtonRelease", **event})
    assert focus != bent.viewport.camera.focal_point
    bent.area.reset_camera()


def test_a_zoom_into_a_curved_surface_stops_before_it(bent: FlowApp) -> None:
    bent.area.reset_camera()
    for _ in range(40):
        bent.viewport.zoom_by(1.25, 0.1, 0.1)
    assert bent.viewport.surface_point(0.1, 0.1) is not None
    assert bent.viewport.zoom > 1000
    bent.area.reset_camera()


def test_pinching_zooms_between_the_fingers(flat: FlowApp) -> None:
    flat.area.reset_camera()
    send = flat.stream.on_interaction
    fingers = {"0": {"x": 60, "y": 80}, "1": {"x": 180, "y": 80}}
    send("test", {"type": "StartPinch", "w": 240, "h": 160, "factor": 1})
    send("test", {"type": "Pinch", "w": 240, "h": 160, "factor": 2, "positions": fingers})
    assert flat.viewport.zoom == pytest.approx(2)
    flat.area.reset_camera()


def test_a_moved_picture_is_the_one_that_would_be_drawn(flat: FlowApp) -> None:
    flat.area.reset_camera()
    scene = flat.viewport
    view = scene.plane_view()
    assert view is not None
    shot = Snapshot(scene.draw(240, 160), view)
    scene.pan(0.2, -0.1)
    moved = scene.plane_view()
    assert moved is not None
    share, stretch = coverage(shot, moved)
    assert 0.5 < share < 1 and stretch == pytest.approx(1)
    shifted = reproject(shot, moved, (240, 160), Snapshot(shot.pixels * 0, moved))
    drawn = scene.draw(240, 160)
    assert difference(shifted[20:140, 40:190], drawn[20:140, 40:190]) < 1.5
    scene.zoom_by(2.0)
    closer = scene.plane_view()
    assert closer is not None and coverage(shot, closer)[1] == pytest.approx(2)
    flat.area.reset_camera()


def test_time_and_colours_follow_the_slider(series: FlowApp) -> None:
    series.state.set(time=0.0)
    series.controllers.playback.take_time()
    early = picture(series)
    series.state.set(time=2.5)
    series.controllers.playback.take_time()
    assert series.viewport.handle.time == 2.5 and series.state.get("moment") == "t = 2.50"
    assert difference(picture(series), early) > 2
    series.state.set(time=99.0)
    series.controllers.playback.take_time()
    assert series.viewport.handle.time == 3.0


def test_playing_goes_round(series: FlowApp) -> None:
    series.state.set(time=2.9)
    series.controllers.playback.take_time()
    series.area.player.advance(0.5)
    assert 0 <= series.viewport.handle.time < 0.5


def test_playing_a_steady_flow_moves_its_clock(flat: FlowApp) -> None:
    flat.state.set(playing=True)
    flat.controllers.playback.take_playing()
    flat.controllers.appearance.take_settings()
    still = picture(flat)
    flat.area.player.advance(0.5)
    assert flat.viewport.handle.clock == 0.5 and flat.viewport.handle.settings.motion == "speed"
    assert difference(picture(flat), still) > 2
    flat.state.set(playing=False, set_motion="off")
    flat.controllers.playback.take_playing()
    flat.controllers.appearance.take_settings()


def test_the_cost_of_a_picture_is_learnt() -> None:
    cost = Cost()
    for _ in range(20):
        cost.learn(0.006 + 1e-8 * 10**6 * (41 + 8), 10**6, 41)
    assert cost.seconds(10**6, 41) == pytest.approx(0.496, rel=0.02)
    assert cost.choose(10**6, 41, 1.0).scale == 1.0
    draft = cost.choose(10**6, 41, 0.05)
    assert draft.samples == 9 and 0.3 < draft.scale < 0.6
    assert cost.seconds(10**6 * draft.scale**2, 9) == pytest.approx(0.05, rel=0.05)


class Streamer:
    """Stands for trame-rca's, and keeps what is sent."""

    def __init__(self) -> None:
        self.sent: list[dict[str, Any]] = []
        self.coreServer = SimpleNamespace(network_monitor=SimpleNamespace(pending=0))

    def push_content(self, name: str, meta: dict[str, Any], content: bytes) -> None:
        assert content[:2] == b"\xff\xd8"
        self.sent.append({"name": name, **meta})


def test_pictures_come_until_rest_and_then_no_more(flat: FlowApp) -> None:
    stream, streamer = flat.stream, Streamer()
    flat.area.reset_camera()

    async def watch() -> None:
        stream.set_streamer(streamer)
        sharp = flat.state.get("sharp")
        task = asyncio.create_task(stream.run())
        for _ in range(200):
            # Many requests at once are one picture.
            stream.moved()
            stream.moved()
            await asyncio.sleep(0.02)
            if len(streamer.sent) >= 3:
                break
        for _ in range(500):
            if flat.state.get("sharp") > sharp:
                break
            await asyncio.sleep(0.02)
        assert flat.state.get("sharp") == sharp + 1 and flat.state.get("picture") == "sharp"
        assert streamer.sent[-1]["quality"] > streamer.sent[0]["quality"]
        assert (streamer.sent[-1]["w"], streamer.sent[-1]["h"]) == (240, 160)
        count = len(streamer.sent)
        await asyncio.sleep(0.4)
        assert len(streamer.sent) == count
        stream.watched = lambda: False
        stream.changed()
        await asyncio.sleep(0.3)
        assert len(streamer.sent) == count
        task.cancel()

    asyncio.run(watch())


def test_examples_make_an_app() -> None:
    app = FlowApp(examples.cylinder_field(), zoom=3.0, focus=(4.0, 0.0), scalars=False)
    app.stream.update_size("test", {"w": 64, "h": 48})
    assert app.viewport.zoom == pytest.approx(3.0)
    assert (
        app.state.get("colour") == "none"
        and app.state.get("about") == "161 × 65 nodes · 31 times · periodic along i"
    )
    app.close()


def test_a_complaint_does_not_tell_where_a_file_lies() -> None:
    from flowtex.app.controllers.data import _without_folder

    said = "/srv/private/runs/torn.vts: the file is broken. VTK says: no"
    assert _without_folder(said, "runs/torn.vts") == "torn.vts: the file is broken. VTK says: no"
    assert (
        _without_folder("block is 'x'; there are a, b", "torn.vts")
        == "block is 'x'; there are a, b"
    )
