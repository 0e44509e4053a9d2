"""Where points of the mesh are in the view, from -1 to 1 to the right and up."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from flowtex.app.streaming.navigate import Navigator
from flowtex.camera import Camera
from flowtex.plotting.vtk_camera import read_camera

__all__ = ["BEYOND", "camera_of", "project", "runs"]

Floats = NDArray[np.float64]

#: How far beyond the view a line is drawn, in halves of the view.
BEYOND = 2.0


def camera_of(navigator: Navigator) -> Camera:
    """Camera of the picture, as :func:`flowtex.probe.probe` takes it."""
    return read_camera(navigator.camera)


def project(navigator: Navigator, points: Floats) -> Floats:
    """Places of points in the view.

    Parameters
    ----------
    navigator
        What moves the camera.
    points
        Points in the mesh's own coordinates, (..., 3).

    Returns
    -------
    numpy.ndarray
        Places from -1 to 1, to the right and up, (..., 2); NaN for points behind the camera.
    """
    camera = navigator.camera
    # Counted from the focal point, the digits are those of the view.
    away = np.asarray(points, dtype=float) - np.asarray(camera.GetFocalPoint())
    right, up, depth = (away @ axis for axis in navigator.axes)
    places = np.stack([right / navigator.aspect, up], axis=-1) / navigator.height
    if camera.GetParallelProjection():
        return places
    # What is as far away as the focal point is seen as if there were no perspective.
    nearer: Floats = np.asarray(1.0 + depth / float(camera.GetDistance()))[..., None]
    return np.where(nearer > 0, places / np.where(nearer > 0, nearer, 1.0), np.nan)


def runs(places: Floats, beyond: float = BEYOND) -> list[list[list[float]]]:
    """Cut a line in the view to what can be seen.

    Parameters
    ----------
    places
        Places in the view, (N, 2), NaN where there is none.
    beyond
        How far from the middle a line is kept, in halves of the view.

    Returns
    -------
    list of list of list of float
        Stretches of the line, each of two places [x, y] or more.
    """
    a, b = places[:-1], places[1:]
    known = np.asarray(np.isfinite(a).all(axis=-1) & np.isfinite(b).all(axis=-1))
    a, b = np.where(known[:, None], a, 2 * beyond), np.where(known[:, None], b, 2 * beyond)
    step = b - a
    moving = np.abs(step) > 1e-300
    ends = np.stack([(side - a) / np.where(moving, step, 1.0) for side in (-beyond, beyond)])
    aside = np.where(np.abs(a) <= beyond, -np.inf, np.inf)
    enter: Floats = np.max(np.where(moving, ends.min(axis=0), aside), axis=-1)
    leave: Floats = np.min(np.where(moving, ends.max(axis=0), np.inf), axis=-1)
    first: Floats = np.clip(enter, 0, 1)
    last: Floats = np.clip(leave, 0, 1)
    seen = known & (enter <= 1) & (leave >= 0) & (first < last)
    result: list[list[list[float]]] = []
    for k in np.flatnonzero(seen).tolist():
        if not (result and first[k] == 0 and k > 0 and seen[k - 1] and last[k - 1] == 1):
            result.append([(a[k] + first[k] * step[k]).tolist()])
        result[-1].append((a[k] + last[k] * step[k]).tolist())
    return result
