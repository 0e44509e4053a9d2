"""Datasets of xarray's as fields; the package itself tells them from meshes."""

from __future__ import annotations

from typing import Any


def is_dataset(thing: Any) -> bool:
    """Whether something is a dataset of xarray's, or several of them; xarray is not loaded."""
    several = thing if isinstance(thing, (list, tuple)) else [thing]
    return bool(several) and all(
        type(one).__name__ == "Dataset" and type(one).__module__.startswith("xarray.")
        for one in several
    )
