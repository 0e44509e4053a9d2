"""Triangles of a surface by level: no crack, no lost cell, and an error that is kept."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np
import pytest

from flowtex._util.array_types import Floats, Indices
from flowtex.field import FlowField
from flowtex.rendering.mesh_levels import MAX_ERROR_PIXELS, MeshLevels, Region, join
from flowtex.textures.tiles.blocks import BLOCK_CELLS
from flowtex.textures.tiles.grid_pyramid import TILE_BLOCKS, GridPyramid
from flowtex.textures.tiles.pyramid import Pyramid, TileKey

SHAPES = [(2, 2), (65, 65), (66, 130), (64, 200), (3, 300), (100, 2)]


def grid(shape: tuple[int, int], height: float = 0.0) -> Floats:
    """Nodes of unit cells, bent by a wave of some height."""
    y, x = np.mgrid[0 : shape[0], 0 : shape[1]].astype(float)
    return np.stack([x, y, height * np.sin(0.11 * x) * np.cos(0.07 * y)], axis=-1)


def whole(shape: tuple[int, int]) -> Any:
    return np.ones((shape[0] - 1, shape[1] - 1), dtype=bool)


def edges(triangles: Indices) -> Counter[tuple[int, int]]:
    """How many triangles have each edge."""
    pairs = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    return Counter(map(tuple, np.sort(pairs, axis=1).tolist()))


def area(points: Floats, triangles: Indices) -> float:
    a, b, c = (points.reshape(-1, 3)[triangles[:, k]] for k in range(3))
    return float(0.5 * np.cross(b - a, c - a)[:, 2].sum())


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("seed", range(2))
def test_neighbours_of_any_levels_join_without_cracks(shape: tuple[int, int], seed: int) -> None:
    points, rng = grid(shape), np.random.default_rng(seed)
    mesh = MeshLevels(points, whole(shape))
    levels = rng.integers(0, len(mesh.error), mesh.error.shape[1:])
    triangles = mesh.triangles(levels)
    assert area(points, triangles) == pytest.approx((shape[0] - 1) * (shape[1] - 1))
    for (a, b), count in edges(triangles).items():
        j, i = np.divmod([a, b], shape[1])
        outside = any(
            (k == end).all() for k, n in ((j, shape[0]), (i, shape[1])) for end in (0, n - 1)
        )
        assert count == (1 if outside else 2)


def test_the_finest_level_is_every_cell_and_a_flat_grid_two_triangles_a_tile() -> None:
    shape = (70, 90)
    mesh = MeshLevels(grid(shape), whole(shape))
    triangles = mesh.triangles(np.zeros(mesh.error.shape[1:], dtype=int))
    assert len(triangles) == 2 * 69 * 89
    assert len(np.unique(triangles)) == 70 * 90
    shape = (4 * BLOCK_CELLS + 1, 2 * BLOCK_CELLS + 1)
    mesh = MeshLevels(grid(shape), whole(shape))
    assert len(mesh.triangles(mesh.levels(None, 130.0, 600))) == 16


@pytest.mark.parametrize("level", [1, 2, 4])
def test_no_node_is_farther_from_the_triangles_than_the_error(level: int) -> None:
    shape = (129, 193)
    points = grid(shape, height=4.0)
    mesh = MeshLevels(points, whole(shape))
    step = 1 << level
    j, i = np.mgrid[0 : shape[0], 0 : shape[1]]
    a, b = (
        np.minimum(j // step * step, shape[0] - 1 - step),
        np.minimum(i // step * step, shape[1] - 1 - step),
    )
    s, t = ((i - b) / step)[..., None], ((j - a) / step)[..., None]
    p, q, r, u = points[a, b], points[a, b + step], points[a + step, b + step], points[a + step, b]
    drawn = np.where(s >= t, p + s * (q - p) + t * (r - q), p + t * (u - p) + s * (r - u))
    off = np.linalg.norm(drawn - points, axis=-1).max()
    assert 0.1 * mesh.error[level].max() < off <= mesh.error[level].max()


def test_levels_follow_the_error_on_the_screen() -> None:
    shape = (257, 257)
    mesh = MeshLevels(grid(shape, height=0.3), whole(shape))
    counts = []
    for half in (1000.0, 130.0, 1.0):
        levels = mesh.levels(None, half, 600)
        pixels = 0.5 * 600 / half
        chosen = np.take_along_axis(mesh.error, levels[None], axis=0)[0]
        assert (chosen[levels > 0] * pixels <= MAX_ERROR_PIXELS).all() or pixels < 1
        counts.append(len(mesh.triangles(levels)))
    assert counts[0] < counts[1] < counts[2] == 2 * 256**2


def test_no_triangle_covers_what_is_blanked() -> None:
    shape = (200, 300)
    points, cells = grid(shape), whole(shape)
    cells[70:90, 100:131] = False
    cells[0, 0] = False
    points[75:85, 110:120] = np.nan
    mesh = MeshLevels(points, cells)
    triangles = mesh.triangles(mesh.levels(None, 100.0, 50))
    assert area(np.nan_to_num(points), triangles) == pytest.approx(cells.sum())
    assert np.isfinite(points.reshape(-1, 3)[triangles]).all()


def holes(shape: tuple[int, int], seed: int) -> Any:
    """Cells without those around some blanked nodes, many of which lie along borders of blocks."""
    rng = np.random.default_rng(seed)
    valid = np.ones(shape, dtype=bool)
    for _ in range(8):
        border = BLOCK_CELLS * rng.integers(0, 4, 2) + rng.integers(-2, 3, 2)
        anywhere = rng.integers(0, shape)
        first = np.maximum(np.where(rng.random(2) < 0.7, border, anywhere), 0)
        size = np.where(rng.random() < 0.2, [150, 150], rng.integers(1, 20, 2))
        valid[first[0] : first[0] + size[0], first[1] : first[1] + size[1]] = False
    return valid[1:, 1:] & valid[:-1, 1:] & valid[1:, :-1] & valid[:-1, :-1]


@pytest.mark.parametrize("seed", range(20))
def test_no_crack_leads_from_a_hole_along_a_border(seed: int) -> None:
    shape = (200, 270)
    points, cells = grid(shape), holes(shape, seed)
    periodic = (False, seed % 2 == 1)
    mesh = MeshLevels(points, cells, periodic=periodic)
    levels = mesh.levels(None, 100.0, 600)
    drawn = levels[levels >= 0]
    assert drawn.max() > 3 and drawn.min() == 0
    # A seam closes in space, so that of a flat grid stays open.
    triangles = mesh.triangles(levels)
    assert area(points, triangles) == pytest.approx(cells.sum())


def test_a_seam_has_the_same_nodes_on_both_sides() -> None:
    shape = (65, 129)
    mesh = MeshLevels(grid(shape), whole(shape), periodic=(False, True))
    levels = np.array([[0, 5]])
    triangles = mesh.triangles(levels)
    nodes = [{int(n) // 129 for n in np.unique(triangles) if n % 129 == i} for i in (0, 128)]
    assert nodes[0] == nodes[1]


@pytest.mark.parametrize("size", [1e-300, 1e150])
def test_any_size_of_a_surface_has_levels(size: float) -> None:
    shape = (70, 90)
    mesh = MeshLevels(size * grid(shape, height=1.0), whole(shape))
    for eye, half in ((None, 45 * size), (np.zeros(3), 0.3), (None, 1e-320)):
        levels = mesh.levels(eye, half, 600)
        assert ((levels >= 0) & (levels < len(mesh.error))).all()
    flat = MeshLevels(np.zeros((70, 90, 3)), whole(shape))
    assert len(flat.triangles(flat.levels(np.zeros(3), 0.3, 600)))


def _mixed(pyramid: Pyramid, rng: np.random.Generator) -> list[tuple[Region, MeshLevels, Any]]:
    """Cover a surface by the root of a pyramid and some tiles of each level, at any mesh levels."""
    parts: list[tuple[Region, MeshLevels, Any]] = []

    def add(key: TileKey | None) -> Region:
        level = pyramid.depth if key is None else key.level
        lines = [
            np.minimum(np.arange(n) << level, full - 1)
            for n, full in zip(pyramid.shape(level), pyramid.field.shape, strict=True)
        ]
        place = (0, 0) if key is None else (key.row * TILE_BLOCKS, key.column * TILE_BLOCKS)
        if key is not None:
            size = TILE_BLOCKS * BLOCK_CELLS
            lines = [
                some[size * at : size * (at + 1) + 1]
                for some, at in zip(lines, key[1:], strict=True)
            ]
        mesh = MeshLevels(
            pyramid.field.points[np.ix_(*lines)], whole((len(lines[0]), len(lines[1])))
        )
        levels = rng.integers(0, len(mesh.error), mesh.error.shape[1:])
        region = Region(level, place[0] << level, place[1] << level, levels)
        parts.append((region, mesh, lines))
        return region

    def refine(region: Region, key: TileKey | None) -> None:
        for child in pyramid.children(key) if region.step else []:
            if rng.random() < 0.6:
                finer = add(child)
                row, column = (
                    (finer.row - region.row) >> region.step,
                    (finer.column - region.column) >> region.step,
                )
                region.levels[row : row + 2, column : column + 2] = -1
                refine(finer, child)

    refine(add(None), None)
    return parts


@pytest.mark.parametrize("seed", range(5))
def test_tiles_of_different_levels_join_without_cracks(seed: int, monkeypatch: Any) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 5000)
    rng = np.random.default_rng(seed)
    shape = (int(rng.integers(200, 700)), int(rng.integers(200, 900)))
    points = grid(shape)
    field = FlowField.from_arrays(points, np.ones_like(points), periodic="")
    pyramid = GridPyramid(field)
    parts = _mixed(pyramid, rng)
    joins = join([region for region, _, _ in parts], pyramid.blocks)
    triangles = []
    for (region, mesh, lines), border in zip(parts, joins, strict=True):
        local = mesh.triangles(region.levels, border)
        j, i = np.divmod(local, len(lines[1]))
        triangles.append(lines[0][j] * shape[1] + lines[1][i])
    together = np.concatenate(triangles)
    assert area(points, together) == pytest.approx((shape[0] - 1) * (shape[1] - 1))
    for (a, b), count in edges(together).items():
        j, i = np.divmod([a, b], shape[1])
        outside = any(
            (k == end).all() for k, n in ((j, shape[0]), (i, shape[1])) for end in (0, n - 1)
        )
        assert count == (1 if outside else 2)


def test_coarser_tiles_keep_their_nodes_beside_holes_of_finer_ones() -> None:
    """A hole beside the border of a tile, of which the coarser nodes know nothing."""
    cells = whole((65, 257))
    cells[:8, 41:60] = False
    fine, coarse = MeshLevels(grid((65, 257)), cells), MeshLevels(grid((65, 129)), whole((65, 129)))
    parts = []
    for mesh, step, row in ((fine, 0, 2), (coarse, 1, 0)):
        levels = mesh.levels(None, 100.0, 600)
        parts.append(Region(step, row, 0, levels, mesh.ragged))
    joins = join(parts, (3, 4))
    assert parts[1].levels[0, 0] == 0
    assert joins[0][0, 0, 0] == 1
    lost = cells.sum() - area(grid((65, 257)), fine.triangles(parts[0].levels, joins[0]))
    assert abs(lost) <= 1.0
