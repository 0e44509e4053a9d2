"""Levels of detail from the footprint of a pixel: ``shaders/common/levels.glsl``."""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.rendering.constants import (
    HUE_SHIFT,
    LEAST_FACING,
    LEAST_SQUARE,
    LEAST_TEXELS,
    LEVEL_DARKEST,
    LEVELS_AROUND,
    PI,
)
from flowtex.rendering.cpu.fragments import Varying
from flowtex.rendering.uniforms import Values


def footprint(dx: Floats, dy: Floats) -> tuple[Floats, Floats]:
    """Return the longest and the shortest side of a pixel's footprint, (N,) each.

    They follow from derivatives, (N, C).
    """
    aa, bb, ab = (np.einsum("nc,nc->n", p, q) for p, q in ((dx, dx), (dy, dy), (dx, dy)))
    # |dx x dy|^2, whatever the number of channels is.
    square = np.maximum(aa * bb - ab * ab, 0.0)
    half = 0.5 * (aa + bb)
    root = np.sqrt(np.maximum(half * half - square, 0.0))
    longest = np.sqrt(np.maximum(half + root, LEAST_SQUARE))
    return longest, np.sqrt(square) / longest


def on_surface(position: Varying, normal: Varying, eye: Floats) -> Varying:
    """Return positions with derivatives on the smooth surface instead of its facets.

    Positions and normals have three channels; ``eye`` is ``u_eye``, (4,).
    """
    ray = _unit(eye[:3] - eye[3] * position.value)
    toward = _unit(normal.value)
    facing = np.einsum("nc,nc->n", toward, ray)
    facing = np.where(facing < 0, -1.0, 1.0) * np.maximum(np.abs(facing), LEAST_FACING)

    def moved(derivative: Floats) -> Floats:
        slope = np.einsum("nc,nc->n", toward, derivative) / facing
        return np.asarray(derivative - ray * slope[:, None])

    return Varying(position.value, moved(position.dx), moved(position.dy))


def _unit(vector: Floats) -> Floats:
    length = np.linalg.norm(vector, axis=-1, keepdims=True)
    return np.asarray(vector / np.maximum(length, np.finfo(float).tiny))


def slice_level(coordinate: Varying, values: Values) -> Floats:
    """Return the mip level of the slice texture, (N,), for the shorter side of the footprint."""
    if not values["u_lod"]:
        return np.zeros(len(coordinate.value))
    size = np.asarray(values["u_slicesSize"])
    _, shortest = footprint(coordinate.dx * size, coordinate.dy * size)
    levels = np.log2(np.maximum(shortest, LEAST_TEXELS))
    return np.asarray(np.clip(levels, 0.0, values["u_deepest"]))


def level_colour(level: Floats) -> Floats:
    """Return colours (..., 3) for levels of detail (...): one hue per doubling, six in a cycle."""
    turn = level[..., None] / LEVELS_AROUND + HUE_SHIFT * np.array([0.0, -1.0, 1.0])
    hue = 0.5 + 0.5 * np.cos(2 * PI * turn)
    return np.asarray(LEVEL_DARKEST + (1.0 - LEVEL_DARKEST) * hue)
