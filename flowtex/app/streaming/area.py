"""The view as a component of its own, for any trame application.

::

    from flowtex.app import FlowArea

    area = FlowArea(mesh, server=server, samples=25)
    with VAppLayout(server):
        area.ui(style="height: 100%")
    area.settings.lod = False

It draws on the server and streams pictures; a drag pans a flat surface and turns a curved one, the
wheel zooms. Whatever is changed through :attr:`FlowArea.settings` is drawn at once.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from trame.widgets import html, rca

from flowtex.app.server.background import begin
from flowtex.app.server.state import PageState
from flowtex.app.streaming.player import Player
from flowtex.app.streaming.scene import Scene
from flowtex.app.streaming.stream import Figures, FrameStream
from flowtex.field import FlowField
from flowtex.settings import Settings

__all__ = ["FlowArea"]


class FlowArea:
    """A flow drawn on the server, as a part of a page.

    Parameters
    ----------
    flow
        The flow, or a mesh that makes one.
    server
        The trame server of the page.
    state
        Where the names of its state are; a place of its own by default.
    **options
        Arguments and settings of ``plotter.flowtex.add``, and ``zoom`` and ``focus`` as for
        :func:`flowtex.render`.

    Attributes
    ----------
    scene
        What is drawn.
    stream
        The pictures that go to the page.
    player
        What lets time go by.
    reports
        Called with :class:`~flowtex.app.streaming.stream.Figures` after each picture.
    timed
        Called when the time that is shown has changed.

    Raises
    ------
    FieldError, SettingsError
        When the mesh or a setting does not fit.
    """

    def __init__(
        self,
        flow: FlowField | Any,
        *,
        server: Any,
        state: PageState | None = None,
        **options: Any,
    ) -> None:
        from flowtex.options import FieldOptions

        self.server = server
        self.state = state or PageState(server)
        names = FieldOptions.__dataclass_fields__
        field = FieldOptions(**{k: options.pop(k, None) for k in names}).field(flow)
        self.scene = Scene(field, **options)
        self.stream = FrameStream(self.state.key("view"), self.scene, self._report)
        self.player = Player(self.scene, self.stream, self._timed)
        self.reports: list[Callable[[Figures], None]] = []
        self.timed: list[Callable[[], None]] = []
        self._tasks: list[asyncio.Task[None]] = []
        self._end_watching = lambda: None
        self._watch()
        if server.running:
            self._on_ready()
        else:
            server.controller.on_server_ready.add(self._on_ready)

    @property
    def settings(self) -> Settings:
        """Every setting, live."""
        return self.scene.handle.settings

    def ui(self, **attributes: Any) -> Any:
        """Put the view into the trame layout that is open.

        Parameters
        ----------
        **attributes
            Of the element around it, such as ``classes`` and ``style``.
        """
        with html.Div(**attributes) as element:
            rca.RemoteControlledArea(
                name=self.stream.area_name,
                display="image",
                event_throttle_ms=16,
                send_mouse_move=True,
                image_style=("{ width: '100%', height: '100%' }",),
            )
        return element

    def show(self, field: FlowField, *, keep_view: bool = False, keep_range: bool = False) -> None:
        """Show another flow with the same settings; :meth:`Scene.show` has the parameters."""
        self.scene.show(field, keep_view=keep_view, keep_range=keep_range)
        self._watch()
        self.stream.changed()

    def compare(self, changes: dict[str, Any] | None) -> None:
        """Show a second pane, or one again; :meth:`Scene.compare` has the parameters."""
        at_home = self.scene.at_home
        self.scene.compare(changes)
        if at_home:  # a pane is half as wide as the whole view
            self.scene.home()
        self.stream.changed()

    def reset_camera(self) -> None:
        """Show the whole surface again."""
        self.scene.home()
        self.stream.moved()

    def close(self) -> None:
        """End the tasks and free the graphics card."""
        self.stream.close()
        for task in self._tasks:
            task.cancel()
        self._tasks.clear()
        self._end_watching()
        self.scene.close()

    def _watch(self) -> None:
        """Draw when a setting changes."""
        self._end_watching()
        self._end_watching = self.settings.observe(lambda name, value: self._changed())

    def _changed(self) -> None:
        if not self.stream.composer.drafting:
            self.stream.changed()

    def _on_ready(self, **_: Any) -> None:
        if self._tasks:  # a page can have trame say this once more
            return
        self.server.controller.rc_area_register(self.stream)
        for work in (self.stream.run(), self.player.play()):
            self._tasks.append(begin(work, "the page has stopped drawing"))

    def _report(self, figures: Figures) -> None:
        for call in self.reports:
            call(figures)

    def _timed(self) -> None:
        for call in self.timed:
            call()
