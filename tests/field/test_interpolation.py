from __future__ import annotations

import numpy as np
import pytest

from flowtex.field.interpolation import along_line, bracket, inverse_along_line, steps_around


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
