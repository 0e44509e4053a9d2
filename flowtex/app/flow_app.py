"""The application of a page, and its server."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

from trame.app import get_server
from trame.ui.vuetify3 import VAppLayout

from flowtex.app.controllers.appearance import ANOTHER_TIME, BACKGROUNDS, Appearance
from flowtex.app.controllers.context import Context, Controller, State
from flowtex.app.controllers.data import Data, FileBeside
from flowtex.app.controllers.library import Choice, Library
from flowtex.app.controllers.sharing import FORMATS, Sharing
from flowtex.app.server.files import UPLOAD_SUFFIXES
from flowtex.app.server.page import PageState, name_among
from flowtex.app.server.security import new_secret
from flowtex.app.server.sessions.local import MakeApp, opener
from flowtex.app.server.site import IDLE_MINUTES, serve_sessions
from flowtex.app.streaming.area import FlowArea
from flowtex.app.streaming.element import PAINTERS
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.scene.options import ViewOptions
from flowtex.settings import TABLE

#: Arguments that choose a part of a file or a mesh, and those that change how it is read.
CHOICE_ARGUMENTS = tuple(f.name for f in fields(Choice))
FIELD_ARGUMENTS = ("times", "periodic", "sign_free", "preference")
TEMPLATE = Path(__file__).parent / "ui" / "page.html"
#: Mark of the view in the template.
VIEW = "<!-- the view -->"
#: Error messages are dark in both themes.
COMPLAINT = {"surface-variant": "#2a3440", "on-surface-variant": "#e8edf2"}
THEMES = {
    "dark": {"dark": True, "colors": {"primary": "#4fd1c5", "surface": "#171c23", **COMPLAINT}},
    "light": {"dark": False, "colors": {"primary": "#0f766e", "surface": "#ffffff", **COMPLAINT}},
}
#: Words of the template that are the same on each page.
WORDS = {
    "ANOTHER_TIME": ANOTHER_TIME,
    "UPLOADS": ",".join(UPLOAD_SUFFIXES),
    "BACKGROUNDS": str(list(BACKGROUNDS)),
    "FORMATS": str(list(FORMATS)),
    "PAINTERS": str(list(PAINTERS)),
    "LOD": TABLE["lod"].label.lower(),
    # Attributes of widgets of a kind.
    "BUTTON": 'icon size="small" variant="text"',
    "NUMBER": 'type="number" step="any" class="flowtex-number"',
    "SELECT": 'density="compact" variant="plain" hide-details class="flowtex-select" '
    ":menu-props=\"{ contentClass: 'flowtex-list' }\" :list-props=\"{ density: 'compact' }\"",
    "SLIDER": 'density="compact" color="primary" hide-details thumb-size="14" track-size="3"',
    "SWITCH": 'density="compact" color="primary" hide-details inset class="flowtex-switch"',
    "TOGGLE": 'density="compact" color="primary" variant="text" mandatory class="flowtex-toggle"',
}
#: Directions of view onto a surface, and their directions up.
VIEWS: dict[str, tuple[tuple[float, float, float], tuple[float, float, float]]] = {
    "from +x": ((1, 0, 0), (0, 0, 1)),
    "from -x": ((-1, 0, 0), (0, 0, 1)),
    "from +y": ((0, 1, 0), (0, 0, 1)),
    "from -y": ((0, -1, 0), (0, 0, 1)),
    "from +z": ((0, 0, 1), (0, 1, 0)),
    "from -z": ((0, 0, -1), (0, 1, 0)),
}


class FlowApp:
    """The page of ``flowtex show``, with one or several flows and all controls.

    Parameters
    ----------
    flow
        A :class:`~flowtex.FlowField`, a mesh, the path of a file or of a folder, or a
        :class:`~flowtex.app.Library` of several flows.
    server
        A trame server; a new one by default.
    **options
        Arguments and settings of ``plotter.flowtex.add``, and ``zoom``, ``focus``, ``camera``
        and ``axes`` as for :func:`flowtex.show`.

    Attributes
    ----------
    server, layout
        The trame server, and the layout of the page.
    area, viewport, stream
        The view, what it draws, and the stream of pictures to the page.
    state
        The state of the page, whose names are prefixed for this application.
    context, data, beside, appearance, viewpoint, sharing
        The parts that act on the view.

    Raises
    ------
    FieldError, SettingsError
        When the mesh or a setting is invalid.

    Examples
    --------
    >>> import flowtex
    >>> from flowtex.app import FlowApp
    >>> app = FlowApp(flowtex.examples.airfoil_field(), samples=9)
    >>> app.area.settings.lod = False
    >>> app.close()
    """

    def __init__(self, flow: Any, *, server: Any = None, **options: Any) -> None:
        self.server = server or get_server(f"flowtex-{id(self)}")
        self.server.client_type = "vue3"
        self.state = PageState(self.server)
        library = Library.of(flow, **_taken(options, FIELD_ARGUMENTS))
        name, choice = first_choice(library, options)
        for argument in CHOICE_ARGUMENTS:
            options.pop(argument, None)
        field = library.field(name, choice)
        camera = options.pop("camera", None)
        self.area = FlowArea(field, server=self.server, state=self.state, **options)
        self.viewport = self.area.viewport
        self.stream = self.area.stream
        if camera is not None:
            self.viewport.camera = ViewOptions.of(camera=camera).first_camera(field.surface)
        self.context = Context(self.state, self.area, library.branch())
        self.server.state.trame__favicon = None
        self.state.set(panel=False, group="View", help=False, problem="")
        self.data = Data(self.context, name, choice)
        self.beside = FileBeside(self.context, self.data)
        self.appearance = Appearance(self.context, self.beside)
        self.viewpoint = Viewpoint(self.context)
        first = self.appearance.first
        self.sharing = Sharing(self.context, self.data, self.beside, self.restore, first)
        self._first = (name, choice)
        self.context.field_changed.connect(self._name_page)
        self._name_page()
        self.layout = build_page(self)

    @property
    def field(self) -> FlowField:
        """The flow shown."""
        return self.viewport.field

    def show(self, field: FlowField, **keep: bool) -> None:
        """Show another flow, as :meth:`flowtex.app.FlowArea.show` does."""
        self.context.show(field, **keep)

    def restore(self, state: State) -> None:
        """Show the state of a link, and what that omits as on a new page."""
        first_name, first_choice = self._first
        name = str(state.get("file", first_name))
        choice = _choice_of(state)
        if name == first_name and choice == Choice():
            choice = first_choice
        self.data.open(name, choice, lambda: self._restore(state))

    def _restore(self, state: State) -> None:
        if (self.data.name, self.data.choice) == self._first:
            self.viewpoint.look_as_first()
        try:
            for controller in self.context.controllers:
                controller.restore(state)
        except FieldError as error:
            self.context.complain(error)
        self.area.changed()

    def cancel_opening(self) -> None:
        """Stop opening files, in either pane."""
        self.data.cancel()
        self.beside.cancel()

    def close(self) -> None:
        """End the tasks and free the graphics memory."""
        for controller in self.context.controllers:
            controller.close()
        self.area.close()

    def _name_page(self) -> None:
        self.server.state.trame__title = f"{self.field.name or 'flow'} - flowtex"


class Viewpoint(Controller):
    """The camera and the time of a page."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._first_look = self.viewport.look
        self._first_camera = self.viewport.chosen_camera
        self.state.set(views=self.views)
        context.field_changed.connect(lambda: self.state.set(views=self.views))

    @property
    def views(self) -> list[str]:
        """Names of the directions of view; none for a flat surface."""
        if self.viewport.flat:
            return []
        return list(VIEWS)

    def look_from(self, name: object) -> None:
        """Look at the whole of a curved surface from a side."""
        if name_among(name, VIEWS):
            toward, up = VIEWS[name]
            self.viewport.home(toward=toward, up=up)
            self.area.changed()

    def look_as_first(self) -> None:
        """Look as the page does when it is new."""
        self.viewport.home(**self._first_look)
        if self._first_camera is not None:
            self.viewport.camera = self._first_camera

    def describe(self) -> State:
        """Return the camera, and the time where it makes a difference."""
        if self.viewport.field.steady:
            time = {}
        else:
            time = {"time": self.area.player.time}
        return {"camera": self.viewport.camera.to_dict(), "clock": self.viewport.clock, **time}

    def restore(self, saved: State) -> None:
        """Stop at a saved time, and look from a saved camera."""
        field = self.viewport.field
        player = self.area.player
        player.playing = False
        self.viewport.clock = float(saved.get("clock", 0.0))
        if not field.steady:
            player.go_to(float(saved.get("time", field.first_time)))
        if saved.get("camera"):
            self.area.look(saved["camera"])


