"""Pages of small flows, and pictures of them, for the tests of the page."""

from __future__ import annotations

from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from camera_moves import pan

from flowtex import FlowField
from flowtex.rendering.camera import Camera

if TYPE_CHECKING:
    from flowtex.app import FlowApp
    from flowtex.app.streaming.stream import FrameStream


class Streamer:
    """Stands for trame-rca's and a page: counts the pictures, and acknowledges each at once."""

    def __init__(self, stream: FrameStream) -> None:
        self.sent = 0
        self.stream = stream
        stream.set_streamer(self)

    def push_content(self, name: str, meta: dict[str, Any], content: bytes) -> None:
        del name, content
        self.sent += 1
        self.stream.on_interaction("page", {"number": meta["number"], "seconds": 0.0})


def small(*, curved: bool = False, steps: int = 1, name: str = "") -> FlowField:
    """A patch of 24 x 16 nodes, flat or bent, in which everything moves along x."""
    x, y = np.meshgrid(np.linspace(0, 3, 24), np.linspace(0, 2, 16))
    z = 0.4 * np.sin(x) if curved else np.zeros_like(x)
    points = np.stack([x, y, z], axis=-1)
    velocity = np.zeros((steps, *points.shape))
    velocity[..., 0] = 1 + 0.1 * np.arange(steps)[:, None, None] + 0.2 * y
    times = np.arange(steps, dtype=float) if steps > 1 else None
    moving = velocity if steps > 1 else velocity[0]
    return FlowField.from_arrays(points, moving, times=times, scalars={"height": x}, name=name)


def small_page(
    flow: Any, samples: int = 3, width: int = 96, height: int = 64, **options: Any
) -> FlowApp:
    pytest.importorskip("trame_rca")
    from flowtex.app import FlowApp

    app = FlowApp(flow, samples=samples, **options)
    app.stream.update_size("test", {"w": width, "h": height, "p": 1})
    return app


@pytest.fixture(scope="module")
def flat(opengl: object) -> Iterator[FlowApp]:
    """A page of a steady flow on a flat patch."""
    app = small_page(small(), 9, 240, 160)
    yield app
    app.close()


@pytest.fixture(scope="module")
def bent(opengl: object) -> Iterator[FlowApp]:
    """A page of a steady flow on a bent patch."""
    app = small_page(small(curved=True), 9, 240, 160)
    yield app
    app.close()


@pytest.fixture
def series(opengl: object) -> Iterator[FlowApp]:
    """A page of a flow that varies in time."""
    app = small_page(small(steps=4), 5, 120, 80)
    yield app
    app.close()


def picture(app: Any) -> Any:
    width, height = app.viewport.size
    return app.viewport.draw(width, height).astype(int)


def panned(viewport: Any, x: float, y: float) -> None:
    """Move what is seen by a part of the view."""
    viewport.camera = pan(viewport.camera, x, y, viewport.aspect)


def zoom_of(app: FlowApp) -> float:
    """Return the zoom of a page; 1 shows the whole surface."""
    viewport = app.viewport
    whole = Camera.fit(viewport.scene.whole.surface, viewport.aspect)
    return whole.height / viewport.camera.height


def difference(one: Any, other: Any) -> float:
    return float(np.abs(np.asarray(one, int) - np.asarray(other, int)).mean())


@asynccontextmanager
async def playing(app: FlowApp) -> AsyncIterator[None]:
    """Let something happen on a page in the event loop, and close it there."""
    app.server.state.ready()
    try:
        yield
    finally:
        app.close()
