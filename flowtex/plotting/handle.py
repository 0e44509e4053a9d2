"""One flow texture on a plotter: it carries changes of a scene to the graphics card."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from typing import Any

from flowtex._util.colours import DEFAULT_CMAP
from flowtex.field import FlowField
from flowtex.rendering.constants import AMBIENT_LIGHT, DIFFUSE_LIGHT
from flowtex.rendering.vtk import FlowSurface, surface_mesh, use_flow_mapper
from flowtex.scene import Scene
from flowtex.settings import Affects, Settings

__all__ = ["FlowHandle"]

#: A lit surface: dark sides stay bright enough to read the texture there.
LIGHT: dict[str, Any] = {"ambient": AMBIENT_LIGHT, "diffuse": DIFFUSE_LIGHT}

#: A scalar bar that keeps out of the picture's way.
SCALAR_BAR: dict[str, Any] = {
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
    scene
        The arrays behind the picture.
    """

    def __init__(
        self,
        plotter: Any,
        scene: Scene,
        forget: Callable[[FlowHandle], None],
        scalar_bar_args: Mapping[str, Any] | None = None,
    ) -> None:
        self._plotter = plotter
        self._forget = forget
        self.scene = scene
        mesh = surface_mesh(scene.textures)
        name, appearance = scene.scalar_name, scene.appearance
        lit = scene.is_lit
        options: dict[str, Any] = {"opacity": appearance.opacity, "lighting": lit}
        options |= LIGHT if lit else {}
        if name is None:
            options["color"] = appearance.color
        else:
            mesh.point_data[name] = scene.scalar(name, scene.textures.geometry.field).ravel()
            options |= {"scalars": name, "cmap": appearance.cmap or DEFAULT_CMAP}
            options["clim"] = scene.scalar_limits
        self.actor = plotter.add_mesh(
            mesh,
            name=f"flowtex {next(_count)}",
            show_scalar_bar=False,
            reset_camera=False,
            **options,
        )
        mapper = use_flow_mapper(self.actor, mesh, name)
        self._bar_title: str | None = None
        if name is not None and appearance.has_bar:
            bar = {"title": name, **SCALAR_BAR, **(scalar_bar_args or {})}
            plotter.add_scalar_bar(mapper=mapper, **bar)
            self._bar_title = bar["title"]
        self._surface = FlowSurface(
            self.actor, plotter.renderer, scene.textures, scene.settings, scene.pyramid
        )
        self._surface.set_moment(*scene.moment)
        if name is not None:
            self.set_scalars(name, name)
        self._shown_time = scene.time
        self._end = scene.observe(self._changed)

    @property
    def field(self) -> FlowField:
        """The flow."""
        return self.scene.field

    @property
    def settings(self) -> Settings:
        """Every setting, live."""
        return self.scene.settings

    @property
    def scalars(self) -> str | None:
        """Name of what the texture is coloured by; ``None`` for a plain one."""
        return self.scene.scalar_name

    @property
    def time(self) -> float:
        """Time that is shown, in the field's own unit."""
        return self.scene.time

    @time.setter
    def time(self, value: float) -> None:
        self.scene.time = value

    @property
    def clock(self) -> float:
        """Clock of the animation in seconds; set it to draw the frame of any moment."""
        return self._surface.view.clock

    @clock.setter
    def clock(self, value: float) -> None:
        self._surface.view.clock = float(value)
        self._draw()

    @property
    def density(self) -> float:
        """Pixels drawn, along a side, for one that the settings speak of; 1 on a plain screen.

        Twice the density shows the same in twice as many pixels, as fine screens, print and
        supersampling want it.
        """
        return self._surface.view.density

    @density.setter
    def density(self, value: float) -> None:
        if not value > 0:
            msg = f"density is {value!r}; expected a positive number, 1 for a plain screen"
            raise ValueError(msg)
        self._surface.view.density = float(value)
        self._draw()

    @property
    def closed(self) -> bool:
        """Whether the texture has been removed."""
        return self._plotter is None

    def load_in_background(self, notify: Callable[[], None]) -> None:
        """Draw with the tiles that are there; ``notify`` is called in a thread when there are more.

        Of a large surface only what is seen is traced, in tiles. By default a picture waits for
        those that it needs.
        """
        self._surface.load_in_background(notify)

    def draw_for(self, height: int | None) -> None:
        """Choose tiles as for a picture of so many pixels, of which the next ones are drafts."""
        self._surface.full_height = height

    @property
    def busy(self) -> bool:
        """Whether tiles of the last picture are on their way."""
        return self._surface.busy

    def set_scalars(self, array: str, name: str) -> None:
        """Write a scalar of the scene to a point array of what is drawn, at all times shown."""
        self._surface.set_scalars(array, lambda field: self.scene.scalar(name, field))

    def set_image(self, image: Any) -> None:
        """Advect another image; as :meth:`Scene.set_image <flowtex.scene.Scene.set_image>`."""
        self.scene.set_image(image)

    def remove(self, *, render: bool = True) -> None:
        """Take the texture, its scalar bar and everything on the graphics card away.

        The plotter is drawn without it at once where ``render`` says so.
        """
        if self._plotter is None:
            return
        plotter, self._plotter = self._plotter, None
        self._end()
        self.scene.close()
        self._surface.close()
        if self._bar_title is not None and self._bar_title in plotter.scalar_bars:
            plotter.remove_scalar_bar(self._bar_title, render=False)
        plotter.remove_actor(self.actor, render=False)
        self._forget(self)
        if render:
            plotter.render()

    def _changed(self, affects: Affects) -> None:
        if affects == "uniform":
            self._show_moment()
        else:
            self._surface.set_textures(self.scene.textures, self.scene.pyramid)
        self._draw()

    def _show_moment(self) -> None:
        """Follow the time: textures at the steps around it, and the colours."""
        if self.field.steady or self._shown_time == self.scene.time:
            return
        self._shown_time = self.scene.time
        self._surface.set_moment(*self.scene.moment)
        self._surface.write_scalars()

    def _draw(self) -> None:
        if self._plotter is not None:
            self._plotter.render()

    def __repr__(self) -> str:
        state = "removed" if self.closed else f"time {self.time:g}"
        return f"FlowHandle({self.field!r}, {state})"
