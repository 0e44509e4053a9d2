"""The image of a flow on matplotlib axes, redrawn for the limits that they show."""

from __future__ import annotations

import warnings
from contextlib import closing
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.colors import Colormap, ListedColormap, LogNorm, Normalize
from matplotlib.image import AxesImage
from matplotlib.patches import Polygon
from matplotlib.transforms import Affine2D
from PIL import Image

from flowtex._util.arguments import brief
from flowtex._util.array_types import Bytes, Floats
from flowtex._util.colours import colour_map, norm_scale
from flowtex.errors import FieldError
from flowtex.field import FlowField, Surface
from flowtex.field.dates import time_text
from flowtex.field.earth.projection import Projection
from flowtex.field.finer import finest_of
from flowtex.field.options import FieldOptions
from flowtex.plotting.offscreen.axes_kinds import (
    AxesScales,
    SameMap,
    is_geo,
    label_degrees,
    projection_of_axes,
    same_map,
    unit_of,
    with_polar_scalars,
)
from flowtex.plotting.offscreen.plotter import NOTHING_SEEN, OffscreenPlotter
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu.shade import mean_colours
from flowtex.rendering.map_overlay import ground_colours
from flowtex.scene.fields import is_stored, read_field
from flowtex.scene.options import Options, ViewOptions, coast_of
from flowtex.scene.scene import make_scenes
from flowtex.sources.reproject import reprojected

#: Matplotlib's ``extend`` of a colour bar, by whether values lie below and above its ends.
EXTENDED = {(False, True): "max", (True, False): "min", (True, True): "both"}
#: Kind of axes, and names of the scales of usual ones.
LINEAR = ("rectilinear", "linear", "linear")
USUAL_DPI = 100.0  #: Dots per inch at which a grain has the pixels of the settings.
#: Longest side of the drawn picture where the scales of the axes differ, in pixels.
LONGEST_SIDE_PX = 8192
EDGE_COLOR = "0.3"  #: Colour of the border of a legend's patches.


