"""Checks of the arrays of a field, and nodes that have data only at some times.

Functions ``..._faults`` return faults as sentences (see :mod:`flowtex.errors`); the others convert
arrays into the form that the rest of the package uses.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import Bools, Floats
from flowtex._util.arrays import rows_where
from flowtex._util.host_arrays import host_array, unit_text
from flowtex.errors import FieldError
from flowtex.field.dates import as_seconds
from flowtex.field.field_arrays import FieldArrays
from flowtex.field.steps import LazySteps, examined_steps, map_steps, typical_steps
from flowtex.field.units import speed_unit, symbol, velocity_units

LINE_WIDTH = 1e-7  #: A surface narrower than this share of its length is a line.
LENGTHS = (1e-30, 1e30)  #: Range of lengths in single precision.
MAGNITUDES = (1e-100, 1e100)  #: Range of speeds and times with finite squares.
NO_DATA = "no data"  #: The scalar that is 1 where there are no data, 0 elsewhere.


def node_positions(points: Any) -> Any:
    """Return a tuple of coordinates as one array, (J, I, 2 or 3).

    The coordinates are (J, I) each, or x (I,) and y (J,). Other points are returned as they are.

    Raises
    ------
    FieldError
        When coordinates of rows or columns both increase and decrease, or the arrays of a tuple
        have different shapes.
    """
    sizes = []
    if isinstance(points, (tuple, list)) and len(points) in (2, 3):
        sizes = list(map(np.ndim, points))
    if sizes == [1, 1]:
        for name, line in zip("xy", points, strict=True):
            steps: Floats = np.diff(np.ma.filled(np.ma.asarray(line, dtype=float), np.nan))
            if (steps > 0).any() and (steps < 0).any():
                raise FieldError(
                    f"{name} increases and decreases; expected coordinates in one direction: sort "
                    f"them, and the velocity with them, by np.argsort({name})"
                )
        points = np.meshgrid(*points)
    elif not isinstance(points, tuple) or set(sizes) != {2}:
        return points
    shapes = list(map(np.shape, points))
    if len(set(shapes)) > 1:
        raise FieldError(
            f"points are arrays of shapes {', '.join(map(str, shapes))}; expected one shape (J, I)"
        )
    if any(map(np.ma.isMA, points)):
        return np.ma.stack(points, axis=-1)
    return np.stack(points, -1)


def as_numbers(name: str, values: ArrayLike) -> tuple[Floats, Any]:
    """Return values as float64, copied if necessary, and the nodes (J, I) that a mask hides.

    Raises
    ------
    FieldError
        When the values are not real numbers, such as complex ones or text.
    """
    values = host_array(name, values)
    if np.ma.isMaskedArray(values):
        mask = np.ma.getmaskarray(values)
    else:
        mask = None
    array = np.asarray(np.ma.getdata(values))
    if array.dtype.kind not in "fiub":
        raise FieldError(
            f"{name} has type {array.dtype}; expected real numbers: convert it with "
            "astype(float), or take its real part"
        )
    array = np.asarray(array, np.float64)
    if mask is None:
        return array, np.False_
    if mask.ndim:
        hidden = mask.any(axis=-1)
    else:
        hidden = mask
    while hidden.ndim > 2:
        hidden = hidden.any(axis=0)
    return array, hidden


#: Warning about a velocity of zero.
ALL_AT_REST = (
    "The velocity is zero at every node, so the picture shows no flow; check the selected "
    "array and its region. On a wall draw the wall shear stress, such as wallShearStress."
)


def with_gaps(name: str, values: ArrayLike) -> Floats:
    """Return values as float64, copied if necessary, NaN where a masked array hides them."""
    values = host_array(name, values)
    array, _ = as_numbers(name, values)
    if isinstance(values, np.ma.MaskedArray) and np.ma.is_masked(values):
        array = np.where(np.ma.getmaskarray(values), np.nan, array)
    return array


def shape_faults(
    p: Floats,
    v: Floats,
    steps: int,
    times: Floats | None,
    valid: Floats | None,
    periodic: Any,
    scalars: Mapping[str, Floats],
) -> list[str]:
    """Return faults in the shapes of the arguments of :meth:`FlowField.from_arrays`."""
    if p.ndim != 3 or p.shape[-1] not in (2, 3):
        return [
            f"points has shape {p.shape}; expected (J, I, 2) or (J, I, 3). Reshape a flat list of "
            "points with reshape(J, I, 3)"
        ]
    grid = p.shape[:2]
    faults = []
    if min(grid) < 2:
        faults.append(
            f"points has {grid[0]} x {grid[1]} nodes (J x I); a surface needs at least 2 along "
            "each axis. A single row is a curve: choose another plane"
        )
    hint = ""
    if v.ndim in (3, 4) and v.shape[-3:-1] == grid[::-1] and grid[0] != grid[1]:
        hint = ". The two axes seem to be swapped: arrays are (j, i), try np.swapaxes"
    faults += nodal_faults(grid, v, steps, times, valid, scalars, hint)
    if periodic is not None and not (isinstance(periodic, str) and set(periodic) <= {"i", "j"}):
        faults.append(
            f'periodic is {periodic!r}; expected "", "i", "j" or "ij", or None to detect it'
        )
    return faults


def nodal_faults(
    grid: tuple[int, ...],
    v: Floats,
    steps: int,
    times: Floats | None,
    valid: Any,
    scalars: Mapping[str, Floats],
    hint: str = "",
) -> list[str]:
    """Return faults in the shapes of arrays over nodes (J, I) or (N,), and in the times."""
    faults = []
    is_series = v.ndim == len(grid) + 2
    fits = (v.ndim == len(grid) + 1 or is_series) and v.shape[is_series:-1] == grid
    if not (fits and v.shape[-1] in (2, 3) and v.size):
        nodes = ", ".join(map(str, grid))
        faults.append(
            f"velocity has shape {v.shape}; expected ({nodes}, 2 or 3) for a steady field or "
            f"(T, {nodes}, 2 or 3) for a time-varying one, as points has ({nodes}) nodes{hint}"
        )
    else:
        faults += time_faults(times, steps)
    if valid is not None and np.shape(valid) != grid:
        faults.append(f"valid has shape {np.shape(valid)}; expected {grid}, as points")
    return faults + scalar_faults("scalars", grid, steps, scalars, "as points and velocity have")


def scalar_faults(
    argument: str, shape: tuple[int, ...], steps: int, arrays: Mapping[str, Floats], reason: str
) -> list[str]:
    """Return faults in the shapes of scalars at nodes or cells of this shape."""
    found = []
    for name, array in arrays.items():
        if np.shape(array) not in (shape, (steps, *shape)):
            found.append(
                f"{argument}[{name!r}] has shape {np.shape(array)}; expected {shape} or "
                f"{(steps, *shape)}, {reason}"
            )
    return found


def cell_faults(
    shape: tuple[int, ...], steps: int, cells: Mapping[str, Floats], nodal: Iterable[str]
) -> list[str]:
    """Return faults in the shapes of scalars at cells, and in their names."""
    faults = scalar_faults("cell_scalars", shape, steps, cells, "one value for each cell")
    for name in cells:
        if name in nodal:
            faults.append(f"{name!r} is in scalars and in cell_scalars; expected one")
    return faults


def time_faults(t: Floats | None, count: int) -> list[str]:
    """Return faults in the times of this many steps, where they are given."""
    if t is None:
        return []
    if t.shape != (count,):
        return [f"times has shape {t.shape}; expected ({count},), one for each step of velocity"]
    if not np.isfinite(t).all():
        bad = int(np.flatnonzero(~np.isfinite(t))[0])
        return [f"times[{bad}] is {t[bad]}; expected a finite number"]
    if np.abs(t).max() > MAGNITUDES[1]:
        return [f"times reach {np.abs(t).max():.3g}; expected {MAGNITUDES[1]:g} at most"]
    falls = np.flatnonzero(np.diff(t) < MAGNITUDES[0])
    if len(falls):
        n = int(falls[0])
        return [
            f"times[{n + 1}] = {t[n + 1]:g} is not greater than times[{n}] = {t[n]:g}; expected "
            "strictly increasing times: sort the steps, and drop repeated ones"
        ]
    return []


#: Nodes of which a surface is expected to span a plane.
MOST_COMPARED = 10_000


def range_faults(p: Floats, v: Floats, ok: Bools) -> list[str]:
    """Return faults in the size of positions, and of velocities, NaN where not valid."""
    faults = []
    if ok.all():
        node_size = largest(p)
    else:
        node_size = largest(p, ok[..., None])
    for name, most, ends in (("points", node_size, LENGTHS), ("velocity", largest(v), MAGNITUDES)):
        if most and not ends[0] <= most <= ends[1]:
            faults.append(
                f"{name} has values up to {most:.3g}; expected {ends[0]:g} to {ends[1]:g}: use "
                "another unit, or NaN for missing values"
            )
    return faults


def node_faults(p: Floats, ok: Bools) -> list[str]:
    """Return faults in the nodes that are valid."""
    if not ok.any():
        return [
            f"none of the {ok.size} nodes is usable: all are blanked, masked or NaN; check the "
            "selected vectors and the mask"
        ]
    cells = ok[:-1, :-1] & ok[1:, :-1] & ok[:-1, 1:] & ok[1:, 1:]
    if not cells.any():
        return [
            f"{int(ok.sum())} of {ok.size} nodes are usable, but no four of them form a cell; "
            "check the mask"
        ]
    numbers = np.flatnonzero(ok)
    some = numbers[:: -(-len(numbers) // MOST_COMPARED)]
    # Hardly any surface is a line for these nodes alone.
    if not _line_faults(p.reshape(-1, p.shape[-1])[some]):
        return []
    return _line_faults(rows_where(p, ok))


def _line_faults(nodes: Floats) -> list[str]:
    """Return the fault of nodes (N, C) that lie at one point or on a line."""
    offsets = nodes - nodes.mean(axis=0)
    if (size := largest(offsets)) == 0:
        return ["all usable nodes lie at one point; expected a surface: check the coordinates"]
    offsets /= size
    spans = np.linalg.svd(offsets.T @ offsets, compute_uv=False)
    if spans[1] <= LINE_WIDTH**2 * spans[0]:
        return ["all usable nodes lie on one line; expected a surface: check the coordinates"]
    return []


def finite_nodes(a: Floats) -> Bools:
    """Return whether all components of (..., J, I, C) are finite at the nodes, (J, I)."""
    finite = np.isfinite(a)
    if finite.all():
        return np.ones(a.shape[-3:-1], dtype=bool)
    # NumPy's reduction over few components is slow.
    columns = np.moveaxis(finite, -1, 0)
    return np.asarray(np.logical_and.reduce(columns).all(axis=tuple(range(a.ndim - 3))))


def largest(a: Floats, where: Bools | bool = True) -> float:  # noqa: FBT001, FBT002
    """Return the greatest magnitude in an array, without a copy; 0 where all are NaN."""
    options: dict[str, Any] = {"axis": None, "initial": 0.0, "where": where}
    return float(max(-np.fmin.reduce(a, **options), np.fmax.reduce(a, **options)))


def three_components(a: Floats) -> Floats:
    """Return vectors (..., 2 or 3) with three components, the third one zero."""
    if a.shape[-1] == 3:
        return a
    return np.concatenate([a, np.zeros_like(a[..., :1])], axis=-1)


def scalar_steps(values: Floats, grid: tuple[int, ...]) -> Floats:
    """Copy a nodal array, with an axis of time; values beyond :data:`MAGNITUDES` become NaN."""
    result = values.reshape(-1, *grid).copy("C")
    if largest(result) > MAGNITUDES[1]:
        result[np.abs(result) > MAGNITUDES[1]] = np.nan
    return result


def filled_gaps(
    velocity: Any,
    scalars: Mapping[str, Any] | None,
    units: Mapping[str, str] | None,
    *,
    axes: int,
    unit: str,
) -> tuple[Any, Mapping[str, Any], Mapping[str, str], str]:
    """Return a velocity (T, ..., 2 or 3) that is zero where only some times have no data.

    Such nodes are drawn without streaks, and in the colour of NaN: the uncertainty of their
    direction is 1. Its name, empty without gaps, follows the scalars and their units. ``axes`` is
    the number of axes of the nodes. Of a long series of lazy steps some are compared.
    """
    if scalars is None:
        scalars = {}
    without_gaps = velocity, scalars, units or {}, ""
    if isinstance(velocity, LazySteps):
        numbers = _steps_to_compare(velocity)
        masks: list[Bools] | Bools = [_known(velocity[number]) for number in numbers]
        if len(numbers) < len(velocity) > 1 and isinstance(scalars, Mapping):
            without_gaps = _with_late_gaps(velocity, scalars, units or {}, unit)
    else:
        try:
            velocity = with_gaps("velocity", velocity)
        except FieldError:  # the field lists all faults later
            return without_gaps
        if velocity.ndim == axes + 2:
            masks = _known(velocity)
        else:
            masks = []
    if len(masks) < 2 or not isinstance(scalars, Mapping):
        return without_gaps
    sometimes: Bools = np.any(masks, axis=0)
    if np.array_equal(sometimes, np.all(masks, axis=0)):
        return without_gaps
    whole = map_steps(velocity, partial(_filled, sometimes))
    data = dict(scalars)
    data.setdefault(NO_DATA, map_steps(velocity, lacking))
    data.setdefault("speed", map_steps(velocity, _speed))
    return whole, data, {"speed": unit, **(units or {})}, NO_DATA


def _with_late_gaps(
    velocity: LazySteps, scalars: Mapping[str, Any], units: Mapping[str, str], unit: str
) -> tuple[Any, Mapping[str, Any], Mapping[str, str], str]:
    """Return a velocity of which steps that are read later may lack data, and the scalar for that.

    There the speed is missing, and not 0. Where the data have a speed with other gaps, their reader
    has marked those of the velocity.
    """
    if NO_DATA in scalars:
        return velocity, scalars, units, NO_DATA
    speeds = {"speed": map_steps(velocity, _speed), **scalars}
    return velocity, speeds, {"speed": unit, **units}, ""


def _steps_to_compare(velocity: LazySteps) -> list[int]:
    if velocity.quick:
        return examined_steps(len(velocity), velocity[0].size)
    if _known(velocity[0]).all():
        return []
    return typical_steps(len(velocity))


def _filled(sometimes: Bools, step: Floats) -> Floats:
    """Return a step with zeros at nodes that lack data in this step but not in all."""
    return np.where((sometimes & ~_known(step))[..., None], 0.0, step)


def lacking(step: Floats) -> Floats:
    """Return 1 at nodes that lack data, 0 elsewhere."""
    return np.where(_known(step), 0.0, 1.0)


def _speed(step: Floats) -> Floats:
    with np.errstate(over="ignore", invalid="ignore"):  # the field refuses such values later
        return np.where(_known(step), np.linalg.norm(step, axis=-1), np.nan)


def _known(step: Floats) -> Bools:
    return np.asarray(np.isfinite(step).all(axis=-1))


class Checked(NamedTuple):
    """The times and the velocity of a field, in one system of units."""

    times: Floats | None
    start: Any  #: The date at time 0, if the times count from one.
    scale: float  #: Factor of the velocity to units of length per unit of time.
    velocity: Any  #: Without gaps at single steps; not scaled yet.
    scalars: Mapping[str, Any]
    units: dict[str, str]
    length_unit: str
    time_unit: str
    velocity_unit: str
    uncertainty: str  #: Name of the scalar that marks gaps; empty without gaps.


def in_own_units(arrays: FieldArrays, *, axes: int) -> Checked:
    """Return times, velocity and scalars of arrays whose nodes have this number of axes.

    Raises
    ------
    FieldError
        When times or units cannot be read.
    """
    unit_of_time = arrays.time_unit or symbol(unit_text(arrays.times))
    times, time_unit, start = as_seconds(arrays.times, unit_of_time)
    t = None
    if times is not None:
        t = with_gaps("times", times)
    length_unit = arrays.length_unit
    scale, time_unit, velocity_unit = velocity_units(length_unit, time_unit, arrays.velocity_unit)
    unit = velocity_unit or speed_unit(length_unit, time_unit)
    velocity, scalars, units, uncertainty = filled_gaps(
        arrays.velocity, arrays.scalars, arrays.units, axes=axes, unit=unit
    )
    return Checked(
        times=t,
        start=start,
        scale=scale,
        velocity=velocity,
        scalars=scalars,
        units=dict(units),
        length_unit=length_unit,
        time_unit=time_unit,
        velocity_unit=velocity_unit,
        uncertainty=uncertainty,
    )
