"""Means over blocks of an array."""

from __future__ import annotations

import numpy as np

from flowtex._util.arrays import block_means


def test_lines_that_fill_no_block_are_dropped() -> None:
    means = block_means(np.arange(35.0).reshape(5, 7), 2)
    assert means.shape == (2, 3)
    assert means[0, 0] == (0 + 1 + 7 + 8) / 4


def test_other_axes_stay() -> None:
    data = np.random.default_rng(0).random((2, 6, 4, 3))
    means = block_means(data, 2, axis=1)
    assert means.shape == (2, 3, 2, 3)
    np.testing.assert_allclose(means[1, 2, 1], data[1, 4:6, 2:4].mean(axis=(0, 1)))
