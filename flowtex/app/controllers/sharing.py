"""Exports of a page: pictures, movies, a link to the state, and lines of Python."""

from __future__ import annotations

import asyncio
import logging
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

from flowtex._util.progress import Stopped
from flowtex.app.controllers.context import Context, Controller, State
from flowtex.app.controllers.data import Data, FileBeside
from flowtex.app.controllers.export_jobs import ExportError, Job, MovieJob, PictureJob
from flowtex.app.controllers.serialization import from_link, to_link, to_python
from flowtex.app.server.files import Downloads
from flowtex.app.server.validation import number
from flowtex.errors import FieldError

#: Formats of files to save.
FORMATS = ("PNG", "MP4", "GIF")
#: Seconds between two reports of how far a job is.
PROGRESS_INTERVAL_S = 0.15
#: Names of numbers of the page in messages.
LABELS = {
    "out_width": "the width",
    "out_height": "the height",
    "out_density": "the fineness",
    "out_seconds": "the length in seconds",
    "out_fps": "the pictures per second",
}

_log = logging.getLogger(__name__)


class Sharing(Controller):
    """Exports of a page; ``restore_state`` is called with the state of a link."""

    def __init__(
        self,
        context: Context,
        data: Data,
        beside: FileBeside,
        restore_state: Callable[[State], None],
    ) -> None:
        super().__init__(context)
        self.downloads = Downloads(context.routes)
        self._data, self._beside, self._restore_state = data, beside, restore_state
        self._job: Job | None = None
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
        self.cancel()
        try:
            job = self._new_job()
        except (FieldError, ModuleNotFoundError, OSError) as error:
            self.context.complain(error)
            return
        self._job = job
        if isinstance(job, MovieJob) and job.notice:
            self.context.complain(job.notice)
        self.state.set(out_progress=0.0, out_file=None)
        self._task = asyncio.create_task(self._run(job, self._task))

    def cancel(self) -> None:
        """Cancel the export."""
        if self._job is not None:
            self._job.cancel()
        self._job = None
        self.state.set(out_progress=None)

    def _new_job(self) -> Job:
        get = self.state.get
        kind = get("out_format")
        if kind not in FORMATS:
            msg = f"the format is {kind!r}; expected {', '.join(FORMATS)}"
            raise ExportError(msg)
        path = self.downloads.reserve(f"{self.viewport.field.name or 'flow'}.{kind.lower()}")
        try:
            size = (int(self._number("out_width")), int(self._number("out_height")))
            options: dict[str, Any] = {
                "supersampling": 2 if get("out_smooth") else 1,
                "density": self._number("out_density"),
                "annotations": bool(get("out_annotations")),
            }
            if kind == "PNG":
                return PictureJob(self.viewport, path, size, **options)
            options |= {"seconds": self._number("out_seconds"), "fps": self._number("out_fps")}
            return MovieJob(self.viewport, path, size, **options)
        except BaseException:
            shutil.rmtree(path.parent, ignore_errors=True)
            raise

    def _number(self, name: str) -> float:
        value = self.state.get(name)
        checked = number(value)
        if checked is None:
            msg = f"{LABELS[name]} is {value!r}; expected a number"
            raise ExportError(msg)
        return checked

    async def _run(self, job: Job, before: asyncio.Task[None] | None) -> None:
        if before is not None:
            # It was cancelled, and its window is closed before another one is opened.
            await asyncio.wait([before])
        if job.cancelled:
            shutil.rmtree(job.path.parent, ignore_errors=True)
            return
        reporting = asyncio.create_task(self._report_progress(job))
        path: Path | None = None
        try:
            path = await job.run()
        except Stopped:
            return
        except Exception as error:
            if not isinstance(error, (FieldError, OSError)):
                _log.exception("%s could not be made", job.path.name)
            self.context.complain(
                f"{job.path.name} could not be made: {str(error) or type(error).__name__}"
            )
            return
        finally:
            reporting.cancel()
            if path is None:
                shutil.rmtree(job.path.parent, ignore_errors=True)
            if job is self._job:
                self._job = None
                self.state.send(out_progress=None)
        self.state.send(out_file={"name": path.name, "url": self.downloads.add(path)})

    async def _report_progress(self, job: Job) -> None:
        while job is self._job:
            self.state.send(out_progress=round(100 * job.progress, 1))
            await asyncio.sleep(PROGRESS_INTERVAL_S)

    def present_state(self) -> dict[str, Any]:
        """Return the state of the page, named as in :mod:`.serialization`."""
        state: dict[str, Any] = {}
        for controller in self.context.controllers:
            state |= controller.describe()
        return state

    def show_state(self) -> None:
        """Show the link and the lines of Python on the page."""
        state, beside = self.present_state(), self._beside.name
        python = self.context.library.python
        self.state.set(
            link="#" + to_link(state),
            python=to_python(
                state,
                source=python(self._data.name),
                source_beside=python(beside) if beside else None,
                size=self.viewport.size,
            ),
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
        if self._job is not None:
            self._job.cancel()
        if self._task is not None:
            self._task.cancel()
        self.downloads.close()
