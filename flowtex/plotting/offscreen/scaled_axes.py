"""Flows on axes with logarithmic and other scales, and on polar axes."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from flowtex._util.array_types import AnyArray, Floats
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.derived import DERIVED, derived_unit
from flowtex.field.steps import LazySteps
from flowtex.scene.options import SPEED

#: Relative step of the derivative of a scale, and least step over the range of the axis.
STEP, LEAST_STEP = 1e-6, 1e-12
#: Scales that matplotlib clips: the logarithm of values that are not positive is -1000.
CLIPPED, BEYOND = ("log", "logit"), 999.0
#: Steps in which y is stretched against x, in powers of two.
STRETCH_STEP = 0.5


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
            return (scaled if self.polar else self._within(scaled)) * (1.0, self.stretch)

    def _within(self, scaled: Floats) -> Floats:
        """Return scaled values with NaN where matplotlib clips them."""
        beyond = (np.abs(scaled) >= BEYOND) & [name in CLIPPED for name in self.names]
        return np.where(beyond, np.nan, scaled)

    def shown(self, pixels: ArrayLike) -> Floats:
        """Return scaled positions (..., 2) of pixels of the figure."""
        return np.asarray(self._placed.inverted().transform(pixels) * (1.0, self.stretch))

    def extent(self, field: FlowField, frame: Floats) -> Floats:
        """Return the ends of the coordinates that the scales can show, (2, 2): lower, upper."""
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
        # Column n is the derivative along coordinate n.
        slope = np.stack(
            [
                (self.on_map(near + delta) - self.on_map(near - delta)) / (2 * step[..., n, None])
                for n, delta in enumerate(np.moveaxis(step[..., None] * np.eye(2), -1, 0))
            ],
            axis=-1,
        )
        if self.polar:  # a velocity along the angle has the unit of the radius
            with np.errstate(all="ignore"):  # undefined at radius 0
                slope[..., 0] /= near[..., 1, None]
        return slope

    def field(self, field: FlowField, frame: Floats) -> FlowField:
        """Return a flat field as the axes show it; nodes outside of the scales are blanked.

        ``frame`` are the directions of x and y, (2, 3). The speed stays that of the field.
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

        def transformed(steps: Any) -> Floats:
            return planar((slope @ (steps @ frame.T)[..., None])[..., 0], np.zeros(2))

        velocity: Any = field.velocity
        if isinstance(velocity, LazySteps):  # those of a long series are read when they are drawn
            read = velocity
            velocity = LazySteps(len(read), lambda step: transformed(np.asarray(read[step])))
        else:
            velocity = transformed(velocity)
        scalars = {SPEED: field.speed, **field.scalars}
        shown = replace(
            field,
            points=planar(scaled, scaled[valid][0]),
            velocity=velocity,
            valid=valid,
            has_position=valid if field.has_position is None else field.has_position & valid,
            scalars=scalars,
            units={SPEED: field.unit_of(SPEED), **field.units},
            formula=None,
            section=None,
        )
        if not self.polar or field.triangles is not None:
            return shown
        # The angle may be periodic.
        closed = FlowField.from_arrays(
            shown.points, shown.velocity, valid=valid, scalars=scalars, sign_free=field.sign_free
        )
        names = ("points", "velocity", "valid", "has_position", "scalars", "periodic")
        return replace(shown, **{name: getattr(closed, name) for name in names})


def with_polar_scalars(field: FlowField, frame: Floats, name: str | None) -> FlowField:
    """Return a field in polar coordinates with a derived scalar, computed in the plane."""
    if name not in DERIVED or name in field.scalars or field.sign_free:
        return field
    plane = AxesScales(Figure().add_subplot(projection="polar")).field(field, frame)
    rows, columns = field.shape  # the plane may have one more line, which closes it
    values = np.stack([np.asarray(step)[:rows, :columns] for step in plane.derive(name)])
    units = {**field.units, name: derived_unit(name, field)}
    return replace(field, scalars={**field.scalars, name: values}, units=units)


def _missed(values: Floats) -> FieldError:
    low, high = (of(values.reshape(-1, 2), axis=0) for of in (np.min, np.max))
    return FieldError(
        f"x is from {low[0]:g} to {high[0]:g} and y from {low[1]:g} to {high[1]:g}; expected "
        "values that the axes have: positive ones on a logarithmic scale, radii beyond the centre's"
    )
