"""Another file in a second pane: opened aside, and followed as the first pane changes."""

from __future__ import annotations

import asyncio
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, astuple
from typing import Any

from flowtex.app.controllers.context import Context, Controller, LoadRequest, State, announced
from flowtex.app.controllers.data import Data
from flowtex.app.controllers.library import Choice, TracedFlow
from flowtex.errors import FieldError
from flowtex.field.interpolation import steps_around


class FileBeside(Controller):
    """The flow of another file than ``data`` shows, in a second pane.

    It shows the same part of its file as the first pane does, as far as that exists.
    """

    def __init__(self, context: Context, data: Data) -> None:
        super().__init__(context)
        self._data = data
        self._name, self._choice = "", Choice()
        self._active = False
        #: What was requested last, and the flow that is shown, whose traces stay with it.
        self._request: LoadRequest | None = None
        self._flow: TracedFlow | None = None
        self._opening: asyncio.Task[None] | None = None
        self._worker = ThreadPoolExecutor(1, thread_name_prefix="flowtex opening beside")
        self.state.set(file_beside="")
        self.state.on("file_beside")(self.take_file)
        context.field_changed.connect(self.follow)

    @property
    def name(self) -> str:
        """Name of the file in the second pane; empty without one."""
        return self._name if "field" in self.viewport.differences else ""

    @property
    def possible(self) -> bool:
        """Whether another file exists."""
        return len(self._data.names) > 1

    @property
    def python(self) -> str | None:
        """Expression that makes the flow, unless that comes from a file."""
        return self.context.library.python(self.name) if self.name else None

    def begin(self) -> None:
        """Show the file that was chosen last, or the next one of the list."""
        self._active = True
        self.open(self._chosen() or self._next())

    def end(self) -> None:
        """Forget the file, after another second pane or none has replaced it."""
        self._active = False
        self._forget()
        self.context.beside_changed.emit()

    def cancel(self) -> None:
        """Stop opening; one pane is shown until a file is chosen."""
        if self._opening is not None and not self._opening.done():
            self._fail()

    def take_file(self) -> None:
        """Show the file that the page requests."""
        name, goal = self._chosen(), self._goal
        if not name:
            self.state.set(file_beside=goal)
        elif self._active and name != goal:
            self.open(name)

    def open(self, name: str) -> None:
        """Open a file for the second pane, instead of the one being opened."""
        if self._request is not None and name == self._request.name:
            self._request.superseded = True
        elif self._request is not None:
            self._request.cancelled = True
        self._request = LoadRequest(name, self._data.choice)
        self.state.set(file_beside=name)
        self._opening = asyncio.ensure_future(self._open(self._request))

    def follow(self) -> None:
        """Follow the first pane to another plane, array or file."""
        if self._goal and self._goal == self._data.name:  # which is in the first pane now
            self.open(self._next())
        elif self._request is not None and self._request.choice != self._data.choice:
            self.open(self._goal)
        self.show_names()

    def show_names(self) -> None:
        """Show the names of the two files on the page."""
        self.area.element.names = self._names() if self.name else ()
        self.area.element.follow()

    def _names(self) -> tuple[str, ...]:
        """Return the names of the two files; that of the second with its differing parts."""
        pairs = zip(astuple(self._choice), astuple(self._data.choice), strict=True)
        differing = [part for part, first in pairs if part != first]
        return (self._data.name, " · ".join([self._name, *filter(None, differing)]))

    def describe(self) -> State:
        """Return the file, and the part of it that is shown."""
        if not self.name:
            return {"beside_file": self._goal} if self._goal else {}
        handle = self.viewport.panes[1].handle
        beside: dict[str, Any] = {**asdict(self._choice), "time": None}
        if not handle.field.steady:
            beside["time"] = handle.time
        if handle.scene.scalar_name != self.area.scene.scalar_name:
            beside["scalars"] = handle.scene.scalar_name
        return {"beside_file": self.name, "beside": beside}

    def restore(self, saved: State) -> None:
        """Choose the file of a saved state."""
        if saved.get("beside_file"):
            self.state.set(file_beside=saved["beside_file"])
            self.take_file()

    def close(self) -> None:
        """End running tasks."""
        self._forget()
        if self._opening is not None:
            self._opening.cancel()
        self._worker.shutdown(wait=False, cancel_futures=True)

    @property
    def _goal(self) -> str:
        """Name of the requested file."""
        return "" if self._request is None else self._request.name

    def _chosen(self) -> str:
        """Return the requested name, which may not exist; empty for an invalid one."""
        name = self.state.get("file_beside")
        return name if isinstance(name, str) and name != self._data.name else ""

    def _next(self) -> str:
        """Return the name after that of the first pane, cyclically."""
        names = self._data.names
        position = names.index(self._data.name) if self._data.name in names else -1
        return names[(position + 1) % len(names)]

    async def _open(self, request: LoadRequest) -> None:
        async with announced(self.context, request, self._fail):
            choice, flow = await request.in_thread(
                self._worker, lambda: self._read(request), quick=True
            )
            self._show(request, choice, flow)

    def _read(self, request: LoadRequest) -> tuple[Choice, TracedFlow]:
        """Read a flow, and make the traces for its first picture."""
        library, name = self.context.library, request.name
        choice = library.nearest(name, request.choice)
        field = library.field(name, choice)
        flow = library.trace(name, choice, field, self.settings)
        for step in sorted(set(steps_around(field.times, self.viewport.time_in(field))[:2])):
            flow.store.at(step)
        return choice, flow

    def _show(self, request: LoadRequest, choice: Choice, flow: TracedFlow) -> None:
        """Show a flow in the second pane."""
        units = [field.length_unit for field in (self.viewport.field, flow.field)]
        if all(units) and units[0] != units[1]:
            msg = (
                f"{request.name} is in {units[1]} and {self._data.name} in {units[0]}; expected "
                "the same unit of length in both files, because they share one camera"
            )
            raise FieldError(msg)
        self._name, self._choice, self._flow = request.name, choice, flow
        self.area.element.names = self._names()
        if self.viewport.differences.get("field") is not flow.field:
            self.area.compare({"field": flow.field})
        self.context.beside_changed.emit()
        self.show_names()

    def _fail(self) -> None:
        """Show one pane, until another file is chosen."""
        self._forget()
        self.area.compare(None)
        self.context.beside_changed.emit()
        self.state.send(file_beside="", busy="")

    def _forget(self) -> None:
        if self._request is not None:
            self._request.cancelled = True
        self._request = self._flow = None
        self._name = ""
        self.show_names()
