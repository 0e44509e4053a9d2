"""Arrays in the forms of ``plt.streamplot`` and ``plt.quiver``, against an analytic flow."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from flowtex import FieldError, FlowField
from flowtex._util.array_types import AnyArray, Floats

LINE_X, LINE_Y = np.linspace(-1, 1, 8), np.linspace(-2, 2, 11) ** 3
X, Y = np.meshgrid(LINE_X, LINE_Y)
SHAPE = X.shape


def flow(x: Any, y: Any) -> tuple[Floats, Floats]:
    return 1 - y + 0.3 * x, 2 * x + 0.1 * y


U, V = flow(X, Y)
BOTH = np.stack([U, V], axis=-1)
LATER = 1 + np.arange(4.0)[:, None, None]


class Exported:
    """An array that gives its values by DLPack alone, as some libraries do."""

    def __init__(self, values: AnyArray) -> None:
        self._values = np.ascontiguousarray(values)

    def __dlpack__(self, **options: Any) -> Any:
        return self._values.__dlpack__(**options)

    def __dlpack_device__(self) -> Any:
        return self._values.__dlpack_device__()


class OnCard(Exported):
    """An array of a graphics card, which refuses an implicit copy, as those of CuPy."""

    def __array__(self, *_: Any, **__: Any) -> AnyArray:
        raise TypeError("Implicit conversion to a NumPy array is not allowed")


class WithGradient:
    """A tensor that must be detached first, as those of PyTorch."""

    def __init__(self, values: AnyArray) -> None:
        self._values = values

    def detach(self) -> AnyArray:
        return self._values

    def __array__(self, *_: Any, **__: Any) -> AnyArray:
        raise RuntimeError("Can't call numpy() on Tensor that requires grad.")


class Quantity:
    """Values with a unit, as those of pint and astropy."""

    def __init__(self, magnitude: AnyArray, units: str) -> None:
        self.magnitude, self.units = magnitude, units

    def __array__(self, *_: Any, **__: Any) -> AnyArray:
        raise AssertionError("the unit would be lost")


FORMS: dict[str, tuple[Any, ...]] = {
    "lines": (LINE_X, LINE_Y, U, V),
    "nodes": (X, Y, U, V),
    "nodes by columns": (X.T, Y.T, U.T, V.T),
    "rows from above": (LINE_X, LINE_Y[::-1], U[::-1], V[::-1]),
    "columns from the right": (LINE_X[::-1], LINE_Y, U[:, ::-1], V[:, ::-1]),
    "sparse nodes": (LINE_X[None], LINE_Y[:, None], U, V),
    "a line and nodes": (LINE_X, Y, U, V),
    "complex": (LINE_X, LINE_Y, U + 1j * V),
    "complex places": (X + 1j * Y, U + 1j * V),
    "components last": (LINE_X, LINE_Y, BOTH),
    "components first": (LINE_X, LINE_Y, np.stack([U, V])),
    "places in a tuple": ((LINE_X, LINE_Y), np.stack([U, V])),
    "lists": (LINE_X.tolist(), LINE_Y.tolist(), U.tolist(), V.tolist()),
    "DLPack": tuple(map(Exported, (LINE_X, LINE_Y, U, V))),
    "graphics card": tuple(map(OnCard, (LINE_X, LINE_Y, U, V))),
    "tensors with a gradient": tuple(map(WithGradient, (LINE_X, LINE_Y, U, V))),
    "surface in space": (X, Y, 0 * X, U, V, 0 * U),
}


@pytest.mark.parametrize("arrays", FORMS.values(), ids=FORMS)
def test_each_form_has_the_flow_at_every_node(arrays: tuple[Any, ...]) -> None:
    field = FlowField.from_arrays(*arrays)
    assert sorted(field.shape) == sorted(SHAPE)
    x, y, _ = np.moveaxis(field.points, -1, 0)
    np.testing.assert_allclose(field.velocity[0][..., :2], np.stack(flow(x, y), -1), atol=1e-12)
    # The sign of what is derived follows from positions, not from the order of rows.
    inside = field.with_derived("vorticity").scalars["vorticity"][0][2:-2, 2:-2]
    np.testing.assert_allclose(inside, 3, atol=1e-9)


@pytest.mark.parametrize(
    "arrays",
    [
        (LINE_X, LINE_Y, LATER * U, LATER * V),
        (LINE_X, LINE_Y, LATER * U + 1j * LATER * V),
        (LINE_X, LINE_Y, LATER[..., None] * BOTH),
        (LINE_X, LINE_Y, np.stack([LATER * U, LATER * V])),
        (LINE_X, LINE_Y, np.stack([LATER * U, LATER * V], axis=1)),
    ],
)
def test_series_have_their_steps(arrays: tuple[Any, ...]) -> None:
    field = FlowField.from_arrays(*arrays, times=[0, 1, 2, 5])
    assert field.times.tolist() == [0, 1, 2, 5]
    for step, factor in enumerate(LATER.ravel()):
        np.testing.assert_allclose(field.velocity[step][..., :2], factor * BOTH)


def test_arrays_without_positions_count_their_nodes() -> None:
    for arrays in ((U, V), (BOTH,), (U + 1j * V,), (np.stack([U, V]),)):
        field = FlowField.from_arrays(*arrays)
        assert field.shape == SHAPE
        assert field.points[4, 3].tolist() == [3, 4, 0]
        assert field.velocity[0, 4, 3, :2].tolist() == BOTH[4, 3].tolist()


def test_masked_nodes_are_not_valid() -> None:
    hidden = X > 0.5
    field = FlowField.from_arrays(LINE_X, LINE_Y, np.ma.masked_where(hidden, U), V)
    assert np.array_equal(field.valid, ~hidden)
    both = np.ma.masked_where(hidden, U + 1j * V)
    assert np.array_equal(FlowField.from_arrays(LINE_X, LINE_Y, both).valid, ~hidden)


def test_quantities_keep_their_units() -> None:
    pytest.importorskip("pint")
    pytest.importorskip("cf_xarray")
    x, y = Quantity(LINE_X, "kilometer"), Quantity(1000 * LINE_Y, "meter")
    u, v = Quantity(U, "meter / second"), Quantity(3.6 * V, "kilometer / hour")
    times = Quantity(np.array([0.0, 2.0]), "hour")
    series = [Quantity(np.stack([part.magnitude] * 2), part.units) for part in (u, v)]
    field = FlowField.from_arrays(x, y, *series, times=times)
    assert (field.length_unit, field.velocity_unit, field.time_unit) == ("km", "m/s", "h")
    np.testing.assert_allclose(field.points[..., 1], Y)
    np.testing.assert_allclose(field.speed[0], np.hypot(U, V))
    np.testing.assert_allclose(field.velocity[0][..., :2], 3.6 * BOTH)  # km/h
    with pytest.raises(FieldError, match="v is in 'kilometer', which cannot be converted"):
        FlowField.from_arrays(x, y, u, Quantity(V, "kilometer"))


FAULTS: dict[str, tuple[Callable[[], Any], str]] = {
    "columns before rows": (
        lambda: FlowField.from_arrays(LINE_X, LINE_Y, U.T, V.T),
        r"u has shape \(8, 11\), .* \(11, 8\) nodes; .* np.swapaxes\(u, -1, -2\)",
    ),
    "columns before rows in one array": (
        lambda: FlowField.from_arrays(LINE_X, LINE_Y, np.stack([U.T, V.T])),
        r"velocity has shape \(2, 8, 11\), .*np.swapaxes\(velocity, -1, -2\)",
    ),
    "two axes of two": (
        lambda: FlowField.from_arrays(np.ones((2, 2, 3))),
        r"\(2, 2, 3\), and its components may lie along axis 0 or 2; pass them as two arrays",
    ),
    "one component": (
        lambda: FlowField.from_arrays(LINE_X, LINE_Y, U),
        r"velocity has shape \(11, 8\), .*both components: u, v or u \+ 1j \* v; colours",
    ),
    "colours": (
        lambda: FlowField.from_arrays(LINE_X, LINE_Y, U, V, U),
        r"5 arrays are given, of the shapes \(8,\), \(11,\), .* the argument scalars",
    ),
    "shapes that differ": (
        lambda: FlowField.from_arrays(LINE_X, LINE_Y, U, V[1:]),
        r"the components have the shapes \(11, 8\), \(10, 8\); expected one shape",
    ),
    "complex components": (
        lambda: FlowField.from_arrays(LINE_X, LINE_Y, 1j * U, 1j * V),
        r"the shapes .*; complex u \+ iv is one array",
    ),
    "positions of two shapes": (
        lambda: FlowField.from_arrays(X, Y[1:], U, V),
        r"the positions have the shapes \(11, 8\), \(10, 8\); expected x \(I,\) and y \(J,\)",
    ),
    "scattered points": (
        lambda: FlowField.from_arrays(X.ravel(), Y.ravel(), U.ravel(), V.ravel()),
        r"shapes \(88,\), \(88,\), \(88, 2\), as of scattered points; .* flowtex.show\(x, y, u, v",
    ),
    "unsorted": (
        lambda: FlowField.from_arrays(np.roll(LINE_X, 3), LINE_Y, U, V),
        r"x increases and decreases; .* np.argsort\(x\)",
    ),
}


@pytest.mark.parametrize(("call", "words"), FAULTS.values(), ids=FAULTS)
def test_an_error_names_shapes_and_the_remedy(call: Callable[[], Any], words: str) -> None:
    with pytest.raises(FieldError, match=words):
        call()


def test_an_array_that_cannot_be_copied_is_named() -> None:
    class Locked(OnCard):
        def __dlpack__(self, **_: Any) -> Any:
            raise BufferError("the device is lost")

    words = r"v is an array that NumPy cannot read \(the device is lost\); .* v.cpu\(\)"
    with pytest.raises(FieldError, match=words):
        FlowField.from_arrays(LINE_X, LINE_Y, U, Locked(V))
