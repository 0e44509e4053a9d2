"""Flow textures in PyVista: ``plotter.flowtex.add(mesh)``, and the handle that it returns.

PyVista finds :class:`FlowtexComponent` through its entry point and makes one for each plotter
that asks for ``plotter.flowtex``. The component keeps the handles; a handle joins a
:class:`~flowtex.view.FlowView` (arrays, settings, time) to a
:class:`~flowtex.renderers.vtk.FlowLayer` (the graphics card) and carries changes from one to the
other.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from typing import Any

import pyvista as pv

from flowtex.camera import look
from flowtex.field import FlowField
from flowtex.renderers.vtk import FlowLayer, set_attributes, surface_mesh, use_flow_mapper
from flowtex.settings import Affects, Settings
from flowtex.view import FlowView

__all__ = ["FlowHandle", "FlowtexComponent", "as_field"]

#: Colours when there are none to ask for: a neutral grey that can go darker and lighter.
PLAIN, CMAP = "#a0a0a0", "viridis"

#: A scalar bar that keeps out of the picture's way.
BAR: dict[str, Any] = {
    "fmt": "%.3g",
    "n_labels": 3,
    "vertical": True,  # labels of a level bar would hang over its ends
    "width": 0.08,
    "height": 0.36,
    "position_x": 0.02,
    "position_y": 0.04,
    "fill": True,
    "background_color": "white",
    "color": "black",
    "title_font_size": 16,
    "label_font_size": 14,
    "unconstrained_font_size": True,
}

#: Arguments of ``add`` that go to the making of the field.
FIELD_ARGUMENTS = ("vectors", "plane", "times", "periodic")

_count = itertools.count(1)


def as_field(mesh: Any, **options: Any) -> FlowField:
    """Return a field from a field, or from a mesh with :meth:`FlowField.from_pyvista`.

    Raises
    ------
    FieldError
        When the mesh does not make a field.
    TypeError
        When options for a mesh are given with a field that is made already.
    """
    given = {key: value for key, value in options.items() if value is not None}
    if not isinstance(mesh, FlowField):
        return FlowField.from_pyvista(mesh, **given)
    if given:
        msg = f"{', '.join(given)} cannot be chosen any more for {mesh!r}; choose when it is made"
        raise TypeError(msg)
    return mesh


class FlowHandle:
    """One flow texture on a plotter; change it through :attr:`settings` and :attr:`time`.

    Attributes
    ----------
    field
        The flow.
    settings
        Every setting, live: ``handle.settings.lod = False``.
    actor
        PyVista's actor, for opacity, lighting, position and the like.
    """

    def __init__(
        self,
        plotter: Any,
        view: FlowView,
        scalars: str | None,
        add_mesh: dict[str, Any],
        forget: Callable[[FlowHandle], None],
    ) -> None:
        self._plotter = plotter
        self._forget = forget
        self._view = view
        self._scalars = scalars
        self._mesh = surface_mesh(view.textures)
        bar = add_mesh.pop("bar")
        if scalars is not None:
            self._mesh.point_data[scalars] = view.scalar(scalars).ravel()
        self.actor = plotter.add_mesh(
            self._mesh, name=f"flowtex {next(_count)}", show_scalar_bar=False, **add_mesh
        )
        mapper = use_flow_mapper(self.actor, self._mesh, scalars)
        self._bar = bar.get("title", scalars) if bar is not None and scalars else None
        if self._bar is not None:
            plotter.add_scalar_bar(mapper=mapper, **{"title": scalars, **bar})
        self._layer = FlowLayer(self.actor, plotter.renderer, view.textures, view.settings)
        self._layer.set_moment(*view.moment)
        self._shown = view.time
        self._end = view.observe(self._changed)

    @property
    def field(self) -> FlowField:
        """The flow."""
        return self._view.field

    @property
    def settings(self) -> Settings:
        """Every setting, live."""
        return self._view.settings

    @property
    def view(self) -> FlowView:
        """The arrays behind the picture."""
        return self._view

    @property
    def time(self) -> float:
        """Time that is shown, in the field's own unit."""
        return self._view.time

    @time.setter
    def time(self, value: float) -> None:
        self._view.time = value

    @property
    def clock(self) -> float:
        """Clock of the animation in seconds; set it to draw the frame of any moment."""
        return self._layer.view.clock

    @clock.setter
    def clock(self, value: float) -> None:
        self._layer.view.clock = float(value)
        self._draw()

    @property
    def closed(self) -> bool:
        """Whether the texture has been removed."""
        return self._plotter is None

    def remove(self, *, render: bool = True) -> None:
        """Take the texture, its scalar bar and everything on the graphics card away.

        Parameters
        ----------
        render
            Whether to draw the plotter without it at once.
        """
        if self._plotter is None:
            return
        plotter, self._plotter = self._plotter, None
        self._end()
        self._view.close()
        self._layer.close()
        if self._bar is not None and self._bar in plotter.scalar_bars:
            plotter.remove_scalar_bar(self._bar, render=False)
        plotter.remove_actor(self.actor, render=False)
        self._forget(self)
        if render:
            plotter.render()

    def _changed(self, affects: Affects) -> None:
        if affects == "uniform":
            self._show_moment()
        else:
            textures = self._view.textures
            set_attributes(self._mesh, textures)
            self._layer.set_textures(textures)
        self._draw()

    def _show_moment(self) -> None:
        """Follow the time: textures at the steps around it, and the colours."""
        if self.field.steady or self._shown == self._view.time:
            return
        self._shown = self._view.time
        self._layer.set_moment(*self._view.moment)
        if self._scalars is not None:
            self._mesh.point_data[self._scalars] = self._view.scalar(self._scalars).ravel()

    def _draw(self) -> None:
        if self._plotter is not None:
            self._plotter.render()

    def __repr__(self) -> str:
        state = "removed" if self.closed else f"time {self.time:g}"
        return f"FlowHandle({self.field!r}, {state})"


