"""A scene as it is sent to a browser: the header and the arrays that the client draws."""

from __future__ import annotations

import sys
from collections.abc import Collection
from dataclasses import replace
from functools import partial
from typing import Any

from flowtex._util.arguments import checked_count
from flowtex._util.colours import colour_table, rgb
from flowtex.field import FlowField
from flowtex.field.derived import steps_of
from flowtex.rendering.webgl import ClientData, Colours
from flowtex.rendering.webgl.bodies import Bodies
from flowtex.rendering.webgl.marks import MARK_PARTS, Marks
from flowtex.rendering.webgl.protocol import Header
from flowtex.scene.options import Options, default_cmap
from flowtex.scene.scene import Scene, share_field
from flowtex.settings import TABLE
from flowtex.sources.notices import notify_section
from flowtex.textures.tiles import Pyramid


class WebView:
    """A scene for a client in a browser.

    ``steps`` time steps are sent, evenly spaced including the first and the last; paths are traced
    through all of them. ``own`` names the settings and the fields of the appearance in which this
    view differs from the one beside it. ``bodies`` are drawn with the
    flow.
    """

    def __init__(
        self,
        scene: Scene,
        *,
        background: Any | None = None,
        steps: int | None = None,
        own: Collection[str] = (),
        bodies: Bodies | None = None,
    ) -> None:
        self.scene, self._bodies, self.own = scene, bodies, tuple(own)
        self.own_settings = tuple(name for name in own if name in TABLE)
        self._times = even_steps(len(scene.field.times), steps)
        self._background = None if background is None else rgb(background)

    @property
    def field(self) -> FlowField:
        """The flow."""
        return self.scene.field

    def data(self) -> ClientData:
        """Return the data for the client; makes noise textures, and traces nothing."""
        scene = self.scene
        return self._data(scene, scene.pyramid)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of nodes of what is sent."""
        pyramid = self.scene.pyramid
        return self.field.shape if pyramid is None else pyramid.shape(pyramid.depth)

    def page_data(self) -> ClientData:
        """Return the same with the values of all scalars, for pages without a server."""
        data, names = self.data(), self.scene.scalar_names
        others = tuple(
            (n, steps_of(data.field, name))
            for n, name in enumerate(names)
            if name != self.scene.scalar_name
        )
        colours, settings = replace(data.colours, others=others), self.scene.settings
        # A client finds the structure of a formula itself.
        is_whole = data.formula is not None
        drawn = [part for name, part in MARK_PARTS.items() if is_whole or getattr(settings, name)]
        kinds = [kind for kind in drawn if data.marks and kind in data.marks.kinds]
        marks = data.marks and replace(data.marks, kinds=tuple(kinds), carried=True)
        return replace(data.recoloured(colours), marks=marks if kinds else None)

    def coarse_data(self, nodes: int) -> ClientData:
        """Return the same with at most this many nodes, for a first picture."""
        return self._data(self.scene.coarsened(nodes))

    def _data(self, scene: Scene, pyramid: Pyramid | None = None) -> ClientData:
        textures = scene.textures
        colours = colours_of(self.scene, textures.geometry.field, self._background)
        return ClientData(
            textures,
            colours,
            self._times,
            pyramid,
            traces=True,
            bodies=self._bodies,
            marks=marks_of(self.scene),
        )

    def show(self, field: FlowField) -> None:
        """Show another flow in the same way; raises what :meth:`Scene.showing` does."""
        before, self.scene = self.scene, self.scene.showing(field)
        self.scene.follow(before)

    def recoloured(self, data: ClientData) -> ClientData:
        """Return the data of the client with the current colours."""
        return data.recoloured(colours_of(self.scene, data.field, self._background))

    def close(self) -> None:
        """Stop following the settings."""
        self.scene.close()


def marks_of(scene: Scene) -> Marks | None:
    """Return the critical points and separatrices of a scene, found when they are requested."""
    if scene.field.sign_free:
        return None
    is_flat = scene.field.surface.frame is not None
    kinds = (kind for kind in MARK_PARTS.values() if is_flat or kind != "nullclines")
    return Marks(scene.structure, tuple(kinds))


def colours_of(
    scene: Scene, field: FlowField, background: tuple[float, float, float] | None
) -> Colours:
    """Return the colours of a scene on its field, or on a coarser form of it."""
    look, name = scene.appearance, scene.scalar_name
    low, high = scene.scalar_limits
    return Colours(
        name=name,
        unit="" if name is None else scene.field.unit_of(name),
        number=0 if name is None else scene.scalar_names.index(name),
        choices=choices_of(scene),
        cmap=look.cmap if isinstance(look.cmap, str) else "",
        auto=look.clim is None,
        values=None if name is None else steps_of(field, name),
        low=low,
        high=high,
        log_scale=look.log_scale,
        table=colour_table(look.cmap),
        plain=rgb(look.color),
        background=background,
        lighting=scene.is_lit,
        opacity=float(look.opacity) if look.visible else 0.0,
        bar=look.has_bar,
        label="" if name is None else scene.label_of(name),
        coastlines=look.coastlines is not False,
        graticule=look.graticule is not False,
        land=None if look.land is None else rgb(look.land),
    )


def choices_of(scene: Scene) -> tuple[Header, ...]:
    """Return the scalars that can colour the surface, with their own ranges."""
    choices: list[Header] = []
    for name in scene.scalar_names:
        (low, high), (least, most) = scene.usual_range(name), scene.scalar_range(name)
        steps = len(scene.field.scalars.get(name, scene.field.velocity))
        choices.append(
            {
                "name": name,
                "label": scene.label_of(name),
                "unit": scene.field.unit_of(name),
                "cmap": default_cmap(name),
                "low": low,
                "high": high,
                "least": least,
                "most": most,
                "steps": steps,
            }
        )
    return tuple(choices)


def browser_options(mesh: Any, **options: Any) -> tuple[Any, Options]:
    """Return the mesh or field to draw, and the sorted arguments.

    For a PyVista plotter they are those of its first flow texture, with the other objects of the
    scene; ``options`` have precedence.
    """
    pyvista = sys.modules.get("pyvista")
    if pyvista is None or not isinstance(mesh, pyvista.BasePlotter):
        return mesh, Options.split(mesh=mesh, **options)
    field, look, bodies = mesh.flowtex.for_browser()
    arguments = {name: value for name, value in options.items() if value is not None}
    return field, replace(Options.split(**{**look, **arguments}), bodies=bodies)


def web_views(mesh: Any, options: Options, *, steps: int | None = None) -> tuple[WebView, ...]:
    """Return the view of a mesh or a field, and one beside it if ``options.view`` asks for it.

    Equal meshes share their traces. ``steps`` and the errors are those of :class:`WebView` and
    :meth:`Scene.of`.
    """
    field = share_field(options.field.field(mesh))
    notify_section(field.section)
    background, changes = options.view.background, options.view.beside
    first = Scene(field, options.make_settings(field), options.appearance)
    make = partial(WebView, background=background, steps=steps, bodies=options.bodies)
    views = [make(first)]
    if changes is not None:
        views.append(make(first.beside(changes), own=changes))
    return tuple(views)


def even_steps(count: int, steps: int | None) -> tuple[int, ...]:
    """Return evenly spaced time steps, ``steps`` out of ``count``; empty for all of them."""
    if steps is None:
        return ()
    expected = f"1 to {count}, the time steps of the field"
    steps = checked_count("steps", steps, expected=expected)
    if steps >= count:
        return ()
    if steps == 1:
        return (count - 1,)
    return tuple(round(n * (count - 1) / (steps - 1)) for n in range(steps))
