"""Which flow is shown: files, arrays, and planes of a mesh of three dimensions.

Reading and tracing go on in a thread. What is asked for next makes an end of what went before; a
large flow is first shown with few of its nodes, and the view on the page stands until there is
another to put in its place.
"""

from __future__ import annotations

import asyncio
import logging
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from flowtex.app.library import Choice, Library
from flowtex.app.part import Part
from flowtex.app.untrusted import clipped, name_among, shortened
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.reading import moment
from flowtex.field.source import FlowSource
from flowtex.progress import Stopped, stoppable
from flowtex.staging import coarsened
from flowtex.trace import SliceStore

__all__ = ["Data"]

_log = logging.getLogger(__name__)

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
        # Kept here: the library may let go of it, and to read it again takes a while.
        self._source = library.source(name)
        self._goal = (name, choice)
        self._store: SliceStore | None = None
        self._wanted = threading.Event()
        self._worker = ThreadPoolExecutor(1, thread_name_prefix="flowtex opening")
        self._opening: asyncio.Task[None] | None = None

    @property
    def python(self) -> str | None:
        """Expression that makes what is shown, unless that comes from a file."""
        return self.library.python(self.name)

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
        if wanted == self.name:
            if self._goal[0] != self.name:  # the person has come back
                self.cancel()
        elif not isinstance(wanted, str):
            self._show_choice()
        elif wanted != self._goal[0]:
            self.begin(wanted, Choice())

    def take_choice(self) -> None:
        """Show another array or plane of the same file."""
        wanted = self._asked()
        if wanted == self.choice:
            if self._goal != (self.name, wanted) and self._goal[0] == self.name:
                self.cancel()  # the slider has come back to what is shown
            else:
                self.state.set(**self._offers())
        elif (self.name, wanted) != self._goal:
            self.begin(self.name, wanted)

    def look_again(self) -> None:
        """Look through the folder for files that have come or gone."""
        self.state.set(files=list(self.library.names))

    def cancel(self) -> None:
        """Stop what is being opened; the old view stands."""
        self._wanted.set()
        self._goal = (self.name, self.choice)
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
        self._goal = (name, choice)
        self._opening = asyncio.ensure_future(self._open(name, choice, unwanted, then))

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
        except (FieldError, OSError) as error:
            self._give_up(error, unwanted)
        except Exception as error:
            _log.exception("%s could not be opened", name)
            words = shortened(name, 80)
            self._give_up(f"{words} could not be opened: {error!r}", unwanted)
        finally:
            telling.cancel()
            if not unwanted.is_set():
                self.state.send(busy="")

    def _give_up(self, problem: Any, unwanted: threading.Event) -> None:
        """Say why there is nothing else to show; the old view stands."""
        if not unwanted.is_set():
            self.app.complain(problem)
            self._goal = (self.name, self.choice)
            self._show_choice()

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
        store = self.library.trace(name, choice, field, self.area.settings).store
        # The time that is shown stays where another part of the same data is.
        if store is not None and np.array_equal(field.times, self.scene.field.times):
            for step in sorted(set(moment(field.times, self.scene.handle.time)[:2])):
                store.at(step)
        return store

    def _show(self, field: FlowField, store: SliceStore | None, name: str, choice: Choice) -> None:
        """Put another flow in the place of the one that is shown; where that fails, it stands."""
        before = (self._store, self.name, self.choice, self._source)
        same = name == self.name and choice.block == self.choice.block
        same = same and choice.vectors == self.choice.vectors
        keep = same and choice.plane[:1] == self.choice.plane[:1]
        self._store, self.name, self.choice = store, name, choice
        try:
            self._source = self.library.source(name) if name != before[1] else self._source
            self.app.show(field, keep_view=keep, keep_range=same)
        except BaseException:
            self._store, self.name, self.choice, self._source = before
            raise
        self._goal = (name, choice)

    async def _say(self, name: str, unwanted: threading.Event) -> None:
        """Tell the page what goes on, once it has gone on for a moment."""
        await asyncio.sleep(PATIENCE)
        if not unwanted.is_set():
            self.state.send(busy=f"Opening {shortened(name, 80)}")

    def refresh(self) -> None:
        """Follow another flow that is shown."""
        self._show_choice()

    def _show_choice(self) -> None:
        """Let the page show what is chosen."""
        self.state.send(busy="", file=self.name, **self._offers())

    def _asked(self) -> Choice:
        """Return what the page asks for; where it asks for nothing that is there, what is shown."""
        offers = self._offers()
        block, vectors, axis = (
            self.state.get(one) if name_among(self.state.get(one), offers[all_]) else offers[one]
            for one, all_ in (("block", "blocks"), ("vectors", "vectors_choices"), ("axis", "axes"))
        )
        if block != offers["block"]:  # its planes, and its arrays, are others
            known = self._source.part(block).vectors
            return Choice(vectors if vectors in known else "", "", block)
        plane = ""
        if axis:
            last = self._part.planes[axis] - 1
            at = int(clipped(self.state.get("index"), offers["index"], 0, last))
            plane = f"{axis}={at if axis == offers['axis'] else (last + 1) // 2}"
        return Choice(vectors, plane, block)

    @property
    def _part(self) -> FlowSource:
        """The source of the block that is shown."""
        return self._source.part(self.choice.block or None)

    def _offers(self) -> dict[str, Any]:
        """Return what there is to choose from in the present file, and what is chosen."""
        source, part = self._source, self._part
        axis = self.choice.plane[:1] if part.planes else ""
        count = part.planes.get(axis, 0)
        field = self.scene.field
        return {
            "name": (field.name or source.name).replace("_", " ") or "flow",
            "about": about(field),
            "vectors_choices": list(part.vectors) if len(part.vectors) > 1 else [],
            "vectors": self.choice.vectors or (part.vectors[0] if part.vectors else ""),
            "blocks": list(source.blocks),
            "block": self.choice.block or (source.blocks[0] if source.blocks else ""),
            "axes": list(part.planes),
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
