"""A scene as a browser is handed it: the header and the arrays that the client draws."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from flowtex._util.colours import colour_table, rgb
from flowtex.field import FlowField
from flowtex.options import Options
from flowtex.rendering.webgl import ClientData, Colours
from flowtex.scene import Scene, share_field, steps_of
from flowtex.settings import TABLE
from flowtex.tiles import Pyramid

__all__ = ["WebView", "even_steps", "web_views"]


class WebView:
    """A scene for a client in a browser.

    Of the time steps so many are handed over, evenly chosen with the first and the last among
    them; paths are traced through all of them all the same. ``own_settings`` are those of this
    view alone, where it stands beside another.

    Raises
    ------
    ValueError
        When there is no such colour or colour map, or fewer than one time step is asked for.
    """

    def __init__(
        self,
        scene: Scene,
        *,
        background: Any = "white",
        steps: int | None = None,
        own_settings: tuple[str, ...] = (),
    ) -> None:
        appearance = scene.appearance
        self.scene, self.own_settings = scene, own_settings
        self._times = even_steps(len(scene.field.times), steps)
        self._colours = Colours(
            table=colour_table(appearance.cmap),
            plain=rgb(appearance.color),
            background=rgb(background),
            lighting=scene.is_lit,
            opacity=float(appearance.opacity),
            bar=appearance.has_bar,
        )

    @property
    def field(self) -> FlowField:
        """The flow."""
        return self.scene.field

    def data(self) -> ClientData:
        """Return what the client is handed; makes noise textures, and traces nothing."""
        scene = self.scene
        return self._data(scene, scene.pyramid)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of nodes of what is handed over."""
        pyramid = self.scene.pyramid
        return self.field.shape if pyramid is None else pyramid.shape(pyramid.depth)

    def coarse_data(self, nodes: int) -> ClientData:
        """Return the same with so many nodes at most, for a first picture."""
        return self._data(self.scene.coarsened(nodes))

    def _data(self, scene: Scene, pyramid: Pyramid | None = None) -> ClientData:
        colours, name = self._colours, scene.scalar_name
        if name is not None:
            low, high = scene.scalar_limits
            values = steps_of(scene.textures.geometry.field, name)
            colours = replace(colours, name=name, values=values, low=low, high=high)
        return ClientData(scene.textures, colours, self._times, pyramid)

    def close(self) -> None:
        """Follow the settings no longer."""
        self.scene.close()


def web_views(mesh: Any, options: Options, *, steps: int | None = None) -> tuple[WebView, ...]:
    """Return the view of a mesh or a field, and one beside it if ``options.view`` asks for it.

    Equal meshes share their traces. ``steps`` and the errors are those of :class:`WebView` and
    :meth:`Scene.of`.
    """
    field = share_field(options.field.field(mesh))
    chosen = replace(options, field=type(options.field)())
    background, changes = options.view.background, options.view.beside
    first = Scene.from_options(field, chosen)
    views = [WebView(first, background=background, steps=steps)]
    if changes is not None:
        own = tuple(name for name in changes if name in TABLE)
        second = first.beside(changes, chosen)
        views.append(WebView(second, background=background, steps=steps, own_settings=own))
    return tuple(views)


def even_steps(count: int, steps: int | None) -> tuple[int, ...]:
    """Return so many of the numbers below a count, or none of them where all are asked for."""
    if steps is None or steps >= count:
        return ()
    if steps < 1:
        msg = f"steps is {steps}; expected 1 to {count}, the time steps of the field"
        raise ValueError(msg)
    if steps == 1:
        return (count - 1,)
    return tuple(round(n * (count - 1) / (steps - 1)) for n in range(steps))
