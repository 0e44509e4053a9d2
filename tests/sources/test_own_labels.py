"""Colours with labels of pandas or xarray, which are those of the flow in another order."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

pytest.importorskip("xarray")

import pandas as pd
import xarray as xr

from flowtex import FieldError, FlowField
from flowtex.scene.fields import DATA, read_field
from flowtex.scene.options import Options

pytestmark = pytest.mark.filterwarnings("ignore::flowtex.sources.notices.DatasetNotice")


def read(data: Any, colours: Any) -> FlowField:
    return read_field(data, Options.split("field", "appearance", scalars=colours).field)


def coloured() -> dict[str, tuple[Any, Any]]:
    """Return flows of several kinds, and colours with labels in another order: x + 10 y."""
    x, y = np.linspace(0, 3, 13), np.linspace(0, 2, 9)
    across, up = np.meshgrid(x, y)
    parts = (1 + up, 0.3 * across, across + 10 * up)
    u, v, c = (pd.DataFrame(part, y, x) for part in parts)
    a, b, d = (xr.DataArray(part, {"y": y, "x": x}, ("y", "x")) for part in parts)
    rows = pd.DataFrame({"x": across.ravel(), "y": up.ravel()})
    rows = rows.assign(u=parts[0].ravel(), v=parts[1].ravel())
    series = pd.Series(parts[2].ravel())
    points = [pd.Series(np.ravel(part)) for part in (across, up, *parts[:2])]
    pivoted = rows.pivot(index="y", columns="x", values=["u", "v"])
    return {
        "tables": ((u, v), c.iloc[::-1, ::-1]),
        "tables and lines": ((x, y, u, v), c.iloc[::-1]),
        "arrays": ((a, b), d.T),
        "arrays and lines": ((x, y, a, b), d[::-1].T),
        "a dataset": (xr.Dataset({"u": a, "v": b}), d[:, ::-1].T),
        "a dataset and a table": (xr.Dataset({"u": a, "v": b}), c.iloc[::-1]),
        "a dictionary": ({"x": x, "y": y, "u": u, "v": v}, c.iloc[::-1]),
        "rows": (rows, series.sample(frac=1, random_state=0)),
        "points": (tuple(points), series[::-1]),
        "a pivoted table": (pivoted, c.iloc[::-1]),
    }


@pytest.mark.parametrize("kind", coloured())
def test_colours_with_labels_are_in_the_order_of_the_flow(kind: str) -> None:
    data, colours = coloured()[kind]
    field = read(data, colours)
    expected = field.points[..., 0] + 10 * field.points[..., 1]
    assert np.allclose(field.scalars[DATA][0], expected)


@pytest.mark.parametrize("kind", ["tables", "arrays", "rows", "a dataset"])
def test_colours_with_other_labels_are_refused(kind: str) -> None:
    data, colours = coloured()[kind]
    if kind == "rows":
        colours.index = colours.index + 1
    elif kind == "tables":
        colours.columns = colours.columns + 0.5
    else:
        colours = colours.assign_coords(x=colours.x + 0.5)
    with pytest.raises(FieldError, match="and scalars have different labels"):
        read(data, colours)


def test_table_of_colours_beside_plain_arrays_has_their_order() -> None:
    data, _ = coloured()["tables and lines"]
    plain = tuple(map(np.asarray, data))
    _, colours = coloured()["tables and lines"]
    with pytest.raises(FieldError, match="the rows of scalars have the labels 2 to 0"):
        read(plain, colours)
    read(plain, colours.iloc[::-1])
