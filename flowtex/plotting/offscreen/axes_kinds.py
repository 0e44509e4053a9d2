"""Kinds of matplotlib axes: maps with degrees, logarithmic and other scales, and polar axes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, Locator, MaxNLocator
from matplotlib.transforms import Affine2D
from numpy.typing import ArrayLike

from flowtex._util.array_types import AnyArray, Floats
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.derived.kinds import DERIVED
from flowtex.field.derived.quantities import derived_unit
from flowtex.field.earth.map_lines import MOST_LINES, STEPS
from flowtex.field.earth.projection import DEGREE, Projection, cartopy_map, is_cartopy
from flowtex.field.scalars import Scalars
from flowtex.field.steps import LazySteps
from flowtex.scene.options import SPEED

DEGREE_STEPS = [1, 1.5, 2, 3, 5, 6, 10]  #: Leading digits of ticks in degrees.
TICKS = (90, 60, *STEPS)  #: Degrees between ticks on a border.
WIDE = 0.85  #: Share of the ticks for which matplotlib sees room, where they are longitudes.
#: Number of points along a border of axes at which longitude and latitude are computed.
ALONG = 241
INWARDS = 33  #: Number of points from the border inwards; the first one on the map is used.
NEAR = 1e-3  #: Share of the axes within which a place maps back to where it was looked up.
STEP = 1e-6  #: Relative step of the derivative of a scale.
LEAST_STEP = 1e-12  #: Least step of the derivative, over the range of the axis.
CLIPPED = ("log", "logit")  #: Scales that matplotlib clips.
#: Magnitude of clipped scaled values: matplotlib gives -1000 as the logarithm of zero.
BEYOND = 999.0
STRETCH_STEP = 0.5  #: Steps in which y is stretched against x, in powers of two.

MOST_COMPARED = 2000  #: Nodes of which positions on two maps are compared.
SAME_MAP = 1e-5  #: Share of the extent by which positions on equal maps differ.

DegreeText = Callable[..., str]  #: Writes degrees.


def is_geo(ax: Axes) -> bool:
    """Return whether axes are cartopy's."""
    return hasattr(ax, "projection") and is_cartopy(ax.projection)


def projection_of_axes(ax: Any) -> tuple[str, Affine2D]:
    """Return the projection of cartopy's axes, as PROJ takes it, and their :func:`unit_of`.

    Axes in degrees show a plate carrée in metres.
    """
    unit = Affine2D()
    if not ax.projection.is_projected:
        unit = unit.scale(DEGREE)
    return cartopy_map(ax.projection), unit


def unit_of(projection: Projection | None) -> Affine2D:
    """Return the transform from straight axes, in degrees on a plate carrée, to the data."""
    if projection is None or projection.name != "platecarree":
        return Affine2D()
    lon, standard = projection.center
    scale = DEGREE * math.cos(math.radians(standard))
    return Affine2D().scale(scale, DEGREE).translate(-lon * scale, 0.0)


class SameMap(NamedTuple):
    """How a field lies on a map: the transform from the map to its positions.

    Where the map ends at another meridian, its positions repeat after a ``turn``, which is 0
    otherwise.
    """

    transform: Affine2D
    turn: float


