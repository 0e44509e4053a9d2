"""Datasets of xarray's as fields; the package itself tells them from meshes."""

from __future__ import annotations

from typing import Any


def is_dataset(thing: Any) -> bool:
    """Whether something is a dataset or a tree of xarray's, or several; xarray is not loaded."""
    several = thing if isinstance(thing, (list, tuple)) else [thing]
    return bool(several) and all(
        type(one).__name__ in ("Dataset", "DataTree") and type(one).__module__.startswith("xarray.")
        for one in several
    )
