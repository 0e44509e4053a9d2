"""Land and sea by the coasts, and which cells without data are which."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

from flowtex import FlowField
from flowtex.field.earth.coast import Coast
from flowtex.field.earth.on_land import on_land
from flowtex.field.earth.projection import Projection
from flowtex.rendering.map_overlay import ground_cells, ground_kinds, missing_colour

LAND = [(10, 50), (-100, 40), (135, -25), (180, 67), (-179.5, 66.5), (20, 0), (0, -90), (170, -85)]
SEA = [(0, 90), (-40, 30), (179, -17), (-75, 39), (0, 0), (51, 42), (-177, -70), (540, 0)]


def test_places_are_on_land_or_at_sea() -> None:
    assert on_land(*np.array(LAND, dtype=float).T).all()
    assert not on_land(*np.array(SEA, dtype=float).T).any()
    assert not on_land(np.array([np.nan, 10.0]), np.array([50.0, np.inf])).any()


def test_the_share_of_land_is_that_of_the_earth() -> None:
    lon, lat = np.meshgrid(np.arange(-179.5, 180), np.arange(-89.5, 90))
    weights = np.cos(np.radians(lat))
    share = (on_land(lon, lat) * weights).sum() / weights.sum()
    assert share == pytest.approx(0.292, abs=0.01)


@pytest.mark.parametrize("name", ["platecarree", "robinson", "globe"])
@pytest.mark.parametrize("tiled", [False, True])
def test_sea_without_data_is_not_land(name: str, tiled: bool) -> None:
    projection = Projection(name)
    lon, lat = np.meshgrid(np.linspace(-60.0, 10.0, 71), np.linspace(40.0, 60.0, 41))
    east = np.where((lon > -40) & (lon < -20), 1.0, np.nan)
    field = FlowField.from_arrays(
        projection.positions(lon, lat),
        projection.vectors(lon, lat, east, 0 * lon),
        length_unit="m",
        time_unit="s",
        projection=projection,
    )
    ground = ground_cells(field, tiled=tiled)
    empty = field.surface.placed_cells
    if not tiled:
        empty = empty & ~field.surface.cells
    np.testing.assert_array_equal(ground.land | ground.missing, empty)
    assert not (ground.land & ground.missing).any()
    middle_lon = (lon[1:, 1:] + lon[:-1, :-1]) / 2
    middle_lat = (lat[1:, 1:] + lat[:-1, :-1]) / 2
    expected = empty & on_land(middle_lon, middle_lat)
    assert ground.land[expected].all()
    # Masks of models do not match coasts exactly.
    reach = scipy.ndimage.binary_dilation(expected, np.ones((3, 3), dtype=bool), iterations=3)
    assert not (ground.land & ~reach).any()
    assert ground.missing.sum() > 300


@pytest.mark.parametrize("background", [(1.0, 1.0, 1.0), (0.0, 0.0, 0.0), (0.1, 0.1, 0.3)])
def test_missing_data_look_near_the_background(background: tuple[float, ...]) -> None:
    difference = np.abs(missing_colour(background) - background).max()
    assert 0.05 < difference < 0.2


#: An island of the user where there is sea, and a lake in it.
ISLAND = np.array([(-45, 35), (-35, 35), (-35, 45), (-45, 45), (-45, 35)], dtype=float)
LAKE = np.array([(-41, 39), (-39, 39), (-39, 41), (-41, 41), (-41, 39)], dtype=float)


def test_closed_lines_of_the_user_are_land() -> None:
    coast = Coast.of([ISLAND, LAKE])
    assert coast.is_closed
    lon = np.array([-43.0, -40.0, 317.0, -20.0, 10.0, -44.99])
    lat = np.array([37.0, 40.0, 37.0, 40.0, 50.0, 34.9])
    np.testing.assert_array_equal(on_land(lon, lat, coast), [True, False, True, False, True, False])
    assert not on_land(lon[:4], lat[:4]).any()


def test_open_lines_of_the_user_leave_land_to_the_coasts() -> None:
    coast = Coast.of([ISLAND[:-1], np.array([[0.0, 50.0], [20.0, 50.0]])])
    assert not coast.is_closed
    found = on_land(np.array([-43.0, 10.0]), np.array([37.0, 50.0]), coast)
    np.testing.assert_array_equal(found, [False, True])


def test_land_of_a_picture_is_that_of_the_lines() -> None:
    projection = Projection("platecarree")
    lon, lat = np.meshgrid(np.linspace(-60.0, 0.0, 61), np.linspace(30.0, 50.0, 21))
    inside = (np.abs(lon + 40) <= 4) & (np.abs(lat - 40) <= 4)
    field = FlowField.from_arrays(
        projection.positions(lon, lat),
        projection.vectors(lon, lat, np.where(inside, np.nan, 1.0), 0 * lon),
        length_unit="m",
        time_unit="s",
        projection=projection,
    )
    own = ground_cells(field, coast=Coast.of([ISLAND]))
    assert own.land.sum() == 100 and not own.missing.any()
    assert ground_kinds(field, Coast.of([ISLAND])) == ()
    assert not ground_cells(field).land.any() and ground_kinds(field) == ("no data",)
