"""Flat maps show all of the cell around a pole of the Earth, with the velocity of the data."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from earth_data import RATE, components, turning
from earth_data import winds as winds_on_lines
from map_places import drawn_at, turned_frame, winds
from scipy.spatial import ConvexHull

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.field.earth.projection import EARTH_RADIUS, GLOBE, Projection
from flowtex.sources.models.healpix import healpix_centres
from flowtex.sources.reproject import reprojected

MAPS = [
    "+proj=eqc +lon_0=0",
    "+proj=eqc +lon_0=110",
    "robinson",
    "equalearth",
    "+proj=moll +lon_0=-20",
    "+proj=eck4",
    "+proj=sinu +lon_0=30",
    "+proj=natearth +lon_0=170",
]
EVEN = np.arange(-180.0, 180.0, 4.0), np.arange(-88.0, 89.0, 4.0)
#: Lines of a grid, and its own pole. The pole of the Earth lies in a cell, on a side and on a node.
GRIDS: dict[str, tuple[tuple[Floats, Floats], tuple[float, float]]] = {
    "in a cell": (EVEN, (77.3, 38.3)),
    "near a side": (EVEN, (30.001, 50.2)),
    "on a side": (EVEN, (30.0, 61.0)),
    "on a node": (EVEN, (30.0, 60.0)),
    "region": ((np.arange(-28.0, 29.0, 3.5), np.arange(-28.0, 29.0, 3.5)), (170.0, 7.0)),
}
#: Greatest error of linear interpolation in cells of 4 degrees, in m/s.
LINEAR = 0.006


def grid(name: str) -> xr.Dataset:
    lines, pole = GRIDS[name]
    return winds(*turned_frame(*pole).transform(*np.meshgrid(*lines)))


def beside_poles(number: int, signs: tuple[int, ...] = (-1, 1)) -> tuple[Floats, Floats]:
    """Places within 6 degrees of a pole, most of them near it."""
    rng = np.random.default_rng(3)
    away = 6.0 * 10.0 ** rng.uniform(-4.0, 0.0, number)
    return rng.uniform(-180.0, 180.0, number), rng.choice(signs, number) * (90.0 - away)


def triangles(seed: int) -> FlowField:
    """Triangles of scattered nodes on a globe."""
    rng = np.random.default_rng(seed)
    p = rng.normal(size=(2500, 3))
    p /= np.linalg.norm(p, axis=1)[:, None]
    if seed:
        p[0] = 0.0, 0.0, 1.0
    corners = ConvexHull(p).simplices
    outside = np.sum(np.cross(p[corners[:, 1]], p[corners[:, 2]]) * p[corners[:, 0]], axis=1) > 0
    corners[~outside] = corners[~outside][:, ::-1]
    return FlowField.from_triangles(
        EARTH_RADIUS * p,
        corners,
        turning(p),
        projection=Projection(GLOBE),
        length_unit="m",
        time_unit="s",
    )


def assert_right(field: FlowField, signs: tuple[int, ...], error: float) -> None:
    """Compare values beside poles, and the vectors that are drawn there, with the rotation."""
    lon, lat = beside_poles(40, signs)
    east, north = components(lon, lat)
    for a, b, u, v in zip(lon[:12], lat[:12], east, north, strict=False):
        found = field.at(a, b)
        assert found is not None, (a, b)
        assert (found.eastward, found.northward) == pytest.approx((u, v), abs=error)
    projection = field.projection
    assert projection is not None
    places = projection.positions(lon, lat)
    # A thousandth of the map inside its outline, which is bent between the nodes at it.
    drawn, vectors = drawn_at(field, 0.999 * places[:, :2])
    assert drawn.all()
    # Directions far from the pole, where those of the map change little within a cell.
    wide = np.abs(lat) < 88.0
    step = 1e-4 / np.cos(np.radians(lat))
    ahead = projection.positions(lon + east * step, lat + north * 1e-4)
    behind = projection.positions(lon - east * step, lat - north * 1e-4)
    wanted = (ahead - behind)[wide, :2]
    turned = np.angle((wanted @ [1, 1j]) / (vectors[wide] @ [1, 1j]))
    assert np.abs(np.degrees(turned)).max() < 12.0
    assert np.median(np.abs(np.degrees(turned))) < 2.0


@pytest.mark.parametrize(("where", "name"), [*zip([*GRIDS, *GRIDS], MAPS, strict=False)])
def test_the_cell_around_a_pole_is_drawn_on_flat_maps(where: str, name: str) -> None:
    field = FlowField.from_xarray(grid(where), projection=name)
    signs = (1,) if where == "region" else (-1, 1)
    assert_right(field, signs, LINEAR)


@pytest.mark.parametrize(("seed", "name"), [*zip([0, 1] * 3, MAPS[2:], strict=True)])
def test_triangles_around_a_pole_are_drawn_on_flat_maps(seed: int, name: str) -> None:
    field = reprojected(triangles(seed), name)
    assert_right(field, (-1, 1), 3 * LINEAR)


@pytest.mark.parametrize("name", ["mercator", "EPSG:3857"])
def test_mercator_ends_at_a_parallel(name: str) -> None:
    field = FlowField.from_xarray(grid("in a cell"), projection=name)
    lon = np.linspace(-179.9, 179.9, 60)
    shown = field.projection
    assert shown is not None
    edge = field.surface.points[field.surface.valid]
    for lat in (84.9, -84.9):
        places = shown.positions(lon, np.full(60, lat))[:, :2]
        assert drawn_at(field, places)[0].all()
    most = shown.positions(np.zeros(2), np.array([-85.0, 85.0]))[:, 1]
    assert (edge[:, 1].min(), edge[:, 1].max()) == pytest.approx(tuple(most), rel=1e-6)


def test_polar_maps_end_at_the_equator() -> None:
    field = FlowField.from_xarray(grid("in a cell"), projection="north")
    rim = np.linalg.norm(field.surface.points[field.surface.valid][:, :2], axis=1)
    equator = Projection("north").positions(np.zeros(1), np.zeros(1))[0]
    assert rim.max() == pytest.approx(np.linalg.norm(equator), rel=1e-6)


def test_a_field_goes_from_one_map_to_another_with_its_poles() -> None:
    first = FlowField.from_xarray(grid("in a cell"), projection="+proj=eqc +lon_0=0")
    second = reprojected(first, "+proj=moll +lon_0=100")
    lon, lat = beside_poles(12)
    for a, b in zip(lon, lat, strict=True):
        one, other = first.at(a, b), second.at(a, b)
        assert one is not None
        assert other is not None
        got = other.eastward, other.northward
        assert got == pytest.approx((one.eastward, one.northward), abs=LINEAR)
    globe = reprojected(first, GLOBE)
    speed = np.linalg.norm(np.asarray(globe.velocity[0]), axis=-1)
    wanted = np.linalg.norm(turning(globe.points / EARTH_RADIUS), axis=-1)
    # Half-way along the diagonal of a cell of 4 degrees, linear vectors are shorter by the cosine.
    shorter = 1.0 - np.cos(np.radians(2.0 * np.sqrt(2.0)))
    assert speed[globe.valid] == pytest.approx(wanted[globe.valid], abs=1.05 * shorter * RATE)


def healpix(nside: int, order: str) -> xr.Dataset:
    """The rotation at the middles of cells, some of which lie on the meridian of 180 degrees."""
    u, v = components(*healpix_centres(np.arange(12 * nside**2), nside, nested=order != "ring"))
    crs = {"grid_mapping_name": "healpix", "healpix_nside": nside, "healpix_order": order}
    named = {"units": "m s-1", "grid_mapping": "crs"}
    return xr.Dataset(
        {
            "ua": ("cell", u, {"standard_name": "eastward_wind", **named}),
            "va": ("cell", v, {"standard_name": "northward_wind", **named}),
            "crs": ((), 0, crs),
        }
    )


@pytest.mark.filterwarnings("ignore::flowtex.sources.notices.DatasetNotice")
@pytest.mark.parametrize(("order", "name"), [("ring", "robinson"), ("nested", "mercator")])
def test_nodes_on_the_edge_of_a_map_leave_no_gap_beside_it(order: str, name: str) -> None:
    field = FlowField.from_xarray(healpix(8, order), projection=name)
    for lon in (174.5, 179.0, 179.99, -179.99, -179.0, -174.5):
        for lat in (-51.7, -0.4, 0.3, 30.2, 80.0):
            found = field.at(lon, lat)
            assert found is not None, (lon, lat)
            u, v = components(np.array(lon), np.array(lat))
            assert (found.eastward, found.northward) == pytest.approx((u, v), abs=0.05)


@pytest.mark.parametrize("projection", ["eqc", "moll", "eqearth"])
def test_oblique_maps_show_all_of_a_grid_on_lines(projection: str) -> None:
    name = f"+proj=ob_tran +o_proj={projection} +o_lat_p=30 +o_lon_p=20 +lon_0=50"
    lines = winds_on_lines(np.arange(-180.0, 180.0, 6.0), np.arange(-90.0, 90.1, 6.0))
    field = FlowField.from_xarray(lines, projection=name)
    shown = field.projection
    assert shown is not None
    rng = np.random.default_rng(1)
    lon = rng.uniform(-180.0, 180.0, 600)
    lat = np.degrees(np.arcsin(rng.uniform(-1.0, 1.0, 600)))
    lat[:2] = -90.0, 90.0
    places = shown.positions(lon, lat)[:, :2]
    # Beside its own poles, which are no nodes, an oblique map does not show parts of cells.
    away = np.abs(places[:, 1]) < 0.9 * np.abs(places[:, 1]).max()
    assert away[:2].all()
    # A thousandth of the map inside its outline, which is bent between the nodes at it.
    assert drawn_at(field, 0.999 * places[away])[0].all()
    for a, b in zip(lon[away][:100], lat[away][:100], strict=True):
        found = field.at(a, b)
        assert found is not None, (a, b)
        speed = np.hypot(*components(np.array(a), np.array(b)))
        assert found.speed == pytest.approx(speed, abs=0.08)
