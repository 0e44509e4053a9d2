"""The files of examples in closed form against what computes them."""

from __future__ import annotations

import delta_wing_run
import numpy as np
import ocean_run
import packing
import pytest
import weather_run

from flowtex.examples import _shipped


def test_the_file_of_the_sea_is_the_computation() -> None:
    pytest.importorskip("pyproj")
    file = _shipped.load(_shipped.OCEAN)
    longitude, latitude, land, height = ocean_run.run()
    stored = _shipped.unpack(file["height"], float(file["step"]), axis=(0, 1, 2))
    assert np.abs(stored - height).max() <= file["step"] * 0.5001
    np.testing.assert_array_equal(file["land"], land)
    np.testing.assert_allclose(file["longitude"], longitude)
    np.testing.assert_allclose(file["latitude"], latitude)


def test_the_file_of_the_winds_is_the_computation() -> None:
    file = _shipped.load(_shipped.WEATHER)
    longitude, latitude, winds = weather_run.run()
    stored = _shipped.unpack(file["winds"], float(file["step"]), axis=(2, 3))
    assert np.abs(stored - winds).max() <= file["step"] * 0.5001
    np.testing.assert_allclose(file["longitude"], longitude)
    np.testing.assert_allclose(file["latitude"], latitude)
    assert file["level"].tolist() == list(weather_run.LEVELS)


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
