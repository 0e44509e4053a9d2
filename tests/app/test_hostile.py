"""What a page may send, and when: nothing of it ends the drawing, or reaches another page."""

from __future__ import annotations

import asyncio
import logging
import math
import threading
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from small_pages import Streamer, playing, small, small_page
from waiting import until

pytest.importorskip("trame_rca")

from camera_moves import pan

from flowtex import FlowField
from flowtex._util.progress import check
from flowtex.app import FlowApp, Library
from flowtex.app.controllers.library import Choice
from flowtex.app.streaming.stream import MOST_PIXELS
from flowtex.scene.fields import TracedFlow

pytestmark = pytest.mark.usefixtures("opengl")

#: What a page may send in the place of anything.
JUNK: list[Any] = [
    *(10**400, -(10**400)),
    *(None, True, -1, 0, 10**18, 2.5, -1e308, 1e308, math.nan, math.inf, -math.inf),
    *("", "x" * 50_000, "1", b"1", b"\xff" * 9, [], {}, [1, 2], [math.nan, {}], [[], []]),
    *({"x": "y"}, {"content": 3}, [{"name": [], "content": []}]),
]


def block(size: tuple[int, int, int] = (9, 8, 7), *arrays: str) -> pv.ImageData:
    """A grid in which the plane can be told from the velocity."""
    grid = pv.ImageData(dimensions=size)
    velocity = np.zeros((grid.n_points, 3))
    velocity[:, 0] = 1.0
    for name in arrays or ("velocity",):
        grid.point_data[name] = velocity
    grid.point_data["depth"] = grid.points[:, 2].copy()
    return grid


def opened(app: FlowApp) -> bool:
    """Return whether nothing is being opened."""
    return app.data._opening is None or app.data._opening.done()


@pytest.fixture(scope="module")
def app() -> Iterator[FlowApp]:
    made = small_page(small(steps=3))
    yield made
    made.close()


def test_a_view_has_a_size_that_can_be_drawn(app: FlowApp) -> None:
    for junk in JUNK:
        for size in (junk, *({"w": 96, "h": 64, "p": 1, name: junk} for name in "whp")):
            app.stream.update_size("test", size)
            width, height = app.viewport.size
            assert min(width, height) >= 4 and max(width, height) <= 8192
            assert width * height <= 1.01 * MOST_PIXELS
    app.stream.update_size("test", {"w": 96, "h": 64, "p": 1})
    assert app.viewport.size == (96, 64)


def raising(error: Exception) -> Callable[..., Any]:
    def fail(*_: Any, **__: Any) -> Any:
        raise error

    return fail


async def test_a_picture_that_fails_is_not_the_last_one(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.ERROR)
    app = small_page(small())
    quick = app.stream.painter.quick

    async with playing(app):
        streamer = Streamer(app.stream)
        monkeypatch.setattr(app.stream.painter, "quick", raising(RuntimeError("no context")))
        task = asyncio.create_task(app.stream.run())
        app.stream.changed()
        await until(lambda: "could not be drawn" in caplog.text)
        monkeypatch.setattr(app.stream.painter, "quick", quick)
        app.stream.changed()
        await until(lambda: streamer.sent)
        assert not task.done()
        task.cancel()


@pytest.mark.parametrize("name", ["out_width", "out_seconds"])
def test_a_picture_of_no_size_is_refused_and_leaves_no_folder(app: FlowApp, name: str) -> None:
    before = {key: app.state.get(key) for key in ("out_format", name)}
    for junk in [j for j in JUNK if j not in (2.5, True)]:
        app.state.set(**{"out_format": "PNG" if name == "out_width" else "GIF", name: junk})
        app.state.set(problem="")
        app.sharing.start()
        assert 0 < len(app.state.get("problem")) < 1000
        assert app.state.get("out_progress") is None
        assert list(app.sharing.downloads.folder.iterdir()) == []
    app.state.set(**before, problem="")


async def test_a_choice_of_any_kind_is_one_that_there_is() -> None:
    app = small_page(Library.of(block(), small(name="other")))
    data = app.data

    async def send(name: str, junk: Any, before: tuple[str, Choice]) -> None:
        app.state.set(problem="", **{name: junk})
        data.take_file() if name == "file" else data.take_choice()
        await until(lambda: opened(app))
        assert app.state.get("busy") == ""
        if name != "index":
            assert (data.name, data.choice) == before
            assert app.state.get(name) == data._options().get(name, data.name)
        assert app.state.get("index") == int(data.choice.plane[2:])
        assert len(app.state.get("problem")) < 500
        if data.choice != before[1]:
            data.open(*before)
            await until(lambda: data.choice == before[1] and opened(app))

    async with playing(app):
        before = (data.name, data.choice)
        for name in ("file", "vectors", "block", "axis", "index"):
            for junk in JUNK:
                await send(name, junk, before)


def slow(monkeypatch: pytest.MonkeyPatch, app: FlowApp) -> dict[str, threading.Event]:
    """Let each plane be opened when its event is set, or when it is not wanted any more."""
    gates: dict[str, threading.Event] = {}
    library = app.data.library
    read = library.field

    def waiting(name: str, choice: Choice) -> Any:
        gate = gates.setdefault(choice.plane, threading.Event())
        while not gate.wait(0.005):
            check()
        return read(name, choice)

    monkeypatch.setattr(library, "field", waiting)
    return gates


