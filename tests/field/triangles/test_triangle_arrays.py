"""What makes a field of triangles, what is left out, and what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import property_test
from triangle_meshes import random_plane, soup, sphere, surface_of

from flowtex import FlowField
from flowtex._util.progress import Stopped, stoppable
from flowtex.errors import FieldError
from flowtex.field.field_arrays import TriangleArrays
from flowtex.field.triangles.triangle_arguments import READING_PARTS, triangle_nodes
from flowtex.field.validation import in_own_units
from flowtex.scene.fields import MOST_SAMPLED, share_field

SQUARE = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
HALVES = np.array([[0, 1, 2], [0, 2, 3]])
EVEN = np.tile([1.0, 0.5], (4, 1))


def test_a_square_is_a_field() -> None:
    field = FlowField.from_triangles(SQUARE, HALVES, EVEN, name="square", length_unit="m")
    assert repr(field) == "FlowField(square: 4 nodes, 2 triangles, steady, 0 blanked)"
    assert field.points.shape == (1, 4, 3)
    assert field.velocity.shape == (1, 1, 4, 3)
    assert field.speed.shape == (1, 1, 4)
    np.testing.assert_allclose(field.speed, np.hypot(1, 0.5))
    assert field.steady
    with pytest.raises(ValueError, match="no lines of nodes"):
        field.downsample(2)


def test_what_has_no_area_or_is_there_twice_is_left_out() -> None:
    triangles = np.concatenate([HALVES, [[0, 1, 5]], [[2, 1, 0]]])
    points = np.concatenate([SQUARE, [[5.0, 5.0]], [[0.5, 0.0]]])
    velocity = np.concatenate([EVEN, [[9.0, 9]], [[9.0, 9]]])
    with pytest.warns(UserWarning, match="1 without area, 1 there twice"):
        field = FlowField.from_triangles(points, triangles, velocity)
    assert field.shape == (1, 4)  # and the node that no triangle uses
    assert len(surface_of(field).triangles) == 2
    assert field.surface.extent == pytest.approx(np.sqrt(2))


def test_a_needle_without_area_leaves_no_crack() -> None:
    # The diagonal of a square is a sliver, as wide as nothing and as short at one end.
    points = np.concatenate([SQUARE, [[1e-9, 1e-9]]])
    triangles = np.array([[0, 1, 2], [0, 2, 4], [4, 2, 3], [0, 4, 3], [3, 3, 0]])
    field = FlowField.from_triangles(points, triangles, np.concatenate([EVEN, EVEN[:1]]))
    assert field.shape == (1, 4)
    assert (surface_of(field).neighbours >= 0).sum() == 2


def test_nodes_that_are_not_known_blank_their_triangles() -> None:
    velocity = EVEN.copy()
    velocity[3] = np.nan
    field = FlowField.from_triangles(SQUARE, HALVES, velocity)
    assert field.valid.tolist() == [[True, True, True, False]]
    assert field.surface.cells.tolist() == [True, False]
    assert not field.velocity[0, 0, 3].any()
    hidden = np.ma.masked_invalid(velocity)
    assert share_field(field) is share_field(FlowField.from_triangles(SQUARE, HALVES, hidden))
    other = FlowField.from_triangles(SQUARE, HALVES[::-1], velocity)
    assert share_field(other) is other


def test_reading_triangles_can_be_shown_and_cancelled() -> None:
    arrays = TriangleArrays(points=SQUARE, triangles=HALVES, velocity=EVEN)
    reading = triangle_nodes(arrays, in_own_units(arrays, axes=1), on_globe=False)
    assert len(list(reading)) == READING_PARTS
    with pytest.raises(Stopped), stoppable(lambda: True):
        FlowField.from_triangles(SQUARE, HALVES, EVEN)


def test_large_fields_are_shared_only_where_every_value_is_equal() -> None:
    points, triangles = sphere(4)
    velocity = np.cross([0.0, 0.0, 1.0], points)
    shared = share_field(FlowField.from_triangles(points, triangles, velocity))
    # Fields are told apart by a sample first, so one of these nodes is not in it.
    assert velocity.size > 3 * MOST_SAMPLED
    for node in (0, 1, 2, 3):
        changed = velocity.copy()
        changed[node] *= 2
        other = FlowField.from_triangles(points, triangles, changed)
        assert share_field(other) is other
        again = FlowField.from_triangles(points, triangles, changed)
        assert share_field(again) is other
    again = FlowField.from_triangles(points, triangles, velocity)
    assert share_field(again) is shared


def test_nodes_at_one_place_are_one_with_their_mean(rng: np.random.Generator) -> None:
    points, triangles = soup(rng, sphere(2))
    steps = np.stack([np.cross([0.0, 0, 1], points), points * 0 + 1.0])
    field = FlowField.from_triangles(
        points, triangles, steps, scalars={"number": np.arange(len(points), dtype=float)}
    )
    assert field.shape[1] == len(sphere(2)[0])
    np.testing.assert_allclose(field.velocity[0, 0], np.cross([0.0, 0, 1], field.points[0]))
    np.testing.assert_allclose(field.velocity[1, 0], 1)
    # Every corner counts once at the node that it became.
    degree = np.bincount(surface_of(field).triangles.ravel())
    total = float(field.scalars["number"][0, 0] @ degree)
    assert total == pytest.approx(len(points) * (len(points) - 1) / 2)


@property_test(40)
@given(st.integers(0, 10**6))
def test_any_triangles_make_a_field_or_an_error(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points, triangles = random_plane(rng, 40)
    points = points + rng.normal(size=points.shape) * rng.choice([0.0, 0.1])
    points[rng.integers(0, len(points), 3)] = points[0]
    triangles[rng.integers(0, len(triangles), 5)] = rng.integers(0, len(points), (5, 3))
    velocity = rng.normal(size=points.shape)
    velocity[rng.random(len(points)) < 0.1] = np.nan
    velocity *= 10.0 ** rng.integers(-90, 90)
    try:
        field = _quiet(points, triangles, velocity)
    except FieldError as error:
        assert "expected" in str(error) or "check" in str(error)
        return
    surface = surface_of(field)
    for array in (surface.normals, surface.tangents, surface.cell_size, field.speed):
        assert np.isfinite(array).all()
    assert (surface.cell_size > 0).all()
    assert (field.speed[0, 0] <= np.linalg.norm(field.velocity[0, 0], axis=-1) * 1.0001).all()


def _quiet(*arrays: Any) -> FlowField:
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return FlowField.from_triangles(*arrays)


def test_steps_that_are_read_late_stay_so() -> None:
    from flowtex.field.steps import LazySteps

    points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 1.0], [5.0, 5.0]])
    triangles = np.array([[0, 1, 2], [0, 2, 3], [0, 2, 4]])[:2]
    steps = np.arange(3 * 6 * 2, dtype=float).reshape(3, 6, 2)
    steps[:, 1] = np.nan
    read: list[int] = []

    def step(number: int) -> Any:
        read.append(number)
        return steps[number]

    late = FlowField.from_triangles(
        points,
        triangles,
        LazySteps(3, step),
        times=[0.0, 1.0, 2.0],
        scalars={"a": LazySteps(3, lambda n: steps[n, :, 0])},
    )
    # Where the first step has gaps the middle and the last one are looked at.
    assert isinstance(late.velocity, LazySteps) and set(read) == {0, 1, 2}
    early = FlowField.from_triangles(
        points, triangles, steps, times=[0.0, 1.0, 2.0], scalars={"a": steps[..., 0]}
    )
    assert np.array_equal(late.velocity, early.velocity) and late.shape == (1, 4)
    assert np.array_equal(late.valid, early.valid) and not late.valid[0, 1]
    assert np.array_equal(late.scalars["a"], early.scalars["a"], equal_nan=True)
