"""The arrays of a mesh, the choice of the velocity, and the drawn nodes at one time.

A velocity is an array of two or three components, or as many arrays of one: those that are named,
or whose names differ only in one letter or number, such as ``X Velocity`` or ``vel_z``. Meshes hide
nodes and cells by VTK's ghost arrays on points and on cells, by PLOT3D's ``IBlank``, and by the
mask of points that a sampling filter missed. Vectors may have a fill value.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from flowtex._util.arguments import near_names
from flowtex._util.array_types import AnyArray, Bools, Floats, Indices
from flowtex._util.arrays import rows_where
from flowtex.errors import FieldError
from flowtex.field.vector_names import is_velocity
from flowtex.remedies import Remedy
from flowtex.sources.datasets.masks import DRAW_ALL, undeclared_fill
from flowtex.sources.notices import Record

if TYPE_CHECKING:
    import pyvista as pv

#: Arrays that only mark hidden parts.
BLANKING = ("vtkGhostType", "IBlank", "vtkValidPointMask")
#: Values of these where nothing is hidden.
SHOWN = {"vtkGhostType": 0, "IBlank": 1, "vtkValidPointMask": 1}
#: Names of velocities among several vectors.
VELOCITY = re.compile(
    r"((mean|avg|average)[ _.-]?)?(vel|velocity|velocities|u|flow|wind|current)([ _.-]?mean)?",
    re.IGNORECASE,
)
#: Share of the extent of a mesh below which it is flat along an axis.
FLAT_SHARE = 1e-6
_PLACES: tuple[Literal["points"], Literal["cells"]] = ("points", "cells")
#: Names of vectors other than the velocity.
NO_VELOCITY = re.compile(
    r".*normals?|.*texture.?coord.*|t_?coords?|coord(inate)?s?|points?|positions?", re.IGNORECASE
)
#: Momenta, which are not velocities; a real array of vectors is left to the user.
_MOMENTUM = re.compile(r".*momentum.*|rho.?[uv]?", re.IGNORECASE)
_VELOCITY = re.compile(r"(.*[ _.:-])?(vel|velocit(y|ies)|wind|[uv])([ _.:-].*)?", re.IGNORECASE)

#: Letters and numbers of the components.
_AXES = ("xyz", "XYZ")
_ALPHABETS = (*_AXES, "uvw", "UVW", "012", "123")
_GAP = r"[ _.:-]+"
_FORMS = tuple(
    re.compile(form)
    for form in (
        rf"(?P<token>[x-zu-wX-ZU-W]){_GAP}.+",
        r"(?P<token>[XYZ])[A-Z][a-z].*",
        rf".+?({_GAP}|[\[(])(?P<token>[X-ZU-Wx-zu-w0-3])[\])]?",
        r".*[a-z0-9](?P<token>[XYZ])",
        r"([uvUV]|[vV]el(ocity)?|VEL(OCITY)?)(?P<token>[xyzXYZ0-3])",
        r"(?P<token>[uvwUVW])",
    )
)
_UNIT = re.compile(r"\s*(\[[^\]]{2,}\]|\([^)]{2,}\))$")
_EDGES = " _.:-()[]"
#: Flag of VTK's ghost arrays for a hidden point. Points and cells that are duplicates of a
#: neighbouring piece carry data and count as visible.
_HIDDEN_POINT = 2
#: Flags for a refined and for a hidden cell.
_HIDDEN_CELL = 8 | 32


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
        if self.parts:
            made = f" from {', '.join(self.parts)}"
        else:
            made = ""
        return f"{self.name} ({self.where}, {self.components}{made})"


def catalogue(mesh: pv.DataSet) -> list[MeshArray]:
    """Return the arrays on the points and cells of a mesh, without those of :data:`BLANKING`."""
    found = []
    for where in _PLACES:
        data = data_of(mesh, where)
        for name in data:
            if name in BLANKING:
                continue
            values = np.asarray(data[name])
            components = math.prod(values.shape[1:])
            kind = values.dtype.kind
            is_number = kind in "fiub"
            array = MeshArray(name, where, components, numeric=is_number, real=kind == "f")
            found.append(array)
    return found


def data_of(mesh: pv.DataSet, where: str) -> pv.DataSetAttributes:
    """Return the arrays on points or cells."""
    if where == "points":
        return mesh.point_data
    return mesh.cell_data


def with_array(mesh: pv.DataSet, name: str, values: AnyArray) -> pv.DataSet:
    """Return a mesh with values at its points or cells as an array.

    Parameters
    ----------
    mesh
        The mesh, which does not change.
    name
        Name of the array.
    values
        One value for each point or cell, (N,).

    Raises
    ------
    FieldError
        When the number of values is neither the number of points nor of cells.
    """
    mesh = mesh.copy(deep=False)
    for where, count in (("points", mesh.n_points), ("cells", mesh.n_cells)):
        if values.shape == (count,):
            data_of(mesh, where)[name] = values
            return mesh
    raise FieldError(
        f"scalars is an array of the shape {values.shape}; expected the name of an array, "
        f"({mesh.n_points},) for the points of the mesh, or ({mesh.n_cells},) for its cells"
    )


def values_of(mesh: pv.DataSet, array: MeshArray) -> AnyArray:
    """Return the values of an array, (N,) or (N, C)."""
    data = data_of(mesh, array.where)
    if array.parts:
        return np.column_stack([np.asarray(data[name]) for name in array.parts])
    values = np.asarray(data[array.name])
    if array.components == 1:
        return values.reshape(-1)
    return values


def candidates(mesh: pv.DataSet) -> list[MeshArray]:
    """Return the arrays that may be a velocity.

    If there are none, return vectors of arrays with one component each, whose names are those of
    components, such as u, v and w.
    """
    not_velocity = _normals_and_texture_coordinates(mesh)
    found: dict[str, MeshArray] = {}
    for array in catalogue(mesh):
        if not array.real or array.components not in (2, 3):
            continue
        if array.name in not_velocity or NO_VELOCITY.fullmatch(array.name):
            continue
        # If both points and cells have an array, one was computed from the other: arrays of points
        # come first, and stay.
        found.setdefault(array.name, array)
    return list(found.values()) or _component_vectors(mesh)


def _normals_and_texture_coordinates(mesh: pv.DataSet) -> set[str]:
    """Return the names of arrays that a mesh declares as normals or texture coordinates."""
    names = set()
    for data in (mesh.GetPointData(), mesh.GetCellData()):
        for array in (data.GetNormals(), data.GetTCoords()):
            if array is not None:
                names.add(array.GetName())
    return names


def _component_vectors(mesh: pv.DataSet) -> list[MeshArray]:
    """Return vectors of arrays with one component each, by their names; pairs on flat meshes."""
    arrays = catalogue(mesh)
    thick = thick_axes(np.reshape(mesh.bounds, (3, 2)).T)
    if len(thick) == 2:
        pair = (thick[0], thick[1])
    else:
        pair = None
    found = []
    for where in _PLACES:
        names = []
        for array in arrays:
            if array.where == where and array.real and array.components == 1:
                names.append(array.name)
        for name, parts in find_vectors(names, pair).items():
            found.append(MeshArray(name, where, len(parts), parts=parts))
    return found


def thick_axes(points: AnyArray) -> list[int]:
    """Return the axes, 0 to 2, along which points (N, 3) extend."""
    if len(points):
        spans = np.ptp(points, axis=0)
    else:
        spans = np.zeros(3)
    found = []
    for axis, span in enumerate(spans):
        if span > FLAT_SHARE * spans.max():
            found.append(axis)
    return found


def select_velocity(mesh: pv.DataSet, vectors: Any, record: Record) -> MeshArray:
    """Return the vectors that are drawn.

    Parameters
    ----------
    mesh
        The mesh.
    vectors
        Name of an array, or of its components with commas between; ``None`` to find it.
    record
        Record of what was chosen automatically.

    Raises
    ------
    FieldError
        When no such array exists, it has no 2 or 3 components, or several could be the velocity.
    """
    arrays = catalogue(mesh)
    known = f"with their numbers of components: {', '.join(map(str, arrays)) or 'none'}"
    if vectors is None:
        return _found(mesh, known, record)
    words = tuple(word.strip() for word in str(vectors).split(","))
    named = [a for a in (*arrays, *_component_vectors(mesh)) if a.name == vectors]
    if not named and len(words) in (2, 3):
        scalars = {(a.where, a.name) for a in arrays if a.numeric and a.components == 1}
        named = []
        for where in _PLACES:
            if scalars.issuperset((where, word) for word in words):
                named.append(MeshArray(",".join(words), where, len(words), parts=words))
    for array in named:
        if array.numeric and array.components in (2, 3):
            record("select", f'the velocity is "{array.name}", as selected')
            return array
    reason = "; " + near_names(str(vectors), [array.name for array in arrays])
    if named or len(words) > 1:
        reason = (
            "; expected an array of 2 or 3 components, or the names of 2 or 3 arrays of one "
            "component, all on points or all on cells, separated by commas"
        )
    raise FieldError(f"vectors is {vectors!r}{reason}. The arrays of the mesh, {known}")


def _found(mesh: pv.DataSet, known: str, record: Record) -> MeshArray:
    """Return the only velocity, or the one that the mesh marks or a name identifies."""
    arrays = candidates(mesh)
    if not any(is_velocity(a.name) for a in arrays):
        # Such as u, v and w beside a vorticity.
        single = [a for a in _component_vectors(mesh) if is_velocity(a.name)]
        if len(single) == 1 and single[0] not in arrays:
            listed = ", ".join(map(str, arrays))
            text = f'the velocity is "{single[0].name}", made of single arrays; other vectors: '
            record("select", text + listed, Remedy("vectors", arrays[0].name), notable=True)
            return single[0]
    active = mesh.active_vectors_name
    # VTK's PLOT3D reader marks the momentum automatically: that is no choice.
    if active == "Momentum" and any(a.name == "Velocity" for a in arrays):
        active = None
    marked = [a for a in arrays if a.name == active][:1]
    named = [a for a in arrays if VELOCITY.fullmatch(a.name)]
    preferred = marked or (named if len(named) == 1 else arrays)
    if not preferred:
        raise FieldError(
            "the mesh has no vectors that could be the velocity; expected an array of real numbers "
            f'with 2 or 3 components, or single ones, as in vectors="u,v,w". Arrays, {known}'
        )
    if len(preferred) > 1:
        raise FieldError(
            f"the mesh has {len(preferred)} arrays that could be the velocity: "
            f'{", ".join(map(str, preferred))}; choose one, as in vectors="{preferred[-1].name}"'
        )
    (array,) = preferred
    others = [other for other in arrays if other != array]
    by_name = bool(others) and mesh.active_vectors_name != array.name
    reason = f"the only {array.where.removesuffix('s')} array with {array.components} components"
    if others:
        reason = "the active vectors of the mesh"
    remedies = []
    if by_name:
        reason = f"chosen by its name; other vectors: {', '.join(map(str, others))}"
        remedies = [Remedy("vectors", others[0].name)]
    record("select", f'the velocity is "{array.name}", {reason}', *remedies, notable=by_name)
    return array


def find_vectors(
    names: Sequence[str], pair: tuple[int, int] | None = None
) -> dict[str, tuple[str, ...]]:
    """Return the names of the components of each vector, by a name for the vector.

    Two components are sufficient on a flat mesh: those along the ``pair`` of axes in its plane, or
    the first two if their letters name no axes. A vector has the name of its components without
    their letter, ``Velocity``, or if that is too short or the name of an array, all their names,
    ``u,v,w``.
    """
    all_names = set(names)
    vectors: dict[str, tuple[str, ...]] = {}
    for name in names:
        for before, alphabet, after in _parses(name):
            whole = tuple(before + token + after for token in alphabet)
            # Four numbered arrays are not a vector.
            if alphabet[0].isdecimal():
                numbered = [before + n + after for n in "0123"]
            else:
                numbered = []
            if numbered and all_names.issuperset(numbered):
                continue
            choices = [whole]
            if pair is not None:
                pairs = dict.fromkeys((pair, pair if alphabet in _AXES else (0, 1)))
                choices += [(whole[first], whole[second]) for first, second in pairs]
            parts = next((parts for parts in choices if all_names.issuperset(parts)), ())
            if parts and name == parts[0] and parts not in vectors.values():
                stem = _stem(before, after)
                free = len(stem) > 1 and stem not in all_names and stem not in vectors
                vectors[stem if free else ",".join(parts)] = parts
    return vectors


def named_axes(parts: Sequence[str]) -> tuple[tuple[int, ...], bool]:
    """Return the axes, 0 to 2, of named components, empty if unknown, and if these say x, y, z."""
    if parts:
        parses = (*_parses(parts[0]), *(("", axes, "") for axes in _AXES))
    else:
        parses = ()
    for before, alphabet, after in parses:
        whole = [before + token + after for token in alphabet]
        if set(parts) <= set(whole) and len(set(parts)) == len(parts):
            axes = tuple(whole.index(part) for part in parts)
            if alphabet in _AXES:
                return (axes, True)
            return (() if axes == (0, 1) else axes, False)
    return (), False


def _parses(name: str) -> Iterator[tuple[str, str, str]]:
    """Yield the ways to read a name: text, alphabet of the component, and text."""
    bare = _UNIT.sub("", name)
    for form in _FORMS:
        match = form.fullmatch(bare)
        if match is None or "," in name:
            continue
        start, end = match.span("token")
        before = name[:start]
        after = name[end:]
        stem = _stem(before, after)
        token = match["token"]
        if NO_VELOCITY.fullmatch(stem) or _MOMENTUM.fullmatch(stem):
            continue
        velocity = _VELOCITY.fullmatch(stem) is not None
        # Components, as x, y, z and numbers also have other uses.
        plausible = {"u": velocity or not stem, "x": bool(stem)}
        for alphabet in _ALPHABETS:
            kind = plausible.get(alphabet[0].lower(), velocity or before.endswith((":", "[")))
            if token in alphabet and kind:
                yield before, alphabet, after


def _stem(before: str, after: str) -> str:
    """Return the name of a vector: the name of a component without its letter and its unit."""
    return (before + _UNIT.sub("", after)).strip(_EDGES)


@dataclass(kw_only=True)
class Sheet:
    """Positions (..., 3) and visibility (...) of nodes, which are (J, I) or (N,).

    ``nodes`` computes the values of an array at the nodes, ``flat`` returns those of the cells,
    (J - 1, I - 1) or (M,), and ``arrays`` are all that there are.
    """

    points: Floats
    shown: Bools
    arrays: list[MeshArray]
    nodes: Callable[[MeshArray], Floats]
    flat: Callable[[MeshArray], Floats]
    #: Corners of triangles (M, 3), or the cells of a grid that are shown and have a velocity,
    #: (J - 1, I - 1), and whether the last line along (j, i) repeats the first one.
    triangles: Indices | None = None
    cells: Bools | None = None
    wrap: tuple[bool, bool] = (False, False)


def hidden_nodes(mesh: Any) -> Bools:
    """Return which nodes a mesh hides, (N,)."""
    return np.any([np.zeros(mesh.n_points, bool), *_hidden(mesh).values()], axis=0)


def visible_cells(mesh: Any) -> Bools:
    """Return which cells a mesh shows, (N,)."""
    flags = mesh.cell_data.get("vtkGhostType", np.zeros(mesh.n_cells, np.uint8))
    return (np.asarray(flags) & _HIDDEN_CELL) == 0


def _hidden(mesh: Any) -> dict[str, Bools]:
    """Return the hidden nodes by the reason."""
    # Negative values and those above one are walls and overlaps of grids, with data.
    tests: dict[str, Callable[[Any], Bools]] = {
        "vtkGhostType": lambda flags: (flags & _HIDDEN_POINT) != 0,
        "IBlank": lambda flags: flags == 0,
        "vtkValidPointMask": lambda flags: flags == 0,
    }
    data = mesh.point_data
    found = {}
    for name, test in tests.items():
        if name in data:
            found[name] = test(np.asarray(data[name]))
    return found


class Masks:
    """The masks of a series, and the greatest share that each of them hides.

    With ``keeps_fills`` fill values are drawn.
    """

    def __init__(self, velocity: MeshArray, *, keeps_fills: bool = False) -> None:
        self._velocity = velocity
        self._keeps_fills = keeps_fills
        self._shares: dict[str, float] = {}
        self._fills: dict[float, str] = {}

    def masked(self, mesh: Any) -> Any:
        """Return a mesh whose vectors are NaN where they have a fill value."""
        name = self._velocity.name
        where = self._velocity.where
        parts = self._velocity.parts
        values = values_of(mesh, self._velocity)
        hidden = {f"of the nodes are hidden by {array}": at for array, at in _hidden(mesh).items()}
        hidden["of the cells are hidden by vtkGhostType"] = ~visible_cells(mesh)
        if values.size and np.isnan(values.min()):
            missing = f"of the {where} have no velocity: {name} is NaN"
            hidden[missing] = np.asarray(np.isnan(values).any(-1))
        if where == "cells":
            visible = visible_cells(mesh)
        else:
            visible = ~hidden_nodes(mesh)
        known = rows_where(values, visible)
        for fill in self._fills:
            known = np.where(known == fill, np.nan, known)
        while not self._keeps_fills and (found := undeclared_fill(known)) is not None:
            text = f"{name} is {found:g} there, which is taken for a fill value"
            self._fills[found] = f"of the {where} are masked: {text}"
            known = np.where(known == found, np.nan, known)
        for fill, text in self._fills.items():
            hidden[text] = (values == fill).any(axis=-1) & visible
        for text, at in hidden.items():
            if at.size:
                share = float(at.mean())
            else:
                share = 0.0
            self._shares[text] = max(share, self._shares.get(text, 0.0))
        if not self._fills:
            return mesh
        left = np.where(np.isin(values, list(self._fills)), np.nan, values)
        mesh = mesh.copy(deep=False)
        for array, column in zip(parts or (name,), left.T if parts else (left,), strict=True):
            data_of(mesh, where)[array] = column
        return mesh

    def tell(self, record: Record) -> None:
        """Record what was hidden."""
        for text, share in self._shares.items():
            if share >= 0.01:
                percent = f"{share:.0%}"
            else:
                percent = "less than 1%"
            if share:
                if text in self._fills.values():
                    record("mask", f"{percent} {text}", DRAW_ALL, notable=True)
                else:
                    record("mask", f"{percent} {text}")
