"""``flowtex formula``: a flow from a formula."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from cyclopts import Parameter

from flowtex._util.written import UnreadableError, numbers
from flowtex.cli.console import check_page_file, check_picture_file, describe, drawing, say, writing
from flowtex.cli.options import FLAT, FLOW, FrameFlags, LookFlags, SettingFlags, UsageError, pixels
from flowtex.cli.write import write_picture
from flowtex.errors import FieldError
from flowtex.field import FlowField

#: Patterns in messages for Python, and their forms for a shell.
_IN_SHELL = (
    (r"its value, as in (\w+)=1", r"its value, as in --set \1=1"),
    (r"times=, such as times=np\.linspace\(0, 10, 41\)", "--times 0,10,41"),
    (r"^(x|y|u|v|surface|times|resolution) is", r"--\1 is"),
    (r"^(\w+) is (.*value, low)", r"--set \1 is \2"),
    (r"such as \(([^)]*), ([^),]*)\)", r"such as \1,\2"),
)


def _flag(text: str) -> Parameter:
    return Parameter(group=FLOW, help=text, allow_leading_hyphen=True)


_RANGE = "Range of the coordinate, such as -7,7."


def formula(
    *expressions: Annotated[
        str,
        Parameter(
            allow_leading_hyphen=True,
            help=(
                "The rates of x and y, such as y and -sin(x); on a surface the rates of u and v, "
                "or the velocity along x, y and z. Or the name of a known formula, such as "
                "pendulum."
            ),
        ),
    ],
    output: Annotated[
        Path | None, Parameter(name=["--output", "-o"], help="Page (.html) or picture to write.")
    ] = None,
    x: Annotated[str | None, _flag(_RANGE)] = None,
    y: Annotated[str | None, _flag(_RANGE)] = None,
    u: Annotated[str | None, _flag(_RANGE)] = None,
    v: Annotated[str | None, _flag(_RANGE)] = None,
    set: Annotated[
        tuple[str, ...],
        Parameter(
            group=FLOW,
            negative=(),
            help="A parameter: b=0.2, or with the range of its slider b=0.2,0,1.",
        ),
    ] = (),
    surface: Annotated[
        str | None,
        _flag(
            "sphere, torus, cylinder, or x, y and z as expressions in u and v, separated by "
            "semicolons."
        ),
    ] = None,
    times: Annotated[str | None, _flag("First and last time, and their number: 0,10,41.")] = None,
    resolution: Annotated[
        int | None, Parameter(group=FLOW, help="Nodes along the longer side.")
    ] = None,
    look: Annotated[LookFlags | None, FLAT] = None,
    frame: Annotated[FrameFlags | None, FLAT] = None,
    settings: Annotated[SettingFlags | None, FLAT] = None,
) -> int:
    """Draw a flow from a formula: as a page, as a picture, or in a window."""
    options, frame = drawing(look, settings), frame or FrameFlags()
    is_page = output is not None and output.suffix.lower() in (".html", ".htm")
    if output is not None:
        (check_page_file if is_page else check_picture_file)(output)
    ranges = {"x": x, "y": y, "u": u, "v": v}
    choice: dict[str, Any] = {n: _numbers(n, text, 2) for n, text in ranges.items() if text}
    for text in set:
        name, equals, value = text.partition("=")
        if not equals or not name.isidentifier() or name in ("surface", "times", *ranges):
            msg = f"--set is {text!r}; expected a parameter and its value, such as b=0.2"
            raise UsageError(msg)
        ends = _numbers(f"set {name}", value, 1, 3)
        choice[name] = ends if len(ends) > 1 else ends[0]
    if surface:
        choice["surface"] = tuple(surface.split(";")) if ";" in surface else surface
    if times:
        first, last, count = _numbers("times", times, 3)
        choice["times"] = np.linspace(first, last, int(min(max(count, 1), 10_000)))
    if resolution is not None:
        choice["resolution"] = resolution
    field = _field(expressions, choice)
    if output is None:
        from flowtex import show

        show(field, size=pixels(frame.size), **options)
        return 0
    if is_page:
        from flowtex import export

        with writing(output):
            size = export(field, output, **options).nbytes
        result = f"{size / 1e6:.2f} MB"
    else:
        from flowtex import render

        frames = {**vars(frame), "size": pixels(frame.size)}
        write_picture(render(field, **options, **frames), output)
        result = frame.size
    say((str(output), "bold"), f"  {describe(field)}  ", (result, "dim"))
    return 0


def _numbers(name: str, text: str, *counts: int) -> tuple[float, ...]:
    expected = f"{' or '.join(map(str, counts))} numbers separated by commas"
    try:
        return numbers(*counts, expected=expected)(text)
    except UnreadableError as error:
        msg = f"--{name} is {text!r}; expected {error}"
        raise UsageError(msg) from error


def _field(expressions: tuple[str, ...], choice: dict[str, Any]) -> FlowField:
    from flowtex.field.formula.make import formula as make

    try:
        return make(*expressions, **choice)
    except FieldError as error:
        for flag in (text for text in expressions if re.fullmatch(r"--[A-Za-z]\w*(=.*)?", text)):
            name = flag[2:].partition("=")[0]
            msg = f"formula has no option {flag}; a parameter is set by --set {name}=1"
            raise UsageError(msg) from error
        text = str(error)
        for before, after in _IN_SHELL:
            text = re.sub(before, after, text)
        raise UsageError(text) from error
