"""Which flow is shown: files, arrays, and planes of a mesh of three dimensions.

Reading and tracing go on in a thread. What is asked for next makes an end of what went before; a
large flow is first shown with few of its nodes, and the view on the page stands until there is
another to put in its place.
"""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from flowtex.app.library import Choice, Library
from flowtex.app.part import Part
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.progress import Stopped, stoppable
from flowtex.staging import coarsened
from flowtex.trace import SliceStore

__all__ = ["Data"]

#: A flow of more nodes than this is first shown with so many of them.
LARGE, FEW = 40_000, 8_000
#: Seconds after which the page says that something is being made.
PATIENCE = 0.3


class Data(Part):
    """Which flow is shown.

    Parameters
    ----------
    app
        The application.
    library
        What may be opened.
    name, choice
        What is shown first.
    """

    def __init__(self, app: Any, library: Library, name: str, choice: Choice) -> None:
        super().__init__(app)
        self.library = library
        self.name = name
        self.choice = choice
        self._store: SliceStore | None = None
        self._wanted = threading.Event()
        self._worker = ThreadPoolExecutor(1, thread_name_prefix="flowtex opening")
        self._opening: asyncio.Task[None] | None = None

    @property
    def from_file(self) -> bool:
        """Whether what is shown comes from a file that has a name."""
        return self.library.is_file(self.name)

    def values(self) -> dict[str, Any]:
        """Return what the page begins with."""
        return {"busy": "", "files": list(self.library.names), "file": self.name, **self._offers()}

    def watch(self) -> None:
        """Listen to the page."""
        self.state.on("file")(self.take_file)
        self.state.on("vectors", "block", "axis", "index")(self.take_choice)

    def take_file(self) -> None:
        """Open another file."""
        wanted = self.state.get("file")
        if wanted != self.name:
            self.begin(str(wanted), Choice())

    def take_choice(self) -> None:
        """Show another array or plane of the same file."""
        wanted = self._asked()
        if wanted != self.choice:
            self.begin(self.name, wanted)

    def look_again(self) -> None:
        """Look through the folder for files that have come or gone."""
        self.state.set(files=list(self.library.names))

    def cancel(self) -> None:
        """Stop what is being opened; the old view stands."""
        self._wanted.set()
        self._show_choice()

    def begin(self, name: str, choice: Choice, then: Callable[[], None] | None = None) -> None:
        """Open something, in place of what is being opened.

        Parameters
        ----------
        name, choice
            What to open.
        then
            Called once it is shown.
        """
        self._wanted.set()
        self._wanted = unwanted = threading.Event()
        self._opening = asyncio.ensure_future(self._open(name, choice, unwanted, then))
        self._opening.add_done_callback(_tell_failure)

    async def _open(
        self,
        name: str,
        choice: Choice,
        unwanted: threading.Event,
        then: Callable[[], None] | None,
    ) -> None:
        telling = asyncio.create_task(self._say(name, unwanted))
        try:
            field, choice = await self._in_thread(unwanted, lambda: self._read(name, choice))
            if field.valid.size > LARGE:
                few = coarsened(field, FEW)
                quick = await self._in_thread(unwanted, lambda: self._trace("", choice, few))
                self._show(few, quick, name, choice)
            store = await self._in_thread(unwanted, lambda: self._trace(name, choice, field))
            self._show(field, store, name, choice)
            if then is not None:
                then()
        except Stopped:
            pass
        except FieldError as error:
            if not unwanted.is_set():
                self.app.complain(error)
                self._show_choice()
        finally:
            telling.cancel()
            if not unwanted.is_set():
                self.state.send(busy="")

    async def _in_thread(self, unwanted: threading.Event, work: Callable[[], Any]) -> Any:
        """Do some work off the event loop, unless nobody wants it any more."""

        def guarded() -> Any:
            with stoppable(unwanted.is_set):
                if unwanted.is_set():
                    raise Stopped
                return work()

        made = await asyncio.get_running_loop().run_in_executor(self._worker, guarded)
        if unwanted.is_set():
            raise Stopped
        return made

    def _read(self, name: str, choice: Choice) -> tuple[FlowField, Choice]:
        choice = self.library.complete(name, choice)
        return self.library.field(name, choice), choice

    def _trace(self, name: str, choice: Choice, field: FlowField) -> SliceStore | None:
        return self.library.trace(name, choice, field, self.area.settings).store

    def _show(self, field: FlowField, store: SliceStore | None, name: str, choice: Choice) -> None:
        same = name == self.name
        of_plane = same and choice.vectors == self.choice.vectors
        keep = of_plane and choice.plane[:1] == self.choice.plane[:1]
        self._store, self.name, self.choice = store, name, choice
        self.app.show(field, keep_view=keep)

    async def _say(self, name: str, unwanted: threading.Event) -> None:
        """Tell the page what goes on, once it has gone on for a moment."""
        await asyncio.sleep(PATIENCE)
        if not unwanted.is_set():
            self.state.send(busy=f"Tracing {name}")

    def refresh(self) -> None:
        """Follow another flow that is shown."""
        self._show_choice()

    def _show_choice(self) -> None:
        """Let the page show what is chosen."""
        self.state.send(busy="", file=self.name, **self._offers())

    def _asked(self) -> Choice:
        axis, index = self.state.get("axis"), self.state.get("index")
        planes = self.library.source(self.name).planes
        plane = ""
        if axis in planes:
            moved = axis != self.choice.plane[:1]
            at = planes[axis] // 2 if moved else min(max(int(index or 0), 0), planes[axis] - 1)
            plane = f"{axis}={at}"
        return Choice(self.state.get("vectors") or "", plane, self.state.get("block") or "")

    def _offers(self) -> dict[str, Any]:
        """Return what there is to choose from in the present file, and what is chosen."""
        source = self.library.source(self.name)
        axis = self.choice.plane[:1]
        count = source.planes.get(axis, 0)
        field = self.scene.field
        return {
            "name": (field.name or source.name).replace("_", " ") or "flow",
            "about": about(field),
            "vectors_choices": list(source.vectors) if len(source.vectors) > 1 else [],
            "vectors": self.choice.vectors or (source.vectors[0] if source.vectors else ""),
            "blocks": list(source.blocks),
            "block": self.choice.block or (source.blocks[0] if source.blocks else ""),
            "axes": list(source.planes),
            "axis": axis,
            "index": int(self.choice.plane[2:] or 0) if count else 0,
            "planes": max(count - 1, 0),
        }

    def describe(self) -> dict[str, Any]:
        """Return what a link needs to know."""
        chosen = {
            "file": self.name,
            "vectors": self.choice.vectors,
            "plane": self.choice.plane,
            "block": self.choice.block,
        }
        return {name: value for name, value in chosen.items() if value}

    def close(self) -> None:
        """End what goes on."""
        self._wanted.set()
        if self._opening is not None:
            self._opening.cancel()
        self._worker.shutdown(wait=False, cancel_futures=True)


def about(field: FlowField) -> str:
    """Say in a few words what a field is."""
    rows, columns = field.shape
    words = [f"{columns} × {rows} nodes"]
    words.append("steady" if field.steady else f"{len(field.times)} times")
    closed = [axis for axis, is_closed in zip("ji", field.periodic, strict=True) if is_closed]
    if closed:
        words.append(f"periodic along {' and '.join(sorted(closed))}")
    return " · ".join(words)


def _tell_failure(task: asyncio.Task[None]) -> None:
    """Let an error that nobody waits for be seen."""
    if not task.cancelled():
        task.exception()
