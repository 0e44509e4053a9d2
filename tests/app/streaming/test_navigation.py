"""What the mouse, the wheel and fingers do to the camera."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

pytest.importorskip("trame_rca")

from small_pages import difference, picture

from flowtex.app import FlowApp
from flowtex.app.streaming.navigation import Place

pytestmark = pytest.mark.usefixtures("opengl")


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


def test_fingers_that_pinch_click_nothing(flat: FlowApp) -> None:
    """The page tells the first finger down, and the last one up, as clicks of a mouse."""
    flat.area.reset_camera()
    send = flat.stream.on_interaction
    places: list[Place | None] = []
    flat.stream.pointer.clicked.connect(places.append)
    size = {"w": 240, "h": 160}

    def click(x: float) -> None:
        for kind in ("LeftButtonPress", "LeftButtonRelease"):
            send("test", {"type": kind, "x": x, "y": 80, **size})

    click(60)
    send("test", {"type": "StartPinch", "factor": 1, **size})
    assert places == [(-0.5, 0.0), None]
    send("test", {"type": "Pinch", "factor": 2, **size})
    send("test", {"type": "EndPinch", "factor": 2, **size})
    click(180)
    assert len(places) == 2
    click(180)
    assert places[2:] == [(0.5, 0.0)]
    flat.area.reset_camera()


def test_pinching_zooms_between_the_fingers(flat: FlowApp) -> None:
    flat.area.reset_camera()
    send = flat.stream.on_interaction
    fingers = {"0": {"x": 60, "y": 80}, "1": {"x": 180, "y": 80}}
    send("test", {"type": "StartPinch", "w": 240, "h": 160, "factor": 1})
    send("test", {"type": "Pinch", "w": 240, "h": 160, "factor": 2, "positions": fingers})
    assert flat.viewport.zoom == pytest.approx(2)
    flat.area.reset_camera()
