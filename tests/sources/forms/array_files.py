"""Plain arrays, tables, GRIB and the files of VTK: what needs no model and no convention."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyvista as pv
import xarray as xr
from known_flow import EPOCH, Truth, at_points, in_plane, on_earth, plane, wind
from mesh_files import points, vectors
from supported import Made, supported

ARRAYS = "Plain arrays"
TABLES = "DataFrames"
VTK = "Meshes of VTK"
X = np.linspace(-1.0, 1.2, 24)
Y = np.linspace(-0.9, 1.0, 19)
LON = np.arange(0.0, 24, 2)
LAT = np.arange(20.0, 51, 3)
TIMES = (0.0, 0.5, 1.0)


def on_grid(time: float = 0.0) -> tuple[Any, Any]:
    """Return u and v at the nodes, (J, I)."""
    return plane(*np.meshgrid(X, Y), time)


# --- arrays -------------------------------------------------------------------------------------


@supported(
    ARRAYS,
    "x, y, u, v as for `plt.streamplot`",
    "flowtex.show(x, y, u, v)",
    "x (I,) and y (J,), or both (J, I); u and v (J, I)",
)
def four_arrays(folder: Path) -> Made:
    u, v = on_grid()
    return {"x": X, "y": Y, "u": u, "v": v}, in_plane(X, Y)


@supported(ARRAYS, "u and v without positions", "flowtex.show(u, v)", "x and y are 0, 1, 2, …")
def two_arrays(folder: Path) -> Made:
    x, y = np.arange(5.0), np.arange(4.0)
    u, v = plane(*np.meshgrid(x, y))
    return {"u": u, "v": v}, in_plane(x, y)


@supported(
    ARRAYS,
    "several times",
    "flowtex.show(x, y, u, v, times=times)",
    "u and v (T, J, I); without `times` they are numbered",
)
def arrays_of_times(folder: Path) -> Made:
    parts = [on_grid(time) for time in TIMES]
    u, v = np.stack([part[0] for part in parts]), np.stack([part[1] for part in parts])
    truth = in_plane(X, Y, TIMES)
    return {"x": X, "y": Y, "u": u, "v": v, "times": np.array(TIMES)}, truth


@supported(
    ARRAYS,
    "one array of both components",
    "flowtex.show(x, y, velocity)",
    "(2, J, I), (J, I, 2), with times (T, J, I, 2), or complex, u + iv",
)
def one_array(folder: Path) -> Made:
    return {"x": X, "y": Y, "velocity": np.stack(on_grid())}, in_plane(X, Y)


@supported(
    ARRAYS,
    "speed and an angle",
    'flowtex.show(x, y, speed, direction=angle, components="angle")',
    'from x, counterclockwise; `"from"` and `"to"` are clockwise from north; degrees or radians',
)
def speed_and_angle(folder: Path) -> Made:
    u, v = on_grid()
    angle = np.degrees(np.arctan2(v, u))
    return {"x": X, "y": Y, "speed": np.hypot(u, v), "angle": angle}, in_plane(X, Y)


@supported(
    ARRAYS,
    "a dictionary, as of `np.load` and `scipy.io.loadmat`",
    "flowtex.show(arrays)",
    "by the names x, y, u, v or vx, vy; other arrays of the nodes are scalars",
)
def named_arrays(folder: Path) -> Made:
    u, v = on_grid()
    np.savez(folder / "flow.npz", x=X, y=Y, u=u, v=v)
    return {"arrays": np.load(folder / "flow.npz")}, in_plane(X, Y)


@supported(
    ARRAYS,
    "longitude, latitude, u, v",
    'flowtex.show(lon, lat, u, v, projection="robinson")',
    "`projection` or `globe=True` says that they are on the Earth; u and v in m/s",
)
def arrays_on_the_earth(folder: Path) -> Made:
    u, v = wind(*np.meshgrid(LON, LAT))
    return {"lon": LON, "lat": LAT, "u": u, "v": v}, on_earth(LON, LAT)


# --- tables -------------------------------------------------------------------------------------


def table() -> pd.DataFrame:
    """Return the rows of a lattice in any order."""
    across, upward = (part.ravel() for part in np.meshgrid(X, Y))
    u, v = plane(across, upward)
    rows = pd.DataFrame({"x": across, "y": upward, "u": u, "v": v})
    return rows.sample(frac=1.0, random_state=3)


@supported(
    TABLES,
    "pandas: columns x, y, u, v",
    "flowtex.show(table)",
    "rows of a lattice, in any order, become a grid; other rows are points",
)
def pandas_table(folder: Path) -> Made:
    return {"table": table()}, in_plane(X, Y)


@supported(
    TABLES,
    "pandas with a MultiIndex",
    "flowtex.show(table)",
    "levels of the index are columns; a level `time` makes a series",
)
def table_by_index(folder: Path) -> Made:
    parts = []
    across, upward = (part.ravel() for part in np.meshgrid(X, Y))
    for time in TIMES:
        u, v = plane(across, upward, time)
        columns = {"time": time, "y": upward, "x": across, "u": u, "v": v}
        parts.append(pd.DataFrame(columns))
    whole = pd.concat(parts).set_index(["time", "y", "x"])
    return {"table": whole}, in_plane(X, Y, TIMES)


@supported(TABLES, "polars", "flowtex.show(table)", "as those of pandas", "polars")
def polars_table(folder: Path) -> Made:
    import polars as pl

    return {"table": pl.from_pandas(table())}, in_plane(X, Y)


@supported(TABLES, "PyArrow: `Table`", "flowtex.show(table)", "as those of pandas", "pyarrow")
def arrow_table(folder: Path) -> Made:
    import pyarrow as pa

    return {"table": pa.Table.from_pandas(table())}, in_plane(X, Y)


@supported(
    TABLES,
    'pandas: `df.pivot(index="y", columns="x", values=["u", "v"])`',
    "flowtex.show(table)",
    "levels of the columns with numbers are positions or times; names in several levels are joined",
)
def pivoted_table(folder: Path) -> Made:
    return {"table": table().pivot(index="y", columns="x", values=["u", "v"])}, in_plane(X, Y)


@supported(
    TABLES,
    "two tables of pandas, whose rows and columns are positions",
    "flowtex.show(u, v)",
    "by the labels; rows are along y if the index has no name",
)
def tables_of_components(folder: Path) -> Made:
    whole = table()
    parts = [whole.pivot(index="y", columns="x", values=name) for name in "uv"]
    return {"u": parts[0], "v": parts[1].iloc[::-1]}, in_plane(X, Y)


@supported(
    TABLES,
    "GeoPandas: points with columns u, v",
    "flowtex.show(gdf)",
    "longitude and latitude of `geometry`, reprojected by its CRS",
    "geopandas",
)
def geopandas_table(folder: Path) -> Made:
    geopandas = import_module("geopandas")
    lon, lat = (part.ravel() for part in np.meshgrid(LON, LAT))
    u, v = wind(lon, lat)
    shapes = geopandas.points_from_xy(lon, lat)
    columns = {"u": u, "v": v}
    return {"gdf": geopandas.GeoDataFrame(columns, geometry=shapes, crs=4326)}, on_earth(LON, LAT)


# --- VTK ----------------------------------------------------------------------------------------


def truth() -> Truth:
    return at_points(points()[0])


def triangles() -> Any:
    places, faces = points()
    deep = np.column_stack([places, np.zeros(len(places))])
    mesh = pv.PolyData.from_regular_faces(deep, faces)
    mesh.point_data["velocity"] = vectors(places)
    return mesh


@supported(
    VTK,
    "image data `.vti`, rectilinear `.vtr`, structured `.vts` grids",
    'flowtex.show("flow.vts")',
    'a surface, or the middle plane of a volume; `plane="k=20"`, `slice="x=0.5"`',
)
def structured_file(folder: Path) -> Made:
    across, upward = np.meshgrid(X, Y)
    mesh = pv.StructuredGrid(across, upward, 0 * across)
    places = np.asarray(mesh.points)[:, :2]
    mesh.point_data["velocity"] = vectors(places)
    mesh.save(folder / "flow.vts")
    return {}, at_points(places)


@supported(
    VTK,
    "unstructured grids `.vtu`, surfaces `.vtp`, legacy `.vtk`",
    'flowtex.show("flow.vtu")',
    'a surface, or the outside of a volume; `slice="x=0.5"` and `contour="p=0"` cut it',
)
def unstructured_file(folder: Path) -> Made:
    triangles().cast_to_unstructured_grid().save(folder / "flow.vtu")
    return {}, truth()


@supported(VTK, "PyVista meshes", "flowtex.show(mesh)", "as their files")
def mesh_itself(folder: Path) -> Made:
    return {"mesh": triangles()}, truth()


@supported(
    VTK,
    "a series `.pvd`, or a list of meshes",
    "flowtex.show(meshes, times=times)",
    "the same nodes at all times, in any order",
)
def list_of_meshes(folder: Path) -> Made:
    places, _ = points()
    meshes = []
    for time in TIMES:
        mesh = triangles()
        mesh.point_data["velocity"] = vectors(places, time)
        meshes.append(mesh)
    return {"meshes": meshes, "times": TIMES}, at_points(places, times=TIMES)


@supported(
    "Models on triangles",
    "faces by name: `faces`, `triangles` or `elements`",
    'flowtex.show("faces.nc")',
    "numbers of nodes from 0 or 1, beside x and y of the nodes; no convention is needed",
)
def faces_by_name(folder: Path) -> Made:
    places, faces = points()
    u, v = plane(*places.T)
    unit = {"units": "m/s"}
    columns: dict[str, Any] = {"u": ("node", u, unit), "v": ("node", v, unit)}
    for name, place in zip("xy", places.T, strict=True):
        columns[name] = ("node", place, {"units": "m"})
    columns["triangles"] = (("face", "corner"), faces.astype("i4") + 1)
    xr.Dataset(columns).to_netcdf(folder / "faces.nc")
    return {}, at_points(places, unit="m", speed_unit="m/s")


@supported(
    "Models on grids",
    "GRIB, also of several levels and members",
    'flowtex.show("winds.grib", level=500)',
    "by cfgrib, without writing index files; needs the extra `grib`",
    "cfgrib",
)
def grib_file(folder: Path) -> Made:
    import eccodes

    lon, lat = np.arange(0.0, 24, 2), np.arange(50.0, 19, -3)
    with (folder / "winds.grib").open("wb") as file:
        for level, scale in ((1000, 2.0), (500, 1.0)):
            for short, part in zip(("u", "v"), wind(*np.meshgrid(lon, lat)), strict=True):
                message = eccodes.codes_grib_new_from_samples("regular_ll_pl_grib2")
                keys = {
                    "Ni": len(lon),
                    "Nj": len(lat),
                    "iDirectionIncrementInDegrees": 2.0,
                    "jDirectionIncrementInDegrees": 3.0,
                    "longitudeOfFirstGridPointInDegrees": 0.0,
                    "longitudeOfLastGridPointInDegrees": lon[-1],
                    "latitudeOfFirstGridPointInDegrees": lat[0],
                    "latitudeOfLastGridPointInDegrees": lat[-1],
                    "shortName": short,
                    "level": level,
                    "bitsPerValue": 24,
                    "dataDate": int(EPOCH.strftime("%Y%m%d")),
                    "dataTime": 0,
                }
                for key, value in keys.items():
                    eccodes.codes_set(message, key, value)
                eccodes.codes_set_values(message, (scale * part).ravel())
                eccodes.codes_write(message, file)
                eccodes.codes_release(message)
    return {}, on_earth(lon, lat, tolerance=1e-4)
