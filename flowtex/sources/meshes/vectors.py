"""The arrays of a mesh, and the choice of the velocity.

A velocity is an array of two or three components, or as many arrays of one: those that are named,
or whose names belong together (:mod:`flowtex.sources.meshes.components`).
"""

from __future__ import annotations

import difflib
import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex._util.notices import notify
from flowtex.sources.meshes.components import NO_VELOCITY, find_vectors

if TYPE_CHECKING:
    import pyvista as pv

#: Arrays that only mark hidden parts.
BLANKING = ("vtkGhostType", "IBlank", "vtkValidPointMask")
#: Names of velocities among several vectors.
VELOCITY = re.compile(
    r"((mean|avg|average)[ _.-]?)?(vel|velocity|velocities|u|flow|wind|current)([ _.-]?mean)?",
    re.IGNORECASE,
)
_PLACES: tuple[Literal["points"], Literal["cells"]] = ("points", "cells")


@dataclass(frozen=True)
class MeshArray:
    """An array of a mesh: its name, the place of its values, and its number of components."""

    name: str
    where: Literal["points", "cells"]
    components: int
    numeric: bool = True
    real: bool = True
    parts: tuple[str, ...] = ()  #: Names of its arrays of one component, if any.

    def __str__(self) -> str:
        made = f" from {', '.join(self.parts)}" if self.parts else ""
        return f"{self.name} ({self.where}, {self.components}{made})"


def catalogue(mesh: pv.DataSet) -> list[MeshArray]:
    """Return the arrays on the points and cells of a mesh, without those of :data:`BLANKING`."""
    return [
        MeshArray(name, where, math.prod(shape), numeric=kind in "fiub", real=kind == "f")
        for where in _PLACES
        for data in [_data(mesh, where)]
        for name in data
        for shape, kind in [(np.shape(data[name])[1:], np.asarray(data[name]).dtype.kind)]
        if name not in BLANKING
    ]


def _data(mesh: pv.DataSet, where: str) -> pv.DataSetAttributes:
    return mesh.point_data if where == "points" else mesh.cell_data


def values_of(mesh: pv.DataSet, array: MeshArray) -> AnyArray:
    """Return the values of an array, (N,) or (N, C)."""
    data = _data(mesh, array.where)
    if array.parts:
        return np.column_stack([np.asarray(data[name]) for name in array.parts])
    return np.asarray(data[array.name])


def candidates(mesh: pv.DataSet) -> list[MeshArray]:
    """Return possible velocities: arrays, or vectors of single components by their names."""
    named = set()
    for data in (mesh.GetPointData(), mesh.GetCellData()):
        named |= {a.GetName() for a in (data.GetNormals(), data.GetTCoords()) if a is not None}
    arrays = [
        array
        for array in catalogue(mesh)
        if array.real
        and array.components in (2, 3)
        and array.name not in named
        and not NO_VELOCITY.fullmatch(array.name)
    ]
    # Of arrays on points and cells one was computed from the other: those of points come first.
    by_name = {array.name: array for array in reversed(arrays)}
    return [array for array in arrays if by_name[array.name] is array] or _component_vectors(mesh)


def _component_vectors(mesh: pv.DataSet) -> list[MeshArray]:
    """Return vectors of single components by their names; pairs on flat meshes."""
    arrays = catalogue(mesh)
    low, high = mesh.bounds[4:]
    vectors = []
    for where in _PLACES:
        names = [a.name for a in arrays if a.where == where and a.real and a.components == 1]
        for name, parts in find_vectors(names, pairs=low == high).items():
            vectors.append(MeshArray(name, where, len(parts), parts=parts))
    return vectors


def missing_arrays(mesh: pv.DataSet, vectors: MeshArray) -> list[str]:
    """Return the arrays of another mesh's vectors that a mesh lacks."""
    needed = [f"{part} ({vectors.where}, 1)" for part in vectors.parts] or [str(vectors)]
    present = {str(array) for array in catalogue(mesh)}
    return [array for array in needed if array not in present]


