"""The common part of both kinds of surfaces: nodes, cells, and vectors in index space.

A position on a surface is two numbers, (i, j) in index space; what they mean is up to the surface.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from flowtex._util.array_types import Bools, Floats
from flowtex._util.arrays import bounds, dot, norm, row_blocks, rows_where
from flowtex.field.grids.poles import Pole, Poles
from flowtex.field.steps import Steps

#: Below this ratio of squared area to squared lengths a cell counts as collapsed.
COLLAPSED_AREA = 1e-10
#: Height over a plane, as a share of the extent, up to which a surface is flat.
FLAT = 1e-6
#: Height of some nodes over their own plane from which on the surface is not flat.
NEARLY_FLAT = 1e-3
#: Most of these nodes.
PLANE_SAMPLE = 10_000


class NodeSurface:
    """Nodes in space with data, in the mesh's own units: the base of both kinds of surfaces."""

    points: Floats  #: Positions of the nodes, (J, I, 3); a surface of triangles has one row.
    valid: Bools  #: Nodes that carry data, (J, I).
    has_position: Bools  #: Nodes with a known position, (J, I).
    periodic: tuple[bool, bool]  #: Whether the (j, i) axis closes on itself.
    offset: Floats  #: Displacement by one period of index j, or i, (2, 3).
    on_globe: bool  #: Whether it lies on a globe around the origin, with north at +z.
    cell_corners: Sequence[Any]  #: Index of each corner of the cells in arrays over the nodes.

    @property
    def poles(self) -> Poles | None:
        """The lines that have collapsed to a point with the surface closed around it, if any."""
        return None

    @property
    def shape(self) -> tuple[int, int]:
        """Number of nodes (J, I)."""
        return self.valid.shape[0], self.valid.shape[1]

    @cached_property
    def cells(self) -> Bools:
        """Cells whose nodes are all valid: (J - 1, I - 1), or triangles (M,)."""
        return self._at_all_corners(self.valid)

    @property
    def placed_cells(self) -> Bools:
        """Cells whose nodes have known positions, in the shape of :attr:`cells`."""
        return self._at_all_corners(self.has_position)

    def _at_all_corners(self, nodes: Bools) -> Bools:
        """Return the cells at whose corners all of some nodes (J, I) are."""
        first, *others = self.cell_corners
        cells = np.array(nodes[first])
        for corner in others:
            cells &= nodes[corner]
        return cells

    @cached_property
    def sharp(self) -> Bools:
        """Nodes at tips, (J, I), whose velocity has another direction in each triangle."""
        return np.zeros(self.valid.shape, dtype=bool)

    @cached_property
    def at_edge(self) -> Bools:
        """Nodes of sharp edges, (J, I), beside other nodes at the same place for other faces."""
        return np.zeros(self.valid.shape, dtype=bool)

    @cached_property
    def closes(self) -> tuple[bool, bool]:
        """Whether the (j, i) axis goes around in space, and is not repeated a period farther."""
        j, i = np.linalg.norm(self.offset, axis=-1) <= 1e-6 * self.extent
        return self.periodic[0] and bool(j), self.periodic[1] and bool(i)

    @cached_property
    def center(self) -> Floats:
        """Middle of the bounding box of the valid nodes, (3,)."""
        return np.asarray(self._bounds.mean(axis=0))

    @cached_property
    def extent(self) -> float:
        """Diagonal of the bounding box of the valid nodes."""
        return float(np.linalg.norm(self._bounds[1] - self._bounds[0]))

    @property
    def _nodes(self) -> Floats:
        """Positions of the valid nodes, (N, 3)."""
        return rows_where(self.points, self.valid)

    @cached_property
    def _bounds(self) -> Floats:
        # Rows of a grid are faster to compare than single nodes.
        if self.valid.all():
            return bounds(self.points)
        return bounds(self._nodes)

    @cached_property
    def frame(self) -> Floats | None:
        """Two orthonormal rows that span the surface where it is flat, (2, 3), else ``None``."""
        low, high = self._bounds
        level = np.flatnonzero(low == high)
        if len(level):
            return np.delete(np.eye(3), level[0], axis=0)
        nodes = self._nodes
        some = nodes[:: -(-len(nodes) // PLANE_SAMPLE)]
        basis, height = _principal_axes(some - self.center)
        if height > NEARLY_FLAT * self.extent:
            return None
        basis, height = _principal_axes(nodes - self.center)
        if height > FLAT * self.extent:
            return None
        normal = basis[2]
        if np.abs(normal).max() > 1 - 1e-12:
            # A plane of constant x, y or z keeps the axes of the mesh: pictures stay comparable.
            return np.delete(np.eye(3), int(np.argmax(np.abs(normal))), axis=0)
        return np.asarray(basis[:2])

    @cached_property
    def plane_size(self) -> Floats:
        """Width and height along the frame of a flat surface, (2,)."""
        assert self.frame is not None
        nodes = self._nodes
        # Column by column, which needs no memory for the differences to the middle.
        return np.array([np.ptp(nodes @ axis) for axis in self.frame])


def _principal_axes(offsets: Floats) -> tuple[Floats, float]:
    """Return the axes of offsets (N, 3), the shortest last, and the greatest height along that."""
    offsets = offsets - offsets.mean(axis=0)  # the middle of the box need not lie in the plane
    _, _, basis = np.linalg.svd(offsets.T @ offsets)
    return basis, float(np.abs(offsets @ basis[2]).max())


@dataclass(frozen=True)
class IndexVelocity:
    """A velocity field in index space."""

    components: Steps  #: (u_i, u_j) in cells per unit of time, (T, J, I, 2).
    #: Length of the velocity along the surface in the mesh's units per unit of time, (T, J, I).
    speed: Steps
    #: Root mean square of the part out of the surface, as a share of the whole, 0 to 1.
    normal_share: float


def to_index_space(
    tangents: Floats, valid: Bools, poles: Poles | None, velocity: Floats
) -> IndexVelocity:
    """Express a velocity (T, J, I, 3), by tangents (2, J, I, 3) along i and j, in index space.

    A velocity v is projected onto the tangents P_i and P_j by solving the 2 x 2 metric system

        | P_i.P_i  P_i.P_j | | u_i |   | v.P_i |
        | P_i.P_j  P_j.P_j | | u_j | = | v.P_j |

    (Forssell and Cohen 1995, section 3); the part that is normal to the surface is left out. At a
    pole all nodes have one velocity, their mean, of which each keeps the component along its line;
    :meth:`flowtex.field.grids.poles.Pole.vector` restores the whole.
    """
    p_i, p_j = tangents
    square = np.einsum("djic,djic->ji", tangents, tangents)
    known = square
    if not valid.all():
        known = square[valid]
    tiny = COLLAPSED_AREA * float(np.median(known))
    u = np.empty((*velocity.shape[:-1], 2))
    speed = np.empty(velocity.shape[:-1])
    squares = np.zeros(2)
    for rows in row_blocks(*valid.shape):
        squares += _project(
            velocity[:, rows], p_i[rows], p_j[rows], valid[rows], tiny, u[:, rows], speed[:, rows]
        )
    for pole in poles or ():
        _at_pole(pole, velocity, u, speed)
    total, normal = squares
    normal_share = 0.0
    if total > 0:
        normal_share = float(np.sqrt(min(normal / total, 1.0)))
    return IndexVelocity(components=u, speed=speed, normal_share=normal_share)


def _project(
    velocity: Floats, p_i: Floats, p_j: Floats, valid: Bools, tiny: float, u: Floats, speed: Floats
) -> tuple[float, float]:
    """Write the components of a velocity (T, J, I, 3) along both tangents, and their speed.

    They go into ``u``, (T, J, I, 2) in cells per unit of time, and ``speed``, (T, J, I), of the
    part of the velocity that is tangential. Tangents, (J, I, 3), are derivatives of the position by
    cell; ``tiny`` is the square of the length of a collapsed one. Returns the sums of the squares
    of the velocity, and of its part normal to the surface, where cells have an area.
    """
    g_ii = dot(p_i, p_i)
    g_jj = dot(p_j, p_j)
    g_ij = dot(p_i, p_j)
    determinant = g_ii * g_jj - g_ij**2
    along_i = dot(velocity, p_i)
    along_j = dot(velocity, p_j)
    is_parallel = determinant <= COLLAPSED_AREA * g_ii * g_jj
    collapsed = is_parallel | (g_ii <= tiny) | (g_jj <= tiny)
    safe = np.where(collapsed, 1.0, determinant)
    # Two tangents along one line share the velocity.
    share = np.where((g_ii > tiny) & (g_jj > tiny), 0.5, 1.0)
    alone_i = share * _along_one(along_i, g_ii, tiny)
    alone_j = share * _along_one(along_j, g_jj, tiny)
    u_i = np.where(collapsed, alone_i, (g_jj * along_i - g_ij * along_j) / safe)
    u_j = np.where(collapsed, alone_j, (g_ii * along_j - g_ij * along_i) / safe)
    u[..., 0] = u_i
    u[..., 1] = u_j
    tangential = u_i[..., None] * p_i + u_j[..., None] * p_j
    speed[:] = norm(tangential)
    normal = np.subtract(velocity, tangential, out=tangential)
    counted = ~collapsed & valid
    total_square = float((dot(velocity, velocity) * counted).sum())
    normal_square = float((dot(normal, normal) * counted).sum())
    return total_square, normal_square


def _at_pole(pole: Pole, velocity: Floats, u: Floats, speed: Floats) -> None:
    """Write the velocity of a pole to its nodes."""
    v = pole.lines(velocity, 1)
    u = pole.lines(u, 1)
    speed = pole.lines(speed, 1)
    mean = v[:, pole.line, :-1].mean(axis=1) @ pole.plane.T
    u[:, pole.line, :, 1 - pole.component] = 0.0
    u[:, pole.line, :, pole.component] = pole.along(mean @ pole.plane)
    speed[:, pole.line] = np.linalg.norm(mean, axis=-1)[:, None]


def _along_one(along: Floats, square: Floats, tiny: float) -> Floats:
    """Return the component along one tangent where the two span no area; 0 if it has collapsed."""
    solid = square > tiny
    return np.asarray(np.where(solid, along / np.where(solid, square, 1.0), 0.0))
