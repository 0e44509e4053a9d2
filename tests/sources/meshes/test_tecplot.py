"""Text files of Tecplot under all their endings, and those whose zones lack numbers."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from flowtex import FieldError, FlowField

X, Y = np.meshgrid(np.linspace(0, 2, 9), np.linspace(10, 13, 7))
U, V = 1 + 0.3 * X + 0.1 * Y, 0.2 * X - 0.5 * (Y - 11)
#: One value of a cell, by its column and row.
PRESSURE = np.add.outer(np.arange(6.0), 10 * np.arange(8.0))


def numbers(values: Any) -> str:
    return "\n".join(" ".join(f"{value:.9g}" for value in row) for row in np.atleast_2d(values))


def points() -> str:
    """A zone of points, whose title looks like a count."""
    head = 'TITLE = "flow"\nVARIABLES = "X" "Y"\n"U"\n"V"\nZONE T="I=3", I=9, J=7, F=POINT\n'
    columns = [X.ravel(), Y.ravel(), U.ravel(), V.ravel()]
    return head + numbers(np.stack(columns, axis=-1)) + "\n"


def blocks() -> str:
    """A zone of blocks with a comment, bare names, and a variable on cells."""
    head = "# made by a solver\nvariables = x, y, u, v, p\nzone i=9 j=7 datapacking=block\n"
    head += "varlocation=([5]=cellcentered)\n"
    return head + "\n".join(map(numbers, (X, Y, U, V, PRESSURE))) + "\n"


def elements() -> str:
    """Triangles of the grid."""
    first = (np.arange(6)[:, None] * 9 + np.arange(8)).ravel() + 1
    lower = np.stack([first, first + 1, first + 10], axis=-1)
    upper = np.stack([first, first + 10, first + 9], axis=-1)
    corners = np.concatenate([lower, upper])
    head = 'VARIABLES = "x", "y", "u", "v"\nZONE N=63, E=96, F=FEPOINT, ET=TRIANGLE\n'
    columns = [X.ravel(), Y.ravel(), U.ravel(), V.ravel()]
    return head + numbers(np.stack(columns, axis=-1)) + "\n" + numbers(corners) + "\n"


def described() -> str:
    """Points below records of a title and of remarks, and a value that is no number at each end."""
    remarks = 'TITLE = "of the flow"\nDATASETAUXDATA Solver = "a = 1"\n'
    text = points().replace("ZONE", f"{remarks}ZONE").replace('"V"\n', '"V"\n"P"\n')
    head, _, rows = text.partition("F=POINT\n")
    lines = [f"{row} NaN" for row in rows.splitlines()]
    return f"{head}F=POINT\n" + "\n".join(lines) + "\n"


def unquoted() -> str:
    """Blocks whose names are followed by a record, and with lines that begin without a number."""
    head = 'VARIABLES = p, x, y, u, v\nTITLE = "a flow"\nZONE I=9 J=7 F=BLOCK\n'
    missing = "0" + 62 * "\nNaN"
    return head + "\n".join([missing, *map(numbers, (X, Y, U, V))]) + "\n"


FORMS: dict[str, Callable[[], str]] = {
    "points": points,
    "blocks": blocks,
    "elements": elements,
    "described": described,
    "unquoted": unquoted,
}


@pytest.mark.parametrize("ending", [".dat", ".tec", ".tp", ".plt"])
@pytest.mark.parametrize("form", FORMS)
def test_text_is_read_under_any_ending(form: str, ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"flow{ending}"
    path.write_text(FORMS[form]())
    field = FlowField.from_file(path)
    x, y, _ = np.moveaxis(field.points, -1, 0)
    assert x.size == X.size
    assert (x.min(), x.max(), y.min(), y.max()) == (0, 2, 10, 13)
    expected = np.stack([1 + 0.3 * x + 0.1 * y, 0.2 * x - 0.5 * (y - 11)], axis=-1)
    np.testing.assert_allclose(field.velocity[0][..., :2], expected, atol=1e-6)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("share", [0.3, 0.7, 0.97])
def test_zone_with_fewer_numbers_raises(form: str, share: float, tmp_path: Path) -> None:
    text = FORMS[form]()
    path = tmp_path / "flow.dat"
    path.write_text(text[: int(share * len(text))])
    with pytest.raises(FieldError, match=r"zone 1 declares \d+ values, but the file has"):
        FlowField.from_file(path)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("I=9,", "I=-9,", "zone 1 declares I = -9; expected 1 or more"),
        ("I=9,", "I=900000000, K=900000000,", "zone 1 declares .* values, but the file has"),
        ("I=9,", "I=8,", r"more than the 224 values that its header and 4 variables declare"),
        ("F=POINT", "F=POINT, VARSHARELIST=([1,2]=1)", "lie in another zone .VARSHARELIST."),
        ("ZONE", "ZONEDATA", "the file has no zone"),
        ("VARIABLES", "NAMES", "the file names no variables"),
        ("I=9, J=7", "N=63, E=96, ET=POLYGON", "cells of the type POLYGON.*expected LINESEG"),
    ],
)
def test_header_that_does_not_fit_raises(old: str, new: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "flow.tec"
    path.write_text(points().replace(old, new))
    with pytest.raises(FieldError, match=message):
        FlowField.from_file(path)


def test_several_zones_are_blocks(tmp_path: Path) -> None:
    path = tmp_path / "flow.tec"
    zone = points()[points().index("ZONE") :]
    path.write_text(points() + zone.replace("I=3", "second"))
    with pytest.raises(FieldError, match="second"):
        FlowField.from_file(path, block="third")
