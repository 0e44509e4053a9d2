"""Triangles as a renderer draws them, and how their nodes lie in the textures."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from flowtex._util.array_types import AnyArray, Floats, Floats32, Indices
from flowtex._util.arrays import bounds
from flowtex.field import FlowField
from flowtex.field.triangles.triangle_nodes import normals_at_corners
from flowtex.field.triangles.triangle_surface import Surface, TriangleSurface
from flowtex.textures.geometry import DrawnSurface


@dataclass(frozen=True, eq=False)
class TriangleGeometry(DrawnSurface):
    """Triangles ready to be drawn.

    Nodes fill the texels of a texture row by row. A fragment looks up the three of its triangle, so
    each has three vertices with the numbers of its nodes and the shares of the second and the
    third.
    """

    field: FlowField  #: The flow, with nodes (1, N).
    nodes: slice | Indices  #: Numbers of the nodes that are drawn, (n,), or all of them.
    triangles: Indices  #: Nodes at the corners of what is drawn, (m, 3), as numbers among these.
    members: Indices  #: Numbers of these triangles in the field, (m,).
    whole: Surface  #: The surface that a tile is a part of, whose middle, size and frame it has.
    #: Blocks that each triangle lies in, (m,): bit b is the block at row b // C of C columns, and
    #: column b % C.
    blocks: NDArray[np.uint16]
    #: Centre, radius and longest side of a triangle of each block, (rows, C, 5).
    block_places: Floats

    levels = 0  #: Mip levels besides the finest: none, for other levels of detail are other meshes.
    periodic = (False, False)

    @classmethod
    def of(cls, field: FlowField) -> TriangleGeometry:
        """Lay out a field's surface."""
        surface = field.surface
        assert isinstance(surface, TriangleSurface)
        members = surface.drawn
        triangles = surface.triangles[members]
        blocks = _one_block(surface.points[0], triangles)
        return cls(field, slice(None), triangles, members, surface, *blocks)

    @classmethod
    def of_tile(
        cls,
        field: FlowField,
        nodes: Indices,
        triangles: Indices,
        members: Indices,
        whole: Surface,
        blocks: tuple[NDArray[np.uint16], Floats] | None = None,
    ) -> TriangleGeometry:
        """Lay out nodes (n,) and triangles (m, 3), ``members``, as part of a larger surface."""
        number = np.zeros(field.shape[1], dtype=np.intp)
        number[nodes] = np.arange(len(nodes))
        blocks = blocks or _one_block(field.surface.points[0], triangles)
        return cls(field, nodes, number[triangles], members, whole, *blocks)

    @property
    def drawn(self) -> tuple[slice, slice | Indices]:
        """Index that selects the drawn nodes in arrays over the nodes of the field, (1, N)."""
        return slice(0, 1), self.nodes

    texels = drawn  #: The nodes of the field that lie in the textures: those that are drawn.

    @property
    def shape(self) -> tuple[int, int]:
        """Number of nodes (1, n) that are drawn."""
        return 1, self.points.shape[1]

    @cached_property
    def size(self) -> tuple[int, int]:
        """Rows and columns (H, W) of texels: about a square, with a power of two as W."""
        return image_size(self.shape[1])

    @cached_property
    def normal(self) -> Floats32:
        """Unit normals at the nodes, (1, n, 3), in the mesh's own axes."""
        surface = self.field.surface
        assert isinstance(surface, TriangleSurface)
        return surface.normals[self.drawn].astype(np.float32)

    @property
    def coordinate(self) -> Floats32:
        """Shares of the second and the third corner at the corners, (m, 3, 2)."""
        corners = np.array([[0, 0], [1, 0], [0, 1]], dtype=np.float32)
        return np.broadcast_to(corners, (len(self.triangles), 3, 2))

    @property
    def faces(self) -> Indices:
        """Vertices of each triangle, (m, 3)."""
        return np.arange(self.triangles.size).reshape(-1, 3)

    def displacements(self, frame: Floats) -> Callable[[AnyArray, float], AnyArray]:
        """Return a function from displacements in space, (1, n, 3), to a frame, (C, 1, n)."""
        return lambda displacement, error: np.moveaxis(displacement @ frame.T, -1, 0)

    @cached_property
    def corners(self) -> Floats32:
        """Numbers of the three nodes, and of the triangle, at each vertex, (3 m, 4)."""
        numbers = np.column_stack([self.triangles, np.arange(len(self.triangles))])
        return np.repeat(numbers.astype(np.float32), 3, axis=0)

    def drawn_values(self, values: AnyArray, *, on_cells: bool) -> AnyArray:
        """Return the values of a scalar at the drawn nodes (..., 1, n) or triangles (..., 1, m)."""
        if on_cells:
            return values[..., self.members]
        return values[..., self.nodes]

    def at_vertices(self, nodal: AnyArray, *, on_cells: bool = False) -> AnyArray:
        """Return values at the vertices, (3 m, ...), from drawn nodes or triangles, (1, n, ...)."""
        if on_cells:
            return np.repeat(nodal[0], 3, axis=0)
        return np.asarray(nodal[0][self.triangles.ravel()])

    @property
    def vertex_normals(self) -> Floats32:
        """Unit normals at the vertices, (3 m, 3), in the mesh's own axes."""
        points = self.points[0][self.triangles]
        normals = self.normal[0][self.triangles]
        return normals_at_corners(points, normals).astype(np.float32).reshape(-1, 3)

    def as_image(self, values: AnyArray, *, on_cells: bool) -> AnyArray:
        """Return values at the vertices (3 m,) as an image of the nodes or triangles, (H, W)."""
        if on_cells:
            size = image_size(len(self.triangles))
            at = np.repeat(np.arange(len(self.triangles)), 3)
        else:
            size = self.size
            at = self.triangles.ravel()
        image = np.zeros(size, values.dtype)
        image.reshape(-1)[at] = values
        return image

    def write_texels(self, data: Floats32, texels: AnyArray) -> None:
        """Write data (1, n, C) of the nodes into texels (H, W, C)."""
        flat = texels.reshape(-1, texels.shape[-1])
        flat[: data.shape[1]] = data[0]
        flat[data.shape[1] :] = 0


def image_size(count: int) -> tuple[int, int]:
    """Return rows and columns of texels for a number of items, about a square."""
    width = 1 << int(np.ceil(np.log2(max(count, 1)) / 2))
    return -(-count // width), width


def _one_block(points: Floats, triangles: Indices) -> tuple[NDArray[np.uint16], Floats]:
    """Return one block for triangles (m, 3) of points (N, 3): its masks (m,) and its place."""
    corners = points[triangles]
    center = bounds(corners.reshape(-1, 3)).mean(axis=0)
    radius = np.linalg.norm(corners - center, axis=-1).max()
    side = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=-1).max()
    return np.ones(len(triangles), np.uint16), np.array([[[*center, radius, side]]])
