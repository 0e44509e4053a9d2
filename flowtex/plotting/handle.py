"""One flow texture on a plotter, which transfers changes of a scene to the graphics card."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pyvista as pv

from flowtex._util.arguments import checked_number
from flowtex._util.colours import rgb
from flowtex.errors import FieldError, notify
from flowtex.field.options import FieldOptions
from flowtex.field.validation import NO_DATA
from flowtex.plotting.bar_layout import checked_bar_options
from flowtex.plotting.bars import FlowBar
from flowtex.plotting.overlay import MapOverlay, StructureOverlay
from flowtex.rendering.map_overlay import missing_colour
from flowtex.rendering.shaders import const
from flowtex.rendering.vtk import FlowSurface, lookup_table, surface_mesh, use_flow_mapper
from flowtex.rendering.vtk.flow_mapper import Ends, Lacking
from flowtex.rendering.vtk.frame import FrameSteps, Step, weak_callback
from flowtex.scene.fields import read_field, share_field
from flowtex.scene.options import Appearance, AppearanceAttributes
from flowtex.scene.scene import Change, Scene
from flowtex.sources.meshes.parts import leaves

#: A lit surface: dark sides stay bright enough to read the texture there.
LIGHT = {"ambient": const.AMBIENT_LIGHT, "diffuse": const.DIFFUSE_LIGHT}
_count = itertools.count(1)
#: Fields of the appearance that change colours alone.
COLOURS = ("n_colors", "flip_scalars", "nan_color", "below_color", "above_color")


def _state(mesh: Any) -> tuple[int, ...]:
    """Return the time of the last change of meshes, which VTK counts; empty for other data."""
    if isinstance(mesh, (list, tuple)):
        meshes = mesh
    else:
        meshes = [mesh]
    times = []
    for one in meshes:
        if isinstance(one, pv.DataObject):
            times += [block.GetMTime() for _, block in leaves(one)]
    return tuple(times)


class FlowHandle(AppearanceAttributes):
    """One flow texture on a plotter.

    Its appearance can be changed at any time, as can :attr:`settings` and :attr:`time`:
    ``handle.cmap = "magma"``, ``handle.scalars = "pressure"``, ``handle.settings.lod = False``.

    Attributes
    ----------
    field
        The flow.
    settings
        Every setting, live.
    {appearance}
        Arguments of ``plotter.flowtex.add``, live.
    actor
        PyVista's actor, for its position and the like.
    scene
        The field, its appearance and its textures.

    Examples
    --------
    >>> import flowtex
    >>> import pyvista as pv
    >>> plotter = pv.Plotter(off_screen=True, window_size=(160, 120))
    >>> handle = plotter.flowtex.add(flowtex.examples.vortex_field(), samples=9)
    >>> handle.scalars, handle.cmap = "vorticity", "RdBu"
    >>> handle.settings.lod = False
    >>> handle.time = handle.field.times[3]
    >>> plotter.screenshot(return_img=True).shape
    (120, 160, 3)
    >>> plotter.close()
    """

    def __init__(
        self,
        plotter: Any,
        scene: Scene,
        forget: Callable[[FlowHandle], None],
        scalar_bar_args: Mapping[str, Any] | None = None,
        *,
        may_have_bar: bool = True,
        **actor_options: Any,
    ) -> None:
        bar_options = checked_bar_options(scalar_bar_args)
        mesh = surface_mesh(scene.textures)
        renderer = plotter.renderer
        actor = plotter.add_mesh(
            mesh,
            color=scene.appearance.color,
            show_scalar_bar=False,
            reset_camera=False,
            **{"name": f"flowtex {next(_count)}", **actor_options},
        )
        bar = FlowBar(plotter, use_flow_mapper(actor, mesh), bar_options)
        surface = FlowSurface(actor, renderer, scene.drawn, scene.settings)
        self.scene = scene
        self.actor = actor
        self.bar = bar
        self._may_have_bar = may_have_bar
        self._plotter = plotter
        self._renderer = renderer
        self._forget = forget
        self.surface = surface
        self._shown_time = scene.time
        self._end = scene.observe(self._changed)
        self._shown: Appearance | None = None
        #: What the flow was read from, and how, and the state in which that was.
        self._source: tuple[Any, FieldOptions] | None = None
        self._state: tuple[int, ...] = ()
        self._map = MapOverlay(actor, renderer, scene, surface)
        self._structure = StructureOverlay(actor, renderer, scene, surface)
        self._show_appearance()
        self._follow_renderer()
        self._is_made = True

    def _follow_renderer(self) -> None:
        """Take part in each frame, and notice when the actor is removed."""
        FrameSteps.of(self._renderer).add(Step.CHANGES, self._before_frame)
        props = self._renderer.GetViewProps()
        self._props_observer = props.AddObserver("ModifiedEvent", weak_callback(self._check_actor))

    @property
    def time(self) -> float:
        """The time shown, in the field's unit."""
        return self.scene.time

    @time.setter
    def time(self, value: float | str) -> None:
        self.scene.time = value

    @property
    def clock(self) -> float:
        """Clock of the animation in seconds; set it to draw any frame."""
        return self.surface.view.clock

    @clock.setter
    def clock(self, value: float) -> None:
        limit = float(np.finfo(float).max)
        expected = "a finite number of seconds"
        self.surface.view.clock = checked_number("clock", value, -limit, limit, expected=expected)
        self._draw()

    @property
    def density(self) -> float:
        """Number of drawn pixels, along a side, per pixel of the settings; 1 on an ordinary screen.

        A density of 2 draws the same picture with twice as many pixels along each side, for
        high-resolution screens, print and supersampling.
        """
        return self.surface.view.density

    @density.setter
    def density(self, value: float) -> None:
        least = float(np.finfo(float).tiny)
        expected = "a positive number, 1 for a standard screen"
        self.surface.view.density = checked_number("density", value, least, expected=expected)
        self._draw()

    @property
    def renderer(self) -> Any:
        """The renderer of the part of the window with the texture."""
        return self._renderer

    @property
    def closed(self) -> bool:
        """Whether the texture has been removed."""
        return self._plotter is None

    def load_in_background(self, notify: Callable[[], None]) -> None:
        """Draw with the tiles that are ready; ``notify`` is called in a thread when more are.

        Only the visible tiles of a large surface are traced. By default a picture waits for the
        tiles that it needs.
        """
        self.surface.load_in_background(notify)
        self._structure.notify = notify

    @property
    def busy(self) -> bool:
        """Whether tiles or the structure of the last picture are still being computed."""
        return self.surface.busy or self._structure.busy

    def set_surface(self, mesh: Any, **options: Any) -> None:
        """Draw the flow on another surface, such as a cutting plane that has moved.

        Settings and appearance stay, and the time if the new flow has it. By default the colours
        have the range of the new flow, which for a slice is that of its volume.

        Parameters
        ----------
        mesh
            As for ``plotter.flowtex.add``.
        **options
            The part of the mesh to draw, such as ``slice="x=0.5"``, as for ``plotter.flowtex.add``.

        Raises
        ------
        FieldError
            When the mesh does not contain a flow, or lacks the scalar that colours the surface;
            nothing is changed then.
        """
        reading = FieldOptions.of(**options)
        field = share_field(read_field(mesh, reading))
        self.show_scene(self.scene.showing(field, keep_range=False), render=False)
        # Before it is drawn: a frame reads the followed mesh again if it has changed.
        self.follow_mesh(mesh, reading)
        self._draw()

    def follow_mesh(self, mesh: Any, reading: FieldOptions) -> None:
        """Read a PyVista mesh again before a frame if it has been changed in place."""
        self._source = (mesh, reading)
        self._state = _state(mesh)

    def read_changes(self) -> None:
        """Draw the mesh again if it has changed; a warning says why it cannot be drawn."""
        if self._source is None or self._state == (state := _state(self._source[0])):
            return
        (mesh, reading) = self._source
        self._state = state
        try:
            field = share_field(read_field(mesh, reading))
            if field is not self.scene.field:
                self.show_scene(self.scene.showing(field), render=False)
        except FieldError as error:
            text = "the mesh has changed and cannot be drawn, so the image shows it as it was"
            notify(f"{text}: {error}", UserWarning)

    def show_scene(self, scene: Scene, *, render: bool = True) -> None:
        """Show another scene with the same settings; if tracing fails, nothing changes.

        Raises
        ------
        FieldError
            When the scene cannot be traced; it is closed, and the present one stays.
        """
        try:
            drawn = scene.drawn
        except BaseException:
            scene.close()
            raise
        old = self.scene
        self.scene = scene
        self._shown_time = scene.time
        self._end()
        self.surface.show(drawn)
        self._map.show(scene)
        self._structure.show(scene)
        self._show_appearance("lighting")
        self._show_colours()
        self._show_bar()
        scene.follow(old)
        self._end = scene.observe(self._changed)
        if render:
            self._draw()

    def set_image(self, image: Any) -> None:
        """Advect another image, given as for the argument ``image``."""
        self.scene.set_image(image)

    def remove(self, *, render: bool = True) -> None:
        """Remove the texture and its scalar bar, and free the graphics memory.

        With ``render`` the plotter is redrawn at once.
        """
        if self._plotter is None:
            return
        plotter = self._plotter
        self._plotter = None
        FrameSteps.of(self._renderer).remove(self._before_frame)
        self._renderer.GetViewProps().RemoveObserver(self._props_observer)
        self._end()
        self.scene.close()
        self._map.close()
        self._structure.close()
        self.surface.close()
        self.bar.remove()
        plotter.remove_actor(self.actor, render=False)
        self._forget(self)
        if render:
            plotter.render()

    def _before_frame(self, _renderer: pv.Renderer) -> None:
        """Follow changes of the mesh, and of others that share the colour bar."""
        self.read_changes()
        self._look_at_bar()

    def _check_actor(self) -> None:
        """Remove the rest when the actor is removed, as by ``plotter.clear_actors()``."""
        if self._plotter is not None and not self._renderer.HasViewProp(self.actor):
            self.remove(render=False)

    def _changed(self, affects: Change) -> None:
        """Draw the scene again after a change."""
        self._structure.show(self.scene)
        if affects == "uniform":  # perhaps the time: textures at the steps around it, and colours
            if not self.field.steady and self._shown_time != self.scene.time:
                self._shown_time = self.scene.time
                self.surface.show(self.scene.drawn)
        elif affects == "appearance":
            self._show_appearance()
        else:
            self.surface.show(self.scene.drawn)
            self._map.show(self.scene)
            self._show_bar()  # which an image has not by default
        self._draw()

    def _show_appearance(self, *anew: str) -> None:
        """Follow the appearance where it, or a name in ``anew``, changes; the actor's stays."""
        old = self._shown
        new = self.scene.appearance
        self._shown = new

        def differs(*names: str) -> bool:
            if old is None or not set(anew).isdisjoint(names):
                return True
            return any(getattr(old, name) is not getattr(new, name) for name in names)

        prop = self.actor.prop
        if differs("opacity"):
            prop.opacity = new.opacity
        if differs("visible"):
            self.actor.SetVisibility(new.visible)
        if differs("lighting"):
            prop.lighting = self.scene.is_lit
            for name, value in LIGHT.items():
                if not self.scene.is_lit:
                    value = getattr(pv.global_theme.lighting_params, name)
                setattr(prop, name, value)
        if old is not None and differs("coastlines", "graticule", "land", "lighting", "opacity"):
            self._map.show(self.scene)
        if differs("color"):
            prop.color = new.color
        if differs("scalars", "cmap", "log_scale", "norm", *COLOURS):
            self.bar.remove()
            self._show_colours()
        elif differs("clim") or self.actor.mapper.ends.limits != self.scene.scalar_limits:
            self._show_colours()
        on_bar = ("scalars", "cmap", "clim", "log_scale", "norm", "visible", "show_scalar_bar")
        if differs(*on_bar, *COLOURS):
            self._show_bar()

    def _show_colours(self) -> None:
        mapper = self.actor.mapper
        name = self.scene.scalar_name
        mapper.scalar_visibility = name is not None
        if name is None:
            return
        self._table = mapper.lookup_table = lookup_table(self.scene.colour_scale)
        are_chosen = isinstance(self.scene.appearance.clim, tuple)
        mapper.ends = Ends(self.scene.scalar_limits, self.scene.scalar_range(name), are_chosen)
        self.bar.fit()
        mapper.SelectColorArray(name)
        self.surface.show(self.scene.drawn)

    def _show_bar(self) -> None:
        """Show the bar of the colours, or remove it where the scene has none."""
        name = self.scene.scalar_name
        has_bar = self._may_have_bar and self.scene.has_bar
        if name is None or not has_bar:
            self.bar.remove()
            return
        title = self.scene.title_of(name)
        # The name alone is that of PyVista's bars; the speed is no array of theirs.
        if name not in self.field.scalars:
            name = title
        self.bar.show(name, title)
        self._look_at_bar()

    def _look_at_bar(self) -> None:
        """Show the mean colours of the picture in the bar, which the texture changes."""
        settings = self.settings.strength, self.settings.contrast, self.settings.noise
        self.actor.mapper.lacking = self._lacking
        self.bar.look(lambda: self.scene.legend_colours, settings)

    @property
    def _lacking(self) -> Lacking | None:
        """What the bar says of missing values of the flow, or else of the map without data."""
        if self.scene.lacks_values:
            return Lacking(NO_DATA, rgb(self.scene.appearance.nan_color))
        if self._map.has_missing:
            colour = missing_colour(self._renderer.GetBackground())
            return Lacking(NO_DATA, tuple(colour.tolist()))
        return None

    def _draw(self) -> None:
        if self._plotter is not None:
            self._plotter.render()

    def __repr__(self) -> str:
        if self.closed:
            state = "removed"
        else:
            state = f"time {self.time:g}"
        return f"FlowHandle({self.field!r}, {state})"
