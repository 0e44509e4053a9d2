"""Pictures of a view: what they show, how well they are drawn, and when they are sent."""

from __future__ import annotations

import asyncio
from functools import partial
from typing import Any, Literal

import numpy as np
import pytest
from waiting import until

pytest.importorskip("trame_rca")

from small_pages import difference, picture

from flowtex import FlowField
from flowtex.app import FlowApp
from flowtex.app.streaming.stream import LINE_GREY, FrameStream
from flowtex.app.streaming.viewport import GAP_PX, Viewport
from flowtex.settings import SettingsError

pytestmark = pytest.mark.usefixtures("opengl")


class Streamer:
    """Stands for trame-rca's and a page: keeps what is sent, and acknowledges each at once."""

    def __init__(self, stream: FrameStream) -> None:
        self.sent: list[dict[str, Any]] = []
        self.stream = stream
        self.acknowledges = True
        stream.clock.restart()
        stream.set_streamer(self)

    def acknowledge(self) -> None:
        """Acknowledge all pictures."""
        self.stream.on_interaction("page", {"number": self.sent[-1]["number"], "seconds": 0})

    def has(self, count: int) -> bool:
        return len(self.sent) >= count

    def push_content(self, name: str, meta: dict[str, Any], content: bytes) -> None:
        assert content[:2] == b"\xff\xd8"
        self.sent.append({"name": name, "bytes": len(content), **meta})
        if self.acknowledges:
            self.acknowledge()


class Wake(asyncio.Event):
    """An event that tells whether somebody waits for it."""

    waiting = False

    async def wait(self) -> Literal[True]:
        self.waiting = True
        try:
            return await super().wait()
        finally:
            self.waiting = False


def test_pictures_come_until_rest_and_then_no_more(flat: FlowApp) -> None:
    stream, streamer = flat.stream, Streamer(flat.stream)
    flat.area.reset_camera()

    async def watch() -> None:
        stream._wake = wake = Wake()
        task = asyncio.create_task(stream.run())
        for count in (1, 2, 3):
            # Many requests at once are one picture.
            stream.changed()
            stream.changed()
            await until(partial(streamer.has, count))
        await until(lambda: any(sent["sharp"] for sent in streamer.sent))
        assert [sent["sharp"] for sent in streamer.sent].count(True) == 1
        assert streamer.sent[-1]["bytes"] > streamer.sent[0]["bytes"]
        assert (streamer.sent[-1]["w"], streamer.sent[-1]["h"]) == (240, 160)
        # At rest it waits for a request, and there is none.
        await until(lambda: wake.waiting)
        count = len(streamer.sent)
        asked: list[bool] = []

        def nobody() -> bool:
            asked.append(True)
            return False

        stream.watched = nobody
        stream.changed()
        await until(lambda: len(asked) == 2 and wake.waiting)
        assert len(streamer.sent) == count
        # Who comes back meanwhile is sent one.
        away = iter([False])
        stream.watched = lambda: next(away, True)
        stream.changed()
        await until(partial(streamer.has, count + 1))
        task.cancel()

    asyncio.run(watch())


def test_pictures_that_a_new_page_missed_are_not_waited_for(flat: FlowApp) -> None:
    stream = flat.stream
    size = dict(zip("wh", flat.viewport.size, strict=True))
    stream.clock.restart()
    for _ in range(2):
        stream.clock.sent(moving=True)
    stream.update_size("page", size)
    assert stream.clock.on_way == 2
    stream.reset()
    stream.update_size("page", size)
    assert stream.clock.on_way == 0


@pytest.mark.parametrize("kind", ["flat", "bent"])
def test_tiles_are_the_same_picture(kind: str, request: pytest.FixtureRequest) -> None:
    app: FlowApp = request.getfixturevalue(kind)
    whole = picture(app)
    tile = app.viewport.draw(80, 60, (100, 40, 80, 60)).astype(int)
    # Curved surfaces show a row of pixels of another level where 2 x 2 blocks fall otherwise.
    assert difference(tile, whole[40:100, 100:180]) < 1.0
    assert difference(tile, whole[42:102, 100:180]) > 3.0


