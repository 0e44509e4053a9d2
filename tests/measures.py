"""What a picture shows of a flow: the angle of its streaks, and their coherence."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter, map_coordinates, sobel

Floats = NDArray[np.float64]


def grey(image: NDArray[Any]) -> Floats:
    """Mean of the channels, (H, W)."""
    image = np.asarray(image, dtype=float)
    return np.asarray(image[..., :3].mean(axis=-1) if image.ndim == 3 else image)


def streaks(image: NDArray[Any], u: Floats, v: Floats, mask: NDArray[np.bool_]) -> dict[str, float]:
    """Mean angle in degrees between streaks and flow (v is up), and coherence from 0 to 1.

    Both come from the structure tensor, averaged over a Gaussian of four pixels.
    """
    smooth = gaussian_filter(grey(image), 0.7)
    right, down = sobel(smooth, axis=1), sobel(smooth, axis=0)
    xx, yy, xy = (gaussian_filter(a, 4.0) for a in (right * right, down * down, right * down))
    along = 0.5 * np.arctan2(2 * xy, xx - yy) + np.pi / 2
    off = np.abs((along - np.arctan2(-v, u) + np.pi / 2) % np.pi - np.pi / 2)
    coherence = np.hypot(xx - yy, 2 * xy) / np.maximum(xx + yy, 1e-12)
    return {
        "angle": float(np.degrees(off[mask]).mean()),
        "coherence": float(coherence[mask].mean()),
    }


def fineness(image: NDArray[Any], mask: NDArray[np.bool_]) -> float:
    """Mean change from pixel to pixel over the deviation: how fine the grain is."""
    g = grey(image)
    step = np.hypot(np.diff(g, axis=0)[:, :-1], np.diff(g, axis=1)[:-1])
    return float(step[mask[:-1, :-1]].mean() / g[mask].std())


def carried(
    first: NDArray[Any], second: NDArray[Any], dx: Floats, dy: Floats, margin: int
) -> float:
    """Correlation of a picture, moved by (dx, dy) pixels right and down, with the next one."""
    a, b = grey(first), grey(second)
    rows, columns = np.indices(a.shape)
    moved = map_coordinates(a, [rows - dy, columns - dx], order=1, mode="nearest")
    inside = (slice(margin, -margin), slice(margin, -margin))
    return float(np.corrcoef(moved[inside].ravel(), b[inside].ravel())[0, 1])
