"""One flow texture on a plotter, which transfers changes of a scene to the graphics card."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pyvista as pv
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkTextProperty, vtkTextRenderer

from flowtex._util.arguments import checked_number
from flowtex._util.colours import colour_table
from flowtex.plotting.overlay import MapOverlay, StructureOverlay
from flowtex.rendering.constants import AMBIENT_LIGHT, DIFFUSE_LIGHT
from flowtex.rendering.vtk import FlowSurface, surface_mesh, use_flow_mapper
from flowtex.scene.attributes import AppearanceAttributes
from flowtex.scene.options import NO_VALUE_COLOR, Appearance, FieldOptions
from flowtex.scene.scene import Change, Scene, share_field

#: A lit surface: dark sides stay bright enough to read the texture there.
LIGHT = {"ambient": AMBIENT_LIGHT, "diffuse": DIFFUSE_LIGHT}
_count = itertools.count(1)
#: A scalar bar at the left border of the picture.
SCALAR_BAR: dict[str, Any] = {
    "fmt": "%.3g",
    "n_labels": 3,
    "vertical": True,  # labels of a level bar would hang over its ends
    "width": 0.08,
    "height": 0.28,
    "position_x": 0.02,
    "position_y": 0.04,
    "color": "black",
    "title_font_size": 16,
    "label_font_size": 14,
    "unconstrained_font_size": True,
}
#: Arguments by which users set the position or size of a bar.
BY_HAND = (
    *("width", "height", "position_x", "position_y", "vertical", "interactive"),
    *("title_font_size", "label_font_size"),
)
#: Arguments by which users set the background of a bar, and the default plate behind its texts:
#: one behind the whole bar would cover as much as the title is wide.
BEHIND, PLATE, PLATE_OPACITY = ("fill", "background_color", "color"), (1.0, 1.0, 1.0), 0.8
#: Height of the text: a share of the view's, within limits in points; a title's is larger.
TEXT_SHARE, LEAST_TEXT, MOST_TEXT, TITLE_SHARE = 1 / 34, 10, 14, 1.15
#: Height of a bar without its title: a share of the view's, and at least this many lines.
HEIGHT_SHARE, LEAST_LINES = 0.28, 5
#: Lengths in heights of the text: the width of the colours, and the room around texts.
THICKNESS, TEXT_PAD = 1.1, 0.4
#: Points in an inch.
POINTS = 72
#: Name of the bars that are arranged.
BARS_NAME = "flowtex"


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
    ) -> None:
        self._plotter = plotter
        self._forget = forget
        self.scene = scene
        mesh = surface_mesh(scene.textures)
        self.actor = plotter.add_mesh(
            mesh,
            name=f"flowtex {next(_count)}",
            color=scene.appearance.color,
            show_scalar_bar=False,
            reset_camera=False,
        )
        use_flow_mapper(self.actor, mesh)
        self._place = plotter.renderers.active_index
        self._bar_title: str | None = None
        self._bar_options = scalar_bar_args or {}
        self._end_arranging: Callable[[], None] = lambda: None
        self._bar_look = self._settings_of_bar
        self._surface = FlowSurface(
            self.actor, plotter.renderer, scene.textures, scene.settings, scene.pyramid
        )
        self._surface.set_moment(*scene.moment)
        self._map = self._map_of(scene)
        self._structure = StructureOverlay(self.actor, plotter.renderer, scene, self._surface)
        self._shown: Appearance | None = None
        self._show_appearance()
        self._shown_time = scene.time
        self._end = scene.observe(self._changed)
        self._is_made = True

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
        return self._surface.view.clock

    @clock.setter
    def clock(self, value: float) -> None:
        limit = float(np.finfo(float).max)
        expected = "a finite number of seconds"
        self._surface.view.clock = checked_number("clock", value, -limit, limit, expected=expected)
        self._draw()

    @property
    def still(self) -> bool:
        """Whether the grains of a time-varying flow stand still unless ``motion`` moves them.

        A picture of one moment is sharper so; from one frame to the next, grains should move.
        """
        return self._surface.view.still

    @still.setter
    def still(self, value: bool) -> None:
        self._surface.view.still = value
        self._draw()

    @property
    def density(self) -> float:
        """Number of drawn pixels, along a side, per pixel of the settings; 1 on an ordinary screen.

        A density of 2 draws the same picture with twice as many pixels along each side, for
        high-resolution screens, print and supersampling.
        """
        return self._surface.view.density

    @density.setter
    def density(self, value: float) -> None:
        least, expected = float(np.finfo(float).tiny), "a positive number, 1 for a standard screen"
        self._surface.view.density = checked_number("density", value, least, expected=expected)
        self._draw()

    @property
    def closed(self) -> bool:
        """Whether the texture has been removed."""
        return self._plotter is None

    def load_in_background(self, notify: Callable[[], None]) -> None:
        """Draw with the tiles that are ready; ``notify`` is called in a thread when more are.

        Only the visible tiles of a large surface are traced. By default a picture waits for the
        tiles that it needs.
        """
        self._surface.load_in_background(notify)
        self._structure.load_in_background(notify)

    @property
    def mesh(self) -> pv.PolyData:
        """PyVista mesh of the surface; of a large one, which has tiles, see :attr:`meshes`."""
        return self.meshes[0]

    @property
    def meshes(self) -> list[pv.PolyData]:
        """PyVista meshes of the last picture; several if the surface is large."""
        return self._surface.meshes

    def draw_for(self, height: int, whole: int) -> None:
        """Choose tiles for this many pixels of a ``whole`` picture and its drafts."""
        self._surface.full_height, self._surface.whole_height = height, whole

    @property
    def busy(self) -> bool:
        """Whether tiles or the structure of the last picture are still being computed."""
        return self._surface.busy or self._structure.busy

    def set_surface(self, mesh: Any, **options: Any) -> None:
        """Draw the flow on another surface, such as a cutting plane that has moved.

        Settings and appearance stay, and the time if the new flow has it.

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
        self.show_scene(self.scene.showing(share_field(FieldOptions(**options).field(mesh))))

    def show_scene(self, scene: Scene) -> None:
        """Show another scene with the same settings; if tracing fails, nothing changes."""
        try:
            textures = scene.textures
        except BaseException:
            scene.close()
            raise
        old, self.scene, self._shown_time = self.scene, scene, scene.time
        self._end()
        self._surface.show(textures, scene.pyramid, scene.moment)
        self._surface.set_moment(*scene.moment)
        if self._map is not None:
            self._map.close()
        self._map = self._map_of(scene)
        self._structure.show(scene)
        self._show_appearance("scalars", "lighting")
        scene.follow(old)
        self._end = scene.observe(self._changed)
        self._draw()

    def _map_of(self, scene: Scene) -> MapOverlay | None:
        if scene.field.projection is None:
            return None
        return MapOverlay(self.actor, self._plotter.renderer, scene, self._surface)

    def set_image(self, image: Any) -> None:
        """Advect another image, given as for the argument ``image``."""
        self.scene.set_image(image)

    def remove(self, *, render: bool = True) -> None:
        """Remove the texture and its scalar bar, and free the graphics memory.

        With ``render`` the plotter is redrawn at once.
        """
        if self._plotter is None:
            return
        plotter, self._plotter = self._plotter, None
        self._end()
        self.scene.close()
        if self._map is not None:
            self._map.close()
        self._structure.close()
        self._surface.close()
        self._remove_bar(plotter)
        plotter.remove_actor(self.actor, render=False)
        self._forget(self)
        if render:
            plotter.render()

    def _changed(self, affects: Change) -> None:
        if self._bar_look != (look := self._settings_of_bar):
            self._bar_look = look
            self._show_bar_colours()
        self._structure.show(self.scene)
        if affects == "uniform":
            self._show_moment()
        elif affects == "appearance":
            self._show_appearance()
        else:
            self._surface.set_textures(self.scene.textures, self.scene.pyramid)
            if self._map is not None:
                self._map.show()
        self._draw()

    def _show_moment(self) -> None:
        """Follow the time: textures at the steps around it, and the colours."""
        if self.field.steady or self._shown_time == self.scene.time:
            return
        self._shown_time = self.scene.time
        self._surface.set_moment(*self.scene.moment)
        self._surface.write_scalars()

    def _show_appearance(self, *anew: str) -> None:
        """Follow the appearance where it, or a name in ``anew``, changes; the actor's stays."""
        old, new = self._shown, self.scene.appearance
        self._shown = new

        def differs(*names: str) -> bool:
            return any(
                old is None or n in anew or getattr(old, n) is not getattr(new, n) for n in names
            )

        prop = self.actor.prop
        if differs("opacity"):
            prop.opacity = new.opacity
        if differs("visible"):
            self.actor.SetVisibility(new.visible)
        if differs("lighting"):
            prop.lighting = is_lit = self.scene.is_lit
            theme_lighting = pv.global_theme.lighting_params
            for name, value in LIGHT.items():
                setattr(prop, name, value if is_lit else getattr(theme_lighting, name))
        on_map = ("coastlines", "graticule", "land", "lighting", "opacity")
        if self._map is not None and differs(*on_map):
            self._map.show()
        if differs("color"):
            prop.color = new.color
        if differs("scalars", "cmap", "clim", "log_scale"):
            self._show_colours()
        if differs("scalars", "visible", "show_scalar_bar"):
            self._show_bar()

    def _show_colours(self) -> None:
        mapper, name, appearance = self.actor.mapper, self.scene.scalar_name, self.scene.appearance
        mapper.scalar_visibility = name is not None
        if name is None:
            return
        table = pv.LookupTable(values=colour_table(appearance.cmap))
        table.nan_color = NO_VALUE_COLOR
        table.log_scale = appearance.log_scale
        table.scalar_range = mapper.scalar_range = self.scene.scalar_limits
        mapper.lookup_table = table
        mapper.SelectColorArray(name)
        self._surface.set_scalars(name, lambda field: self.scene.scalar(name, field))
        self._show_bar_colours()

    def _show_bar(self) -> None:
        """Show a legend of the current colours, or none."""
        plotter, name = self._plotter, self.scene.scalar_name
        self._remove_bar(plotter)
        if name is None or not self.scene.appearance.has_bar:
            return
        title = self.scene.title_of(name)
        arguments = {"title": title, **SCALAR_BAR, **self._bar_options}
        renderers = plotter.renderers
        active = renderers.active_index
        renderers.set_active_renderer(*np.atleast_1d(renderers.index_to_loc(self._place)))
        bar_actor = plotter.add_scalar_bar(mapper=self.actor.mapper, render=False, **arguments)
        if bar_actor is not None:  # None if a bar with this title exists
            self._end_arranging = arrange_with(bar_actor, plotter.renderer, self._bar_options)
        renderers.set_active_renderer(*np.atleast_1d(renderers.index_to_loc(active)))
        self._bar_title = arguments["title"]
        self._show_bar_colours()

    @property
    def _settings_of_bar(self) -> tuple[float, float, str]:
        return self.settings.strength, self.settings.contrast, self.settings.noise

    def _show_bar_colours(self) -> None:
        """Show the mean colours of the picture in the bar, which the texture changes."""
        if self._bar_title is None or self._bar_title not in self._plotter.scalar_bars:
            return
        shown = self.actor.mapper.lookup_table
        table = pv.LookupTable(values=self.scene.legend_colours)
        table.scalar_range, table.log_scale = self.scene.legend_limits, shown.log_scale
        bar = self._plotter.scalar_bars[self._bar_title]
        bar.SetLookupTable(table)
        below, above = self.scene.beyond
        table.below_range_color = table.values[0] if below else None
        table.above_range_color = table.values[-1] if above else None
        bar.SetDrawBelowRangeSwatch(below)
        bar.SetDrawAboveRangeSwatch(above)
        bar.DrawAnnotationsOff()  # marks without a text

    def _remove_bar(self, plotter: Any) -> None:
        self._end_arranging()
        self._end_arranging = lambda: None
        if self._bar_title is not None and self._bar_title in plotter.scalar_bars:
            plotter.remove_scalar_bar(self._bar_title, render=False)
        self._bar_title = None

    def _draw(self) -> None:
        if self._plotter is not None:
            self._plotter.render()

    def __repr__(self) -> str:
        state = "removed" if self.closed else f"time {self.time:g}"
        return f"FlowHandle({self.field!r}, {state})"


