"""Land and sea by the coasts, and which cells without data are which."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

from flowtex import FlowField
from flowtex.field.earth.on_land import on_land
from flowtex.field.earth.projection import Projection
from flowtex.rendering.map_overlay import ground_cells, missing_colour

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
