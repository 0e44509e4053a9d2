"""Flows on axes with logarithmic and other scales."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray, Floats
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.steps import LazySteps
from flowtex.options import SPEED

#: Relative step of the derivative of a scale, and least step over the range of the axis.
STEP, LEAST_STEP = 1e-6, 1e-12
#: Scales that matplotlib clips: the logarithm of what is not positive is -1000.
CLIPPED, BEYOND = ("log", "logit"), 999.0


#: Steps in which y is stretched against x, in powers of two.
STRETCH_STEP = 0.5


class AxesScales:
    """Scales of axes, which take x and y to where the axes show them.

    Attributes
    ----------
    names
        Names of the scales.
    stretch
        Factor of the scaled y, so that a picture has about as many pixels for a unit of both.
    """

    def __init__(self, ax: Any, *, framed: bool = True) -> None:
        self.names = ax.get_xscale(), ax.get_yscale()
        self._scales: tuple[Any, Any] = ax.xaxis.get_transform(), ax.yaxis.get_transform()
        self.stretch = 1.0
        if framed:
            limits = np.transpose([ax.get_xlim(), ax.get_ylim()])
            per_unit = np.divide(ax.bbox.size, np.abs(np.diff(self.on_map(limits), axis=0)[0]))
            power = np.log2(per_unit[1] / per_unit[0]) / STRETCH_STEP
            self.stretch = float(2.0 ** (STRETCH_STEP * np.round(power)))

    @property
    def key(self) -> tuple[str, str, float]:
        """The same for axes on which a flow is the same."""
        return *self.names, self.stretch

    def on_map(self, values: Any) -> Floats:
        """Return scaled positions (..., 2) of values of the axes, NaN where a scale has none."""
        with np.errstate(all="ignore"):
            scaled = _transformed(values, self._scales)
            beyond = (np.abs(scaled) >= BEYOND) & [name in CLIPPED for name in self.names]
            return np.where(beyond, np.nan, scaled) * (1.0, self.stretch)

    def on_axes(self, positions: Any) -> Floats:
        """Return values (..., 2) of the axes of scaled positions."""
        inverse = tuple(scale.inverted() for scale in self._scales)
        return _transformed(np.divide(positions, (1.0, self.stretch)), inverse)

    def field(self, field: FlowField, frame: Floats) -> FlowField:
        """Return a flat field as the axes show it; nodes that these do not have are blanked.

        ``frame`` are the directions of x and y, (2, 3). The speed stays that of the field.

        Raises
        ------
        FieldError
            When no node has a place on the axes.
        """
        points = field.points @ frame.T
        flat = points.reshape(-1, 2)
        scaled = self.on_map(points)
        on_axes = np.isfinite(scaled).all(axis=-1)
        step = np.maximum(STEP * np.abs(points), LEAST_STEP * np.ptp(flat, axis=0))
        slope = (self.on_map(points + step) - self.on_map(points - step)) / (2 * step)
        valid = field.valid & on_axes & np.isfinite(slope).all(axis=-1)
        if not valid.any():
            low, high = flat.min(axis=0), flat.max(axis=0)
            msg = (
                f"x is from {low[0]:g} to {high[0]:g} and y from {low[1]:g} to {high[1]:g}; "
                "expected values that the scales of the axes have, or linear axes"
            )
            raise FieldError(msg)

        def planar(two: AnyArray, blank: AnyArray) -> Floats:
            """Return vectors (..., 3) of two components, with others at nodes that are blanked."""
            known = np.where(valid[..., None], two, blank)
            return np.concatenate([known, np.zeros_like(known[..., :1])], axis=-1)

        def moved(steps: Any) -> Floats:
            return planar(steps @ frame.T * slope, np.zeros(2))

        velocity: Any = field.velocity
        if isinstance(velocity, LazySteps):  # those of a long series are read when they are drawn
            read = velocity
            velocity = LazySteps(len(read), lambda step: moved(np.asarray(read[step])))
        else:
            velocity = moved(velocity)
        known = {SPEED: field.speed, **field.scalars}
        return replace(
            field,
            points=planar(scaled, scaled[valid][0]),
            velocity=velocity,
            valid=valid,
            has_position=valid if field.has_position is None else field.has_position & valid,
            scalars=known,
            units={SPEED: field.unit_of(SPEED), **field.units},
            formula=None,
            section=None,
        )


def _transformed(values: Any, transforms: tuple[Any, ...]) -> Floats:
    """Return points (..., 2), each coordinate transformed by itself."""
    points = np.asarray(values, dtype=float)
    both = [one.transform(points[..., n].ravel()) for n, one in enumerate(transforms)]
    return np.stack(both, axis=-1).reshape(points.shape)
