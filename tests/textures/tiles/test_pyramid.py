"""What a pyramid's tiles cover, and that they hold what the whole field has there."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from small_tiles import TILE_CELLS

from flowtex._util.array_types import Floats
from flowtex.field import FlowField
from flowtex.textures.geometry import SurfaceGeometry
from flowtex.textures.texture_set import TextureSet
from flowtex.textures.tiles.grid_levels import averaged, beside, level_lines
from flowtex.textures.tiles.grid_pyramid import GridPyramid, is_cut
from flowtex.textures.tiles.pyramid import TileKey
from flowtex.trace.store import SliceStore
from flowtex.trace.trace import trace


@pytest.fixture(autouse=True)
def _small_roots(monkeypatch: pytest.MonkeyPatch, small_tiles: None) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 190)


def grid(rows: int, columns: int) -> tuple[Floats, Floats]:
    y, x = np.mgrid[0:rows, 0:columns].astype(float) / 100
    return x, y


def waves(rows: int = 74, columns: int = 84, **options: Any) -> FlowField:
    x, y = grid(rows, columns)
    velocity = np.stack([np.cos(3 * y) + 0.3, np.sin(4 * x)], axis=-1)
    return FlowField.from_arrays(np.stack([x, y], axis=-1), velocity, periodic="", **options)


def whole_layers(field: FlowField, like: TextureSet, step: int = 0) -> Floats:
    """Layers of all nodes, at the lags of a tile, (layers, J, I, 4)."""
    unit = like.store.unit.flat[0]
    slices = trace(field, lags=like.store.lags, unit=unit, compose=field.steady, progress=False)
    textures = TextureSet(
        SurfaceGeometry.of(field), SliceStore(field, slices=slices), whole_speed=like.whole_speed
    )
    layers = textures.layers(step, dtype=np.float64)
    layers[0, ..., 3] *= textures.unit / like.unit
    rows, columns = textures.grid.rows, textures.grid.columns
    return layers[
        :, rows.before : rows.before + rows.nodes, columns.before : columns.before + columns.nodes
    ]


def nodal(tile: TextureSet, step: int = 0) -> Floats:
    """Layers of the nodes that a tile draws."""
    layers, geometry = tile.layers(step, dtype=np.float32), tile.grid
    rows, columns = geometry.rows, geometry.columns
    return layers[
        :, rows.before : rows.before + rows.nodes, columns.before : columns.before + columns.nodes
    ] * np.float64(1)


def test_a_small_field_is_its_root() -> None:
    field = waves(10, 13)
    pyramid = GridPyramid(field)
    assert pyramid.depth == 0
    assert pyramid.children(None) == []
    np.testing.assert_array_equal(pyramid.root.velocity, field.velocity)


@pytest.mark.parametrize("shape", [(74, 84), (65, 129), (66, 150)])
def test_the_tiles_of_each_level_cover_its_cells_once(shape: tuple[int, int]) -> None:
    pyramid = GridPyramid(waves(*shape))
    keys = pyramid.children(None)
    for level in range(pyramid.depth - 1, -1, -1):
        covered = np.zeros([n - 1 for n in pyramid.shape(level)], dtype=int)
        for _, row, column in keys:
            covered[
                row * TILE_CELLS : (row + 1) * TILE_CELLS,
                column * TILE_CELLS : (column + 1) * TILE_CELLS,
            ] += 1
        assert (covered == 1).all()
        assert len(keys) == len({*keys})
        keys = [child for key in keys for child in pyramid.children(key)]


def test_nodes_of_a_level_are_nodes_of_the_field() -> None:
    field = waves()
    root = GridPyramid(field).root
    assert root.valid.size <= 190
    assert {*map(tuple, root.points.reshape(-1, 3))} <= {*map(tuple, field.points.reshape(-1, 3))}
    np.testing.assert_array_equal(root.points[-1, -1], field.points[-1, -1])
    assert root.shape == GridPyramid(field).shape(GridPyramid(field).depth)


def test_an_even_flow_stays_even_beside_land() -> None:
    x, y = grid(74, 84)
    land = np.hypot(x - 0.3, y - 0.3) < 0.1
    velocity = np.where(land[..., None], np.nan, np.stack([1 + 0 * x, 2 + 0 * x], axis=-1))
    root = GridPyramid(FlowField.from_arrays(np.stack([x, y], axis=-1), velocity)).root
    np.testing.assert_allclose(root.velocity[0][root.valid] - [1, 2, 0], 0, atol=1e-12)
    assert not root.velocity[0][~root.valid].any()


@pytest.mark.parametrize("key", [TileKey(0, 0, 0), TileKey(0, 1, 1)])
def test_slopes_of_a_tile_are_those_of_the_field(key: TileKey) -> None:
    field = waves(84, 100)
    tile = GridPyramid(field).textures(key)
    assert tile is not None
    mine = nodal(tile)
    row, column = (TILE_CELLS * at for at in key[1:])
    theirs = whole_layers(field, tile)[
        :, row : row + TILE_CELLS + 1, column : column + TILE_CELLS + 1
    ]
    assert mine.shape == theirs.shape
    assert np.abs(mine - theirs)[..., :3].max() < 2e-3
    np.testing.assert_allclose(mine[0, ..., 3], theirs[0, ..., 3], rtol=1e-5)


def test_slopes_go_on_across_the_seam_of_a_ring() -> None:
    a, r = np.meshgrid(np.linspace(0, 2 * np.pi, 301), np.linspace(1, 2, 40))
    points = np.stack([r * np.cos(a), r * np.sin(a)], axis=-1)
    velocity = np.stack([-np.sin(a) + 0.2 * np.cos(a), np.cos(a) + 0.2 * np.sin(a)], axis=-1)
    field = FlowField.from_arrays(points, velocity)
    assert field.periodic == (False, True)
    tiles = [GridPyramid(field).textures(TileKey(0, 0, at)) for at in (0, 4)]
    assert tiles[0] is not None
    assert tiles[1] is not None
    off = np.abs(nodal(tiles[0])[:, :, 0] - nodal(tiles[1])[:, :, -1])[..., :3].max(axis=(1, 2))
    lags = np.concatenate([[0.0], tiles[0].store.lags, tiles[0].store.lags, [0.0]])
    assert off[lags <= 32].max() < 1e-4  # longer ones only close the last interval


@pytest.mark.parametrize("closed", [False, True])
def test_tiles_traced_together_equal_tiles_traced_alone(*, closed: bool) -> None:
    if closed:
        a, r = np.meshgrid(np.linspace(0, 2 * np.pi, 97), np.linspace(1, 2, 129))
        points = np.stack([r * np.cos(a), r * np.sin(a)], axis=-1)
        velocity = np.stack([-np.sin(a) + 0.2 * np.cos(a), np.cos(a) + 0.2 * np.sin(a)], axis=-1)
        pyramid = GridPyramid(FlowField.from_arrays(points, velocity))
    else:
        pyramid = GridPyramid(waves())
    keys = [TileKey(0, j, i) for j in range(2) for i in range(2)]
    together = pyramid.tiles(keys, [0])
    stores = {textures.store for textures in together.values() if textures is not None}
    assert len(stores) == 1
    for key in keys:
        one, other = together[key], pyramid.tile(key, [0])
        assert one is not None
        assert other is not None
        # The last lag depends on the largest cells around.
        alike = len(other.store.lags) - 1
        np.testing.assert_array_equal(one.store.lags[:alike], other.store.lags[:alike])
        assert np.abs(nodal(one) - nodal(other))[: alike + 1, ..., :3].max() < 2e-3


def test_a_field_that_varies_is_followed_in_time() -> None:
    x, y = grid(74, 84)
    steps = [
        np.stack([np.cos(3 * y + t), np.sin(4 * x - t) + 0.2], axis=-1) for t in (0.0, 0.5, 1.0)
    ]
    field = FlowField.from_arrays(np.stack([x, y], axis=-1), np.stack(steps), times=[0.0, 0.2, 0.4])
    tile = GridPyramid(field).textures(TileKey(0, 0, 0))
    assert tile is not None
    mine = nodal(tile, 2)
    theirs = whole_layers(field, tile, 2)[:, : TILE_CELLS + 1, : TILE_CELLS + 1]
    off = np.abs(mine - theirs)[..., :3]
    assert np.percentile(off, 99.9) < 2e-3
    assert off.max() < 0.02  # one is integrated, the other composed


def test_a_tile_of_land_is_none() -> None:
    x, y = grid(74, 150)
    velocity = np.where((x < 0.8)[..., None], np.nan, np.ones((74, 150, 2)))
    pyramid = GridPyramid(FlowField.from_arrays(np.stack([x, y], axis=-1), velocity))
    assert pyramid.textures(TileKey(0, 0, 0)) is None
    assert pyramid.textures(TileKey(0, 0, 1)) is not None


@pytest.mark.parametrize("speed", [1e-40, 1e40])
def test_paths_that_a_halo_cuts_are_noticed_in_any_unit_of_time(speed: float) -> None:
    x, y = grid(74, 225)
    fast = 1 + 30 * np.exp(-(((y - 0.3) / 0.035) ** 2))
    points, velocity = np.stack([x, y], axis=-1), np.stack([fast, 0 * x], axis=-1)
    cut, layers = [], []
    for s in (1.0, speed):
        pyramid = GridPyramid(FlowField.from_arrays(points, s * velocity, periodic=""), "time")
        for widening in (1, 8):
            tile = pyramid.region([TileKey(0, 0, 1)], widening)[TileKey(0, 0, 1)]
            assert tile is not None
            cut.append(is_cut(tile, 0))
            product = tile.store.lags[:, None, None] * tile.store.unit * tile.pace
            assert tile.longest <= product[-1].max() < 8 * tile.longest
        assert tile is not None
        layers.append(nodal(tile))
    assert cut == [True, False] * 2
    np.testing.assert_allclose(layers[1][..., :3], layers[0][..., :3], rtol=1e-2, atol=1e-2)


def test_paths_over_a_pole_need_not_all_of_a_long_ring(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 1000)
    lon, lat = np.meshgrid(np.linspace(0, 2 * np.pi, 501), np.linspace(-0.5, 0.5, 130) * np.pi)
    points = np.stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)], axis=-1)
    pyramid = GridPyramid(FlowField.from_arrays(points, np.cross([0.3, 1.0, 0.1], points)))
    some = pyramid.textures(TileKey(0, 0, 1))
    monkeypatch.setattr(
        "flowtex.textures.tiles.grid_pyramid._ring", lambda _, count: np.arange(count)
    )
    whole = pyramid.textures(TileKey(0, 0, 1))
    assert whole is not None and some is not None
    assert some.geometry.field.shape[1] < 380 < whole.geometry.field.shape[1]
    np.testing.assert_array_equal(some.geometry.points, whole.geometry.points)
    count = min(len(whole.lags), len(some.lags)) - 2
    away = np.abs(nodal(some)[1:count, ..., :3] - nodal(whole)[1:count, ..., :3])
    assert np.percentile(away, 99) < 0.02
    assert np.abs(nodal(whole)[1:count, ..., :3]).mean() > 0.3


@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("holes", [False, True])
def test_averages_are_those_of_the_nine_nodes_around(closed: bool, holes: bool) -> None:
    rng = np.random.default_rng(0)
    shape = (601, 13)
    velocity = rng.normal(size=(*shape, 2))
    valid = np.ones(shape, dtype=bool)
    if holes:
        valid = rng.random(shape) > 0.4
    lines = [beside(level_lines(n, 1), n, closed=closed) for n in shape]
    found = averaged(velocity, valid, *lines)
    weights = np.array([1, 2, 1]) / 4
    for j, i in [(0, 0), (150, 3), (300, 6), (129, 5)]:
        at = np.ix_(lines[0][:, j], lines[1][:, i])
        share = np.outer(weights, weights) * valid[at]
        total = (share[..., None] * velocity[at]).sum(axis=(0, 1))
        assert found[j, i] == pytest.approx(total / max(share.sum(), 1e-300))
