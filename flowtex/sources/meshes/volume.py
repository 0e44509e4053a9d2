"""One plane of nodes of a structured mesh, as (j, i), and ranges of values of the whole volume.

A structured mesh of I x J x K nodes has node (i, j, k) at place i + I (j + J k). With one index
fixed, the other two keep their order, and nothing is mirrored for a right-handed surface. Vectors
at the nodes are means of the visible cells around each, on both sides of the plane, so that blanked
cells have no effect.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Floats
from flowtex._util.arrays import dot, norm, row_blocks
from flowtex._util.cache import ByteCache
from flowtex.errors import FieldError
from flowtex.field.grids.grid_nodes import axes, find_closure, products
from flowtex.field.validation import MAGNITUDES
from flowtex.remedies import Remedy
from flowtex.sources.meshes import vectors
from flowtex.sources.meshes.cuts import Contour, Cut, Slice
from flowtex.sources.meshes.vectors import MeshArray, Sheet
from flowtex.sources.notices import Record

#: Values that are kept of an array, of all steps together.
MOST_VALUES = 1 << 16
#: Least number of values that are kept of one step.
LEAST_VALUES = 1 << 10
#: Distance between sampled values, as a share of their number: it fits no axis of a grid.
GOLDEN_SHARE = (5**0.5 - 1) / 2
#: Samples by the states of their arrays, which VTK numbers: a moving slice asks again and again.
_samples: ByteCache[tuple[object, ...], Floats] = ByteCache(128_000_000)
_PLANE = re.compile(r"\s*([ijk])\s*=\s*([+-]?\d+)\s*", re.IGNORECASE)


class VolumeValues:
    """Values of the arrays of a volume over a number of steps: the extremes, and a sample of many.

    Vectors have values of their magnitude and their components. ``speed`` is the one in planes such
    as the ``drawn`` one, and is left out for a contour. Of two arrays of a name, that on a "point"
    or on a "cell" is preferred.
    """

    def __init__(
        self, velocity: MeshArray, drawn: Cut | Plane | None, steps: int, preference: str
    ) -> None:
        self._velocity = velocity
        self._plane = drawn
        self._preference = preference
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
        ordered = sorted(
            vectors.catalogue(grid), key=lambda a: a.where.startswith(self._preference)
        )
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
        names = {
            *vectors.BLANKING,
            *array.parts,
            array.name,
            *self._velocity.parts,
            self._velocity.name,
        }
        held = []
        for d in data:
            for n in sorted(names):
                if d.HasArray(n):
                    held.append(d.GetAbstractArray(n))
        if isinstance(part, Plane):
            place = grid.GetMTime()
        else:
            place = None
        key = (*(a.GetMTime() for a in held), place, part, array, self._velocity, self._count)
        sample = _samples.get(key, lambda: self._sample(grid, array, part))
        self._steps.setdefault(name, []).append(sample)

    def _sample(self, grid: Any, array: MeshArray, part: Slice | Plane | int | None) -> Floats:
        """Return a sample of the finite, visible values of an array in a mesh, and their ends.

        Of vectors these are the values of a component if ``part`` is its number, and lengths
        otherwise: of the part in a plane if ``part`` is a cut, else of the whole. The result has at
        most as many values as this object keeps, and the two ends, (S,).
        """
        values = vectors.values_of(grid, array)
        most = np.float64(MAGNITUDES[1])
        if isinstance(part, int):
            values = values[:, part]
        elif values.ndim > 1:
            values = _lengths(values, None if part is None else _normals(grid, array, part))
        if array.where == "cells":
            shown = vectors.visible_cells(grid)
        else:
            shown = ~vectors.hidden_nodes(grid)
        velocity = vectors.values_of(grid, self._velocity)
        if array.where == self._velocity.where and np.isnan(velocity.min(initial=0)):
            shown &= ~np.isnan(velocity).any(axis=-1)
        if shown.all():
            known = values
        else:
            known = values[shown]
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


def _lengths(values: Floats, normals: Floats | None) -> Floats:
    """Return lengths of vectors (N, 3), or of their parts across normals, one or (N, 3)."""
    lengths = np.empty(len(values))
    for rows in row_blocks(len(values), 1):
        part = values[rows].astype(float)
        if normals is not None:
            if normals.ndim == 1:
                normal = normals
            else:
                normal = normals[rows].astype(float)
            with np.errstate(all="ignore"):  # where sides of a cell have no length
                part -= (dot(part, normal) / dot(normal, normal))[..., None] * normal
        lengths[rows] = norm(part)
    return lengths


@dataclass(frozen=True)
class Plane:
    """A plane of constant i, j or k (axis 0, 1 or 2) of a mesh of (I, J, K) nodes."""

    dimensions: tuple[int, int, int]
    axis: int
    index: int

    def nodes(self, values: AnyArray) -> AnyArray:
        """Take the plane out of nodal values, (N, ...) to (J, I, ...)."""
        shaped = values.reshape(*self.dimensions[::-1], *values.shape[1:])
        return np.asarray(np.take(shaped, self.index, axis=2 - self.axis))

    def cells(self, values: AnyArray) -> AnyArray:
        """Take the cells on both sides of the plane, (N, ...) to (1 or 2, J - 1, I - 1, ...)."""
        counts = [max(n - 1, 1) for n in self.dimensions]
        last = counts[self.axis] - 1
        sides = sorted({max(self.index - 1, 0), min(self.index, last)})
        shaped = values.reshape(*counts[::-1], *values.shape[1:])
        return np.moveaxis(np.take(shaped, sides, axis=2 - self.axis), 2 - self.axis, 0)


def find_plane(mesh: Any, plane: Any, record: Record) -> Plane:
    """Return the plane of a structured mesh that is drawn.

    Parameters
    ----------
    mesh
        The mesh.
    plane
        Text such as ``"k=20"``; ``None`` for a mesh that is a plane, or the middle along k.
    record
        Record of what was chosen automatically.

    Raises
    ------
    FieldError
        When the mesh has no surface, or no such plane.
    """
    dimensions = tuple(mesh.dimensions)
    size = " x ".join(map(str, dimensions)) + " nodes (I x J x K)"
    if min(dimensions) < 1 or sum(n > 1 for n in dimensions) < 2:
        raise FieldError(f"the mesh has {size}; a surface needs at least 2 along two of the axes")
    if plane is None and min(dimensions) == 1:
        return Plane(dimensions, dimensions.index(1), 0)
    if plane is None:
        another = Remedy("plane", f"j={dimensions[1] // 2}")
        cut = Remedy("slice", "z", "or cut anywhere, as in")
        text = f'the plane is "k={dimensions[2] // 2}", the middle of {size}, counted from 0'
        record("select", text, another, cut, notable=True)
        return Plane(dimensions, 2, dimensions[2] // 2)
    if isinstance(plane, str):
        match = _PLANE.fullmatch(plane)
    else:
        match = None
    if match:
        axis = "ijk".index(match[1].lower())
    else:
        axis = 0
    count = dimensions[axis]
    if match:
        index = int(match[2])
    else:
        index = 0
    if match is None or not -count <= index < count or (min(dimensions) == 1 and count > 1):
        text = 'expected "i=N", "j=N" or "k=N" with a whole number N'
        raise FieldError(f"plane is {plane!r}; {text} within {size}, and no plane for a surface")
    record("select", f"plane {'ijk'[axis]} = {index % count} of {size}")
    return Plane(dimensions, axis, index % count)


def plane_sheet(
    grid: Any, plane: Plane, velocity: MeshArray, periodic: str | None, *, sign_free: bool
) -> Sheet:
    """Return the nodes of a plane of a structured mesh, (J, I)."""
    points = plane_positions(grid, plane)
    shown = ~plane.nodes(vectors.hidden_nodes(grid))
    # Only values of cells are spread beyond the last line.
    known = np.where(shown[..., None], points, np.nan)
    if len(grid.cell_data):
        wrap = _wrap(known, periodic)
    else:
        wrap = (False, False)
    visible = plane.cells(vectors.visible_cells(grid))

    def nodes(array: MeshArray) -> Floats:
        values = vectors.values_of(grid, array)
        if array.where == "points":
            return plane.nodes(values).astype(np.float64)
        layers = plane.cells(values).astype(np.float64)
        seen = visible & np.isfinite(layers.reshape(*visible.shape, -1)).all(axis=-1)
        if sign_free and array == velocity:
            return axes(_spread(products(layers), seen, wrap))
        return _spread(layers, seen, wrap)

    def flat(array: MeshArray) -> Floats:
        """Return the values beyond the plane, as of PyVista's ``extract_subset``, or before it."""
        layers = plane.cells(vectors.values_of(grid, array)).astype(np.float64)
        layers[~visible] = np.nan
        seen = visible[-1].reshape(*visible.shape[1:], *[1] * (layers.ndim - 3))
        return np.asarray(np.where(seen, layers[-1], layers[0]))

    cells = visible
    if velocity.where == "cells":
        cells = visible & np.isfinite(plane.cells(vectors.values_of(grid, velocity))).all(axis=-1)
    return Sheet(
        points=points,
        shown=shown,
        arrays=vectors.catalogue(grid),
        nodes=nodes,
        flat=flat,
        cells=np.asarray(cells.any(axis=0)),
        wrap=wrap,
    )


