"""What a mouse, a wheel or fingers do to the camera, from the events that the page sends."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

from flowtex.app.server.untrusted import clipped, mapping
from flowtex.app.streaming.scene import GAP, Scene

__all__ = ["Pointer"]

#: Notches of the wheel that one event may stand for; trackpads send small parts of one.
MOST_NOTCHES = 5.0
#: Farthest from the view that a pointer is followed, in pixels, and how far two fingers may spread.
FARTHEST, SPREAD = 1e5, 1e3
#: A button that is let go within so many seconds and pixels is a click.
CLICK_SECONDS, CLICK_PIXELS = 0.4, 4.0

Place = tuple[float, float]


class Pointer:
    """Turns events of the page into moves of a scene's camera.

    Events hold x and y in pixels of the page, y upwards, and the size w, h of the view.

    Attributes
    ----------
    pointed
        Called with the place, (x, y) from -1 to 1 within a pane, when the pointer rests or moves
        with no button held; with ``None`` when something else is done.
    clicked
        Called with the place of a click.
    side
        Number of the pane that the pointer is over.
    """

    def __init__(self, scene: Scene) -> None:
        self.pointed: Callable[[Place | None], None] = lambda place: None
        self.clicked: Callable[[Place], None] = lambda place: None
        self._scene = scene
        self._pinch = 1.0
        self._slide = (0.0, 0.0)
        self._held = False
        self.side = 0
        self._pressed = (0.0, 0.0, 0.0)

    @property
    def _navigator(self) -> Any:
        return self._scene.navigator

    def __call__(self, event: Any) -> bool:
        """Follow one event; tells whether the view changed."""
        event = self._within_pane(_cleaned(mapping(event)))
        kind = event["type"]
        handler = {
            "MouseMove": self._move,
            "MouseWheel": self._wheel,
            "StartPinch": self._start_touch,
            "Pinch": self._spread,
            "StartPan": self._start_touch,
            "Pan": self._slid,
        }.get(kind)
        if handler is not None:
            return handler(event)
        if kind.endswith("ButtonPress"):
            other = event["shiftKey"] or not kind.startswith("Left")
            self._held = True
            self._pressed = (time.monotonic(), *self._pixel(event))
            self._navigator.press(*self._place(event), other=other)
            self.pointed(None)
        elif kind.endswith("ButtonRelease"):
            self._held = False
            self._navigator.release()
            if kind.startswith("Left") and self._is_click(event):
                self.clicked(self._place(event))
        return False

    def _is_click(self, event: dict[str, Any]) -> bool:
        then, x0, y0 = self._pressed
        x, y = self._pixel(event)
        near = abs(x - x0) + abs(y - y0) <= CLICK_PIXELS
        return near and time.monotonic() - then <= CLICK_SECONDS

    def _within_pane(self, event: dict[str, Any]) -> dict[str, Any]:
        """Count from the pane under the pointer; a drag stays with the one in which it began."""
        if len(self._scene.panes) == 1:
            return event
        width, x = event["w"], event["x"]
        share = self._scene.pane_size[0] / max(self._scene.size[0], 1)
        side = int(x > width / 2)
        if not self._held:
            self.side = side
        shift = self.side * width * (share + GAP / max(self._scene.size[0], 1))
        return {**event, "x": x - shift, "w": width * share}

    def _move(self, event: dict[str, Any]) -> bool:
        if not self._held:
            self.pointed(self._place(event))
            return False
        return bool(self._navigator.move(*self._place(event)))

    def _wheel(self, event: dict[str, Any]) -> bool:
        spin = event["spinY"]
        if not spin:
            return False
        # The page counts turns away from the person as negative.
        notches = min(max(-spin, -MOST_NOTCHES), MOST_NOTCHES)
        self.pointed(None)
        self._navigator.wheel(notches, *self._place(event))
        return True

    def _start_touch(self, event: dict[str, Any]) -> bool:
        del event
        self._pinch, self._slide = 1.0, (0.0, 0.0)
        return False

    def _spread(self, event: dict[str, Any]) -> bool:
        factor = event["factor"]
        self._navigator.zoom_by(factor / self._pinch, *self._middle(event))
        self._pinch = factor
        return True

    def _slid(self, event: dict[str, Any]) -> bool:
        """Follow two fingers that move together."""
        (x, y), width, height = event["translation"], event["w"], event["h"]
        self._navigator.pan(-2 * (x - self._slide[0]) / width, -2 * (y - self._slide[1]) / height)
        self._slide = (x, y)
        return True

    @staticmethod
    def _pixel(event: dict[str, Any]) -> Place:
        return event["x"], event["y"]

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
        return clipped(value, 0.0, -FARTHEST, FARTHEST)

    slide, fingers = event.get("translation"), mapping(event.get("positions"))
    slide = slide if isinstance(slide, (list, tuple)) and len(slide) >= 2 else (0.0, 0.0)
    return {
        "type": str(event.get("type", "")),
        "x": pixel(event.get("x")),
        "y": pixel(event.get("y")),
        "w": clipped(event.get("w"), 1.0, 1.0, FARTHEST),
        "h": clipped(event.get("h"), 1.0, 1.0, FARTHEST),
        "shiftKey": bool(event.get("shiftKey")),
        "spinY": pixel(event.get("spinY")),
        "factor": clipped(event.get("factor"), 1.0, 1 / SPREAD, SPREAD),
        "translation": (pixel(slide[0]), pixel(slide[1])),
        "positions": [
            (pixel(at.get("x")), pixel(at.get("y"))) for at in map(mapping, fingers.values())
        ],
    }
