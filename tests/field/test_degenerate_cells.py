"""Derivatives at nodes that coincide, as at poles, are right or missing."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from earth_data import AXIS, DEGREES, RATE, components, on_sphere, winds

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.field.earth.projection import EARTH_RADIUS

pytestmark = pytest.mark.filterwarnings("ignore::flowtex.errors.Notice")

MAPS = [
    "globe",
    "platecarree",
    "robinson",
    "equalearth",
    "+proj=moll +lon_0=30",
    "+proj=eck4",
    "+proj=sinu",
    "+proj=wintri",
    "+proj=laea +lat_0=70",
]


def turning_vorticity(field: FlowField) -> Floats:
    """Return the vorticity of the rigid rotation at the nodes."""
    assert field.projection is not None
    places = on_sphere(*field.projection.lonlat(field.points))
    return np.asarray(2 * RATE / EARTH_RADIUS * (places @ AXIS))


def even(count: int) -> xr.Dataset:
    """Return the rigid rotation at points all over the Earth, with the poles."""
    p = np.random.default_rng(3).normal(size=(count, 3))
    p[:2] = (0, 0, 1), (0, 0, -1)
    p /= np.linalg.norm(p, axis=1, keepdims=True)
    lon, lat = np.degrees(np.arctan2(p[:, 1], p[:, 0])), np.degrees(np.arcsin(p[:, 2]))
    u, v = components(lon, lat)
    units = {"units": "m s-1"}
    return xr.Dataset(
        {
            "u": ("n", u, {"standard_name": "eastward_wind", **units}),
            "v": ("n", v, {"standard_name": "northward_wind", **units}),
        },
        {"lon": ("n", lon, DEGREES["lon"]), "lat": ("n", lat, DEGREES["lat"])},
    )


@pytest.mark.parametrize("nearly", [0.0, 1e-3])
@pytest.mark.parametrize("name", MAPS)
def test_vorticity_in_the_rows_of_poles(name: str, nearly: float) -> None:
    lat = np.linspace(-90 + nearly, 90 - nearly, 37)
    field = FlowField.from_xarray(winds(np.arange(-180.0, 180.0, 5.0), lat), projection=name)
    exact = turning_vorticity(field)
    error = np.abs(field.derive("vorticity")[0] - exact)
    assert np.nanmax(error) < 0.15 * np.nanmax(np.abs(exact))
    assert np.isnan(error[field.valid]).mean() < 0.03
    for other in ("divergence", "shear"):
        assert np.nanmax(np.abs(field.derive(other))) < 0.15 * np.nanmax(np.abs(exact))


@pytest.mark.parametrize("name", MAPS)
def test_vorticity_of_triangles_at_poles_and_edges(name: str) -> None:
    field = FlowField.from_xarray(even(800), projection=name)
    exact = turning_vorticity(field)
    error = np.abs(field.derive("vorticity")[0] - exact)
    assert np.nanmax(error) < 0.5 * np.nanmax(np.abs(exact))
    assert np.nanpercentile(error, 95) < 0.15 * np.nanmax(np.abs(exact))
    # A map that opens a pole into a line has many nodes there, of which cells are much wider than
    # high; they cover a few thousandths of its height.
    assert field.projection is not None
    _, lat = field.projection.lonlat(field.points)
    is_near_pole = np.abs(lat) > 89.0
    assert np.isnan(error[field.valid & ~is_near_pole]).mean() < 0.03


@pytest.mark.parametrize("name", ["robinson", "+proj=moll"])
def test_triangles_have_the_wind_of_the_globe_beside_a_tear(name: str) -> None:
    globe = FlowField.from_xarray(even(800), projection="globe")
    drawn = FlowField.from_xarray(even(800), projection=name)
    for lon, lat in ((179.5, 86.0), (-179.9, 84.0), (179.99, -60.0), (180.0, 30.0)):
        one, other = globe.at(lon, lat), drawn.at(lon, lat)
        assert one is not None
        assert other is not None
        wanted = one.eastward, one.northward
        assert (other.eastward, other.northward) == pytest.approx(wanted, abs=0.02)


def linear(p: Floats) -> Floats:
    """Return a velocity with the vorticity 1."""
    return np.stack([p[..., 0] + 2 * p[..., 1], 3 * p[..., 0] - p[..., 1]], axis=-1)


def disc(turn: float) -> Floats:
    angle, radius = np.meshgrid(np.linspace(0, turn, 25), np.linspace(0, 1, 9))
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)


def moved(rows: object, columns: object, node: tuple[int, int], step: float) -> Floats:
    """Return an even grid of which some nodes lie at another one, or nearly so."""
    x, y = np.meshgrid(np.linspace(0, 1, 20), np.linspace(0, 1, 15))
    p = np.stack([x, y], axis=-1)
    apart = step * np.random.default_rng(0).uniform(-1, 1, p.shape)
    p[rows, columns] = (p[node] + apart)[rows, columns]  # type: ignore[index]
    return p


@pytest.mark.parametrize(
    ("points", "missing"),
    [
        (disc(2 * np.pi), 0),
        (disc(2.0), 25),
        (moved(5, slice(6, 10), (5, 6), 0.0), 20),
        (moved(5, slice(6, 10), (5, 6), 1e-9), 20),
        (moved(slice(5, 7), 7, (5, 7), 0.0), 0),
    ],
)
def test_nodes_that_coincide_are_right_or_missing(points: Floats, missing: int) -> None:
    for periodic in (None, ""):
        field = FlowField.from_arrays(points, linear(points), periodic=periodic)
        values = field.derive("vorticity")
        assert np.isnan(values).sum() <= missing
        known = values[np.isfinite(values)]
        assert known == pytest.approx(np.ones(len(known)), abs=1e-6)


def test_cells_that_grow_a_millionfold_are_differentiated() -> None:
    x, y = np.meshgrid(np.linspace(0, 1, 20), 1e-7 * 1.6 ** np.arange(30))
    points = np.stack([x, y], axis=-1)
    field = FlowField.from_arrays(points, linear(points))
    assert field.derive("vorticity") == pytest.approx(np.ones((1, 30, 20)), abs=1e-6)
