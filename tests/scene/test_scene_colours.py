"""The ranges of colours, and what notifies of them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from flows import gyre
from triangle_meshes import sphere

import flowtex
from flowtex import FieldError
from flowtex.scene.options import Appearance
from flowtex.scene.scene import Scene


def field(values: Any, **options: Any) -> flowtex.FlowField:
    flow = gyre()
    return flowtex.FlowField.from_arrays(
        flow.points, flow.velocity, scalars={"p": values}, **options
    )


SIGNED = np.linspace(-1.0, 3.0, 31 * 61).reshape(31, 61)


def limits(values: Any, **options: Any) -> tuple[float, float]:
    return Scene.of(field(values), scalars="p", **options).scalar_limits


def test_zero_is_in_the_middle_of_a_diverging_map() -> None:
    assert limits(SIGNED) == (-1.0, 3.0)
    assert limits(SIGNED, cmap="coolwarm") == (-3.0, 3.0)
    assert limits(SIGNED, cmap="RdBu_r") == (-3.0, 3.0)
    assert limits(SIGNED, cmap="coolwarm", clim=(-1, 2)) == (-1.0, 2.0)
    assert limits(SIGNED + 2, cmap="coolwarm") == (1.0, 5.0)


def test_an_end_that_is_zero_but_for_rounding_is_told_as_zero() -> None:
    values = np.linspace(1.94e-7, 10.3, SIGNED.size).reshape(SIGNED.shape)
    scene = Scene.of(field(values), scalars="p")
    assert scene.scalar_limits[0] > 0 and scene.legend_limits == (0.0, 10.3)
    assert Scene.of(field(-values), scalars="p").legend_limits == (-10.3, 0.0)
    assert Scene.of(field(values), scalars="p", log_scale=True).legend_limits[0] > 0
    small = Scene.of(field(1e-9 * values), scalars="p", clim=(1e-9, 1e-8))
    assert small.legend_limits == (1e-9, 1e-8)


def test_a_robust_range_leaves_outliers_out() -> None:
    values = SIGNED.copy()
    values[0, 0], values[-1, -1] = -1e6, 1e6
    low, high = limits(values, clim="robust")
    assert (low, high) == pytest.approx((-0.92, 2.92), abs=0.01)
    assert limits(values, clim="robust", cmap="coolwarm") == (-high, high)


def test_a_long_tail_is_left_out_and_the_legend_has_a_tip() -> None:
    values = SIGNED.copy()
    assert Scene.of(field(values), scalars="p").beyond == (False, False)
    values[0, 0] = 6.7  # as far beyond the robust range as that is long
    assert limits(values)[1] == pytest.approx(6.7)
    values[0, 0] = 6.8
    scene = Scene.of(field(values), scalars="p")
    assert scene.scalar_limits == pytest.approx((-1, 2.92), abs=0.01)
    assert scene.beyond == (False, True)
    assert limits(values, cmap="coolwarm")[0] == -limits(values)[1]
    assert limits(values + 2, log_scale=True)[1] == pytest.approx(8.8)
    assert Scene.of(field(values), scalars="p", clim=(0, 8)).beyond == (True, False)
    # A tracer that is nearly everywhere zero has no robust range.
    rare = np.where(SIGNED > 2.99, 1.0, 0.0)
    assert limits(rare) == (0, 1)
    assert Scene.of(field(values), scalars=False).beyond == (False, False)


def test_a_logarithm_is_refused_for_what_has_none() -> None:
    assert limits(SIGNED + 2, log_scale=True) == (1.0, 5.0)
    assert limits(SIGNED, log_scale=True, clim=(0.1, 3)) == (0.1, 3)
    for clim in (None, (0, 3)):
        with pytest.raises(ValueError, match=r"^log_scale is True, but "):
            limits(SIGNED, log_scale=True, clim=clim)


def test_a_change_is_told_and_a_wrong_one_changes_nothing() -> None:
    scene = Scene.of(field(SIGNED))
    told: list[str] = []
    scene.observe(told.append)
    scene.appearance = replace(scene.appearance, scalars="p", cmap="magma")
    assert told == ["appearance"] and scene.scalar_limits == (-1.0, 3.0)
    for wrong in ({"scalars": "q"}, {"log_scale": True}):
        with pytest.raises(FieldError):
            scene.appearance = replace(scene.appearance, **wrong)
    assert told == ["appearance"] and scene.appearance.scalars == "p"


def test_the_range_of_a_large_surface_is_of_the_speed_along_it() -> None:
    """A wind across a sphere is even in space, and along the sphere it goes from none to all."""
    points, triangles = sphere(6)
    wind = np.tile([1.0, 0.0, 0.0], (len(points), 1))
    lon, lat = np.meshgrid(np.linspace(0.1, 3.0, 400), np.linspace(-1.4, 1.4, 400))
    grid = np.stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)], axis=-1)
    for large in (
        flowtex.FlowField.from_triangles(points, triangles, wind),
        flowtex.FlowField.from_arrays(grid, np.broadcast_to([1.0, 0.0, 0.0], grid.shape)),
    ):
        scene = Scene(large)
        assert scene.pyramid is not None
        low, high = scene.scalar_limits
        assert low < 0.15 and high == pytest.approx(1, abs=1e-3)


def test_signed_values_have_a_diverging_map_until_another_is_chosen() -> None:
    field = flowtex.examples.double_gyre_field(shape=(11, 21))
    scene = Scene(field, appearance=Appearance.of(scalars="vorticity"))
    low, high = scene.scalar_limits
    assert scene.appearance.cmap == "RdBu_r" and low == -high
    looks = [scene.appearance.changed(scalars=name) for name in ("speed", "divergence", False)]
    assert [look.cmap for look in looks] == ["viridis", "RdBu_r", "viridis"]
    chosen = Appearance.of(scalars="vorticity", cmap="magma")
    assert chosen.changed(scalars="speed").cmap == "magma"
    assert Appearance.of(scalars="vorticity", cmap="viridis").cmap == "viridis"


def test_zero_is_in_the_middle_of_a_vorticity_of_one_sign() -> None:
    flow = gyre()
    turning = np.linspace(1.0, 3.0, flow.valid.size).reshape(flow.shape)
    named = flowtex.FlowField.from_arrays(
        flow.points, flow.velocity, scalars={"vorticity": turning}
    )
    assert Scene.of(named, scalars="vorticity").scalar_limits == pytest.approx((-3, 3))
    assert Scene.of(named, scalars="vorticity", cmap="magma").scalar_limits == pytest.approx((1, 3))
