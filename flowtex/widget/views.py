"""The view of a widget, or two side by side that differ in some settings.

Both are one widget: the second has the settings of the first except its own, and the browser links
their cameras, so that they move in the same frame.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any, TypeGuard

import numpy as np

from flowtex.field import FlowField
from flowtex.rendering.camera import CameraValues
from flowtex.rendering.webgl.marks import MARK_PARTS
from flowtex.rendering.webgl.protocol import Header
from flowtex.scene.scene import Scene, follow, lay_image
from flowtex.textures.tiles import TileKey
from flowtex.web.view import WebView
from flowtex.widget.feed import Feed, Send

#: Traits of the widget with the headers of the views, from left to right.
HEADERS = ("_header", "_header_beside")

#: Fields of the appearance that can be chosen in the browser.
CHOSEN = ("scalars", "cmap", "clim", "log_scale", "opacity", "coastlines", "graticule")


class Views:
    """One view or two, from left to right, each with its feed.

    ``announce`` is called with the number of a view and its new header, before its arrays are
    sent; ``send`` with a message, which has the number of its view, and its buffers.
    """

    def __init__(
        self, views: Sequence[WebView], announce: Callable[[int, Header], None], send: Send
    ) -> None:
        self.views = tuple(views)
        for view in self.views[1:]:
            follow(lambda: self.first, lambda view=view: view.scene, view.own)  # type: ignore[misc]
        self.feeds = [self._feed(n, view, announce, send) for n, view in enumerate(self.views)]

    @property
    def first(self) -> Scene:
        """The scene of the first view."""
        return self.views[0].scene

    def show(self, field: FlowField) -> None:
        """Show another flow in all views, or in none if it does not fit one of them."""
        for view in self.views:
            view.scene.showing(field).close()
        for view in self.views:
            view.show(field)

    def _feed(
        self, number: int, view: WebView, announce: Callable[[int, Header], None], send: Send
    ) -> Feed:
        return Feed(
            view,
            moment=lambda: self.first.time,
            announce=lambda header: announce(number, self._with_own(number, header)),
            send=lambda message, buffers: send({**message, "view": number}, buffers),
        )

    def _with_own(self, number: int, header: Header) -> Header:
        """Add the settings in which two views differ."""
        if len(self.views) == 1:
            return header
        own, settings = self.views[1].own_settings, self.views[number].scene.settings
        values = {name: getattr(settings, name) for name in own} if number else {}
        return {**header, "differs": list(own), "own": values}

    @property
    def headers(self) -> list[Header]:
        """Header of each view."""
        return [self._with_own(n, feed.header) for n, feed in enumerate(self.feeds)]

    def start(self) -> None:
        """Start the feeds."""
        for feed in self.feeds:
            feed.start()

    def handle_message(self, message: Header) -> None:
        """Answer the client; invalid messages are ignored."""
        kind, number = message.get("kind"), message.get("view", 0)
        for feed in self.feeds:
            feed.acknowledged = True
            if kind == "ready":
                feed.ready()
        if not (isinstance(number, int) and 0 <= number < len(self.feeds)):
            return
        names, request = message.get("names"), message.get("request")
        if kind == "appearance" and isinstance(message.get("changes"), dict):
            self._take_appearance(message["changes"])
        if kind == "want" and isinstance(names, list) and all(isinstance(n, str) for n in names):
            self.feeds[number].want(names)
        if kind == "drop" and isinstance(request, str):
            self.feeds[number].drop(request)
        key, steps = message.get("key"), message.get("steps")
        if kind == "load" and isinstance(request, str) and _are_whole(steps):
            mark = message.get("mark", "")
            if key is None and mark in ("", *MARK_PARTS.values()):
                self.feeds[number].load(request, None, steps, mark)
            elif _are_whole(key) and len(key) == len(TileKey._fields):
                self.feeds[number].load(request, TileKey(*key), steps)

    def _take_appearance(self, changes: Header) -> None:
        """Apply colours that were chosen in the browser; invalid ones are ignored."""
        chosen = {name: value for name, value in changes.items() if name in CHOSEN}
        with suppress(ValueError, KeyError, TypeError):
            self.first.appearance = replace(self.first.appearance, **chosen)

    def set_image(self, image: Any) -> None:
        """Lay another image on the surface, in all views that show one."""
        lay_image([view.scene for view in self.views], image, self.views[-1].own)

    def picture(
        self, size: tuple[int, int], camera: CameraValues, timeout_s: float
    ) -> bytes | None:
        """Return a small picture of all views as PNG, if there is one in this many seconds."""
        view_size = (size[0] // len(self.feeds), size[1] // len(self.feeds))  # in the same shape
        if timeout_s > 0:
            for feed in self.feeds:
                feed.draw(view_size, camera)
                feed.pictured.wait(timeout_s)
        pictures = [feed.picture for feed in self.feeds if feed.picture is not None]
        if len(pictures) < len(self.feeds):
            return None
        return pictures[0] if len(pictures) == 1 else _side_by_side(pictures)

    def close(self) -> None:
        """Close the feeds and the views."""
        for feed, view in zip(self.feeds, self.views, strict=True):
            feed.close()
            view.close()


def _are_whole(values: Any) -> TypeGuard[list[int]]:
    return isinstance(values, list) and all(isinstance(value, int) for value in values)


def _side_by_side(pictures: Sequence[bytes]) -> bytes:
    from PIL import Image

    columns = [np.asarray(Image.open(io.BytesIO(png)).convert("RGB")) for png in pictures]
    file = io.BytesIO()
    Image.fromarray(np.hstack(columns)).save(file, "PNG")
    return file.getvalue()
