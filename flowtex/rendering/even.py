"""The local mean of a texture, which renderers subtract: see ``shaders/common/even.glsl``."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.rendering.shaders import const
from flowtex.rendering.uniforms import EVEN_RADII, Values


@dataclass(frozen=True)
class EvenBlocks:
    """Blocks of pixels around a surface, around whose middles means are taken and interpolated."""

    side: int  #: Of a block, in pixels, a power of two.
    first: tuple[int, int]  #: Lower left pixel of the first block.
    end: tuple[int, int]  #: Column and row that follow the pixels of the surface.
    size: tuple[int, int]  #: Columns and rows of blocks, and one more on each side.
    variance: float  #: Of the bell of the means, in pixels.
    reach: float  #: Pixels on each side of its middle at which it ends.

    @classmethod
    def of(
        cls,
        grain: float,
        box: tuple[int, int, int, int],
        *,
        shift: tuple[int, int] = (0, 0),
        clip: tuple[int, int] | None = None,
    ) -> EvenBlocks:
        """Return the blocks for a grain in pixels, by first and end of columns and rows.

        Pixels may be shifted against the pixels of a picture, which ends before ``clip``.
        """
        deviation = const.EVEN_SIGMA * grain
        doublings = np.floor(np.log2(np.sqrt(2.0) * deviation))
        side = 2 ** max(int(doublings), 0)
        variance = deviation**2
        if side > 1:
            # Linear interpolation has a variance of its own.
            variance -= side**2 / 6 + 1 / 12
        left, right, low, high = box
        # Blocks stay where they are in the picture when the surface moves.
        starts = (max(left, -shift[0]), max(low, -shift[1]))
        first = tuple(
            (start + by) // side * side - by for start, by in zip(starts, shift, strict=True)
        )
        end = (right, high)
        if clip is not None:
            end = (min(right, clip[0]), min(high, clip[1]))
        columns = -(-(end[0] - first[0]) // side) + 2
        rows = -(-(end[1] - first[1]) // side) + 2
        reach = EVEN_RADII * np.sqrt(variance)
        return cls(side, first, end, (columns, rows), float(variance), float(reach))

    @property
    def margin(self) -> int:
        """Pixels beyond a part of a picture on which the part depends."""
        return int(np.ceil(self.reach)) + 2 * self.side

    @property
    def pixels(self) -> tuple[int, int]:
        """Columns and rows of pixels from the first block to the end of the surface."""
        return self.end[0] - self.first[0], self.end[1] - self.first[1]


@dataclass(frozen=True, eq=False)
class DrawnGrains:
    """Sizes in the picture of grains at N fragments, over those where the surface faces the eye."""

    across: Floats  #: Size across the flow, (N,).
    along: Floats  #: Size along it, (N,).

    @property
    def stretch(self) -> Floats:
        """Return the factor of the number of samples, (N,), so that streaks have equal lengths."""
        stretch = np.clip(1.0 / self.along, 1.0 / const.MOST_STRETCH, const.MOST_STRETCH)
        is_usual = np.abs(stretch - 1.0) < const.LEAST_STRETCH
        return np.where(is_usual, 1.0, stretch)


def even_gain(near: Floats, grains: DrawnGrains, values: Values) -> Floats:
    """Return the factor that restores the deviation of a texture less its local mean, (N,).

    The correlation of neighbouring weights is (N,), too.
    """
    near = np.clip(near, const.LEAST_NEAR, const.MOST_NEAR)
    samples = -0.5 / np.log(near)
    grain = 0.5 / const.BELL
    across = grain * grains.across**2
    along = (grain + values["u_spacing"] ** 2 * samples) * grains.along**2
    bell = const.EVEN_SIGMA**2
    once = across * along / ((across + bell) * (along + bell))
    twice = across * along / ((across + 2 * bell) * (along + 2 * bell))
    return np.asarray(1.0 / np.sqrt(1.0 - 2.0 * np.sqrt(once) + np.sqrt(twice)))
