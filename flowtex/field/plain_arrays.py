"""Arrays in the forms that matplotlib's ``streamplot`` and ``quiver`` take.

====================================  =========================================================
arrays                                they are
====================================  =========================================================
``velocity``                          both components in one array; positions are 0, 1, 2, ...
``u, v``                              the same, one array for each component
``points, velocity``                  as :meth:`FlowField.from_arrays` has them
``x, y, velocity``                    positions along x and y
``x, y, u, v``                        as in ``plt.streamplot`` and ``plt.quiver``
``x, y, z, u, v, w``                  a surface in space
====================================  =========================================================

A component has the shape (J, I) or (T, J, I); ``x`` and ``y`` are lines (I,) and (J,), or have the
shape (J, I). One array of all components has them along its first or its last axis, or is complex,
u + iv. Where a shape has two readings, an error says so.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex._util.host_arrays import host_array, unit_text
from flowtex.errors import FieldError
from flowtex.field import units
from flowtex.field.matched_labels import check_positions, has_labels, labelled_lines, matched
from flowtex.field.steps import LazySteps

#: The forms, for messages.
FORMS = (
    "(velocity), (u, v), (points, velocity), (x, y, velocity), (x, y, u, v) or (x, y, z, u, v, w)"
)
COMPONENTS = (2, 3)  #: Numbers of components.


@dataclass(frozen=True, eq=False)
class PlainFlow:
    """Positions and velocity of arrays.

    Attributes
    ----------
    points, velocity
        As for :meth:`FlowField.from_arrays`. Of scattered points the positions are lines (N,), and
        the velocity is (N, 2).
    length_unit, velocity_unit
        The units that the arrays carry; empty for none.
    scattered
        Whether the points are no grid.
    """

    points: Any
    velocity: Any
    length_unit: str = ""
    velocity_unit: str = ""
    scattered: bool = False


def are_named(data: Any) -> bool:
    """Return whether data are arrays by name: a mapping, an ``.npz`` file or a structured array."""
    is_mapping = isinstance(data, Mapping) or has_files(data)
    return is_mapping or fields_of(data) is not None


def has_files(data: Any) -> bool:
    """Return whether data are the arrays of an ``.npz`` file, which ``numpy.load`` opens."""
    return isinstance(data, np.lib.npyio.NpzFile)


def fields_of(data: Any) -> tuple[str, ...] | None:
    """Return the names of the fields of a structured array; ``None`` for other data."""
    return getattr(getattr(data, "dtype", None), "names", None)


def refuse_beside_names(arguments: Mapping[str, Any]) -> None:
    """Raise a FieldError for the first argument that is given beside arrays by name."""
    for argument, value in arguments.items():
        if value is not None and not (isinstance(value, str) and not value):
            raise FieldError(
                f"{argument} is given beside arrays by name; pass the arrays one by one, as in "
                "FlowField.from_arrays(x, y, u, v)"
            )


def plain_grid(points: Any, velocity: Any, components: Sequence[Any]) -> PlainFlow:
    """Return the grid of the arguments of :meth:`FlowField.from_arrays`, as this documents them.

    Two arrays that have no other meaning stay as they are, and the field lists their faults.

    Raises
    ------
    FieldError
        When the points are scattered, or the shapes have no meaning together.
    """
    if isinstance(velocity, LazySteps):
        return PlainFlow(points, velocity)
    if velocity is None:
        flow = read_plain((points,))
    elif components:
        flow = read_plain((points, velocity, *components))
    else:
        flow = _pair(points, velocity)
    if flow.scattered:
        raise FieldError(
            f"positions and velocity have the shapes {_shapes((*flow.points, flow.velocity))}, as "
            "of scattered points; expected a grid. Draw points by flowtex.show(x, y, u, v), or "
            "make triangles by FlowField.from_triangles"
        )
    return flow


def _pair(points: Any, velocity: Any) -> PlainFlow:
    """Return positions and velocity, reordered unless their shapes are the usual ones."""
    if has_labels(points) and has_labels(velocity):
        return read_plain((points, velocity))
    try:
        shape = np.shape(host_array("velocity", velocity))
        is_usual = len(shape) in (3, 4) and shape[-1] in COMPONENTS
        if not is_usual or unit_text(velocity):
            return read_plain((points, velocity))
    except FieldError:
        pass
    return PlainFlow(points, velocity)


def read_plain(arrays: Sequence[Any]) -> PlainFlow:
    """Return the flow of one to six arrays; raise a FieldError that names their shapes."""
    places, parts = _by_role(arrays)
    places, parts = _by_labels(places, parts)
    positions, length_unit = _in_one_unit(("x", "y", "z"), places)
    names: tuple[str, ...] = ("u", "v", "w")
    if len(parts) == 1:
        names = ("velocity",)
    components, velocity_unit = _in_one_unit(names, parts)
    flow_units = {"length_unit": length_unit, "velocity_unit": velocity_unit}
    points, grid = _nodes(positions)
    scattered = _are_scattered(positions, components)
    if scattered:
        grid = positions[0].shape
    velocity = _joined(components, grid)
    if points is None:
        rows, columns = velocity.shape[-3:-1]
        points = np.arange(float(columns)), np.arange(float(rows))
    return PlainFlow(points, velocity, scattered=scattered, **flow_units)


def _by_labels(places: Sequence[Any], parts: Sequence[Any]) -> tuple[Sequence[Any], Sequence[Any]]:
    """Return positions and components in one order of labels; labels are positions if need be."""
    if not any(map(has_labels, (*places, *parts))):
        return places, parts
    sizes = set(map(np.shape, (*places, *parts)))
    names = (*"xyz"[: len(places)], *"uvw"[: len(parts)])
    if len(sizes) == 1 and len(parts) > 1 and max(map(len, sizes)) == 1:
        # Rows of a table.
        arrays = matched(names, (*places, *parts))
        return arrays[: len(places)], arrays[len(places) :]
    if len(parts) > 1:
        parts = matched(names[len(places) :], parts)
        check_positions("u", parts[0], places)
    if not places:
        places = labelled_lines(parts) or ()
    return places, parts


def _by_role(arrays: Sequence[Any]) -> tuple[Sequence[Any], Sequence[Any]]:
    """Return the arrays of positions, and the arrays of the velocity."""
    count = len(arrays)
    if count == 1 or (count == 2 and _are_components(*arrays)):
        return (), arrays
    if count == 2:
        return _coordinates(arrays[0]), arrays[1:]
    if count == 3:
        return arrays[:2], arrays[2:]
    if count in (4, 6):
        return arrays[: count // 2], arrays[count // 2 :]
    raise FieldError(
        f"{count} arrays are given, of the shapes {_shapes(arrays)}; expected {FORMS}. Values for "
        "the colours are the argument scalars"
    )


def _are_components(first: Any, second: Any) -> bool:
    """Return whether two arrays are u and v; otherwise they are positions and a velocity."""
    if isinstance(first, tuple):
        return False
    one = host_array("u", first)
    other = host_array("v", second)
    if np.iscomplexobj(other) or one.ndim != other.ndim or one.ndim not in (2, 3):
        return False
    if one.shape == other.shape and one.shape[-1] in COMPONENTS:
        raise FieldError(
            f"two arrays of the shape {one.shape} may be u and v, or positions and a velocity; "
            "pass x, y, u, v, or make a field: flowtex.FlowField.from_arrays(points, velocity)"
        )
    is_points = one.ndim == 3 and one.shape[-1] in COMPONENTS
    return not is_points


def _coordinates(points: Any) -> tuple[Any, ...]:
    """Return x and y (and z) of one argument for all positions."""
    if isinstance(points, tuple):
        return points
    is_short = isinstance(points, list) and len(points) in COMPONENTS
    if is_short and set(map(np.ndim, points)) == {1}:
        return tuple(points)
    if np.iscomplexobj(points):
        return np.real(points), np.imag(points)
    return (points,)


def _in_one_unit(names: Sequence[str], arrays: Sequence[Any]) -> tuple[list[AnyArray], str]:
    """Return arrays in the unit of the first one that has a unit, and this unit."""
    named = list(map(unit_text, arrays))
    common = next(filter(None, named), "")
    values = []
    for name, array, unit in zip(names, arrays, named, strict=False):
        numbers = host_array(name, array)
        if unit and unit != common:
            factor = units.factor(unit, common)
            if factor is None:
                raise FieldError(
                    f"{name} is in {unit!r}, which cannot be converted to {common!r}, the unit of "
                    "the array before; expected units of one kind"
                )
            numbers = numbers * factor
        values.append(numbers)
    if common:
        common = units.symbol(common)
    return values, common


def _nodes(positions: Sequence[AnyArray]) -> tuple[Any, tuple[int, ...] | None]:
    """Return positions as a field takes them, and the shape (J, I) if they tell it."""
    if not positions:
        return None, None
    if len(positions) == 1:
        return positions[0], positions[0].shape[:-1]
    # Files of MATLAB have lines as (1, N) or (N, 1).
    is_line = [1 in part.shape[-2:] or part.ndim == 1 for part in positions]
    if len(positions) == 2 and all(is_line):
        x = positions[0].ravel()
        y = positions[1].ravel()
        return (x, y), (len(y), len(x))
    x, y, *others = positions
    if y.ndim == 1:
        y = y[:, None]
    try:
        nodes = np.broadcast_arrays(x, y, *others, subok=True)
    except ValueError:
        nodes = ()
    if not nodes or nodes[0].ndim != 2:
        raise FieldError(
            f"the positions have the shapes {_shapes(positions)}; expected x (I,) and y (J,), or "
            "one shape (J, I), the same at all times"
        )
    return tuple(nodes), nodes[0].shape


def _are_scattered(positions: Sequence[AnyArray], components: Sequence[AnyArray]) -> bool:
    """Return whether each of many positions x, y has one velocity, so that they are no grid."""
    if len(positions) != 2 or not positions[0].ndim == positions[1].ndim == 1:
        return False
    first = components[0]
    joined = len(components) == 1 and not np.iscomplexobj(first)
    return len(positions[0]) == len(positions[1]) and first.ndim == 1 + joined


def _joined(components: Sequence[AnyArray], grid: tuple[int, ...] | None) -> AnyArray:
    """Return a velocity with the components along its last axis, on nodes of a shape if known."""
    first = components[0]
    if len(components) == 1 and np.iscomplexobj(first):
        components = [first.real, first.imag]
    if len(components) == 1:
        return _components_last(first, grid)
    shapes = set(map(np.shape, components))
    complex_part = any(map(np.iscomplexobj, components))
    if len(shapes) > 1 or complex_part:
        if complex_part:
            wrong = "complex u + iv is one array"
        else:
            wrong = "expected one shape"
        raise FieldError(f"the components have the shapes {_shapes(components)}; {wrong}")
    if not _fits(first.shape, grid):
        raise FieldError(_misfit("u", first.shape, first.shape, grid))
    if _any_masked(components):
        return np.ma.stack(components, -1)
    return np.stack(components, -1)


def _components_last(velocity: AnyArray, grid: tuple[int, ...] | None) -> AnyArray:
    """Return a velocity with the axis of its components moved to the end."""
    shape = velocity.shape
    last = len(shape) - 1
    found = []
    for axis in (0, 1, last):
        nodes = (*shape[:axis], *shape[axis + 1 :])
        # An axis of components lies after the axis of time, but never between two axes of nodes.
        is_allowed = axis in (0, last) or len(shape) == 4
        is_new = is_allowed and axis not in found
        if is_new and shape[axis:] and shape[axis] in COMPONENTS and _fits(nodes, grid):
            found.append(axis)
    if len(found) == 1:
        return np.moveaxis(velocity, found[0], -1)
    if found:
        raise FieldError(
            f"velocity has shape {shape}, and its components may lie along axis "
            f"{' or '.join(map(str, found))}; pass them as two arrays, u and v"
        )
    nodes = shape[:-1]
    if shape and shape[0] in COMPONENTS and shape[-1] not in COMPONENTS:
        nodes = shape[1:]
    raise FieldError(_misfit("velocity", shape, nodes, grid))


def _fits(nodes: tuple[int, ...], grid: tuple[int, ...] | None) -> bool:
    """Return whether an array of a shape has one value per node, perhaps after an axis of time."""
    if grid is None:
        return len(nodes) in (2, 3) and min(nodes[-2:]) > 1
    return nodes == grid or (len(nodes) == len(grid) + 1 and nodes[1:] == grid)


def _misfit(
    name: str, shape: tuple[int, ...], nodes: tuple[int, ...], grid: tuple[int, ...] | None
) -> str:
    """Return the text of an error for a shape that does not fit the positions."""
    if grid is None:
        return (
            f"{name} has shape {shape}; expected (J, I) or (T, J, I) for each component, and both "
            "components: u, v or u + 1j * v, or one array (J, I, 2)"
        )
    rows = ", ".join(map(str, grid))
    text = (
        f"{name} has shape {shape}, and the positions are those of ({rows}) nodes; expected "
        f"({rows}) or (T, {rows}) for each component"
    )
    if len(grid) == 2 and nodes[-2:] == grid[::-1]:
        return f"{text}, with rows along y: swap its axes, as in np.swapaxes({name}, -1, -2)"
    if name != "velocity" and len(shape) == len(grid) + 1 and shape[:-1] == grid:
        return f"{text}, with the times first: move its last axis, as in np.moveaxis({name}, -1, 0)"
    if name == "velocity" and shape in (grid, grid[1:]):
        return f"{text}, and both components: u, v or u + 1j * v; colours are the argument scalars"
    return text


def _any_masked(arrays: Sequence[AnyArray]) -> bool:
    return any(map(np.ma.isMaskedArray, arrays))


def _shapes(arrays: Sequence[Any]) -> str:
    return ", ".join(map(str, map(np.shape, arrays)))
