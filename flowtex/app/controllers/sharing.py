"""Exports of a page: pictures, movies, a link to the state, and lines of Python.

A job draws a copy of the viewport a tile at a time, and lets the event loop continue between two
tiles. Tracing and writing files is done in a thread. A cancelled job leaves no file.
"""

from __future__ import annotations

import asyncio
import logging
import shutil
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from PIL import Image

from flowtex._util.arguments import checked_number
from flowtex._util.array_types import Bytes
from flowtex._util.colours import rgb
from flowtex._util.progress import check, stoppable
from flowtex._util.whole_file import whole_file
from flowtex.app.controllers.context import Context, Controller, State
from flowtex.app.controllers.data import Data, FileBeside
from flowtex.app.controllers.serialization import from_link, to_link, to_python
from flowtex.app.server.files import Downloads
from flowtex.app.server.page import number
from flowtex.app.streaming.stream import LINE_GREY
from flowtex.app.streaming.viewport import GAP_PX, TILE_PX, Viewport
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.plotting.offscreen.encoders import DEFAULT_QUALITY, MovieWriter, check_movie
from flowtex.plotting.offscreen.movie import FrameTimes, frame_times
from flowtex.scene.annotations import Layout, annotate_views, room_of
from flowtex.settings import Settings

T = TypeVar("T")

#: Formats of files to save.
FORMATS = ("PNG", "MP4", "GIF")
#: Names of numbers of the page in messages.
LABELS = {
    "out_width": "the width",
    "out_height": "the height",
    "out_density": "the fineness",
    "out_seconds": "the length in seconds",
    "out_fps": "the pictures per second",
}

#: Pixels of a picture, at most.
MOST_PIXELS = 100_000_000
#: Pixels of a movie, at most.
MOST_MOVIE_PIXELS = 9_000_000
#: Longest side of either.
LONGEST_SIDE_PX = 30_000
#: How fine a picture may be.
MOST_DENSITY = 8.0

_log = logging.getLogger(__name__)


class Sharing(Controller):
    """Exports of a page, which shows ``first`` when it is new.

    ``restore_state`` is called with the state of a link.
    """

    def __init__(
        self,
        context: Context,
        data: Data,
        beside: FileBeside,
        restore_state: Callable[[State], None],
        first: State,
    ) -> None:
        super().__init__(context)
        self.downloads = Downloads(context.routes)
        self._data = data
        self._beside = beside
        self._restore_state = restore_state
        self._first = first
        self._task: asyncio.Task[None] | None = None
        self.state.set(
            out_format=FORMATS[0],
            out_width=1920,
            out_height=1080,
            out_density=1.0,
            out_smooth=True,
            out_annotations=False,
            out_seconds=4.0,
            out_fps=30.0,
            out_progress=None,
            out_file=None,
            link="",
            python="",
        )
        context.field_changed.connect(self.cancel)

    def start(self) -> None:
        """Start the export that the page requests."""
        before = self._task
        self.cancel()
        try:
            job = self._new_job()
        except (FieldError, ModuleNotFoundError, OSError) as error:
            self.context.complain(error)
            return
        self.state.set(out_progress=0.0, out_file=None)
        self._task = asyncio.create_task(self._run(job, before))

    def cancel(self) -> None:
        """Cancel the export."""
        if self._task is not None:
            self._task.cancel()
        self.state.set(out_progress=None)

    def _new_job(self) -> Job:
        """Return a job with the values of the dialog; its file is reserved."""
        get = self.state.get
        kind = self.state.get("out_format")
        if kind not in FORMATS:
            raise ExportError(f"the format is {kind!r}; expected {', '.join(FORMATS)}")
        path = self.downloads.reserve(f"{self.viewport.field.name or 'flow'}.{kind.lower()}")
        try:
            numbers = {name: self._number(name) for name in LABELS}
            supersampling = 1
            if get("out_smooth"):
                supersampling = 2
            return Job(
                self.viewport,
                path,
                (int(numbers["out_width"]), int(numbers["out_height"])),
                supersampling=supersampling,
                density=numbers["out_density"],
                annotations=bool(get("out_annotations")),
                seconds=numbers["out_seconds"],
                fps=numbers["out_fps"],
            )
        except BaseException:
            shutil.rmtree(path.parent, ignore_errors=True)
            raise

    def _number(self, name: str) -> float:
        """Return a number of the dialog."""
        value = self.state.get(name)
        checked = number(value)
        if checked is None:
            raise ExportError(f"{LABELS[name]} is {value!r}; expected a number")
        return checked

    async def _run(self, job: Job, before: asyncio.Task[None] | None) -> None:
        """Write a file after an earlier job has ended, and offer it on the page."""

        def report(share: float) -> None:
            if (percent := round(100 * share)) != self.state.get("out_progress"):
                self.state.send(out_progress=percent)

        path: Path | None = None
        try:
            if before is not None:
                await asyncio.wait([before])
            path = await job.run(report)
            self.state.send(out_file={"name": path.name, "url": self.downloads.add(path)})
        except Exception as error:
            if not isinstance(error, (FieldError, OSError)):
                _log.exception("%s could not be made", job.path.name)
            self.context.complain(
                f"{job.path.name} could not be made: {str(error) or type(error).__name__}"
            )
        finally:
            if path is None:
                shutil.rmtree(job.path.parent, ignore_errors=True)
            if self._task is asyncio.current_task():
                self.state.send(out_progress=None)

    def present_state(self) -> dict[str, Any]:
        """Return the state of the page, named as in :mod:`.serialization`."""
        state: dict[str, Any] = {}
        for controller in self.context.controllers:
            state |= controller.describe()
        return state

    def show_state(self) -> None:
        """Show the link and the lines of Python on the page."""
        state = self.present_state()
        sources = {}
        if not self.context.library.is_file(self._data.name):
            sources["source"] = "field"
        if not self.context.library.is_file(self._beside.name):
            sources["source_beside"] = "field_beside"
        self.state.set(
            link="#" + to_link(state, self._first),
            python=to_python(state, **sources, size=self.viewport.pane_size),
        )

    def take_link(self, text: object) -> None:
        """Show the state in the page's address."""
        faults: list[str] = []
        state = from_link(str(text), faults)
        if faults:
            self.context.complain("; ".join(faults))
        if state:
            self._restore_state(state)

    def close(self) -> None:
        """End running tasks."""
        self.cancel()
        self.downloads.close()