def arrange_with(
    bar: vtkScalarBarActor, renderer: Any, options: Mapping[str, Any]
) -> Callable[[], None]:
    """Place a bar beside the others of a renderer whenever it draws, unless options place it.

    Returns a function that ends this.
    """
    if not any(name in options for name in BEHIND):
        for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
            text.SetBackgroundColor(*PLATE)
            text.SetBackgroundOpacity(PLATE_OPACITY)
    if any(name in options for name in BY_HAND):
        return lambda: None
    bar.SetObjectName(BARS_NAME)
    observer = renderer.AddObserver("StartEvent", lambda caller, _: _arrange(caller))
    return lambda: renderer.RemoveObserver(observer)


def _arrange(renderer: Any) -> None:
    """Place bars from left to right, and in a row above where there is no room."""
    width, height = renderer.GetSize()
    dpi = renderer.GetRenderWindow().GetDPI()
    x = y = row = 0.0
    for bar in renderer.GetViewProps():
        if bar.GetObjectName() != BARS_NAME:
            continue
        points = min(max(height * TEXT_SHARE * POINTS / dpi, LEAST_TEXT), MOST_TEXT)
        wide, high, title = _fit(bar, points, (width, height), dpi)
        line = points * dpi / POINTS
        gap = TEXT_PAD * line
        if x and x + wide + 2 * gap > width:
            x, y, row = 0.0, y + row + gap, 0.0
        # The lowest label hangs over the end of the bar.
        bar.SetPosition((x + gap) / width, (y + gap + line / 2) / height)
        bar.SetWidth(wide / width)
        bar.SetHeight((high + title) / height)
        # VTK keeps room for the title in the bar, and yet writes it above.
        x, row = x + gap + wide, max(row, high + 2 * title + line / 2)


