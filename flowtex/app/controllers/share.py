"""What leaves the page: pictures, movies, a link to the present state, and the lines of Python."""

from __future__ import annotations

import asyncio
import logging
import shutil
from contextlib import suppress
from pathlib import Path
from typing import Any

from flowtex._util.progress import Stopped
from flowtex.app.controllers.exports import ExportError, Job, MovieJob, PictureJob
from flowtex.app.controllers.links import from_link, to_link
from flowtex.app.controllers.part import Part
from flowtex.app.controllers.python_lines import to_python
from flowtex.app.server.downloads import Downloads
from flowtex.app.server.routes import Content, Routes
from flowtex.app.server.untrusted import number
from flowtex.offscreen.encoders import MovieError

__all__ = ["FORMATS", "Share"]

#: What can be saved.
FORMATS = ("PNG", "MP4", "GIF")
#: Seconds between two looks at how far a job is.
LOOK = 0.15
#: What numbers of the page are called when they are of no use.
WORDS = {
    "out_width": "the width",
    "out_height": "the height",
    "out_density": "the fineness",
    "out_seconds": "the length in seconds",
    "out_fps": "the pictures in a second",
}

_log = logging.getLogger(__name__)


class Share(Part):
    """What leaves the page.

    Parameters
    ----------
    app
        The application.
    """

    def __init__(self, app: Any) -> None:
        super().__init__(app)
        self.downloads = Downloads()
        self._routes = Routes.of(app.server)
        self._job: Job | None = None
        self._task: asyncio.Task[None] | None = None

    def values(self) -> dict[str, Any]:
        """Return what the page begins with."""
        return {
            "out_format": FORMATS[0],
            "out_width": 1920,
            "out_height": 1080,
            "out_density": 1.0,
            "out_smooth": True,
            "out_seconds": 4.0,
            "out_fps": 30.0,
            "out_progress": None,
            "out_file": None,
            "link": "",
            "python": "",
        }

    def refresh(self) -> None:
        """Follow another flow that is shown."""
        self.cancel()

    def begin(self) -> None:
        """Make what the page asks for."""
        self.cancel()
        try:
            job = self._made()
        except (ExportError, MovieError, ModuleNotFoundError, OSError) as error:
            self.app.complain(error)
            return
        self._job = job
        self.state.set(out_progress=0.0, out_file=None)
        self._task = asyncio.create_task(self._run(job, self._task))

    def cancel(self) -> None:
        """Make no more of it."""
        if self._job is not None:
            self._job.cancel()
        self._job = None
        self.state.set(out_progress=None)

    def _made(self) -> Job:
        get = self.state.get
        kind = get("out_format")
        if kind not in FORMATS:
            msg = f"the format is {kind!r}; expected {', '.join(FORMATS)}"
            raise ExportError(msg)
        path = self.downloads.place(f"{self.scene.field.name or 'flow'}.{kind.lower()}")
        try:
            return self._job_of(kind, path)
        except BaseException:
            _forget(path)
            raise

    def _job_of(self, kind: str, path: Path) -> Job:
        size = (int(self._number("out_width")), int(self._number("out_height")))
        options: dict[str, Any] = {
            "supersampling": 2 if self.state.get("out_smooth") else 1,
            "density": self._number("out_density"),
            "busy": self._busy,
        }
        if kind == "PNG":
            return PictureJob(self.scene, path, size, **options)
        seconds, fps = self._number("out_seconds"), self._number("out_fps")
        return MovieJob(self.scene, path, size, seconds=seconds, fps=fps, **options)

    def _number(self, name: str) -> float:
        value = self.state.get(name)
        found = number(value)
        if found is None:
            msg = f"{WORDS[name]} is {value!r}; expected a number"
            raise ExportError(msg)
        return found

    def _busy(self) -> bool:
        """Whether the view needs the time more."""
        return not self.area.stream.paused and self.app.moves.moving

    async def _run(self, job: Job, before: asyncio.Task[None] | None) -> None:
        if before is not None:
            # It was cancelled, and its window goes before there is another one.
            await asyncio.wait([before])
        if job.cancelled:
            _forget(job.path)
            return
        telling = asyncio.create_task(self._tell(job))
        path: Path | None = None
        try:
            path = await job.run()
        except Stopped:
            return
        except Exception as error:
            if not isinstance(error, (ExportError, MovieError, OSError)):
                _log.exception("%s could not be made", job.path.name)
            self.app.complain(
                f"{job.path.name} could not be made: {str(error) or type(error).__name__}"
            )
            return
        finally:
            telling.cancel()
            if path is None:
                _forget(job.path)
            if job is self._job:
                self._job = None
                self.state.send(out_progress=None)
        token = self.downloads.add(path, path.name)
        self.state.send(
            out_file={"name": path.name, "url": self._routes.give(token, self._giver(token))}
        )

    def _giver(self, token: str) -> Any:
        def content() -> Content:
            found = self.downloads.get(token)
            if found is None:
                return b"This file is not there any more.", "text/plain", None
            return found.path, found.headers["Content-Type"], found.name

        return content

    async def _tell(self, job: Job) -> None:
        """Tell the page how far the job is."""
        while job is self._job:
            self.state.send(out_progress=round(100 * job.progress, 1))
            await asyncio.sleep(LOOK)

    def present(self) -> dict[str, Any]:
        """Return the state of the page as a link has it."""
        said: dict[str, Any] = {}
        for part in self.app.parts:
            said |= part.describe()
        return said

    def show_state(self) -> None:
        """Let the page show the link and the lines of Python."""
        said = self.present()
        source = self.app.data.python
        self.state.set(
            link="#" + to_link(said),
            python=to_python(said, source=source, size=self.scene.size),
        )

    def take_link(self, text: Any) -> None:
        """Show the state that the page's address holds."""
        faults: list[str] = []
        said = from_link(str(text)[:10_000], faults)
        if faults:
            self.app.complain("; ".join(faults))
        if said:
            self.app.restore(said)

    def close(self) -> None:
        """End what goes on."""
        if self._job is not None:
            self._job.cancel()
        if self._task is not None:
            self._task.cancel()
        self.downloads.close()


def _forget(path: Path) -> None:
    """Remove the folder that was made for a file that is not there."""
    with suppress(OSError):
        shutil.rmtree(path.parent)
