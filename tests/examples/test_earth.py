"""The example datasets: honest metadata, balance, drift, and no seam and no pole in the winds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from flowtex import FlowField, examples
from flowtex.field.earth import EARTH_RADIUS

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


def test_both_come_back_from_a_file(ocean: Dataset, weather: Dataset, tmp_path: Any) -> None:
    pytest.importorskip("netCDF4")
    for name, ds, level in (("ocean", ocean, None), ("weather", weather, 500)):
        ds.to_netcdf(tmp_path / f"{name}.nc")
        again = FlowField.from_file(tmp_path / f"{name}.nc", level=level)
        here = FlowField.from_xarray(ds, sel={} if level is None else {"level": level})
        np.testing.assert_array_equal(np.asarray(again.velocity[0]), np.asarray(here.velocity[0]))
        assert again.start == here.start


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


def test_eddies_go_west_day_by_day(ocean: Dataset) -> None:
    # Where the sea is lowest in the ring at 60.6 degrees west, south of the stream.
    ring = ocean.zos.sel(longitude=slice(-62.6, -58.8), latitude=slice(35, 37.4))
    weights = (ring.max(("latitude", "longitude")) - ring).values ** 6
    lon = (weights * ring.longitude.values).sum((1, 2)) / weights.sum((1, 2))
    km_a_day = np.polyfit(np.arange(8), lon, 1)[0] * 111.2 * np.cos(np.radians(36.2))
    assert -8.0 < km_a_day < -2.0
    assert (np.diff(lon) < 0).all()


def test_the_winds_have_no_divergence_and_no_seam(weather: Dataset) -> None:
    lat = np.radians(weather.latitude.values)[1:-1]
    u, v = (weather[name].values for name in ("u", "v"))
    along = (np.roll(u, -1, axis=2) - np.roll(u, 1, axis=2))[:, 1:-1]  # over the date line too
    flow = v * np.cos(np.radians(weather.latitude.values))[:, None]
    across = flow[:, :-2] - flow[:, 2:]
    step = 2 * np.radians(2.0)
    divergence = (along + across) / (step * EARTH_RADIUS * np.cos(lat)[:, None])
    around = (np.abs(u).max() / (5 * np.radians(1) * EARTH_RADIUS)) * 0.05
    assert np.abs(divergence[:, 5:-5]).max() < around


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
