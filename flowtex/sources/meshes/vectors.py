"""The arrays of a mesh, and the choice of the velocity.

A velocity is an array of two or three components, or as many arrays of one: those that are named,
or whose names belong together (:mod:`flowtex.sources.meshes.components`).
"""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex.errors import FieldError
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
#: Share of the extent of a mesh below which it is flat along an axis.
FLAT_SHARE = 1e-6
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


class Selection(NamedTuple):
    """The velocity and the reason for it, or ``None`` and the fault."""

    array: MeshArray | None
    text: str
    notable: bool = False


def catalogue(mesh: pv.DataSet) -> list[MeshArray]:
    """Return the arrays on the points and cells of a mesh, without those of :data:`BLANKING`."""
    return [
        MeshArray(name, where, math.prod(shape), numeric=kind in "fiub", real=kind == "f")
        for where in _PLACES
        for data in [data_of(mesh, where)]
        for name in data
        for shape, kind in [(np.shape(data[name])[1:], np.asarray(data[name]).dtype.kind)]
        if name not in BLANKING
    ]


def data_of(mesh: pv.DataSet, where: str) -> pv.DataSetAttributes:
    """Return the arrays on points or cells."""
    return mesh.point_data if where == "points" else mesh.cell_data


def with_array(mesh: pv.DataSet, name: str, values: AnyArray) -> pv.DataSet:
    """Return a mesh with values at its points or cells as an array."""
    mesh = mesh.copy(deep=False)
    for where, count in (("points", mesh.n_points), ("cells", mesh.n_cells)):
        if values.shape == (count,):
            data_of(mesh, where)[name] = values
            return mesh
    msg = (
        f"scalars is an array of the shape {values.shape}; expected the name of an array, "
        f"({mesh.n_points},) for the points of the mesh, or ({mesh.n_cells},) for its cells"
    )
    raise FieldError(msg)


def values_of(mesh: pv.DataSet, array: MeshArray) -> AnyArray:
    """Return the values of an array, (N,) or (N, C)."""
    data = data_of(mesh, array.where)
    if array.parts:
        return np.column_stack([np.asarray(data[name]) for name in array.parts])
    values = np.asarray(data[array.name])
    return values.reshape(-1) if array.components == 1 else values


def candidates(mesh: pv.DataSet) -> list[MeshArray]:
    """Return possible velocities: arrays, or vectors of single components by their names."""
    parts = mesh.GetPointData(), mesh.GetCellData()
    others = {a.GetName() for data in parts for a in (data.GetNormals(), data.GetTCoords()) if a}
    arrays = [
        array
        for array in catalogue(mesh)
        if array.real and array.components in (2, 3)
        if array.name not in others and not NO_VELOCITY.fullmatch(array.name)
    ]
    # Of arrays on points and cells one was computed from the other: those of points come first.
    by_name = {array.name: array for array in reversed(arrays)}
    return [array for array in arrays if by_name[array.name] is array] or _component_vectors(mesh)


def _component_vectors(mesh: pv.DataSet) -> list[MeshArray]:
    """Return vectors of single components by their names; pairs on flat meshes."""
    arrays = catalogue(mesh)
    thick = thick_axes(np.reshape(mesh.bounds, (3, 2)).T)
    pair = (thick[0], thick[1]) if len(thick) == 2 else None
    return [
        MeshArray(name, where, len(parts), parts=parts)
        for where in _PLACES
        for names in [[a.name for a in arrays if a.where == where and a.real and a.components == 1]]
        for name, parts in find_vectors(names, pair).items()
    ]


def thick_axes(points: AnyArray) -> list[int]:
    """Return the axes, 0 to 2, along which points (N, 3) extend."""
    spans = np.ptp(points, axis=0) if len(points) else np.zeros(3)
    return [axis for axis, span in enumerate(spans) if span > FLAT_SHARE * spans.max()]


