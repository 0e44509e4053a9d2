"""Arrows are even on the screen, stay where they are, lie on the paths, and show the sense."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from flows import gyre, holed, lines, torus
from matrix import straight
from scipy import ndimage
from scipy.spatial import cKDTree

import flowtex
from flowtex import FlowField
from flowtex._util.array_types import Bytes, Floats
from flowtex.field.grids.grid_surface import GridSurface
from flowtex.quality import spacing
from flowtex.rendering.arrow_seeds import ArrowSeeds, Seeds
from flowtex.rendering.camera import Camera
from flowtex.rendering.tile_choice import TileView
from flowtex.rendering.uniforms import ARROW_LEAST
from flowtex.textures.geometry import SurfaceGeometry
from flowtex.trace.trace import paths

SIZE = (600, 400)
SPACING = 40  #: Pixels from an arrow to the next.
MOST_UNEVEN = 0.25  #: Deviation of the distance from an arrow to the next one, over the mean.
#: Nothing but the arrows.
PLAIN: dict[str, Any] = {
    "scalars": False,
    "color": "white",
    "strength": 0.0,
    "lighting": False,
    "samples": 1,
    "background": "black",
    "size": SIZE,
}


@cache
def globe() -> FlowField:
    """A stream around the whole Earth, closed at its poles."""
    longitude, latitude = np.radians(np.meshgrid(np.linspace(0, 360, 91), np.linspace(-90, 90, 46)))
    around, up = np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude)
    points = np.stack([around, up, np.sin(latitude)], axis=-1)
    velocity = np.cross([0.3, 0.5, 1.0], points)
    return FlowField.from_arrays(points, velocity)


def crooked() -> FlowField:
    """A stream across sheared cells, fifty times as large in a corner as in another."""
    s, t = np.meshgrid(np.linspace(0.14, 1, 61), np.linspace(0.14, 1, 41))
    points = np.stack([3 * s**2 + t**2, 2 * t**2 + 0.1 * np.sin(7 * s)], axis=-1)
    return FlowField.from_arrays(points, np.stack([1 + 0 * s, 0.5 * s], axis=-1))


def drawn(field: FlowField, **options: Any) -> Bytes:
    return flowtex.render(field, **{**PLAIN, **options})


def middles(picture: Bytes) -> Floats:
    """Middles of what is dark and touches neither border nor background, (N, 2)."""
    labels, count = ndimage.label(picture[..., 0] < 110, np.ones((3, 3)))
    inside = set(range(1, count + 1)) - {*labels[[0, -1]].ravel(), *labels[:, [0, -1]].ravel()}
    numbers = [n for n in inside if 20 < (labels == n).sum() < SPACING**2 / 2]
    return np.array(ndimage.center_of_mass(np.ones(SIZE[::-1]), labels, numbers))


@pytest.mark.parametrize("zoom", [1.0, 100.0])
@pytest.mark.parametrize("make", [gyre, crooked, globe])
def test_arrows_are_even_on_the_screen(make: Any, zoom: float) -> None:
    places = middles(drawn(make(), arrows=SPACING, zoom=zoom))
    apart = np.asarray(cKDTree(places).query(places, 2)[0])[:, 1]
    assert len(places) > 30
    assert spacing(places) <= MOST_UNEVEN
    assert 0.8 * SPACING < apart.mean() < 1.2 * SPACING


def view_of(camera: Camera) -> TileView:
    """A view without perspective, down onto a plane."""
    (x, y, _), half = camera.focal_point, camera.parallel_scale
    wide = half * SIZE[0] / SIZE[1]
    sides = [[1, 0, 0, wide - x], [-1, 0, 0, wide + x], [0, 1, 0, half - y], [0, -1, 0, half + y]]
    return TileView(None, half, SIZE[1], np.array(sides, dtype=float))


@cache
def gyre_seeds() -> tuple[SurfaceGeometry, ArrowSeeds]:
    geometry = SurfaceGeometry.of(gyre())
    return geometry, ArrowSeeds(geometry)


def seen(camera: Camera) -> tuple[Seeds, Floats]:
    """Return the seeds that are shown, made again, and their points, (N, 2)."""
    geometry, seeds = gyre_seeds()
    shown = seeds.seen(view_of(camera), ARROW_LEAST * SPACING)
    pixel = 2 * camera.parallel_scale / SIZE[1]
    shown = shown[shown.radius >= ARROW_LEAST * SPACING * pixel]
    points = (shown.position @ geometry.frame + geometry.center)[:, :2]
    away = np.abs(points - camera.focal_point[:2])
    inside = np.flatnonzero((away < pixel * np.array(SIZE) / 2).all(axis=-1))
    return shown[inside], points[inside]


def kept(before: Camera, after: Camera) -> float:
    """Share of the arrows of a view that are in another one, of those whose place is."""
    (_, points), (_, others) = seen(before), seen(after)
    half = after.parallel_scale * np.array([SIZE[0] / SIZE[1], 1.0])
    points = points[(np.abs(points - after.focal_point[:2]) < half).all(axis=-1)]
    assert len(points) > 40
    there = set(map(tuple, others))
    return float(np.mean([tuple(point) in there for point in points]))


@pytest.mark.parametrize("zoom", [1.0, 3.0, 50.0, 2000.0])
def test_a_zoom_only_adds_arrows_and_a_pan_moves_none(zoom: float) -> None:
    assert kept(straight(zoom), straight(1.01 * zoom)) > 0.99
    assert kept(straight(zoom), straight(zoom, (0.63 + 0.1 / zoom, 0.37))) > 0.99


def test_a_zoom_by_one_in_a_hundred_adds_few() -> None:
    """Seen the other way round: those of the nearer view are in the farther one."""
    shares = [kept(straight(1.01 * zoom), straight(zoom)) for zoom in np.geomspace(2, 8, 9)]
    assert min(shares) > 0.9


@pytest.mark.parametrize("zoom", [2.0, 16.0, 256.0])
def test_an_arrow_lies_on_the_path_through_its_seed_and_points_along_it(zoom: float) -> None:
    camera = straight(zoom)
    picture = drawn(gyre(), arrows=SPACING, camera=camera, background="white")
    seeds, points = seen(camera)
    pixel = 2 * camera.parallel_scale / SIZE[1]
    surface = gyre().surface
    assert isinstance(surface, GridSurface)
    row, column = np.divmod(seeds.cell, gyre().shape[1] - 1)
    start = np.stack([column, row], axis=-1) + seeds.place
    lags = np.linspace(0, 0.4, 13)[1:] * SPACING
    sides = [
        surface.at(paths(gyre(), start, lags * pixel, forward=forward).positions)
        for forward in (False, True)
    ]
    begin = surface.at(start)[None]
    way = np.concatenate([sides[0][::-1], begin, sides[1]])[..., :2]  # from tail to head
    way += points - begin[..., :2]  # cells are drawn flat
    at = (way - camera.focal_point[:2]) / pixel * (1, -1) + np.array(SIZE) / 2 - 0.5
    onward = np.gradient(at, axis=0)
    across = onward[..., ::-1] * (-1, 1) / np.linalg.norm(onward, axis=-1, keepdims=True)
    aside = np.arange(-5, 6)
    around = at[..., None, :] + aside[:, None] * across[..., None, :]
    inside = ((around > 1) & (around < np.array(SIZE) - 2)).all(axis=(0, 2, 3))
    dark = 1 - ndimage.map_coordinates(picture[..., 0] / 255.0, around[..., ::-1].T, order=1).T
    width = dark.sum(axis=-1)
    place = (dark * aside).sum(axis=-1) / np.maximum(width, 1e-9)
    body = inside & (width[6:-6] > 0.5).all(axis=0)  # others end at the border
    assert body.sum() > 30
    off = np.abs(place[6:-6, body])
    # Beside a centre an arrow follows the velocity of one cell over several: it may be a pixel off.
    assert np.quantile(off, 0.995) < 0.75 and off.max() < 1.5
    head, tail = width[13:, body].max(axis=0), width[:12, body].max(axis=0)
    assert np.mean(head > 1.5 * tail) >= 0.95
    assert len(points) == len(place.T)


def test_there_is_none_without_a_sign_nor_in_a_hole() -> None:
    assert (drawn(lines(), arrows=SPACING) == drawn(lines())).all()
    picture, empty = drawn(holed(), arrows=30), drawn(holed())
    outside = (empty == 0).all(axis=-1)
    hole = ndimage.binary_erosion(outside, iterations=6)  # but for half the width of a head
    assert hole[SIZE[1] // 2, SIZE[0] // 2]
    assert picture[hole].max() == 0
    assert len(middles(picture)) > 30


def test_arrows_are_shown_in_perspective_and_gone_when_switched_off() -> None:
    scene = {"camera": [(2.4, -1.9, 1.5), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)]}
    assert len(middles(drawn(torus(), arrows=True, **scene))) > 20
    assert (drawn(torus(), arrows=False, **scene) == drawn(torus(), **scene)).all()


@pytest.mark.parametrize(
    ("make", "power", "offset"),
    [(gyre, 40, 0.0), (globe, -40, 0.0), (gyre, 40, 1e12), (globe, 0, 2.0**36)],
)
def test_arrows_have_their_shape_at_any_scale_and_place(
    make: Any, power: int, offset: float
) -> None:
    field = make()
    points = np.ldexp(field.points, power) + offset
    far = FlowField.from_arrays(points, field.velocity[0], valid=field.valid)
    ours, theirs = drawn(field, arrows=SPACING).astype(int), drawn(far, arrows=SPACING).astype(int)
    assert (ours[..., 0] < 110).mean() > 0.02
    assert (np.abs(ours - theirs).max(axis=-1) > 60).mean() < 2e-3
