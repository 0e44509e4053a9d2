"""What a mouse, a wheel or fingers do to the camera, from the events that the page sends."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from flowtex.app.scene import GAP, Scene

__all__ = ["Pointer"]

#: Notches of the wheel that one event may stand for; trackpads send small parts of one.
MOST_NOTCHES = 5.0


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

    def __call__(self, event: dict[str, Any]) -> bool:
        """Follow one event; tells whether the view changed."""
        event = self._within_pane(event)
        kind = str(event.get("type", ""))
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
            shift = bool(event.get("shiftKey"))
            other = shift or not kind.startswith("Left")
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
        width, x = self._size(event)[0], float(event.get("x") or 0.0)
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
        spin = float(event.get("spinY") or 0.0)
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
        factor = float(event.get("factor") or 1.0)
        self._navigator.zoom_by(factor / self._pinch, *self._middle(event))
        self._pinch = factor
        return True

    def _slid(self, event: dict[str, Any]) -> bool:
        """Follow two fingers that move together."""
        x, y = (float(v) for v in (event.get("translation") or (0.0, 0.0))[:2])
        width, height = self._size(event)
        self._navigator.pan(-2 * (x - self._slide[0]) / width, -2 * (y - self._slide[1]) / height)
        self._slide = (x, y)
        return True

    @staticmethod
    def _size(event: dict[str, Any]) -> Place:
        return max(float(event.get("w") or 1), 1.0), max(float(event.get("h") or 1), 1.0)

    @staticmethod
    def _pixel(event: dict[str, Any]) -> Place:
        return float(event.get("x") or 0.0), float(event.get("y") or 0.0)

    def _place(self, event: dict[str, Any]) -> Place:
        width, height = self._size(event)
        x, y = self._pixel(event)
        return 2 * x / width - 1, 2 * y / height - 1

    def _middle(self, event: dict[str, Any]) -> Place:
        """Place between the fingers; the middle of the view when it is not told."""
        positions = event.get("positions")
        if not isinstance(positions, dict) or not positions:
            return 0.0, 0.0
        places = [self._place({**event, **at}) for at in positions.values()]
        return (
            sum(x for x, _ in places) / len(places),
            sum(y for _, y in places) / len(places),
        )
