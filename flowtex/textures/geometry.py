"""The surface as a renderer draws it, and how its nodes lie in the textures.

Positions are single precision, relative to the middle of the surface; a flat one is laid into its
own plane. A node i lies at the middle of texel i + pad. Textures are padded to a multiple of their
coarsest mip level's block, so every level averages whole blocks and stays in place; a periodic axis
is continued by its own period on both sides, so that no level sees the seam.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from numpy.typing import NDArray

from flowtex._util.array_types import AnyArray, Bools, Floats, Floats32, Indices
from flowtex._util.arrays import norm
from flowtex.field import FlowField
from flowtex.field.grids.grid_surface import CubicMap, GridSurface, faces_of
from flowtex.field.interpolation import nearest_known
from flowtex.field.triangles.triangle_surface import Surface

BLOCK = 16384  #: Nodes looked up together, so few that they stay in a processor's cache.
LINEAR = 1e-6  #: Tangents that differ by less than this share of the longest make a map linear.
ROUNDING = 1e-3  #: Share of a cell by which a displacement may pass a node, by rounding.
STEPS = 64  #: Places on the way of a displacement where the surface is looked for.
FARTHER = 3.0  #: How many times as far as on a straight surface a displacement leads at most.


class NodeDisplacements:
    """Map from displacements in index space to displacements in a frame (C, 3), for some nodes."""

    def __init__(
        self,
        surface: GridSurface,
        frame: Floats,
        nodes: tuple[slice, slice] = (slice(None), slice(None)),
    ) -> None:
        # Relative to the middle and to the nodes, single precision is sufficient.
        self._map = CubicMap(surface, frame, surface.center, np.float32)
        rows = np.arange(surface.shape[0])[nodes[0]]
        columns = np.arange(surface.shape[1])[nodes[1]]
        self._shape = len(rows), len(columns)
        self._j = np.repeat(rows, len(columns))
        self._i = np.tile(columns, len(rows))
        self._points = self._map.nodes[:, self._j * surface.shape[1] + self._i]
        known = surface.has_position
        tangents = self._map.tangents[..., known.ravel()]
        self._first = tangents[..., :1]
        spread = np.abs(tangents - self._first).max(initial=0.0)
        self._linear = bool(spread <= LINEAR * np.abs(self._first).max())

        self._cells = known[1:, 1:] & known[1:, :-1] & known[:-1, 1:] & known[:-1, :-1]
        #: Twice the nodes without a position before each, in its row and in its column; one more
        #: at such a node.
        self._unknown: list[Indices] = []
        if not known.all():
            for axis in (1, 0):
                self._unknown.append(2 * np.cumsum(~known, axis) - ~known)

    def __call__(self, displacement: NDArray[np.floating], error: float = 0.0) -> Floats32:
        """Return displacements (C, J, I) of those (J, I, 2) in cells, up to an error."""
        rows, columns = self._shape
        along_i = displacement[..., 0].astype(np.float32).ravel()
        along_j = displacement[..., 1].astype(np.float32).ravel()
        if self._linear:
            p, q = np.moveaxis(self._first, 1, 0)
            return np.asarray(p * along_i + q * along_j).reshape(-1, rows, columns)
        result = np.empty_like(self._points)
        for first in range(0, rows * columns, BLOCK):
            block = slice(first, first + BLOCK)
            start = self._i[block], self._j[block]
            result[:, block] = self._map.at(along_i[block], along_j[block], start, error)
        result -= self._points
        if self._unknown:
            apart = self._parted(along_i, along_j)
            straight, inside = self._straight(apart, along_i[apart], along_j[apart])
            # A bent path may lead around such nodes, but not as far away as the next part.
            bent = norm(result[:, apart].T.astype(float))
            near = norm(straight.T.astype(float))
            inside &= bent <= FARTHER * near
            result[:, apart] = np.where(inside, result[:, apart], straight)
        return result.reshape(-1, rows, columns)

    def _parted(self, along_i: Floats32, along_j: Floats32) -> Indices:
        """Return numbers of the nodes between which and their displaced places some are unknown."""
        j = self._j
        i = self._i
        (by_row, by_column) = self._unknown
        rows, columns = by_row.shape
        to_j = _displaced(j, along_j, rows)
        to_i = _displaced(i, along_i, columns)
        apart = (by_row[j, i] != by_row[j, to_i]) | (by_column[j, i] != by_column[to_j, i])
        apart |= by_row[to_j, i] != by_row[to_j, to_i]
        apart |= by_column[j, to_i] != by_column[to_j, to_i]
        return np.flatnonzero(apart)

    def _straight(
        self, nodes: Indices, along_i: Floats32, along_j: Floats32
    ) -> tuple[Floats32, Bools]:
        """Return displacements (C, N), straight beyond known cells, and whether they end in one."""
        start = np.stack([self._j, self._i])[:, nodes]
        along = np.stack([along_j, along_i])
        most = np.array(self._cells.shape)[:, None] - 1
        share = np.zeros(len(nodes), np.float32)
        is_known = np.ones(len(nodes), dtype=bool)
        for part in np.linspace(0, 1, STEPS + 1, dtype=np.float32)[1:]:
            place = start + part * along
            inside = np.zeros(len(nodes), dtype=bool)
            for beside in product((-ROUNDING, ROUNDING), repeat=2):  # on a line between cells
                cell = np.clip(np.floor(place + np.array(beside)[:, None]), 0, most).astype(np.intp)
                inside |= self._cells[tuple(cell)]
            is_known &= inside
            share[is_known] = part
        j, i = np.clip(np.rint(start + share * along), 0, most + 1).astype(np.intp)
        p, q = np.moveaxis(self._map.tangents[..., j * (most[1, 0] + 2) + i], 1, 0)
        first = self._map.at(share * along_i, share * along_j, (start[1], start[0]))
        first -= self._points[:, nodes]
        return first + (1 - share) * (p * along_i + q * along_j), inside


DEEPEST = 5  #: Most mip levels of a texture besides its finest one.
TILE_LEVELS = 3  #: Mip levels of a tile besides its finest one.


@dataclass(frozen=True)
class Padding:
    """Where ``nodes`` of the ``total`` on one axis, from the ``first``, lie in a texture."""

    nodes: int
    before: int
    size: int
    periodic: bool
    first: int = 0
    total: int = 0

    @classmethod
    def of(cls, total: int, levels: int, *, periodic: bool, drawn: slice | None = None) -> Padding:
        """Pad to a multiple of the block of the coarsest level.

        The padding of ``drawn`` nodes are the nodes beside them, as along a periodic axis.
        """
        first, end, _ = (drawn or slice(None)).indices(total)
        block = 2**levels
        if periodic or drawn is not None:
            before = block
        else:
            before = 0
        needed = end - first + 2 * before
        return cls(end - first, before, -(-needed // block) * block, periodic, first, total)

    @property
    def picks(self) -> Indices:
        """Node that each texel holds, (size,)."""
        at = np.arange(self.size) - self.before + self.first
        if self.periodic:
            return np.mod(at, self.total - 1)
        return np.clip(at, 0, self.total - 1)

    @property
    def drawn(self) -> slice:
        """The nodes that are drawn."""
        return slice(self.first, self.first + self.nodes)

    @property
    def texels(self) -> slice:
        """The nodes that lie in the texture, once at least."""
        if self.periodic:
            return slice(0, self.total)
        first = self.first - self.before
        return slice(max(first, 0), min(first + self.size, self.total))

    @property
    def start(self) -> int:
        """Texel that holds the first of :attr:`texels`."""
        return int(self.texels.start) - self.first + self.before

    @property
    def coordinates(self) -> Floats:
        """Texture coordinate of each node, (nodes,): the middle of its texel."""
        return (np.arange(self.nodes) + self.before + 0.5) / self.size


class DrawnSurface:
    """Base of surfaces of both kinds: the frame of the ``whole`` in which they are drawn."""

    field: FlowField
    whole: Surface

    @property
    def corners(self) -> Floats32 | None:
        """Numbers of the nodes around each vertex's triangle and its own, (V, 4), for shaders."""
        return None

    @property
    def drawn(self) -> tuple[slice, slice | Indices]:
        """Index that selects the drawn nodes in arrays over the nodes of the field, (J, I).

        Raises
        ------
        NotImplementedError
            In this class; grids and triangles have the property.
        """
        raise NotImplementedError

    @property
    def points(self) -> Floats:
        """The nodes that are drawn, (J, I, 3), in the mesh's own coordinates."""
        return self.field.surface.points[self.drawn]

    def at_vertices(self, nodal: AnyArray, *, on_cells: bool = False) -> AnyArray:
        """Return values at the vertices of a mesh, (V, ...), from drawn ones, (J, I, ...).

        Parameters
        ----------
        nodal
            Values at drawn nodes, (J, I, ...), or on cells.
        on_cells
            Whether the values belong to cells.

        Raises
        ------
        NotImplementedError
            In this class; grids and triangles have the method.
        """
        raise NotImplementedError

    @property
    def faces(self) -> Indices:
        """Vertices around each cell that is drawn, (M, 3 or 4).

        Raises
        ------
        NotImplementedError
            In this class; grids and triangles have the property.
        """
        raise NotImplementedError

    @property
    def padding(self) -> tuple[int, int]:
        """Texels before the nodes, in rows and in columns."""
        return 0, 0

    @cached_property
    def outermost(self) -> Indices:
        """Vertices that touch the sides of the bounding box of the drawn cells, (6,)."""
        at = np.unique(self.faces)
        points = self.at_vertices(self.points)[at]
        return np.asarray(at[np.concatenate([points.argmin(axis=0), points.argmax(axis=0)])])

    @property
    def planar(self) -> bool:
        """Whether the surface is flat."""
        return self.whole.frame is not None

    @property
    def center(self) -> Floats:
        """Origin of the surface's frame in the mesh's coordinates, (3,)."""
        return self.whole.center

    @property
    def extent(self) -> float:
        """Diagonal of the bounding box."""
        return self.whole.extent

    @cached_property
    def frame(self) -> Floats:
        """Rows that take a vector of the mesh to the frame of ``position``, (3, 3)."""
        flat = self.whole.frame
        if flat is None:
            return np.eye(3)
        return np.vstack([flat, np.cross(flat[0], flat[1])])

    @cached_property
    def position(self) -> Floats32:
        """Nodes in the surface's own frame, (J, I, 3)."""
        return self.position_from(np.zeros(3))

    def position_from(self, anchor: Floats) -> Floats32:
        """Return nodes in the frame relative to an anchor (3,), precise near it, (J, I, 3)."""
        local = (self.points - self.center) @ self.frame.T
        return np.asarray(local - anchor, dtype=np.float32)

    def local(self, point: Floats) -> Floats:
        """Take a point from the mesh's own coordinates to the surface's frame, (3,)."""
        return np.asarray(self.frame @ (point - self.center))


