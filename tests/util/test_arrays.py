"""Work on large arrays gives what NumPy's functions give."""

from __future__ import annotations

import numpy as np
import pytest

from flowtex._util.arrays import BLOCK_NODES, bounds, dot, first_places, numbered


@pytest.mark.parametrize("shape", [(1, 3), (63, 2), (64, 3), (1000, 3), (1, 130, 3), (7, 90, 3)])
def test_bounds_are_the_extremes(shape: tuple[int, ...], rng: np.random.Generator) -> None:
    points = rng.normal(size=shape)
    flat = points.reshape(-1, shape[-1])
    np.testing.assert_array_equal(bounds(points), [flat.min(axis=0), flat.max(axis=0)])
    np.testing.assert_array_equal(bounds(points[..., ::-1]), bounds(points)[:, ::-1])


@pytest.mark.parametrize("most", [3, 5_000, 10**15])
def test_keys_are_numbered_in_their_order(most: int, rng: np.random.Generator) -> None:
    keys = rng.integers(-most, most, 1000)
    found, number = numbered(keys)
    expected, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
    np.testing.assert_array_equal(found, expected)
    np.testing.assert_array_equal(number, inverse)
    np.testing.assert_array_equal(first_places(number), first)


def test_no_keys_have_no_numbers() -> None:
    found, number = numbered(np.zeros(0, dtype=np.intp))
    assert len(found) == len(number) == len(first_places(number)) == 0


@pytest.mark.parametrize("shape", [(3, BLOCK_NODES, 3), (BLOCK_NODES, 3, 3), (2 * BLOCK_NODES, 2)])
def test_products_of_large_arrays_are_those_of_their_parts(
    shape: tuple[int, ...], rng: np.random.Generator
) -> None:
    one, other = rng.normal(size=(2, *shape))
    parts = [dot(one[at], other[at]) for at in np.ndindex(shape[0])]
    np.testing.assert_array_equal(dot(one, other), np.stack(parts))
