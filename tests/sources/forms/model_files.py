"""Files of models on triangles, each with the flow on the Earth or in the plane."""

from __future__ import annotations

import warnings
from importlib import import_module
from pathlib import Path

import numpy as np
import xarray as xr
from known_flow import EAST_AT_SEA, NORTH_AT_SEA, Truth, on_earth, wind
from llc_grid import llc, turning
from mesh_files import points, truth, vectors
from supported import Made, supported

KIND = "Models on triangles"


def adcirc_dataset() -> tuple[xr.Dataset, Truth]:
    """Return a dataset as ADCIRC writes fort.64.nc, and its truth."""
    places, triangles = points()
    lon, lat = -75 + 8 * places[:, 0], 30 + 6 * places[:, 1]
    u, v = wind(lon, lat)
    words = {"standard_name": "{}_water_velocity_depth_averaged", "units": "m s-1"}
    words |= {"location": "node", "mesh": "adcirc_mesh"}
    along = [words | {"standard_name": words["standard_name"].format(axis)} for axis in "xy"]
    topology = {"cf_role": "mesh_topology", "topology_dimension": 2, "node_coordinates": "x y"}
    topology["face_node_connectivity"] = "element"
    ds = xr.Dataset(
        {
            "u-vel": (("time", "node"), u[None], along[0]),
            "v-vel": (("time", "node"), v[None], along[1]),
            "element": (("nele", "nvertex"), triangles.astype("i4") + 1, {"start_index": 1}),
            "adcirc_mesh": ((), 0, topology),
        },
        {
            "x": ("node", lon, {"standard_name": "longitude", "units": "degrees_east"}),
            "y": ("node", lat, {"standard_name": "latitude", "units": "degrees_north"}),
            "time": ("time", [0.0], {"units": "seconds since 2024-01-01"}),
        },
    )
    return ds, Truth(np.stack([lon, lat], axis=-1))


@supported(KIND, "ADCIRC: `fort.64.nc`", 'flowtex.show("fort.64.nc")', "UGRID, or by its names")
def adcirc(folder: Path) -> Made:
    ds, true = adcirc_dataset()
    ds.to_netcdf(folder / "fort.64.nc")
    return {}, true


@supported(KIND, "ADCIRC without a topology", "flowtex.show(ds)", "triangles in `element`")
def adcirc_without_topology(folder: Path) -> Made:
    ds, true = adcirc_dataset()
    return {"ds": ds.drop_vars("adcirc_mesh")}, true


@supported(
    KIND,
    "TELEMAC: SELAFIN",
    'flowtex.show("telemac.slf")',
    "`VELOCITY U` and `VELOCITY V` on the nodes",
    "xarray-selafin",
)
def telemac(folder: Path) -> Made:
    places, triangles = points()
    u, v, _ = vectors(places).T.astype("f4")
    x, y = places.T.astype("f4")
    ds = xr.Dataset(
        {"U": (("time", "node"), u[None]), "V": (("time", "node"), v[None])},
        {"x": ("node", x), "y": ("node", y), "time": [np.datetime64("2024-01-01", "ns")]},
        {
            **{"title": "flow", "language": "en", "float_size": 4, "endian": ">"},
            **{"params": (1, 0, 0, 0, 0, 0, 0, 0, 0, 1), "date_start": (2024, 1, 1, 0, 0, 0)},
            "ipobo": np.zeros(len(places), int),
            "ikle2": triangles + 1,
            "variables": {"U": ("VELOCITY U", "M/S"), "V": ("VELOCITY V", "M/S")},
        },
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import_module("xarray_selafin.xarray_backend")  # has the accessor
        ds.selafin.write(str(folder / "telemac.slf"))
    return {}, truth(undated=True)


@supported(
    "Models on faces",
    "cubed spheres and LLC grids: eastward and northward on (face, j, i)",
    "flowtex.show(ds, globe=True)",
    "all faces as one surface; streaks cross their borders",
)
def faces_of_a_cube(folder: Path) -> Made:
    count = 6
    line = np.tan(np.linspace(-np.pi / 4, np.pi / 4, 2 * count + 1)[1::2])
    p, q = np.meshgrid(line, line)
    one = np.ones_like(p)
    faces = ((one, p, q), (-p, one, q), (-one, -p, q), (p, -one, q), (-q, p, one), (q, p, -one))
    x, y, z = np.moveaxis(np.array(faces), 1, 0)
    lon, lat = np.degrees(np.arctan2(y, x)), np.degrees(np.arctan2(z, np.hypot(x, y)))
    u, v = wind(lon, lat)
    dims = ("face", "j", "i")
    ds = xr.Dataset(
        {"EVEL": (dims, u, EAST_AT_SEA), "NVEL": (dims, v, NORTH_AT_SEA)},
        {"lon": (dims, lon), "lat": (dims, lat)},
    )
    return {"ds": ds}, on_earth(lon, lat)


@supported(
    "Models on faces",
    "LLC tiles of MITgcm and ECCO: components on the sides of cells",
    "flowtex.show(ds, globe=True)",
    "averaged, also across the borders of tiles, and turned by `CS` and `SN`, or by positions",
)
def tiles_of_llc(folder: Path) -> Made:
    del folder
    ds = llc(12)
    known = np.ones(ds.XC.shape, dtype=bool)
    # The southern ends of two tiles lack a side. At the corners of the cap rows bend.
    known[[9, 12], :, -1] = False
    lon, lat = ds.XC.values[known][None], ds.YC.values[known][None]
    return {"ds": ds}, on_earth(lon, lat, flow=turning, tolerance=0.25)