class FlowImage(AxesImage):
    """A flow on matplotlib axes, redrawn for the limits that they show.

    :func:`flowtex.axes` returns it. It has the colour map and the norm of the picture, for a colour
    bar.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import flowtex
    >>> figure, ax = plt.subplots()
    >>> image = flowtex.axes(ax, flowtex.examples.vortex_field(), scalars="vorticity")
    >>> image.time = 0.5  # the axes are drawn anew when they are shown or saved next
    >>> plt.close(figure)
    """

    _changes = 0  #: Number of changes of the norm and the colour map.

    def __init__(self, ax: Axes, mesh: Any, options: Options, supersampling: int) -> None:
        self._unit = Affine2D()
        self._turn = 0.0
        if is_geo(ax):
            mesh, options, placed = _on_map(ax, mesh, options)
            self._unit = placed.transform
            self._turn = placed.turn
        if _kind(ax)[0] == "polar":
            mesh = read_field(mesh, options.field)
            options = replace(options, field=FieldOptions())
            scalar = options.appearance.scalar_name
            mesh = with_polar_scalars(mesh, plane_frame(mesh.surface), scalar)
        (self._scene,) = make_scenes(mesh, options)
        self._flow = self._scene.field
        self._projection = self._flow.projection
        if is_geo(ax):
            _check_earth(self._flow)
        else:
            self._unit = unit_of(self._projection)
        self._frame = plane_frame(self._scene.whole.surface)
        self._scales: AxesScales | None = None
        self._supersampling = supersampling
        self._clock = 0.0
        self._shown: tuple[object, ...] = ()
        self._picture = np.zeros((1, 1, 4), np.uint8)
        is_scaled = not is_geo(ax) and _kind(ax) != LINEAR
        corners = self._corners(ax, is_scaled=is_scaled)
        (left, bottom), (right, top) = corners.tolist()
        _limit(ax, *self._ends(ax, left, right), bottom, top)
        if is_scaled:
            self._follow_scales(AxesScales(ax, framed=False))
        super().__init__(ax, extent=(left, right, bottom, top))
        # Pixels have no values, but a colour bar and a norm without limits need some.
        self.set_data([self._scene.legend_limits])
        self.mouseover = False
        if self._scene.scalar_name is not None:
            super().set_cmap(self._bar_colours())
            self.set_norm(self._norm())
        self._first_norm = self.norm
        self._first_clim = self.get_clim()
        self._title = ""

    def _corners(self, ax: Axes, *, is_scaled: bool) -> Floats:
        """Return the lower left and the upper right corner of the flow on the axes, (2, 2)."""
        if is_scaled:
            return AxesScales(ax, framed=False).extent(self._flow, self._frame)
        surface = self._scene.whole.surface
        middle = self._frame @ surface.center
        half = surface.plane_size / 2
        corners: Floats = self._unit.inverted().transform([middle - half, middle + half])
        return corners

    def _norm(self) -> Any:
        """Return the norm of the colour bar."""
        look = self._scene.appearance
        if look.norm is not None:
            return look.norm
        if look.log_scale:
            return LogNorm(*self._scene.legend_limits)
        return Normalize(*self._scene.legend_limits)

    def _ends(self, ax: Any, left: float, right: float) -> tuple[float, float]:
        """Return the ends along x, the map's own ends where the flow may lie at both of them."""
        if not self._turn:
            return left, right
        low, high = ax.projection.x_limits
        return float(low), float(high)

    def _bar_colours(self) -> Colormap:
        """Return the colours of a colour bar, which are those of the picture."""
        look = self._scene.appearance
        scale = self._scene.colour_scale
        # As many as the map has, as a norm may return their numbers.
        chosen = colour_map(look.cmap, look.n_colors, flip=look.flip_scalars)
        rows = np.vstack([chosen(np.arange(chosen.N))[:, :3], scale.texels[[0, -2, -1], :3]])
        means = mean_colours(np.rint(255 * rows).astype(np.uint8), self._scene.settings) / 255
        *inside, below, above, nan = means
        # In matplotlib colorbar_extend is a word, in its type a bool.
        colours: Any = ListedColormap(inside).with_extremes(under=below, over=above, bad=nan)
        colours.colorbar_extend = EXTENDED.get(self._scene.beyond, "neither")
        return colours

    def set_norm(self, norm: Any) -> None:
        """Draw the scalars by another norm; limits that it lacks become the ends of the scalars.

        Parameters
        ----------
        norm
            A matplotlib norm, or its name, such as ``"log"``.

        Raises
        ------
        FieldError
            When flowtex cannot draw colours by this norm; the norm before stays.
        ValueError
            When matplotlib rejects the norm or its limits; the norm before stays.
        """
        before = self.norm
        super().set_norm(norm)
        try:
            self.autoscale_None()
            norm_scale(self.norm, self.cmap)
        except (FieldError, ValueError):
            super().set_norm(before)
            raise

    def changed(self) -> None:
        """Draw anew after a change of the norm or the colour map."""
        self._changes += 1
        super().changed()

    def set_cmap(self, cmap: str | Colormap) -> None:
        """Draw the scalars with another colour map, by its name or a colour map of matplotlib."""
        if self._scene.scalar_name is None:
            return
        self._scene.appearance = self._scene.appearance.changed(cmap=cmap)
        super().set_cmap(self._bar_colours())

    def _follow_scales(self, scales: AxesScales | None) -> None:
        """Transform the flow to the scales of the axes."""
        if (scales and scales.key) == (self._scales and self._scales.key):
            return
        if scales is not None and self._projection is not None:
            kind = f"with scales {scales.names}"
            if scales.polar:
                kind = "polar"
            raise FieldError(
                f"ax is {kind}, but the data are of the Earth; expected linear axes, or those of "
                "cartopy"
            )
        flow = self._flow
        if scales is not None:
            flow = scales.field(flow, plane_frame(flow.surface))
        before = self._scene
        self._scales = scales
        self._scene = before.showing(flow, {}, keep_range=False)
        before.close()
        self._frame = plane_frame(self._scene.whole.surface)

    @property
    def flow(self) -> FlowField:
        """The field that is drawn."""
        return self._scene.field

    @property
    def colour_label(self) -> str:
        """Name and unit of the scalars, for a colour bar; empty if the flow has one colour."""
        name = self._scene.scalar_name
        if name is None:
            return ""
        return self._scene.title_of(name)

    @property
    def time(self) -> float:
        """The time shown, in the field's unit; set it to show another one."""
        return self._scene.time

    @time.setter
    def time(self, value: float | str) -> None:
        self._scene.time = value
        self._update_title()
        self.stale = True

    @property
    def clock(self) -> float:
        """Clock of the streaming of a steady flow, in seconds."""
        return self._clock

    @clock.setter
    def clock(self, value: float) -> None:
        self._clock = float(value)
        self.stale = True

    def frame_axes(self) -> None:
        """Set title, aspect and ticks of the axes."""
        ax: Any = self.axes
        self._update_title()
        self._add_ground_legend()
        if (section := self._flow.section) is not None:  # with its top above
            ax.set_aspect("auto")
            if section.downward and not ax.yaxis_inverted():
                ax.invert_yaxis()
            ax.set(xlabel=ax.get_xlabel() or section.x, ylabel=ax.get_ylabel() or section.y)
        if is_geo(ax) or self._scales is not None or section is not None:
            return
        across, up, _ = self._unit.get_matrix().diagonal()
        ax.set_aspect(up / across)
        if self._projection is not None:
            label_degrees(ax, self._projection)

    def _add_ground_legend(self) -> None:
        """Name land and places without data in a legend, where some are drawn.

        Its entries are also in a legend that is made later.
        """
        ax = self.axes
        look = self._scene.appearance
        has_ground = False
        colours = ground_colours(self._flow, look.land, ax.get_facecolor(), coast_of(look))
        for name, colour in colours.items():
            handle = Polygon(np.full((3, 2), np.nan), label=name)
            handle.set(facecolor=tuple(colour), edgecolor=EDGE_COLOR)
            ax.add_artist(handle)
            has_ground = True
        if has_ground and ax.get_legend() is None:
            ax.legend(loc="upper right", fontsize="small")

    def _update_title(self) -> None:
        """Show level and time of data of the Earth in the title, unless one has been set."""
        field = self._scene.field
        ax = self.axes
        is_set = ax.get_title() != self._title or ax.get_title("left") or ax.get_title("right")
        if self._projection is not None and not is_set:
            dated = len(field.times) > 1 or field.start is not None
            if dated:
                time = [time_text(field, self.time)]
            else:
                time = []
            self._title = ", ".join([*filter(None, [field.name]), *time])
            ax.set_title(self._title)

    def make_image(
        self,
        renderer: RendererBase | None,
        magnification: float = 1.0,
        unsampled: bool = False,  # noqa: FBT001, FBT002
    ) -> tuple[Any, float, float, Any]:
        """Return the pixels of the axes and their position, for matplotlib."""
        del renderer, unsampled
        if self._projection is None:
            straight = self.axes.get_aspect() != "auto" and _kind(self.axes) == LINEAR
            try:
                if straight:
                    self._follow_scales(None)
                else:
                    self._follow_scales(AxesScales(self.axes))
            except FieldError:  # no part of the flow is on the axes now
                return np.zeros((1, 1, 4), np.uint8), 0.0, 0.0, None
        box = self.axes.bbox
        # Whole pixels; matplotlib clips those at the border.
        low = np.floor(np.multiply(box.min, magnification))
        high = np.ceil(np.multiply(box.max, magnification))
        pixels = np.stack([low, high]) / magnification
        if self._scales is None:
            corners = self._unit.transform(self.axes.transData.inverted().transform(pixels))
        else:
            corners = self._scales.shown(pixels)
        width, height = np.maximum(high - low, 1).astype(int).tolist()
        density = self.axes.figure.dpi * magnification / USUAL_DPI
        shown = (*corners.ravel(), width, height, density, self.time, self.clock)
        cmap = self._scene.appearance.cmap
        shown += (self.axes.get_facecolor(), self._changes, cmap, self.get_alpha())
        if shown != self._shown:
            self._picture = self._draw_around(corners, (width, height), density)
            self._shown = shown
        left, bottom = low / magnification
        return self._picture, float(left), float(bottom), None

    def _draw_around(self, corners: Floats, size: tuple[int, int], density: float) -> Bytes:
        """Draw a rectangle in which the flow may be repeated from turn to turn."""
        turn = self._turn
        if not turn:
            return self._draw(corners, size, density)
        surface = self._scene.whole.surface
        middle = self._frame @ surface.center
        half = surface.plane_size / 2
        shares = (np.arange(size[0]) + 0.5) / size[0]
        x = corners[0, 0] + shares * (corners[1, 0] - corners[0, 0])
        turns = np.floor((x - (middle[0] - half[0])) / turn)
        picture = np.zeros((size[1], size[0], 4), dtype=np.uint8)
        for number in np.unique(turns):
            shifted = corners - np.array([number * turn, 0.0])
            columns = turns == number
            picture[:, columns] = self._draw(shifted, size, density)[:, columns]
        return picture

    def _draw(self, corners: Floats, size: tuple[int, int], density: float) -> Bytes:
        """Draw the rectangle between two corners, (2, 2), row 0 at the bottom, opaque."""
        spans = np.abs(corners[1] - corners[0])
        scale = min(float(np.max(size / spans)), LONGEST_SIDE_PX / float(spans.max()))
        width, height = np.maximum(np.rint(spans * scale), 1).astype(int).tolist()
        look = self._scene.appearance
        if self.norm is not self._first_norm or look.norm is not None:  # set by matplotlib
            look = replace(look, norm=self.norm, clim=None, log_scale=False)
        elif self.get_clim() != self._first_clim:
            look = replace(look, clim=self.get_clim())
        if (alpha := self.get_alpha()) is not None:
            look = replace(look, opacity=look.opacity * float(alpha))
        view = ViewOptions(
            camera=self._camera(corners.mean(axis=0), float(spans[1])),
            background=self.axes.get_facecolor(),
        )
        scene = self._scene.copy()
        scene.appearance = look
        plotter = OffscreenPlotter(
            [scene],
            view,
            size=(width, height),
            supersampling=self._supersampling,
            density=density,
            still=True,
        )
        with closing(plotter), warnings.catch_warnings():
            warnings.filterwarnings("ignore", NOTHING_SEEN)  # axes may lie beside the flow
            transparent = view.background[-1] == 0
            picture = plotter.picture(time=self.time, clock=self.clock, transparent=transparent)
        if transparent:  # edge pixels are premultiplied, on black
            shares = np.maximum(picture[..., 3:], 1) / 255
            picture = np.concatenate([picture[..., :3] / shares, picture[..., 3:]], axis=-1)
            picture = picture.clip(0, 255).astype(np.uint8)
        across, up = np.sign(corners[1] - corners[0]).astype(int)
        shot = Image.fromarray(picture[::-up, ::across]).convert("RGBA").resize(size)
        return np.array(shot)  # matplotlib needs a writable array

    def _camera(self, middle: Floats, height: float) -> Camera:
        """Return the camera that looks at a place on the axes, (2,), from above."""
        surface = self._scene.whole.surface
        right, up = self._frame
        moved = middle - self._frame @ surface.center
        center = surface.center + moved @ self._frame
        position = center + np.cross(right, up) * surface.extent
        return Camera(
            tuple(position), tuple(center), tuple(up), parallel=True, parallel_scale=height / 2
        )


