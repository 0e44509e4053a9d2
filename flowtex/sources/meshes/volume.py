"""Values of the arrays of a volume, which give the colours of its slices their range."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex._util.blocks import row_blocks
from flowtex._util.cache import ByteCache
from flowtex._util.vectors import dot, norm
from flowtex.field.validation import MAGNITUDES
from flowtex.sources.meshes.cuts import Contour, Cut, Slice
from flowtex.sources.meshes.planes import Plane
from flowtex.sources.meshes.vectors import (
    BLANKING,
    MeshArray,
    catalogue,
    hidden_nodes,
    values_of,
    visible_cells,
)

#: Values that are kept of an array, of all steps together, and at least of one.
MOST_VALUES, LEAST_VALUES = 1 << 16, 1 << 10
#: Distance between sampled values, as a share of their number: it fits no axis of a grid.
GOLDEN_SHARE = (5**0.5 - 1) / 2
#: Samples by the states of their arrays, which VTK numbers: a moving slice asks again and again.
_samples: ByteCache[tuple[object, ...], Floats] = ByteCache(128_000_000)


class VolumeValues:
    """Values of the arrays of a volume over a number of steps: the extremes, and a sample of many.

    Vectors have values of their magnitude and their components. ``speed`` is the one in planes such
    as the ``drawn`` one, and is left out for a contour. Of two arrays of a name, that on a "point"
    or on a "cell" is preferred.
    """

    def __init__(
        self, velocity: MeshArray, drawn: Cut | Plane | None, steps: int, preference: str
    ) -> None:
        self._velocity, self._plane, self._preference = velocity, drawn, preference
        # All planes in a direction have the same values.
        if isinstance(drawn, Slice):
            self._plane = replace(drawn, point=None, text="")
        elif isinstance(drawn, Plane):
            self._plane = replace(drawn, index=0)
        self._count = max(MOST_VALUES // max(steps, 1), LEAST_VALUES)
        self._steps: dict[str, list[Floats]] = {}

    def add(self, grid: Any) -> None:
        """Read a step, unless it is a surface."""
        if grid.max_cell_dimensionality < 3:
            return
        arrays = {self._velocity.name: self._velocity}
        ordered = sorted(catalogue(grid), key=lambda a: a.where.startswith(self._preference))
        arrays |= {a.name: a for a in ordered if a.numeric and a.components <= 3}
        wanted: dict[str, tuple[MeshArray, Any]] = {}
        if self._velocity.components == 3 and not isinstance(self._plane, Contour | None):
            wanted["speed"] = self._velocity, self._plane
        for name, array in arrays.items():
            axes = enumerate("xyz" if array.components == 3 else "")
            wanted |= {f"{name}_{letter}": (array, axis) for axis, letter in axes}
        wanted |= {name: (array, None) for name, array in arrays.items()}
        for name, (array, part) in wanted.items():
            self._keep(name, grid, array, part)

    def values(self) -> dict[str, Floats]:
        """Return the values of all steps by the names of the arrays."""
        return {name: np.concatenate(steps) for name, steps in self._steps.items()}

    def _keep(self, name: str, grid: Any, array: MeshArray, part: Any) -> None:
        data = (grid.GetPointData(), grid.GetCellData())
        names = {*BLANKING, *array.parts, array.name, *self._velocity.parts, self._velocity.name}
        held = [d.GetAbstractArray(n) for d in data for n in sorted(names) if d.HasArray(n)]
        place = grid.GetMTime() if isinstance(part, Plane) else None
        key = (*(a.GetMTime() for a in held), place, part, array, self._velocity, self._count)
        sample = _samples.get(key, lambda: self._sample(grid, array, part))
        self._steps.setdefault(name, []).append(sample)

    def _sample(self, grid: Any, array: MeshArray, part: Slice | Plane | int | None) -> Floats:
        """Return values of an array, or of a component or the part in planes of vectors."""
        values, most = values_of(grid, array), np.float64(MAGNITUDES[1])
        if isinstance(part, int):
            values = values[:, part]
        elif values.ndim > 1:
            values = _lengths(values, None if part is None else _normals(grid, array, part))
        shown = visible_cells(grid) if array.where == "cells" else ~hidden_nodes(grid)
        velocity = values_of(grid, self._velocity)
        if array.where == self._velocity.where and np.isnan(velocity.min(initial=0)):
            shown &= ~np.isnan(velocity).any(axis=-1)
        known = values if shown.all() else values[shown]
        if not (known.min(initial=0) >= -most and known.max(initial=0) <= most):  # or NaN
            known = known[np.abs(known) <= most]
        if len(known) <= self._count:
            return known.astype(float)
        places = (np.arange(self._count) * GOLDEN_SHARE % 1 * len(known)).astype(int)
        return np.append(known[places], [known.min(), known.max()]).astype(float)


def _normals(grid: Any, array: MeshArray, drawn: Slice | Plane) -> Floats:
    """Return the normal of parallel planes, (3,), or of the one at each value, (N, 3)."""
    import pyvista as pv

    if isinstance(drawn, Slice):
        return np.array(drawn.normal, dtype=float)
    if not isinstance(grid, pv.StructuredGrid):
        return np.array(getattr(grid, "direction_matrix", np.eye(3))[:, drawn.axis])
    points = np.asarray(grid.points).reshape(*drawn.dimensions[::-1], 3)
    sides = np.gradient(points, axis=[axis for axis in range(3) if axis != 2 - drawn.axis])
    normals = np.cross(*sides)
    # Cells have the normal at their first corner.
    return (normals if array.where == "points" else normals[:-1, :-1, :-1]).reshape(-1, 3)


def _lengths(vectors: Floats, normals: Floats | None) -> Floats:
    """Return lengths of vectors (N, 3), or of their parts across normals, one or (N, 3)."""
    lengths = np.empty(len(vectors))
    for rows in row_blocks(len(vectors), 1):
        part = vectors[rows].astype(float)
        if normals is not None:
            normal = normals if normals.ndim == 1 else normals[rows].astype(float)
            with np.errstate(all="ignore"):  # where sides of a cell have no length
                part -= (dot(part, normal) / dot(normal, normal))[..., None] * normal
        lengths[rows] = norm(part)
    return lengths