def plane_positions(grid: Any, plane: Plane) -> Floats:
    """Return positions of the nodes of a plane, (J, I, 3)."""
    import pyvista as pv

    if isinstance(grid, pv.RectilinearGrid):
        lines = [grid.x, grid.y, grid.z]
        lines[plane.axis] = lines[plane.axis][plane.index : plane.index + 1]
        part: Any = pv.RectilinearGrid(*lines)
    else:
        bare = grid.copy(deep=False)
        ends = np.reshape(grid.GetExtent(), (3, 2))
        bare.clear_data()
        ends[plane.axis] = ends[plane.axis, 0] + plane.index
        part = bare.extract_subset(ends.ravel().tolist())
    points = np.asarray(part.points, dtype=np.float64)
    return points.reshape(*np.delete(plane.dimensions, plane.axis)[::-1], 3)


def _wrap(points: Floats, periodic: str | None) -> tuple[bool, bool]:
    """Return whether the last line along (j, i) repeats the first one, so that cells go round."""
    ends = find_closure(points), find_closure(np.swapaxes(points, 0, 1))
    allowed = [periodic is None or letter in periodic for letter in "ji"]
    j, i = (closes and line is None for closes, line in ends)
    return j and allowed[0], i and allowed[1]


def _spread(values: Floats, visible: Bools, wrap: tuple[bool, bool]) -> Floats:
    """Return the mean of the visible cells around each node, (J, I, ...); NaN without such cells.

    Values are one or two layers of cells, (L, J - 1, I - 1, ...), and ``visible`` marks those that
    count, (L, J - 1, I - 1). ``wrap`` is whether the last line of nodes along (j, i) repeats the
    first one, so that the cells beyond it are known.
    """
    seen = visible.reshape(*visible.shape, *[1] * (values.ndim - 3))
    total = _around(np.where(seen, values, 0.0).sum(axis=0), wrap)
    count = _around(seen.sum(axis=0).astype(np.float64), wrap)
    return np.asarray(np.where(count > 0, total / np.maximum(count, 1.0), np.nan))


def nodes_to_keep(visible: Bools, wrap: tuple[bool, bool]) -> Bools:
    """Return nodes (J, I) that draw the visible cells (J - 1, I - 1) and none of the hidden ones.

    A cell is drawn when its four nodes are kept. Nodes between a visible and a hidden cell are
    kept, unless that would draw a hidden cell: a wall one cell thick takes its nodes with it.
    """
    keep = _around(visible.astype(np.float64), wrap) > 0
    drawn = keep[:-1, :-1] & keep[1:, :-1] & keep[:-1, 1:] & keep[1:, 1:]
    return np.asarray(keep & (_around((drawn & ~visible).astype(np.float64), wrap) == 0))


def _around(cells: Floats, wrap: tuple[bool, bool]) -> Floats:
    """Return sums of the four cells around each node, (J - 1, I - 1, ...) to (J, I, ...)."""
    for axis in (0, 1):
        width = [(1, 1) if a == axis else (0, 0) for a in range(cells.ndim)]
        padded = np.pad(cells, width, mode="wrap" if wrap[axis] else "constant")
        lines = np.swapaxes(padded, 0, axis)
        cells = np.swapaxes(lines[:-1] + lines[1:], 0, axis)
    return cells