async def test_the_latest_plane_wins_and_the_slider_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    app = small_page(block())
    gates = slow(monkeypatch, app)
    shown: list[str] = []
    show = app.context.show

    def noted(*arguments: Any, **options: Any) -> None:
        shown.append(app.data.choice.plane)
        show(*arguments, **options)

    monkeypatch.setattr(app.context, "show", noted)
    told: list[Any] = []
    async with playing(app):
        app.state.on(lambda: told.append(app.state.get("index")), "index")
        for index in (4, 5, 6):
            app.state.send(index=index)
            # The first one has begun before the second one is requested.
            await until(lambda index=index: told[-1:] == [index] and "k=4" in gates)
        for gate in ("k=4", "k=5", "k=6"):
            gates.setdefault(gate, threading.Event()).set()
        await until(lambda: app.data.choice.plane == "k=6" and opened(app))
        # What had begun was seen on the way, and the slider heard nothing of it.
        assert shown == ["k=4", "k=6"] and told == [4, 5, 6]
        # Away and back again before the other one was there: it stays away.
        app.state.send(index=2)
        await until(lambda: "k=2" in gates)
        app.state.send(index=6)
        gates.setdefault("k=2", threading.Event()).set()
        await until(lambda: opened(app))
        assert (
            shown == ["k=4", "k=6"] and app.state.get("index") == 6 and app.state.get("busy") == ""
        )


async def test_a_file_that_fails_in_any_way_says_so_and_the_old_view_stands(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    app = small_page(Library.of(block(), small(name="other")))
    async with playing(app):
        before, failing = app.field, raising(RuntimeError("reader crashed"))
        places: list[tuple[Any, str]] = [
            (app.data.library, "field"),
            (TracedFlow, "of"),
            (app.context, "show"),
        ]
        for owner, name in places:
            with monkeypatch.context() as patch:
                patch.setattr(owner, name, failing)
                app.state.send(file="other")
                await until(lambda: "reader crashed" in app.state.get("problem"))
                await until(lambda: opened(app))
            assert app.field is before and app.state.get("busy") == ""
            assert app.state.get("file") == app.data.name != "other"
            assert app.state.get("index") == 3 and "reader crashed" in caplog.text
            app.state.send(problem="")
        app.state.send(file="other")
        await until(lambda: app.data.name == "other" and app.state.get("axes") == [])


async def test_blocks_have_planes_of_their_own() -> None:
    blocks = pv.MultiBlock(
        {"large": block((9, 8, 20)), "small": block((9, 8, 4), "other", "third")}
    )
    library = Library.of(blocks)
    app, beside = small_page(library), small_page(library)
    async with playing(app):
        app.state.send(index=15)
        await until(lambda: app.data.choice.plane == "k=15")
        app.state.send(block="small")
        await until(lambda: app.data.choice == Choice("other", "k=2", "small"))
        await until(lambda: app.state.get("planes") == 3)
        assert app.state.get("vectors_choices") == ["other", "third"]
        # Another page, which shows the other block, sees nothing of it.
        assert beside.data._options()["planes"] == 19
        beside.data.take_choice()
        assert beside.data._opening is None
        beside.close()
        app.state.send(block="large")
        await until(lambda: app.data.choice == Choice("velocity", "k=10", "large"))


async def test_a_plane_keeps_time_range_and_camera_and_another_file_does_not() -> None:
    steps = [block() for _ in range(3)]
    app = small_page(Library.of(steps, small(name="other")), times=None)
    assert len(app.field.times) == 3
    async with playing(app):
        app.area.scalars, app.area.clim = "depth", (-1.0, 99.0)
        app.area.take_time(1.0)
        app.viewport.camera = camera = pan(app.viewport.camera, 0.2, 0.1, app.viewport.aspect)
        app.state.send(index=5)
        await until(lambda: app.data.choice.plane == "k=5")
        assert app.viewport.handle.time == 1.0
        assert app.area.scene.scalar_limits == (-1.0, 99.0)
        assert app.viewport.camera == camera
        app.state.send(file="other")
        await until(lambda: app.data.name == "other" and app.field.steady)
        assert app.area.scalars == "speed" and app.area.clim is None


def test_what_stays_open_is_bounded_in_bytes() -> None:
    library = Library.of(*(small(name=name) for name in "abcde"))
    library._sources.max_bytes = 1
    sizes = [library.source(name).nbytes for name in library.names]
    assert min(sizes) > 1000 and len(library._sources) == 1


@pytest.mark.parametrize(
    ("size", "panes", "curved"),
    [((60, 240), 1, False), ((60, 240), 2, True), ((240, 60), 2, False)],
)
def test_the_whole_surface_is_in_view(size: tuple[int, int], panes: int, curved: bool) -> None:
    flow = small(curved=curved)
    # Long, so that one side of it tells nothing of another.
    app = small_page(FlowField.from_arrays(flow.points * [4, 1, 1], flow.velocity[0]))
    app.stream.update_size("test", {"w": size[0], "h": size[1], "p": 1})
    app.area.compare({"lod": False} if panes == 2 else None)

    def seen() -> float:
        points = app.field.points.reshape(-1, 3)
        return float(np.abs(app.viewport.camera.project(points, app.viewport.aspect)).max())

    assert 0.5 < seen() <= 1.0
    app.viewport.camera = pan(app.viewport.camera, 0.3, 0.1, app.viewport.aspect)
    app.area.reset_camera()
    assert 0.5 < seen() <= 1.0
    for view in app.viewpoint.views:
        app.viewpoint.look_from(view)
        assert 0.3 < seen() <= 1.0
    app.close()
