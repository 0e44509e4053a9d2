"""One flow texture on a plotter.

A handle joins a :class:`~flowtex.view.FlowView` (arrays, settings, time) to a
:class:`~flowtex.rendering.vtk.FlowLayer` (the graphics card) and carries changes from one to the
other.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

from flowtex.field import FlowField
from flowtex.rendering.vtk import FlowLayer, set_attributes, surface_mesh, use_flow_mapper
from flowtex.settings import Affects, Settings
from flowtex.textures.image_files import load_image
from flowtex.view import FlowView

__all__ = ["FlowHandle"]

_count = itertools.count(1)


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
    def scalars(self) -> str | None:
        """Name of what the texture is coloured by; ``None`` for a plain one."""
        return self._scalars

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
    def density(self) -> float:
        """Pixels drawn, along a side, for one that the settings speak of; 1 on a plain screen.

        Twice the density shows the same in twice as many pixels, as fine screens, print and
        supersampling want it.
        """
        return self._layer.view.density

    @density.setter
    def density(self, value: float) -> None:
        if not value > 0:
            msg = f"density is {value!r}; expected a positive number, 1 for a plain screen"
            raise ValueError(msg)
        self._layer.view.density = float(value)
        self._draw()

    @property
    def closed(self) -> bool:
        """Whether the texture has been removed."""
        return self._plotter is None

    def set_image(self, image: Any) -> None:
        """Advect another image, and set ``settings.noise`` to ``"image"``.

        Parameters
        ----------
        image
            As for ``plotter.flowtex.add``.

        Raises
        ------
        ImageError
            When it cannot be used; nothing is changed then.
        """
        self._view.set_image(load_image(image))

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
