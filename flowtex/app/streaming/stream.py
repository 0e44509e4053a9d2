"""The stream of pictures to the page: when to draw, and how well.

One task draws quick pictures for as long as they are requested, and the full one once nothing has
moved for a moment; the next picture shows the latest state. A graphics card draws everything at
full quality at once. A processor takes too long for that, so what moves is a draft of fewer pixels
and samples, over which the full picture is drawn a tile at a time. Over a slow connection both draw
fewer pixels, and they are sent no faster than the page acknowledges them.
"""

from __future__ import annotations

import asyncio
import io
import logging
import math
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import contextmanager

import numpy as np
from PIL import Image
from trame_rca.protocol import AreaAdapter

from flowtex._util.array_types import Bytes
from flowtex.app.server.page import clipped, mapping, number
from flowtex.app.streaming.frame_clock import MOST_ON_WAY, FrameClock
from flowtex.app.streaming.viewport import GAP_PX, TILE_PX, Viewport
from flowtex.errors import FieldError
from flowtex.plotting.handle import FlowHandle
from flowtex.rendering.diagnostics import opengl_report
from flowtex.settings import Signal

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
#: JPEG quality in motion over a slow connection.
LEAST_QUALITY = 50
#: JPEG quality in motion otherwise.
MOTION_QUALITY = 80
#: JPEG quality at rest.
REST_QUALITY = 94
#: Pixels of a picture, at most: a screen of 2,560 x 1,600.
MOST_PIXELS = 4_100_000
#: Sides of a picture in pixels, at least and at most.
SIDES_PX = (16.0, 8192.0)
#: Pixels for one of CSS, at least and at most.
PIXEL_RATIOS = (0.25, 8.0)
#: Most pixels of a draft: a processor draws it in about a fifteenth of a second.
DRAFT_PIXELS = 80_000
#: Most samples of a draft, whose pixels are larger, so that its streaks are as long.
DRAFT_SAMPLES = 9
#: Grey of the line between two panes.
LINE_GREY = 128

_log = logging.getLogger(__name__)


class ViewPainter:
    """Draws all panes of a viewport, which may come and go."""

    def __init__(self, viewport: Viewport) -> None:
        self._viewport = viewport
        self.slow = opengl_report().software  #: Whether drafts are drawn in motion.
        self.complete = False  #: Whether the last quick picture is at full quality.
        self.drafting = False  #: Whether a setting is changed for the moment, for a draft.

    def quick(self, share: float = 1.0) -> Bytes:
        """Return a picture as good as there is time for in motion, (h, w, 3) uint8.

        ``share`` is the share of the pixels for which there is time on the way to the page.
        """
        panes = self._viewport.panes
        (width, height) = self._viewport.pane_size
        pixels = width * height
        if self.slow:
            most = min(DRAFT_PIXELS / len(panes), pixels)
        else:
            most = pixels
        scale = math.sqrt(share * most / pixels)
        self.complete = scale == 1.0
        if not self.complete:
            width = max(round(width * scale), 16)
            height = max(round(height * scale), 16)
        line = np.full((height, max(round(GAP_PX * scale), 1), 3), LINE_GREY, np.uint8)
        columns: list[Bytes] = []
        for pane in panes:
            if columns:
                columns.append(line)
            columns.append(self._quick(pane, width, height))
        return np.hstack(columns)

    def _quick(self, pane: FlowHandle, width: int, height: int) -> Bytes:
        """Return a picture of a pane, with fewer samples where drawing is slow."""
        chosen = pane.settings.samples
        if not self.slow or chosen <= DRAFT_SAMPLES:
            return self._viewport.draw(width, height, pane=pane)
        self.complete = False
        self.drafting = True
        pane.settings.samples = DRAFT_SAMPLES
        try:
            return self._viewport.draw(width, height, pane=pane)
        finally:
            pane.settings.samples = chosen
            self.drafting = False

    def full(self, draft: Bytes) -> Generator[Bytes, None, None]:
        """Draw the full picture over a quick one; yield it after each tile, to cancel there."""
        count = len(self._viewport.panes)
        (width, height) = self._viewport.pane_size
        size = count * (width + GAP_PX) - GAP_PX, height
        canvas = np.array(Image.fromarray(draft).resize(size, Image.Resampling.BILINEAR))
        if self.slow:
            side = TILE_PX
        else:
            side = max(width, height)
        for _ in self._viewport.draw_tiles(canvas, GAP_PX, side=side):
            yield canvas