def first_choice(library: Library, options: Mapping[str, Any]) -> tuple[str, Choice]:
    """Return the first flow that can be shown, and its chosen part.

    Parameters
    ----------
    library
        The flows, in the order in which they are tried.
    options
        Arguments of the application; ``CHOICE_ARGUMENTS`` among them choose the part.

    Returns
    -------
    tuple of str and Choice
        Name of the flow in the library, and its part.

    Raises
    ------
    FieldError
        When no flow can be shown: the error of the first one.
    OSError
        Likewise, when the file of the first flow cannot be read.
    """
    partial_choice = _choice_of(options)
    names = library.names
    drawable = tuple(name for name in names if name not in library.unshown)
    names = drawable or names
    errors = list[Exception]()
    for name in names:
        try:
            choice = library.complete(name, partial_choice)
            if len(names) > 1:
                library.field(name, choice)  # whether it can be drawn
            return name, choice
        except (FieldError, OSError) as error:
            errors.append(error)
    raise errors[0]


def serve(
    field: Any,
    *,
    host: str = "127.0.0.1",
    port: int = 0,
    allow_host: Iterable[str] = (),
    limit: int | None = None,
    idle: float = IDLE_MINUTES,
    folder: str | Path | None = None,
    open_browser: bool = True,
    announce: Callable[[str], None] = print,
    **options: Any,
) -> None:
    """Show a flow on a page, until Ctrl-C.

    Each browser tab has its own camera, settings and time. Fields and their traces are shared in
    this process; the command ``flowtex show`` starts a process for each tab.

    Parameters
    ----------
    field
        A :class:`~flowtex.FlowField`, a mesh, the path of a file or of a folder; or a function that
        takes a trame server and returns an application on it, such as a :class:`FlowApp`.
    host
        Address to listen on. With any but the default, everybody on the network who knows the
        page's address can use it.
    port
        Port to listen on; 0 takes a free one.
    allow_host
        Host names by which browsers may address the page, besides ``localhost`` and ``host``, such
        as that of a proxy; ``"*"`` allows any. Numeric addresses are always allowed.
    limit
        Largest number of open pages; by default as many as cores and memory allow.
    idle
        Minutes during which a closed page can be opened again.
    folder
        Folder of further files that a page may open; none by default.
    open_browser
        Whether to open the page in a browser.
    announce
        Called with the page's address, which contains its secret; by default the address is
        printed.
    **options
        Arguments and settings of ``plotter.flowtex.add``; not allowed with a function.

    Raises
    ------
    FieldError, SettingsError
        When the mesh, a setting or a name in ``allow_host`` is invalid, or options are given with a
        function.
    ServeError
        When the server cannot listen on the host and port, or ``port``, ``limit`` or ``idle`` is
        out of range.

    Examples
    --------
    >>> import flowtex
    >>> flowtex.app.serve("runs/", port=8080, limit=12)  # doctest: +SKIP
    """
    secret = new_secret()
    serve_sessions(
        opener(app_maker(field, folder, options), secret),
        secret,
        host=host,
        port=port,
        allow_host=allow_host,
        limit=limit,
        idle=idle,
        open_browser=open_browser,
        announce=announce,
    )


