"""What a mouse, a wheel or fingers do to the camera, from the events that the page sends."""

from __future__ import annotations

from typing import Any

from flowtex.app.navigate import Navigator

__all__ = ["Pointer"]

#: Notches of the wheel that one event may stand for; trackpads send small parts of one.
MOST_NOTCHES = 5.0


class Pointer:
    """Turns events of the page into moves of a :class:`~flowtex.app.navigate.Navigator`.

    Events hold x and y in pixels of the page, y upwards, and the size w, h of the view.
    """

    def __init__(self, navigator: Navigator) -> None:
        self._navigator = navigator
        self._pinch = 1.0
        self._slide = (0.0, 0.0)

    def __call__(self, event: dict[str, Any]) -> bool:
        """Follow one event; tells whether the view changed."""
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
            other = shift or kind.startswith("Middle")
            self._navigator.press(*self._place(event), other=other)
        elif kind.endswith("ButtonRelease"):
            self._navigator.release()
        return False

    def _move(self, event: dict[str, Any]) -> bool:
        return self._navigator.move(*self._place(event))

    def _wheel(self, event: dict[str, Any]) -> bool:
        spin = float(event.get("spinY") or 0.0)
        if not spin:
            return False
        # The page counts turns away from the person as negative.
        notches = min(max(-spin, -MOST_NOTCHES), MOST_NOTCHES)
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
    def _size(event: dict[str, Any]) -> tuple[float, float]:
        return max(float(event.get("w") or 1), 1.0), max(float(event.get("h") or 1), 1.0)

    def _place(self, event: dict[str, Any]) -> tuple[float, float]:
        width, height = self._size(event)
        x, y = float(event.get("x") or 0.0), float(event.get("y") or 0.0)
        return 2 * x / width - 1, 2 * y / height - 1

    def _middle(self, event: dict[str, Any]) -> tuple[float, float]:
        """Place between the fingers; the middle of the view when it is not told."""
        positions = event.get("positions")
        if not isinstance(positions, dict) or not positions:
            return 0.0, 0.0
        places = [self._place({**event, **at}) for at in positions.values()]
        return (
            sum(x for x, _ in places) / len(places),
            sum(y for _, y in places) / len(places),
        )
