"""A picture of a flat surface, seen again from another view.

Without perspective a plane is mapped to the view by an affine map, so what was drawn already can
be moved to its new place exactly: a drag follows the hand however long a new picture takes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Shot", "coverage", "warp"]

Pixels = NDArray[np.uint8]
Matrix = NDArray[np.float64]


@dataclass(frozen=True)
class Shot:
    """A picture and the view that it shows.

    Attributes
    ----------
    pixels
        (H, W, 3) uint8, row 0 at the top.
    view
        Affine map from coordinates in the plane to the view's (x, y) from -1 to 1, (3, 3).
    """

    pixels: Pixels
    view: Matrix


def coverage(shot: Shot, view: Matrix) -> tuple[float, float]:
    """Tell how well a picture serves for another view.

    Returns
    -------
    share, stretch
        How much of the new view it covers, 0 to 1, and how much larger its pixels become.
    """
    back = shot.view @ np.linalg.inv(view)
    grid = np.linspace(-1, 1, 9)
    x, y = np.meshgrid(grid, grid)
    seen = back @ np.stack([x.ravel(), y.ravel(), np.ones(x.size)])
    inside = (np.abs(seen[:2]) <= 1.0 + 1e-9).all(axis=0)
    area = abs(float(np.linalg.det(back[:2, :2])))
    return float(inside.mean()), float(area**-0.5) if area > 0 else float("inf")


def warp(shot: Shot, view: Matrix, under: Pixels | None = None) -> Pixels:
    """Show a picture from another view.

    Parameters
    ----------
    shot
        What was drawn.
    view
        The new view, as in :class:`Shot`.
    under
        What to show where the picture does not reach, (h, w, 3) of any size; its own edge
        colours are repeated when left out.

    Returns
    -------
    numpy.ndarray
        (H, W, 3) uint8.
    """
    from PIL import Image

    height, width = shot.pixels.shape[:2]
    to_view = np.array([[2 / width, 0, -1], [0, -2 / height, 1], [0, 0, 1.0]])
    back = np.linalg.inv(to_view) @ shot.view @ np.linalg.inv(view) @ to_view
    data = tuple(float(v) for v in back[:2].ravel())
    size, affine = (width, height), Image.Transform.AFFINE
    picture = Image.fromarray(shot.pixels)
    moved = picture.transform(size, affine, data, resample=Image.Resampling.BILINEAR)
    if under is None:
        return np.asarray(moved)
    base = Image.fromarray(under).resize(size, Image.Resampling.BILINEAR)
    mask = Image.new("L", size, 255).transform(size, affine, data)
    return np.asarray(Image.composite(moved, base, mask))
