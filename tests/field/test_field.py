"""Arrays become a field, or one error that says all that is wrong with them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from flowtex import FlowField
from flowtex.errors import FieldError

Floats = NDArray[np.float64]


def flat(rows: int = 5, columns: int = 7, size: float = 1.0) -> Floats:
    """Nodes of a plain rectangle with cells of one size, (J, I, 3)."""
    x, y = np.meshgrid(np.arange(columns) * size, np.arange(rows) * size)
    return np.stack([x, y, np.zeros_like(x)], axis=-1)


def ring(lines: int, *, last: bool, columns: int = 4) -> Floats:
    """Nodes around a ring along j, with or without the line that closes it, (J, I, 3)."""
    angle = np.linspace(0, 2 * np.pi, lines, endpoint=last)[:, None]
    radius = np.linspace(1.0, 2.0, columns)[None]
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    return np.stack([x, y, np.zeros_like(x)], axis=-1)


def ones(points: NDArray[Any], *steps: int) -> Floats:
    return np.ones((*steps, *points.shape))


# --- form -----------------------------------------------------------------------------------


def test_a_series_keeps_its_times() -> None:
    field = FlowField.from_arrays(flat(), ones(flat(), 3), times=[0.5, 1.0, 4.0])
    assert field.times.tolist() == [0.5, 1.0, 4.0]
    assert not field.steady
    assert FlowField.from_arrays(flat(), ones(flat(), 3)).times.tolist() == [0.0, 1.0, 2.0]


@pytest.mark.parametrize("unit", ["h", "ns"])
def test_dates_are_seconds_since_the_first(unit: str) -> None:
    dates = np.array(["2002-01-01T00", "2002-01-01T06"], dtype=f"datetime64[{unit}]")
    points, velocity = np.moveaxis(np.indices((4, 5)), 0, -1), np.ones((2, 4, 5, 2))
    for times in (dates, dates.tolist() if unit == "h" else dates, dates - dates[0]):
        field = FlowField.from_arrays(points, velocity, times=times)
        assert field.times.tolist() == [0.0, 21600.0]
        assert field.time_unit == "s"
    with pytest.raises(FieldError, match=r"^time_unit is 'd', but the times are dates"):
        FlowField.from_arrays(points, velocity, times=dates, time_unit="d")
    months = np.array(["2002-01", "2002-02"], dtype="datetime64[M]")
    field = FlowField.from_arrays(points, velocity, times=months)
    assert field.times.tolist() == [0.0, 31 * 86400.0]
    dates[1] = np.array("NaT", dates.dtype)
    with pytest.raises(FieldError, match=r"times\[1\] is nan; expected a finite number"):
        FlowField.from_arrays(points, velocity, times=dates)


def test_scalars_get_an_axis_of_time() -> None:
    scalars = {"p": np.ones((5, 7)), "q": np.ones((3, 5, 7)), "valid": np.ones((3, 5, 7))}
    field = FlowField.from_arrays(flat(), ones(flat(), 3), scalars=scalars)
    assert {k: s.shape[0] for k, s in field.scalars.items()} == {"p": 1, "q": 3, "valid": 3}
    field = FlowField.from_arrays(flat(), ones(flat()), scalars={"p": np.ones((1, 5, 7))})
    assert field.scalars["p"].shape == (1, 5, 7)


# --- what does not count --------------------------------------------------------------------


@pytest.mark.parametrize("where", ["velocity", "points", "mask of velocity", "mask of points"])
def test_nan_and_masks_blank_a_node(where: str) -> None:
    points, velocity = flat(), ones(flat())
    arrays: dict[str, Any] = {"points": points, "velocity": velocity}
    name = where.split()[-1]
    if where.startswith("mask"):
        mask = np.zeros(arrays[name].shape, bool)
        mask[1, 2, 0] = True
        arrays[name] = np.ma.masked_array(arrays[name], mask)
    else:
        arrays[name][1, 2, 1] = np.nan
    field = FlowField.from_arrays(**arrays)
    assert np.argwhere(~field.valid).tolist() == [[1, 2]]
    assert np.isfinite(field.velocity).all()
    assert np.isfinite(field.points).all()
    assert not field.velocity[0, 1, 2].any()


def test_velocity_of_zero_everywhere_warns_at_the_callers_line() -> None:
    with pytest.warns(
        UserWarning,
        match=(
            "^The velocity is zero at every node, so the picture shows no flow; check the "
            "selected array and its region. On a wall draw the wall shear stress, such as "
            "wallShearStress.$"
        ),
    ) as told:
        FlowField.from_arrays(flat(), 0 * ones(flat()))
    assert [warning.filename for warning in told] == [__file__]


# --- axes that close ------------------------------------------------------------------------


def swapped(points: Floats) -> Floats:
    return np.ascontiguousarray(np.swapaxes(points, 0, 1))


AXES: list[tuple[str, Callable[[Floats], Floats], tuple[bool, bool]]] = [
    ("j", lambda p: p, (True, False)),
    ("i", swapped, (False, True)),
]


@pytest.mark.parametrize(("letter", "turn", "closed"), AXES)
def test_coinciding_lines_close_an_axis(
    letter: str, turn: Callable[[Floats], Floats], closed: tuple[bool, bool]
) -> None:
    points = turn(ring(13, last=True))
    field = FlowField.from_arrays(points, ones(points))
    assert field.periodic == closed
    assert field.shape == points.shape[:2]
    assert FlowField.from_arrays(points, ones(points), periodic="").periodic == (False, False)


@pytest.mark.parametrize(("letter", "turn", "closed"), AXES)
def test_a_ring_one_cell_short_gets_its_line(
    letter: str, turn: Callable[[Floats], Floats], closed: tuple[bool, bool]
) -> None:
    points = turn(ring(12, last=False))
    velocity, p = np.random.default_rng(0).random((2, *points.shape)), points[..., 0]
    field = FlowField.from_arrays(points, velocity, scalars={"p": p})
    axis = "ji".index(letter)
    assert field.periodic == closed
    assert field.shape[axis] == 13
    for array, behind in [(field.points, 0), (field.velocity, 1), (field.scalars["p"], 1)]:
        lines = np.moveaxis(array, axis + behind, 0)
        assert np.array_equal(lines[0], lines[-1])
    np.testing.assert_allclose(turn(ring(13, last=True)), field.points, atol=1e-12)


@pytest.mark.parametrize(("letter", "turn", "closed"), AXES)
@pytest.mark.parametrize("count", [36, 37])
def test_global_longitude_closes_an_axis(
    count: int, letter: str, turn: Callable[[Floats], Floats], closed: tuple[bool, bool]
) -> None:
    x, y = np.meshgrid(np.arange(count) * 10.0 - 180, np.linspace(90, -90, 19), indexing="ij")
    points = turn(np.stack([x, y, 0 * x], axis=-1))
    field = FlowField.from_arrays(points, ones(points))
    axis = "ji".index(letter)
    assert field.periodic == closed
    assert field.shape[axis] == 37
    assert np.ptp(field.points[..., 0]) == pytest.approx(360)
    assert field.surface.offset[axis].tolist() == [360, 0, 0]


def test_a_torus_closes_both_axes() -> None:
    a, b = np.meshgrid(*[np.linspace(0, 2 * np.pi, 24, endpoint=False)] * 2)
    r = 3 + np.cos(a)
    points = np.stack([r * np.cos(b), r * np.sin(b), np.sin(a)], axis=-1)
    field = FlowField.from_arrays(points, ones(points))
    assert field.periodic == (True, True)
    assert field.shape == (25, 25)


def test_half_a_ring_and_a_region_do_not_close() -> None:
    half = ring(25, last=True)[:13]
    assert FlowField.from_arrays(half, ones(half)).periodic == (False, False)
    x, y = np.meshgrid(np.arange(30.0), np.arange(20.0))
    region = np.stack([x, y], axis=-1)
    assert FlowField.from_arrays(region, ones(region)).periodic == (False, False)


def test_a_seam_written_with_few_digits_is_no_sliver() -> None:
    points = ring(49, last=True)
    points[-1] += 4e-5
    field = FlowField.from_arrays(points, ones(points))
    assert field.shape == (49, 4)
    assert field.periodic == (True, False)


def test_an_axis_closes_when_asked() -> None:
    velocity = np.random.default_rng(1).random((5, 7, 3))
    field = FlowField.from_arrays(flat(), velocity, periodic="i")
    assert field.periodic == (False, True)
    assert field.shape == (5, 8)
    assert field.surface.offset[1].tolist() == [7, 0, 0]
    assert np.array_equal(field.velocity[0, :, -1], velocity[:, 0])


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e12])
def test_a_flat_map_that_repeats_its_first_line_is_taken_as_it_is(scale: float) -> None:
    velocity = np.random.default_rng(1).random((5, 7, 3)) * scale
    open_map = FlowField.from_arrays(flat(), velocity, periodic="i")
    assert open_map.shape == (5, 8), "different lines were taken for the same"
    velocity[:, -1] = velocity[:, 0]
    assert FlowField.from_arrays(flat(), velocity, periodic="i").shape == (5, 7)


def test_both_sides_of_a_seam_get_one_value() -> None:
    points = ring(13, last=True)
    velocity = ones(points)
    velocity[0], velocity[-1] = 1.0, 3.0
    velocity[0, 1], velocity[-1, 2] = np.nan, np.nan
    field = FlowField.from_arrays(points, velocity)
    assert field.velocity[0, 0, :, 0].tolist() == [2, 3, 1, 2]
    assert np.array_equal(field.velocity[0, 0], field.velocity[0, -1])
    assert field.valid.all()


# --- parts of a field -----------------------------------------------------------------------


def test_one_step_is_a_steady_field() -> None:
    velocity = ones(flat(), 3) * np.arange(1.0, 4)[:, None, None, None]
    scalars = {"p": np.ones((5, 7)), "q": velocity[..., 0]}
    field = FlowField.from_arrays(flat(), velocity, times=[1, 2, 4], scalars=scalars).at_step(-1)
    assert field.steady
    assert field.times.tolist() == [4.0]
    assert (field.velocity == 3).all()
    assert (field.scalars["q"] == 3).all()
    assert field.scalars["p"].shape == (1, 5, 7)
    with pytest.raises(FieldError, match=r"^time step 1 does not exist: expected 0 to 0$"):
        field.at_step(1)


def test_downsampling_keeps_the_closing_line() -> None:
    points = ring(12, last=False)
    field = FlowField.from_arrays(points, ones(points)).downsample(2)
    assert field.shape == (7, 2)
    np.testing.assert_allclose(field.points[-1], field.points[0])


def test_the_words_for_a_field() -> None:
    points = ring(13, last=True)
    velocity = ones(points, 2)
    velocity[:, 3, 3] = np.nan
    field = FlowField.from_arrays(points, velocity, name="ring")
    assert repr(field) == "FlowField(ring: 4 x 13 nodes (I x J), 2 steps, periodic j, 1 blanked)"
    assert "unnamed: 7 x 5 nodes (I x J), steady, 0" in repr(
        FlowField.from_arrays(flat(), ones(flat()))
    )


def test_positions_that_were_filled_in_stay_marked() -> None:
    points, velocity = flat(13, 13), ones(flat(13, 13))
    points[6, 6] = 1e20
    velocity[6, 6] = np.nan
    velocity = np.stack([velocity, velocity])
    field = FlowField.from_arrays(points, velocity)
    for part in (field, field.at_step(1), field.downsample(2)):
        assert part.has_position is not None
        assert np.argwhere(~part.has_position).tolist() == np.argwhere(~part.valid).tolist()
        assert np.isfinite(part.points).all()
        size = part.points[0, 1, 0]
        u = part.index_velocity.components[:, part.valid]
        np.testing.assert_allclose(u, np.full_like(u, 1 / size))


def test_x_and_y_of_a_rectilinear_grid_make_its_nodes() -> None:
    x, y = np.array([0.0, 1.0, 3.0, 4.0]), np.array([0.0, 2.0, 5.0])
    whole = np.stack(np.meshgrid(x, y), axis=-1)
    velocity = np.ones((3, 4, 2))
    expected = FlowField.from_arrays(whole, velocity).points
    for points in ((x, y), [x, y], [list(x), list(y)], tuple(np.meshgrid(x, y))):
        assert np.array_equal(FlowField.from_arrays(points, velocity).points, expected)
    lifted = (*np.meshgrid(x, y), np.full((3, 4), 7.0))
    assert (FlowField.from_arrays(lifted, velocity).points[..., 2] == 7).all()
