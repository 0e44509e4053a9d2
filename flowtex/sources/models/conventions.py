"""Finding the mesh of a dataset by UGRID, by the names of models, or by the bounds of cells.

Its dimensions, levels and times then get a form in which the axes are recognised.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from flowtex.errors import FieldError
from flowtex.sources.datasets.axes import FACES, LEVELS, NODES
from flowtex.sources.datasets.select import find_pairs
from flowtex.sources.models.mesh import Mesh
from flowtex.sources.models.scattered import NAMED, points_in, with_points
from flowtex.sources.reader_errors import values_in

if TYPE_CHECKING:
    import xarray as xr

#: The attribute of xarray-selafin with the corners of faces.
TELEMAC = "ikle2"
#: Names of the corners of faces, and of coordinates of the nodes, of models without a convention.
#: Each has the mesh's words, the corners, pairs of coordinates, and the number of the first node.
MODELS = (
    ("FVCOM", ("nv",), (("lon", "lat"), ("x", "y")), 1),
    ("SCHISM", ("SCHISM_hgrid_face_nodes",), (("SCHISM_hgrid_node_x", "SCHISM_hgrid_node_y"),), 1),
    (
        "FESOM",
        ("face_nodes", "elem_nodes", "elements", "elem"),
        (("lon", "lat"), ("nodes", "nodes")),
        1,
    ),
    (
        "ICON",
        ("vertex_of_cell",),
        (("vlon", "vlat"), ("longitude_vertices", "latitude_vertices")),
        1,
    ),
    # The velocity of MPAS is in the middle of its cells: these are the nodes here, and triangles
    # join the three around each corner.
    ("MPAS", ("cellsOnVertex",), (("lonCell", "latCell"), ("xCell", "yCell")), 1),
    ("MPAS", ("verticesOnCell",), (("lonVertex", "latVertex"), ("xVertex", "yVertex")), 1),
    ("TUFLOW FV", ("cell_node",), (("node_X", "node_Y"),), 1),
    ("TELEMAC", (TELEMAC,), (("x", "y"),), 1),
)
#: Variables with the number of corners of each face.
COUNTS = {"verticesOnCell": "nEdgesOnCell", "cell_node": "cell_Nvert"}


def find_mesh(datasets: Sequence[xr.Dataset]) -> Mesh | None:
    """Return the mesh of datasets that belong together; ``None`` where they have none."""
    variables: dict[str, xr.DataArray] = {}
    for ds in datasets:
        for name in ds.variables:
            variables.setdefault(str(name), ds[name])
    for find in (_ugrid, _of_models, _bounded, points_in):
        for mesh in find(variables):
            return mesh
    return None


def _ugrid(variables: Mapping[str, xr.DataArray]) -> Iterator[Mesh]:
    for topology in variables.values():
        attrs = topology.attrs
        if attrs.get("cf_role") != "mesh_topology" or "face_node_connectivity" not in attrs:
            continue
        missing = [attrs["face_node_connectivity"], *str(attrs.get("node_coordinates", "")).split()]
        missing = [name for name in missing if name not in variables]
        names = str(attrs.get("node_coordinates", "")).split()
        if missing or len(names) != 2:
            msg = (
                f"the topology {topology.name!r} names {', '.join(missing) or names}, which the "
                "data do not contain; expected two coordinates of the nodes and the nodes of "
                "each face. Open the file that has them together with this one"
            )
            raise FieldError(msg)
        corners = variables[attrs["face_node_connectivity"]]
        x, y = (variables[name] for name in names)
        if _is_latitude(x):
            x, y = y, x
        kind = "SCHISM" if str(topology.name).startswith("SCHISM") else "UGRID"
        yield Mesh(kind, x, y, corners, first=int(corners.attrs.get("start_index", 0)))


def _is_latitude(c: xr.DataArray) -> bool:
    named = str(c.attrs.get("standard_name", c.name)).lower()
    return "lat" in named or named == "projection_y_coordinate"


def _of_models(variables: Mapping[str, xr.DataArray]) -> Iterator[Mesh]:
    for kind, names, coordinates, first in MODELS:
        corners = next((variables[n] for n in names if n in variables), None)
        if corners is None or corners.ndim != 2 or corners.dtype.kind not in "fiu":
            continue
        for x, y in coordinates:
            if x not in variables or y not in variables:
                continue
            longitude, latitude = variables[x], variables[y]
            if longitude.ndim != (2 if x == y else 1) or not _varies(longitude):
                continue
            attrs = {**corners.attrs}
            counts = variables.get(COUNTS.get(str(corners.name), ""))
            first_index = int(attrs.get("start_index", first))
            yield Mesh(kind, longitude, latitude, corners, counts, first_index)


def _varies(c: xr.DataArray) -> bool:
    """Return whether the values of a coordinate differ; models write unused ones as zeros."""
    values = np.asarray(values_in(c), dtype=float)
    return bool(np.nanmax(values, initial=-np.inf) > np.nanmin(values, initial=np.inf))


def _bounded(variables: Mapping[str, xr.DataArray]) -> Iterator[Mesh]:
    """Yield meshes of cells with bounds, along one dimension."""
    for x in variables.values():
        name = str(x.attrs.get("bounds", x.encoding.get("bounds", "")))
        if x.ndim != 1 or name not in variables or _is_latitude(x):
            continue
        for y in variables.values():
            name_y = str(y.attrs.get("bounds", y.encoding.get("bounds", "")))
            if y.dims != x.dims or name_y not in variables or not _is_latitude(y):
                continue
            bounds_x, bounds_y = variables[name], variables[name_y]
            if bounds_x.ndim == 2 and bounds_x.dims == bounds_y.dims and bounds_x.shape[1] >= 3:
                units = {"units": x.attrs.get("units", "")}
                a, b = (c.assign_attrs(units | c.attrs) for c in (bounds_x, bounds_y))
                yield Mesh("cells with bounds", a, b)


def with_mesh_axes(datasets: Sequence[xr.Dataset]) -> list[xr.Dataset]:
    """Return datasets whose mesh has dimensions of known names; without faces it is of points."""
    datasets = [_completed(ds) for ds in datasets]
    _check_classes(datasets)
    mesh = find_mesh(datasets)
    if mesh is None:
        return with_points(datasets)
    sizes = dict(zip((NODES, FACES), _sizes(mesh), strict=True))
    named = dict(zip((NODES, FACES), mesh.dims, strict=True))
    return [_levels(_renamed(ds, named, sizes), mesh) for ds in datasets]


def _sizes(mesh: Mesh) -> tuple[int, int]:
    nodes, faces = mesh.dims
    of_faces = mesh.x if mesh.corners is None else mesh.corners
    return (mesh.x.sizes[nodes] if nodes else -1), of_faces.sizes[faces]


def _renamed(ds: xr.Dataset, named: dict[str, str], sizes: dict[str, int]) -> xr.Dataset:
    """Rename dimensions by their names, or by their sizes in a file without the mesh."""
    for ours, theirs in named.items():
        if ours in ds.dims:
            continue
        alike = [d for d in ds.dims if ds.sizes[d] == sizes[ours] and d not in (NODES, FACES)]
        dim = theirs if theirs in ds.dims else alike[0] if len(alike) == 1 else None
        if dim is not None:
            ds = ds.rename_dims({dim: ours})
    return ds


def _completed(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset of TUFLOW FV or TELEMAC in the form of those of other models."""
    if (faces := ds.attrs.get(TELEMAC)) is not None:
        ds = ds.assign({TELEMAC: ((f"{TELEMAC}_faces", f"{TELEMAC}_corners"), np.asarray(faces))})
    if "ResTime" in ds and ds["ResTime"].ndim == 1:
        time = ds["ResTime"].assign_attrs(axis="T")
        ds = ds.assign_coords({str(time.dims[0]): time.variable})
    if {"cell_node", "idx3"} <= set(ds.variables) and "NumCells3D" in ds.dims:
        # Cells of a column follow each other from the top.
        ds = ds.isel(NumCells3D=ds["idx3"] - 1).drop_vars(["idx2", "idx3", "NL"], errors="ignore")
    if "cell_node" in ds and "stat" in ds:
        ds = ds.assign(wet_cells=(ds["stat"] != 0).astype("i1")).drop_vars("stat")
    return ds


def _check_classes(datasets: Sequence[xr.Dataset]) -> None:
    """Raise a FieldError for speeds and directions that are numbers of classes."""
    classes = {
        str(name): str(array.attrs["flag_bounds"])
        for ds in datasets
        for name, array in ds.data_vars.items()
        if "flag_bounds" in array.attrs
        and re.search("speed|direction", str(array.attrs.get("standard_name", "")))
    }
    if classes and not any(pair.rank <= NAMED for pair in find_pairs(datasets)):
        msg = (
            f"{' and '.join(classes)} store classes of the speed and the direction, not their "
            f"values; their bounds are in {' and '.join(classes.values())}. Replace each number "
            "by the middle of its class, compute the components, and pass the dataset with both"
        )
        raise FieldError(msg)


def _levels(ds: xr.Dataset, mesh: Mesh) -> xr.Dataset:
    """Return a dataset with numbers for levels, which show the one at the surface."""
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
