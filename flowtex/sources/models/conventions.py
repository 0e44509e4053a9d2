"""Finding the mesh of a dataset by UGRID, by the names of models, or by the bounds of cells.

Its dimensions, levels and times then get a form in which the axes are recognised. Values along one
dimension are points of a mesh: scattered ones, faces of a cube.
"""

from __future__ import annotations

import re
from collections.abc import Container, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex.errors import FieldError
from flowtex.sources.datasets.axes import FACES, LEVEL, NODES, TIME, axis_kind, horizontal_dims
from flowtex.sources.datasets.coordinates import ACROSS, LONGITUDE, SWAPS
from flowtex.sources.datasets.levels import LEVELS
from flowtex.sources.datasets.select import MOVING, find_pairs
from flowtex.sources.datasets.vertical import is_vertical
from flowtex.sources.models.healpix import with_centres
from flowtex.sources.models.model_mesh import POINTS, Mesh
from flowtex.sources.reader_errors import values_in

if TYPE_CHECKING:
    import xarray as xr

#: The attribute of xarray-selafin with the corners of faces.
TELEMAC = "ikle2"
#: Names of the corners of faces, and of coordinates of the nodes, of models without a convention.
#: Each has the mesh's words, the corners, and pairs of coordinates; nodes are counted from 1.
MODELS = (
    ("FVCOM", ("nv",), (("lon", "lat"), ("x", "y"))),
    ("SCHISM", ("SCHISM_hgrid_face_nodes",), (("SCHISM_hgrid_node_x", "SCHISM_hgrid_node_y"),)),
    (
        "FESOM",
        ("face_nodes", "elem_nodes", "elements", "elem"),
        (("lon", "lat"), ("nodes", "nodes")),
    ),
    ("ICON", ("vertex_of_cell",), (("vlon", "vlat"), ("longitude_vertices", "latitude_vertices"))),
    # The velocity of MPAS is in the middle of its cells: these are the nodes here, and triangles
    # join the three around each corner.
    ("MPAS", ("cellsOnVertex",), (("lonCell", "latCell"), ("xCell", "yCell"))),
    ("MPAS", ("verticesOnCell",), (("lonVertex", "latVertex"), ("xVertex", "yVertex"))),
    ("TUFLOW FV", ("cell_node",), (("node_X", "node_Y"),)),
    ("TELEMAC", (TELEMAC,), (("x", "y"),)),
    ("ADCIRC", ("element",), (("x", "y"),)),
)
#: Names of the corners of faces in files without a convention.
NAMED_FACES = re.compile(
    r"^(faces?|tri(angle)?s?|cells?|elem(ent)?s?|connectivity|simplices)$", re.IGNORECASE
)
#: Variables with the number of corners of each face.
COUNTS = {"verticesOnCell": "nEdgesOnCell", "cell_node": "cell_Nvert"}
#: Most faces of a grid that covers the globe, and names of their dimension.
MOST_FACES = 30
FACES_OF_GLOBE = re.compile(r"^(nf|n?faces?|n?tiles?|panels?)$", re.IGNORECASE)
#: Types of features whose points follow each other in time or height.
PATHS = ("trajectory", "profile", "timeseriesprofile", "trajectoryprofile")
#: Greatest rank of a pair that is a velocity by its names.
NAMED = 4


def find_mesh(datasets: Sequence[xr.Dataset]) -> Mesh | None:
    """Return the mesh of datasets that belong together; ``None`` where they have none.

    Of several meshes it is the first on which a velocity lies.
    """
    meshes = _meshes(datasets)
    first = next(meshes, None)
    if first is None:
        return None
    carrying = {str(dim) for pair in find_pairs(datasets) for dim in pair.u.dims}
    for mesh in (first, *meshes):
        if carrying & {*filter(None, mesh.dims)}:
            return mesh
    return first


def _meshes(datasets: Sequence[xr.Dataset]) -> Iterator[Mesh]:
    """Yield the meshes of datasets, those of a convention first."""
    variables: dict[str, xr.DataArray] = {}
    for ds in datasets:
        for name in ds.variables:
            variables.setdefault(str(name), ds[name])
    for find in (_ugrid, _of_models, _bounded, _of_named_faces, points_in):
        yield from find(variables)


def _ugrid(variables: Mapping[str, xr.DataArray]) -> Iterator[Mesh]:
    for topology in variables.values():
        attrs = topology.attrs
        if attrs.get("cf_role") != "mesh_topology" or "face_node_connectivity" not in attrs:
            continue
        names = str(attrs.get("node_coordinates", "")).split()
        missing = []
        for n in (attrs["face_node_connectivity"], *names):
            if n not in variables:
                missing.append(n)
        if missing or len(names) != 2:
            raise FieldError(
                f"the topology {topology.name!r} names {', '.join(missing) or names}, which the "
                "data do not contain; open the file that has them together with this one"
            )
        corners = variables[attrs["face_node_connectivity"]]
        x, y = (variables[name] for name in names)
        if _is_latitude(x):
            x, y = y, x
        if str(topology.name).startswith("SCHISM"):
            kind = "SCHISM"
        else:
            kind = "UGRID"
        yield Mesh(kind, x, y, corners, first=int(corners.attrs.get("start_index", 0)))


