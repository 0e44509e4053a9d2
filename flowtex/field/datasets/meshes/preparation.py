"""Datasets with a mesh, in a form in which axes can be told: dimensions, levels and times."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex.field.datasets.axes import FACES, LEVELS, NODES
from flowtex.field.datasets.meshes.conventions import find_mesh
from flowtex.field.datasets.meshes.mesh import Mesh

#: Dates as letters, which some models write beside times that are less exact, or instead of them.
LETTERS = ("Times", "xtime")
#: A dimension of the two components of a vector.
COMPONENTS = re.compile(r"^(two|component\w*|n?vec\w*)$", re.IGNORECASE)
#: A unit of time of ICON: a date, with the share of the day behind its point.
DAYS_AS_NUMBERS = "%Y%m%d"


def with_mesh_axes(datasets: Sequence[Any]) -> list[Any]:
    """Return datasets whose mesh, if there is one, has dimensions of known names.

    Vectors in one variable become two, and levels and times get values where files have them
    elsewhere.
    """
    mesh = find_mesh(datasets)
    if mesh is None:
        return list(datasets)
    sizes = dict(zip((NODES, FACES), _sizes(mesh), strict=True))
    named = dict(zip((NODES, FACES), mesh.dims, strict=True))
    return [_levels(_times(_apart(_renamed(ds, named, sizes))), mesh) for ds in datasets]


def _sizes(mesh: Mesh) -> tuple[int, int]:
    nodes, faces = mesh.dims
    of_faces = mesh.x if mesh.corners is None else mesh.corners
    return (mesh.x.sizes[nodes] if nodes else -1), of_faces.sizes[faces]


def _renamed(ds: Any, named: dict[str, str], sizes: dict[str, int]) -> Any:
    """Rename dimensions by their names, or by their sizes in a file without the mesh."""
    for ours, theirs in named.items():
        if ours in ds.dims:
            continue
        alike = [d for d in ds.dims if ds.sizes[d] == sizes[ours] and d not in (NODES, FACES)]
        dim = theirs if theirs in ds.dims else alike[0] if len(alike) == 1 else None
        if dim is not None:
            ds = ds.rename_dims({dim: ours})
    return ds


def _apart(ds: Any) -> Any:
    """Make two variables of one that has both components of a velocity."""
    for name, array in list(ds.data_vars.items()):
        dim = next((d for d in array.dims if COMPONENTS.match(str(d))), None)
        if dim is None or array.sizes[dim] != 2 or not {NODES, FACES} & set(array.dims):
            continue
        both = {f"{name}_{letter}": array.isel({dim: n}) for n, letter in enumerate("uv")}
        for part in both.values():
            part.attrs = {k: v for k, v in array.attrs.items() if k == "units"}
        ds = ds.drop_vars(name).assign(both)
    return ds


def _times(ds: Any) -> Any:
    """Return a dataset with dates along its axis of time, where they are hidden in it."""
    for name in LETTERS:
        if name not in ds.variables or not ds[name].dims or ds[name].dtype.kind not in "SUO":
            continue
        dim = str(ds[name].dims[0])
        texts = [
            (row.decode() if isinstance(row, bytes) else str(row)).strip(" \0")
            for row in (ds[name].values if ds[name].ndim == 1 else map(b"".join, ds[name].values))
        ]
        try:
            dates = np.array([t.replace("_", "T").rstrip("Z") for t in texts], "datetime64[ms]")
        except ValueError:
            continue
        if ds.sizes[dim] == len(dates) and not np.isnat(dates).any():
            return ds.assign_coords({dim: (dim, dates.astype("datetime64[ns]"), {"axis": "T"})})
    for dim in ds.dims:
        line = ds.coords.get(dim)
        if line is not None and DAYS_AS_NUMBERS in str(line.attrs.get("units", "")):
            return ds.assign_coords({dim: (dim, _days(line.values), {"axis": "T"})})
    return ds


def _days(numbers: AnyArray) -> AnyArray:
    whole = np.floor(numbers).astype(int)
    days = np.array([f"{n:08d}" for n in whole])
    dates = [np.datetime64(f"{d[:4]}-{d[4:6]}-{d[6:]}", "s") for d in days]
    seconds = np.round((numbers - whole) * 86400).astype("timedelta64[s]")
    return np.asarray(np.array(dates) + seconds, dtype="datetime64[ns]")


def _levels(ds: Any, mesh: Mesh) -> Any:
    """Return a dataset with a number for each level, by which the one at the surface is found."""
    for dim in map(str, ds.dims):
        line = ds.variables.get(dim)
        if line is not None and line.ndim == 2 and {dim, NODES} >= set(line.dims):
            # Levels that follow the ground, in shares of the depth: their means tell them apart.
            values = np.asarray(line.values, dtype=float)
            mean = np.nanmean(values, axis=line.dims.index(NODES))
            ds = ds.drop_vars(dim).assign_coords({dim: (dim, mean, {**line.attrs, "axis": "Z"})})
        elif line is None and mesh.kind == "SCHISM" and LEVELS.match(dim):
            below = np.arange(1 - ds.sizes[dim], 1)
            ds = ds.assign_coords({dim: (dim, below, {"axis": "Z", "long_name": "from the top"})})
    return ds