def _limit(ax: Any, left: float, right: float, bottom: float, top: float) -> None:
    """Set the limits of axes that have not been set."""
    kind, _, scale = _kind(ax)
    if is_geo(ax):
        limits = ax.projection
        left, right = np.clip((left, right), *sorted(limits.x_limits)).tolist()
        bottom, top = np.clip((bottom, top), *sorted(limits.y_limits)).tolist()
    if kind == "polar":  # all around the centre
        left, right = ax.get_xlim()
        if scale == "linear":
            bottom = min(bottom, 0.0)
    if ax.get_autoscalex_on():
        if ax.xaxis_inverted():
            left, right = right, left
        ax.set_xlim(left, right)
    if ax.get_autoscaley_on():
        if ax.yaxis_inverted():
            bottom, top = top, bottom
        ax.set_ylim(bottom, top)


def _kind(ax: Axes) -> tuple[str, str, str]:
    return ax.name, ax.get_xscale(), ax.get_yscale()


def _on_map(ax: Axes, mesh: Any, options: Options) -> tuple[Any, Options, SameMap]:
    """Return what is drawn on axes of a map, its options, and how the data lie on the axes.

    Datasets are read in the projection of the axes. Fields and stores have a projection. If it is
    the same as the projection of the axes, they are drawn as they are; otherwise fields are put on
    the map of the axes.
    """
    if options.field.projection is not None or options.field.globe is not None:
        raise FieldError(
            "projection and globe are those of the axes, which are of a map; leave them out, or "
            "give axes without a projection"
        )
    name, unit = projection_of_axes(ax)
    look = options.appearance
    coasts = look.coastlines or False
    look = replace(look, coastlines=coasts, graticule=bool(look.graticule))
    options = replace(options, appearance=look)
    if not isinstance(mesh, FlowField) and not is_stored(mesh):
        field_options = replace(options.field, projection=name)
        return mesh, replace(options, field=field_options), SameMap(unit, 0.0)
    field = read_field(mesh, options.field)
    options = replace(options, field=FieldOptions())
    _check_earth(field)
    is_large = finest_of(field) is not None
    same = same_map(field, Projection(name), stretched=is_large)
    if same is not None:
        joined: Any = unit + same.transform  # affine, as both are
        return field, options, SameMap(joined, same.turn)
    if is_large:
        raise FieldError(
            f"ax shows the map {name!r}, but the large store lies on {field.projection!r}; draw it "
            "on axes of that map, or build it on the map of the axes: "
            f"flowtex.pyramid.build(data, store, projection={name!r})"
        )
    return reprojected(field, name), options, SameMap(unit, 0.0)


def _check_earth(field: FlowField) -> None:
    """Raise a FieldError for a field that cannot be drawn on a map."""
    if field.projection is None:
        raise FieldError(
            f"ax is a map, and {brief(field)} is not of the Earth, as far as is known; give a "
            "dataset on longitudes and latitudes, or say on which map its points lie, as in "
            "FlowField.from_arrays(..., projection=flowtex.field.earth.Projection('platecarree')), "
            "or give axes without a projection"
        )


def plane_frame(surface: Surface) -> Floats:
    """Return the directions of x and y of a flat surface, (2, 3)."""
    if surface.frame is None:
        raise FieldError(
            "the surface is curved, so its picture has no axes in data coordinates; draw it with "
            "flowtex.render, or use a flat plane of the mesh"
        )
    return surface.frame
