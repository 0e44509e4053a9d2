"""Which flow is shown: files, arrays, and planes of a mesh of three dimensions.

Reading and tracing go on in a thread. What is asked for next makes an end of what went before; a
large flow is first shown with few of its nodes, and the view on the page stands until there is
another to put in its place.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Any

import numpy as np

from flowtex._util.progress import Stopped
from flowtex.app.controllers.library import Choice, Library
from flowtex.app.controllers.part import Part
from flowtex.app.server.untrusted import clipped, name_among, shortened
from flowtex.app.streaming.wishes import Found, Wish
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.interpolation import steps_around
from flowtex.field.source import FlowSource
from flowtex.scene import coarsened_field
from flowtex.trace import SliceStore

__all__ = ["Data"]

_log = logging.getLogger(__name__)

#: A flow of more nodes than this is first shown with so many of them.
LARGE, FEW = 40_000, 8_000
#: The same for another part of the data that is shown: a slider redraws while it moves.
MANY, SOME = 5_000, 2_500
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
        self._wish = Wish(name, choice)
        self._whole = True
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
            there = self._goal == (self.name, wanted) or self._goal[0] != self.name
            if not there and self._whole:
                self.cancel()  # the slider has come back to what is shown
            elif not there:
                self.begin(self.name, wanted)
            else:
                self.state.set(**self._offers())
        elif (self.name, wanted) != self._goal:
            self.begin(self.name, wanted)

    def look_again(self) -> None:
        """Look through the folder for files that have come or gone."""
        self.state.set(files=list(self.library.names))

    def cancel(self) -> None:
        """Stop what is being opened; the old view stands."""
        self._wish.dropped = True
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
        if name == self._wish.name and then is None:
            self._wish.passed = True
        else:
            self._wish.dropped = True
        self._wish, self._goal = Wish(name, choice, then), (name, choice)
        self._opening = asyncio.ensure_future(self._open(self._wish))

    async def _open(self, wish: Wish) -> None:
        telling = asyncio.create_task(self._say(wish))
        try:
            many, few = (LARGE, FEW) if wish.name != self.name else (MANY, SOME)
            found = await wish.in_thread(
                self._worker, lambda: self._quick_look(wish, many, few), quick=True
            )
            self._show(found, wish)
            if not found.whole:
                field = found.field
                whole = lambda: replace(found, shown=field, store=self._trace(found, field))  # noqa: E731
                self._show(await wish.in_thread(self._worker, whole, quick=False), wish)
            if wish.then is not None and not wish.over:
                wish.then()
        except Stopped:
            pass
        except (FieldError, OSError) as error:
            self._give_up(error, wish)
        except Exception as error:
            _log.exception("%s could not be opened", shortened(wish.name, 80))
            words = f"{shortened(wish.name, 80)} could not be opened"
            self._give_up(f"{words}: {str(error) or type(error).__name__}", wish)
        finally:
            telling.cancel()
            if not wish.over:
                self.state.send(busy="")

    def _give_up(self, problem: Any, wish: Wish) -> None:
        """Say why there is nothing else to show; the old view stands."""
        if not wish.over:
            self.app.complain(_without_folder(str(problem), wish.name))
            self._goal = (self.name, self.choice)
            self._show_choice()
            if not self._whole:  # only a quick look at it was there, on the way
                self.begin(self.name, self.choice)

    def _quick_look(self, wish: Wish, many: int, few: int) -> Found:
        """Read a flow, and trace what there is time for."""
        source, field, choice = self._read(wish.name, wish.choice)
        shown = coarsened_field(field, few) if field.valid.size > many else field
        found = Found(wish.name, choice, source, field, shown)
        return replace(found, store=self._trace(found, shown))

    def _read(self, name: str, choice: Choice) -> tuple[FlowSource, FlowField, Choice]:
        choice = self.library.complete(name, choice)
        return self.library.source(name), self.library.field(name, choice), choice

    def _trace(self, found: Found, field: FlowField) -> SliceStore | None:
        name = found.name if field is found.field else ""
        store = self.library.trace(name, found.choice, field, self.area.settings).store
        # The time that is shown stays where another part of the same data is.
        if store is not None and np.array_equal(field.times, self.scene.field.times):
            for step in sorted(set(steps_around(field.times, self.scene.handle.time)[:2])):
                store.at(step)
        return store

    def _show(self, found: Found, wish: Wish) -> None:
        """Put another flow in the place of the one that is shown; where that fails, it stands."""
        before = (self._store, self.name, self.choice, self._source, self._whole, self._goal)
        now, then = found.choice, self.choice
        same = (found.name, now.block, now.vectors) == (self.name, then.block, then.vectors)
        keep = same and now.plane[:1] == then.plane[:1]
        self._store, self.name, self.choice = found.store, found.name, now
        self._source, self._whole = found.source, found.whole
        if not wish.passed:
            self._goal = (found.name, now)
        try:
            self.app.show(found.shown, keep_view=keep, keep_range=same)
            if not keep:
                self.scene.home(*self.library.look(found.name))
                self.area.stream.moved()
        except BaseException:
            self._store, self.name, self.choice, self._source, self._whole, self._goal = before
            raise

    async def _say(self, wish: Wish) -> None:
        """Tell the page what goes on, once it has gone on for a moment."""
        await asyncio.sleep(PATIENCE)
        if not wish.over:
            self.state.send(busy=f"Opening {shortened(wish.name, 80)}")

    def refresh(self) -> None:
        """Follow another flow that is shown."""
        self._show_choice()

    def _show_choice(self) -> None:
        """Let the page show what is chosen; not while it has gone on to something else."""
        said = {"file": self.name, **self._offers()}
        if self._goal != (self.name, self.choice):
            said = {name: said[name] for name in ("name", "about")}
        self.state.send(busy="", **said)

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
        self._wish.dropped = True
        if self._opening is not None:
            self._opening.cancel()
        self._worker.shutdown(wait=False, cancel_futures=True)


def _without_folder(problem: str, name: str) -> str:
    """Leave out where the file lies: that is the server's own affair."""
    last = name.rsplit("/", 1)[-1]
    at = problem.find(f"/{last}:")
    return problem if at < 0 or ":" in problem[:at] else problem[at + 1 :]


def about(field: FlowField) -> str:
    """Say in a few words what a field is."""
    rows, columns = field.shape
    words = [f"{columns} × {rows} nodes"]
    words.append("steady" if field.steady else f"{len(field.times)} times")
    closed = [axis for axis, is_closed in zip("ji", field.periodic, strict=True) if is_closed]
    if closed:
        words.append(f"periodic along {' and '.join(sorted(closed))}")
    return " · ".join(words)
