"""Varyings of every pixel and their derivatives, between the rasteriser and the method."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flowtex._util.array_types import Floats, Indices
from flowtex.field.triangles.topology import normals_at_corners
from flowtex.rendering.cpu.path import Places, TrianglePlaces, coordinates_by
from flowtex.rendering.cpu.raster import Coverage
from flowtex.textures import TextureSet, TriangleGeometry


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

    These are of the slices, (N, 2), and of the noise where it has a texture. A flat surface has no
    normals; others are of any length. On a surface of triangles the coordinates are the shares of
    the second and the third corner, and ``nodes`` (N, 3) are the corners' numbers.
    """

    position: Varying
    coordinate: Varying
    noise: Varying | None = None
    normal: Varying | None = None
    nodes: Indices | None = None

    @classmethod
    def of(cls, textures: TextureSet, coverage: Coverage) -> Fragments:
        """Interpolate the values of the nodes to the pixels of a coverage."""
        geometry, paper = textures.geometry, textures.paper

        def varying(nodal: NDArray[np.floating]) -> Varying:
            return Varying(*coverage.mix(nodal.reshape(-1, nodal.shape[-1])))

        if isinstance(geometry, TriangleGeometry):
            return cls(
                varying(geometry.position),
                Varying(*(a[:, 1:] for a in (coverage.weights, coverage.dx, coverage.dy))),
                normal=None if geometry.planar else _normals(geometry, coverage),
                nodes=coverage.corners,
            )
        return cls(
            varying(geometry.position),
            varying(geometry.coordinate),
            None if paper is None else varying(paper.coordinate),
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
        at, position = self.coordinate, self.position
        return coordinates_by(position.dx, position.dy, at.dx, at.dy)

    def __len__(self) -> int:
        """Count the fragments."""
        return len(self.position.value)

    def parts(self, count: int) -> Iterator[tuple[slice, Fragments]]:
        """Yield parts of at most ``count`` fragments, with their slices."""
        for start in range(0, len(self), count):
            part = slice(start, start + count)
            noise, normal = (None if v is None else v[part] for v in (self.noise, self.normal))
            nodes = None if self.nodes is None else self.nodes[part]
            yield part, Fragments(self.position[part], self.coordinate[part], noise, normal, nodes)


def _normals(geometry: TriangleGeometry, coverage: Coverage) -> Varying:
    """Interpolate normals as the vertices of triangles have them, which no two triangles share."""
    corners = coverage.corners
    normals = normals_at_corners(geometry.points[0][corners], geometry.normal[0][corners])
    value, dx, dy = (
        np.einsum("nk,nkc->nc", share, normals)
        for share in (coverage.weights, coverage.dx, coverage.dy)
    )
    return Varying(value, dx, dy)
