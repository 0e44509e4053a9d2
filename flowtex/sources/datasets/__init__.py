"""Datasets of xarray's as fields, and how to recognise them among meshes."""

from __future__ import annotations

#: Libraries and classes of labelled arrays and tables.
KINDS = (
    *(("xarray", name) for name in ("Dataset", "DataTree", "DataArray")),
    *((library, "DataFrame") for library in ("pandas", "polars")),
    ("geopandas", "GeoDataFrame"),
    ("_io", "StringIO"),
)


def is_dataset(data: object) -> bool:
    """Return whether data are one or several of :data:`KINDS`, without loading a library."""
    if isinstance(data, (list, tuple)):
        items = data
    else:
        items = [data]
    kinds = ((kind.__module__.partition(".")[0], kind.__name__) for kind in map(type, items))
    return bool(items) and all(kind in KINDS for kind in kinds)
