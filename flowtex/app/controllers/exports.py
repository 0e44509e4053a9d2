"""Pictures and movies of what a page shows, made beside it.

A job draws a scene of its own, which takes over settings, colours and camera of the one on view,
a tile at a time, and lets the event loop go on between two tiles. What does not draw, tracing and
writing files, is done in a thread::

    job = PictureJob(scene, path, (8000, 6000))
    task = asyncio.create_task(job.run())  # job.progress, job.cancel()
    await task  # the path, or Stopped

After a job that was cancelled or that failed there is no file.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import IO, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from flowtex._util.progress import Stopped, stoppable
from flowtex._util.whole_file import whole_file
from flowtex.app.streaming.scene import Scene
from flowtex.app.streaming.scene_copy import copy_of, trace_moment
from flowtex.app.streaming.tiles import Sheet
from flowtex.field import FlowField
from flowtex.offscreen.encoders import (
    DEFAULT_QUALITY,
    MovieError,
    check_movie,
    default_fps,
    movie_writer,
)
from flowtex.offscreen.movie import FrameTimes, frame_times
from flowtex.settings import Settings

__all__ = ["MOST_PIXELS", "ExportError", "Job", "MovieJob", "PictureJob"]

Pixels = NDArray[np.uint8]
T = TypeVar("T")

#: Pixels of a picture, and of a movie, and its longest side, at most.
MOST_PIXELS, MOST_MOVIE_PIXELS, LONGEST_SIDE = 100_000_000, 9_000_000, 30_000
#: Pixels that may be drawn, along a side, for one of the result, and how fine a picture may be.
MOST_SUPERSAMPLING, FINEST = 4, 8.0
#: Seconds between two looks whether the view has come to rest.
LOOK = 0.05


class ExportError(ValueError):
    """A picture or a movie cannot be made so; the text says why and what to do."""


class Job:
    """Something that is drawn and written while a page goes on.

    Parameters
    ----------
    scene
        What is on view; nothing of it is changed.
    path
        File to write.
    size
        Width and height in pixels.
    supersampling
        Pixels that are drawn, along each side, for one of the result, 1 to 4.
    density
        Pixels of the result for one that the settings speak of: 2 has grains of twice as many
        pixels, as fine screens and print want it.
    busy
        Tells whether the view needs the time more; nothing is drawn meanwhile.

    Attributes
    ----------
    progress
        How much is done, 0 to 1.
    done
        Whether it has ended, in whatever way.
    path
        The file.

    Raises
    ------
    ExportError, MovieError
        When it cannot be made so.
    """

    def __init__(
        self,
        scene: Scene,
        path: Path,
        size: tuple[int, int],
        *,
        supersampling: int = 1,
        density: float = 1.0,
        busy: Callable[[], bool] = lambda: False,
    ) -> None:
        _check(size, supersampling, density)
        self.path, self.progress, self.done = Path(path), 0.0, False
        self._view, self._size, self._busy = scene, size, busy
        self._supersampling, self._density = supersampling, density
        self._cancelled = False
        self._pool = ThreadPoolExecutor(1, "flowtex-export")

    def cancel(self) -> None:
        """Make no more of it; :meth:`run` ends with ``Stopped`` and no file is left."""
        self._cancelled = not self.done

    @property
    def cancelled(self) -> bool:
        """Whether it was cancelled before it was done."""
        return self._cancelled

    def _unwanted(self) -> bool:
        return self._cancelled or self.done

    async def run(self) -> Path:
        """Draw it and write it.

        Returns
        -------
        pathlib.Path
            The file.

        Raises
        ------
        Stopped
            When it was cancelled.
        OSError
            When it cannot be written.
        """
        scene = copy_of(self._view)
        try:
            await self._make(scene)
        finally:
            self.done = True
            scene.close()
            self._pool.shutdown(wait=False)
        self.progress = 1.0
        return self.path

    async def _make(self, scene: Scene) -> None:
        raise NotImplementedError

    def _sheet(self, scene: Scene) -> Sheet:
        return Sheet(scene, self._size, density=self._density, supersampling=self._supersampling)

    async def _draw(self, sheet: Sheet, before: float, share: float) -> Pixels:
        """Draw one picture, which is ``share`` of the whole work, after what was ``before``."""
        picture: Pixels | None = None
        for canvas, drawn in sheet.draw():
            picture, self.progress = canvas, before + share * drawn
            # Whatever waits for the event loop has its turn.
            await asyncio.sleep(0)
            while self._busy() and not self._cancelled:
                await asyncio.sleep(LOOK)
            if self._cancelled:
                raise Stopped
        if picture is None:
            msg = "there was nothing to draw; expected a size of at least one pixel"
            raise ExportError(msg)
        return picture

    async def _aside(self, work: Callable[..., T], *arguments: Any) -> T:
        """Do something in the job's thread, where tracing can be stopped."""

        def stopping() -> T:
            with stoppable(self._unwanted):
                return work(*arguments)

        return await asyncio.get_running_loop().run_in_executor(self._pool, stopping)