def _is_latitude(c: xr.DataArray) -> bool:
    named = str(c.attrs.get("standard_name", c.name)).lower()
    return "lat" in named or named == "projection_y_coordinate"


def _of_models(variables: Mapping[str, xr.DataArray]) -> Iterator[Mesh]:
    for kind, names, coordinates in MODELS:
        corners = next((variables[n] for n in names if n in variables), None)
        if corners is None or corners.ndim != 2 or corners.dtype.kind not in "fiu":
            continue
        for x, y in coordinates:
            if x not in variables or y not in variables:
                continue
            longitude = variables[x]
            latitude = variables[y]
            values = np.asarray(values_in(longitude), dtype=float)
            # Models write unused coordinates as zeros.
            varies = np.nanmax(values, initial=-np.inf) > np.nanmin(values, initial=np.inf)
            if longitude.ndim != (2 if x == y else 1) or not varies:
                continue
            counts = variables.get(COUNTS.get(str(corners.name), ""))
            first = int(corners.attrs.get("start_index", 1))
            yield Mesh(kind, longitude, latitude, corners, counts, first)


def _of_named_faces(variables: dict[str, xr.DataArray]) -> Iterator[Mesh]:
    """Yield meshes of triangles or quadrangles whose corners have a usual name, or count nodes."""
    for x, y in position_pairs(list(variables.values())):
        if x.ndim != 1:
            continue
        for name, corners in variables.items():
            is_table = corners.ndim == 2 and corners.shape[1] in (3, 4)
            if not is_table or corners.dtype.kind not in "iu" or x.dims[0] in corners.dims:
                continue
            if NAMED_FACES.match(name) or _counts_all(corners, x.size):
                yield Mesh("faces", x, y, corners, first=int(corners.attrs.get("start_index", 1)))


def _counts_all(corners: xr.DataArray, count: int) -> bool:
    """Return whether the values are the numbers of this many nodes, from 0 or 1, and of no more."""
    numbers = np.unique(np.asarray(values_in(corners)))
    numbers = numbers[numbers >= 0]
    return len(numbers) == count > 0 and int(numbers[-1] - numbers[0]) == count - 1


def _bounded(variables: Mapping[str, xr.DataArray]) -> Iterator[Mesh]:
    """Yield meshes of cells with bounds, along one dimension."""
    for x in variables.values():
        name = _bounds_of(x, variables)
        if x.ndim != 1 or name not in variables or _is_latitude(x):
            continue
        for y in variables.values():
            name_y = _bounds_of(y, variables)
            if y.dims != x.dims or name_y not in variables or not _is_latitude(y):
                continue
            bounds_x = variables[name]
            bounds_y = variables[name_y]
            if bounds_x.ndim == 2 and bounds_x.dims == bounds_y.dims and bounds_x.shape[1] >= 3:
                units = {"units": x.attrs.get("units", "")}
                a = bounds_x.assign_attrs(units | bounds_x.attrs)
                b = bounds_y.assign_attrs(units | bounds_y.attrs)
                yield Mesh("cells with bounds", a, b)


def _bounds_of(c: xr.DataArray, variables: Container[str]) -> str:
    """Return the name of the corners of cells: as declared, or as ICON and CDO call them."""
    name = str(c.attrs.get("bounds", c.encoding.get("bounds", "")))
    if name:
        return name
    usual = (f"{c.name}_{word}" for word in ("vertices", "bnds", "bounds"))
    return next((known for known in usual if known in variables), "")


def with_mesh_axes(datasets: Sequence[xr.Dataset]) -> list[xr.Dataset]:
    """Return datasets whose mesh has dimensions of known names; without faces it is of points."""
    datasets = with_centres([_completed(ds) for ds in datasets])
    mesh = find_mesh(datasets)
    if mesh is None:
        return with_points(datasets)
    return [_levels(_renamed(ds, mesh), mesh) for ds in datasets]


def _renamed(ds: xr.Dataset, mesh: Mesh) -> xr.Dataset:
    """Rename dimensions by their names, or by their sizes in a file without the mesh."""
    sizes = {**mesh.x.sizes, **({} if mesh.corners is None else mesh.corners.sizes)}
    for ours, theirs in zip((NODES, FACES), mesh.dims, strict=True):
        if ours in ds.dims or not theirs:
            continue
        alike = []
        for d in ds.dims:
            if ds.sizes[d] == sizes[theirs] and d not in (NODES, FACES):
                alike.append(d)
        dim: Any
        if theirs in ds.dims:
            dim = theirs
        elif len(alike) == 1:
            dim = alike[0]
        else:
            dim = None
        if dim is not None:
            ds = ds.rename_dims({dim: ours})
    return ds