def _taken(options: dict[str, Any], names: Iterable[str]) -> dict[str, Any]:
    """Return some of the options, ``None`` where one is not given, and remove them."""
    return {name: options.pop(name, None) for name in names}


def _choice_of(values: Mapping[str, Any]) -> Choice:
    """Return the part of a file that values by name choose."""
    chosen = {}
    for key in CHOICE_ARGUMENTS:
        if values.get(key) is not None:
            chosen[key] = str(values[key])
    return Choice(**chosen)


def app_maker(field: Any, folder: str | Path | None, options: dict[str, Any]) -> MakeApp:
    """Return a function that makes an application for each page.

    Parameters
    ----------
    field
        What the pages show, as for ``flowtex.app.serve``, or a function that makes applications.
    folder
        Folder whose files visitors can choose.
    options
        Further arguments of :class:`FlowApp`; arguments of reading are removed from it.

    Raises
    ------
    FieldError
        When ``field`` is a function and options or a folder are given as well.
    """
    if callable(field):
        names = list(options)
        if folder is not None:
            names.append("folder")
        if names:
            raise FieldError(
                f"{', '.join(names)} cannot be used with a function; pass them to the application "
                "that it makes"
            )
        make_app: MakeApp = field
        return make_app
    # All pages share one library, with its open files and traces.
    library = Library.of(field, folder=folder, **_taken(options, FIELD_ARGUMENTS))
    return lambda server: FlowApp(library, server=server, **options)


def build_page(app: FlowApp) -> Any:
    """Build the page; return trame's layout, whose ``html`` is the text of the page."""
    state = app.state
    data = app.data
    sharing = app.sharing
    actions = {
        "list_files": data.list_files,
        "reload": data.reload,
        "cancel_opening": app.cancel_opening,
        "look_from": app.viewpoint.look_from,
        "save": sharing.start,
        "cancel_saving": sharing.cancel,
        "show_state": sharing.show_state,
        "take_link": sharing.take_link,
    }
    words = dict(WORDS)
    for name, call in actions.items():
        words[name] = app.server.trigger_name(call)
    words["TYPED"] = str(app.context.library.typed).lower()
    # All other names are those of values of the page's state.
    page = re.sub(
        r"%(\w+)", lambda m: words.get(m[1], state.key(m[1])), TEMPLATE.read_text("utf-8")
    )
    config = {"theme": {"defaultTheme": "dark", "themes": THEMES}}
    before, after = page.split(VIEW)
    with VAppLayout(app.server, vuetify_config=config) as layout:
        layout.root.theme = (state.key("theme"),)
        layout.root.add_child(before)
        app.area.ui(classes="flowtex-area")
        layout.root.add_child(after)
    return layout
