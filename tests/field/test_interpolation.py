from __future__ import annotations

import numpy as np
import pytest

from flowtex.field.interpolation import (
    along_line,
    between_nodes,
    bracket,
    cell_of,
    cubic_weights,
    fill_blanked,
    inverse_along_line,
    steps_around,
)


def test_a_time_lies_between_two_steps() -> None:
    times = np.array([0.0, 1.0, 3.0])
    assert steps_around(times[:1], 0.0) == (0, 0, 0.0)
    assert steps_around(times, 0.25) == (0, 1, 0.25)
    assert steps_around(times, 1.0) == (1, 2, 0.0)
    assert steps_around(times, 3.0) == (1, 2, 1.0)


def test_a_number_of_the_line_begins_an_interval_or_ends_one() -> None:
    line, values = np.array([0.0, 1.0, 3.0]), np.array([[-1.0, 1.0], [2.0, 4.0]])
    interval, share = bracket(line, values)
    np.testing.assert_array_equal(interval, [[0, 1], [1, 1]])
    np.testing.assert_array_equal(share, [[-1.0, 0.0], [0.5, 1.5]])
    interval, share = bracket(line, values, side="left")
    np.testing.assert_array_equal(interval, [[0, 0], [1, 1]])
    np.testing.assert_array_equal(share, [[-1.0, 1.0], [0.5, 1.5]])


def test_blanked_nodes_take_the_nearest_value(rng: np.random.Generator) -> None:
    data = rng.standard_normal((2, 4, 5, 3))
    known = np.ones((4, 5), bool)
    assert fill_blanked(data, known, 1) is data
    known[:2, 0] = False
    filled = fill_blanked(data, known, 1)
    np.testing.assert_array_equal(filled[:, known], data[:, known])
    np.testing.assert_array_equal(filled[:, 0, 0], data[:, 0, 1])
    np.testing.assert_array_equal(fill_blanked(data[0, ..., 0], known), filled[0, ..., 0])


def test_cells_fractions_and_turns() -> None:
    x = np.array([-0.5, 0.0, 2.25, 4.0, 9.0])
    cell, inside, beyond, turns = cell_of(x, 5, periodic=False)
    np.testing.assert_array_equal(cell, [0, 0, 2, 3, 3])
    np.testing.assert_array_equal(inside, [0, 0, 0.25, 1, 1])
    np.testing.assert_array_equal(beyond, [-0.5, 0, 0, 0, 5])
    assert not turns.any()
    cell, inside, beyond, turns = cell_of(x, 5, periodic=True)
    np.testing.assert_array_equal(cell + inside + 4 * turns, x)
    np.testing.assert_array_equal(turns, [-1, 0, 0, 1, 2])
    assert not beyond.any()


def test_cubic_weights_sum_to_one_and_meet_the_nodes() -> None:
    weights = np.array(cubic_weights(np.linspace(0, 1, 5)))
    np.testing.assert_allclose(weights.sum(axis=0), 1, atol=1e-15)
    np.testing.assert_array_equal(weights[:, 0], [0, 1, 0, 0])
    np.testing.assert_array_equal(weights[:, -1], [0, 0, 1, 0])


def test_values_between_nodes_are_linear_and_constant_beyond() -> None:
    j, i = np.mgrid[:3, :4]
    index = np.array([[1.5, 0.5], [3.0, 2.0], [7.0, 1.0]])
    np.testing.assert_allclose(between_nodes(i + 10 * j, index), [6.5, 23.0, 13.0])


@pytest.mark.parametrize("periodic", [False, True])
def test_a_line_goes_on_beyond_its_ends_and_back(periodic: bool) -> None:
    line = np.array([0.0, 0.1, 0.4, 1.0])
    index = np.array([-1.5, -0.5, 0.0, 1.5, 2.75, 3.5, 7.0])
    values = along_line(line, index, periodic=periodic)
    assert (np.diff(values) > 0).all()
    assert values[3] == pytest.approx(0.25)
    assert values[5] == pytest.approx(1.05 if periodic else 1.3)
    np.testing.assert_allclose(
        inverse_along_line(line, values, periodic=periodic), index, atol=1e-12
    )
