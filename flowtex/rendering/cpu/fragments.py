"""Varyings of every pixel and their derivatives, between the rasteriser and the method."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flowtex._util.array_types import Floats, Indices
from flowtex._util.arrays import norm, smoothstep
from flowtex.field.triangles.triangle_nodes import normals_at_corners
from flowtex.rendering.cpu.path import Places, TrianglePlaces
from flowtex.rendering.cpu.raster import Coverage
from flowtex.rendering.shaders import const
from flowtex.rendering.uniforms import Values
from flowtex.textures.texture_set import TextureSet
from flowtex.textures.triangle_geometry import TriangleGeometry


@dataclass(frozen=True, eq=False)
class Varying:
    """Values at N fragments, (N, C), and their derivatives for a pixel to the right and down."""

    value: Floats
    dx: Floats
    dy: Floats

    def __getitem__(self, selection: slice) -> Varying:
        """Return a part of the fragments."""
        return Varying(self.value[selection], self.dx[selection], self.dy[selection])


@dataclass(frozen=True, eq=False)
class Fragments:
    """N pixels of a surface: their positions and normals in its own frame, (N, 3), and coordinates.

    These are of the slices, (N, 2), and of an image in place of the noise. A flat surface has no
    normals; others are of any length. On a surface of triangles the coordinates are the shares of
    the second and the third corner, and ``nodes`` (N, 3) are the corners' numbers.
    """

    position: Varying
    coordinate: Varying
    image: Varying | None = None
    normal: Varying | None = None
    nodes: Indices | None = None

    @classmethod
    def of(cls, textures: TextureSet, coverage: Coverage) -> Fragments:
        """Interpolate the values of the nodes to the pixels of a coverage."""
        geometry = textures.geometry
        image = textures.image

        def varying(nodal: NDArray[np.floating]) -> Varying:
            return Varying(*coverage.mix(nodal.reshape(-1, nodal.shape[-1])))

        if isinstance(geometry, TriangleGeometry):
            corners = coverage.corners
            # As the vertices of triangles have them, which no two triangles share.
            normals = normals_at_corners(geometry.points[0][corners], geometry.normal[0][corners])
            return cls(
                varying(geometry.position),
                Varying(*(a[:, 1:] for a in (coverage.weights, coverage.dx, coverage.dy))),
                normal=None if geometry.planar else Varying(*coverage.mix_corners(normals)),
                nodes=corners,
            )
        return cls(
            varying(geometry.position),
            varying(geometry.coordinate),
            None if image is None else varying(image.coordinate),
            None if geometry.planar else varying(geometry.normal),
        )

    @property
    def place(self) -> Places:
        """Places at which the slices are looked up."""
        coordinate = self.coordinate.value
        if self.nodes is None:
            return coordinate
        shares = np.concatenate([1 - coordinate.sum(axis=1, keepdims=True), coordinate], axis=1)
        return TrianglePlaces(shares, self.nodes, self.by)

    @property
    def by(self) -> Floats:
        """Change of the coordinates by a vector in the surface's frame, (N, 2, 3)."""
        at = self.coordinate
        dx = self.position.dx
        dy = self.position.dy
        normal = np.cross(dx, dy)
        square = np.einsum("nc,nc->n", normal, normal)[:, None]
        across = normal / np.maximum(square, np.finfo(float).tiny)
        first = np.cross(dy, across)
        second = np.cross(across, dx)
        return np.asarray(at.dx[:, :, None] * first[:, None] + at.dy[:, :, None] * second[:, None])

    def rim(self, eye: Floats) -> Floats:
        """Return the factor of the texture, (N,), less at the outlines of a smooth surface.

        The eye is ``u_eye``, (4,).
        """
        normal = self.normal
        if normal is None:
            return np.ones(len(self))
        ray = _unit(eye[:3] - eye[3] * self.position.value)
        aslant = np.abs(np.einsum("nc,nc->n", normal.value, ray))
        by_x = np.einsum("nc,nc->n", normal.dx, ray)
        by_y = np.einsum("nc,nc->n", normal.dy, ray)
        change = np.maximum(np.hypot(by_x, by_y), const.LEAST_SQUARE)
        # The square of how a curved surface faces the eye grows evenly from its outline.
        shown = smoothstep(const.RIM_HIDDEN, const.RIM_SHOWN, 0.5 * aslant / change)
        cosine = aslant / np.maximum(norm(normal.value), const.LEAST_SQUARE)
        return np.maximum(shown, smoothstep(const.RIM_ASLANT, const.RIM_FACING, cosine))

    def __len__(self) -> int:
        """Count the fragments."""
        return len(self.position.value)

    def parts(self, count: int) -> Iterator[tuple[slice, Fragments]]:
        """Yield parts of at most ``count`` fragments, with their slices."""
        for start in range(0, len(self), count):
            part = slice(start, start + count)
            if self.image is None:
                image = None
            else:
                image = self.image[part]
            if self.normal is None:
                normal = None
            else:
                normal = self.normal[part]
            if self.nodes is None:
                nodes = None
            else:
                nodes = self.nodes[part]
            yield part, Fragments(self.position[part], self.coordinate[part], image, normal, nodes)


def footprint(dx: Floats, dy: Floats) -> tuple[Floats, Floats]:
    """Return longest and shortest side of a pixel's footprint, (N,), by derivatives (N, C)."""
    aa = np.einsum("nc,nc->n", dx, dx)
    bb = np.einsum("nc,nc->n", dy, dy)
    ab = np.einsum("nc,nc->n", dx, dy)
    # |dx x dy|^2, whatever the number of channels is.
    square = np.maximum(aa * bb - ab * ab, 0.0)
    half = 0.5 * (aa + bb)
    root = np.sqrt(np.maximum(half * half - square, 0.0))
    longest = np.sqrt(np.maximum(half + root, np.finfo(float).tiny))
    return longest, np.sqrt(square) / longest


def on_surface(position: Varying, normal: Varying, eye: Floats) -> Varying:
    """Return positions with derivatives on the smooth surface; ``eye`` is ``u_eye``, (4,)."""
    ray = _unit(eye[:3] - eye[3] * position.value)
    toward = _unit(normal.value)
    facing = np.einsum("nc,nc->n", toward, ray)
    facing = np.where(facing < 0, -1.0, 1.0) * np.maximum(np.abs(facing), const.LEAST_FACING)

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
    levels = np.log2(np.maximum(shortest, const.LEAST_TEXELS))
    return np.asarray(np.clip(levels, 0.0, values["u_deepest"]))


def level_colour(level: Floats) -> Floats:
    """Return colours (..., 3) for levels of detail (...): one hue per doubling, six in a cycle."""
    turn = level[..., None] / const.LEVELS_AROUND + const.HUE_SHIFT * np.array([0.0, -1.0, 1.0])
    hue = 0.5 + 0.5 * np.cos(2 * const.PI * turn)
    return np.asarray(const.LEVEL_DARKEST + (1.0 - const.LEVEL_DARKEST) * hue)
