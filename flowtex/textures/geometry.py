"""The surface as a renderer draws it, and how its nodes lie in the textures.

Positions are single precision, relative to the middle of the surface, and a flat surface is laid
into its own plane, so that noise needs two dimensions there and three elsewhere.

A node i lies at the middle of texel i + pad. Textures are padded to a multiple of their coarsest
mip level's block, so every level averages whole blocks and stays in place; a periodic axis is
continued by its own period on both sides, so that no level sees the seam.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from flowtex._util.array_types import Floats, Floats32, Indices
from flowtex.field import FlowField
from flowtex.field.interpolation import nearest_known

__all__ = ["SurfaceGeometry"]


#: Mip levels of a texture beside its finest one, at most.
DEEPEST = 5


@dataclass(frozen=True)
class Padding:
    """Where the nodes of one axis lie in a texture."""

    nodes: int
    before: int
    size: int
    periodic: bool

    @classmethod
    def of(cls, nodes: int, levels: int, *, periodic: bool) -> Padding:
        """Pad to a multiple of the block of the coarsest level."""
        block = 2**levels
        before = block if periodic else 0
        needed = nodes + 2 * before
        return cls(nodes, before, -(-needed // block) * block, periodic)

    @property
    def picks(self) -> Indices:
        """Node that each texel holds, (size,)."""
        at = np.arange(self.size) - self.before
        if self.periodic:
            return np.mod(at, self.nodes - 1)
        return np.clip(at, 0, self.nodes - 1)

    @property
    def coordinates(self) -> Floats:
        """Texture coordinate of each node, (nodes,): the middle of its texel."""
        return (np.arange(self.nodes) + self.before + 0.5) / self.size


@dataclass(frozen=True, eq=False)
class SurfaceGeometry:
    """A surface ready to be drawn, with ``levels`` mip levels in its textures beside the finest.

    ``rows`` and ``columns`` say how the j and i axes lie in the slice textures.
    """

    field: FlowField
    levels: int
    rows: Padding
    columns: Padding

    @classmethod
    def of(cls, field: FlowField) -> SurfaceGeometry:
        """Lay out a field's surface."""
        shortest = min(field.shape)
        levels = int(np.clip(np.log2(max(shortest / 4, 1)), 0, DEEPEST))
        rows, columns = (
            Padding.of(n, levels, periodic=p)
            for n, p in zip(field.shape, field.periodic, strict=True)
        )
        return cls(field, levels, rows, columns)

    @property
    def planar(self) -> bool:
        """Whether the surface is flat."""
        return self.field.surface.frame is not None

    @property
    def center(self) -> Floats:
        """What was taken from the mesh's coordinates, (3,)."""
        return self.field.surface.center

    @property
    def extent(self) -> float:
        """Diagonal of the bounding box."""
        return self.field.surface.extent

    @cached_property
    def frame(self) -> Floats:
        """Rows that take a vector of the mesh to the frame of ``position``, (3, 3)."""
        flat = self.field.surface.frame
        return np.eye(3) if flat is None else np.vstack([flat, np.cross(flat[0], flat[1])])

    @cached_property
    def position(self) -> Floats32:
        """Nodes in the surface's own frame, (J, I, 3)."""
        return self.position_from(np.zeros(3))

    def position_from(self, anchor: Floats) -> Floats32:
        """Nodes in the surface's own frame relative to a point of it (3,), (J, I, 3).

        Close to the anchor single precision tells points apart that it would not from the middle.
        """
        local = (self.field.surface.points - self.center) @ self.frame.T
        return np.asarray(local - anchor, dtype=np.float32)

    def local(self, point: Floats) -> Floats:
        """Take a point from the mesh's own coordinates to the surface's frame, (3,)."""
        return np.asarray(self.frame @ (point - self.center))

    @cached_property
    def normal(self) -> Floats32:
        """Unit normals at the nodes, (J, I, 3), in the mesh's own axes.

        A node whose cells have collapsed takes that of the line beside it.
        """
        normal = np.cross(*self.field.surface.tangents)
        length = np.linalg.norm(normal, axis=-1, keepdims=True)
        small = length[..., 0] <= 1e-9 * max(float(np.median(length)), 1e-300)
        if small.any() and not small.all():
            for row, beside in ((0, 1), (-1, -2)):
                if small[row].any():
                    normal[row][small[row]] = normal[beside][small[row]].mean(axis=0)
            for column, beside in ((0, 1), (-1, -2)):
                bad = small[:, column]
                normal[bad, column] = normal[bad, beside]
            length = np.linalg.norm(normal, axis=-1, keepdims=True)
        safe = np.where(length > 0, length, 1.0)
        return np.where(length > 0, normal / safe, [0.0, 0.0, 1.0]).astype(np.float32)

    @cached_property
    def coordinate(self) -> Floats32:
        """Texture coordinates of the nodes in the slices, (J, I, 2) as (u, v)."""
        u, v = np.meshgrid(self.columns.coordinates, self.rows.coordinates)
        return np.stack([u, v], axis=-1).astype(np.float32)

    def write_texels(self, data: Floats32, texels: Floats32) -> None:
        """Write nodal data (J, I, C) into texels (H, W, C), in the order of its rows and columns.

        Blanked nodes of ``data`` are filled in place.
        """
        if not self.field.valid.all():
            blank = ~self.field.valid
            data[blank] = data[tuple(at[blank] for at in self._nearest)]
        rows, columns = self.rows, self.columns
        top, left = rows.before + rows.nodes, columns.before + columns.nodes
        inner = texels[rows.before : top]
        inner[:, columns.before : left] = data
        inner[:, : columns.before] = data[:, columns.picks[: columns.before]]
        inner[:, left:] = data[:, columns.picks[left:]]
        if columns.periodic:
            # The closing line is traced apart from the first; every repeat must be the same.
            inner[:, left - 1] = inner[:, columns.before]
        if rows.periodic:
            inner[-1] = inner[0]
        # Beyond the nodes whole rows are repeated.
        texels[: rows.before] = inner[rows.picks[: rows.before]]
        texels[top:] = inner[rows.picks[top:]]

    @cached_property
    def _nearest(self) -> tuple[Any, ...]:
        return nearest_known(self.field.valid)
