"""TraceSlices as textures.

A layer of the slice texture does not hold a displacement D(s) at lag s but the mean slope D(s) / s
since lag zero. It is of order one at every lag, so half precision serves; it tends to the tangent
as s goes to zero, which is layer 0; and interpolating it linearly between two lags gives a path
of second order. Both sides share one sign: D(s) = s * slope(s), with s negative backward.

====================  =====================================================  =================
layer                 first three channels                                   fourth channel
====================  =====================================================  =================
0                     slope at lag zero                                      unit of lag
1 ... M               slopes of the backward slices                          layer 1: reach
M + 1 ... 2 M         slopes of the forward slices, where there are any      M + 1: reach
====================  =====================================================  =================

Slopes are in space (the surface's own frame), lengths per unit of nominal length, for the
procedural noise; in index space, cells per unit of lag, for the paper's noise texture.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex.field import FlowField
from flowtex.settings import Settings
from flowtex.textures.geometry import Geometry
from flowtex.textures.paper import PaperTextures
from flowtex.trace import TraceSlices

__all__ = ["MOST_LAGS", "TextureSet"]

Singles = NDArray[np.float32]

#: Slices on each side that a shader has room for.
MOST_LAGS = 32


@dataclass(frozen=True, eq=False)
class TextureSet:
    """All that a renderer needs of a flow, beside the settings.

    Attributes
    ----------
    geometry
        The surface.
    slices
        The traces.
    space
        ``"physical"`` for slopes in space, ``"index"`` for slopes in index space.
    paper
        The noise texture and the step texture, for ``space="index"``.
    """

    geometry: Geometry
    slices: TraceSlices
    space: str = "physical"
    paper: PaperTextures | None = None

    @classmethod
    def build(cls, field: FlowField, slices: TraceSlices, settings: Settings) -> TextureSet:
        """Make the textures that the settings ask for.

        Raises
        ------
        ValueError
            When the slices do not belong to the field, or are more than a shader has room for.
        """
        if slices.shape != field.shape:
            msg = (
                f"the slices have {slices.shape} nodes and the field {field.shape}; expected "
                "slices traced in this field"
            )
            raise ValueError(msg)
        if len(slices.lags) > MOST_LAGS:
            msg = f"{len(slices.lags)} lags were traced; expected at most {MOST_LAGS}"
            raise ValueError(msg)
        geometry = Geometry.of(field)
        if settings.noise == "procedural":
            return cls(geometry, slices)
        paper = PaperTextures.build(
            field,
            slices,
            resolution=settings.resolution,
            correction=settings.noise_correction,
            seed=settings.seed,
        )
        return cls(geometry, slices, "index", paper)

    @property
    def sides(self) -> int:
        """1 when paths lead backward only, 2 when forward too."""
        return 1 if self.slices.forward is None else 2

    @cached_property
    def pace(self) -> float:
        """Nominal length of one unit of ``slices.unit``: 1 by arc length, a typical speed by time."""
        if self.slices.parameter == "arclength":
            return 1.0
        speed = self.geometry.field.speed[:, self.geometry.field.valid]
        return float(np.sqrt(np.mean(speed**2))) or 1.0

    @cached_property
    def unit(self) -> float:
        """Length that the fourth channel of layer 0 is measured in."""
        return float(np.median(self.slices.unit[self.geometry.field.valid])) * self.pace

    @property
    def lags(self) -> Singles:
        """Lags of the slices, (M,), in multiples of the unit at each node."""
        return self.slices.lags.astype(np.float32)

    @property
    def count(self) -> int:
        """Number of layers."""
        return 1 + self.sides * len(self.slices.lags)

    def layers(self, step: int = 0) -> Singles:
        """Texels of the slice texture for one destination time, (layers, H, W, 4)."""
        result = np.empty(
            (self.count, self.geometry.rows.size, self.geometry.columns.size, 4), np.float32
        )
        pad = self.geometry.pad
        for layer, (slope, extra) in enumerate(self._nodal(step)):
            result[layer, ..., :3] = pad(slope)
            result[layer, ..., 3] = pad(extra)
        return result

    def _nodal(self, step: int) -> Any:
        """Give slope (J, I, 3) and fourth channel (J, I) of each layer."""
        slices = self.slices
        nothing = np.zeros(slices.shape)
        yield self._tangent(step), slices.unit * self.pace / self.unit
        sides = [(-1.0, slices.displacement, slices.reach)]
        if slices.forward is not None and slices.forward_reach is not None:
            sides.append((1.0, slices.forward, slices.forward_reach))
        for sign, displacement, reach in sides:
            for m, lag in enumerate(slices.lags):
                slope = self._vector(displacement[step, m].astype(float)) * (sign / lag)
                yield slope, self._usable_reach(reach[step], step) if m == 0 else nothing

    def _usable_reach(self, reach: NDArray[Any], step: int) -> NDArray[Any]:
        """Reach to draw with: where nothing moves, the neighbours alone decide."""
        still = ~np.abs(self.slices.rate[step]).any(axis=-1)
        return np.where(still, np.inf, reach).clip(max=2 * float(self.slices.lags[-1]))

    def _tangent(self, step: int) -> NDArray[Any]:
        rate = self.slices.rate[step]
        if self.space == "index":
            return np.concatenate([rate, np.zeros_like(rate[..., :1])], axis=-1)
        p_i, p_j = self.geometry.field.surface.tangents
        along = rate[..., :1] * p_i + rate[..., 1:] * p_j
        return np.asarray(along @ self.geometry.frame.T) / self._length

    def _vector(self, displacement: NDArray[Any]) -> NDArray[Any]:
        """Displacement of every node as the three channels of a layer, by unit of lag."""
        if self.space == "index":
            return np.concatenate([displacement, np.zeros_like(displacement[..., :1])], axis=-1)
        surface = self.geometry.field.surface
        moved = surface.at(self.slices.nodes + displacement) - surface.points
        return np.asarray(moved @ self.geometry.frame.T) / self._length

    @cached_property
    def _length(self) -> NDArray[np.float64]:
        """Nominal length of one unit of lag at each node, (J, I, 1)."""
        return (self.slices.unit * self.pace)[..., None]
