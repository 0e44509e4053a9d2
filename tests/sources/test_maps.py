"""Maps show the data and nothing else: nothing in gaps, and all up to where the map is torn."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyproj
import pytest
import xarray as xr
from earth_data import components, on_sphere
from map_places import drawn_at, turned_frame, winds

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.field.grids.grid_surface import GridSurface
from flowtex.sources.reproject import reprojected
from flowtex.textures.geometry import NodeDisplacements

#: Maps, as flowtex names them or as cartopy's axes have them; their middle, and the degrees from
#: there up to which they are drawn.
MAPS: dict[str, tuple[float, float, float]] = {
    "robinson": (0, 0, 180),
    "+proj=eqc +lon_0=0": (0, 0, 180),
    "+proj=robin +lon_0=150": (150, 0, 180),
    "EPSG:3857": (0, 0, 85),
    "+proj=moll +lon_0=-20": (-20, 0, 180),
    "+proj=igh +lon_0=-160": (-160, 0, 180),
    "+proj=stere +lat_0=90 +lon_0=0": (0, 90, 100),
    "+proj=ortho +lat_0=20 +lon_0=160": (160, 20, 75),
    "+proj=laea +lat_0=-30 +lon_0=40": (40, -30, 100),
    "+proj=ob_tran +o_proj=eqc +o_lon_p=0 +o_lat_p=37.5 +lon_0=357.5": (0, 0, 180),
}
FINE, BAND = np.arange(-180.0, 180.0, 4.0), np.arange(-60.0, 61.0, 3.0)
PACIFIC, CAP = np.arange(120.0, 241.0, 3.0), np.arange(60.0, 91.0, 3.0)
#: Longitudes and latitudes of data, and the box where they are.
LINES: dict[str, tuple[Floats, Floats, tuple[float, float, float, float]]] = {
    "pacific": (PACIFIC, BAND, (120, 240, -60, 60)),
    "pacific from -180": ((PACIFIC + 181) % 360 - 180, BAND[::-1], (121, 241, -60, 60)),
    "polar cap": (FINE, CAP, (0, 360, 60, 91)),
    "sector": (np.arange(-60.0, 241.0, 5.0), np.arange(50.0, 81.0, 3.0), (-60, 240, 50, 80)),
    "sector at the pole": (np.arange(130.0, 221.0, 5.0), CAP, (130, 220, 60, 91)),
    "earth": (FINE + 181, np.arange(-88.0, 89.0, 4.0), (0, 360, -88, 88)),
    "earth, repeated": (np.append(FINE, 180.0), np.arange(-90.0, 91.0, 4.0), (0, 360, -91, 91)),
    "gap": (FINE[np.abs(FINE - 18) > 22], BAND, (40, 356, -60, 60)),
    "gap in latitude": (FINE, BAND[np.abs(BAND + 10.5) > 10], (0, 360, -60, 60)),
}
#: Grids on lines of a sphere whose pole lies elsewhere, and that pole.
CURVED = {
    "rotated region": (np.arange(-30.0, 31.0, 3.0), np.arange(-30.0, 31.0, 3.0), (170, 40)),
    "earth with other poles": (FINE, np.arange(-84.0, 85.0, 4.0), (30, 60)),
}


def data_of(name: str) -> tuple[xr.Dataset, Any, float]:
    """Return data, a function of the degrees to their edge, negative outside, and a cell."""
    if name in LINES:
        lon, lat, (west, east, south, north) = LINES[name]
        turned, data = None, winds(lon, lat)
    else:
        lon, lat, (lon_0, lat_p) = CURVED[name]
        turned = turned_frame(lon_0, lat_p)
        data = winds(*turned.transform(*np.meshgrid(lon, lat)))
        around = 360 if np.ptp(lon) > 350 else np.ptp(lon)
        west, east, south, north = lon[0], lon[0] + around, lat.min(), lat.max()

    def depth(a: Floats, b: Floats) -> Floats:
        if turned is not None:
            a, b = turned.transform(a, b, direction="INVERSE")
        beside = (east - west) / 2 - np.abs((a - (west + east) / 2 + 180) % 360 - 180)
        beside = beside * np.cos(np.radians(b)) if east - west < 360 else np.full_like(b, 999.0)
        depth = np.minimum(beside, np.minimum(b - south, north - b))
        return np.minimum(depth, np.abs(b + 10.5) - 10.5) if name == "gap in latitude" else depth

    return data, depth, 1.1 * max(float(np.median(np.abs(np.diff(line)))) for line in (lon, lat))


@pytest.mark.parametrize("region", [*LINES, *CURVED])
@pytest.mark.parametrize("name", MAPS)
def test_a_map_shows_the_data_and_nothing_else(name: str, region: str) -> None:
    data, depth_of, cell = data_of(region)
    field = FlowField.from_xarray(data, projection=name)
    projection = field.projection
    assert projection is not None
    crs, shift = projection._crs, projection._origin
    change = pyproj.Transformer.from_crs(crs.geodetic_crs, crs, always_xy=True)

    def to_map(lon: Floats, lat: Floats) -> Floats:
        lon = (lon - shift + 180) % 360 - 180 if shift else lon
        return np.stack(change.transform(lon, lat, errcheck=False), axis=-1)

    rng = np.random.default_rng(1)
    lon, lat = rng.uniform(-180, 180, 250), np.degrees(np.arcsin(rng.uniform(-0.99, 0.99, 250)))
    places = to_map(lon, lat)
    middle = (MAPS[name][0] + (shift if name in ("robinson",) else 0), MAPS[name][1])
    away = np.degrees(np.arccos(np.clip(on_sphere(lon, lat) @ on_sphere(*middle), -1, 1)))
    shown = np.isfinite(places).all(axis=1) & (away < MAPS[name][2])
    if name == "EPSG:3857":
        shown = np.abs(lat) < 80
    lon, lat, places = lon[shown], lat[shown], places[shown]
    depth = depth_of(lon, lat)
    found, vectors = drawn_at(field, places)
    assert not (found & (depth < -0.05 * cell)).any(), "nothing is drawn outside the data"
    missing = ~found & (depth > cell)
    # Beside its own poles, which are no nodes, an oblique map leaves parts of cells out.
    if region in LINES and "ob_tran" in name:
        missing &= np.abs(places[:, 1]) < 0.9 * np.abs(places[:, 1]).max()
    assert not missing.any(), (lon[missing], lat[missing])
    # Where a particle goes in a short time.
    east, north = components(lon, lat)
    step = 1e-3 / np.hypot(east, north)
    way = step * east / np.cos(np.radians(lat)), step * north
    ahead, behind = (s * (to_map(lon + s * way[0], lat + s * way[1]) - places) for s in (1, -1))
    whole = np.linalg.norm(ahead - behind, axis=1) < 0.05 * np.linalg.norm(ahead, axis=1)
    inside = found & (depth > 0) & whole & (np.abs(lat) < 75)
    (u, v), (x, y) = (ahead + behind)[inside].T, vectors[inside].T
    turned = np.degrees(np.abs(np.angle((u + 1j * v) / (x + 1j * y))))
    # In cells where the map has a kink, as Goode's at 41 degrees, directions differ.
    assert turned.size == 0 or (np.quantile(turned, 0.96) < 2 and turned.max() < 20)


@pytest.mark.parametrize("name", ["+proj=eqc", "+proj=moll", "+proj=igh"])
def test_paths_beyond_a_tear_go_on_as_they_come(name: str) -> None:
    field = FlowField.from_xarray(data_of("pacific")[0], projection=name)
    surface = field.surface
    assert isinstance(surface, GridSurface)
    cells = np.zeros((*field.shape, 2), np.float32)
    cells[..., 0] = 12.0
    for sign in (1, -1):
        moved = NodeDisplacements(surface, np.eye(3))(sign * cells)[:, surface.valid]
        longest = np.linalg.norm(surface.tangents[0][surface.valid], axis=-1).max()
        assert (sign * moved[0] > 0).all() and np.abs(moved).max() < 1.2 * 12 * longest


@pytest.mark.parametrize("beside", [0.0, 0.03, 0.07, -0.05])
@pytest.mark.parametrize("projection", ["robinson", "platecarree"])
def test_columns_beside_the_edge_of_a_map_are_those_of_the_data(
    projection: str, beside: float
) -> None:
    lon = np.asarray(-180.0 + 10.0 * (np.arange(36) + beside), float)
    lat = np.arange(-80.0, 81.0, 10.0)
    if projection == "platecarree":
        projection = "+proj=eqc +lon_0=0"
    data = winds(lon, lat)
    # Rough, so that values between two columns differ from those of both.
    data["u"] = data["u"] + 5.0 * np.cos(np.pi * np.arange(36))
    data["u"].attrs = winds(lon, lat)["u"].attrs
    field = FlowField.from_xarray(data, projection=projection)
    for column in (0, 1, 35):
        place = float((lon[column] + 180.0) % 360.0 - 180.0)
        found = field.at(place, 20.0)
        assert found is not None
        assert found.eastward == pytest.approx(float(data["u"][10, column]), abs=1e-3)


@pytest.mark.parametrize(
    ("projection", "antipode"),
    [
        ("+proj=laea +lat_0=30 +lon_0=-60", (120, -30)),
        ("+proj=aeqd +lat_0=50 +lon_0=20", (200, -50)),
    ],
)
@pytest.mark.parametrize("west", [-180.0, -177.0])
def test_cells_beside_the_antipode_have_the_values_of_the_data(
    projection: str, antipode: tuple[float, float], west: float
) -> None:
    lon: Floats = np.asarray(west + 10.0 * np.arange(36), float)
    lat = np.arange(-90.0, 91.0, 10.0)
    data = winds(lon, lat)
    rng = np.random.default_rng(3)
    data["q"] = ("lat", "lon"), rng.uniform(0.0, 1.0, (len(lat), len(lon)))  # rough
    around = xr.concat([data, data.isel(lon=0).assign_coords(lon=west + 360.0)], "lon")
    on_map = FlowField.from_xarray(data, projection=projection)
    fields = [on_map, reprojected(on_map, "platecarree")]
    places = np.stack([rng.uniform(west, west + 360.0, 150), rng.uniform(-89.9, 30.0, 150)])
    away = np.degrees(np.arccos(on_sphere(*places) @ on_sphere(*np.array(antipode, float))))
    drawn = 0
    for a, b in places[:, away < 45.0].T:
        wanted = float(around["q"].interp(lon=a, lat=b))
        for field in fields:
            found = field.at(a, b)
            if found is not None:
                drawn += 1
                assert found.scalars["q"] == pytest.approx(wanted, abs=2e-3)
    assert drawn > (away < 45.0).sum()