def missing_arrays(mesh: pv.DataSet, vectors: MeshArray) -> list[str]:
    """Return the arrays of another mesh's vectors that a mesh lacks."""
    needed = [f"{part} ({vectors.where}, 1)" for part in vectors.parts] or [str(vectors)]
    present = {str(array) for array in catalogue(mesh)}
    return [array for array in needed if array not in present]


def select_velocity(mesh: pv.DataSet, vectors: Any) -> Selection:
    """Return the selected vectors; of ``None`` those that can be the velocity."""
    arrays = catalogue(mesh)
    known = f"with their numbers of components: {', '.join(map(str, arrays)) or 'none'}"
    if vectors is None:
        return _found(mesh, known)
    words = tuple(word.strip() for word in str(vectors).split(","))
    named = [a for a in (*arrays, *_component_vectors(mesh)) if a.name == vectors]
    if not named and len(words) in (2, 3):
        scalars = {(a.where, a.name) for a in arrays if a.numeric and a.components == 1}
        named = [
            MeshArray(",".join(words), where, len(words), parts=words)
            for where in _PLACES
            if scalars.issuperset((where, word) for word in words)
        ]
    for array in named:
        if array.numeric and array.components in (2, 3):
            return Selection(array, f'the velocity is "{array.name}", as selected')
    names = [array.name for array in arrays]
    if named:
        reason = (
            f", an array of {named[0].components} component(s); expected 2 or 3 components at each "
            "point or cell, or the names of 2 or 3 arrays of one component, separated by commas. "
            "The arrays of the mesh,"
        )
    elif len(words) == 1:
        reason = f", but the mesh has no such array{near_name(vectors, names) or '.'} Its arrays,"
    elif absent := [word for word in words if word not in names]:
        hint = near_name(absent[0], names) or "."
        reason = f", but the mesh has no array {absent[0]!r}{hint} The arrays of the mesh,"
    else:
        reason = (
            "; expected two or three arrays of one component each, all on points or all on cells. "
            "The arrays of the mesh,"
        )
    return Selection(None, f"vectors is {vectors!r}{reason} {known}")


def near_name(name: Any, names: Iterable[str]) -> str:
    """Return a question for the name that was meant; empty if no name is similar."""
    close = difflib.get_close_matches(str(name), list(names), n=1)
    return f'. Did you mean "{close[0]}"?' if close else ""


def _found(mesh: pv.DataSet, known: str) -> Selection:
    """Return the only velocity, or the one that the mesh marks or a name identifies."""
    arrays = candidates(mesh)
    active = mesh.active_vectors_name
    # VTK's PLOT3D reader marks the momentum automatically: that is no choice.
    if active == "Momentum" and any(a.name == "Velocity" for a in arrays):
        active = None
    marked = [a for a in arrays if a.name == active][:1]
    named = [a for a in arrays if VELOCITY.fullmatch(a.name)]
    preferred = marked or (named if len(named) == 1 else arrays)
    if not preferred:
        text = (
            "the mesh has no vectors that could be the velocity; expected a point or cell array "
            f"of real numbers with 2 or 3 components. Its arrays, {known}. To use single "
            'components, separate their names by commas, as in vectors="u,v,w"'
        )
        return Selection(None, text)
    array, *others = preferred
    listed = ", ".join(map(str, preferred))
    if others:
        text = f"the mesh has {len(preferred)} arrays that could be the velocity: {listed}"
        return Selection(None, f'{text}; choose one, as in vectors="{preferred[-1].name}"')
    others = [other for other in arrays if other != array]
    text = f'the velocity is "{array.name}"'
    if not others:
        kind = f"{array.where.removesuffix('s')} array with {array.components} components"
        return Selection(array, f"{text}, the only {kind}")
    if mesh.active_vectors_name == array.name:
        return Selection(array, f"{text}, the active vectors of the mesh")
    listed = ", ".join(map(str, others))
    text += f', chosen by its name; other vectors: {listed}. Choose one of them as in vectors="'
    return Selection(array, f'{text}{others[0].name}"', notable=True)
