"""A flow as one line of text: ``y; -sin(x) - b*y; x=-7,7; b=0.2,0,1``, or ``pendulum; b=0.5``."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from flowtex._util.written import UnreadableError, numbers
from flowtex.errors import FieldError
from flowtex.field.field import FlowField
from flowtex.field.formula.known import KNOWN
from flowtex.field.formula.make import formula

_NAMED = re.compile(r"\s*([^\W\d]\w*)\s*=(?!=)(.*)", re.DOTALL)
#: Most letters of a line, and most steps.
MOST_LETTERS, MOST_TIMES = 4000, 200


def is_line(text: str) -> bool:
    """Return whether a text is a line, or the name of a known formula."""
    return (";" in text and len(text) <= MOST_LETTERS) or text.replace(" ", "_") in KNOWN


def line_arguments(line: str) -> tuple[list[str], dict[str, Any]]:
    """Return the expressions of a line, and the arguments of :func:`flowtex.formula` by name.

    Raises a FieldError when numbers are invalid.
    """
    expressions, named = [], {}
    for part in line.split(";"):
        match = _NAMED.match(part)
        if match is None:
            expressions += [part.strip()] if part.strip() else []
        elif match[1] == "surface":
            named["surface"] = match[2].strip()
        else:
            try:
                values = numbers(1, 2, 3, expected="one to three numbers")(match[2])
            except UnreadableError as error:
                msg = f"{match[1]} is {match[2].strip()!r}; expected {error} separated by commas"
                raise FieldError(msg) from error
            named[match[1]] = values if len(values) > 1 else values[0]
    if isinstance(times := named.pop("t", None), tuple) and len(times) == 3:
        first, last, count = times
        named["times"] = np.linspace(first, last, int(min(max(count, 2), MOST_TIMES)))
    elif times is not None:
        msg = (
            "t is the time; expected the first time, the last, and their number, such as t=0,10,41"
        )
        raise FieldError(msg)
    allowed = ("x", "y", "u", "v", "surface", "times")
    if taken := [n for n in ("resolution", "name") if n in named]:
        msg = (
            f"{taken[0]} cannot be the name of a parameter; expected another name, or one of "
            f"{', '.join(allowed)}"
        )
        raise FieldError(msg)
    return expressions, named


def line_field(line: str) -> FlowField:
    """Return the flow of a line; raises what :func:`flowtex.formula` does."""
    expressions, named = line_arguments(line)
    return formula(*expressions, **named)


def with_parameter(line: str, field: FlowField, name: str, value: float) -> str:
    """Return the line of a flow with another value of a parameter, whose slider stays."""
    if field.formula is None or name not in field.formula.parameters:
        return line
    parameter = field.formula.parameters[name]
    others = [p.strip() for p in line.split(";") if (m := _NAMED.match(p)) is None or m[1] != name]
    value = min(max(value, parameter.low), parameter.high)
    return "; ".join([*others, f"{name}={value!r},{parameter.low!r},{parameter.high!r}"])


def line_python(line: str) -> str:
    """Return the expression of Python that makes the flow of a line."""
    expressions, named = line_arguments(line)
    times = named.pop("times", None)
    inputs = [*map(repr, expressions), *(f"{name}={value!r}" for name, value in named.items())]
    if times is not None:
        inputs.append(f"times=np.linspace({float(times[0])!r}, {float(times[-1])!r}, {len(times)})")
    return f"flowtex.formula({', '.join(inputs)})"
