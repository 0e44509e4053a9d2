"""What a mouse, a wheel or fingers do to the camera, from the events that the page sends.

Places in the view are (x, y) from -1 to 1, right and up, so that no move depends on the size of
the picture. A drag pans a flat surface and turns a curved one; with another button, or with Shift,
it does the other of the two.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from typing import Any

from flowtex.app.server.page import Signal
from flowtex.app.server.validation import clipped, mapping
from flowtex.app.streaming.viewport import GAP_PX, Viewport
from flowtex.camera import CAMERA_LIMITS

#: Notches of the wheel that one event may stand for; trackpads send small parts of one.
MOST_NOTCHES = 5.0
#: Farthest from the view that a pointer is followed, in pixels, and how far two fingers may spread.
FARTHEST_PX, MOST_SPREAD = 1e5, 1e3
#: A button that is released within so many seconds and pixels is a click.
CLICK_S, CLICK_PX = 0.4, 4.0
#: A click within so many seconds before two fingers was the first of them; a busy machine hears
#: of them late.
TOUCH_S = 1.5

Place = tuple[float, float]


class Pointer:
    """Turns events of the page into moves of a viewport's camera.

    Events hold x and y in pixels of the page, y upwards, and the size w, h of the view.

    Attributes
    ----------
    hovered
        Signal with the place within a pane when the pointer rests or moves with no button
        pressed, and with ``None`` when something else is done.
    clicked
        Signal with the place of a click, and with ``None`` when it turns out to be none.
    pane
        Number of the pane that the pointer is over.
    """

    def __init__(self, viewport: Viewport) -> None:
        self.hovered, self.clicked = Signal(), Signal()
        self.pane = 0
        self._viewport = viewport
        self._spread = 1.0
        self._slide = (0.0, 0.0)
        #: Whether the drag turns, and where it is.
        self._drag: tuple[bool, Place] | None = None
        self._pressed = (0.0, 0.0, 0.0)
        self._clicked = -math.inf
        #: Whether a finger of two was lifted last; the page tells the other one as a click.
        self._lifted = False

    def __call__(self, event: Any) -> bool:
        """Follow one event; tells whether the view changed."""
        event = self._within_pane(_cleaned(mapping(event)))
        kind = event["type"]
        handler = {
            "MouseMove": self._on_move,
            "MouseWheel": self._on_wheel,
            "StartPinch": self._on_touch,
            "Pinch": self._on_pinch,
            "StartPan": self._on_touch,
            "Pan": self._on_slide,
        }.get(kind)
        if handler is not None:
            return handler(event)
        if kind.endswith("ButtonPress"):
            other = event["shiftKey"] or not kind.startswith("Left")
            self._drag = (self._viewport.flat is other, self._place(event))
            began = -math.inf if self._lifted else time.monotonic()
            self._pressed, self._lifted = (began, event["x"], event["y"]), False
            self.hovered.emit(None)
        elif kind.endswith("ButtonRelease"):
            self._drag = None
            if kind.startswith("Left") and self._is_click(event):
                self._clicked = time.monotonic()
                self.clicked.emit(self._place(event))
        elif kind in {"EndPinch", "EndPan"}:
            self._lifted = True
        return False

    def _is_click(self, event: dict[str, Any]) -> bool:
        pressed, x, y = self._pressed
        near = abs(event["x"] - x) + abs(event["y"] - y) <= CLICK_PX
        return near and time.monotonic() - pressed <= CLICK_S

    def _within_pane(self, event: dict[str, Any]) -> dict[str, Any]:
        """Count from the pane under the pointer; a drag stays with the one in which it began."""
        viewport = self._viewport
        if len(viewport.panes) == 1:
            self.pane = 0
            return event
        width, x = event["w"], event["x"]
        share = viewport.pane_size[0] / max(viewport.size[0], 1)
        if self._drag is None:
            self.pane = int(x > width / 2)
        shift = self.pane * width * (share + GAP_PX / max(viewport.size[0], 1))
        return {**event, "x": x - shift, "w": width * share}

    def _on_move(self, event: dict[str, Any]) -> bool:
        place = self._place(event)
        if self._drag is None:
            self._lifted = False
            self.hovered.emit(place)
            return False
        turns, (x, y) = self._drag
        if place == (x, y):
            return False
        if turns:
            self._viewport.rotate(place[0] - x, place[1] - y)
        else:
            self._viewport.pan(x - place[0], y - place[1])
        self._drag = (turns, place)
        return True

    def _on_wheel(self, event: dict[str, Any]) -> bool:
        spin = event["spinY"]
        if not spin:
            return False
        # The page counts turns away from the person as negative.
        notches = min(max(-spin, -MOST_NOTCHES), MOST_NOTCHES)
        self.hovered.emit(None)
        self._viewport.zoom_by(CAMERA_LIMITS.wheel_zoom**notches, *self._place(event))
        return True

    def _on_touch(self, event: dict[str, Any]) -> bool:
        """Begin with two fingers; the first of them came as a click."""
        del event
        if time.monotonic() - self._clicked <= TOUCH_S:
            self.clicked.emit(None)
        self._spread, self._slide = 1.0, (0.0, 0.0)
        return False

    def _on_pinch(self, event: dict[str, Any]) -> bool:
        factor = event["factor"]
        self._viewport.zoom_by(factor / self._spread, *self._middle(event))
        self._spread = factor
        return True

    def _on_slide(self, event: dict[str, Any]) -> bool:
        """Follow two fingers that move together."""
        (x, y), width, height = event["translation"], event["w"], event["h"]
        self._viewport.pan(-2 * (x - self._slide[0]) / width, -2 * (y - self._slide[1]) / height)
        self._slide = (x, y)
        return True

    def _place(self, event: dict[str, Any]) -> Place:
        return 2 * event["x"] / event["w"] - 1, 2 * event["y"] / event["h"] - 1

    def _middle(self, event: dict[str, Any]) -> Place:
        """Place between the fingers; the middle of the view when it is not told."""
        if not event["positions"]:
            return 0.0, 0.0
        places = [self._place({**event, "x": x, "y": y}) for x, y in event["positions"]]
        return (
            sum(x for x, _ in places) / len(places),
            sum(y for _, y in places) / len(places),
        )


def _cleaned(event: Mapping[str, Any]) -> dict[str, Any]:
    """Return an event in which every value is there, and is a number where one is meant."""

    def pixel(value: Any) -> float:
        return clipped(value, 0.0, -FARTHEST_PX, FARTHEST_PX)

    slide, fingers = event.get("translation"), mapping(event.get("positions"))
    slide = slide if isinstance(slide, (list, tuple)) and len(slide) >= 2 else (0.0, 0.0)
    return {
        "type": str(event.get("type", "")),
        "x": pixel(event.get("x")),
        "y": pixel(event.get("y")),
        "w": clipped(event.get("w"), 1.0, 1.0, FARTHEST_PX),
        "h": clipped(event.get("h"), 1.0, 1.0, FARTHEST_PX),
        "shiftKey": bool(event.get("shiftKey")),
        "spinY": pixel(event.get("spinY")),
        "factor": clipped(event.get("factor"), 1.0, 1 / MOST_SPREAD, MOST_SPREAD),
        "translation": (pixel(slide[0]), pixel(slide[1])),
        "positions": [
            (pixel(at.get("x")), pixel(at.get("y"))) for at in map(mapping, fingers.values())
        ],
    }
