"""Tables and labelled arrays as plain arrays: their labels decide, or an error names them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.field.options import FieldOptions
from flowtex.scene.fields import read_field

pd = pytest.importorskip("pandas")
xr = pytest.importorskip("xarray")
X, Y = np.linspace(0, 3, 9), np.linspace(0, 1, 7)
A, B = np.meshgrid(X, Y)
#: Values that differ at all nodes.
U, V = 1 + A + 10 * B, 3 - A * B


def tables() -> tuple[Any, Any]:
    lines = {"index": pd.Index(Y, name="y"), "columns": pd.Index(X, name="x")}
    return pd.DataFrame(U, **lines), pd.DataFrame(V, **lines)


def arrays() -> tuple[Any, Any]:
    lines = {"y": Y, "x": X}
    return xr.DataArray(U, lines, ("y", "x")), xr.DataArray(V, lines, ("y", "x"))


def check(field: FlowField) -> None:
    """Compare a field with the values at all nodes, in any order."""
    points = field.points.reshape(-1, 3)
    order = np.lexsort((points[:, 0], points[:, 1]))
    assert np.allclose(points[order, 0], A.ravel())
    assert np.allclose(points[order, 1], B.ravel())
    velocity: Floats = np.asarray(field.velocity[0]).reshape(-1, 3)[order]
    assert np.allclose(velocity[:, 0], U.ravel())
    assert np.allclose(velocity[:, 1], V.ravel())


def drawn(*data: Any) -> FlowField:
    return read_field(data, FieldOptions())


def named(u: Any, v: Any) -> FlowField:
    return read_field({"x": X, "y": Y, "u": u, "v": v}, FieldOptions())


CALLS: dict[str, Callable[[Any, Any], FlowField]] = {
    "from_arrays(u, v)": FlowField.from_arrays,
    "from_arrays(x, y, u, v)": lambda u, v: FlowField.from_arrays(X, Y, u, v),
    "show(u, v)": drawn,
    "show(x, y, u, v)": lambda u, v: drawn(X, Y, u, v),
    "show(dictionary)": named,
}
ORDERS: dict[str, Callable[[Any], Any]] = {
    "the same": lambda v: v,
    "reversed": lambda v: v.iloc[::-1, ::-1],
    "shuffled": lambda v: v.sample(frac=1, random_state=1),
}


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("order", ORDERS)
def test_labels_of_tables_decide(call: str, order: str) -> None:
    u, v = tables()
    check(CALLS[call](u, ORDERS[order](v)))


@pytest.mark.parametrize("call", ["from_arrays(x, y, u, v)", "show(u, v)", "show(dictionary)"])
def test_dimensions_of_arrays_decide(call: str) -> None:
    u, v = arrays()
    for other in (v, v[::-1, ::-1], v.T, v.T[::-1]):
        check(CALLS[call](u, other))


def test_rows_of_series_are_matched() -> None:
    rows = pd.DataFrame({"x": A.ravel(), "y": B.ravel(), "u": U.ravel(), "v": V.ravel()})
    v = rows.v.sample(frac=1, random_state=1)
    check(drawn(rows.x, rows.y, rows.u, v))
    check(read_field({"x": rows.x, "y": rows.y, "u": rows.u, "v": v}, FieldOptions()))


@pytest.mark.parametrize(
    "call", ["from_arrays(u, v)", "from_arrays(x, y, u, v)", "show(x, y, u, v)", "show(dictionary)"]
)
def test_other_labels_are_refused(call: str) -> None:
    u, v = tables()
    for other in (v.T, v.iloc[1:], v.set_axis(Y + 0.01, axis=0)):
        with pytest.raises(FieldError, match=r"have different labels, 0\.0 to 1\.0"):
            CALLS[call](u, other)


def test_labels_in_another_order_than_the_positions_are_refused() -> None:
    u, v = tables()
    with pytest.raises(FieldError, match="columns of u have the labels 3 to 0, and the positions"):
        FlowField.from_arrays(X, Y, u.iloc[:, ::-1], v.iloc[:, ::-1])


def test_coordinates_are_not_ignored() -> None:
    with pytest.raises(FieldError, match="the coordinates y, x, which from_arrays does not read"):
        FlowField.from_arrays(*arrays())
    check(FlowField.from_xarray([array.rename(n) for n, array in zip("uv", arrays(), strict=True)]))


def test_numbered_tables_are_counted() -> None:
    field = FlowField.from_arrays(pd.DataFrame(U), pd.DataFrame(V))
    assert np.array_equal(field.points[0, :, 0], np.arange(9.0))
