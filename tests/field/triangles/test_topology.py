"""How triangles are joined."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest
from triangle_meshes import random_plane, soup, sphere

from flowtex.field.triangles.triangle_nodes import (
    connected_nodes,
    flipped,
    merged_nodes,
    neighbours,
    repeated,
    triangle_normals,
    uneven_nodes,
)


def test_neighbours_share_the_edge_opposite_to_a_corner(rng: np.random.Generator) -> None:
    points, triangles = random_plane(rng, 300)
    beside = neighbours(points, triangles)
    for corner in range(3):
        rows = np.flatnonzero(beside[:, corner] >= 0)
        edges = np.delete(triangles[rows], corner, axis=1)
        others = triangles[beside[rows, corner]]
        assert (edges[:, :, None] == others[:, None]).any(axis=2).all()
        assert (beside[beside[rows, corner]] == rows[:, None]).any(axis=1).all()
    # A square with a border: Euler's formula tells how many sides it has.
    border = int((beside < 0).sum())
    sides = (3 * len(triangles) + border) // 2
    assert len(points) - sides + len(triangles) == 1


@pytest.mark.parametrize("copies", [0, 1, 7])
def test_a_triangle_is_repeated_from_its_second_place_on(
    rng: np.random.Generator, copies: int
) -> None:
    _, triangles = random_plane(rng, 20_000)
    at = rng.choice(len(triangles), copies, replace=False)
    # In another order of the corners, and some of them twice.
    more = np.concatenate([np.roll(triangles[at], 1, axis=1), triangles[at[:2], ::-1]])
    found = repeated(np.concatenate([triangles, more]))
    assert not found[: len(triangles)].any()
    assert found[len(triangles) :].all()


@pytest.mark.parametrize("count", [0, 1, 5, 500])
def test_triangles_around_one_node_are_repeated_only_if_equal(count: int) -> None:
    ring = np.arange(1, count + 1)
    fan = np.stack([np.zeros_like(ring), ring, ring + 1], axis=-1)
    assert not repeated(fan).any()
    assert repeated(np.concatenate([fan, fan[-1:, ::-1]])).sum() == min(count, 1)


def test_nodes_that_rounding_moved_are_one() -> None:
    points, triangles = soup(np.random.default_rng(1), sphere(2))
    points = points + np.random.default_rng(2).uniform(-1e-11, 1e-11, points.shape)
    assert len(
        np.unique(merged_nodes(points, triangles, uneven_nodes(triangles, len(points))))
    ) == len(sphere(2)[0])


def test_all_faces_look_outward_or_inward(rng: np.random.Generator) -> None:
    points, triangles = soup(rng, sphere(3))
    triangles = merged_nodes(points, triangles, uneven_nodes(triangles, len(points)))[triangles]
    turned = flipped(triangles, neighbours(points, triangles))
    assert 0.3 < turned.mean() < 0.7
    outward = np.einsum(
        "mc,mc->m", triangle_normals(points, triangles), points[triangles].mean(axis=1)
    )
    assert len(np.unique(np.sign(outward) * np.where(turned, -1, 1))) == 1


def test_a_band_with_one_side_ends() -> None:
    # A strip whose end is turned over before it is closed.
    turn = np.arange(20)
    low = np.stack([np.cos(turn), np.sin(turn), 0 * turn], -1)
    points = np.concatenate([low, np.add(low, [0.0, 0.0, 1.0])])
    after = np.concatenate([turn[1:], [20]]), np.concatenate([20 + turn[1:], [0]])
    triangles = np.concatenate(
        [np.stack([turn, after[0], after[1]], -1), np.stack([turn, after[1], 20 + turn], -1)]
    )
    beside = neighbours(points, triangles)
    assert (beside >= 0).sum() == 2 * len(triangles)
    assert flipped(triangles, beside).shape == (40,)


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 0, 1), (1, 2, 0)])
def test_where_three_meet_the_straight_one_is_beside(order: tuple[int, int, int]) -> None:
    points = np.array([[0, 0, 0], [0, 1, 0], [1, 0, 0], [-1, 0.5, 0], [0, 0, 1]], float)
    triangles = np.array([[0, 1, 2], [0, 3, 1], [0, 1, 4]])[list(order)]
    beside = neighbours(points, triangles)
    one, other = order.index(0), order.index(1)
    assert other in beside[one]
    assert one in beside[other]
    # The one that stands up looks at one of them and is looked at by none.
    assert order.index(2) not in beside[[one, other]]


def test_sheets_that_share_a_node_are_one_part() -> None:
    sheets = np.array([[0, 1, 4], [0, 1, 2], [6, 7, 8], [1, 0, 3], [3, 4, 5]])
    for order in permutations(range(5)):
        part = connected_nodes(sheets[list(order)], 9)
        assert len(set(part[:6])) == 1
        assert len(set(part[6:])) == 1
        assert part[0] != part[6]
