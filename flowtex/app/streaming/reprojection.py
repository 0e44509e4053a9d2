"""Reprojection of a picture of a flat surface to another view.

Without perspective a plane is mapped to the view by an affine map, so a drawn picture can be moved
to its new place exactly: a drag follows the pointer however long a new picture takes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from flowtex._util.array_types import Bytes, Floats
from flowtex.field import Surface
from flowtex.rendering.camera import Camera

if TYPE_CHECKING:
    from PIL import Image

#: Change of scale below which a picture only shifts.
SCALE_TOLERANCE = 1e-3
#: Distance from a whole number of pixels below which a shift is one, in pixels.
SHIFT_TOLERANCE_PX = 0.02


@dataclass(frozen=True)
class Snapshot:
    """A picture and the view that it shows."""

    pixels: Bytes  #: (H, W, 3) uint8, row 0 at the top.
    #: Affine map from coordinates in the plane to the view's (x, y) from -1 to 1, (3, 3).
    view: Floats
    sharp: bool = False  #: Whether it is at full quality everywhere.


def plane_to_view(surface: Surface, camera: Camera, aspect: float) -> Floats | None:
    """Return the affine map from a flat surface to the view, (3, 3); ``None`` for others."""
    if surface.frame is None or not camera.parallel:
        return None
    axes = camera.axes[:2]
    scale = np.array([aspect, 1.0])[:, None] * camera.height
    view = np.eye(3)
    view[:2, :2] = axes @ surface.frame.T / scale
    view[:2, 2] = axes @ (surface.center - np.asarray(camera.focal_point)) / scale[:, 0]
    # A plane seen edge on cannot be moved to another view.
    return view if abs(np.linalg.det(view[:2, :2])) > 1e-12 * np.abs(view).max() ** 2 else None


def coverage(picture: Snapshot, view: Floats) -> tuple[float, float]:
    """Return the share of a new view that a picture covers, and how much its pixels grow in it."""
    back = picture.view @ np.linalg.inv(view)
    grid = np.linspace(-1, 1, 9)
    x, y = np.meshgrid(grid, grid)
    places = back @ np.stack([x.ravel(), y.ravel(), np.ones(x.size)])
    inside = (np.abs(places[:2]) <= 1.0 + 1e-9).all(axis=0)
    area = abs(float(np.linalg.det(back[:2, :2])))
    return float(inside.mean()), float(area**-0.5) if area > 0 else float("inf")


def whole_shift(picture: Snapshot, view: Floats) -> tuple[int, int] | None:
    """Return the shift of a picture in another view, right and down, if it is in whole pixels."""
    height, width = picture.pixels.shape[:2]
    change = view @ np.linalg.inv(picture.view)
    if np.abs(change[:2, :2] - np.eye(2)).max() * max(width, height) > SHIFT_TOLERANCE_PX:
        return None
    right, down = change[0, 2] * width / 2, -change[1, 2] * height / 2
    whole = round(right), round(down)
    exact = max(abs(right - whole[0]), abs(down - whole[1])) < SHIFT_TOLERANCE_PX
    return whole if exact and abs(whole[0]) < width and abs(whole[1]) < height else None


def reproject(
    picture: Snapshot, view: Floats, size: tuple[int, int], under: Snapshot | None = None
) -> Bytes:
    """Return a picture moved to another view, with ``under`` or black where it does not reach.

    If the scale changes, the result has half the size, in pixels: smooth interpolation takes time,
    and the picture has no finer details.
    """
    from PIL import Image

    half = (max(size[0] // 2, 1), max(size[1] // 2, 1))
    shifts = abs(coverage(picture, view)[1] - 1) < SCALE_TOLERANCE
    goal = size if shifts else half
    moved = _move(picture, view, goal, smooth=not shifts)
    if under is None:
        return np.asarray(moved)
    beneath = _move(under, view, half, smooth=True).resize(goal, Image.Resampling.NEAREST)
    height, width = picture.pixels.shape[:2]
    inside = Image.new("L", (width, height), 255)
    mask = inside.transform(goal, Image.Transform.AFFINE, _back(picture, view, goal))
    return np.asarray(Image.composite(moved, beneath, mask))


def _move(picture: Snapshot, view: Floats, size: tuple[int, int], *, smooth: bool) -> Image.Image:
    from PIL import Image

    kind = Image.Resampling.BILINEAR if smooth else Image.Resampling.NEAREST
    back = _back(picture, view, size)
    return Image.fromarray(picture.pixels).transform(
        size, Image.Transform.AFFINE, back, resample=kind
    )


def _back(picture: Snapshot, view: Floats, size: tuple[int, int]) -> tuple[float, ...]:
    """Return the map from pixels of the result to those of the picture, for Pillow."""
    height, width = picture.pixels.shape[:2]
    back = np.linalg.inv(_from_pixels(width, height)) @ picture.view @ np.linalg.inv(view)
    return tuple(float(v) for v in (back @ _from_pixels(*size))[:2].ravel())


def _from_pixels(width: int, height: int) -> Floats:
    """Return the map from pixels, y down, to the view's (x, y) from -1 to 1."""
    return np.array([[2 / width, 0, -1], [0, -2 / height, 1], [0, 0, 1.0]])
