"""Products of vectors along the last axis; NumPy's sums over few components are slow."""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import Floats


def dot(one: Floats, other: Floats) -> Floats:
    """Return inner products of vectors (..., C), of shape (...)."""
    product = one * other
    return np.asarray(product @ np.ones(product.shape[-1], product.dtype))


def norm(vectors: Floats) -> Floats:
    """Return lengths of vectors (..., C), of shape (...)."""
    return np.sqrt(dot(vectors, vectors))
