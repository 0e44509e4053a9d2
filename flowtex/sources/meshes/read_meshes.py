"""From PyVista meshes to the arrays of a field, in the steps of ``field_arrays.STEPS``.

The velocity and the surface are selected in the first step of a series. Every step is aligned with
the first one, masked, and drawn as a :class:`Sheet`: a plane of a structured mesh, or a surface of
triangles. Vectors on cells become vectors on nodes. :meth:`FlowField.from_arrays` and
:meth:`FlowField.from_triangles` check the rest.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import Bools, Floats
from flowtex._util.arrays import is_nonzero
from flowtex.errors import FieldError
from flowtex.field.field_arrays import NOTABLE_SHARE, GridArrays, SourceArrays, TriangleArrays
from flowtex.field.folds import MOST_NODES
from flowtex.field.grids.grid_surface import GridSurface
from flowtex.field.options import OF_EARTH, OF_UNITS, FieldOptions
from flowtex.field.vector_names import component_name
from flowtex.sources.meshes import parts, series, volume
from flowtex.sources.meshes.cuts import Cut, check_cut, contour_of, slice_of, surface_sheet
from flowtex.sources.meshes.turned_vectors import MeshVelocity
from flowtex.sources.meshes.vectors import (
    NO_VELOCITY,
    Masks,
    MeshArray,
    Sheet,
    named_axes,
    select_velocity,
    thick_axes,
)
from flowtex.sources.notices import Record

#: Start of the names by which VTK's filters number the nodes and cells of their input.
NUMBERS = "vtkOriginal"
#: Greatest ratio of the variances across and along a flat mesh.
FLAT = 1e-10


def read_meshes(mesh: Any, options: FieldOptions, *, name: str = "") -> SourceArrays:
    """Read the arrays for :meth:`FlowField.from_pyvista` from a mesh or a series of them.

    Parameters
    ----------
    mesh
        A mesh, a list of meshes, or a PyVista reader.
    options
        Options of the field.
    name
        Name of the field.

    Raises
    ------
    FieldError
        When the options are for datasets or do not fit the mesh, it has no vectors that can be the
        velocity, or the steps of a series differ in their nodes.
    """
    record = Record()
    options.refuse(OF_EARTH, "datasets, but this is a mesh")
    periodic = options.periodic
    sign_free = bool(options.sign_free)
    preference = _preference(options)
    cut = _cut_of(options)
    vectors, steps = series.with_velocity(mesh, options, record)
    first = next(steps)
    if first.is_plane:
        options = replace(options, plane=None)
    if cut is not None or not parts.is_structured(first.grid):
        _refuse_of_grids(options)
    stored, chosen = choose(first.grid, vectors, options.plane, cut, record)
    read_as = MeshVelocity.of(stored, options.components, record)
    velocity = read_as.drawn
    is_plain = periodic is None and not sign_free
    if chosen is not None and is_plain and _has_cells_at_folds(first.grid, chosen, velocity):
        chosen = None

    def sheet_of(grid: Any) -> Sheet:
        if chosen is not None:
            return volume.plane_sheet(grid, chosen, velocity, periodic, sign_free=sign_free)
        return surface_sheet(grid, cut, velocity, record)

    count = len(mesh) if isinstance(mesh, (list, tuple)) else len(parts.times_of(mesh))
    ranges = volume.VolumeValues(velocity, chosen or cut, count, preference)
    read = _Series(read_as, _masks(stored, options), sheet_of, preference, ranges)
    arrays = _stacked(chain([first], steps), read, options.times, record)
    arrays |= {unit: getattr(options, unit) or "" for unit in OF_UNITS}
    record.notify()
    arrays |= {"name": name, "reading": record.reading, "vectors": velocity.name}
    arrays["volume_values"] = ranges.values()
    if first.grid.max_cell_dimensionality < 3:
        arrays["notable_normal"] = NOTABLE_SHARE
    if chosen is not None:
        return GridArrays(**arrays, periodic=periodic, sign_free=sign_free)
    return TriangleArrays(**arrays)


def _preference(options: FieldOptions) -> str:
    """Return whether an array is that of points or of cells where both have its name."""
    preference = options.preference or "point"
    if preference not in ("point", "cell"):
        raise FieldError(f'preference is {preference!r}; expected "point" or "cell"')
    return preference


def _refuse_of_grids(options: FieldOptions) -> None:
    """Raise a FieldError for arguments of structured meshes alone."""
    given = []
    for name in ("plane", "periodic", "sign_free"):
        value = getattr(options, name)
        if value:
            given.append(f"{name}={value!r}")
    if given:
        raise FieldError(
            f"{', '.join(given)} applies to structured meshes, and this one is not; omit it, or "
            'cut a volume as in slice="x=0.5"'
        )


def _masks(velocity: MeshArray, options: FieldOptions) -> Masks:
    """Return the masks of a velocity, which hide its fill values unless ``mask`` is ``False``."""
    if options.mask not in (None, False):
        raise FieldError(
            f"mask is {options.mask!r}; of a mesh expected False, which draws fill values too, or "
            "none. To hide nodes, set their velocity to NaN"
        )
    return Masks(velocity, keeps_fills=options.mask is False)


def _cut_of(options: FieldOptions) -> Cut | None:
    """Return the cut of a volume, if there is one."""
    cuts = {"plane": options.plane, "slice": options.slice, "contour": options.contour}
    given = []
    for name, value in cuts.items():
        if value is not None:
            given.append(f"{name} is {value!r}")
    if len(given) > 1:
        raise FieldError(f"{' and '.join(given)}; choose one of them")
    if options.contour is not None:
        return contour_of(options.contour)
    if options.slice is not None:
        return slice_of(options.slice)
    return None


def choose(
    grid: Any, vectors: str | None, plane: str | None, cut: Cut | None, record: Record
) -> tuple[MeshArray, volume.Plane | None]:
    """Find the velocity and the plane, if there is one."""
    chosen = None
    if parts.is_structured(grid) and cut is None:
        chosen = volume.find_plane(grid, plane, record)
    else:
        check_cut(grid, cut)
    return select_velocity(grid, vectors, record), chosen


def _has_cells_at_folds(grid: Any, plane: volume.Plane, velocity: MeshArray) -> bool:
    """Return whether a surface has a velocity on its cells, and folds where means are per face."""
    if velocity.where != "cells" or grid.max_cell_dimensionality != 2:
        return False
    points = volume.plane_positions(grid, plane)
    known = np.asarray(np.isfinite(points).all(axis=-1))
    return known.size <= MOST_NODES and GridSurface(points, known, (False, False)).is_folded


class _StepValues(NamedTuple):
    """What is kept of a time step."""

    step: parts.TimeStep  #: Its time and label; meshes are not kept.
    shown: Bools  #: Nodes that are shown.
    cells: Bools | None  #: Cells of a grid that are shown.
    velocity: Floats  #: At the nodes, (..., C).
    nodal: dict[str, Floats]  #: Scalars at the nodes.
    flat: dict[str, Floats]  #: Scalars of the cells.


@dataclass
class _Series:
    """The steps of a series, of which all have the nodes of the first one."""

    velocity: MeshVelocity
    masks: Masks
    #: Returns the surface of a mesh that is drawn.
    sheet_of: Callable[[Any], Sheet]
    preference: str  #: Whether of two arrays of a name that of points or of cells is read.
    ranges: volume.VolumeValues
    sheet: Sheet | None = None  #: The surface in the first step.
    read: list[_StepValues] = field(default_factory=list)
    #: Names of the scalars that are not components of vectors.
    single: set[str] = field(default_factory=set)
    reordered: int = 0  #: Number of steps whose nodes or cells were in another order.

    def add(self, step: parts.TimeStep, first: parts.TimeStep) -> None:
        """Read a step, with its nodes and cells in the order of the first one."""
        drawn = self.velocity.drawn
        parts.check_arrays(step, first, self.velocity.stored)
        aligned = parts.aligned(step, first)
        if aligned is not step:
            self.reordered += 1
        grid = self.velocity.in_space(self.masks.masked(aligned.grid))
        self.ranges.add(grid)
        sheet = self.sheet_of(grid)
        if self.sheet is None:
            self.sheet = sheet
        else:
            parts.check_nodes(self.sheet, sheet, step.label)
        self.single |= {array.name for array in sheet.arrays if array.components == 1}
        nodal, flat = _scalars(sheet, self.preference, drawn)
        without_mesh = replace(step, grid=None)
        values = sheet.nodes(drawn)
        self.read.append(_StepValues(without_mesh, sheet.shown, sheet.cells, values, nodal, flat))

    @property
    def valid(self) -> Bools:
        """Nodes that are shown in all steps."""
        assert self.sheet is not None
        valid = np.logical_and.reduce([each.shown for each in self.read])
        if self.sheet.cells is not None:
            cells = np.logical_and.reduce([np.asarray(each.cells) for each in self.read])
            valid &= volume.nodes_to_keep(cells, self.sheet.wrap)
        return np.asarray(valid)


def _stacked(
    steps: Iterator[parts.TimeStep], series: _Series, times: ArrayLike | None, record: Record
) -> dict[str, Any]:
    """Return the arrays of a field by name, with the steps of a series in the order of time."""
    first = next(steps)
    for step in chain([first], steps):
        series.add(step, first)
    sheet = series.sheet
    assert sheet is not None
    order: Sequence[int] = range(len(series.read))
    moments = None
    if times is None:
        order, moments = parts.ordered_times([each.step for each in series.read], record)
    if series.reordered:
        record(
            "align",
            f"nodes or cells of {series.reordered} steps are in another order than those of the "
            "first, and were matched by their labels or places",
            notable=True,
        )
    series.masks.tell(record)
    if series.velocity.drawn.where == "cells":
        record("surface", "velocity averaged from the cells to the nodes")
    is_solid = first.grid.max_cell_dimensionality == 3
    axes = _axes(series.velocity.drawn, sheet, record, solid=is_solid)
    in_order = [series.read[number] for number in order]
    flow = np.zeros((len(in_order), *in_order[0].velocity.shape[:-1], 3))
    for number, each in enumerate(in_order):
        flow[number][..., axes] = each.velocity
    _note_rest(flow, moments, record)
    nodal = parts.scalar_steps([each.nodal for each in in_order], moments, record)
    flat = parts.scalar_steps([each.flat for each in in_order], moments, record)
    for name in {*nodal} & {*flat}:
        record("align", f"{name!r} lies on nodes and on cells; that on nodes is read", notable=True)
        del flat[name]
    arrays: dict[str, Any] = {"points": sheet.points, "velocity": flow, "valid": series.valid}
    arrays |= {"scalars": nodal, "cell_scalars": flat}
    arrays["parts"] = tuple(name for name in (*nodal, *flat) if name not in series.single)
    if sheet.triangles is not None:
        arrays["triangles"] = sheet.triangles
    arrays["times"] = times
    if times is None:
        arrays["times"] = moments
    return arrays


def _note_rest(flow: Floats, moments: Any, record: Record) -> None:
    """Record the first step of a velocity (T, ...) that moves, if the first one is at rest."""
    moving = [n for n, step in enumerate(flow) if is_nonzero(step)]
    if moving and moving[0]:
        when = f"step {moving[0]}" if moments is None else f"time {moments[moving[0]]:g}"
        text = f"the velocity is zero everywhere at the first step; it is not from {when} on"
        if moments is not None:
            text = f"{text}, where pictures begin; for another one, time={moments[-1]:g}"
        record("mask", text, notable=True)


def _scalars(
    sheet: Sheet, preference: str, velocity: MeshArray
) -> tuple[dict[str, Floats], dict[str, Floats]]:
    """Return the scalars at the nodes, and the scalars of the cells; a name is in one of them.

    Components of other vectors than the velocity are among them.
    """
    nodal: dict[str, Floats] = {}
    flat: dict[str, Floats] = {}
    order = sorted(
        sheet.arrays, key=lambda a: (a.components > 1, not a.where.startswith(preference))
    )
    for array in order:
        if array.name.startswith(NUMBERS):
            continue
        is_other = array.name != velocity.name and not NO_VELOCITY.fullmatch(array.name)
        if array.components == 1:
            names = [array.name]
        else:
            names = []
        if array.components in (2, 3) and array.real and is_other:
            names = [component_name(array.name, str(axis)) for axis in range(array.components)]
        if array.numeric and names and not {*nodal, *flat} & set(names):
            on_points = array.where == "points"
            if on_points:
                values = sheet.nodes(array)
            else:
                values = sheet.flat(array)
            if len(names) == 1:
                columns = [values]
            else:
                columns = list(np.moveaxis(values, -1, 0))
            (nodal if on_points else flat).update(zip(names, columns, strict=True))
    return nodal, flat


def _axes(velocity: MeshArray, sheet: Sheet, record: Record, *, solid: bool) -> list[int]:
    """Return the axes in space, 0 to 2, of the components of a velocity.

    Names with x, y or z say it. Otherwise two components lie in the plane of a flat mesh; those of
    a volume or a curved surface are along x and y, or as ``u``, ``v`` and ``w`` say.
    """
    name = velocity.name
    if velocity.parts:
        record("components", f"{', '.join(velocity.parts)} combined")
    if velocity.components == 3:
        return [0, 1, 2]
    points = sheet.points[sheet.shown & np.isfinite(sheet.points).all(axis=-1)]
    in_plane = thick_axes(points)
    if len(points) > 2:
        variances = np.linalg.eigvalsh(np.cov(points.T))
    else:
        variances = np.ones(3)
    named, is_sure = named_axes(velocity.parts)
    if named and (is_sure or solid or len(in_plane) != 2 or sorted(named) == in_plane):
        axes = list(named)
    elif len(in_plane) == 2 and not solid:
        axes = in_plane
    elif solid or variances[0] > FLAT * variances[-1]:
        axes = [0, 1]
    else:
        raise FieldError(
            f"the velocity {name!r} has two components, and the mesh lies in a plane across the "
            "axes, where their directions are unknown; expected three components"
        )
    along = " and ".join("xyz"[axis] for axis in axes)
    if sorted(axes) == in_plane:
        record("components", f"{name}: two components, along {along} in the plane of the mesh")
    else:
        (lacking,) = {0, 1, 2} - set(axes)
        text = f"{name} has two components, which are drawn along {along}: the one along "
        record("components", f"{text}{'xyz'[lacking]} is taken to be zero", notable=True)
    return axes