class FrameStream(AreaAdapter):
    """One view of the page, as an area of trame-rca."""

    def __init__(self, name: str, viewport: Viewport) -> None:
        super().__init__(name)
        self.playing = False  #: Whether the animation runs.
        self.paused = False  #: Whether no picture is sent, because the browser draws.
        #: Whether the camera is fitted to the surface when the size of the view changes. A page
        #: moves its own camera.
        self.fits = True
        #: Returns whether a page is connected; otherwise nothing is drawn.
        self.watched: Callable[[], bool] = lambda: True
        #: Signal when a part of the data cannot be read, such as a later step; its argument is the
        #: FieldError.
        self.data_failed = Signal()
        self.painter = ViewPainter(viewport)
        self.clock = FrameClock()
        self._viewport = viewport
        self._wake = asyncio.Event()
        self._sized = False  # whether the page has sent its size
        self._is_new = False  # whether a client has connected that has no picture
        self._closed = False
        self._fault = ""  # text of the last error of the data
        self._tiled = 0.0  # time at which tiles were drawn last, in seconds of the clock

    def update_size(self, origin: str, size: object) -> None:
        """Follow the size of the view in the page, in CSS pixels ``w``, ``h`` times ``p``."""
        del origin
        if self._closed:
            return
        sides = mapping(size)
        (least, most) = SIDES_PX
        ratio = clipped(sides.get("p"), 1.0, *PIXEL_RATIOS)
        width = min(max(clipped(sides.get("w"), least, least, most) * ratio, least), most)
        height = min(max(clipped(sides.get("h"), least, least, most) * ratio, least), most)
        shrink = min(1.0, (MOST_PIXELS / (width * height)) ** 0.5)
        new = round(width * shrink), round(height * shrink)
        if new != self._viewport.size:
            self._viewport.resize(*new, fits=self.fits)
        if self._is_new:  # it did not listen before it sent its size
            self.clock.restart()
        self._sized = True
        self._is_new = False
        self.changed()

    def on_interaction(self, origin: object, event: object) -> None:
        """Take the acknowledgement of a picture; the page moves the camera itself."""
        shown = mapping(event)
        picture = number(shown.get("number"))
        seconds = number(shown.get("seconds"))
        if picture is not None and seconds is not None:
            self.clock.acknowledge(str(origin), int(picture), seconds)

    def reset(self) -> None:
        """Begin again, as when the page is loaded again."""
        self._is_new = True
        self.changed()

    def close(self) -> None:
        """Stop drawing."""
        self._closed = True

    def changed(self) -> None:
        """Request a picture after a change of the scene or a move of the camera."""
        if not self._closed:
            self._wake.set()

    def _tile_ready(self) -> None:
        """Request a picture when a tile is ready, now and then while more follow."""
        now = self.clock.now()
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
                draft = await self._quick()
                if await self._rests():
                    await self._full(draft)

    @contextmanager
    def _log_faults(self) -> Iterator[None]:
        """Log the error of a picture, and draw on; the page shows only errors of the data."""
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

    async def _quick(self) -> Bytes:
        """Send a quick picture, and return it."""
        self._wake.clear()
        started = self.clock.now()
        share = self.clock.share
        picture = self.painter.quick(share)
        quality = round(LEAST_QUALITY + share * (MOTION_QUALITY - LEAST_QUALITY))
        await self._send(picture, quality, moving=True)
        # Events of the page arrive while this sleeps; without it they would wait for the picture.
        await asyncio.sleep(max(1 / MOST_RATE_HZ - (self.clock.now() - started), 0.004))
        return picture

    async def _rests(self) -> bool:
        """Return whether nothing changes for a while."""
        try:
            await asyncio.wait_for(self._wake.wait(), REST_S)
        except TimeoutError:
            return not self.playing
        return False

    async def _full(self, draft: Bytes) -> None:
        """Send the full picture, and unfinished ones before where the connection is free."""
        looked = self.clock.now()
        picture = draft
        fuller: Iterable[Bytes] = ()
        if not self.painter.complete:
            fuller = self.painter.full(draft)
        for picture in fuller:
            await asyncio.sleep(0)
            if self._wake.is_set():
                return
            # An unfinished one must not delay the finished one.
            is_free = self.clock.share == 1.0 and not self.clock.on_way
            if is_free and self.clock.now() - looked > PARTIAL_INTERVAL_S:
                await self._send(picture, MOTION_QUALITY)
                looked = self.clock.now()
        await self._send(picture, REST_QUALITY)

    async def _send(self, picture: Bytes, quality: int, *, moving: bool = False) -> None:
        """Send a picture once few are on their way, and one at rest if nothing has changed then."""
        (height, width) = picture.shape[:2]
        sharp = quality == REST_QUALITY
        loop = asyncio.get_running_loop()
        content = await loop.run_in_executor(None, encode, picture, quality)
        if sharp:
            await self.clock.until(0)
        else:
            await self.clock.until(MOST_ON_WAY - 1)
        if sharp and self._wake.is_set():
            return
        meta = {"type": "image/jpeg", "codec": "", "w": width, "h": height, "key": "key"}
        meta |= {"sharp": sharp, "number": self.clock.sent(moving=moving)}
        self.streamer.push_content(self.area_name, meta, content)


def encode(pixels: Bytes, quality: int) -> bytes:
    """Return a picture as JPEG; at rest without halving the resolution of the colours."""
    buffer = io.BytesIO()
    if quality >= REST_QUALITY:
        subsampling = 0
    else:
        subsampling = 2
    Image.fromarray(pixels).save(buffer, "JPEG", quality=quality, subsampling=subsampling)
    return buffer.getvalue()
