"""Moves of a camera as in the browser: the reference of ``client/src/camera.ts``."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import Floats
from flowtex.rendering.camera import CAMERA_LIMITS, Camera, Point


def _shifted(camera: Camera, by: Floats) -> Camera:
    ends = (np.add(end, by).tolist() for end in (camera.position, camera.focal_point))
    return replace(camera, **dict(zip(("position", "focal_point"), ends, strict=True)))


def pan(camera: Camera, dx: float, dy: float, aspect: float) -> Camera:
    """Return the camera after a pan by a fraction of the view."""
    right, up, _ = camera.axes
    return _shifted(camera, (right * dx * aspect + up * dy) * camera.height)


def rotate(
    camera: Camera, dx: float, dy: float, aspect: float, pivot: ArrayLike | None = None
) -> Camera:
    """Return the camera after a rotation, as by a drag by (dx, dy).

    The centre of the rotation is ``pivot``, (3,), by default the focal point.
    """
    around = np.asarray(camera.focal_point if pivot is None else pivot, dtype=float)
    aside = -CAMERA_LIMITS.turn * dx * min(aspect, CAMERA_LIMITS.widest_turn)
    up = np.asarray(camera.up)
    right = _turned(camera.axes[0], up, aside)

    def turned(vector: ArrayLike) -> Floats:
        level = _turned(np.asarray(vector, dtype=float), up, aside)
        return _turned(level, -right, -CAMERA_LIMITS.turn * dy)

    return replace(
        camera,
        position=point_of(around + turned(camera.position - around)),
        focal_point=point_of(around + turned(camera.focal_point - around)),
        # The old up need not be off the new line of sight, so the axes turn along with it.
        up=point_of(turned(camera.axes[1])),
    )


def zoom_by(
    camera: Camera,
    factor: float,
    x: float = 0.0,
    y: float = 0.0,
    *,
    aspect: float,
    whole: Camera,
    target: ArrayLike | None = None,
) -> Camera:
    """Return the camera after a zoom; the point at (x, y) stays where it is.

    Parameters
    ----------
    factor
        More than 1 zooms in; a factor that is not a positive number changes nothing.
    x, y
        Point in the view that keeps its place.
    aspect
        Width of the picture over its height.
    whole
        Camera that shows the whole surface, which has zoom 1.
    target
        Point of the surface at (x, y), (3,). The focal point moves to its depth, which does not
        change the view, so that a perspective camera never enters the surface.
    """
    if not math.isfinite(factor) or factor <= 0:
        return camera
    camera = camera if target is None else _focused(camera, np.asarray(target, dtype=float))
    limits, zoom = CAMERA_LIMITS, whole.height / camera.height
    factor = min(max(factor, limits.farthest_zoom / zoom), limits.deepest_zoom / zoom)
    right, up, ahead = camera.axes
    offset = (right * x * aspect + up * y) * camera.height
    moved = _shifted(camera, offset * (1 - 1 / factor))
    if camera.parallel:
        return replace(moved, parallel_scale=camera.parallel_scale / factor)
    height = camera.height / factor
    half = math.tan(math.radians(limits.view_angle / 2))
    distance = max(height / half, whole.distance / limits.closest)
    return replace(
        moved,
        position=point_of(np.asarray(moved.focal_point) - ahead * distance),
        view_angle=2 * math.degrees(math.atan(height / distance)),
    )


def _focused(camera: Camera, point: Floats) -> Camera:
    """Bring the focal point to the depth of a point; the view stays the same."""
    ahead = camera.axes[2]
    depth = float((point - camera.position) @ ahead)
    if depth <= 0:
        return camera
    return replace(camera, focal_point=point_of(camera.position + ahead * depth))


def _turned(vector: Floats, axis: Floats, degrees: float) -> Floats:
    """Rotate a vector about an axis, by the right-hand rule."""
    axis = axis / np.linalg.norm(axis)
    angle = math.radians(degrees)
    along = axis * (axis @ vector)
    across = vector - along
    return np.asarray(along + across * math.cos(angle) + np.cross(axis, vector) * math.sin(angle))


def point_of(values: ArrayLike) -> Point:
    x, y, z = (float(v) for v in np.asarray(values))
    return x, y, z
