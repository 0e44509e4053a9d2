"""Levels and tiles of surfaces of triangles."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from triangle_meshes import cube, joined, random_plane, sheet, sphere, surface_of

import flowtex
from flowtex import FlowField
from flowtex._util.array_types import Floats, Indices
from flowtex._util.progress import Stopped, stoppable
from flowtex.textures.texture_set import TextureSet
from flowtex.textures.tiles.clusters import MERGED, Clusters, Levels
from flowtex.textures.tiles.pyramid import TileKey
from flowtex.textures.tiles.shared import shared_pyramid
from flowtex.textures.tiles.triangle_pyramid import TrianglePyramid
from flowtex.textures.triangle_geometry import TriangleGeometry
from flowtex.trace.store import SliceStore
from flowtex.trace.trace import trace


@pytest.fixture(autouse=True)
def _small_roots(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.triangle_pyramid.ROOT_NODES", 350)
    # As any surface has:


def flow_on(points: Floats, triangles: Indices, **options: Any) -> FlowField:
    flat = not points[:, 2].any()
    velocity = np.cross(points, [0.3, 0.2, 1.0]) + np.array([0.2, 0.1, 0.3])
    velocity[:, 2] *= not flat
    return FlowField.from_triangles(points, triangles, velocity, **options)


def plane(rng: np.random.Generator, nodes: int = 3000, **options: Any) -> FlowField:
    return flow_on(*random_plane(rng, nodes), **options)


def graded(rng: np.random.Generator) -> FlowField:
    return flow_on(*random_plane(rng, 4000, grading=1000.0))


def ball() -> FlowField:
    return flow_on(*sphere(4))


def shells() -> FlowField:
    """Four spheres, one in another, in which neither points nor triangles are in order."""
    points, triangles = sphere(4)
    numbers = np.concatenate([triangles + k * len(points) for k in range(4)])
    nested = np.concatenate([points * radius for radius in (2, 4, 1, 3)])
    return flow_on(nested, np.random.default_rng(0).permutation(numbers))


def drawn(pyramid: TrianglePyramid, key: TileKey) -> TriangleGeometry:
    textures = pyramid.textures(key)
    assert textures is not None
    assert isinstance(textures.geometry, TriangleGeometry)
    return textures.geometry


def test_levels_keep_the_means(rng: np.random.Generator) -> None:
    points, triangles = random_plane(rng, 3000)
    pressure = points[:, 0] ** 2
    field = flow_on(points, triangles, scalars={"p": pressure})
    for level in Levels(field, 200)[1:]:
        inside = level.number >= 0
        assert inside.mean() > 0.98
        count = np.bincount(level.number[inside], minlength=level.field.shape[1])
        mean = count @ level.field.velocity[0, 0] / count.sum()
        np.testing.assert_allclose(mean, field.velocity[0, 0, inside].mean(axis=0), rtol=1e-9)
        mean = count @ level.field.scalars["p"][0, 0] / count.sum()
        assert mean == pytest.approx(pressure[inside].mean())


@pytest.mark.parametrize("make", [plane, graded])
def test_a_level_has_the_outline_of_the_field(make: Any, rng: np.random.Generator) -> None:
    field = make(rng)
    for level in Levels(field, 200)[1:]:
        p, side = level.field.points[0], level.sides / 2
        corners = p[level.triangles]
        area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] / 2
        # Nothing is turned over, and what is missing is at the corners.
        assert area.min() > 0 or area.max() < 0
        assert abs(np.abs(area).sum() - 1) < 4 * side.max() ** 2
        outside = np.stack([p[:, 0], 1 - p[:, 0], p[:, 1], 1 - p[:, 1]]).min(axis=0)
        used = np.isin(np.arange(len(p)), level.triangles)
        assert outside.min() > -1e-9
        assert (outside < side)[level.border & used].all()


def test_a_closed_surface_stays_closed() -> None:
    levels = Levels(ball(), 200)
    assert [level.field.shape[1] for level in levels][-1] < 230
    for level in levels[1:]:
        surface = level.field.surface
        assert (surface.neighbours >= 0).mean() > 0.99  # type: ignore[union-attr]
        p = level.field.points[0]
        outward = np.einsum("nc,nc->n", surface.normals[0], p)  # type: ignore[union-attr]
        assert outward.min() > 0 or outward.max() < 0
        assert np.ptp(np.linalg.norm(p, axis=1)) < (level.sides.max() / 2) ** 2


def test_sides_of_a_thin_sheet_stay_apart(rng: np.random.Generator) -> None:
    points, triangles = cube(40)
    field = flow_on(points * [1.0, 1.0, 1e-3], triangles)
    level = Levels(field, 200)[1]
    near = np.abs(level.field.points[0][:, :2]).max(axis=1) < 0.9
    assert (np.abs(level.field.points[0][near, 2]) > 0.9e-3).all()


def test_surfaces_close_to_one_another_stay_apart() -> None:
    points, triangles = sphere(4)
    field = flow_on(*joined((points, triangles), (1.01 * points, triangles)))
    outer = np.arange(2 * len(points)) >= len(points)
    for level in Levels(field, 200)[1:]:
        kept = level.number >= 0
        count = np.bincount(level.number[kept])
        of_outer = np.bincount(level.number[kept], outer[kept])
        assert ((of_outer == 0) | (of_outer == count)).all()
        assert level.field.shape[1] > 50


def test_turns_of_a_roll_stay_apart() -> None:
    # Turns that are connected along the roll only, closer to each other than the bins.
    points, triangles = sheet(np.zeros((40, 300)))
    angle = points[:, 0] * (6 * np.pi / 299)
    along = points[:, 1] * (2 / 39)
    radius = 1 + 0.04 * angle / (2 * np.pi)
    roll = np.stack([radius * np.cos(angle), radius * np.sin(angle), along], axis=-1)
    field = flow_on(roll, triangles)
    assert field.shape[1] == len(points)
    levels = Levels(field, 300)
    assert len(levels) >= 3
    for level in levels[1:]:
        kept = np.flatnonzero(level.number >= 0)
        number = level.number[kept]
        ends = np.full((2, level.field.shape[1]), np.inf)
        np.minimum.at(ends[0], number, angle[kept])
        np.minimum.at(ends[1], number, -angle[kept])
        assert (-ends[1] - ends[0]).max() < np.pi


def open_sides(level: Clusters) -> int:
    """Return how many sides of triangles lie away from the border of the surface."""
    surface = surface_of(level.field)
    triangle, corner = np.nonzero(surface.neighbours < 0)
    ends = surface.triangles[triangle[:, None], (corner[:, None] + [1, 2]) % 3]
    return int((~level.border[ends].all(axis=1)).sum())


def test_levels_of_rough_terrain_are_smooth_and_whole(rng: np.random.Generator) -> None:
    side = 120
    points, triangles = sheet(rng.normal(size=(side, side)))
    levels = Levels(flow_on(points, triangles), 600)
    assert levels[0].field.shape[1] == side**2
    for finer, level in itertools.pairwise(levels):
        assert level.field.shape[1] < 0.4 * finer.field.shape[1]
        assert open_sides(level) < 0.01 * len(level.triangles)
    # The noise of the means is less than a cell, so that the surface is hardly larger than flat.
    area = np.linalg.norm(surface_of(levels[-1].field).crosses, axis=1).sum() / 2
    assert area == pytest.approx((side - 1) ** 2, rel=0.02)


def test_two_sides_of_a_rough_sheet_stay_apart(rng: np.random.Generator) -> None:
    heights = rng.normal(size=(60, 60))
    points, triangles = sheet(heights)
    # Two sides that are joined along one border only, closer to each other than the bins.
    rim = np.zeros((60, 60), dtype=bool)
    rim[0] = True
    below = np.where(rim.ravel(), np.arange(len(points)), np.arange(len(points)) + len(points))
    lower = points - [0, 0, 0.3]
    both = np.concatenate([points, lower]), np.concatenate([triangles, below[triangles[:, ::-1]]])
    field = flow_on(*both)
    is_lower = np.asarray(np.isin(field.points[0].round(9), lower.round(9)).all(axis=1))
    x, y = field.points[0, :, :2].T
    inside = (np.minimum(x, y) > 20) & (np.maximum(x, y) < 40)
    for level in Levels(field, 600)[1:]:
        kept = (level.number >= 0) & inside
        count = np.bincount(level.number[kept])
        of_lower = np.bincount(level.number[kept], is_lower[kept])
        assert ((of_lower == 0) | (of_lower == count)).mean() > 0.97


def test_steps_smaller_than_bins_become_a_slope() -> None:
    points, triangles = sheet(np.zeros((80, 80)))
    number = points[:, 0].copy()
    points[:, 0] = np.ceil(number / 2)
    points[:, 2] = np.floor(number / 2)
    levels = Levels(flow_on(points, triangles), 300)
    assert surface_of(levels[0].field).at_edge.mean() > 0.9
    last = levels[-1]
    assert last.field.shape[1] < 600
    assert (last.face == MERGED).mean() > 0.3
    x, _, z = last.field.points[0].T
    assert np.abs(x - z).max() < 1.5


@pytest.mark.parametrize("make", [plane, graded, lambda rng: ball(), lambda rng: shells()])
def test_every_point_is_covered_by_the_tiles_of_a_level(
    make: Any, rng: np.random.Generator
) -> None:
    field = make(rng)
    pyramid = TrianglePyramid(field)
    assert pyramid.depth >= 2
    keys = pyramid.children(None)
    while keys:
        level = pyramid.at_level(keys[0].level)
        assert level.triangles is not None
        found = np.zeros(len(level.triangles), dtype=int)
        order = np.lexsort(np.sort(level.triangles, axis=1).T)
        whole = level.points[0][level.triangles].mean(axis=1)
        places = {tuple(p): n for n, p in enumerate(np.round(whole, 9))}
        for key in keys:
            geometry = drawn(pyramid, key)
            # By its corners' places a triangle is found again in the whole level.
            middle = geometry.points[0][geometry.triangles].mean(axis=1)
            at = [places[tuple(p)] for p in np.round(middle, 9)]
            found[at] += 1
            assert geometry.blocks.min() >= 1 and geometry.blocks.max() <= 15
        assert (found[order] >= 1).all()
        assert (found > 1).mean() < 0.5
        keys = [child for key in keys for child in pyramid.children(key)]


def test_levels_between_are_made_when_they_are_needed(rng: np.random.Generator) -> None:
    levels = Levels(flow_on(*random_plane(rng, 12000)), 200)
    assert len(levels) > 3
    made = vars(levels)["_made"]
    expected = [levels.nodes(number) for number in range(len(levels))]
    assert 1 not in made
    assert levels[1] is levels[1] is made[1]
    counts = [level.field.shape[1] for level in levels]
    assert counts == [levels.nodes(number) for number in range(len(levels))]
    np.testing.assert_allclose(expected, counts, rtol=0.3)
    assert all(0.15 < after / before < 0.4 for before, after in itertools.pairwise(counts))


def test_making_levels_can_be_cancelled(rng: np.random.Generator) -> None:
    with pytest.raises(Stopped), stoppable(lambda: True):
        Levels(plane(rng), 200)


def with_crumbs(rng: np.random.Generator) -> FlowField:
    """A plane, and triangles far from it and smaller than the bins of coarse levels."""
    points, triangles = random_plane(rng, 3000)
    crumb = np.array([[0.0, 0.0, 0.0], [0.01, 0.0, 0.0], [0.0, 0.01, 0.0]])
    places = np.array([[2.0, k / 5, 0.01] for k in range(5)])
    crumbs = [(crumb + place, np.array([[0, 1, 2]])) for place in places]
    return flow_on(*joined((points, triangles), *crumbs))


@pytest.mark.parametrize("make", [plane, graded, lambda rng: shells(), with_crumbs])
def test_blocks_are_known_from_a_coarse_level(make: Any, rng: np.random.Generator) -> None:
    field = make(rng)
    pyramid = TrianglePyramid(field)
    places = pyramid.places(0).reshape(-1, 5)
    assert 0 < pyramid.depth == len(pyramid._clusters) - 1
    points = field.points[0]
    corners = points[field.triangles]
    middles = corners.mean(axis=1)
    # Each triangle's middle is in the ball of a block with cells of about its size.
    gap = np.linalg.norm(middles[:, None] - places[:, :3], axis=-1) - places[:, 3]
    assert (gap.min(axis=1) <= 0).all()
    side = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=-1).max(axis=1)
    nearest = places[np.argmin(gap, axis=1), 4]
    assert np.percentile(side / nearest, [5, 50]) == pytest.approx([2, 3], abs=1.9)


def test_surfaces_in_one_another_are_in_tiles_of_their_own() -> None:
    pyramid = TrianglePyramid(shells())
    keys = pyramid.children(None)
    radii = [np.linalg.norm(drawn(pyramid, key).points[0], axis=1) for key in keys]
    assert sorted(round(float(np.median(radius))) for radius in radii) == [1, 2, 3, 4]
    assert all(np.ptp(radius) < 0.3 for radius in radii)


def test_a_small_field_is_its_root(rng: np.random.Generator) -> None:
    pyramid = TrianglePyramid(plane(rng, 200))
    assert pyramid.depth == 0
    assert pyramid.root is pyramid.field
    assert pyramid.children(None) == []


@pytest.mark.parametrize("make", [plane, lambda rng: ball()])
def test_slopes_of_a_tile_are_those_of_the_field(make: Any, rng: np.random.Generator) -> None:
    field = make(rng)
    tile = TrianglePyramid(field).textures(TileKey(0, 1, 2))
    assert tile is not None
    mine = tile.layers(0).reshape(tile.count, -1, 4)[:, : tile.geometry.shape[1]]
    unit = float(tile.store.unit.flat[0])
    slices = trace(field, lags=tile.store.lags, unit=unit, progress=False)
    whole = TextureSet(
        TriangleGeometry.of(field), SliceStore(field, slices=slices), whole_speed=tile.whole_speed
    )
    theirs = whole.layers(0).reshape(whole.count, -1, 4)[:, : field.shape[1]]
    points = {tuple(p): n for n, p in enumerate(field.points[0])}
    at = [points[tuple(p)] for p in tile.geometry.points[0]]
    off = np.abs(mine - theirs[:, at])[..., :3]
    assert np.percentile(off, 99.5) < 2e-3


def test_nodes_without_data_are_in_no_mean(rng: np.random.Generator) -> None:
    points, triangles = random_plane(rng, 3000)
    land = np.hypot(points[:, 0] - 0.5, points[:, 1] - 0.5) < 0.2
    velocity = np.where(land[:, None], np.nan, [1.0, 2.0, 0.0])
    pyramid = TrianglePyramid(FlowField.from_triangles(points, triangles, velocity))
    root = pyramid.root
    used = np.unique(pyramid.root_geometry.triangles)
    np.testing.assert_allclose(root.velocity[0, 0, used] - [1, 2, 0], 0, atol=1e-12)
    away = np.hypot(*(root.points[0, used, :2] - 0.5).T)
    assert away.min() > 0.2


@pytest.mark.parametrize("zoom", [1.0, 6.0])
def test_a_picture_of_tiles_is_that_of_the_whole(
    zoom: float, rng: np.random.Generator, monkeypatch: pytest.MonkeyPatch
) -> None:
    points, triangles = random_plane(rng, 5000)
    options: dict[str, Any] = {"size": (160, 120), "zoom": zoom, "scalars": "speed"}
    tiled = flowtex.render(flow_on(points, triangles), **options).astype(float)
    monkeypatch.setattr("flowtex.textures.tiles.triangle_pyramid.ROOT_NODES", 10**6)
    whole = flow_on(points * 1.0, triangles)
    assert shared_pyramid(whole, "arclength", "streamlines").depth == 0
    off = np.abs(tiled - flowtex.render(whole, **options))[..., :3]
    assert np.median(off) <= 4
    assert off.mean() < 10
