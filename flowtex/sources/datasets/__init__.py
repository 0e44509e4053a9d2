"""Datasets of xarray's as fields, and how to recognise them among meshes."""

from __future__ import annotations


def is_dataset(data: object) -> bool:
    """Return whether data are one or several datasets or trees of xarray's, without loading it."""
    kinds = [type(item) for item in (data if isinstance(data, (list, tuple)) else [data])]
    names = ("Dataset", "DataTree")
    return bool(kinds) and all(
        kind.__name__ in names and kind.__module__.startswith("xarray.") for kind in kinds
    )
