"""What a flow texture shows, measured from its values alone.

A picture is (H, W), row 0 at the top. The flow at a pixel is ``u`` to the right and ``v`` up, of
any length. ``mask`` (H, W) says which pixels are judged.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import ndimage

from flowtex._util.array_types import Bools, Floats

#: Width in pixels of the derivative, and of the window over which directions are averaged.
EDGE_PIXELS, WINDOW_PIXELS = 1.0, 4.0
#: Shades wider than this many pixels are no grain.
SHADE_PIXELS = 20.0
#: Pixels at which grain is measured, and the farthest that is looked.
GRAIN_POINTS, MAX_DISTANCE_PIXELS = 20_000, 64


class Streaks(NamedTuple):
    """Direction of a texture: its mean angle to the flow in degrees, and how clear it is."""

    angle: float
    coherence: float


class Grain(NamedTuple):
    """Distances in pixels, along the flow and across it, at which the correlation is a half."""

    along: float
    across: float


def streaks(
    picture: Floats, u: Floats, v: Floats, mask: Bools, window: float = WINDOW_PIXELS
) -> Streaks:
    """Compare the direction of a texture with the flow.

    The direction is that of the structure tensor: the mean, over a Gaussian window, of the outer
    product of the gradient with itself. Its coherence is 1 for parallel lines and 0 for noise.
    """
    filled = _filled(picture)
    gx = ndimage.gaussian_filter(filled, EDGE_PIXELS, order=(0, 1))
    gy = ndimage.gaussian_filter(filled, EDGE_PIXELS, order=(1, 0))
    # As complex numbers of twice the angle, which do not tell a direction from its opposite.
    turned = ndimage.gaussian_filter(gx * gx - gy * gy, window) + 2j * ndimage.gaussian_filter(
        gx * gy, window
    )
    energy = ndimage.gaussian_filter(gx * gx + gy * gy, window)
    flow = np.square(u - 1j * v)  # rows go down, v goes up
    with np.errstate(invalid="ignore"):
        between = np.abs(np.angle(-turned * np.conj(flow))) / 2
    coherence = np.abs(turned) / np.maximum(energy, np.finfo(float).tiny)
    return Streaks(float(np.degrees(between[mask].mean())), float(coherence[mask].mean()))


def grain(picture: Floats, u: Floats, v: Floats, mask: Bools, seed: int = 0) -> Grain:
    """Measure the grain of a texture along the flow, however it bends, and across it."""
    filled = _filled(picture)
    flat = filled - ndimage.gaussian_filter(filled, SHADE_PIXELS)
    rows, columns = np.nonzero(mask)
    pick = np.random.default_rng(seed).integers(0, len(rows), min(GRAIN_POINTS, 4 * len(rows)))
    at = np.stack([rows[pick], columns[pick]]).astype(float)
    length = np.maximum(np.hypot(u, v), np.finfo(float).tiny)
    right, down = u / length, -v / length
    return Grain(
        _half_width(flat, at, np.stack([down, right])),
        _half_width(flat, at, np.stack([right, -down])),
    )


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


def _half_width(flat: Floats, start: Floats, direction: Floats) -> float:
    """Distance at which the mean product with the value at the start is half the mean square.

    Lines are followed from ``start``, (2, N) as (row, column), along unit vectors (2, H, W).
    """
    here = ndimage.map_coordinates(flat, start, order=1, mode="nearest")
    power = float(np.mean(here * here))
    if power == 0:
        return float(MAX_DISTANCE_PIXELS)
    at, distance, before = start.copy(), 0.0, 1.0
    while distance < MAX_DISTANCE_PIXELS:
        # Quarters of a pixel close by, where fine grain falls quickly; coarser steps farther off.
        step = 0.25 if distance < 4 else 1.0
        nearest = np.rint(at).astype(np.intp)
        row, column = (np.clip(nearest[a], 0, flat.shape[a] - 1) for a in (0, 1))
        at = at + step * direction[:, row, column]
        there = ndimage.map_coordinates(flat, at, order=1, mode="nearest")
        now = float(np.mean(here * there)) / power
        if now < 0.5:
            return distance + step * (before - 0.5) / (before - now)
        distance, before = distance + step, now
    return float(MAX_DISTANCE_PIXELS)


def aliasing(picture: Floats, reference: Floats, mask: Bools) -> float:
    """Root mean square error against a picture of many samples a pixel, over its deviation."""
    error = picture[mask] - reference[mask]
    return float(np.sqrt(np.mean(error**2)) / max(float(reference[mask].std()), 1e-12))


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