class PictureJob(Job):
    """A picture as PNG, of any size: :class:`Job` has the parameters."""

    async def _make(self, scene: Scene) -> None:
        await self._aside(trace_moment, scene)
        picture = await self._draw(self._sheet(scene), 0.0, 0.9)
        await self._aside(self._write, picture)

    def _write(self, picture: Pixels) -> None:
        from PIL import Image

        with whole_file(self.path) as part, part.open("wb") as file:
            wanted = _Wanted(file, self._unwanted)
            Image.fromarray(picture).save(wanted, "PNG")  # type: ignore[arg-type]


class _Wanted:
    """A file that takes no more once it is not wanted any more."""

    def __init__(self, file: IO[bytes], unwanted: Callable[[], bool]) -> None:
        self._file, self._unwanted = file, unwanted
        self.flush = file.flush

    def write(self, content: bytes) -> int:
        if self._unwanted():
            raise Stopped
        return self._file.write(content)


class MovieJob(Job):
    """A movie: a seamless loop of a steady flow, or all times of one that varies.

    Parameters
    ----------
    scene, path, size
        As for :class:`Job`; the suffix of the file is the format. An MP4 gets even sides.
    seconds, fps, quality
        As for :func:`flowtex.movie`.
    **options
        Further arguments of :class:`Job`.
    """

    def __init__(
        self,
        scene: Scene,
        path: Path,
        size: tuple[int, int],
        *,
        seconds: float | None = None,
        fps: float | None = None,
        quality: int = DEFAULT_QUALITY,
        **options: Any,
    ) -> None:
        if Path(path).suffix.lower() == ".mp4":
            size = (max(size[0] // 2 * 2, 2), max(size[1] // 2 * 2, 2))
        super().__init__(scene, path, size, **options)
        if size[0] * size[1] > MOST_MOVIE_PIXELS:
            shown = f"the movie would be {size[0]} x {size[1]}"
            msg = f"{shown}; expected at most {MOST_MOVIE_PIXELS:,} pixels: choose a smaller size"
            raise MovieError(msg)
        fps = default_fps(path) if fps is None else fps
        check_movie(path, size, fps, quality)
        self._quality = quality
        settings = _moving(scene.handle.settings, scene.field)
        self._moments = frame_times(scene.field, settings, fps=fps, seconds=seconds)

    @property
    def moments(self) -> FrameTimes:
        """What its frames show."""
        return self._moments

    async def _make(self, scene: Scene) -> None:
        if scene.field.steady:
            motion = _moving(scene.handle.settings, scene.field).motion
            for pane in scene.panes:
                pane.handle.settings.update(motion=motion, period=self._moments.seconds)
        fps, count = self._moments.fps, len(self._moments)
        made = asyncio.ensure_future(
            self._aside(movie_writer, self.path, self._size, fps, self._quality)
        )
        try:
            writer = await asyncio.shield(made)
            sheet = self._sheet(scene)
            written: asyncio.Future[None] | None = None
            for number in range(count):
                await self._show(scene, number)
                picture = await self._draw(sheet, 0.95 * number / count, 0.95 / count)
                if written is not None:
                    await written
                # The next frame is drawn while this one is written.
                written = asyncio.ensure_future(self._aside(writer.add, picture))
                # Nobody waits for it where the drawing ends in an error.
                written.add_done_callback(lambda ended: ended.cancelled() or ended.exception())
            if written is not None:
                await written
            await self._aside(writer.finish, self._unwanted)
        finally:
            # In the thread, after whatever it is busy with.
            self.done = True
            await asyncio.wait([made])  # who cancels this may do so while it is being opened
            if not made.cancelled() and made.exception() is None:
                await asyncio.wrap_future(self._pool.submit(made.result().abandon))

    async def _show(self, scene: Scene, number: int) -> None:
        if scene.field.steady:
            scene.clock = self._moments.clocks[number]
            return
        scene.set_time(self._moments.times[number])
        await self._aside(trace_moment, scene)


def _moving(settings: Settings, field: FlowField) -> Settings:
    """Return settings with which a steady flow streams."""
    made = settings.copy()
    if field.steady and made.motion == "off":
        made.motion = "speed"
    return made


def _check(size: tuple[int, int], supersampling: int, density: float) -> None:
    width, height = size
    shown = f"the picture would be {width} x {height}"
    msg = ""
    if not (1 <= width <= LONGEST_SIDE and 1 <= height <= LONGEST_SIDE):
        msg = f"{shown}; expected 1 to {LONGEST_SIDE:,} pixels along each side"
    elif width * height > MOST_PIXELS:
        msg = f"{shown}; expected at most {MOST_PIXELS:,} pixels: choose a smaller size"
    elif supersampling not in range(1, MOST_SUPERSAMPLING + 1):
        msg = f"supersampling is {supersampling!r}; expected 1 to {MOST_SUPERSAMPLING}"
    elif not 1 / FINEST <= density <= FINEST:
        msg = f"density is {density!r}; expected {1 / FINEST:g} to {FINEST:g}, 1 for a screen"
    if msg:
        raise ExportError(msg)
