"""Forms that differ in their grids: staggered, moving, in faces, and unstructured."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from form_table import form, variants
from known_flow import (
    AVERAGED,
    DEGREES,
    EAST,
    NORTH,
    Truth,
    dates,
    earth,
    in_plane,
    lab,
    on_earth,
    wind,
)
from label_forms import BACK
from scipy.spatial import Delaunay
from turned_forms import PLAIN, TURNED, I, J, along, turned_grid

FINE_LON, FINE_LAT = np.arange(4.0, 24), np.arange(38.0, 54)
INNER = on_earth(FINE_LON[1:], FINE_LAT[1:], tolerance=AVERAGED)


# --- staggered ----------------------------------------------------------------------------------


def u_at(lon: Any, lat: Any, **more: Any) -> xr.Dataset:
    return earth(lon, lat, **more)[["u"]]


def v_at(lon: Any, lat: Any, **more: Any) -> xr.Dataset:
    return earth(lon, lat, **more)[["v"]]


@form(says="half|stagger|averag|mean")
def half_a_cell() -> Any:
    """u lies half a cell east and v half a cell north; names and sizes are the same."""
    return [u_at(FINE_LON + 0.5, FINE_LAT), v_at(FINE_LON, FINE_LAT + 0.5)], INNER


@form(says="half|stagger|averag|mean")
def half_a_cell_west_and_south() -> Any:
    truth = on_earth(FINE_LON[:-1], FINE_LAT[:-1], tolerance=AVERAGED)
    return [u_at(FINE_LON - 0.5, FINE_LAT), v_at(FINE_LON, FINE_LAT - 0.5)], truth


@form(says="half|stagger|averag|mean")
def half_a_cell_and_reversed_in_v() -> Any:
    v = v_at(FINE_LON, FINE_LAT + 0.5).isel(lat=BACK, lon=BACK)
    return [u_at(FINE_LON + 0.5, FINE_LAT), v], INNER


@form(says="half|stagger|averag|mean")
def half_a_cell_and_a_series_of_other_times() -> Any:
    u = u_at(FINE_LON + 0.5, FINE_LAT, hours=np.array([0.0, 6, 12]))
    v = v_at(FINE_LON, FINE_LAT + 0.5, hours=np.array([6.0, 12, 18]))
    return [u, v], on_earth(FINE_LON[1:], FINE_LAT[1:], [6.0, 12], tolerance=AVERAGED)


@form(says="half|stagger|averag|mean")
def half_a_cell_around_the_globe() -> Any:
    """The column west of the first one is the last one."""
    lon = np.arange(0.0, 360, 2)
    truth = on_earth(lon, FINE_LAT[1:], tolerance=AVERAGED)
    inner = np.ones((len(FINE_LAT) - 1, len(lon)), dtype=bool)
    inner[:, [0, -1]] = False
    return [u_at(lon + 1, FINE_LAT), v_at(lon, FINE_LAT + 0.5)], replace(truth, core=inner)


@form(error="lon|lat")
def half_a_cell_in_both_directions_in_u_alone() -> Any:
    """As u in the corners and v in the middle: no C grid."""
    truth = on_earth(FINE_LON, FINE_LAT, tolerance=AVERAGED, any_place=True)
    return [u_at(FINE_LON + 0.5, FINE_LAT + 0.5), v_at(FINE_LON, FINE_LAT)], truth


@form(error="lon|lat")
def half_a_cell_in_u_alone() -> Any:
    truth = on_earth(FINE_LON[1:], FINE_LAT, tolerance=AVERAGED, any_place=True)
    return [u_at(FINE_LON + 0.5, FINE_LAT), v_at(FINE_LON, FINE_LAT)], truth


@variants(["left", "right", "outer", "inner"])
def sides_of_cells_by_dimensions(kind: str) -> Any:
    """u on (y, x of sides), v on (y of sides, x), all with longitudes or latitudes."""

    def sides(line: Any) -> Any:
        before, after = line - 0.5, line + 0.5
        both = np.append(before, after[-1])
        return {"left": before, "right": after, "outer": both, "inner": both[1:-1]}[kind]

    u = u_at(sides(FINE_LON), FINE_LAT).rename(lon="lon_u")
    v = v_at(FINE_LON, sides(FINE_LAT)).rename(lat="lat_v")
    cut = {"left": slice(-1), "right": slice(1, None), "inner": slice(1, -1)}
    kept = cut.get(kind, slice(None))
    truth = on_earth(FINE_LON[kept], FINE_LAT[kept], tolerance=AVERAGED)
    return xr.merge([u, v]), truth


@form()
def comodo_in_the_plane() -> Any:
    x, y = np.linspace(0, 3, 61), np.linspace(0, 1, 41)
    half_x, half_y = (line[:-1] + np.diff(line) / 2 for line in (x, y))
    u = lab(x[:-1], half_y, dims=("y_c", "x_g"), units="m/s")[["u"]]
    v = lab(half_x, y[:-1], dims=("y_g", "x_c"), units="m/s")[["v"]]
    ds = xr.merge([u, v])
    for name in ds.coords:
        shift = {"c_grid_axis_shift": -0.5} if str(name).endswith("g") else {}
        ds[name].attrs = {"units": "m", "axis": str(name)[0].upper(), **shift}
    truth = in_plane(half_x[:-1], half_y[:-1], unit="m", speed_unit="m/s", tolerance=AVERAGED)
    return ds, truth


@variants(["angle", "no angle", "degrees"])
def roms(kind: str) -> Any:
    """u and v on the sides of cells, along the grid."""
    ds = xr.Dataset()
    dims = {"rho": ("eta_rho", "xi_rho"), "u": ("eta_u", "xi_u"), "v": ("eta_v", "xi_v")}
    points = {"rho": (I, J), "u": (I[:, :-1] + 0.5, J[:, :-1]), "v": (I[:-1], J[:-1] + 0.5)}
    for number, name in enumerate(("u", "v")):
        lon, lat, angle = turned_grid(*points[name])
        text = f"time-averaged {name}-momentum component"
        values = along(lon, lat, angle)[number]
        ds[name] = (dims[name], values, {"long_name": text, "units": "meter second-1"})
    for name, at in points.items():
        lon, lat, angle = turned_grid(*at)
        ds[f"lon_{name}"] = (dims[name], lon, DEGREES["lon"])
        ds[f"lat_{name}"] = (dims[name], lat, DEGREES["lat"])
    lon, lat, angle = turned_grid(I, J)
    if kind != "no angle":
        attrs = {"long_name": "angle between XI-axis and EAST", "units": "radians"}
        if kind == "degrees":
            angle, attrs["units"] = np.degrees(angle), "degrees"
        ds["angle"] = (dims["rho"], angle, attrs)
    names = [n for n in ds if str(n).startswith(("lon", "lat"))]
    inner = np.zeros(lon.shape, dtype=bool)
    inner[1:-1, 1:-1] = True
    return ds.set_coords(names), on_earth(lon, lat, tolerance=TURNED, core=inner)


@form()
def nemo_in_files_of_their_own() -> Any:
    """uo and vo have the same dimensions and sizes, and places of their own."""
    found = []
    for number, (name, at) in enumerate((("uo", (I + 0.5, J)), ("vo", (I, J + 0.5)))):
        lon, lat, angle = turned_grid(*at)
        letter = "xy"[number]
        attrs = {"long_name": f"sea_water_{letter}_velocity", "units": "m/s"}
        values = along(lon, lat, angle)[number]
        found.append(
            xr.Dataset(
                {name: (("y", "x"), values, attrs)},
                {
                    "nav_lon": (("y", "x"), lon, DEGREES["lon"]),
                    "nav_lat": (("y", "x"), lat, DEGREES["lat"]),
                },
            )
        )
    lon, lat, _ = turned_grid(I, J)
    inner = np.zeros(lon.shape, dtype=bool)
    inner[1:-1, 1:-1] = True
    return found, on_earth(lon, lat, tolerance=TURNED, core=inner)


@form()
def wrf_staggered() -> Any:
    lon, lat, _ = turned_grid(I, J)
    ds = xr.Dataset()
    points: dict[str, Any] = {
        "": (I, J, ("south_north", "west_east")),
        "_U": (np.c_[I - 0.5, I[:, -1:] + 0.5], np.c_[J, J[:, -1:]], ("south_north", "we_stag")),
        "_V": (np.r_[I, I[-1:]], np.r_[J - 0.5, J[-1:] + 0.5], ("sn_stag", "west_east")),
    }
    names = {"we_stag": "west_east_stag", "sn_stag": "south_north_stag"}
    for suffix, (i, j, dims) in points.items():
        at_lon, at_lat, turn = turned_grid(i, j)
        dims = tuple(names.get(d, d) for d in dims)
        ds = ds.assign_coords(
            {
                f"XLONG{suffix}": (dims, at_lon, {"units": "degree_east"}),
                f"XLAT{suffix}": (dims, at_lat, {"units": "degree_north"}),
            }
        )
        if suffix:
            letter = suffix[1]
            attrs = {"description": f"{'xy'[letter == 'V']}-wind component", "units": "m s-1"}
            ds[letter] = (dims, along(at_lon, at_lat, turn)[letter == "V"], attrs)
    return ds, on_earth(lon, lat, tolerance=TURNED)


# --- moving and in faces ------------------------------------------------------------------------


def nest() -> tuple[xr.Dataset, Any, Any]:
    """A nest that moves 0.5 degrees a step, on lines of longitude and latitude."""
    j, i = np.mgrid[0:15, 0:20]
    hours = np.arange(4) * 6.0
    lon = -70 + 0.2 * i - 0.5 * np.arange(4)[:, None, None]
    lat = np.broadcast_to(20 + 0.2 * j, lon.shape)
    u, v = (np.stack(c) for c in zip(*map(wind, lon, lat, hours), strict=True))
    dims = ("Time", "south_north", "west_east")
    return (
        xr.Dataset(
            {"U10": (dims, u, PLAIN), "V10": (dims, v, PLAIN)},
            {"XLONG": (dims, lon), "XLAT": (dims, lat), "XTIME": ("Time", dates(hours))},
        ),
        lon,
        lat,
    )


@form(error="position.*(time|move|vary|change)|move|vary in time")
def moving_nest() -> Any:
    return nest()[0]


@form(options={"isel": {"Time": 2}})
def a_step_of_a_moving_nest() -> Any:
    ds, lon, lat = nest()
    return ds, on_earth(lon[2], lat[2], [12.0], tolerance=TURNED)


@form(options={"sel": {"time": "2024-01-01T18:00"}})
def a_dated_step_of_a_moving_nest() -> Any:
    ds, lon, lat = nest()
    return ds, on_earth(lon[3], lat[3], [18.0], tolerance=TURNED)


@form()
def nest_that_rests() -> Any:
    """Places that are repeated for every time, and do not change."""
    ds, lon, lat = nest()
    dims = ds.U10.dims
    hours = np.arange(4) * 6.0
    u, v = (np.stack(c) for c in zip(*(wind(lon[0], lat[0], h) for h in hours), strict=True))
    ds = ds.assign_coords(XLONG=(dims, np.broadcast_to(lon[0], lon.shape)))
    ds = ds.assign(U10=(dims, u, PLAIN), V10=(dims, v, PLAIN))
    return ds, on_earth(lon[0], lat[0], hours, tolerance=TURNED)


def cube(n: int = 10) -> tuple[xr.Dataset, Any, Any]:
    """Six faces of a cubed sphere, with 1-D axes that only count."""
    a = (np.arange(n) + 0.5) / n * np.pi / 2 - np.pi / 4
    p, q = np.meshgrid(np.tan(a), np.tan(a))
    one = np.ones_like(p)
    faces = [(one, p, q), (-p, one, q), (-one, -p, q), (p, -one, q), (-q, p, one), (q, p, -one)]
    x, y, z = np.moveaxis(np.array(faces), 1, 0)
    lon, lat = np.degrees(np.arctan2(y, x)) % 360, np.degrees(np.arctan2(z, np.hypot(x, y)))
    u, v = wind(lon, lat)
    dims = ("nf", "Ydim", "Xdim")
    fake = {"long_name": "Fake Longitude for GrADS Compatibility", "units": "degrees_east"}
    return (
        xr.Dataset(
            {"U": (dims, u, EAST), "V": (dims, v, NORTH)},
            {
                "lons": (dims, lon, DEGREES["lon"]),
                "lats": (dims, lat, DEGREES["lat"]),
                "Xdim": ("Xdim", np.linspace(-5, 5, n), fake),
                "nf": np.arange(1, 7),
            },
        ),
        lon,
        lat,
    )


@form(error="nf|face", options={"globe": True})
def faces_of_a_cube() -> Any:
    """One globe, or an error, or one face at its place; never at the place of another."""
    ds, lon, lat = cube()
    return ds, on_earth(lon, lat, any_place=True)


@variants([0, 3, 5], options={"globe": True})
def one_face_of_a_cube(number: int) -> Any:
    ds, lon, lat = cube()
    return ds.isel(nf=number), on_earth(lon[number], lat[number])


@form(options={"globe": True, "isel": {"nf": 4}})
def a_chosen_face_of_a_cube() -> Any:
    ds, lon, lat = cube()
    return ds, on_earth(lon[4], lat[4])


# --- along one dimension ------------------------------------------------------------------------


@form(error="reduced", options={"globe": True})
def reduced_gaussian() -> Any:
    n = 8
    lat = np.degrees(np.arcsin(np.polynomial.legendre.leggauss(2 * n)[0]))[::-1]
    count = 20 + 4 * np.minimum(np.arange(2 * n), np.arange(2 * n)[::-1])
    lats = np.repeat(lat, count)
    lons = np.concatenate([np.arange(c) * 360 / c for c in count])
    u, v = wind(lons, lats)
    kind = {"GRIB_gridType": "reduced_gg"}
    return xr.Dataset(
        {"u": ("values", u, EAST | kind), "v": ("values", v, NORTH | kind)},
        {"latitude": ("values", lats), "longitude": ("values", lons)},
    ), Truth(np.stack([lons, lats], axis=-1))


def ugrid(at: str, start: int) -> tuple[xr.Dataset, Any, Any]:
    """Triangles of UGRID around points of a region."""
    p = np.random.default_rng(4).uniform((5, 40), (25, 55), (1200, 2))
    faces = Delaunay(p).simplices
    middle = p[faces].mean(axis=1)
    places, dim = (p, "node") if at == "node" else (middle, "face")
    u, v = wind(*places.T)
    more = {"mesh": "mesh2d", "location": at}
    attrs = {
        "cf_role": "mesh_topology",
        "topology_dimension": 2,
        "node_coordinates": "node_lon node_lat",
        "face_node_connectivity": "face_nodes",
    }
    return (
        xr.Dataset(
            {
                "mesh2d": ((), 0, attrs),
                "face_nodes": (("face", "three"), faces + start, {"start_index": start}),
                "u": (dim, u, EAST | more),
                "v": (dim, v, NORTH | more),
            },
            {
                "node_lon": ("node", p[:, 0], {**DEGREES["lon"], "standard_name": "longitude"}),
                "node_lat": ("node", p[:, 1], {**DEGREES["lat"], "standard_name": "latitude"}),
            },
        ),
        places,
        p,
    )


@variants([0, 1])
def triangles_with_values_at_nodes(start: int) -> Any:
    ds, places, _ = ugrid("node", start)
    return ds, Truth(places)


@form()
def triangles_with_values_at_faces() -> Any:
    """Means at the nodes; nodes of the border have only values on one side."""
    ds, _, nodes = ugrid("face", 0)
    return ds, Truth(nodes, tolerance=0.1)


@form()
def triangles_with_a_series_and_v_in_another_order() -> Any:
    ds, places, _ = ugrid("node", 0)
    hours = np.array([0.0, 6.0])
    u, v = (
        np.stack(c) for c in zip(*(wind(places[:, 0], places[:, 1], h) for h in hours), strict=True)
    )
    ds["u"] = (("time", "node"), u, ds.u.attrs)
    ds["v"] = (("node", "time"), v.T, ds.v.attrs)
    return ds.assign_coords(time=dates(hours)), Truth(places, (0.0, 6.0))
