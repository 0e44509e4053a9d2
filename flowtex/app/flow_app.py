"""The application behind a page: a view, and the groups of controls that act on it."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from trame.app import get_server

from flowtex.app.controllers.browser import Browser
from flowtex.app.controllers.clockwork import Clockwork
from flowtex.app.controllers.data import Data
from flowtex.app.controllers.library import Choice, Library
from flowtex.app.controllers.look import Look
from flowtex.app.controllers.moves import Moves
from flowtex.app.controllers.part import Part
from flowtex.app.controllers.reader import Reader
from flowtex.app.controllers.share import Share
from flowtex.app.server.cell import InCell
from flowtex.app.server.state import PageState
from flowtex.app.server.untrusted import shortened
from flowtex.app.streaming.area import FlowArea
from flowtex.app.streaming.scene import Scene
from flowtex.app.streaming.stream import FrameStream
from flowtex.app.ui.layout import build_page
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.settings import SettingsError

__all__ = ["FlowApp"]

#: Arguments that choose something in a file or a mesh, and those that make a mesh another field.
CHOOSING, MAKING = ("vectors", "plane", "block"), ("times", "periodic", "sign_free")


class FlowApp(InCell):
    """Flows on a page, with everything that can be done with them.

    Parameters
    ----------
    flow
        The flow, a mesh that makes one, the path of a file or of a folder of files, or a
        :class:`~flowtex.app.Library` of several.
    server
        A trame server; one of its own by default.
    **options
        Arguments and settings of ``plotter.flowtex.add``, and ``zoom`` and ``focus`` as for
        :func:`flowtex.render`.

    Attributes
    ----------
    server
        The trame server.
    layout
        The page, as trame's layout.
    area
        The view.
    state
        What the page knows, under names of this application's own.

    Raises
    ------
    FieldError, SettingsError
        When the mesh or a setting does not fit.
    """

    def __init__(self, flow: Any, *, server: Any = None, **options: Any) -> None:
        self.server = server or get_server(f"flowtex-{id(self)}")
        self.server.client_type = "vue3"
        self.state = PageState(self.server)
        library = Library.of(flow, **{name: options.pop(name, None) for name in MAKING})
        name, choice = first_choice(library, options)
        options = {k: v for k, v in options.items() if k not in CHOOSING}
        self.area = FlowArea(
            library.field(name, choice), server=self.server, state=self.state, **options
        )
        self.data = Data(self, library, name, choice)
        self.look = Look(self)
        self.clockwork = Clockwork(self)
        self.moves = Moves(self)
        self.browser = Browser(self)
        self.reader = Reader(self)
        self.share = Share(self)
        self.parts: tuple[Part, ...] = (
            self.data,
            self.look,
            self.clockwork,
            self.moves,
            self.browser,
            self.reader,
            self.share,
        )
        self._setup_state()
        self._build_page()
        for part in self.parts:
            part.watch()

    @property
    def scene(self) -> Scene:
        """What is drawn."""
        return self.area.scene

    @property
    def stream(self) -> FrameStream:
        """The pictures that go to the page."""
        return self.area.stream

    @property
    def field(self) -> FlowField:
        """The flow that is shown."""
        return self.scene.field

    def show(self, field: FlowField, *, keep_view: bool = False, keep_range: bool = False) -> None:
        """Show another flow; :meth:`Scene.show` has the parameters."""
        playing = self.area.player.playing
        self.area.show(field, keep_view=keep_view, keep_range=keep_range)
        for part in self.parts:
            part.refresh()
        self.area.player.playing = playing
        self._name_page()

    def restore(self, said: Mapping[str, Any]) -> None:
        """Show the state that a link has told.

        Parameters
        ----------
        said
            As :func:`flowtex.app.controllers.links.from_link` returns it.
        """
        name = str(said.get("file", self.data.name))
        choice = Choice(*(str(said.get(k, "")) for k in CHOOSING))
        if "file" not in said and choice == Choice():
            self._restore_parts(said)
        else:
            self.data.begin(name, choice, lambda: self._restore_parts(said))

    def _restore_parts(self, said: Mapping[str, Any]) -> None:
        try:
            for part in self.parts:
                part.restore(said)
        except (SettingsError, FieldError) as error:
            self.complain(error)
        self.area.stream.changed()

    def complain(self, problem: Any) -> None:
        """Let the page say what is wrong."""
        self.state.send(problem=shortened(str(problem)))

    def close(self) -> None:
        """End the tasks and free the graphics card."""
        self.leave_cell()
        for part in self.parts:
            part.close()
        self.area.close()

    def _setup_state(self) -> None:
        self.server.state.trame__favicon = None
        self.state.set(panel=None, group=None, help=False, problem="", views=self.moves.views)
        for part in self.parts:
            self.state.set(**part.values())
        self._name_page()

    def _name_page(self) -> None:
        self.server.state.trame__title = f"{self.field.name or 'flow'} - flowtex"

    def _build_page(self) -> None:
        static = str(Path(__file__).parent / "ui" / "static")
        self.server.enable_module(
            {
                "serve": {"__flowtex": static},
                "styles": ["__flowtex/flowtex.css"],
                "scripts": ["__flowtex/flowtex.js"],
                "vue_use": ["flowtex_page"],
            }
        )
        self.layout = build_page(self)


def first_choice(library: Library, options: Mapping[str, Any]) -> tuple[str, Choice]:
    """Return what is shown first: the name of a flow, and what is chosen of it.

    Parameters
    ----------
    library
        What there is.
    options
        May hold ``vectors``, ``plane`` and ``block``.

    Raises
    ------
    FieldError
        When none can be opened; it tells of the first one.
    """
    chosen = Choice(
        *("" if (value := options.get(key)) is None else str(value) for key in CHOOSING)
    )
    name, *others = library.names
    try:
        return name, _first_of(library, name, chosen, sure=not others)
    except (FieldError, OSError):
        # In a folder lies this and that: what cannot be drawn does not hide the rest.
        for other in others:
            with suppress(FieldError, OSError):
                return other, _first_of(library, other, chosen)
        raise


def _first_of(library: Library, name: str, chosen: Choice, *, sure: bool = False) -> Choice:
    """Return what is chosen of a flow in full, after making sure that it can be drawn."""
    choice = library.complete(name, chosen)
    if not sure:
        library.field(name, choice)
    return choice
