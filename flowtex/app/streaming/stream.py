"""The stream of pictures to the page: when to draw, and how well.

One task draws. It sleeps until a picture is requested, draws quick ones for as long as they are
requested, and the full one once nothing has moved for a moment. Requests are not queued: the next
picture shows the latest state. Pictures are sent by a remote controlled area (trame-rca).

A graphics card draws everything at full quality at once. A processor takes too long for that, so
what moves is a draft of fewer pixels and samples, over which the full picture is drawn a tile at a
time.
"""

from __future__ import annotations

import asyncio
import io
import logging
import math
import time
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from itertools import pairwise
from typing import Any

import numpy as np

from flowtex._util.array_types import Bytes
from flowtex.app.server.page import Signal, clipped, mapping
from flowtex.app.streaming.viewport import GAP_PX, Rect, Viewport
from flowtex.errors import FieldError
from flowtex.plotting.handle import FlowHandle
from flowtex.rendering.diagnostics import opengl_report

#: Seconds to answer a new page before anything is drawn for it.
ANSWER_S = 0.05
#: Seconds without a change after which the full picture is drawn.
REST_S = 0.12
#: Pictures in a second, at most.
MOST_RATE_HZ = 30.0
#: Seconds between two sendings of an unfinished full picture.
PARTIAL_INTERVAL_S = 0.2
#: Seconds between two pictures that show more and more tiles.
TILE_INTERVAL_S = 1.0
#: Seconds between two checks whether a page is connected.
WATCH_INTERVAL_S = 0.1
#: Seconds that a picture waits for earlier ones that are still on their way, at most.
CONGESTION_S = 2.0
#: JPEG qualities in motion and at rest.
MOTION_QUALITY, REST_QUALITY = 80, 94
#: Pixels of a picture, at most: a screen of 2,560 x 1,600.
MOST_PIXELS = 4_100_000
#: Sides of a picture in pixels, and pixels for one of CSS, at least and at most.
SIDES_PX, PIXEL_RATIOS = (16.0, 8192.0), (0.25, 8.0)
#: Pixels and samples of a draft, at most: a processor draws it in about a fifteenth of a second.
#: Its pixels are larger, so its streaks are as long with fewer samples.
DRAFT_PIXELS, DRAFT_SAMPLES = 80_000, 9
#: About the side in pixels of a tile, which a processor draws in about a tenth of a second.
TILE_PX = 224
#: Grey of the line between two panes.
LINE_GREY = 128

_log = logging.getLogger(__name__)


class ViewPainter:
    """Draws all panes of a viewport, which may come and go."""

    def __init__(self, viewport: Viewport) -> None:
        self._viewport = viewport
        self.slow = opengl_report().software  #: Whether drafts are drawn in motion.
        self.complete = False  #: Whether the last picture that was drawn is at full quality.
        self.drafting = False  #: Whether a setting is changed for the moment, for a draft.
        self._last: list[Bytes] = []
        self._state = 0

    def forget(self) -> None:
        """Discard the drawn picture, which no longer shows the present state."""
        self.complete = False
        self._state += 1

    def quick(self) -> Bytes:
        """Return a picture as good as there is time for in motion, (h, w, 3) uint8."""
        panes = self._viewport.panes
        self.complete = True
        self._last = [self._quick(pane, DRAFT_PIXELS / len(panes)) for pane in panes]
        return self._joined(self._last)

    def _quick(self, pane: FlowHandle, most: float) -> Bytes:
        (width, height), settings = self._viewport.pane_size, pane.settings
        scale = min(math.sqrt(most / max(width * height, 1)), 1.0)
        if not self.slow or (scale == 1.0 and settings.samples <= DRAFT_SAMPLES):
            return self._viewport.draw(width, height, pane=pane)
        self.complete = False
        self.drafting = True
        chosen, settings.samples = settings.samples, min(DRAFT_SAMPLES, settings.samples)
        try:
            width, height = (max(round(side * scale), 16) for side in (width, height))
            return self._viewport.draw(width, height, pane=pane)
        finally:
            settings.samples = chosen
            self.drafting = False

    def full(self) -> Generator[Bytes, None, None]:
        """Draw the full picture over the quick one; yield it after each tile, to cancel there."""
        state, panes = self._state, list(self._viewport.panes)
        if len(self._last) != len(panes):
            self.quick()
        canvases = [_resized(last, *self._viewport.pane_size).copy() for last in self._last]
        for canvas, pane in zip(canvases, panes, strict=True):
            for left, top, wide, high in _tiles(canvas.shape[1], canvas.shape[0]):
                tile = self._viewport.draw(wide, high, (left, top, wide, high), pane=pane)
                canvas[top : top + high, left : left + wide] = tile
                yield self._joined(canvases)
        self.complete = state == self._state

    def _joined(self, pictures: list[Bytes]) -> Bytes:
        """Put pictures side by side, a line between them."""
        if len(pictures) == 1:
            return pictures[0]
        height, width = (max(p.shape[axis] for p in pictures) for axis in (0, 1))
        gap = max(round(GAP_PX * width / self._viewport.pane_size[0]), 1)
        joined = np.full((height, len(pictures) * (width + gap) - gap, 3), LINE_GREY, np.uint8)
        for number, picture in enumerate(pictures):
            left = number * (width + gap)
            joined[:, left : left + width] = _resized(picture, width, height)
        return joined


