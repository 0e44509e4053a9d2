"""Where the view meets the surface, and how a flat surface lies in it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex.app.streaming.navigate import Navigator
from flowtex.field import Surface

__all__ = ["hit", "plane_view", "ray", "within_reach"]

#: Farthest and nearest that a camera may be, in extents of the surface: beyond, numbers end.
FAR, NEAR = 1e9, 1e-9


def plane_view(surface: Surface, navigator: Navigator) -> NDArray[np.float64] | None:
    """Affine map from a flat surface's plane to the view, (3, 3); ``None`` when it has none."""
    camera = navigator.camera
    if surface.frame is None or not camera.GetParallelProjection():
        return None
    right, up, _ = navigator.axes
    scale = np.array([navigator.aspect, 1.0])[:, None] * navigator.height
    view = np.eye(3)
    view[:2, :2] = np.stack([right, up]) @ surface.frame.T / scale
    offset = surface.center - np.asarray(camera.GetFocalPoint())
    view[:2, 2] = np.stack([right, up]) @ offset / scale[:, 0]
    # A plane seen edge on cannot be moved to another view.
    return view if abs(np.linalg.det(view[:2, :2])) > 1e-12 * np.abs(view).max() ** 2 else None


def within_reach(camera: Mapping[str, Any], surface: Surface) -> bool:
    """Tell whether a camera, as :meth:`Canvas.camera` has it, is of use for a surface."""
    eye, focus = (np.asarray(camera[name], dtype=float) for name in ("position", "focal_point"))
    far = np.abs([eye - surface.center, focus - surface.center]).max() <= FAR * surface.extent
    sizes = (float(np.abs(eye - focus).max()), float(camera["parallel_scale"]))
    return bool(far and all(NEAR <= size / surface.extent <= FAR for size in sizes))


def hit(
    mesh: Any, extent: float, navigator: Navigator, x: float, y: float
) -> NDArray[np.float64] | None:
    """Point of a mesh at a place of the view, from -1 to 1, right and up; ``None`` beside it."""
    start, along = ray(navigator, x, y)
    reach = navigator.camera.GetDistance() + 2 * extent
    points, _ = mesh.ray_trace(start, start + along * reach, first_point=True)
    return np.asarray(points, dtype=float) if len(points) else None


def ray(
    navigator: Navigator, x: float, y: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Start and direction, of length one, of what is seen at a place of the view."""
    camera = navigator.camera
    right, up, ahead = navigator.axes
    position, focus = np.asarray(camera.GetPosition()), np.asarray(camera.GetFocalPoint())
    at = focus + (right * x * navigator.aspect + up * y) * navigator.height
    parallel = camera.GetParallelProjection()
    start = at - ahead * camera.GetDistance() if parallel else position
    return start, (at - start) / np.linalg.norm(at - start)
