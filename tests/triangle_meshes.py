"""Surfaces of triangles for tests: points (N, 3) and numbers of the corners (M, 3)."""

from __future__ import annotations

import numpy as np
from scipy.spatial import Delaunay

from flowtex import FlowField
from flowtex._util.array_types import Floats, Indices
from flowtex.field.triangles.triangle_surface import TriangleSurface

Mesh = tuple[Floats, Indices]


def random_plane(rng: np.random.Generator, nodes: int, *, grading: float = 1.0) -> Mesh:
    """Triangulate random points of the unit square; sides grow by ``grading`` along x."""
    side = int(np.sqrt(nodes))
    edge = np.linspace(0, 1, side)
    border = [(edge, 0 * edge), (edge, 0 * edge + 1), (0 * edge, edge), (0 * edge + 1, edge)]
    inner = rng.uniform(0.3 / side, 1 - 0.3 / side, (nodes, 2))
    flat = np.unique(np.concatenate([*(np.stack(b, -1) for b in border), inner]), axis=0)
    if grading > 1:
        # The density of nodes falls with x as the sides grow.
        flat[:, 0] = (grading ** flat[:, 0] - 1) / (grading - 1)
    triangles = Delaunay(flat).simplices.astype(np.intp)
    return np.column_stack([flat, np.zeros(len(flat))]), triangles


def sphere(subdivisions: int) -> Mesh:
    """Return a unit sphere: an icosahedron whose sides are halved so many times."""
    import pyvista as pv

    mesh = pv.Icosphere(nsub=subdivisions)
    points = np.asarray(mesh.points, float)
    return points / np.linalg.norm(points, axis=1, keepdims=True), mesh.regular_faces.astype(int)


def cube(cells: int) -> Mesh:
    """Return the surface of the cube from -1 to 1, each face cut into squares and these in two."""
    import pyvista as pv

    mesh = pv.Box(level=cells - 1).triangulate().clean()
    return np.asarray(mesh.points, float), mesh.regular_faces.astype(int)


def sheet(heights: Floats, cell: float = 1.0) -> Mesh:
    """Return the surface at some heights (rows, columns) above a plane of square cells."""
    rows, columns = heights.shape
    y, x = cell * np.indices(heights.shape, dtype=float)
    points = np.stack([x, y, heights], axis=-1).reshape(-1, 3)
    node = np.arange(rows * columns).reshape(rows, columns)
    near = np.stack([node[:-1, :-1], node[:-1, 1:], node[1:, 1:]], axis=-1)
    far = np.stack([node[:-1, :-1], node[1:, 1:], node[1:, :-1]], axis=-1)
    return points, np.concatenate([near.reshape(-1, 3), far.reshape(-1, 3)])


def joined(*meshes: Mesh) -> Mesh:
    """Return several surfaces as one that is not connected."""
    first = np.cumsum([0, *(len(points) for points, _ in meshes)])
    triangles = [part + n for n, (_, part) in zip(first, meshes, strict=False)]
    return np.concatenate([points for points, _ in meshes]), np.concatenate(triangles)


def tube(around: Floats, along: Floats, *, closed: bool) -> Mesh:
    """Return a tube along x with a section (n, 2) at places (m,), maybe with ends."""
    count = len(around)
    points = np.column_stack([np.repeat(along, count), np.tile(around, (len(along), 1))])
    node = np.arange(len(points)).reshape(len(along), count)
    after = np.roll(node, -1, axis=1)
    near = np.stack([node[:-1], after[:-1], after[1:]], axis=-1)
    far = np.stack([node[:-1], after[1:], node[1:]], axis=-1)
    parts = [near.reshape(-1, 3), far.reshape(-1, 3)]
    if closed:
        middle = np.full(count, len(points))
        parts.append(np.column_stack([after[0], node[0], middle]))
        parts.append(np.column_stack([node[-1], after[-1], middle + 1]))
        ends = [[along[0], 0, 0], [along[-1], 0, 0]]
        points = np.concatenate([points, ends])
    return points, np.concatenate(parts)


def polygon(corners: int, pieces: int) -> Floats:
    """Return points (n, 2) on a regular polygon of radius one half, whose sides are in pieces."""
    angle = 2 * np.pi * (np.arange(corners + 1) + 0.5) / corners
    corner = 0.5 * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    share = np.arange(pieces)[:, None] / pieces
    sides = corner[:-1, None] * (1 - share) + corner[1:, None] * share
    return np.asarray(sides.reshape(-1, 2))


def soup(rng: np.random.Generator, mesh: Mesh) -> Mesh:
    """Return triangles that share no nodes and face either way, as STL files have them."""
    points, triangles = mesh
    turned = rng.random(len(triangles)) < 0.5
    mixed = np.where(turned[:, None], triangles[:, ::-1], triangles)
    return points[mixed].reshape(-1, 3), np.arange(mixed.size).reshape(-1, 3)


def surface_of(field: FlowField) -> TriangleSurface:
    """Return the surface of a field of triangles."""
    assert isinstance(field.surface, TriangleSurface)
    return field.surface
