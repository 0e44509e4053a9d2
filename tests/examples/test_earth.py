"""The example datasets: honest metadata, balance, drift, and no seam and no pole in the winds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from flowtex import FlowField, examples

xr = pytest.importorskip("xarray")
pytest.importorskip("pyproj")
if TYPE_CHECKING:
    from xarray import Dataset


@pytest.fixture(scope="module")
def ocean() -> Dataset:
    return examples.ocean()


@pytest.fixture(scope="module")
def weather() -> Dataset:
    return examples.weather()


def test_the_currents_are_in_balance_with_the_height(ocean: Dataset) -> None:
    # The current goes along the lines of equal height.
    z = ocean.zos.isel(time=3)
    north, east = np.gradient(z.values, axis=(0, 1))
    east /= np.cos(np.radians(z.latitude.values))[:, None]
    u, v = (ocean[name].isel(time=3).values for name in ("uo", "vo"))
    with np.errstate(invalid="ignore"):  # the sea is level at some nodes
        across = (u * east + v * north) / (np.hypot(u, v) * np.hypot(east, north))
    known = np.isfinite(across)
    assert known.mean() > 0.7
    assert np.median(np.abs(across[known])) < 1e-6


@pytest.mark.parametrize("pole", [0, -1])
def test_the_wind_at_a_pole_is_one_vector(weather: Dataset, pole: int) -> None:
    field = FlowField.from_xarray(weather, level=250, globe=True)
    lon = np.radians(weather.longitude.values)
    for level in (850, 500, 250):
        at = weather.sel(level=level).isel(latitude=pole)
        up = np.sign(float(at.latitude))
        x = -np.sin(lon) * at.u.values - up * np.cos(lon) * at.v.values
        y = np.cos(lon) * at.u.values - up * np.sin(lon) * at.v.values
        rounding = np.abs(weather.u.values).max() / 16_000
        assert np.ptp(x) < 2 * rounding
        assert np.ptp(y) < 2 * rounding
        assert np.hypot(x, y).max() > 0.2
    assert field.valid.all()
    assert field.periodic == (False, True)
