"""What a flow texture shows, measured from its values alone.

A picture is (H, W), row 0 at the top. The flow at a pixel is ``u`` to the right and ``v`` up, of
any length. ``mask`` (H, W) says which pixels are judged.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flowtex._util.array_types import Bools, Floats
from flowtex.quality import Grain, grain


def local_grain(picture: Floats, mask: Bools) -> Grain:
    """Measure the grain of a texture along the rows and along the columns of the picture."""
    ones = np.ones(picture.shape)
    return grain(picture, ones, 0 * ones, mask)


class Evenness(NamedTuple):
    """How even a grain is over a picture.

    ``spread`` is the quotient of large and small grains (the ninth and the first tenth), 1 when all
    are alike; ``stretch`` the mean quotient of their longer and shorter side, 1 when all are round.
    """

    spread: float
    stretch: float


def evenness(picture: Floats, mask: Bools, tile: int = 40) -> Evenness:
    """Measure the grain of a noise tile by tile; tiles that are judged by half or less are left."""
    sizes, sides = [], []
    for row in range(0, picture.shape[0] - tile + 1, tile):
        for column in range(0, picture.shape[1] - tile + 1, tile):
            part = (slice(row, row + tile), slice(column, column + tile))
            inside = np.zeros_like(mask)
            inside[part] = mask[part]
            if inside.sum() > tile * tile / 2:
                part_grain = local_grain(picture, inside)
                sizes.append(np.sqrt(part_grain.along * part_grain.across))
                ratio = part_grain.along / part_grain.across
                sides.append(max(ratio, 1 / ratio))
    if not sizes:
        return Evenness(float("nan"), float("nan"))
    small, large = np.percentile(sizes, (10, 90))
    return Evenness(float(large / small), float(np.mean(sides)))


def likeness(first: Floats, second: Floats, mask: Bools) -> float:
    """Correlation of two pictures, from -1 to 1."""
    a, b = first[mask] - first[mask].mean(), second[mask] - second[mask].mean()
    scale = float(np.sqrt(np.mean(a * a) * np.mean(b * b)))
    return float(np.mean(a * b)) / max(scale, 1e-12)


def sharpness(picture: Floats, mask: Bools) -> float:
    """Root mean square of the change from pixel to pixel: what blurring takes away."""
    filled = _filled(picture)
    across, down = np.diff(filled, axis=1)[:-1], np.diff(filled, axis=0)[:, :-1]
    inner = mask[:-1, :-1]
    return float(np.sqrt(np.mean(across[inner] ** 2 + down[inner] ** 2)))


def standardised(picture: Floats) -> Floats:
    """Return the picture with mean zero and deviation one; NaN stays."""
    return np.asarray((picture - np.nanmean(picture)) / np.nanstd(picture))


def _filled(picture: Floats) -> Floats:
    """Put the mean where there is no value, so that a filter does not spread what is missing."""
    missing = np.isnan(picture)
    return np.where(missing, np.mean(picture[~missing]), picture) if missing.any() else picture
