"""The view of a widget, or two beside each other that differ in what the second one was told.

Both are one widget: the second has the settings of the first but for those that are its own, and
the browser links their cameras, so that they move in one frame.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from typing import Any

from flowtex.scene import Scene
from flowtex.settings import Affects
from flowtex.web.view import WebView
from flowtex.widget.feed import Feed

__all__ = ["HEADERS", "Views"]

#: Traits of the widget with the headers of the views, from left to right.
HEADERS = ("_header", "_header_beside")

Header = dict[str, Any]
Say = Callable[[dict[str, Any], list[memoryview]], None]


class Views:
    """One view or two, each with its feed.

    Parameters
    ----------
    views
        What is shown, from left to right.
    announce
        Given the number of a view and its new header, before its arrays are sent.
    send
        Given a message, which tells the number of its view, and its buffers.
    """

    def __init__(
        self, views: Sequence[WebView], announce: Callable[[int, Header], None], send: Say
    ) -> None:
        self.views = tuple(views)
        self.first = self.views[0].scene
        self.feeds = [self._feed(n, view, announce, send) for n, view in enumerate(self.views)]
        for feed, other in zip(self.feeds[1:], self.views[1:], strict=True):
            other.scene.observe(self._remade(feed))

    def _feed(
        self, number: int, view: WebView, announce: Callable[[int, Header], None], send: Say
    ) -> Feed:
        return Feed(
            view,
            moment=lambda: self.first.time,
            announce=lambda header: announce(number, self._told(number, header)),
            send=lambda message, buffers: send({**message, "view": number}, buffers),
        )

    @staticmethod
    def _remade(feed: Feed) -> Callable[[Affects], None]:
        def follow(affects: Affects) -> None:
            if affects != "uniform":
                feed.restart(traces=affects == "trace")

        return follow

    def _told(self, number: int, header: Header) -> Header:
        """Add what tells the views apart: the settings that are the view's own."""
        if len(self.views) == 1:
            return header
        own = self.views[1].own_settings
        scene: Scene = self.views[number].scene
        return {
            **header,
            "differs": list(own),
            "own": {name: getattr(scene.settings, name) for name in own} if number else {},
        }

    @property
    def headers(self) -> list[Header]:
        """Header of each view."""
        return [self._told(n, feed.header) for n, feed in enumerate(self.feeds)]

    def start(self) -> None:
        """Begin to work."""
        for feed in self.feeds:
            feed.start()

    def hear(self, message: dict[str, Any]) -> None:
        """Answer the client; what it cannot mean is not answered."""
        kind, number = message.get("kind"), message.get("view", 0)
        for feed in self.feeds:
            feed.heard = True
        if kind == "ready":
            for feed in self.feeds:
                feed.ready()
        if not (isinstance(number, int) and 0 <= number < len(self.feeds)):
            return
        step, names = message.get("step"), message.get("names")
        if kind == "need" and isinstance(step, int):
            self.feeds[number].need(step)
        if kind == "want" and isinstance(names, list) and all(isinstance(n, str) for n in names):
            self.feeds[number].want(names)

    def follow(self, name: str, value: Any) -> None:
        """Hand a setting of the first view on."""
        for view in self.views[1:]:
            if name not in view.own_settings:
                setattr(view.scene.settings, name, value)

    def set_image(self, image: Any) -> None:
        """Lay another image on the surface, in all views that show one."""
        self.first.set_image(image)
        for view in self.views[1:]:
            if view.scene.settings.noise == "image" or "noise" not in view.own_settings:
                view.scene.set_image(image)

    def changed(self, affects: Affects) -> None:
        """Make anew what a change of the first view asks for."""
        self._remade(self.feeds[0])(affects)

    def picture(
        self, size: tuple[int, int], camera: dict[str, Any], patience: float
    ) -> bytes | None:
        """Return a small picture of all views as PNG, if there is one in so many seconds."""
        each = (size[0] // len(self.feeds), size[1] // len(self.feeds))  # in the same shape
        if patience > 0:
            for feed in self.feeds:
                feed.draw(each, camera)
                feed.pictured.wait(patience)
        found = [feed.picture for feed in self.feeds if feed.picture is not None]
        if len(found) < len(self.feeds):
            return None
        return found[0] if len(found) == 1 else _side_by_side(found)

    def close(self) -> None:
        """Let go of everything."""
        for feed, view in zip(self.feeds, self.views, strict=True):
            feed.close()
            view.close()


def _side_by_side(pictures: Sequence[bytes]) -> bytes:
    from PIL import Image

    opened = [Image.open(io.BytesIO(picture)).convert("RGB") for picture in pictures]
    whole = Image.new("RGB", (sum(p.width for p in opened), opened[0].height))
    left = 0
    for one in opened:
        whole.paste(one, (left, 0))
        left += one.width
    file = io.BytesIO()
    whole.save(file, "PNG")
    return file.getvalue()
