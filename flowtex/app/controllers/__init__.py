"""Controllers of a page: the actions of its controls."""

from __future__ import annotations

from collections.abc import Callable

from flowtex.app.controllers.appearance import Appearance
from flowtex.app.controllers.context import Context, Controller, State
from flowtex.app.controllers.data import Data, FileBeside
from flowtex.app.controllers.library import Choice
from flowtex.app.controllers.sharing import Sharing
from flowtex.app.server.validation import name_among

#: Directions of view onto a surface, and their directions up.
VIEWS: dict[str, tuple[tuple[float, float, float], tuple[float, float, float]]] = {
    "from +x": ((1, 0, 0), (0, 0, 1)),
    "from -x": ((-1, 0, 0), (0, 0, 1)),
    "from +y": ((0, 1, 0), (0, 0, 1)),
    "from -y": ((0, -1, 0), (0, 0, 1)),
    "from +z": ((0, 0, 1), (0, 1, 0)),
    "from -z": ((0, 0, -1), (0, 1, 0)),
}


class Viewpoint(Controller):
    """The camera and the time of a page."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self.state.set(views=self.views)
        context.field_changed.connect(lambda: self.state.set(views=self.views))

    @property
    def views(self) -> list[str]:
        """Names of the directions of view; none for a flat surface."""
        return [] if self.viewport.flat else list(VIEWS)

    def look_from(self, name: object) -> None:
        """Look at the whole of a curved surface from a side."""
        if name_among(name, VIEWS):
            toward, up = VIEWS[name]
            self.viewport.home(toward=toward, up=up)
            self.area.moved()

    def describe(self) -> State:
        """Return the camera, and the time where it makes a difference."""
        time = {} if self.viewport.field.steady else {"time": self.area.player.time}
        return {"camera": self.viewport.camera.to_dict(), **time}

    def restore(self, saved: State) -> None:
        """Look from a saved camera, at a saved time."""
        if saved.get("camera"):
            self.area.look(saved["camera"])
        if "time" in saved and not self.viewport.field.steady:
            self.area.player.go_to(float(saved["time"]))


__all__ = ["Controllers"]


class Controllers:
    """All controllers of a page; ``restore_state`` is called with the state that a link holds."""

    def __init__(
        self, context: Context, name: str, choice: Choice, restore_state: Callable[[State], None]
    ) -> None:
        self.context = context
        self.data = Data(context, name, choice)
        self.beside = FileBeside(context, self.data)
        self.appearance = Appearance(context, self.beside)
        self.viewpoint = Viewpoint(context)
        self.sharing = Sharing(context, self.data, self.beside, restore_state)

    def cancel_opening(self) -> None:
        """Stop opening files, in either pane."""
        self.data.cancel()
        self.beside.cancel()