def test_full_picture_replaces_draft(flat: FlowApp, monkeypatch: pytest.MonkeyPatch) -> None:
    module = "flowtex.app.streaming.stream"
    monkeypatch.setattr(f"{module}.DRAFT_PIXELS", 2_000)
    monkeypatch.setattr(f"{module}.TILE_PX", 64)
    painter = flat.stream.painter
    monkeypatch.setattr(painter, "slow", True)
    flat.area.settings.samples = 21
    quick = painter.quick()
    assert flat.area.settings.samples == 21  # of which a draft has fewer
    flat.area.settings.samples = 9
    assert not painter.complete and quick.shape[0] * quick.shape[1] < 2_100
    *_, full = painter.full(quick)
    assert difference(full, picture(flat)) < 0.5
    monkeypatch.setattr(painter, "slow", False)
    assert difference(painter.quick(), full) < 0.5 and painter.complete
    # A slow connection has smaller pictures from a graphics card as well.
    quarter = painter.quick(0.25)
    assert not painter.complete and quarter.shape == (80, 120, 3)
    (full,) = painter.full(quarter)
    assert difference(full, picture(flat)) < 0.5


def test_two_panes_have_line_between_them(flat: FlowApp, monkeypatch: pytest.MonkeyPatch) -> None:
    painter = flat.stream.painter
    monkeypatch.setattr(painter, "slow", False)
    flat.area.compare({"contrast": 0.0})
    try:
        width, height = flat.viewport.pane_size
        views = [flat.viewport.draw(width, height, pane=pane) for pane in flat.viewport.panes]
        line = np.full((height, GAP_PX, 3), LINE_GREY)
        expected = np.concatenate([views[0], line, views[1]], axis=1)
        assert difference(*views) > 3.0
        assert difference(painter.quick(), expected) < 0.5
        for share, slow in ((0.5, False), (1.0, True)):
            monkeypatch.setattr(painter, "slow", slow)
            *_, full = painter.full(painter.quick(share))
            assert difference(full, expected) < 0.5
    finally:
        flat.area.compare(None)


GRID = np.stack(np.meshgrid(np.linspace(0, 2, 9), np.linspace(0, 1, 5)), axis=-1)


def on_grid(**options: Any) -> FlowField:
    return FlowField.from_arrays(GRID, np.ones_like(GRID), **options)


def on_triangles() -> FlowField:
    points = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    return FlowField.from_triangles(points, [[0, 1, 2], [1, 3, 2]], np.ones_like(points))


def state(view: Viewport) -> tuple[Any, ...]:
    scenes = [pane.scene for pane in view.panes]
    drawn = sorted(view.plotter.renderer.actors)
    return view.panes[:], scenes, dict(view.differences), view.camera, view.clock, drawn


@pytest.mark.parametrize("act", ["show", "compare", "time"])
def test_a_flow_that_is_refused_leaves_the_comparison(act: str) -> None:
    view = Viewport(on_grid(), image=np.ones((2, 2)), samples=5)  # which triangles do not have
    view.compare({"contrast": 0.0})
    view.clock = 0.5
    before = state(view)
    with pytest.raises((SettingsError, TypeError)):
        if act == "show":
            view.show(on_triangles())
        else:
            view.compare({"field": on_triangles()} if act == "compare" else {"time": "noon"})
    assert state(view) == before
    view.settings.samples = 7  # the second one follows still
    assert [pane.settings.samples for pane in view.panes] == [7, 7]
    view.show(on_grid(name="another"), keep_view=True)
    assert [pane.field.name for pane in view.panes] == ["another"] * 2
    assert [pane.clock for pane in view.panes] == [0.5] * 2
    assert view.panes[1].settings.contrast == 0.0
    view.settings.samples = 5
    assert view.panes[1].settings.samples == 5
    view.compare(None)
    assert len(view.panes) == 1
    view.close()