class FrameStream:
    """One view of the page, as an area of trame-rca."""

    def __init__(self, name: str, viewport: Viewport) -> None:
        self.area_name = name
        self.streamer: Any = None
        #: Whether the animation runs, and whether the browser draws, so that no picture is needed.
        self.playing = self.paused = False
        #: Whether the surface is fitted to another size of the view, which a page does itself.
        self.fits = True
        #: Returns whether a page is connected; otherwise nothing is drawn.
        self.watched: Callable[[], bool] = lambda: True
        #: Signal with a FieldError when a part of the data, such as a later step, cannot be read.
        self.data_failed = Signal()
        self.painter = ViewPainter(viewport)
        self._viewport = viewport
        self._wake = asyncio.Event()
        self._sized = False
        self._closed = False
        self._fault = ""
        self._tiled = 0.0

    def set_streamer(self, streamer: Any) -> None:
        """Set the object that sends pictures to the page."""
        self.streamer = streamer

    def update_size(self, origin: str, size: object) -> None:
        """Follow the size of the view in the page, in CSS pixels ``w``, ``h`` times ``p``."""
        del origin
        if self._closed:
            return
        sides, (least, most) = mapping(size), SIDES_PX
        ratio = clipped(sides.get("p"), 1.0, *PIXEL_RATIOS)
        width, height = (
            min(max(clipped(sides.get(side), least, least, most) * ratio, least), most)
            for side in ("w", "h")
        )
        shrink = min(1.0, (MOST_PIXELS / (width * height)) ** 0.5)
        new = round(width * shrink), round(height * shrink)
        if new != self._viewport.size:
            at_home = self.fits and self._viewport.at_home
            self._viewport.resize(*new)
            if at_home:
                self._viewport.refit()
            self.painter.forget()
        self._sized = True
        self.moved()

    def on_interaction(self, origin: str, event: object) -> None:
        """Ignore events: the page moves the camera itself."""
        del origin, event

    def reset(self) -> None:
        """Begin again, as when the page is loaded again."""
        self.moved()

    def video_codecs(self) -> list[dict[str, str]]:
        """Return the video formats that are offered: none."""
        return []

    def negotiate_video(self, codecs: list[str]) -> dict[str, str]:
        """Refuse video: it costs more than it saves on a picture that is all texture."""
        del codecs
        return {"error": "not-a-video-stream"}

    def close(self) -> None:
        """Stop drawing."""
        self._closed = True

    def moved(self) -> None:
        """Request a picture after a move of the camera."""
        if not self._closed:
            self._wake.set()

    def changed(self) -> None:
        """Request a picture after a change of the scene."""
        if self._closed:
            return
        self.painter.forget()
        self.moved()

    def _tile_ready(self) -> None:
        """Request a picture when a tile is ready, now and then while more follow."""
        now = time.perf_counter()
        if not self._viewport.busy or now > self._tiled + TILE_INTERVAL_S:
            self._tiled = now
            self.changed()

    async def run(self) -> None:
        """Draw for as long as the task lives."""
        loop = asyncio.get_running_loop()

        def notify() -> None:
            if not loop.is_closed():
                loop.call_soon_threadsafe(self._tile_ready)

        self._viewport.load_in_background(notify)
        # The shader is built for the first picture: better now, while the browser starts, but after
        # its answer.
        await asyncio.sleep(ANSWER_S)
        with self._log_faults():
            self._viewport.draw(16, 16)
        while True:
            await self._wake.wait()
            if not self._is_watched():
                self._wake.clear()
                await asyncio.sleep(WATCH_INTERVAL_S)
                if self._is_watched():
                    self._wake.set()
                continue
            with self._log_faults():
                await self._quick()
                if await self._rests():
                    await self._full()

    @contextmanager
    def _log_faults(self) -> Iterator[None]:
        """Log the error of a picture, and draw on; the page gets those of the data."""
        try:
            yield
        except Exception as error:
            # An animation may fail many times in a second.
            if repr(error) != self._fault:
                self._fault = repr(error)
                if isinstance(error, FieldError):
                    self.data_failed.emit(error)
                else:
                    _log.exception("a picture could not be drawn")

    def _is_watched(self) -> bool:
        return self._sized and self.streamer is not None and not self.paused and self.watched()

    async def _quick(self) -> None:
        """Send one picture in motion, no sooner than the last one allows."""
        self._wake.clear()
        started = time.perf_counter()
        pixels = self.painter.quick()
        await self._send(pixels, MOTION_QUALITY)
        # Events of the page arrive while this sleeps; without it they would wait for the picture.
        await asyncio.sleep(max(1 / MOST_RATE_HZ - (time.perf_counter() - started), 0.004))

    async def _rests(self) -> bool:
        try:
            await asyncio.wait_for(self._wake.wait(), REST_S)
        except TimeoutError:
            return not self.playing
        return False

    async def _full(self) -> None:
        """Draw the full picture, and give up as soon as something changes."""
        looked = time.perf_counter()
        if self.painter.complete:
            await self._send(self.painter.quick(), REST_QUALITY, sharp=True)
            return
        for canvas in self.painter.full():
            await asyncio.sleep(0)
            if self._wake.is_set():
                return
            if time.perf_counter() - looked > PARTIAL_INTERVAL_S:
                await self._send(canvas, MOTION_QUALITY)
                looked = time.perf_counter()
        await self._send(canvas, REST_QUALITY, sharp=True)

    async def _send(self, pixels: Bytes, quality: int, *, sharp: bool = False) -> None:
        height, width = pixels.shape[:2]
        loop = asyncio.get_running_loop()
        content = await loop.run_in_executor(None, encode, pixels, quality)
        meta = {"type": "image/jpeg", "codec": "", "w": width, "h": height, "key": "key"}
        meta |= {"st": time.time_ns() // 1_000_000, "quality": quality, "sharp": sharp}
        end, monitor = time.perf_counter() + CONGESTION_S, self.streamer.coreServer.network_monitor
        while monitor.pending > 1 and time.perf_counter() < end:
            await asyncio.sleep(0.002)
        self.streamer.push_content(self.area_name, meta, content)


def encode(pixels: Bytes, quality: int) -> bytes:
    """Return a picture as JPEG; at rest without halving the resolution of the colours."""
    from PIL import Image

    buffer = io.BytesIO()
    subsampling = 0 if quality >= REST_QUALITY else 2
    Image.fromarray(pixels).save(buffer, "JPEG", quality=quality, subsampling=subsampling)
    return buffer.getvalue()


def _tiles(width: int, height: int) -> list[Rect]:
    """Return tiles of about the same size, from the middle of the view outwards."""
    tiles = [
        (x, y, right - x, below - y)
        for y, below in pairwise(_cuts(height))
        for x, right in pairwise(_cuts(width))
    ]
    return sorted(
        tiles, key=lambda t: math.hypot(2 * t[0] + t[2] - width, 2 * t[1] + t[3] - height)
    )


def _resized(pixels: Bytes, width: int, height: int) -> Bytes:
    if pixels.shape[:2] == (height, width):
        return pixels
    from PIL import Image

    smooth = Image.Resampling.BILINEAR
    return np.asarray(Image.fromarray(pixels).resize((width, height), smooth))


def _cuts(length: int) -> list[int]:
    """Return the ends of about equal parts, even, as derivatives need 2 x 2 pixels."""
    count = math.ceil(length / TILE_PX)
    return [2 * round(length * n / count / 2) for n in range(count)] + [length]
