"""The stream of pictures to the page: when to draw, and how well.

One task draws. It sleeps until a picture is requested, draws quick ones for as long as they are
requested, and the full one once nothing has moved for a moment. Requests are not queued: the next
picture shows the latest state. Pictures are sent by a remote controlled area (trame-rca).
"""

from __future__ import annotations

import asyncio
import io
import logging
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from flowtex._util.array_types import Bytes
from flowtex.app.server.page import Signal
from flowtex.app.server.validation import mapping
from flowtex.app.streaming.painter import ViewPainter, view_pixels
from flowtex.app.streaming.viewport import Viewport
from flowtex.errors import FieldError

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

_log = logging.getLogger(__name__)


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
        new = view_pixels(mapping(size))
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
        canvas: Bytes | None = None
        if self.painter.complete:
            canvas = self.painter.quick()
        else:
            for canvas in self.painter.full():
                await asyncio.sleep(0)
                if self._wake.is_set():
                    return
                if time.perf_counter() - looked > PARTIAL_INTERVAL_S:
                    await self._send(canvas, MOTION_QUALITY)
                    looked = time.perf_counter()
        if canvas is not None:
            await self._send(canvas, REST_QUALITY, sharp=True)

    async def _send(self, pixels: Bytes, quality: int, *, sharp: bool = False) -> None:
        height, width = pixels.shape[:2]
        loop = asyncio.get_running_loop()
        content = await loop.run_in_executor(None, encode, pixels, quality)
        meta = {"type": "image/jpeg", "codec": "", "w": width, "h": height, "key": "key"}
        meta |= {"st": time.time_ns() // 1_000_000, "quality": quality, "sharp": sharp}
        await self._uncongested()
        self.streamer.push_content(self.area_name, meta, content)

    async def _uncongested(self) -> None:
        """Wait while earlier pictures are still on their way."""
        end = time.perf_counter() + CONGESTION_S
        monitor = self.streamer.coreServer.network_monitor
        while monitor.pending > 1 and time.perf_counter() < end:
            await asyncio.sleep(0.002)


def encode(pixels: Bytes, quality: int) -> bytes:
    """Return a picture as JPEG; at rest without halving the resolution of the colours."""
    from PIL import Image

    buffer = io.BytesIO()
    subsampling = 0 if quality >= REST_QUALITY else 2
    Image.fromarray(pixels).save(buffer, "JPEG", quality=quality, subsampling=subsampling)
    return buffer.getvalue()