def _completed(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset of TUFLOW FV or TELEMAC in the form of other models."""
    if (faces := ds.attrs.get(TELEMAC)) is not None:
        ds = ds.assign({TELEMAC: ((f"{TELEMAC}_faces", f"{TELEMAC}_corners"), np.asarray(faces))})
        for name, (words, unit) in dict(ds.attrs.get("variables", {})).items():
            ds[name].attrs.setdefault("long_name", words.strip().lower())
            ds[name].attrs.setdefault("units", unit.strip().lower())
    if "ResTime" in ds and ds["ResTime"].ndim == 1:
        time = ds["ResTime"].assign_attrs(axis="T")
        ds = ds.assign_coords({str(time.dims[0]): time.variable})
    if {"cell_node", "idx3"} <= set(ds.variables) and "NumCells3D" in ds.dims:
        # Cells of a column follow each other from the top.
        ds = ds.isel(NumCells3D=ds["idx3"] - 1).drop_vars(["idx2", "idx3", "NL"], errors="ignore")
    if "cell_node" in ds and "stat" in ds:
        ds = ds.assign(wet_cells=(ds["stat"] != 0).astype("i1")).drop_vars("stat")
    return ds


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


def with_points(datasets: Sequence[xr.Dataset]) -> list[xr.Dataset]:
    """Return datasets in which the dimension of scattered points is called ``NODES``.

    Raises
    ------
    FieldError
        When the positions are a trajectory, or move with time.
    """
    pairs = [pair for pair in find_pairs(datasets) if pair.rank <= NAMED]
    for x, y in position_pairs([ds[name] for ds in datasets for name in ds.variables]):
        times = [d for d in map(str, x.dims) if axis_kind(x, d) == TIME]
        if x.ndim != 1 and (x.ndim, len(times)) != (2, 1):
            continue
        along = [a for ds in datasets for a in ds.data_vars.values() if set(x.dims) <= set(a.dims)]
        values = [a for a in along if a.dtype.kind in "fiu" and a.name not in (x.name, y.name)]
        if not values or any(_lie_elsewhere(x, pair.u) for pair in pairs):
            continue
        dim = next((str(d) for d in x.dims if d not in times), "")
        levels = any(axis_kind(a, str(d)) == LEVEL for a in values for d in {*a.dims} - {*x.dims})
        is_section = levels and any(is_vertical(a) for a in values)
        if is_section and (times or not _is_surface(x, y)):
            continue
        kind = next((str(k) for ds in datasets if (k := ds.attrs.get("featureType"))), "")
        if (times and len(values) > 1) or kind.lower() in PATHS:
            if times:
                why = f"along {times[0]}"
            else:
                why = f"of the type {kind!r}"
            raise FieldError(
                f"{x.name} and {y.name} are positions {why}: a trajectory, or points that move; "
                "interpolate the values to a grid, or select one time, as in ds.isel(time=0)"
            )
        if x.ndim == 1:
            return [ds.rename_dims({dim: NODES}) if dim in ds.dims else ds for ds in datasets]
    return list(datasets)


def _lie_elsewhere(x: xr.DataArray, u: xr.DataArray) -> bool:
    """Return whether values have other axes than positions, or a surface besides their axes.

    So has a wind on a grid beside the place of a radar at each time.
    """
    if not {*x.dims} <= {*u.dims}:
        return True
    surface = {*horizontal_dims(u)}
    kinds = {axis_kind(u, dim) for dim in surface}
    return len(surface) == 2 and not surface & {*x.dims} and not kinds & {TIME, LEVEL}


def points_in(variables: dict[str, xr.DataArray]) -> Iterator[Mesh]:
    """Yield the mesh of points along ``NODES``."""
    for x, y in position_pairs(list(variables.values())):
        if x.dims == (NODES,):
            yield Mesh(POINTS, x, y)


def position_pairs(arrays: list[xr.DataArray]) -> Iterator[tuple[xr.DataArray, xr.DataArray]]:
    """Yield longitudes and latitudes, then x and y, along the same dimensions."""
    numbers = []
    for a in arrays:
        if a.ndim and a.dtype.kind in "fiu":
            numbers.append(a)
    for pattern, word in ((LONGITUDE, "longitude"), (ACROSS, "projection_x_coordinate")):
        for x in numbers:
            name = str(x.name).lower()
            named = pattern.match(name) or x.attrs.get("standard_name") == word
            if named and not MOVING.search(name):
                partners = {name.replace(one, other) for one, other in SWAPS if one in name}
                alike = (y for y in numbers if str(y.name).lower() in partners)
                yield from ((x, y) for y in alike if y.dims == x.dims)


def _is_surface(x: xr.DataArray, y: xr.DataArray) -> bool:
    try:
        return len(Mesh(POINTS, x, y).faces) > 0
    except FieldError:
        return False
