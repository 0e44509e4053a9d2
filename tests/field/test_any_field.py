"""Whatever is given as a field becomes one of finite numbers, or an error of ours."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from strategies import field_arguments, field_of, property_test

from flowtex import FlowField
from flowtex.field.locate import locate
from flowtex.field.quantities import values_at

PLANE = np.stack(np.meshgrid(np.arange(4.0), np.arange(4.0)), axis=-1)
WIND = np.ones((4, 4, 2))


def check(field: FlowField) -> None:
    """Everything that is computed of a field is finite, and its places are found again."""
    surface = field.surface
    assert np.isfinite([*field.velocity.flat, *field.speed.flat, *surface.tangents.flat]).all()
    assert 0 <= field.normal_share <= 1
    assert np.isfinite(surface.cell_size).all() and (surface.cell_size > 0).all()
    j, i = np.argwhere(surface.cells)[0]
    values = values_at(field, (j + 0.25, i + 0.5))
    assert np.isfinite(values.position).all()
    # Where a corner has no data at the time that is shown, neither may the point have.
    step = int(np.searchsorted(field.times, field.first_time))
    is_known = field.known_nodes(step, step)[j : j + 2, i : i + 2].all()
    is_finite = np.isfinite([*values.velocity, values.speed])
    assert is_finite.all() or (not is_known and not is_finite.any())
    found = locate(field, values.position)
    assert found is None or np.isfinite(found).all()
    assert field.at_step(-1).steady


@property_test(50, fuzz=100)
@given(field_arguments(wild=True))
def test_any_arguments_make_a_field_or_an_error(arguments: dict[str, Any]) -> None:
    field = field_of(arguments)
    if field is not None:
        check(field)


@property_test(50, fuzz=100)
@given(field_arguments())
def test_a_field_is_made_of_finite_numbers(arguments: dict[str, Any]) -> None:
    field = field_of(arguments)
    if field is not None:
        check(field)


def damaged(array: Any, value: float, at: tuple[Any, ...] = (1, 1, 0)) -> Any:
    result = np.array(array, dtype=float)
    result[at] = value
    return result


@pytest.mark.parametrize(
    "arguments",
    [
        # Squares of what stands for missing data.
        {"velocity": damaged(WIND, np.inf, (0, 0, 0)), "sign_free": True},
        {"velocity": damaged(WIND, np.inf), "periodic": "i"},
        {"points": damaged(PLANE, 1e300), "velocity": damaged(WIND, np.nan), "periodic": "i"},
        {"scalars": {"pressure": damaged(PLANE[..., 0], 1e300, (1, 1))}},
        {"valid": damaged(np.ones((4, 4)), np.nan, (1, 1))},
        {"velocity": 1e99 * WIND, "points": 1e-29 * PLANE},
    ],
)
def test_missing_data_is_not_computed_with(arguments: dict[str, Any]) -> None:
    check(FlowField.from_arrays(**{"points": PLANE, "velocity": WIND, **arguments}))


def test_what_was_given_is_neither_changed_nor_kept() -> None:
    given: dict[str, Any] = {
        "points": damaged(PLANE, 1e20),
        "velocity": damaged(np.stack([WIND, WIND]), np.nan, (slice(None), 1, 1, 0)),
        "times": np.array([0.0, 1.0]),
        "valid": np.ones((4, 4), bool),
        "scalars": {"p": damaged(PLANE[..., 0], 1e300, (1, 1))},
    }
    given["scalars"]["q"] = np.ma.masked_array(PLANE[..., 0], PLANE[..., 0] > 1)
    before = {key: np.array(given[key]) for key in ("points", "velocity", "times", "valid")}
    field = FlowField.from_arrays(**given)
    for key, array in before.items():
        np.testing.assert_array_equal(given[key], array)
        assert not np.shares_memory(given[key], getattr(field, key))
    assert given["scalars"]["p"][1, 1] == 1e300
    assert np.isfinite(given["scalars"]["q"].data).all()
    for key, values in field.scalars.items():
        assert not np.shares_memory(given["scalars"][key], values)
    assert np.isnan(field.scalars["p"][0, 1, 1])
    assert np.isnan(field.scalars["q"][0]).sum() == 8