def same_map(field: FlowField, projection: Projection, *, stretched: bool) -> SameMap | None:
    """Return how a field lies on a map, ``None`` if the map of the field differs too much.

    The map of the field may have another size or origin; if ``stretched``, also other scales of x
    and y, or another meridian at its ends.
    """
    own = field.projection
    if own is None or own.is_globe or projection.is_globe:
        return None
    nodes = np.flatnonzero(field.valid.ravel())
    nodes = nodes[:: len(nodes) // MOST_COMPARED + 1]
    theirs = field.points.reshape(-1, 3)[nodes, :2]
    ours = projection.positions(*own.lonlat(field.points.reshape(-1, 3)[nodes]))[:, :2]
    same = _even_transform(theirs, ours, stretched=stretched)
    if same is not None:
        return SameMap(same, 0.0)
    turn = _turn_of(projection)
    own_turn = _turn_of(own)
    if not (stretched and np.isfinite(ours).all() and turn > 0 and own_turn > 0):
        return None
    # Either map may end between the nodes, where the other one goes on.
    wanted = theirs[:, 0] * turn / own_turn
    behind = wanted - ours[:, 0]
    onward = ours.copy()
    onward[:, 0] += turn * np.round((behind - behind[0]) / turn)
    same = _even_transform(theirs, onward, stretched=True)
    if same is None:
        return None
    return SameMap(same, turn * float(same.get_matrix()[0, 0]))


def _turn_of(projection: Projection) -> float:
    """Return how far x increases around the Earth on a map with straight meridians."""
    lon = np.arange(-180.0, 180.0, 30.0)
    x = projection.positions(np.stack([lon, lon + 1], axis=-1), np.zeros((len(lon), 2)))[..., 0]
    return float(360.0 * np.median(np.diff(x, axis=-1)))


def _even_transform(theirs: Floats, ours: Floats, *, stretched: bool) -> Affine2D | None:
    """Return the scales and the shift from some places to others; ``None`` if it is no such."""
    spans = np.ptp(theirs, axis=0)
    if not (np.isfinite(ours).all() and (spans > 0).all() and (np.ptp(ours, axis=0) > 0).all()):
        return None
    scales = spans / np.ptp(ours, axis=0)
    origins = np.mean(theirs - scales * ours, axis=0)
    errors = np.abs(scales * ours + origins - theirs) / spans
    is_even = abs(scales[0] / scales[1] - 1) < SAME_MAP
    if errors.max() > SAME_MAP or not (stretched or is_even):
        return None
    return Affine2D().scale(*scales).translate(*origins)


def label_degrees(ax: Axes, projection: Projection) -> None:
    """Give straight axes ticks in degrees: of a map, where its graticule meets their border."""
    for number, axis in enumerate((ax.xaxis, ax.yaxis)):
        if projection.name != "platecarree":
            border = _Border(ax, projection, number)
            axis.set_major_locator(border)
            axis.set_major_formatter(FuncFormatter(border.text))
        else:
            axis.set_major_locator(_DegreeLocator(nbins="auto", steps=DEGREE_STEPS))
            axis.set_major_formatter(FuncFormatter((longitude_text, latitude_text)[number]))


def longitude_text(degrees: float, _position: int | None = None) -> str:
    """Return a longitude as ``"30°E"``."""
    turned = (degrees + 180.0) % 360.0 - 180.0
    text = f"{abs(turned):.6g}°"
    if abs(turned) < 1e-6 or abs(abs(turned) - 180.0) < 1e-6:
        return text
    if turned > 0:
        return text + "E"
    return text + "W"


def latitude_text(degrees: float, _position: int | None = None) -> str:
    """Return a latitude as ``"60°N"``."""
    text = f"{abs(degrees):.6g}°"
    if abs(degrees) < 1e-6:
        return text
    if degrees > 0:
        return text + "N"
    return text + "S"


def _room(axis: Any) -> int:
    """Return the number of ticks for which an axis has room: longitudes are wide."""
    if axis.axis_name == "x":
        share = WIDE
    else:
        share = 1.0
    return max(min(MOST_LINES, round(share * axis.get_tick_space())), 1)


def _step(degrees: float, most: float) -> float:
    """Return the smallest step with which at most so many ticks lie in a range of degrees."""
    for step in reversed(TICKS):
        if degrees / step <= most:
            return step
    return TICKS[0]


class _Border(Locator):
    """Crossings of meridians with the lower border of axes (0), or parallels with the left (1)."""

    def __init__(self, ax: Axes, projection: Projection, number: int) -> None:
        self._ax = ax
        self._projection = projection
        self._number = number
        self._find = lru_cache(maxsize=1)(self._crossings)  # each tick asks

    def crossings(self) -> tuple[Floats, Floats, DegreeText]:
        """Return the places along the border, their degrees, and the function for their text."""
        most = _room((self._ax.xaxis, self._ax.yaxis)[self._number])
        return self._find((self._ax.get_xlim(), self._ax.get_ylim()), most)

    def __call__(self) -> list[float]:
        return list(map(float, self.crossings()[0]))

    def tick_values(self, vmin: float, vmax: float) -> list[float]:
        """Return the ticks of the axes as they are."""
        del vmin, vmax
        return self()

    def text(self, x: float, _position: int | None = None) -> str:
        places, values, text = self.crossings()
        if len(places):
            return text(values[np.argmin(np.abs(places - x))])
        return ""

    def _crossings(
        self, axis_limits: tuple[tuple[float, float], tuple[float, float]], most: int
    ) -> tuple[Floats, Floats, DegreeText]:
        """Return where meridians or parallels cross an axis, their degrees, and their texts."""
        limits = np.array(axis_limits)
        (start, end) = limits[self._number]
        (border, other) = limits[1 - self._number]
        along = np.linspace(start, end, ALONG)
        inwards = np.linspace(border, other, INWARDS)
        grid = np.zeros((ALONG, INWARDS, 3))
        grid[..., self._number] = along[:, None]
        grid[..., 1 - self._number] = inwards
        lon, lat = self._projection.lonlat(grid)
        # Outside of a map with an outline, PROJ returns places of the other side.
        mapped_back = self._projection.positions(lon, lat)
        with np.errstate(invalid="ignore"):
            on_map = np.linalg.norm(mapped_back - grid, axis=-1) <= NEAR * np.ptp(limits)
        # A map with an outline begins further in.
        first = (np.arange(ALONG), np.argmax(on_map, axis=1))
        has_place = on_map.any(axis=1)
        along = along[has_place]
        lon = lon[first][has_place]
        lat = lat[first][has_place]
        if len(along) < 2:
            return np.zeros(0), np.zeros(0), longitude_text
        steps = np.diff(lat)
        if self._number == 1 and ((steps >= 0).all() or (steps <= 0).all()):
            degrees = lat
            text = latitude_text
        else:  # around a pole meridians meet all sides
            degrees = np.unwrap(lon, period=360.0)
            text = longitude_text
        low = degrees.min()
        high = degrees.max()
        room = most * abs(float(np.ptp(along) / np.ptp(limits[self._number])))
        step = _step(high - low, room)
        values = np.arange(math.ceil(low / step), math.floor(high / step) + 1) * step
        n, k = np.nonzero(np.diff(degrees >= values[:, None], axis=1))
        share = (values[n] - degrees[k]) / (degrees[k + 1] - degrees[k])
        return along[k] + share * (along[k + 1] - along[k]), values[n], text


class _DegreeLocator(MaxNLocator):
    """Ticks at whole parts of a right angle, where the axes show more than some degrees."""

    def tick_values(self, vmin: float, vmax: float) -> Any:
        """Return ticks between two values, and one beyond each."""
        low, high = sorted((vmin, vmax))
        step = _step(high - low, _room(self.axis))
        if step < 2 * TICKS[-1]:
            return super().tick_values(vmin, vmax)
        return np.arange(math.floor(low / step), math.ceil(high / step) + 1) * step


class AxesScales:
    """Scales of axes: of x and y, or of the angle and the radius of polar ones."""

    def __init__(self, ax: Any, *, framed: bool = True) -> None:
        self.names = ax.get_xscale(), ax.get_yscale()
        #: Zero and sign of the angle, radius of the centre, and sign of the radius.
        self.polar: tuple[float, ...] = ()
        #: Factor of the scaled y, so that a picture has about as many pixels for a unit of both.
        self.stretch = 1.0
        # Scaling, and the transform to the figure after it: together they are ``ax.transData``.
        self._scale = self._scaled = ax.transScale
        if ax.name == "polar":
            turn = ax.get_theta_offset(), ax.get_theta_direction()
            self.polar = *turn, ax.get_rorigin(), ax.get_rsign()
            self._scaled = self._scale + ax.transShift + ax.transProjection
            self._placed = ax.transProjectionAffine + ax.transWedge + ax.transAxes
            return
        self._placed = ax.transLimits + ax.transAxes
        if framed:
            spans = np.abs(np.diff(self.shown(ax.bbox.get_points()), axis=0)[0])
            power = np.log2(np.divide(*np.divide(spans, ax.bbox.size))) / STRETCH_STEP
            self.stretch = float(2.0 ** (STRETCH_STEP * np.round(power)))

    @property
    def key(self) -> tuple[object, ...]:
        """Equal for axes on which a flow is the same."""
        return *self.names, *self.polar, self.stretch

    def on_map(self, values: ArrayLike) -> Floats:
        """Return scaled positions (..., 2) of values of the axes, NaN where a scale has none."""
        points = np.asarray(values, dtype=float)
        with np.errstate(all="ignore"):
            scaled = self._scaled.transform(points.reshape(-1, 2)).reshape(points.shape)
            if not self.polar:
                scaled = self._within(scaled)
            return scaled * (1.0, self.stretch)

    def _within(self, scaled: Floats) -> Floats:
        """Return scaled values with NaN where matplotlib clips them."""
        beyond = (np.abs(scaled) >= BEYOND) & np.isin(self.names, CLIPPED)
        return np.where(beyond, np.nan, scaled)

    def shown(self, pixels: ArrayLike) -> Floats:
        """Return scaled positions (..., 2) of pixels of the figure."""
        return np.asarray(self._placed.inverted().transform(pixels) * (1.0, self.stretch))

    def extent(self, field: FlowField, frame: Floats) -> Floats:
        """Return the ends of the coordinates that the scales can show, (2, 2): lower, upper.

        Parameters
        ----------
        field
            The flow.
        frame
            Directions of x and y, (2, 3).

        Raises
        ------
        FieldError
            When the axes can show no node, as with negative values on a logarithmic scale.
        """
        values = (field.points @ frame.T).reshape(-1, 2)
        with np.errstate(all="ignore"):
            is_shown = np.isfinite(self._within(self._scale.transform(values))).all(axis=-1)
        if not is_shown.any():
            raise _missed(values)
        return np.stack([values[is_shown].min(axis=0), values[is_shown].max(axis=0)])

    def _slope(self, points: Floats, step: Floats) -> Floats:
        """Return the Jacobian of positions on the axes, (..., 2, 2), by central differences."""
        near = points.copy()
        if self.polar:  # at the centre the angle has no direction
            *_, origin, sign = self.polar
            beside = np.maximum(sign * (near[..., 1] - origin), 2 * step[..., 1])
            near[..., 1] = origin + sign * beside
        columns = []
        for coordinate in (0, 1):
            delta = np.zeros_like(step)
            delta[..., coordinate] = step[..., coordinate]
            difference = self.on_map(near + delta) - self.on_map(near - delta)
            columns.append(difference / (2 * step[..., coordinate, None]))
        slope = np.stack(columns, axis=-1)
        if self.polar:  # a velocity along the angle has the unit of the radius
            with np.errstate(all="ignore"):  # undefined at radius 0
                slope[..., 0] /= near[..., 1, None]
        return slope

    def field(self, field: FlowField, frame: Floats) -> FlowField:
        """Return a flat field as the axes show it; nodes outside of the scales are blanked.

        ``frame`` are the directions of x and y, (2, 3). The speed stays that of the field.

        Raises
        ------
        FieldError
            When the axes can show no node with data.
        """
        points = field.points @ frame.T
        low, high = self.extent(field, frame)
        scaled = self.on_map(points)
        on_axes = np.isfinite(scaled).all(axis=-1)
        step = np.maximum(STEP * np.abs(points), LEAST_STEP * (high - low))
        slope = self._slope(points, step)
        valid = field.valid & on_axes & np.isfinite(slope).all(axis=(-1, -2))
        if not valid.any():
            raise _missed(points)
        slope[~valid] = 0.0

        def planar(components: AnyArray, blank: AnyArray) -> Floats:
            """Return vectors (..., 3) of two components, with others at nodes that are blanked."""
            vectors = np.where(valid[..., None], components, blank)
            return np.concatenate([vectors, np.zeros_like(vectors[..., :1])], axis=-1)

        def transformed(step: int) -> Floats:
            along = np.asarray(field.velocity[step]) @ frame.T
            return planar((slope @ along[..., None])[..., 0], np.zeros(2))

        # Those of a long series are read when they are drawn.
        velocity: Any = LazySteps(len(field.velocity), transformed)
        has_position = valid
        if field.has_position is not None:
            has_position = field.has_position & valid
        shown = replace(
            field,
            points=planar(scaled, scaled[valid][0]),
            velocity=velocity,
            valid=valid,
            has_position=has_position,
            scalars=Scalars({SPEED: field.speed, **field.scalars}),
            units={SPEED: field.unit_of(SPEED), **field.units},
            formula=None,
            section=None,
        )
        if not self.polar or field.triangles is not None:
            return shown
        return _closed(shown)


def _closed(field: FlowField) -> FlowField:
    """Return a structured field with its periodic axes closed, such as the angle."""
    closed = FlowField.from_arrays(
        field.points,
        field.velocity,
        valid=field.valid,
        scalars=field.scalars,
        sign_free=field.sign_free,
    )
    return replace(
        field,
        points=closed.points,
        velocity=closed.velocity,
        valid=closed.valid,
        has_position=closed.has_position,
        scalars=closed.scalars,
        periodic=closed.periodic,
    )


def with_polar_scalars(field: FlowField, frame: Floats, name: str | None) -> FlowField:
    """Return a field in polar coordinates with a derived scalar, computed in the plane."""
    if name not in DERIVED or name in field.scalars or field.sign_free:
        return field
    plane = AxesScales(Figure().add_subplot(projection="polar")).field(field, frame)
    rows, columns = field.shape  # the plane may have one more line, which closes it
    values = np.stack([np.asarray(step)[:rows, :columns] for step in plane.derive(name)])
    units = {**field.units, name: derived_unit(name, field)}
    return field.same_flow(scalars={**field.scalars, name: values}, units=units)


def _missed(values: Floats) -> FieldError:
    """Return the error of a flow that lies outside of what the axes can show."""
    low = np.min(values.reshape(-1, 2), axis=0)
    high = np.max(values.reshape(-1, 2), axis=0)
    return FieldError(
        f"x is from {low[0]:g} to {high[0]:g} and y from {low[1]:g} to {high[1]:g}; expected "
        "values that the axes have: positive ones on a logarithmic scale, radii beyond the centre's"
    )
