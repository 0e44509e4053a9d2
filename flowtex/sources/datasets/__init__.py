"""Datasets of xarray's as fields, and how to recognise them among meshes."""

from __future__ import annotations

#: Libraries and classes of labelled arrays and tables.
KINDS = (
    *(("xarray", name) for name in ("Dataset", "DataTree", "DataArray")),
    *((library, "DataFrame") for library in ("pandas", "polars")),
    ("geopandas", "GeoDataFrame"),
    ("pyarrow", "Table"),
    ("_io", "StringIO"),
)


def is_dataset(data: object) -> bool:
    """Return whether data are one or several of :data:`KINDS`, without loading a library."""
    if isinstance(data, (list, tuple)):
        items = data
    else:
        items = [data]
    return bool(items) and all(map(_is_kind, items))


def _is_kind(item: object) -> bool:
    """Return whether the class of an item, or one it derives from, is one of the kinds."""
    for kind in type(item).__mro__:
        if (kind.__module__.partition(".")[0], kind.__name__) in KINDS:
            return True
    return False
