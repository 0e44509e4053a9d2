"""Projections: places and back, vectors as the derivative of places, and what cannot be."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import property_test

from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.earth.projection import EARTH_RADIUS, Projection, map_name

CENTER = (10.0, 50.0)
#: Latitudes that each projection shows without going to infinity.
REACH = {
    "globe": (-89.9, 89.9),
    "platecarree": (-89.9, 89.9),
    "mercator": (-85.0, 85.0),
    "north": (-60.0, 89.9),
    "south": (-89.9, 60.0),
    "lambert": (-50.0, 89.0),
    "robinson": (-89.0, 89.0),
    "equalearth": (-89.0, 89.0),
}
PROJECTIONS = {name: Projection(name, CENTER) for name in REACH}

names = st.sampled_from(sorted(REACH))
shares = st.floats(0.0, 1.0)
offsets = st.floats(-179.0, 179.0)


def place(name: str, offset: float, share: float) -> tuple[Floats, Floats]:
    south, north = REACH[name]
    return np.array(CENTER[0] + offset), np.array(south + share * (north - south))


def on_sphere(lon: Floats, lat: Floats) -> Floats:
    return PROJECTIONS["globe"].positions(lon, lat)


@property_test(100)
@given(names, offsets, shares)
def test_a_place_comes_back(name: str, offset: float, share: float) -> None:
    lon, lat = place(name, offset, share)
    back = PROJECTIONS[name].lonlat(PROJECTIONS[name].positions(lon, lat))
    assert np.linalg.norm(on_sphere(*back) - on_sphere(lon, lat)) < 1.0  # metres


@property_test(100)
@given(names, offsets, shares, st.floats(-30, 30), st.floats(-30, 30))
def test_a_vector_is_how_a_particle_moves_on_the_map(
    name: str, offset: float, share: float, east: float, north: float
) -> None:
    lon, lat = place(name, offset, share)
    # At 85 degrees Robinson's has a kink of three tenths.
    lat = np.clip(lat, -84.9, 84.9)
    projection, seconds = PROJECTIONS[name], 10.0
    degrees = np.degrees(seconds / EARTH_RADIUS)

    def after(sign: int) -> Floats:
        moved = lon + sign * degrees * east / np.cos(np.radians(lat))
        return projection.positions(moved, lat + sign * degrees * north)

    moved = (after(1) - after(-1)) / (2 * seconds)
    vector = projection.vectors(lon, lat, np.array(east), np.array(north))
    # Robinson's has kinks, by up to a tenth, at every fifth degree.
    share = 0.1 if name == "robinson" else 0.03
    far = np.hypot(east, north)
    tolerance = share * far + 0.01
    assert vector == pytest.approx(
        moved, abs=tolerance * float(projection.scales(*projection.lonlat(after(0))))
    )


@property_test(100)
@given(names, offsets, shares, st.floats(-30, 30), st.floats(-30, 30))
def test_components_are_those_a_vector_is_made_of(
    name: str, offset: float, share: float, east: float, north: float
) -> None:
    lon, lat = place(name, offset, share)
    vector = PROJECTIONS[name].vectors(lon, lat, np.array(east), np.array(north))
    found = PROJECTIONS[name].components(lon, lat, vector)
    assert np.array(found) == pytest.approx([east, north], abs=1e-6)


@pytest.mark.parametrize("name", REACH)
@pytest.mark.parametrize("lat", [-90.0, 90.0])
def test_a_pole_is_a_point_or_nowhere(name: str, lat: float) -> None:
    lon = np.linspace(-180, 180, 9)
    projection = PROJECTIONS[name]
    points = projection.positions(lon, np.full(9, lat))
    assert not np.isinf(points).any()
    assert points.shape == (9, 3)
    with np.errstate(all="ignore"):
        vectors = projection.vectors(lon, np.full(9, lat), np.ones(9), np.ones(9))
    if name == "globe":
        assert np.ptp(points, axis=0) == pytest.approx([0, 0, 0], abs=1e-6)
        assert np.linalg.norm(vectors, axis=-1) == pytest.approx(np.full(9, np.sqrt(2)))


def test_the_scale_is_that_of_the_map() -> None:
    assert PROJECTIONS["globe"].scales(np.array(0.0), np.array(0.0)) == 1.0
    mercator = PROJECTIONS["mercator"]
    for lat in (0.0, 30.0, 60.0):
        place = mercator.positions(np.array(10.0), np.array(lat))
        assert mercator.scales(*mercator.lonlat(place)) == pytest.approx(
            1 / np.cos(np.radians(lat)), rel=1e-5
        )


def test_names_in_any_case_and_codes_are_maps() -> None:
    assert map_name("Robinson") == "robinson"
    assert map_name("PlateCarree") == "platecarree"
    assert map_name(" Globe ") == "globe"
    assert map_name(3413) == map_name("3413") == "EPSG:3413"
    assert map_name("+proj=moll") == "+proj=moll"


def test_projections_of_pyproj_and_cartopy_are_maps() -> None:
    pyproj = pytest.importorskip("pyproj")
    ccrs = pytest.importorskip("cartopy.crs")
    polar = Projection(map_name(pyproj.CRS("EPSG:3413")))
    expected = pyproj.Transformer.from_crs("EPSG:4326", "EPSG:3413", always_xy=True)
    assert polar.positions(np.array(12.0), np.array(78.0))[:2] == pytest.approx(
        expected.transform(12.0, 78.0)
    )

    crs = ccrs.Mollweide(central_longitude=30)
    own = Projection(map_name(crs))
    place = crs.transform_point(12.0, 48.0, ccrs.Geodetic())
    assert own.positions(np.array(12.0), np.array(48.0))[:2] == pytest.approx(place, rel=1e-6)

    # Cartopy's plate carree has degrees, flowtex's metres.
    flat = Projection(map_name(ccrs.PlateCarree(central_longitude=30)))
    metres = np.radians([12.0 - 30.0, 48.0]) * EARTH_RADIUS
    assert flat.positions(np.array(12.0), np.array(48.0))[:2] == pytest.approx(metres)


@pytest.mark.parametrize(
    ("wanted", "message"),
    [
        (True, "projection is True; expected one of globe"),
        (1.5, "projection is 1.5; expected one of globe"),
        ("EPSG:4326", "'EPSG:4326' is in degrees; expected one of globe"),
        ("EPSG:2263", "'EPSG:2263' is in units of US survey foot; expected one of globe"),
        ("nowhere", "'nowhere' is unknown; expected one of globe"),
    ],
)
def test_other_projections_are_refused(wanted: object, message: str) -> None:
    with pytest.raises(FieldError, match=message):
        Projection(map_name(wanted))


def test_a_field_of_arrays_takes_the_name_of_its_map() -> None:
    lon, lat = np.meshgrid(np.linspace(0.0, 20.0, 5), np.linspace(40.0, 50.0, 4))
    globe = Projection("globe")
    points = globe.positions(lon, lat)
    flow = globe.vectors(lon, lat, np.full(lon.shape, 3.0), np.full(lon.shape, 4.0))
    field = FlowField.from_arrays(points, flow, projection="Globe")
    assert field.projection == globe
    values = field.at(11.0, 44.0)
    assert values is not None
    assert (values.eastward, values.northward) == pytest.approx((3.0, 4.0), rel=1e-2)
    with pytest.raises(FieldError, match=r"projection is 1\.5; expected one of globe"):
        FlowField.from_arrays(points, flow, projection=1.5)  # type: ignore[arg-type]
