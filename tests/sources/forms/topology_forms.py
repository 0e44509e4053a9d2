"""Forms whose grids, levels and places are declared beside the velocity, or known by names."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import xarray as xr
from form_table import form, variants
from known_flow import (
    AVERAGED,
    EAST_AT_SEA,
    NORTH_AT_SEA,
    Truth,
    at_points,
    grid,
    in_plane,
    on_earth,
    plane,
    wind,
    without,
)

pytest.importorskip("pyproj")

X, Y = np.linspace(0, 3, 121), np.linspace(0, 2, 81)
MIDDLE_X, MIDDLE_Y = (X[1:] + X[:-1]) / 2, (Y[1:] + Y[:-1]) / 2
METRES = {"units": "m"}
SPEED = {"units": "m/s"}


# --- layers -------------------------------------------------------------------------------------


def flow_of(u: float, v: float) -> Any:
    """Return a flow that is the same everywhere."""

    def flow(x: Any, _y: Any, _t: Any = 0.0) -> Any:
        return np.full(np.shape(x), u), np.full(np.shape(x), v)

    return flow


def d_flow_fm(*, contours: bool) -> xr.Dataset:
    """Return layers of D-Flow FM before UGRID 1: cells have another dimension than the mesh."""
    x, y = np.meshgrid(np.linspace(0, 9, 10), np.linspace(0, 5, 6))
    number = np.arange(60).reshape(6, 10)
    sides = (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1])
    corners = np.stack([side.ravel() for side in sides], axis=1)
    layers = np.array([0.1, 0.5, 0.9])
    factor = np.array([3.0, 2.0, 1.0])
    dims = ("nFlowElem", "laydim")
    ones = np.ones((45, 3)) * factor
    topology = {"cf_role": "mesh_topology", "topology_dimension": 2}
    topology |= {"node_coordinates": "NetNode_x NetNode_y", "face_dimension": "nNetElem"}
    topology["face_node_connectivity"] = "NetElemNode"
    attrs = {"units": "m", "standard_name": "projection_{}_coordinate"}
    ds = xr.Dataset(
        {
            "Mesh2D": ((), 0, topology),
            "NetElemNode": (("nNetElem", "four"), corners + 1, {"start_index": 1}),
            "ucx": (dims, 2 * ones, SPEED | {"standard_name": "sea_water_x_velocity"}),
            "ucy": (dims, 3 * ones, SPEED | {"standard_name": "sea_water_y_velocity"}),
            "ucxa": (dims[:1], ones[:, 0], SPEED | {"standard_name": "sea_water_x_velocity"}),
            "ucya": (dims[:1], ones[:, 0], SPEED | {"standard_name": "sea_water_y_velocity"}),
            "LayCoord_cc": (
                "laydim",
                layers,
                {"standard_name": "ocean_sigma_coordinate", "positive": "up", "units": ""},
            ),
        }
    ).expand_dims(time=[0.0])
    ds = ds.assign({n: ds[n].isel(time=0) for n in ("Mesh2D", "NetElemNode", "LayCoord_cc")})
    for letter, values in zip("xy", (x, y), strict=True):
        own = {**attrs, "standard_name": attrs["standard_name"].format(letter)}
        middles = values.ravel()[corners].mean(axis=1)
        ds[f"NetNode_{letter}"] = ("nNetNode", values.ravel(), own)
        bounds = {"bounds": f"FlowElemContour_{letter}"}
        ds[f"FlowElem_{letter}cc"] = ("nFlowElem", middles, own | bounds)
        ds[f"FlowElemContour_{letter}"] = (("nFlowElem", "corner"), values.ravel()[corners], own)
    return ds if contours else ds.drop_vars(["Mesh2D", "NetElemNode"])


@variants(["mesh and contours", "contours alone"])
def layers_without_a_declaration(kind: str) -> Any:
    """Layers by value: 0.9 from the bed is the nearest to the surface."""
    data = d_flow_fm(contours=kind == "mesh and contours")
    places = grid(*np.meshgrid(np.linspace(0, 9, 10), np.linspace(0, 5, 6)))
    truth = at_points(places, flow=flow_of(2.0, 3.0), unit="m", speed_unit="m/s", undated=True)
    return data, truth


# --- grids of ROMS and SGRID ----------------------------------------------------------------------

LON, LAT = np.arange(-60.0, -48), np.arange(30.0, 41)


def warmth(lon: Any, lat: Any, _hours: Any = 0.0) -> Any:
    return 0.1 * lon + 0.3 * np.asarray(lat)


@variants(["own places", "places of cells alone", "no mask"])
def roms_on_points_of_their_own(kind: str) -> Any:
    """Scalars and the mask in the middle of cells, whose dimensions u and v do not have."""
    u_lon, v_lat = (LON[1:] + LON[:-1]) / 2, (LAT[1:] + LAT[:-1]) / 2
    at = {"rho": (LON, LAT), "u": (u_lon, LAT), "v": (LON, v_lat)}
    ds = xr.Dataset()
    for letter, (lon, lat) in at.items():
        for name, values in zip(("lon", "lat"), np.meshgrid(lon, lat), strict=True):
            ds[f"{name}_{letter}"] = ((f"eta_{letter}", f"xi_{letter}"), values)
    land = (ds.lon_rho.values > -53) & (ds.lat_rho.values > 36)
    ds["temp"] = (ds.lon_rho.dims, warmth(ds.lon_rho.values, ds.lat_rho.values))
    ds["mask_rho"] = (ds.lon_rho.dims, (~land).astype(float))
    u = wind(ds.lon_u.values, ds.lat_u.values)[0]
    v = wind(ds.lon_v.values, ds.lat_v.values)[1]
    ds["u"] = (ds.lon_u.dims, u, EAST_AT_SEA)
    ds["v"] = (ds.lon_v.dims, v, NORTH_AT_SEA)
    if kind == "places of cells alone":
        ds = ds.drop_vars(["lon_u", "lat_u", "lon_v", "lat_v"])
    inside = (slice(1, -1), slice(1, -1))
    a, b = ds.lon_rho.values[inside], ds.lat_rho.values[inside]
    truth = on_earth(a, b, tolerance=AVERAGED, scalars={"temp": warmth})
    if kind == "no mask":
        return ds.drop_vars("mask_rho"), truth
    return ds, without(truth, land[inside])


def declared(**dimensions: str) -> dict[str, Any]:
    topology: dict[str, Any] = {"cf_role": "grid_topology", "topology_dimension": 2}
    return topology | dimensions


def sides(dims: dict[str, tuple[str, str]]) -> xr.Dataset:
    """Return the flow on the sides of cells in a plane, with dimensions of u, v and the places."""
    parts = {"u": plane(*np.meshgrid(X, MIDDLE_Y))[0], "v": plane(*np.meshgrid(MIDDLE_X, Y))[1]}
    ds = xr.Dataset()
    for (name, values), location in zip(parts.items(), ("edge1", "edge2"), strict=True):
        ds[name] = (dims[name], values, SPEED | {"grid": "grid", "location": location})
    lines = {"node": (X, Y), "face": (MIDDLE_X, MIDDLE_Y)}
    for place, line in lines.items():
        for letter, values in zip("ab", np.meshgrid(*line), strict=True):
            ds[f"{letter}_{place}"] = (dims[place], values, METRES | {"location": place})
    return ds


CELLS = "c1: n1 (padding: none) c2: n2 (padding: none)"
PLACES = {"node_coordinates": "a_node b_node", "face_coordinates": "a_face b_face"}


@variants(["plain", "transposed", "nodes alone", "dimensions of edges"])
def sgrid_of_any_names(kind: str) -> Any:
    dims = {"u": ("c2", "n1"), "v": ("n2", "c1"), "node": ("n2", "n1"), "face": ("c2", "c1")}
    topology = declared(node_dimensions="n1 n2", face_dimensions=CELLS, **PLACES)
    topology |= {"edge1_dimensions": "n1 c2: n2 (padding: none)"}
    topology |= {"edge2_dimensions": "c1: n1 (padding: none) n2"}
    if kind == "dimensions of edges":
        dims |= {"u": ("e2", "e1"), "v": ("f2", "f1")}
        topology |= {"edge1_dimensions": "e1: n1 e2: n2 (padding: none)"}
        topology |= {"edge2_dimensions": "f1: n1 (padding: none) f2: n2"}
    ds = sides(dims)
    if kind == "nodes alone":
        ds = ds.drop_vars(["a_face", "b_face"])
    ds["grid"] = ((), 0, topology)
    if kind == "transposed":
        ds = ds.transpose()
    truth = in_plane(MIDDLE_X, MIDDLE_Y, unit="m", speed_unit="m/s", tolerance=AVERAGED)
    return ds, truth


@variants(["low", "high"])
def sgrid_with_one_dimension_for_sides_and_cells(padding: str) -> Any:
    """The location of each variable tells, where the dimensions do not."""
    topology = declared(
        node_dimensions="x y",
        face_dimensions=f"x: x (padding: {padding}) y: y (padding: {padding})",
        face_coordinates="a_face b_face",
    )
    places = dict.fromkeys(("u", "v", "node", "face"), ("y", "x"))
    ds = xr.Dataset()
    step = X[1] - X[0]
    shift = step / 2 if padding == "high" else -step / 2
    line = {"face": (X, Y), "u": (X - shift, Y), "v": (X, Y - shift)}
    for name, values in zip(("a_face", "b_face"), np.meshgrid(*line["face"]), strict=True):
        ds[name] = (places["face"], values, METRES)
    ds["u"] = (places["u"], plane(*np.meshgrid(*line["u"]))[0], SPEED | {"location": "edge1"})
    ds["v"] = (places["v"], plane(*np.meshgrid(*line["v"]))[1], SPEED | {"location": "edge2"})
    ds["grid"] = ((), 0, topology)
    inside = slice(1, None) if padding == "low" else slice(None, -1)
    truth = in_plane(X[inside], Y[inside], unit="m", speed_unit="m/s", tolerance=AVERAGED)
    return ds, truth


@form(error="face_dimensions.*padding")
def sgrid_that_declares_no_cells() -> Any:
    dims = {"u": ("c2", "n1"), "v": ("n2", "c1"), "node": ("n2", "n1"), "face": ("c2", "c1")}
    return sides(dims).assign(grid=((), 0, declared(node_dimensions="n1 n2")))


# --- points and images ----------------------------------------------------------------------------


@variants(["node_x", "FlowElem_xcc", "pos_x", "cell_center_x"])
def places_of_points_by_name(name: str) -> Any:
    other = name[::-1].replace("x", "y", 1)[::-1]
    places = 3 * np.random.default_rng(4).random((400, 2))
    parts = [*places.T, *plane(*places.T)]
    ds = xr.Dataset({n: ("points", part) for n, part in zip("abuv", parts, strict=True)})
    return ds.rename(a=name, b=other), at_points(places)


@variants(["node", "position"])
def table_of_points_by_name(word: str) -> Any:
    places = 3 * np.random.default_rng(4).random((400, 2))
    u, v = plane(*places.T)
    columns = {f"{word}_x": places[:, 0], f"{word}_y": places[:, 1], "u": u, "v": v}
    pandas = pytest.importorskip("pandas")
    return pandas.DataFrame(columns), at_points(places)


def in_pixels(unit: str) -> tuple[xr.Dataset, Truth]:
    """Return a dataset of PIVPy, (y, x, t), and its truth in pixels per frame."""
    x, y = np.arange(8.0, 320, 16), np.arange(8.0, 240, 16)
    a, b = np.meshgrid(x, y)
    times = np.arange(3.0)

    def flow(x: Any, y: Any, t: Any = 0.0) -> Any:
        return plane(np.asarray(x) / 100, np.asarray(y) / 100, t)

    u, v = (np.stack(part, axis=-1) for part in zip(*(flow(a, b, t) for t in times), strict=True))
    dims = ("y", "x", "t")
    attrs = {"units": unit}
    ds = xr.Dataset(
        {"u": (dims, u, attrs), "v": (dims, v, attrs), "chc": (dims, np.ones_like(u))},
        {"x": ("x", x, {"units": "pix"}), "y": ("y", y, {"units": "pix"})},
        {"delta_t": 0.0},
    )
    ds = ds.assign_coords(t=("t", times, {"units": "frame"}))
    ds["mask"] = (dims[:2], np.zeros(a.shape))
    truth = in_plane(x, y, times, flow=flow, unit="pixel", speed_unit="pixel/frame", undated=True)
    return ds, truth


@variants(["pix", "pix/dt", "px/frame"])
def images_in_pixels(unit: str) -> Any:
    return in_pixels(unit)


@form(says="rejected")
def images_with_rejected_vectors() -> Any:
    """The flag of Insight is negative, and the mask of OpenPIV is 1, for vectors to leave out."""
    ds, truth = in_pixels("pix")
    ds.mask.values[:3, :4] = 1
    ds.chc.values[8, 9] = -2
    blank = (ds.mask.values > 0) | (ds.chc.values[..., 0] < 0)
    return ds, without(truth, blank)


@form()
def components_by_the_letters_of_the_coordinates() -> Any:
    ds, truth = in_pixels("pix")
    ds = ds.rename(u="velocity_n", v="velocity_z").assign(velocity_s=0 * ds.u)
    ds = ds.assign_coords(grid_n=("x", ds.x.values), grid_z=("y", ds.y.values))
    for name in ("grid_n", "grid_z"):
        ds[name].attrs["units"] = "pix"
    return ds.drop_vars(["x", "y"]), truth
