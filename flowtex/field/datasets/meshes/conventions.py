"""Finding the mesh of a dataset by UGRID, by the names of models, or by the bounds of cells."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex.errors import FieldError
from flowtex.field.datasets.meshes.mesh import Mesh
from flowtex.field.io.inspection.limits import values_in

if TYPE_CHECKING:
    import xarray as xr

#: Names of the corners of faces, and of coordinates of the nodes, of models without a convention.
#: Each has the mesh's words, the corners, pairs of coordinates, and the number of the first node.
MODELS = (
    ("FVCOM", ("nv",), (("lon", "lat"), ("x", "y")), 1),
    (
        "SCHISM",
        ("SCHISM_hgrid_face_nodes",),
        (("SCHISM_hgrid_node_x", "SCHISM_hgrid_node_y"),),
        1,
    ),
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
    # The velocity of MPAS is in the middle of its cells: these are the nodes, and triangles join
    # the three around each corner of the cells.
    ("MPAS", ("cellsOnVertex",), (("lonCell", "latCell"), ("xCell", "yCell")), 1),
    ("MPAS", ("verticesOnCell",), (("lonVertex", "latVertex"), ("xVertex", "yVertex")), 1),
)


def find_mesh(datasets: Sequence[xr.Dataset]) -> Mesh | None:
    """Return the mesh of datasets that belong together; ``None`` where they have none."""
    variables: dict[str, Any] = {}
    for ds in datasets:
        for name in ds.variables:
            variables.setdefault(str(name), ds[name])
    for find in (_ugrid, _of_models, _bounded):
        for mesh in find(variables):
            return mesh
    return None


def _ugrid(variables: Mapping[str, Any]) -> Iterator[Mesh]:
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
                "data lack; expected two coordinates of the nodes and the nodes of each face. Give "
                "the file that has them too"
            )
            raise FieldError(msg)
        corners = variables[attrs["face_node_connectivity"]]
        x, y = (variables[name] for name in names)
        if _is_latitude(x):
            x, y = y, x
        kind = "SCHISM" if str(topology.name).startswith("SCHISM") else "UGRID"
        yield Mesh(kind, x, y, corners, first=int(corners.attrs.get("start_index", 0)))


def _is_latitude(c: Any) -> bool:
    named = str(c.attrs.get("standard_name", c.name)).lower()
    return "lat" in named or named == "projection_y_coordinate"


def _of_models(variables: Mapping[str, Any]) -> Iterator[Mesh]:
    for kind, names, coordinates, first in MODELS:
        corners = next((variables[n] for n in names if n in variables), None)
        if corners is None or corners.ndim != 2 or corners.dtype.kind not in "fiu":
            continue
        for x, y in coordinates:
            if x not in variables or y not in variables:
                continue
            one, other = variables[x], variables[y]
            if one.ndim != (2 if x == y else 1) or not _spreads(one):
                continue
            attrs = {**corners.attrs}
            counts = variables.get("nEdgesOnCell") if names == ("verticesOnCell",) else None
            told = int(attrs.get("start_index", first))
            yield Mesh(kind, one, other, corners, counts, told)


def _spreads(c: Any) -> bool:
    """Whether a coordinate is no array of zeros, as of the other kind that a model may write."""
    values = np.asarray(values_in(c), dtype=float)
    return bool(np.nanmax(values, initial=-np.inf) > np.nanmin(values, initial=np.inf))


def _bounded(variables: Mapping[str, Any]) -> Iterator[Mesh]:
    """Give cells that have bounds each, along one dimension."""
    for x in variables.values():
        name = x.attrs.get("bounds", x.encoding.get("bounds"))
        if x.ndim != 1 or name not in variables or _is_latitude(x):
            continue
        for y in variables.values():
            other = y.attrs.get("bounds", y.encoding.get("bounds"))
            if y.dims != x.dims or other not in variables or not _is_latitude(y):
                continue
            one, two = variables[name], variables[other]
            if one.ndim == 2 and one.dims == two.dims and one.shape[1] >= 3:
                units = {"units": x.attrs.get("units", "")}
                a, b = (c.assign_attrs(units | c.attrs) for c in (one, two))
                yield Mesh("cells with bounds", a, b)