class ExportError(FieldError):
    """A picture or a movie cannot be made; the text gives the reason and the remedy."""


class Job:
    """An export, which draws and writes while a page continues, without changing its view.

    A picture of any size is drawn a tile at a time, through a window as large as a tile. The suffix
    of the file is the format: a PNG, or a movie, which is a seamless loop of a steady flow, or
    shows all times of a varying flow. An MP4 gets even sides. ``supersampling`` is the number of
    drawn pixels for each pixel of the result, along each side. ``density`` scales lengths that the
    settings give in pixels: with 2 grains are twice as large, for high-resolution screens and
    print. Raises an ExportError or a MovieError for invalid arguments.
    """

    def __init__(
        self,
        viewport: Viewport,
        path: Path,
        size: tuple[int, int],
        *,
        supersampling: int = 1,
        density: float = 1.0,
        annotations: bool = False,
        seconds: float | None = None,
        fps: float = 30.0,
        quality: int = DEFAULT_QUALITY,
    ) -> None:
        self.path = path
        self.done = False
        suffix = path.suffix.lower()
        if suffix == ".mp4":
            size = (max(size[0] // 2 * 2, 2), max(size[1] // 2 * 2, 2))
        if suffix == ".png":
            _check(size, density, MOST_PIXELS)
        else:
            _check(size, density, MOST_MOVIE_PIXELS)
        self._viewport = viewport
        self._size = size
        self._quality = quality
        self._supersampling = supersampling
        self._density = density
        self._annotations = annotations
        self._gap = 0
        self._rows = slice(0, size[1])
        self.frames: FrameTimes | None = None
        self._report: Callable[[float], None] = lambda share: None
        if suffix != ".png":
            check_movie(path, size, fps, quality)
            settings = _moving(viewport.handle.settings, viewport.field)
            self.frames = frame_times(viewport.field, settings, fps=fps, seconds=seconds)
        self._pool = ThreadPoolExecutor(1, "flowtex-export")

    async def run(self, report: Callable[[float], None]) -> Path:
        """Draw and write the file, and return its path; ``report`` takes the share that is done."""
        viewport = self._viewport = self._viewport.copy()
        self._report = report
        try:
            if self.frames is None:
                await self._in_thread(viewport.trace)
                self._prepare()
                await self._in_thread(self._write, await self._draw(0.0, 0.9))
            else:
                await self._make_movie(viewport, self.frames)
        finally:
            self.done = True
            viewport.close()
            self._pool.shutdown(wait=False)
        return self.path

    def _write(self, picture: Bytes) -> None:
        with whole_file(self.path) as file:
            Image.fromarray(picture).save(file, "PNG")
            check()

    async def _make_movie(self, viewport: Viewport, frames: FrameTimes) -> None:
        """Draw the frames, and write them to the file."""
        viewport.set_still(still=False)
        if viewport.field.steady:
            motion = _moving(viewport.handle.settings, viewport.field).motion
            for pane in viewport.panes:
                pane.settings.update(motion=motion, period=frames.seconds, speed=frames.speed)
        self._prepare()
        writer = MovieWriter(self.path, self._size, frames.fps, self._quality)
        try:
            for n in range(len(frames)):
                if viewport.field.steady:
                    viewport.clock = frames.clocks[n]
                else:
                    await self._in_thread(viewport.trace, frames.times[n])
                    viewport.set_time(frames.times[n])
                picture = await self._draw(0.95 * n / len(frames), 0.95 / len(frames))
                await self._in_thread(writer.add, picture)
            await self._in_thread(writer.finish)
        finally:
            self.done = True
            # In the thread, after its present work.
            await asyncio.wrap_future(self._pool.submit(writer.close))

    def _prepare(self) -> None:
        """Set the resolution of the panes, and leave room for annotations."""
        panes = self._viewport.panes
        density = self._density
        if len(panes) > 1:
            self._gap = max(round(GAP_PX * density), 1)
        else:
            self._gap = 0
        self._viewport.longest_side = TILE_PX
        for pane in panes:
            pane.density = density * self._supersampling
        if self._annotations:
            layouts = self._annotate(np.zeros((*self._size[::-1], 3), np.uint8))
            above, below = room_of(layouts)
            self._rows = slice(above, self._size[1] - below)

    async def _draw(self, before: float, share: float) -> Bytes:
        """Draw a picture, which is ``share`` of the whole work, after the share ``before``."""
        ground = np.rint(255 * np.array(rgb(self._viewport.background)))
        canvas = np.full((*self._size[::-1], 3), ground, np.uint8)
        rows = canvas[self._rows]
        panes = self._viewport.panes
        times = self._supersampling
        rows[:] = LINE_GREY
        if self._size[0] < len(panes) + self._gap:
            shown = f"{self._size[0]} x {len(rows)}"
            raise ExportError(f"the size is {shown}; expected a pixel for each view")
        tiles = self._viewport.draw_tiles(rows, self._gap, side=TILE_PX // times, times=times)
        for drawn in tiles:
            self._report(before + share * drawn)
            await asyncio.sleep(0)  # other tasks of the event loop have their turn
        if self._annotations:
            self._annotate(canvas)
        return canvas

    def _annotate(self, picture: Bytes) -> list[Layout]:
        """Write annotations on a picture of all panes in place; return their layouts."""
        viewport = self._viewport
        return annotate_views(
            picture,
            [pane.scene for pane in viewport.panes],
            viewport.camera,
            viewport.differences,
            flow_height=self._rows.stop - self._rows.start,
            background=viewport.background,
            legend=viewport.settings.noise != "image",
        )

    async def _in_thread(self, work: Callable[..., T], *arguments: Any) -> T:
        """Do work in the thread of the job, which ends once the job is done."""

        def stopping() -> T:
            with stoppable(lambda: self.done):
                return work(*arguments)

        return await asyncio.get_running_loop().run_in_executor(self._pool, stopping)


def _moving(settings: Settings, field: FlowField) -> Settings:
    """Return settings with which a steady flow moves."""
    moving = settings.copy()
    if field.steady and moving.motion == "off":
        moving.motion = "speed"
    return moving


def _check(size: tuple[int, int], density: float, most: int) -> None:
    """Check the size of an image in pixels, and its density."""
    if min(size) < 1 or max(size) > LONGEST_SIDE_PX or size[0] * size[1] > most:
        raise ExportError(
            f"the size is {size[0]} x {size[1]}; expected 1 to {LONGEST_SIDE_PX:,} pixels along "
            f"each side, and at most {most:,} in all"
        )
    expected = f"{1 / MOST_DENSITY:g} to {MOST_DENSITY:g}, 1 for a screen"
    checked_number("density", density, 1 / MOST_DENSITY, MOST_DENSITY, expected=expected)
