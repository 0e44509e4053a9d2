"""The files of examples in closed form against what computes them."""

from __future__ import annotations

import delta_wing_run
import numpy as np
import ocean_run
import packing
import pytest
import weather_run

from flowtex import examples
from flowtex.examples import _shipped


def test_the_file_of_the_sea_is_the_computation() -> None:
    pytest.importorskip("pyproj")
    longitude, latitude, land, height = ocean_run.run()
    sea = examples.ocean()
    stored = sea.zos.values
    step = np.abs(height).max() / packing.STEPS
    assert np.abs(stored - height)[:, ~land].max() <= step * 0.5001
    np.testing.assert_array_equal(np.isnan(stored), land | np.zeros((8, 1, 1), bool))
    np.testing.assert_allclose(sea.longitude, longitude)
    np.testing.assert_allclose(sea.latitude, latitude)


def test_the_file_of_the_winds_is_the_computation() -> None:
    file = examples.weather()
    longitude, latitude, winds = weather_run.run()
    for name, wind in zip("uv", winds, strict=True):
        step = np.abs(wind).max() / packing.STEPS
        assert np.abs(file[name].values - wind).max() <= step * 0.5001
    np.testing.assert_allclose(file.longitude, longitude)
    np.testing.assert_allclose(file.latitude, latitude)
    assert file.level.values.tolist() == list(weather_run.LEVELS)


def test_the_file_of_the_wing_is_the_computation() -> None:
    file = _shipped.load(_shipped.DELTA_WING)
    for stored, computed in zip(
        (file["points"], file["velocity"]), delta_wing_run.run(), strict=True
    ):
        np.testing.assert_allclose(stored, computed, atol=1e-7, rtol=1e-6)


@pytest.mark.parametrize("axis", [0, 1, (0, 1), (1, 0)])
def test_differences_along_any_axes_add_up_again(axis: int | tuple[int, ...]) -> None:
    values = np.random.default_rng(0).normal(size=(7, 9))
    packed, step = packing.pack(values, axis)
    assert np.abs(_shipped.unpack(packed, step, axis) - values).max() <= step * 0.5001
