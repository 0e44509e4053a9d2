"""What the controllers of a page share: the view, the state, and the signals between them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flowtex.app.controllers.library import Library
from flowtex.app.server.files import Routes
from flowtex.app.server.page import PageState, Signal
from flowtex.app.server.validation import shortened
from flowtex.app.streaming.area import FlowArea
from flowtex.app.streaming.viewport import Viewport
from flowtex.field import FlowField
from flowtex.settings import Settings


class Context:
    """What the controllers of a page share."""

    def __init__(self, state: PageState, area: FlowArea, library: Library) -> None:
        #: What the page knows, the view, and the flows the page may open.
        self.state, self.area, self.library = state, area, library
        self.routes = Routes.of(state.server)  #: The files that the page may fetch.
        self.controllers: list[Controller] = []  #: All, in the order in which they were made.
        #: Signals after another flow is shown, and after that of another file came or went.
        self.field_changed, self.beside_changed = Signal(), Signal()
        area.element.failed.connect(self.complain)

    def complain(self, problem: object) -> None:
        """Let the page say what is wrong."""
        self.state.send(problem=shortened(str(problem)))

    def show(self, field: FlowField, *, keep_view: bool = False, keep_range: bool = False) -> None:
        """Show another flow; :meth:`Viewport.show` has the parameters."""
        playing = self.area.player.playing
        self.area.show(field, keep_view=keep_view, keep_range=keep_range)
        self.field_changed.emit()
        self.area.player.playing = playing


class Controller:
    """Base of what acts on one group of controls: sets their state, and follows it."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self.state, self.area, self.stream = context.state, context.area, context.area.stream
        context.controllers.append(self)

    @property
    def viewport(self) -> Viewport:
        """What is drawn."""
        return self.area.viewport

    @property
    def settings(self) -> Settings:
        """Every setting, live."""
        return self.area.settings

    def describe(self) -> dict[str, Any]:
        """Return a part of the page's state, named as in :mod:`.serialization`."""
        return {}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Take over the part of a saved state that belongs to this controller."""

    def close(self) -> None:
        """End what is running."""
