"""Long paths put together from short ones agree with those that are integrated."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from flowtex import FieldError, FlowField, TraceSlices, trace
from flowtex._util.array_types import Floats
from flowtex.examples import airfoil_field, cylinder_field, double_gyre_field, vortex_field
from flowtex.trace.compose import landings


def both(field: FlowField, **options: object) -> tuple[TraceSlices, TraceSlices]:
    composed = trace(field, two_sided=False, **options)  # type: ignore[arg-type]
    direct = trace(
        field,
        two_sided=False,
        **{**options, "lags": composed.lags, "compose": False, "tolerance": 1e-4},  # type: ignore[arg-type]
    )
    return composed, direct


def share_of_length(one: TraceSlices, two: TraceSlices, step: int = 0) -> Floats:
    """Mean distance of the paths, by lag, over their length in cells; those that have not ended."""
    result = []
    pace = np.abs(two.rate[step]).max(axis=-1)
    for m, lag in enumerate(two.lags):
        going = two.reach[step] >= lag
        away = np.linalg.norm(one.displacement[step, m] - two.displacement[step, m], axis=-1)
        result.append(away[going].mean() / (pace[going] * lag).mean())
    return np.array(result)


STEADY: dict[str, tuple[Callable[[], FlowField], float]] = {
    "double gyre": (lambda: double_gyre_field(shape=(100, 100)), 0.003),
    "airfoil": (lambda: airfoil_field((33, 97)), 0.01),
    "cylinder": (lambda: cylinder_field().at_step(3), 0.012),
    # Eight cells to a vortex: neighbouring paths part within few turns.
    "vortex": (lambda: vortex_field().at_step(30), 0.02),
}


@pytest.mark.parametrize("name", STEADY)
def test_steady_fields(name: str) -> None:
    make, bound = STEADY[name]
    composed, direct = both(make())
    assert len(composed.lags) > 8
    assert share_of_length(composed, direct).max() < bound


def test_reach_is_found_across_compositions() -> None:
    composed, direct = both(airfoil_field((33, 97)))
    last = direct.lags[-1]
    one, two = (np.minimum(s.reach[0], last) for s in (composed, direct))
    ended = two < last
    assert ended.mean() > 0.5
    assert (np.isfinite(composed.reach[0]) == np.isfinite(direct.reach[0])).mean() > 0.98
    assert np.abs(one - two).mean() < 0.01 * last
    assert np.median(np.abs(one / np.maximum(two, 1) - 1)[ended]) < 0.01


@pytest.mark.parametrize("name", ["vortex", "double gyre"])
def test_fields_that_vary_in_time(name: str) -> None:
    vortex = name == "vortex"
    field = (
        vortex_field().at_steps(range(12)) if vortex else double_gyre_field(True, shape=(41, 81))
    )
    composed = trace(field)
    for step in (len(field.times) - 1, 9):
        direct = trace(field, lags=composed.lags, steps=[step])
        assert share_of_length(composed.at_step(step), direct).max() < 0.01


def test_landings_need_equal_steps_that_the_lags_reach() -> None:
    field = double_gyre_field(True, shape=(6, 11))
    unit = np.ones(field.shape)
    found = landings(field, np.array([0.125, 0.25, 0.5, 1.0]), unit)
    assert found is not None
    assert found.tolist() == [0, 1, 2, 4]
    assert landings(field, np.array([0.125, 0.25, 0.6]), unit) is None
    assert landings(field, np.array([0.5, 0.75]), unit) is None
    assert landings(field, np.array([0.1, 0.2]), unit) is None
    assert landings(field, np.array([0.25, 0.5]), unit * np.linspace(1, 2, 11)) is None


def test_centre_of_a_rotation_stays_bounded() -> None:
    """No path leaves its circle by more than a cell, however often it has gone round."""
    i, j = np.meshgrid(np.arange(81.0) - 40, np.arange(81.0) - 40)
    points = np.stack([i, j], axis=-1)
    field = FlowField.from_arrays(points, np.stack([-j, i], axis=-1), periodic="")
    slices = trace(field, lags=0.25 * 2.0 ** np.arange(9), two_sided=False, compose=True)
    radius = np.hypot(i, j)
    whole = (radius > 3) & (radius < 38)
    for m in range(9):
        there = points + slices.displacement[0, m]
        away = np.abs(np.hypot(there[..., 0], there[..., 1]) - radius)
        assert np.quantile(away[whole], 0.95) < 0.3
        assert away[whole].max() < 2.0


@pytest.mark.parametrize("longest", [0.5, 1e-6, 1e6])
def test_paths_end_with_the_first_slice_that_is_as_long_as_asked_for(longest: float) -> None:
    x = np.sinh(np.linspace(-3, 3, 81))
    points = np.stack(np.meshgrid(x, np.linspace(-2, 2, 41)), axis=-1)
    field = FlowField.from_arrays(points, np.broadcast_to([1.0, 0.02], points.shape), periodic="")
    whole, some = trace(field), trace(field, longest=longest)
    before = np.concatenate([[0.0], whole.lags[:-1]])
    for one, two, reach, short in (
        (whole.displacement, some.displacement, whole.reach[0], some.reach[0]),
        (whole.forward, some.forward, whole.forward_reach, some.forward_reach),
    ):
        assert one is not None
        assert two is not None
        assert reach is not None
        assert short is not None
        assert (short >= np.minimum(longest / some.unit, reach) * 0.99).all()
        for m, lag in enumerate(before):
            followed = lag * some.unit < longest
            np.testing.assert_allclose(two[0, m][followed], one[0, m][followed], atol=0.02)
            if lag > 2:
                stays = ~followed
                np.testing.assert_array_equal(two[0, m][stays], two[0, m - 1][stays])
    with pytest.raises(FieldError, match=r"longest is -1\.0; expected a positive length"):
        trace(field, longest=-1.0)
