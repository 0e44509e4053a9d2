"""The view as its own component, for any trame application.

It is ``<flowtex-view>``, with its controls: drawn by the browser where that has WebGL2 and a
graphics card, and else here, as pictures. Whatever is changed through :attr:`FlowArea.settings`,
or of the appearance, such as ``area.cmap = "magma"``, is drawn at once.
"""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import trame_rca.module
from trame_client.widgets.core import AbstractElement

from flowtex.app.server.page import PageState
from flowtex.app.streaming.element import Element, Player
from flowtex.app.streaming.points import PointReader
from flowtex.app.streaming.stream import FrameStream
from flowtex.app.streaming.viewport import Viewport
from flowtex.field import FlowField
from flowtex.field.options import FieldOptions
from flowtex.scene.fields import read_field
from flowtex.scene.options import AppearanceAttributes, ViewOptions
from flowtex.scene.scene import Change, Scene

#: Events of the element on the page.
EVENTS = ("camera", "time", "clock", "playing", "setting", "colours")


class _Client(AbstractElement):
    """The element that ``client/src/app`` makes."""

    def __init__(self, name: str, **attributes: Any) -> None:
        super().__init__(name, **attributes)
        self._attr_names += ["begin", "read"]
        self._event_names += EVENTS


class FlowArea(AppearanceAttributes):
    """A view of a flow as part of a trame page, with its controls.

    Parameters
    ----------
    flow
        A :class:`~flowtex.FlowField` or a mesh.
    server
        The trame server of the page.
    state
        The state of the page; new names by default.
    **options
        Arguments and settings of ``plotter.flowtex.add``, and ``zoom``, ``focus`` and ``axes`` as
        for :func:`flowtex.show`.

    Attributes
    ----------
    viewport, stream, player
        The view as it is drawn, the stream of pictures to the page, and the animation.
    element, points
        The element on the page, and the values at points.
    scalars, cmap, clim, log_scale, color, opacity, visible, lighting
        Arguments of ``plotter.flowtex.add``, which can be changed.

    Raises
    ------
    FieldError, SettingsError
        When the mesh or a setting is invalid.

    Examples
    --------
    >>> import flowtex
    >>> from flowtex.app import FlowArea
    >>> from trame.app import get_server
    >>> area = FlowArea(flowtex.examples.airfoil_field(), server=get_server("a page"), samples=9)
    >>> area.compare({"lod": False})
    >>> area.close()
    """

    def __init__(
        self, flow: Any, *, server: Any, state: PageState | None = None, **options: Any
    ) -> None:
        self.server = server
        self.state = state or PageState(server)
        names = FieldOptions.__dataclass_fields__
        self._reading = FieldOptions(**{k: options.pop(k, None) for k in names})
        axes = ViewOptions(axes=options.pop("axes", None)).axes
        self.viewport = Viewport(read_field(flow, self._reading), **options)
        self.stream = FrameStream(self.state.key("view"), self.viewport)
        self.player = Player(self.viewport, self.stream)
        self.element = Element(self.state, self.viewport, self.stream, self.player, axes)
        self.points = PointReader(self.viewport)
        self._tasks: list[asyncio.Task[None]] = []
        settings = self.settings.observe(lambda name, value: self._changed())
        self._ends = (settings, self.scene.observe(self._scene_changed))
        self._is_made = True
        if server.running:
            self._on_ready()
        else:
            server.controller.on_server_ready.add(self._on_ready)

    @property
    def scene(self) -> Scene:
        """The field, its appearance and its textures."""
        return self.viewport.scene

    @property
    def field(self) -> FlowField:
        """The flow. Assign another flow or mesh to show it with the same camera."""
        return self.viewport.field

    @field.setter
    def field(self, mesh: Any) -> None:
        reading = FieldOptions() if isinstance(mesh, FlowField) else self._reading
        self.show(read_field(mesh, reading), keep_view=True, keep_range=True)

    def ui(self, **attributes: Any) -> Any:
        """Add the view to the open layout; ``attributes`` are those of the element."""
        element, server = self.element, self.server
        server.enable_module(trame_rca.module)
        server.enable_module(
            {
                "serve": {"__flowtex": str(Path(__file__).parents[1] / "ui" / "static")},
                "styles": ["__flowtex/flowtex.css"],
                "scripts": ["__flowtex/flowtex.js"],
                "vue_use": ["flowtex_page"],
            }
        )
        attributes["style"] = "width: 100%; height: 100%; " + attributes.get("style", "")
        return _Client(
            "flowtex-client",
            ref=element.ref,
            begin=server.trigger_name(element.begin),
            read=server.trigger_name(self.points.read),
            **{
                name: (getattr(element, f"take_{name}"), "[$event.value, $event.page]")
                for name in EVENTS
            },
            **attributes,
        )

    def show(self, field: FlowField, *, keep_view: bool = False, keep_range: bool = False) -> None:
        """Show another flow with the same settings.

        Parameters
        ----------
        field
            The flow.
        keep_view
            Whether the camera stays where it is.
        keep_range
            Whether a chosen colour range and the time shown stay.
        """
        self.viewport.show(field, keep_view=keep_view, keep_range=keep_range)
        self.changed()

    def compare(self, changes: Mapping[str, Any] | None) -> None:
        """Show a second pane with the given differences, or a single pane for ``None``.

        Parameters
        ----------
        changes
            Settings, and ``scalars``, ``time`` and ``field`` of the second pane, where they differ.
        """
        self.viewport.compare(changes)
        self.changed()

    def look(self, camera: object) -> None:
        """Set the camera, unless it sees nothing."""
        if self.element.take_camera(camera):
            self.element.repeat()

    def reset_camera(self) -> None:
        """Show the whole surface again."""
        self.viewport.home()
        self.changed()

    def changed(self) -> None:
        """Draw after a change, and notify the page."""
        self.element.follow()
        self.stream.changed()

    def close(self) -> None:
        """End the tasks and free the graphics memory."""
        self.stream.close()
        for task in self._tasks:
            task.cancel()
        self._tasks.clear()
        self.player.close()
        self.element.close()
        self.points.close()
        for end in self._ends:
            end()
        self.viewport.close()

    def _scene_changed(self, affects: Change) -> None:
        if affects == "appearance":
            self._changed()

    def _changed(self) -> None:
        if not self.stream.painter.drafting:
            self.changed()

    def _on_ready(self, **_: object) -> None:
        if self._tasks:  # a page can trigger this again
            return
        self.server.controller.rc_area_register(self.stream)
        self._tasks.append(asyncio.create_task(self.stream.run()))
