"""One place of the surface as a pixel of it: what :func:`cover` would find there."""

from __future__ import annotations

import numpy as np

from flowtex.field import Surface
from flowtex.field.facets import Facet
from flowtex.rendering.cpu.camera import Camera
from flowtex.rendering.cpu.raster import Coverage

__all__ = ["facing", "spot"]


def spot(surface: Surface, place: Facet, camera: Camera) -> Coverage:
    """Cover one place, whether or not something stands before it.

    Parameters
    ----------
    surface
        The surface.
    place
        A place on one of its triangles.
    camera
        The picture whose pixel the place is given.

    Raises
    ------
    ValueError
        When the place is behind the camera, or its triangle is seen edge on.
    """
    points = surface.points.reshape(-1, 3)[place.nodes] - surface.center
    matrix = camera.matrix(surface.center)
    clip = points @ matrix[:, :3].T + matrix[:, 3]
    x, y, _, w = place.weights @ clip
    if not w > 0:
        msg = f"(j, i) = {place.index} lies behind the camera at {camera.position}; expected a "
        raise ValueError(msg + "camera that sees the place")
    # Derivatives of pixels to the right and down by the shares of the corners.
    pixels = np.array(camera.size) * [0.5, -0.5]
    by_share = (clip[:, :2] - clip[:, 3:] * [x / w, y / w]) * pixels / w
    # The shares sum to one, so two of them are free.
    free = by_share[1:] - by_share[0]
    if not abs(np.linalg.det(free)) > 1e-12 * np.abs(free).max() ** 2:
        msg = f"the triangle at (j, i) = {place.index} is seen edge on; expected one that is seen"
        raise ValueError(msg)
    two = np.linalg.inv(free)
    shares = np.concatenate([-two.sum(axis=1, keepdims=True), two], axis=1)
    first = np.zeros(1, dtype=np.intp)
    return Coverage(first, place.nodes[None], place.weights[None], shares[:1], shares[1:])


def facing(surface: Surface, place: Facet, pixel: float) -> Camera:
    """Camera that looks straight at a place, and has one pixel.

    Parameters
    ----------
    surface
        The surface.
    place
        A place on one of its triangles.
    pixel
        Width of the pixel in the mesh's units.

    Raises
    ------
    ValueError
        When the width is not positive, or the triangle has no area.
    """
    if not 0 < pixel < np.inf:
        msg = f"pixel is {pixel!r}; expected a positive length in the mesh's units, or a Camera"
        raise ValueError(msg)
    a, b, c = surface.points.reshape(-1, 3)[place.nodes]
    across = np.cross(b - a, c - a)
    length = float(np.linalg.norm(across))
    if not length > 0:
        msg = f"the triangle at (j, i) = {place.index} has no area; expected a place beside it"
        raise ValueError(msg)
    at = place.weights @ np.stack([a, b, c])
    position = at + across / length * surface.extent
    up = max((b - a, c - a), key=lambda side: float(np.linalg.norm(side)))
    points = [(float(p[0]), float(p[1]), float(p[2])) for p in (position, at, up)]
    return Camera(points[0], points[1], points[2], (1, 1), parallel_scale=0.5 * float(pixel))
