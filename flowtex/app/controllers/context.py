"""Context of the controllers of a page: the view, the state, and signals between them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias

from flowtex.app.controllers.library import Library
from flowtex.app.server.files import Routes
from flowtex.app.server.page import PageState, Signal
from flowtex.app.server.validation import shortened
from flowtex.app.streaming.area import FlowArea
from flowtex.app.streaming.viewport import Viewport
from flowtex.field import FlowField
from flowtex.settings import Settings

#: The state of a page by name, as in :mod:`.serialization`.
State: TypeAlias = Mapping[str, Any]


class Context:
    """Objects that the controllers of a page share."""

    def __init__(self, state: PageState, area: FlowArea, library: Library) -> None:
        #: The state of the page, the view, and the flows that the page may open.
        self.state, self.area, self.library = state, area, library
        self.routes = Routes.of(state.server)  #: The files that the page may fetch.
        self.controllers: list[Controller] = []  #: All, in the order in which they were made.
        #: Signals after another flow is shown, and after a change of the file beside it.
        self.field_changed, self.beside_changed = Signal(), Signal()
        area.element.failed.connect(self.complain)

    def complain(self, problem: object) -> None:
        """Show an error on the page."""
        self.state.send(problem=shortened(str(problem)))

    def show(self, field: FlowField, *, keep_view: bool = False, keep_range: bool = False) -> None:
        """Show another flow; :meth:`Viewport.show` has the parameters."""
        playing = self.area.player.playing
        self.area.show(field, keep_view=keep_view, keep_range=keep_range)
        self.field_changed.emit()
        self.area.player.playing = playing


class Controller:
    """Base of the controllers of one group of controls: sets their state, and follows it."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self.state, self.area, self.stream = context.state, context.area, context.area.stream
        context.controllers.append(self)

    @property
    def viewport(self) -> Viewport:
        """The view that is drawn."""
        return self.area.viewport

    @property
    def settings(self) -> Settings:
        """Every setting, live."""
        return self.area.settings

    def describe(self) -> State:
        """Return a part of the page's state, named as in :mod:`.serialization`."""
        return {}

    def restore(self, saved: State) -> None:
        """Take over the part of a saved state that belongs to this controller."""

    def close(self) -> None:
        """End running tasks."""