@pv.register_plotter_component("flowtex")
class FlowtexComponent:
    """The flow textures of one plotter."""

    def __init__(self, plotter: Any) -> None:
        self._plotter = plotter
        self._handles: list[FlowHandle] = []

    def add(
        self,
        mesh: Any,
        vectors: str | None = None,
        scalars: str | bool | None = None,  # noqa: FBT001 False is "by nothing", as in PyVista
        cmap: str | Any | None = None,
        *,
        clim: tuple[float, float] | None = None,
        plane: str | None = None,
        times: Any | None = None,
        periodic: str | None = None,
        color: Any = PLAIN,
        opacity: float = 1.0,
        lighting: bool | None = None,
        show_scalar_bar: bool = True,
        scalar_bar_args: dict[str, Any] | None = None,
        reset_camera: bool | None = None,
        **settings: Any,
    ) -> FlowHandle:
        """Draw the flow on a structured mesh as a texture.

        Parameters
        ----------
        mesh
            A structured mesh with one flat index direction, a list of such meshes in time, or
            a :class:`~flowtex.FlowField`.
        vectors
            Name of the velocity; found when there is only one candidate.
        scalars
            What to colour by: the name of an array, ``"speed"`` (the default), or ``False`` for
            a plain texture.
        cmap, clim
            Colour map and range, as PyVista takes them. The range defaults to that over all
            times.
        plane
            Plane of a 3D mesh, such as ``"k=20"``.
        times, periodic
            As for :meth:`FlowField.from_pyvista`.
        color
            Colour of a plain texture.
        opacity
            1 is opaque, 0 invisible.
        lighting
            Whether the surface is lit; by default a curved one is and a flat one is not.
        show_scalar_bar, scalar_bar_args
            As for ``plotter.add_mesh``.
        reset_camera
            Whether to move the camera so that everything is seen; by default when this is
            the first mesh.
        **settings
            Any setting of :class:`~flowtex.Settings`, such as ``samples=25``.

        Returns
        -------
        FlowHandle

        Raises
        ------
        FieldError
            When the mesh does not make a field.
        SettingsError
            When a setting is unknown or out of range.
        """
        chosen = Settings()
        chosen.update(**settings)
        field = as_field(mesh, vectors=vectors, plane=plane, times=times, periodic=periodic)
        view = FlowView(field, chosen)
        name = self._scalar_name(view, scalars=scalars)
        look_first = reset_camera or (reset_camera is None and not self._plotter.renderer.actors)
        flat = view.textures.geometry.planar
        add_mesh: dict[str, Any] = {
            "opacity": opacity,
            "lighting": (not flat) if lighting is None else lighting,
            "reset_camera": False,
            "bar": {**BAR, **(scalar_bar_args or {})} if show_scalar_bar else None,
        }
        if name is None:
            add_mesh["color"] = color
        else:
            limits = view.scalar_range(name) if clim is None else clim
            add_mesh |= {"scalars": name, "cmap": cmap or CMAP, "clim": limits}
        handle = FlowHandle(self._plotter, view, name, add_mesh, self._forget)
        self._handles.append(handle)
        if look_first:
            look(self._plotter, field)
        return handle

    @staticmethod
    def _scalar_name(view: FlowView, *, scalars: str | bool | None) -> str | None:
        if scalars is False:
            return None
        name = "speed" if scalars is None or scalars is True else scalars
        view.scalar(name)
        return name

    def __iter__(self) -> Iterator[FlowHandle]:
        """Give the handles that have not been removed."""
        return iter(tuple(self._handles))

    def __len__(self) -> int:
        """Count the handles that have not been removed."""
        return len(self._handles)

    def clear(self, *, render: bool = True) -> None:
        """Remove every flow texture."""
        for handle in tuple(self._handles):
            handle.remove(render=False)
        if render:
            self._plotter.render()

    def _forget(self, handle: FlowHandle) -> None:
        if handle in self._handles:
            self._handles.remove(handle)

    def __plotter_close__(self) -> None:
        """Free the graphics card when the plotter closes."""
        self.clear(render=False)
