"""From PyVista meshes to the arrays of a field, in the steps of ``field_arrays.STEPS``.

The velocity and the surface are selected in the first step of a series. Every step is aligned with
the first one, masked, and drawn as a :class:`Sheet`: a plane of a structured mesh, or a surface of
triangles. Vectors on cells become vectors on nodes. :meth:`FlowField.from_arrays` and
:meth:`FlowField.from_triangles` check the rest.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.field.derived.quantities import component_name
from flowtex.field.field_arrays import NOTABLE_SHARE, GridArrays, TriangleArrays
from flowtex.field.folds import MOST_NODES
from flowtex.field.grids.grid_surface import GridSurface
from flowtex.field.options import OF_EARTH, OF_UNITS, FieldOptions
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


def read_meshes(mesh: Any, options: FieldOptions, *, name: str = "") -> GridArrays | TriangleArrays:
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
    plane, periodic, sign_free = options.plane, options.periodic, bool(options.sign_free)
    if (preference := options.preference or "point") not in ("point", "cell"):
        raise FieldError(f'preference is {preference!r}; expected "point" or "cell"')
    cut = _cut_of(options)
    vectors, steps = series.with_velocity(mesh, options, record)
    first = next(steps)
    on_grid = parts.is_structured(first.grid) and cut is None
    refused = {"plane": plane, "periodic": periodic, "sign_free": sign_free or None}
    if not on_grid and (given := [f"{k}={value!r}" for k, value in refused.items() if value]):
        raise FieldError(
            f"{', '.join(given)} applies to structured meshes, and this one is not; omit it, or "
            'cut a volume as in slice="x=0.5"'
        )
    stored, chosen = choose(first.grid, vectors, plane, cut, record)
    read_as = MeshVelocity.of(stored, options.components, record)
    velocity = read_as.drawn
    is_plain = periodic is None and not sign_free
    if chosen is not None and is_plain and _has_cells_at_folds(first.grid, chosen, velocity):
        chosen = None

    def draw(grid: Any) -> Sheet:
        if chosen is not None:
            return volume.plane_sheet(grid, chosen, velocity, periodic, sign_free=sign_free)
        return surface_sheet(grid, cut, velocity, record)

    times = options.times
    count = len(mesh) if isinstance(mesh, (list, tuple)) else len(parts.times_of(mesh))
    ranges = volume.VolumeValues(velocity, chosen or cut, count, preference)
    every = chain([first], steps)
    arrays = _stacked(
        every, read_as, _masks(stored, options), draw, times, preference, record, ranges
    )
    arrays |= {unit: getattr(options, unit) or "" for unit in OF_UNITS}
    record.notify()
    arrays |= {"name": name, "reading": record.reading, "vectors": velocity.name}
    arrays["volume_values"] = ranges.values()
    if first.grid.max_cell_dimensionality < 3:
        arrays["notable_normal"] = NOTABLE_SHARE
    if chosen is not None:
        return GridArrays(**arrays, periodic=periodic, sign_free=sign_free)
    return TriangleArrays(**arrays)


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


def _stacked(
    steps: Iterator[parts.TimeStep],
    read_as: MeshVelocity,
    masks: Masks,
    draw: Callable[[Any], Sheet],
    times: ArrayLike | None,
    preference: str,
    record: Record,
    ranges: volume.VolumeValues,
) -> dict[str, Any]:
    velocity = read_as.drawn
    first, reordered = next(steps), 0
    start: Sheet | None = None
    single: set[str] = set()
    read = []
    for step in chain([first], steps):
        parts.check_arrays(step, first, read_as.stored)
        same = parts.aligned(step, first)
        grid = read_as.in_space(masks.masked(same.grid))
        ranges.add(grid)
        sheet = draw(grid)
        if start is None:
            start = sheet
        else:
            parts.check_nodes(start, sheet, step.label)
        single |= {array.name for array in sheet.arrays if array.components == 1}
        values = sheet.nodes(velocity), *_scalars(sheet, preference, velocity)
        # Meshes are not kept.
        read.append((replace(step, grid=None), sheet.shown, sheet.cells, *values))
        reordered += same is not step
    assert start is not None
    kept, shown, cells, vectors, *scalars = zip(*read, strict=True)
    order, moments = (
        parts.ordered_times(kept, record) if times is None else (range(len(kept)), None)
    )
    if reordered:
        text = f"nodes or cells of {reordered} steps are in another order than those of the first"
        record("align", f"{text}, and were matched by their labels or places", notable=True)
    masks.tell(record)
    valid = np.logical_and.reduce(shown)
    if start.cells is not None:
        valid &= volume.nodes_to_keep(np.logical_and.reduce(cells), start.wrap)
    if velocity.where == "cells":
        record("surface", "velocity averaged from the cells to the nodes")
    axes = _axes(velocity, start, record, solid=first.grid.max_cell_dimensionality == 3)
    flow = np.zeros((len(order), *vectors[0].shape[:-1], 3))
    for n, number in enumerate(order):
        flow[n][..., axes] = vectors[number]
    _note_rest(flow, moments, record)
    nodal, flat = (parts.scalar_steps([s[n] for n in order], moments, record) for s in scalars)
    for name in {*nodal} & {*flat}:
        record("align", f"{name!r} lies on nodes and on cells; that on nodes is read", notable=True)
        del flat[name]
    arrays = {"points": start.points, "velocity": flow, "valid": valid}
    arrays |= {"scalars": nodal, "cell_scalars": flat}
    arrays["parts"] = tuple(name for name in (*nodal, *flat) if name not in single)
    triangles = {} if start.triangles is None else {"triangles": start.triangles}
    return {**arrays, **triangles, "times": moments if times is None else times}


def _note_rest(flow: Floats, moments: Any, record: Record) -> None:
    """Record the first step of a velocity (T, ...) that moves, if the first one is at rest."""
    moving = [n for n, step in enumerate(flow) if np.nan_to_num(step).any()]
    if moving and moving[0]:
        when = f"step {moving[0]}" if moments is None else f"time {moments[moving[0]]:g}"
        text = f"the velocity is zero everywhere at the first step; it is not from {when} on"
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
