"""The turning Earth of :mod:`earth_data` on meshes, as each convention has it in its files."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from earth_data import DEGREES, components, on_sphere
from scipy.spatial import ConvexHull

from flowtex._util.array_types import Floats, Indices

EAST = {"standard_name": "eastward_sea_water_velocity", "units": "m s-1"}
NORTH = {"standard_name": "northward_sea_water_velocity", "units": "m s-1"}


@dataclass(frozen=True)
class Globe:
    """Triangles all over the sphere: nodes in degrees, and the middles of triangles."""

    lon: Floats
    lat: Floats
    triangles: Indices

    @property
    def middles(self) -> tuple[Floats, Floats]:
        x, y, z = on_sphere(self.lon, self.lat)[self.triangles].mean(axis=1).T
        return np.degrees(np.arctan2(y, x)), np.degrees(np.arctan2(z, np.hypot(x, y)))


def globe(count: int = 600) -> Globe:
    """Triangles between places that lie evenly on the sphere; none of them is at a pole."""
    n = np.arange(count) + 0.5
    lat = np.asarray(np.degrees(np.arcsin(1 - 2 * n / count)), dtype=np.float64)
    lon = np.asarray((n * 180.0 * (1 + 5**0.5)) % 360.0 - 180.0, dtype=np.float64)
    return Globe(lon, lat, ConvexHull(on_sphere(lon, lat)).simplices.astype(np.int64))


def at_faces(mesh: Globe) -> tuple[Floats, Floats]:
    return components(*mesh.middles)


def ugrid(mesh: Globe, *, start: int = 0, at: str = "face") -> list[xr.Dataset]:
    """UGRID, its velocity in faces or at nodes."""
    u, v = at_faces(mesh) if at == "face" else components(mesh.lon, mesh.lat)
    topology = {
        "cf_role": "mesh_topology",
        "topology_dimension": 2,
        "node_coordinates": "Mesh2_node_x Mesh2_node_y",
        "face_node_connectivity": "Mesh2_face_nodes",
    }
    where = {"mesh": "Mesh2", "location": at}
    return [
        xr.Dataset(
            {
                "Mesh2": ((), 0, topology),
                "Mesh2_face_nodes": (
                    ("nFace", "three"),
                    mesh.triangles + start,
                    {"start_index": start},
                ),
                "Mesh2_node_x": (
                    "nNode",
                    mesh.lon,
                    {"standard_name": "longitude", **DEGREES["lon"]},
                ),
                "Mesh2_node_y": (
                    "nNode",
                    mesh.lat,
                    {"standard_name": "latitude", **DEGREES["lat"]},
                ),
                "ucx": ("nFace" if at == "face" else "nNode", u, EAST | where),
                "ucy": ("nFace" if at == "face" else "nNode", v, NORTH | where),
                "height": ("nNode", mesh.lat, {"units": "m", "location": "node"}),
                "twice": ("nFace", 2 * mesh.middles[1], {"units": "m", "location": "face"}),
            }
        )
    ]


def fvcom(mesh: Globe) -> list[xr.Dataset]:
    """FVCOM, two times and three layers; the one at the surface moves as the Earth turns."""
    u, v = at_faces(mesh)
    depth = np.array([-0.1, -0.5, -0.9])
    share = np.array([1.0, 2.0])[:, None, None] * (1 + depth + 0.1)[:, None]
    nodes = np.ones(len(mesh.lon))
    return [
        xr.Dataset(
            {
                "nv": (("three", "nele"), mesh.triangles.T + 1),
                "u": (("time", "siglay", "nele"), share * u, EAST),
                "v": (("time", "siglay", "nele"), share * v, NORTH),
                "ua": (
                    ("time", "nele"),
                    share[:, 0] * u,
                    {"units": "m s-1", "long_name": "Vertically Averaged x-velocity"},
                ),
                "va": (
                    ("time", "nele"),
                    share[:, 0] * v,
                    {"units": "m s-1", "long_name": "Vertically Averaged y-velocity"},
                ),
                "zeta": (("time", "node"), np.stack([nodes, 2 * nodes]), {"units": "m"}),
                "x": ("node", 0 * nodes, {"units": "meters"}),
                "y": ("node", 0 * nodes, {"units": "meters"}),
            },
            {
                "lon": ("node", mesh.lon, {"units": "degrees_east"}),
                "lat": ("node", mesh.lat, {"units": "degrees_north"}),
                "siglay": (("siglay", "node"), depth[:, None] * nodes),
                "time": np.array(["2024-01-01", "2024-01-02"], "datetime64[ns]"),
            },
        )
    ]


def schism(mesh: Globe, *, old: bool = False) -> list[xr.Dataset]:
    """SCHISM, with fill where a face has three corners; levels count from the ground."""
    u, v = components(mesh.lon, mesh.lat)
    corners = np.concatenate([mesh.triangles + 1, np.full((len(mesh.triangles), 1), -1)], axis=1)
    shares = np.array([0.2, 1.0])
    mesh_parts: dict[str, Any] = {
        "SCHISM_hgrid_face_nodes": (("nSCHISM_hgrid_face", "nMaxSCHISM_hgrid_face_nodes"), corners),
        "SCHISM_hgrid_node_x": ("nSCHISM_hgrid_node", mesh.lon),
        "SCHISM_hgrid_node_y": ("nSCHISM_hgrid_node", mesh.lat),
    }
    dims = ("time", "nSCHISM_hgrid_node", "nSCHISM_vgrid_layers")
    time = {"time": np.array(["2024-01-01"], "datetime64[ns]")}
    parts = [(c[:, None] * shares)[None] for c in (u, v)]
    if old:
        both = {"hvel": ((*dims, "two"), np.stack(parts, axis=-1))}
        return [xr.Dataset(mesh_parts | both, time)]
    return [
        xr.Dataset(mesh_parts, time),
        *(
            xr.Dataset({name: (dims, part)}, time)
            for name, part in zip(("horizontalVelX", "horizontalVelY"), parts, strict=True)
        ),
    ]


def fesom(mesh: Globe) -> list[xr.Dataset]:
    """FESOM: the mesh beside the components, which are in their own files."""
    u, v = at_faces(mesh)
    levels = {"nz1": ("nz1", np.array([5.0, 100.0]), {"units": "m"})}
    parts = [
        xr.Dataset(
            {
                n: (
                    ("time", "nz1", "elem"),
                    np.stack([c, c / 2])[None],
                    {"units": "m/s", "long_name": w},
                )
            },
            {"time": np.array(["1958-01-01"], "datetime64[ns]"), **levels},
        )
        for n, c, w in (("u", u, "zonal velocity"), ("v", v, "meridional velocity"))
    ]
    diagnostics = xr.Dataset(
        {
            "elements": (("n3", "elem"), mesh.triangles.T + 1),
            "nodes": (("n2", "nod2"), np.radians([mesh.lon, mesh.lat])),
            "elem_area": ("elem", np.ones(len(mesh.triangles))),
        }
    )
    return [diagnostics, *parts]


def icon(mesh: Globe, *, bounds: bool = False) -> list[xr.Dataset]:
    """ICON: its grid in a file beside, or bounds of the cells in the same one."""
    u, v = at_faces(mesh)
    lon, lat = (np.radians(c) for c in mesh.middles)
    named = [
        {"standard_name": "eastward_wind", "units": "m s-1"},
        {"standard_name": "northward_wind", "units": "m s-1"},
    ]
    told = {"axis": "Z", "long_name": "generalized_height"}
    clon = {"standard_name": "longitude", "units": "radian", "bounds": "clon_bnds"}
    clat = {"standard_name": "latitude", "units": "radian", "bounds": "clat_bnds"}
    output = xr.Dataset(
        {
            "u": (("time", "height", "ncells"), np.stack([u / 3, u])[None], named[0]),
            "v": (("time", "height", "ncells"), np.stack([v / 3, v])[None], named[1]),
        },
        {
            "height": ("height", np.array([1.0, 2.0]), told),
            "time": ("time", np.array([20240101.5]), {"units": "day as %Y%m%d.%f"}),
            "clon": ("ncells", lon, clon),
            "clat": ("ncells", lat, clat),
        },
    )
    if bounds:
        sides = {
            f"c{n}_bnds": (("ncells", "vertices"), np.radians(c[mesh.triangles]))
            for n, c in (("lon", mesh.lon), ("lat", mesh.lat))
        }
        return [output.assign(sides)]
    output.clon.attrs.pop("bounds"), output.clat.attrs.pop("bounds")
    grid = xr.Dataset(
        {
            "vertex_of_cell": (("nv", "cell"), mesh.triangles.T + 1),
            "cell_area": ("cell", np.ones(len(mesh.triangles))),
        },
        {
            "vlon": ("vertex", np.radians(mesh.lon), {"units": "radian"}),
            "vlat": ("vertex", np.radians(mesh.lat), {"units": "radian"}),
        },
    )
    return [output, grid]


def mpas(mesh: Globe) -> list[xr.Dataset]:
    """MPAS: the nodes are the middles of its cells, and triangles are around their corners."""
    u, v = components(mesh.lon, mesh.lat)
    dims = ("Time", "nCells", "nVertLevels")
    zonal, meridional = (np.stack([c, 2 * c], axis=-1)[None] for c in (u, v))
    what = "component of reconstructed horizontal velocity at cell centers"
    named = [{"units": "m s^{-1}", "long_name": f"{w} {what}"} for w in ("Zonal", "Meridional")]
    space = [{"units": "m s^{-1}", "long_name": f"Cartesian {w}-{what}"} for w in "xy"]
    return [
        xr.Dataset(
            {
                "uReconstructX": (dims, zonal, space[0]),
                "uReconstructY": (dims, zonal, space[1]),
                "uReconstructZonal": (dims, zonal, named[0]),
                "uReconstructMeridional": (dims, meridional, named[1]),
                "xtime": ("Time", np.array([b"2024-01-01_06:00:00"], "S64")),
                "lonCell": ("nCells", np.radians(mesh.lon) % (2 * np.pi)),
                "latCell": ("nCells", np.radians(mesh.lat)),
                "cellsOnVertex": (("nVertices", "vertexDegree"), mesh.triangles + 1),
            }
        )
    ]


#: Datasets of each convention, and whether their velocity is at the nodes.
CONVENTIONS: dict[str, tuple[Callable[[Globe], list[xr.Dataset]], bool]] = {
    "ugrid": (ugrid, False),
    "ugrid from 1": (lambda mesh: ugrid(mesh, start=1), False),
    "ugrid at nodes": (lambda mesh: ugrid(mesh, at="node"), True),
    "fvcom": (fvcom, False),
    "schism": (schism, True),
    "schism old": (lambda mesh: schism(mesh, old=True), True),
    "fesom": (fesom, False),
    "icon": (icon, False),
    "icon bounds": (lambda mesh: icon(mesh, bounds=True), False),
    "mpas": (mpas, True),
}