def _fit(
    bar: vtkScalarBarActor, points: float, view: tuple[int, int], dpi: int
) -> tuple[float, float, float]:
    """Set the sizes of a bar's texts; return its width, its height, and that of the title."""
    title, labels = bar.GetTitleTextProperty(), bar.GetLabelTextProperty()
    labels.SetFontSize(round(points))
    title.SetFontSize(round(TITLE_SHARE * points))
    em = points * dpi / POINTS
    pad = round(TEXT_PAD * em)
    room = view[0] - 6 * pad
    title_width, title_height = _size(title, bar.GetTitle(), dpi)
    if title_width > room:
        title.SetFontSize(max(int(title.GetFontSize() * room / title_width), 1))
        title_width, title_height = _size(title, bar.GetTitle(), dpi)
    low, high = bar.GetLookupTable().GetRange()
    form = bar.GetLabelFormat()
    texts = [form % v if "%" in form else form.format(v) for v in (low, (low + high) / 2, high)]
    label_width = max(_size(labels, text, dpi)[0] for text in texts)
    thick = THICKNESS * em
    bar_width = max(title_width, thick + label_width + 2 * pad) + 2 * pad
    bar.SetTextPad(pad)
    bar.SetBarRatio(thick / bar_width)
    return bar_width, max(HEIGHT_SHARE * view[1], LEAST_LINES * em), title_height


def _size(text: vtkTextProperty, words: str, dpi: int) -> tuple[int, int]:
    """Return the width and height of a text in pixels."""
    box = [0, 0, 0, 0]
    vtkTextRenderer.GetInstance().GetBoundingBox(text, words, box, dpi)
    return box[1] - box[0] + 1, box[3] - box[2] + 1