@dataclass(frozen=True, eq=False)
class SurfaceGeometry(DrawnSurface):
    """A surface ready to be drawn."""

    field: FlowField
    levels: int  #: Mip levels in its textures besides the finest.
    #: How the j axis lies in the slice textures, and which nodes of the field are drawn: in a tile,
    #: those around it only continue it.
    rows: Padding
    columns: Padding  #: The same of the i axis.
    whole: Surface  #: The surface that a tile is a part of, whose middle, size and frame it has.
    #: Whether the field continues before and after its rows, and its columns.
    open_sides: tuple[tuple[bool, bool], ...] = ((False, False), (False, False))

    @classmethod
    def of(cls, field: FlowField) -> SurfaceGeometry:
        """Lay out a field's surface."""
        levels = int(np.clip(np.log2(max(min(field.shape) / 4, 1)), 0, DEEPEST))
        rows = Padding.of(field.shape[0], levels, periodic=field.periodic[0])
        columns = Padding.of(field.shape[1], levels, periodic=field.periodic[1])
        return cls(field, levels, rows, columns, field.surface)

    @classmethod
    def of_tile(
        cls,
        field: FlowField,
        drawn: tuple[slice, slice],
        whole: Surface,
        open_sides: tuple[tuple[bool, bool], ...],
    ) -> SurfaceGeometry:
        """Lay out some of a field's rows and columns, as a part of a larger surface."""
        rows = Padding.of(field.shape[0], TILE_LEVELS, periodic=False, drawn=drawn[0])
        columns = Padding.of(field.shape[1], TILE_LEVELS, periodic=False, drawn=drawn[1])
        return cls(field, TILE_LEVELS, rows, columns, whole, open_sides)

    @property
    def drawn(self) -> tuple[slice, slice]:
        """The rows and columns of the field that are drawn."""
        return self.rows.drawn, self.columns.drawn

    @property
    def texels(self) -> tuple[slice, slice]:
        """The rows and columns of the field that lie in the textures."""
        return self.rows.texels, self.columns.texels

    @property
    def shape(self) -> tuple[int, int]:
        """Number of nodes (J, I) that are drawn."""
        return self.rows.nodes, self.columns.nodes

    @property
    def size(self) -> tuple[int, int]:
        """Rows and columns (H, W) of texels."""
        return self.rows.size, self.columns.size

    @property
    def surface(self) -> GridSurface:
        """The surface of the field."""
        assert isinstance(self.field.surface, GridSurface)
        return self.field.surface

    @property
    def padding(self) -> tuple[int, int]:
        """Texels before the nodes, in rows and in columns."""
        return self.rows.before, self.columns.before

    @property
    def faces(self) -> Indices:
        """Vertices around each cell that is drawn, (M, 4)."""
        return faces_of(self.cells)

    def displacements(self, frame: Floats) -> Callable[[AnyArray, float], AnyArray]:
        """Return a function from displacements (J, I, 2) in cells and an error to (C, J, I)."""
        return NodeDisplacements(self.surface, frame, self.texels)

    @property
    def cells(self) -> Bools:
        """The cells that are drawn, (J - 1, I - 1)."""
        return self.surface.cells[self.drawn][: self.rows.nodes - 1, : self.columns.nodes - 1]

    @property
    def periodic(self) -> tuple[bool, bool]:
        """Whether the drawn surface closes on itself, along j and i."""
        return self.rows.periodic, self.columns.periodic

    @cached_property
    def normal(self) -> Floats32:
        """Unit normals at the nodes, (J, I, 3); collapsed cells have those of the line beside."""
        normal = np.cross(*self.field.surface.tangents[:, *self.drawn])
        length = norm(normal)[..., None]
        small = _is_small(length[..., 0])
        if small.any() and not small.all():
            for row, beside in ((0, 1), (-1, -2)):
                if small[row].any():
                    normal[row][small[row]] = normal[beside][small[row]].mean(axis=0)
            for column, beside in ((0, 1), (-1, -2)):
                bad = small[:, column]
                normal[bad, column] = normal[bad, beside]
            length = np.linalg.norm(normal, axis=-1, keepdims=True)
        safe = np.where(length > 0, length, 1.0)
        unit = np.where(length > 0, normal / safe, [0.0, 0.0, 1.0])
        return unit.astype(np.float32)

    @property
    def is_smooth(self) -> bool:
        """Whether every node has a position, and a normal from its neighbours or is a pole."""
        surface = self.field.surface
        small = _is_small(norm(np.cross(*surface.tangents)))
        for pole in surface.poles or ():
            pole.lines(small)[pole.line] = False
        return bool(surface.has_position.all() and not small.any())

    @cached_property
    def coordinate(self) -> Floats32:
        """Texture coordinates of the nodes in the slices, (J, I, 2) as (u, v)."""
        u, v = np.meshgrid(self.columns.coordinates, self.rows.coordinates)
        return np.stack([u, v], axis=-1).astype(np.float32)

    def drawn_values(self, values: AnyArray, *, on_cells: bool) -> AnyArray:
        """Return the values (..., J, I) of a scalar at the drawn nodes, or first nodes of cells."""
        del on_cells
        return values[..., self.rows.drawn, self.columns.drawn]

    def at_vertices(self, nodal: AnyArray, *, on_cells: bool = False) -> AnyArray:
        """Return values at the vertices of a mesh, (V, ...), from drawn ones, (J, I, ...)."""
        del on_cells
        return nodal.reshape(-1, *nodal.shape[2:])

    @property
    def vertex_normals(self) -> Floats32:
        """Unit normals at the vertices, (V, 3), in the mesh's own axes."""
        return self.normal.reshape(-1, 3)

    def as_image(self, values: AnyArray, *, on_cells: bool) -> AnyArray:
        """Return values at the vertices (V,) as an image of the nodes, (J, I)."""
        del on_cells
        return values.reshape(self.shape)

    def write_texels(self, data: Floats32, texels: AnyArray) -> None:
        """Write data (J, I, C) of nodes, blanked ones filled in place, into texels (H, W, C)."""
        if self._nearest is not None:
            blank, nearest = self._nearest
            data[blank] = data[nearest]
        rows = self.rows
        columns = self.columns
        above = rows.start
        before = columns.start
        top = above + data.shape[0]
        left = before + data.shape[1]
        inner = texels[above:top]
        inner[:, before:left] = data
        inner[:, :before] = data[:, columns.picks[:before] - columns.texels.start]
        inner[:, left:] = data[:, columns.picks[left:] - columns.texels.start]
        if columns.periodic:
            # The closing line is traced separately from the first; all repeats must be the same.
            inner[:, left - 1] = inner[:, before]
        if rows.periodic:
            inner[-1] = inner[0]
        # Beyond the nodes whole rows are repeated.
        texels[:above] = inner[rows.picks[:above] - rows.texels.start]
        texels[top:] = inner[rows.picks[top:] - rows.texels.start]

    @cached_property
    def _nearest(self) -> tuple[Bools, tuple[AnyArray, ...]] | None:
        """Blanked nodes of :attr:`texels`, and the nodes that they take their data from."""
        valid = self.field.valid[self.texels]
        if valid.all() or not valid.any():
            return None
        blank = ~valid
        return blank, tuple(at[blank] for at in nearest_known(valid))


def _is_small(lengths: Floats) -> Bools:
    return np.asarray(lengths <= 1e-9 * max(float(np.median(lengths)), 1e-300))


def _displaced(numbers: Indices, along: Floats32, count: int) -> Indices:
    """Return the last of ``count`` lines that a displacement from lines of nodes passes, (N,)."""
    away = np.trunc(along + np.copysign(1 - ROUNDING, along))
    return np.clip(numbers + away, 0, count - 1).astype(np.intp)
