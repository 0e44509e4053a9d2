"""Choice of the flow: files, arrays, and planes of a mesh of three dimensions.

Reading and tracing continue in a thread. A new request cancels the one before, and the view on the
page stays until another one can replace it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, astuple
from functools import partial
from pathlib import Path
from typing import Any

from flowtex.app.controllers.context import (
    Context,
    FlowOpener,
    LoadedFlow,
    LoadRequest,
    State,
    without_folder,
)
from flowtex.app.controllers.library import Choice
from flowtex.app.server.files import Uploads
from flowtex.app.server.page import clipped, name_among
from flowtex.app.streaming.viewport import first_time, time_in
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.formula.make import is_line, same_formula, with_parameter
from flowtex.remedies import for_page
from flowtex.sources.open_source import FlowSource


class Data(FlowOpener):
    """Choice of the flow, initially by ``name`` and ``choice``."""

    names: tuple[str, ...]  #: Names of the flows that may be opened, when last listed.

    def __init__(self, context: Context, name: str, choice: Choice) -> None:
        super().__init__(context)
        self._current = LoadedFlow(name, choice, self.library.source(name), self.viewport.field)
        self._goal = (name, choice)
        self.uploads = Uploads(context.routes, self.take_upload)
        self.state.set(busy="", file=name, upload=self.uploads.address, **self._options())
        self.list_files()
        self.state.on(self.take_file, "file")
        self.state.on(self.take_choice, "vectors", "block", "axis", "index")
        context.field_changed.connect(self._show_choice)
        self.stream.data_failed.connect(
            lambda error: context.complain(without_folder(str(error), self.name))
        )
        context.area.parameter_asked.connect(self.take_parameter)

    @property
    def name(self) -> str:
        """Name of the file that is shown."""
        return self._current.name

    @property
    def choice(self) -> Choice:
        """The part of the file that is shown."""
        return self._current.choice

    def take_file(self) -> None:
        """Open another file."""
        name = self.state.get("file")
        if not isinstance(name, str):
            self._show_choice()
        elif name != self._goal[0]:
            if name == self.name:  # back to the present file
                self.cancel()
            else:
                self.open(name, Choice())

    def take_parameter(self, name: str, value: float) -> None:
        """Show a formula with another value of a parameter."""
        line = with_parameter(self._goal[0], self._current.field, name, value)
        if line != self._goal[0] and self.library.typed:
            self.open(line, Choice())

    def take_choice(self) -> None:
        """Show another array or plane of the same file."""
        choice = self._requested()
        if choice != self.choice:
            if (self.name, choice) != self._goal:
                self.open(self.name, choice)
        elif self._goal == (self.name, choice) or self._goal[0] != self.name:
            self.state.set(**self._options())
        else:
            self.cancel()  # the slider is back at the present plane

    def list_files(self) -> None:
        """Look through the folder for files that have come or gone."""
        names = self.library.names
        reasons = self.library.unshown
        self.names = tuple(name for name in names if name not in reasons)
        unshown = []
        for name, why in reasons.items():
            unshown.append({"name": name, "why": why, "final": not self.library.may_open(name)})
        self.state.set(files=list(self.names), unshown=unshown)

    def take_upload(self, name: str, path: Path) -> None:
        """Open a file that the page has sent."""
        name = self.library.add(name, path)
        self.list_files()
        self.open(name, Choice())

    def reload(self) -> None:
        """Read the present file again."""
        self.open(self.name, self.choice)

    def cancel(self) -> None:
        """Stop opening; the old view stays."""
        if self._request is not None:
            self._request.cancelled = True
        self._goal = (self.name, self.choice)
        self._show_choice()

    def open(self, name: str, choice: Choice, then: Callable[[], None] | None = None) -> None:
        """Open a flow instead of the one being opened, and call ``then`` once it is shown."""
        before = self._goal[0]
        is_similar = name == before or (is_line(name) and is_line(before))
        self._goal = (name, choice)
        self._begin(LoadRequest(name, choice, then), follows=is_similar and then is None)

    async def _open(self, request: LoadRequest) -> None:
        """Read a flow, show it, and do what was to follow."""

        def time(field: FlowField) -> float:
            same = self._has_same_velocity(request.name, request.choice, field)
            return first_time(self.area.scene, field, keep=same and not request.is_link)

        flow = await self._read(request, time)
        self._show(flow, request)
        if request.then is not None and self._is_latest(request):
            request.then()

    def _has_same_velocity(self, name: str, choice: Choice, field: FlowField) -> bool:
        """Return whether a flow is another part of the file shown, or only differs in parameters.

        Values of its velocity compare with those on the page, on any plane and in any block.
        """
        if same_formula(field, self._current.field):
            return True
        present = self._current.source.part(self.choice.block or None).vectors
        vectors = choice.vectors or next(iter(present), "")
        return (name, vectors) == (self.name, self.choice.vectors or next(iter(present), ""))

    def _fail(self) -> None:
        self._goal = (self.name, self.choice)
        self._show_choice()
        self.list_files()  # with the reason

    def _show(self, flow: LoadedFlow, request: LoadRequest) -> None:
        """Replace the flow by another one; if that fails, it stays."""
        before = self._current, self._goal
        new = flow.choice
        old = self.choice
        # A link shows the same whatever was shown before.
        same = not request.is_link and self._has_same_velocity(flow.name, new, flow.field)
        keep = same and (new.block, _axis(new.plane)) == (old.block, _axis(old.plane))
        # A file that has changed has other values.
        same_values = same and flow.source.identity == self._current.source.identity
        self._current = flow
        if self._is_latest(request):
            self._goal = (flow.name, new)
        try:
            self.context.show(flow.field, keep_view=keep, keep_range=same_values, keep_time=same)
            if not keep:
                zoom, focus = self.library.look(flow.name)
                self.viewport.home(zoom=zoom, focus=focus)
                self.area.changed()
        except BaseException:
            self._current, self._goal = before
            raise

    def _show_choice(self) -> None:
        """Send the controls of the shown flow; while another one opens, only its name."""
        values = {"file": self.name, **self._options()}
        if self._goal != (self.name, self.choice):
            values = {name: values[name] for name in ("name", "about", "choices")}
        self.state.send(busy="", **values)

    def _requested(self) -> Choice:
        """Return the part of the file that the controls of the page request."""
        options = self._options()
        requested = {}
        for name, choices in (
            ("block", "blocks"),
            ("vectors", "vectors_choices"),
            ("axis", "axes"),
        ):
            requested[name] = options[name]
            value = self.state.get(name)
            if name_among(value, options[choices]):
                requested[name] = value
        block = requested["block"]
        vectors = requested["vectors"]
        axis = requested["axis"]
        if block != options["block"]:  # which has other planes and arrays
            if vectors not in self._current.source.block_vectors[block]:
                vectors = ""
            return Choice(vectors, "", block)
        if not axis:
            return Choice(vectors, "", block)
        last = self._part.planes[axis] - 1
        index = int(clipped(self.state.get("index"), options["index"], 0, last))
        if axis != options["axis"]:
            plane = self._part.plane_at(axis, (last + 1) // 2)
        elif index == options["index"]:
            # A plane between the places of the slider stays until that is moved.
            plane = self.choice.plane
        else:
            plane = self._part.plane_at(axis, index)
        return Choice(vectors, plane, block)

    @property
    def _part(self) -> FlowSource:
        return self._current.source.part(self.choice.block or None)

    def _controls_for(self, request: LoadRequest) -> Mapping[str, str]:
        if request.name != self.name:  # its controls are not shown
            return {}
        return _controls(self._current.source, self._part)

    def _options(self) -> dict[str, Any]:
        """Return the values of the controls that choose a part of the file."""
        source = self._current.source
        part = self._part
        if part.planes:
            axis = _axis(self.choice.plane)
        else:
            axis = ""
        count = part.planes.get(axis, 0)
        index = 0
        if count:
            index = part.plane_number(self.choice.plane) or 0
        vectors_choices = []
        if len(part.vectors) > 1:
            vectors_choices = list(part.vectors)
        field = self.viewport.field
        return {
            "is_file": self.library.is_file(self.name),
            "name": (field.name or source.name).replace("_", " ") or "flow",
            "about": about(field),
            "choices": choices_of(field, _controls(source, part)),
            "vectors_choices": vectors_choices,
            "vectors": self.choice.vectors or next(iter(part.vectors), ""),
            "blocks": list(source.blocks),
            "block": self.choice.block or next(iter(source.blocks), ""),
            "axes": list(part.planes),
            "axis": axis,
            "index": index,
            "plane_text": part.plane_text(self.choice.plane),
            "block_word": source.block_word,
            "planes": max(count - 1, 0),
        }

    def describe(self) -> State:
        """Return the choice of the flow."""
        found = {}
        for k, v in {"file": self.name, **asdict(self.choice)}.items():
            if v:
                found[k] = v
        return found

    def close(self) -> None:
        """End running tasks, and remove the uploads."""
        super().close()
        self.uploads.close()


def _axis(plane: str) -> str:
    return plane.partition("=")[0]


def _controls(source: FlowSource, part: FlowSource) -> dict[str, str]:
    """Return the names of the controls that a page has for a part, by the arguments they set."""
    controls: dict[str, str] = {}
    if part.planes:
        controls |= dict.fromkeys(("plane", "slice", "level", "sel", "isel"), "Plane")
    if len(part.vectors) > 1:
        controls["vectors"] = "Velocity"
    if source.blocks:
        controls["block"] = source.block_word
    if source.block_word == "Map":
        controls["globe"] = "Map"
    return controls


def choices_of(field: FlowField, controls: Mapping[str, str]) -> list[str]:
    """Return what was chosen for a field, and how to choose otherwise on a page."""
    texts = []
    for step in field.reading:
        if step.notable:
            texts.append(for_page(step.text, step.remedies, controls))
    return texts


def about(field: FlowField) -> str:
    """Return a short description of a field."""
    words = [field.short_size]
    if field.steady:
        words.append("steady")
    else:
        words.append(f"{len(field.times)} times")
    closed = []
    for axis, is_closed in zip("ji", field.periodic, strict=True):
        if is_closed:
            closed.append(axis)
    if closed:
        words.append(f"periodic along {' and '.join(sorted(closed))}")
    return " · ".join(words)


class FileBeside(FlowOpener):
    """The same part of another file than ``data`` shows, as far as it exists, in a second pane."""

    def __init__(self, context: Context, data: Data) -> None:
        super().__init__(context)
        self.data = data
        self._flow: LoadedFlow | None = None  #: The flow that is shown, with its traces.
        context.field_changed.connect(self.follow)

    @property
    def name(self) -> str:
        """Name of the file in the second pane; empty without one."""
        if "field" in self.viewport.differences:
            shown = self._flow
        else:
            shown = None
        if shown is None:
            return ""
        return shown.name

    def open(self, name: str) -> None:
        """Open a file for the second pane, instead of the one being opened."""
        follows = self._request is not None and self._request.name == name
        self._begin(LoadRequest(name, self.data.choice), follows=follows)

    def end(self) -> None:
        """Forget the file, after another second pane or none has replaced it."""
        if self._request is not None:
            self._request.cancelled = True
        self._request = self._flow = None
        self.show_names()

    def cancel(self) -> None:
        """Stop opening; one pane is shown."""
        if self.is_opening:
            self._fail()

    def follow(self) -> None:
        """Follow the first pane to another plane, array or file."""
        if self._request is not None and self._request.choice != self.data.choice:
            self.open(self._request.name)
        self.show_names()

    def show_names(self) -> None:
        """Show the names of the two files on the page."""
        names: tuple[str, ...] = ()
        if self._flow is not None:  # that of the second with its differing parts
            pairs = zip(astuple(self._flow.choice), astuple(self.data.choice), strict=True)
            differing = []
            for part, first in pairs:
                if part not in (first, ""):
                    differing.append(part)
            names = (self.data.name, " · ".join([self._flow.name, *differing]))
        self.area.names = names
        self.area.follow()

    def close(self) -> None:
        """End running tasks."""
        self.end()
        super().close()

    async def _open(self, request: LoadRequest) -> None:
        """Read a flow, and show it in the second view."""
        flow = await self._read(request, partial(time_in, self.area.scene), nearest=True)
        present_unit = self.viewport.field.length_unit
        unit = flow.field.length_unit
        if present_unit and unit and present_unit != unit:
            raise FieldError(
                f"{request.name} is in {unit} and {self.data.name} in {present_unit}; expected "
                "the same unit of length in both files, because they share one camera"
            )
        self._flow = flow
        self.show_names()
        if self.viewport.differences.get("field") is not flow.field:
            self.area.compare({"field": flow.field})

    def _fail(self) -> None:
        self.state.send(compare="nothing", busy="")