def choose_vectors(mesh: pv.DataSet, vectors: str | None) -> MeshArray:
    """Return the selected vectors; :func:`vector_faults` returned none before."""
    if vectors is None:
        chosen = _preferred(mesh)[0]
        others = [array for array in candidates(mesh) if array != chosen]
        if others and mesh.active_vectors_name != chosen.name:
            listed = ", ".join(map(str, others))
            notify(
                f'the velocity is "{chosen.name}", chosen by its name; other vectors: {listed}. '
                f'Choose one of them as in vectors="{others[0].name}"'
            )
        return chosen
    return next(a for a in _named_arrays(mesh, vectors) if _is_vector(a))


def vector_faults(mesh: pv.DataSet, vectors: Any) -> list[str]:
    """Return faults in a choice of vectors; ``None`` means the only ones."""
    arrays = catalogue(mesh)
    listed = ", ".join(map(str, arrays)) or "none"
    if vectors is None:
        return _search_faults(mesh, listed)
    named = _named_arrays(mesh, vectors)
    if any(_is_vector(a) for a in named):
        return []
    if named:
        return [
            f"vectors is {vectors!r}, an array of {named[0].components} component(s); expected 2 "
            "or 3 components at each point or cell, or the names of 2 or 3 arrays of one "
            "component, separated by commas. The arrays of the mesh, with their numbers of "
            f"components: {listed}"
        ]
    words = _component_names(vectors)
    if len(words) > 1:
        return [_component_fault(vectors, words, arrays, listed)]
    return [
        f"vectors is {vectors!r}, but the mesh has no such array{_hint(vectors, arrays)} Its "
        f"arrays, with their numbers of components: {listed}"
    ]


def _named_arrays(mesh: pv.DataSet, vectors: Any) -> list[MeshArray]:
    """Return the arrays of a name, or the vectors of the components that it lists."""
    arrays = catalogue(mesh)
    if named := [a for a in arrays if a.name == vectors]:
        return named
    if found := [a for a in _component_vectors(mesh) if a.name == vectors]:
        return found
    words = _component_names(vectors)
    if len(words) not in (2, 3):
        return []
    scalars = {(a.where, a.name) for a in arrays if a.numeric and a.components == 1}
    return [
        MeshArray(",".join(words), where, len(words), parts=words)
        for where in _PLACES
        if scalars.issuperset((where, word) for word in words)
    ]


def _component_names(vectors: Any) -> tuple[str, ...]:
    """Return the names between commas."""
    return tuple(word.strip() for word in str(vectors).split(","))


def _is_vector(array: MeshArray) -> bool:
    return array.numeric and array.components in (2, 3)


def _component_fault(
    vectors: Any, words: tuple[str, ...], arrays: list[MeshArray], listed: str
) -> str:
    end = f"The arrays of the mesh, with their numbers of components: {listed}"
    missing = next((w for w in words if not any(a.name == w for a in arrays)), None)
    if missing is not None:
        hint = _hint(missing, arrays)
        return f"vectors is {vectors!r}, but the mesh has no array {missing!r}{hint} {end}"
    return (
        f"vectors is {vectors!r}; expected two or three arrays of one component each, all on "
        f"points or all on cells. {end}"
    )


def _hint(name: Any, arrays: list[MeshArray]) -> str:
    close = difflib.get_close_matches(str(name), [a.name for a in arrays], n=1)
    return f'. Did you mean "{close[0]}"?' if close else "."


def _preferred(mesh: pv.DataSet) -> list[MeshArray]:
    """Return possible velocities, or the one that the mesh marks or a name identifies."""
    arrays = candidates(mesh)
    active = mesh.active_vectors_name
    # VTK's PLOT3D reader marks the momentum automatically: that is no choice.
    if active == "Momentum" and any(a.name == "Velocity" for a in arrays):
        active = None
    marked = [a for a in arrays if a.name == active][:1]
    named = [a for a in arrays if VELOCITY.fullmatch(a.name)]
    return marked or (named if len(named) == 1 else arrays)


def _search_faults(mesh: pv.DataSet, listed: str) -> list[str]:
    arrays = _preferred(mesh)
    if not arrays:
        return [
            "the mesh has no vectors that could be the velocity; expected a point or cell array "
            "of real numbers with 2 or 3 components. Its arrays, with their numbers of "
            f"components: {listed}. To use single components, separate their names by commas, as "
            'in vectors="u,v,w"'
        ]
    if len(arrays) > 1:
        return [
            f"the mesh has {len(arrays)} arrays that could be the velocity: "
            f'{", ".join(map(str, arrays))}; choose one, as in vectors="{arrays[-1].name}"'
        ]
    return []
