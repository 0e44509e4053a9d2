"""A flow from a formula, also as one line of text.

Such a line is ``y; -sin(x) - b*y; x=-7,7; b=0.2,0,1``, or ``pendulum; b=0.5``.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.arguments import checked_array, checked_count, near_names
from flowtex._util.array_types import Bools, Floats
from flowtex._util.written import UnreadableError, numbers
from flowtex.errors import FieldError, notify
from flowtex.field.field import FlowField
from flowtex.field.formula.formula import Formula

NODES = 257  #: Nodes along the longer side of a plane.
SURFACE_NODES = 129  #: The same for a surface, whose poles slow down tracing.
LEAST_NODES = 33  #: Least number of nodes along the shorter side.
MOST_NODES = 10_000  #: Greatest resolution that users may request.
SAME_PLACE = 1e-9  #: Share of the size of a surface within which places are the same.
MOST_TITLE = 60  #: Letters of a caption.
MOST_LETTERS = 4000  #: Greatest length of a line of text.
MOST_TIMES = 200  #: Most time steps of a line of text.
_NAMED = re.compile(r"\s*([^\W\d]\w*)\s*=(?!=)(.*)", re.DOTALL)
#: Titles and lines of known formulas by name. Their points and orbits lie in the ranges of x and y
#: for all values of the parameters.
KNOWN = {
    "pendulum": ("Pendulum", "y; -sin(x) - b*y; x=-7,7; y=-4,4; b=0.2,0,1"),
    "van_der_pol": ("Van der Pol", "y; mu*(1 - x^2)*y - x; x=-5,5; y=-7,7; mu=1,0,4"),
    "lotka_volterra": (
        "Lotka–Volterra",
        "x*(a - b*y); -y*(c - d*x); x=0,4; y=0,3; "
        "a=1,0.6,1.6; b=1,0.6,1.6; c=1,0.6,1.6; d=1,0.6,1.6",
    ),
    "duffing": ("Duffing", "y; x - x^3 - d*y; x=-2,2; y=-1.5,1.5; d=0.2,0,1"),
    "dipole": (
        "Dipole",
        "(x + a)/hypot(x + a, y)^3 - (x - a)/hypot(x - a, y)^3; "
        "y/hypot(x + a, y)^3 - y/hypot(x - a, y)^3; x=-3,3; y=-2,2; a=1,0.1,2",
    ),
    "saddle_node": ("Saddle-node bifurcation", "r + x^2; -y; x=-3,3; y=-2,2; r=-1,-2,2"),
}

#: Known formulas whose points or orbits move with the parameters.
MOVING = ("van_der_pol", "lotka_volterra", "dipole", "saddle_node")


def formula(
    *expressions: Any,
    x: tuple[float, float] | None = None,
    y: tuple[float, float] | None = None,
    u: tuple[float, float] | None = None,
    v: tuple[float, float] | None = None,
    surface: Any = None,
    times: ArrayLike | None = None,
    resolution: int | None = None,
    name: str = "",
    **parameters: Any,
) -> FlowField:
    """Make a flow from a formula.

    Parameters
    ----------
    expressions
        The rates of x and y, such as ``"y", "-sin(x) - b*y"``. On a surface, the rates of u and v,
        or the three components of the velocity along x, y and z, of which the part along the
        surface is drawn. Each is a string, a sympy expression, or a function of NumPy arrays whose
        arguments are some of the names, such as ``lambda x, y: -np.sin(x)``. Or the name of a known
        formula: ``"pendulum"``, ``"van_der_pol"``, ``"lotka_volterra"``, ``"duffing"``,
        ``"dipole"``, ``"saddle_node"``.
    x, y
        Range of the plane to draw, (-5, 5) by default.
    u, v
        Range of the coordinates of a surface.
    surface
        ``"sphere"``, whose u and v are longitude and latitude, ``"torus"``, ``"cylinder"``, or
        three expressions of u and v, the position along x, y and z.
    times
        Times of the steps, (T,), if the formula contains the time ``t``.
    resolution
        Nodes along the longer side of the grid on which the formula is computed: 257, on a surface
        129 by default.
    name
        Name for captions; the expressions by default.
    parameters
        Value of each other name in the expressions; or value, low and high for a slider.

    Returns
    -------
    FlowField
        Its attribute ``formula`` has the expressions, ranges and parameters. Nodes where the
        formula is undefined, such as ``1/x`` at 0, are blank.

    Raises
    ------
    FieldError
        When an expression cannot be read (the text points at the position), or ranges, parameters
        or times are invalid.

    Warns
    -----
    Notice
        When a parameter of a known formula is beyond the range for which its plane is chosen.

    Notes
    -----
    Strings are parsed by a grammar and never run as code. It has ``+ - * / ^`` (or ``**``),
    numbers, names, ``pi`` and ``e``; the functions sin, cos, tan, asin, acos, atan, atan2, sinh,
    cosh, tanh, exp, log (ln), log2, log10, sqrt, abs, sign, floor, ceil, hypot, mod, min and max;
    and ``where(x < 0, a, b)`` with ``<``, ``>``, ``<=``, ``>=``.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.formula("y", "-sin(x) - b*y", x=(-7, 7), y=(-4, 4), b=0.2)
    >>> field.shape
    (147, 257)
    """
    if len(expressions) == 1:
        known = str(expressions[0])
        title, expressions, defaults = _known_formula(expressions[0])
        name = name or title
        usual_x = defaults.pop("x")
        usual_y = defaults.pop("y")
        x = x or usual_x
        y = y or usual_y
        for key in parameters:
            if key not in defaults:
                raise FieldError(f"{title} has no parameter {key!r}; {near_names(key, defaults)}")
        expressions_move = known.replace(" ", "_") in MOVING
        if expressions_move and x == usual_x and y == usual_y:
            _check_ranges(title, parameters, defaults)
        parameters = {**defaults, **parameters}
    steps = None
    moments: Sequence[float] | Floats = [0.0]
    if times is not None:
        steps = _times(times)
        moments = steps
    ranges = {"x": x, "y": y, "u": u, "v": v}
    flow = Formula.of(expressions, surface, ranges, parameters, timed=steps is not None)
    coordinates = flow.coordinates(_grid_shape(flow, resolution))
    velocity = np.stack([flow.velocity(*coordinates, float(t)) for t in moments])
    points = flow.points(*coordinates)
    values = np.concatenate([*velocity, points], axis=-1)
    gaps: Bools = np.isnan(values).any(axis=-1)
    if (gaps[1:, 1:] | gaps[1:, :-1] | gaps[:-1, 1:] | gaps[:-1, :-1]).all():
        raise FieldError(f"{flow.title} has no value in any cell of the grid; choose other ranges")
    title = flow.title
    if len(title) > MOST_TITLE:
        title = title[:MOST_TITLE] + "…"
    periodic = ""
    if flow.surface:
        periodic = _closed(points)
    field = FlowField.from_arrays(
        points, velocity, times=steps, periodic=periodic, name=name or title
    )
    return replace(field, formula=flow)


def _grid_shape(flow: Formula, resolution: int | None) -> tuple[int, int]:
    """Return the number of nodes (J, I); those of a plane are equally far apart along x and y."""
    if resolution is None:
        count = NODES
        if flow.surface:
            count = SURFACE_NODES
    else:
        expected = f"2 to {MOST_NODES:,} nodes"
        count = checked_count("resolution", resolution, 2, MOST_NODES, expected=expected)
    if flow.surface:
        return count, count
    width, height = np.ptp(list(flow.ranges.values()), axis=1).tolist()
    longest = max(width, height)
    fewest = min(count, LEAST_NODES)
    rows = max(round((count - 1) * height / longest) + 1, fewest)
    columns = max(round((count - 1) * width / longest) + 1, fewest)
    return rows, columns


def _known_formula(name: Any) -> tuple[str, tuple[str, ...], dict[str, Any]]:
    """Return the title of a known formula, its expressions, and further arguments by name."""
    if isinstance(name, str):
        key = name.replace(" ", "_")
    else:
        key = ""
    if key not in KNOWN:
        raise FieldError(
            f"only one expression is given, {name!r}, and it is not the name of a known formula; "
            f"{near_names(str(name), KNOWN)}"
        )
    title, line = KNOWN[key]
    expressions, arguments = line_arguments(line)
    return title, tuple(expressions), arguments


def _check_ranges(title: str, given: dict[str, Any], defaults: dict[str, Any]) -> None:
    """Notify if parameters are beyond those for which a plane has been chosen."""
    for name, values in given.items():
        _, low, high = defaults[name]
        try:
            numbers_given = np.asarray(values, dtype=float)
        except (TypeError, ValueError):
            continue  # the formula's own error says what is wrong
        if (numbers_given < low).any() or (numbers_given > high).any():
            notify(
                f"{name} is {values}, beyond {low:g} to {high:g}, for which the plane of {title} "
                "is chosen: points and orbits may lie outside; pass x=(low, high) and y=(low, high)"
            )


def _times(times: ArrayLike) -> Floats:
    """Return times as numbers, (T,), which must be finite and increase."""
    values = checked_array("times", times, expected="times that increase, such as [0, 1, 2]")
    if (
        values.ndim != 1
        or len(values) < 1
        or not np.isfinite(values).all()
        or (np.diff(values) <= 0).any()
    ):
        raise FieldError(f"times is {times!r}; expected times that increase, such as [0, 1, 2]")
    return values


def _closed(points: Floats) -> str:
    """Return the axes whose first and last lines of nodes (J, I) coincide."""
    least = np.ptp(points, axis=(0, 1)).max() * SAME_PLACE
    closed = ""
    if np.abs(points[-1] - points[0]).max() < least:
        closed += "j"
    if np.abs(points[:, -1] - points[:, 0]).max() < least:
        closed += "i"
    return closed


def is_line(text: str) -> bool:
    """Return whether a text is a line, or the name of a known formula."""
    return (";" in text and len(text) <= MOST_LETTERS) or text.replace(" ", "_") in KNOWN


def line_arguments(line: str) -> tuple[list[str], dict[str, Any]]:
    """Return the expressions of a line, and the arguments of :func:`flowtex.formula` by name.

    Raises
    ------
    FieldError
        When numbers or times cannot be read, or a parameter has a reserved name.
    """
    expressions = []
    named = {}
    for part in line.split(";"):
        match = _NAMED.match(part)
        if match is None:
            if part.strip():
                expressions.append(part.strip())
        elif match[1] == "surface":
            named["surface"] = match[2].strip()
        else:
            try:
                values = numbers(1, 2, 3, expected="one to three numbers")(match[2])
            except UnreadableError as error:
                raise FieldError(
                    f"{match[1]} is {match[2].strip()!r}; expected {error} separated by commas"
                ) from error
            if len(values) == 1:
                named[match[1]] = values[0]
            else:
                named[match[1]] = values
    if isinstance(times := named.pop("t", None), tuple) and len(times) == 3:
        first, last, count = times
        named["times"] = np.linspace(first, last, int(min(max(count, 2), MOST_TIMES)))
    elif times is not None:
        raise FieldError(
            "t is the time; expected the first time, the last, and their number, such as t=0,10,41"
        )
    allowed = ("x", "y", "u", "v", "surface", "times")
    for reserved in ("resolution", "name"):
        if reserved in named:
            raise FieldError(
                f"{reserved} cannot be the name of a parameter; expected another name, or one of "
                f"{', '.join(allowed)}"
            )
    return expressions, named


def line_field(line: str) -> FlowField:
    """Return the flow of a line; raises what :func:`flowtex.formula` does."""
    expressions, named = line_arguments(line)
    return formula(*expressions, **named)


def same_formula(first: FlowField, second: FlowField) -> bool:
    """Return whether two flows come from one formula, perhaps with other values of parameters."""
    one = first.formula
    other = second.formula
    if one is None or other is None:
        return False
    return (one.texts, one.ranges) == (other.texts, other.ranges)


def with_parameter(line: str, field: FlowField, name: str, value: float) -> str:
    """Return the line of a flow with another value of a parameter, whose slider stays."""
    if field.formula is None or name not in field.formula.parameters:
        return line
    parameter = field.formula.parameters[name]
    parts = []
    for part in line.split(";"):
        match = _NAMED.match(part)
        if match is None or match[1] != name:
            parts.append(part.strip())
    value = min(max(value, parameter.low), parameter.high)
    parts.append(f"{name}={value!r},{parameter.low!r},{parameter.high!r}")
    return "; ".join(parts)
