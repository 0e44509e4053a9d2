"""What a picture shows of a flow, measured from its pixels alone.

Pictures are (H, W) or (H, W, 3), row 0 at the top. The flow at each pixel is ``u`` to the right
and ``v`` up; only its direction counts. ``mask`` (H, W) says which pixels to judge: not the
background, not a border of a dozen pixels, and not where the flow nearly stands.
"""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
from scipy.ndimage import gaussian_filter, map_coordinates, sobel

from flowtex._util.array_types import AnyArray, Bools, Floats
from flowtex._util.progress import track
from flowtex.plotting.offscreen.encoders import MovieWriter

WINDOW = 4.0  #: Standard deviation in pixels of the window in which streaks are told from noise.


def grey(image: AnyArray) -> Floats:
    """Mean of the channels, (H, W)."""
    image = np.asarray(image, dtype=float)
    return np.asarray(image[..., :3].mean(axis=-1) if image.ndim == 3 else image)


def streaks(image: AnyArray, u: Floats, v: Floats, mask: Bools) -> dict[str, float]:
    """Mean angle in degrees between streaks and flow, and coherence from 0 to 1.

    Both come from the structure tensor, averaged over a Gaussian of four pixels.
    """
    smooth = gaussian_filter(grey(image), 0.7)
    right, down = sobel(smooth, axis=1), sobel(smooth, axis=0)
    xx, yy, xy = (gaussian_filter(a, WINDOW) for a in (right * right, down * down, right * down))
    along = 0.5 * np.arctan2(2 * xy, xx - yy) + np.pi / 2
    off = np.abs((along - np.arctan2(-v, u) + np.pi / 2) % np.pi - np.pi / 2)
    coherence = np.hypot(xx - yy, 2 * xy) / np.maximum(xx + yy, 1e-12)
    return {
        "angle": float(np.degrees(off[mask]).mean()),
        "coherence": float(coherence[mask].mean()),
    }


def carried(
    first: AnyArray, second: AnyArray, dx: Floats, dy: Floats, margin: int | Bools
) -> float:
    """Correlation of a picture, moved by (dx, dy) pixels right and down, with the next one.

    ``margin`` is a number of pixels to leave out along the border, or a mask.
    """
    a, b = grey(first), grey(second)
    rows, columns = np.indices(a.shape)
    moved = map_coordinates(a, [rows - dy, columns - dx], order=1, mode="nearest")
    inside: Any = margin
    if isinstance(margin, int):
        inside = (slice(margin, -margin), slice(margin, -margin))
    return float(np.corrcoef(moved[inside].ravel(), b[inside].ravel())[0, 1])


def write_movie(path: Path, pictures: Iterable[AnyArray], fps: float, quality: int = 80) -> None:
    """Write pictures as a movie, as :func:`flowtex.movie` does."""
    first, *others = pictures
    with closing(MovieWriter(path, first.shape[1::-1], fps, quality)) as writer:
        for picture in track([first, *others], 1 + len(others), ""):
            writer.add(picture)
        writer.finish()
