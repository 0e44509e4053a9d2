"""Nodes that have data at some times only."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial import Delaunay

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.field.steps import LazySteps
from flowtex.field.validation import NO_DATA
from flowtex.scene.scene import Scene

X, Y = np.meshgrid(np.linspace(0, 3, 30), np.linspace(0, 2, 20))
TRIANGLES = np.array([[0, 1, 2], [1, 3, 2]])
CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
#: Where no step, and where the second one, has data.
NEVER, NOT_NOW = (slice(0, 3), slice(0, 4)), (slice(8, 13), slice(10, 20))


def gappy() -> Floats:
    """A uniform flow (3, J, I, 2); only one component is missing at some nodes."""
    velocity = np.broadcast_to([3.0, 4.0], (3, *X.shape, 2)).copy()
    velocity[:, *NEVER] = np.nan
    velocity[1, *NOT_NOW, 0] = np.nan
    return velocity


def late(velocity: Floats) -> LazySteps:
    return LazySteps(len(velocity), lambda number: velocity[number])


@pytest.mark.parametrize("given", [np.array, late, lambda v: np.ma.masked_invalid(v)])
def test_they_are_at_rest_without_a_direction_meanwhile(given: Any) -> None:
    field = FlowField.from_arrays((X, Y), given(gappy()), length_unit="m", time_unit="s")
    never, now = np.zeros((2, *X.shape), dtype=bool)
    never[NEVER] = now[NOT_NOW] = True
    np.testing.assert_array_equal(field.valid, ~never)
    assert field.uncertainty == NO_DATA
    assert field.unit_of("speed") == "m/s"
    for step in range(3):
        lacks = now & (step == 1)
        moving = np.asarray(field.velocity[step])[..., :2]
        np.testing.assert_array_equal(moving[lacks], 0)  # both components
        np.testing.assert_array_equal(moving[~lacks & ~never] - [3, 4], 0)
        np.testing.assert_array_equal(field.scalars[NO_DATA][step] == 1, lacks | never)
        np.testing.assert_array_equal(np.isnan(field.scalars["speed"][step]), lacks | never)
        np.testing.assert_array_equal(field.scalars["speed"][step][~lacks & ~never], 5)


@pytest.mark.parametrize("given", [np.array, late])
def test_triangles_do_as_grids(given: Any) -> None:
    velocity = np.ones((2, 4, 2))
    velocity[0, 3] = np.nan
    field = FlowField.from_triangles(CORNERS, TRIANGLES, given(velocity))
    assert field.valid.all() and field.uncertainty == NO_DATA
    assert not field.velocity[0, 0, 3].any() and field.velocity[1, 0, 3].any()
    np.testing.assert_array_equal(field.scalars[NO_DATA][0], [[0, 0, 0, 1]])


def test_what_is_given_goes_first() -> None:
    speed = np.full(X.shape, 7.0)
    scalars, units = {"speed": speed, "a": speed}, {"speed": "kn"}
    field = FlowField.from_arrays((X, Y), gappy(), scalars=scalars, units=units)
    assert list(field.scalars) == ["speed", "a", NO_DATA] and field.unit_of("speed") == "kn"
    np.testing.assert_array_equal(field.scalars["speed"][0], speed)


@pytest.mark.parametrize(
    "velocity", [gappy()[0], gappy()[[0, 2]], late(gappy()[:1]), np.ones((2, *X.shape, 3))]
)
def test_a_field_without_them_stays_as_it_is(velocity: Any) -> None:
    field = FlowField.from_arrays((X, Y), velocity)
    assert not field.scalars and not field.uncertainty


def test_a_value_beside_a_step_without_is_that_of_the_nearer_step() -> None:
    scene = Scene(FlowField.from_arrays((X, Y), gappy()))
    for time, lacks in ((0.0, False), (0.4, False), (0.6, True), (1.0, True), (2.0, False)):
        scene.time = time
        assert np.isnan(scene.scalar("speed")[NOT_NOW]).all() == lacks
        assert (scene.scalar("speed")[15:] == 5).all()


@pytest.mark.parametrize("is_mesh", [False, True])
def test_gaps_of_a_step_that_is_read_late_have_no_values(*, is_mesh: bool) -> None:
    velocity = np.broadcast_to([3.0, 4.0], (9, *X.shape, 2)).copy()
    velocity[5, *NOT_NOW] = np.nan  # neither the first, the middle nor the last step
    nodes = np.stack([X, Y], axis=-1)
    field = FlowField.from_arrays(nodes, late(velocity))
    if is_mesh:
        corners = Delaunay(nodes.reshape(-1, 2)).simplices
        field = FlowField.from_triangles(
            nodes.reshape(-1, 2), corners, late(velocity.reshape(9, -1, 2))
        )
    lacks = np.zeros(X.shape, dtype=bool)
    lacks[NOT_NOW] = True
    assert np.isnan(np.asarray(field.scalars["speed"][5]).reshape(X.shape)[lacks]).all()
    vorticity = np.asarray(field.derive("vorticity")[5]).reshape(X.shape)
    assert np.isnan(vorticity[lacks]).all()
    assert np.nanmax(np.abs(vorticity)) < 1e-9  # also beside the gap
    place = float(X[10, 15]), float(Y[10, 15])
    speeds = []
    for time in (4.0, 4.4, 4.6, 5.0, 5.6, 8.0):
        values = field.at(*place, time=time)
        assert values is not None
        speeds.append(values.speed)
    np.testing.assert_allclose(speeds, [5, 5, np.nan, np.nan, 5, 5])
    scene = Scene(field)
    found = []
    for time in (4.0, 5.0, 6.0):
        scene.time = time
        found.append(scene.lacks_values)
    assert found == [False, True, False]
