"""What arrays a PyVista mesh carries: which may be the velocity, which hide nodes and cells.

Meshes say that a part does not count in several ways: VTK's ghost arrays on points and on
cells, PLOT3D's ``IBlank``, and the mask of points that a sampling filter missed.
"""

from __future__ import annotations

import difflib
import re
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "MeshArray",
    "candidates",
    "catalogue",
    "choose_vectors",
    "hidden_nodes",
    "values_of",
    "vector_faults",
    "visible_cells",
]

Bools = NDArray[np.bool_]

#: Arrays that say what is hidden and nothing about the flow.
_BLANKING = {"vtkGhostType", "IBlank", "vtkValidPointMask"}
#: Flags of VTK's ghost arrays that hide: a hidden point; a refined or a hidden cell. Points and
#: cells that are duplicates of a neighbouring piece carry data and are kept.
_HIDDEN_POINT, _HIDDEN_CELL = 2, 8 | 32

_NO_VELOCITY = re.compile(
    r".*normals?|.*texture.?coord.*|t_?coords?|coord(inate)?s?|points?|positions?", re.IGNORECASE
)


@dataclass(frozen=True)
class MeshArray:
    """An array of a mesh: its name, where its values are, and how many there are at each."""

    name: str
    where: Literal["points", "cells"]
    components: int
    numeric: bool
    real: bool

    def __str__(self) -> str:
        return f"{self.name} ({self.where}, {self.components})"


def catalogue(mesh: Any) -> list[MeshArray]:
    """List the arrays on the points and cells of a mesh, without those that only hide."""
    found = []
    for where, data in (("points", mesh.point_data), ("cells", mesh.cell_data)):
        for name in data:
            if name in _BLANKING:
                continue
            array = np.asarray(data[name])
            found.append(
                MeshArray(
                    name=name,
                    where="points" if where == "points" else "cells",
                    components=int(np.prod(array.shape[1:], dtype=int)),
                    numeric=array.dtype.kind in "fiub",
                    real=array.dtype.kind == "f",
                )
            )
    return found


def values_of(mesh: Any, array: MeshArray) -> NDArray[Any]:
    """Return the values of an array, (N,) or (N, C)."""
    data = mesh.point_data if array.where == "points" else mesh.cell_data
    return np.asarray(data[array.name])


def candidates(mesh: Any) -> list[MeshArray]:
    """Arrays that may be the velocity: real, two or three components, no normals or positions."""
    named = set()
    for data in (mesh.GetPointData(), mesh.GetCellData()):
        named |= {a.GetName() for a in (data.GetNormals(), data.GetTCoords()) if a is not None}
    return [
        array
        for array in catalogue(mesh)
        if array.real
        and array.components in (2, 3)
        and array.name not in named
        and not _NO_VELOCITY.fullmatch(array.name)
    ]


def vector_faults(mesh: Any, vectors: Any) -> list[str]:
    """Faults in a choice of vectors; ``None`` stands for the only ones there are."""
    arrays = catalogue(mesh)
    listed = ", ".join(map(str, arrays)) or "none"
    if vectors is None:
        return _search_faults(mesh, listed)
    wanted = [a for a in arrays if a.name == vectors]
    if not wanted:
        close = difflib.get_close_matches(str(vectors), [a.name for a in arrays], n=1)
        hint = f'. Did you mean "{close[0]}"?' if close else "."
        return [
            f"vectors is {vectors!r}, and the mesh has no such array{hint} Its arrays, with their "
            f"components: {listed}"
        ]
    if not any(a.numeric and a.components in (2, 3) for a in wanted):
        return [
            f"vectors is {vectors!r}, an array of {wanted[0].components} component(s); expected 2 "
            f"or 3 numbers at each point or cell. The arrays of the mesh, with their components: "
            f"{listed}"
        ]
    return []


def choose_vectors(mesh: Any, vectors: str | None) -> MeshArray:
    """Return the vectors that are meant; :func:`vector_faults` has found none before."""
    if vectors is None:
        return _found(mesh)[0]
    fits = [a for a in catalogue(mesh) if a.name == vectors and a.components in (2, 3)]
    return next(a for a in fits if a.numeric)


def _found(mesh: Any) -> list[MeshArray]:
    """Candidates, or the single one that the mesh itself marks as its vectors."""
    found = candidates(mesh)
    active = mesh.active_vectors_name
    # VTK's PLOT3D reader marks the momentum by itself: that is no one's choice.
    if active == "Momentum" and any(a.name == "Velocity" for a in found):
        active = None
    return [a for a in found if a.name == active][:1] or found


def _search_faults(mesh: Any, listed: str) -> list[str]:
    found = _found(mesh)
    if not found:
        return [
            "the mesh has no vectors that could be the velocity; expected a point or cell array "
            f"of real numbers with 2 or 3 components. Its arrays, with their components: {listed}. "
            'Join single components with mesh["velocity"] = numpy.column_stack((u, v, w))'
        ]
    if len(found) > 1:
        return [
            f"the mesh has {len(found)} arrays that could be the velocity: "
            f'{", ".join(map(str, found))}; choose one, as in vectors="{found[-1].name}"'
        ]
    return []


def hidden_nodes(mesh: Any) -> Bools | None:
    """Nodes that a mesh hides, (N,), or ``None`` when it says nothing about them."""
    data = mesh.point_data
    hidden = []
    if "vtkGhostType" in data:
        hidden.append((np.asarray(data["vtkGhostType"]) & _HIDDEN_POINT) != 0)
    if "IBlank" in data:
        # Negative values and those above one are walls and overlaps of grids, with data.
        hidden.append(np.asarray(data["IBlank"]) == 0)
    if "vtkValidPointMask" in data:
        hidden.append(np.asarray(data["vtkValidPointMask"]) == 0)
    return np.logical_or.reduce(hidden) if hidden else None


def visible_cells(mesh: Any) -> Bools | None:
    """Cells that a mesh shows, (N,), or ``None`` when it says nothing about them."""
    if "vtkGhostType" not in mesh.cell_data:
        return None
    return np.asarray((np.asarray(mesh.cell_data["vtkGhostType"]) & _HIDDEN_CELL) == 0)
