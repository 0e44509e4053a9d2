"""Forms of further models on grids: ocean, weather, eddies and waves, mostly on sides of cells."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from form_table import form, variants
from known_flow import AVERAGED, Truth, at_points, dates, in_plane, on_earth, plane, wind
from public_forms import Curved, numbers, places_of

from flowtex._util.array_types import AnyArray, Floats

pyproj = pytest.importorskip("pyproj")

X, Y = np.linspace(0, 3, 25), np.linspace(0, 2, 17)
MIDDLE_X, MIDDLE_Y = (X[1:] + X[:-1]) / 2, (Y[1:] + Y[:-1]) / 2
#: Velocity of two levels, of which the first or the last is at the surface.
FALLING, RISING = (np.array(f)[None, :, None, None] for f in ((1.0, 0.5), (0.5, 1.0)))


def all_but(shape: tuple[int, int], row: int, column: int) -> AnyArray:
    """Return which nodes must be there: all but those of a row and a column."""
    core = np.ones(shape, dtype=bool)
    core[row] = core[:, column] = False
    return core


def along(x: Floats, y: Floats, number: int) -> Floats:
    """Return a component of the flow in the plane on the nodes of two lines."""
    return np.asarray(plane(*np.meshgrid(x, y))[number])


# --- on the Earth ---------------------------------------------------------------------------------

ROTATED = Curved(-40, 50, (0.3, 0.06), (-0.06, 0.25))
I, J = numbers(14, 18)
#: Shifts of the points of T, u and v by parts of a cell along rows and columns.
ON_RIGHT = {"": (0.0, 0.0), "_u": (0.5, 0.0), "_v": (0.0, 0.5)}


def places(shift: tuple[float, float]) -> tuple[Floats, Floats]:
    return ROTATED.places(I + shift[0], J + shift[1])


def component(shift: tuple[float, float], number: int) -> Floats:
    return ROTATED.components(I + shift[0], J + shift[1])[number]


@variants(["with cells", "without cells"])
def positions_of_sides_alone(kind: str) -> Any:
    """MPIOM by CDO: each component has positions that say nothing of sides, as lon and lon_2."""
    names = {"_u": ("", "uko"), "_v": ("_2", "vke"), "": ("_3", "tho")}
    if kind == "without cells":
        del names[""]
    ds = xr.Dataset()
    for number, (point, (end, name)) in enumerate(names.items()):
        shift = ON_RIGHT[point]
        dims = (f"y{end}", f"x{end}")
        ds = ds.assign_coords(places_of(dims, (f"lon{end}", f"lat{end}"), *places(shift)))
        attrs = {"units": "K"}
        if point:
            attrs = {"units": "m s-1", "standard_name": f"sea_water_{'xy'[number]}_velocity"}
        ds[name] = (("time", "depth", *dims), component(shift, number % 2)[None, None], attrs)
    ds = ds.assign_coords(depth=("depth", [6.0], {"units": "m", "axis": "Z"}), time=dates([0.0]))
    core = all_but(I.shape, 0, 0)
    return ds, on_earth(*places((0, 0)), core=core, tolerance=5e-3)


@form()
def sides_of_a_rotated_pole() -> Any:
    """COSMO: dimensions rlon and srlon, longitudes lon and slonu."""
    pole = {"grid_mapping_name": "rotated_latitude_longitude"}
    crs = pyproj.CRS.from_cf(
        pole | {"grid_north_pole_latitude": 43.0, "grid_north_pole_longitude": -170.0}
    )
    to_degrees = pyproj.Transformer.from_crs(crs, crs.geodetic_crs, always_xy=True).transform
    rlon, rlat = np.arange(-10.0, 8), np.arange(-8.0, 7)

    def turned(a: Any, b: Any, number: int) -> tuple[Floats, Floats, Floats]:
        lon, lat = to_degrees(*np.meshgrid(a, b))
        ahead = to_degrees(*np.meshgrid(a + 1e-4, b))
        step = np.stack([(ahead[0] - lon) * np.cos(np.radians(lat)), ahead[1] - lat])
        cos, sin = step / np.hypot(*step)
        east, north = wind(lon, lat)
        return lon, lat, (east * cos + north * sin, north * cos - east * sin)[number]

    lon, lat, _ = turned(rlon, rlat, 0)
    ds = xr.Dataset({"rotated_pole": ((), b"", crs.to_cf())})
    for name, grid_dims, end, number in (
        ("U", ("rlat", "srlon"), "u", 0),
        ("V", ("srlat", "rlon"), "v", 1),
    ):
        shifts = (0.5 * (number == 0), 0.5 * (number == 1))
        a, b, values = turned(rlon + shifts[0], rlat + shifts[1], number)
        word = ("eastward", "northward")[number]
        attrs = {"units": "m s-1", "standard_name": f"grid_{word}_wind"}
        attrs["grid_mapping"] = "rotated_pole"
        ds[name] = (("time", "level", *grid_dims), values * RISING, attrs)
        ds = ds.assign_coords(places_of(grid_dims, (f"slon{end}", f"slat{end}"), a, b))
    ds = ds.assign_coords(places_of(("rlat", "rlon"), ("lon", "lat"), lon, lat))
    level = {"standard_name": "model_level_number", "positive": "down", "axis": "Z"}
    lines = {"rlon": rlon, "rlat": rlat, "srlon": rlon + 0.5, "srlat": rlat + 0.5}
    ds = ds.assign_coords(lines)
    ds = ds.assign_coords(level=("level", [1.0, 2.0], level), time=dates([0.0]))
    return ds, on_earth(lon, lat, core=all_but(lon.shape, 0, 0), tolerance=AVERAGED)


@form()
def sides_on_the_left_by_positions() -> Any:
    """Meso-NH: u is west of its cell, and all dimensions have names and lines of their own."""
    shifts = {"": (0.0, 0.0), "_u": (-0.5, 0.0), "_v": (0.0, -0.5)}
    ds = xr.Dataset()
    for end, shift in shifts.items():
        dims = (f"nj{end}", f"ni{end}")
        names = (f"longitude{end}", f"latitude{end}")
        ds = ds.assign_coords(places_of(dims, names, *places(shift)))
        for dim, count, part in ((dims[0], 14, shift[1]), (dims[1], 18, shift[0])):
            ds = ds.assign_coords({dim: (dim, 2e3 * (np.arange(count) + part), {"units": "m"})})
    for number, (name, end) in enumerate((("UT", "_u"), ("VT", "_v"))):
        attrs = {"units": "m s-1", "standard_name": f"{'xy'[number]}_wind"}
        values = component(shifts[end], number) * FALLING
        ds[name] = (("time", "level", f"nj{end}", f"ni{end}"), values, attrs)
    height = ("level", [10.0, 50.0], {"units": "m", "axis": "Z", "positive": "up"})
    ds = ds.assign_coords(level=height, time=dates([0.0]))
    return ds, on_earth(*places((0, 0)), core=all_but(I.shape, -1, -1), tolerance=5e-3)


@variants(["longitude_c longitude_f latitude_c latitude_f", "xt xu yt yu"])
def lines_of_cells_and_sides(names: str) -> Any:
    """Oceananigans and Veros: lines in degrees; of Veros as many sides as cells, on the right."""
    lon, side_lon, lat, side_lat = names.split()
    is_inner = lon == "xt"
    middles = np.arange(20.5, 45), np.arange(-9.5, 10)
    sides = np.arange(20.0 + is_inner, 46), np.arange(-10.0 + is_inner, 11)
    u = wind(*np.meshgrid(sides[0], middles[1]))[0]
    v = wind(*np.meshgrid(middles[0], sides[1]))[1]
    words = ("zonal", "meridional")
    attrs = [{"units": "m/s", "long_name": f"Velocity in the {word} direction"} for word in words]
    ds = xr.Dataset(
        {
            "u": (("time", "z", lat, side_lon), u * RISING, attrs[0]),
            "v": (("time", "z", side_lat, lon), v * RISING, attrs[1]),
        },
        {
            lon: (lon, middles[0], {"units": "degrees east"}),
            side_lon: (side_lon, sides[0], {"units": "degrees east"}),
            lat: (lat, middles[1], {"units": "degrees north"}),
            side_lat: (side_lat, sides[1], {"units": "degrees north"}),
            "z": ("z", [-30.0, -10.0], {"units": "m"}),
            "time": ("time", np.zeros(1, "timedelta64[ns]")),
        },
    )
    core = None
    if is_inner:
        core = all_but((20, 25), 0, 0)
    return ds, on_earth(*middles, core=core, undated=True, tolerance=AVERAGED)


@form(says="other pairs: ubar,vbar")
def means_over_the_depth_beside() -> Any:
    """SODA for CROCO: dimensions lonU and lonT, and long names in capitals."""
    lon, lat = np.arange(-80.0, -64, 0.5), np.arange(-40.0, -26, 0.5)
    ds = xr.Dataset(
        {"temp": (("depth", "latT", "lonT"), np.ones((2, len(lat), len(lon))), {"units": "C"})}
    )
    for letter, values, word in zip("uv", wind(*np.meshgrid(lon, lat)), WORDS, strict=True):
        dims = (f"lat{letter.upper()}", f"lon{letter.upper()}")
        mean = {"units": "m/sec", "long_name": f"{word} BAROTROPIC VELOCITY"}
        ds[f"{letter}bar"] = (("time", *dims), 0.1 * values[None], mean)
        attrs = {"units": "m/sec", "long_name": f"{word} VELOCITY"}
        ds[letter] = (("time", "depth", *dims), values * FALLING, attrs)
    for letter in "TUV":
        ds[f"lon{letter}"] = (f"lon{letter}", lon, {"units": "degrees_east"})
        ds[f"lat{letter}"] = (f"lat{letter}", lat, {"units": "degrees_north"})
    since = {"units": "days since 1-Jan-2000 00:00:0.0"}
    depth = ("depth", [5.0, 15.0], {"units": "meters"})
    return ds.assign_coords(depth=depth, time=("time", [8766.0], since)), on_earth(lon, lat)


WORDS = ("ZONAL", "MERIDIONAL")


# --- in a plane -----------------------------------------------------------------------------------


@form(error=r"u, v \(long name .*; uinterp, vinterp .*Name one")
def averages_beside_the_sides() -> Any:
    ds, _ = sides_in_kilometres()
    for name, number in (("uinterp", 0), ("vinterp", 1)):
        values = along(MIDDLE_X, MIDDLE_Y, number) * FALLING
        words = f"{'xy'[number]}-component of velocity, interpolated to scalar points"
        dims = ("time", "zh", "yh", "xh")
        ds[name] = (dims, values, {"units": "m/s", "long_name": words})
    return ds


def sides_in_kilometres() -> tuple[xr.Dataset, Truth]:
    """Return eddies of CM1, where h is in the middle of cells and f on their sides."""
    words = "{}-component of velocity (on staggered grid)"
    ds = xr.Dataset(
        {
            "u": (("time", "zh", "yh", "xf"), along(X, MIDDLE_Y, 0) * FALLING),
            "v": (("time", "zh", "yf", "xh"), along(MIDDLE_X, Y, 1) * FALLING),
        },
        {"time": ("time", np.array([3600], "timedelta64[s]").astype("timedelta64[ns]"))},
    )
    for name, axis in (("u", "x"), ("v", "y")):
        ds[name].attrs = {"units": "m/s", "long_name": words.format(axis)}
    lines = {"xh": MIDDLE_X, "xf": X, "yh": MIDDLE_Y, "yf": Y}
    for name, line in lines.items():
        ds = ds.assign_coords({name: (name, line, {"units": "km", "axis": name[0].upper()})})
    height = {"units": "km", "axis": "Z", "positive": "up"}
    truth = in_plane(MIDDLE_X, MIDDLE_Y, unit="km", speed_unit="m/s", undated=True)
    return ds.assign_coords(zh=("zh", [0.1, 0.3], height)), replace(truth, tolerance=2 * AVERAGED)


@form()
def eddies_of_which_h_is_in_the_middle() -> Any:
    return sides_in_kilometres()


@variants(["files", "one file"])
def eddies_of_which_h_is_on_the_left(kind: str) -> Any:
    """MicroHH: as many sides as cells, no units, a file for each component."""
    lines = {"xh": X[:-1], "yh": Y[:-1], "x": MIDDLE_X, "y": MIDDLE_Y}
    u = along(X[:-1], MIDDLE_Y, 0) * FALLING
    v = along(MIDDLE_X, Y[:-1], 1) * FALLING
    parts = {"u": (("time", "z", "y", "xh"), u), "v": (("time", "z", "yh", "x"), v)}
    files = []
    for name, part in parts.items():
        ds = xr.Dataset({name: part}, {"z": [0.1, 0.2], "time": ("time", [0.0])})
        files.append(ds.assign_coords({dim: lines[dim] for dim in part[0][2:]}))
    truth = in_plane(MIDDLE_X, MIDDLE_Y, undated=True, core=all_but((16, 24), -1, -1))
    truth = replace(truth, tolerance=2 * AVERAGED)
    if kind == "one file":
        return xr.merge(files), truth
    return files, truth


@variants(["x_caa x_faa y_aca y_afa z_aac", "xC xF yC yF zC"])
def periodic_in_one_direction(names: str) -> Any:
    """Oceananigans: as many sides as cells along x, and one more along y."""
    middle_x, side_x, middle_y, side_y, z = names.split()
    lines = {middle_x: MIDDLE_X, side_x: X[:-1], middle_y: MIDDLE_Y, side_y: Y}
    ds = xr.Dataset(
        {
            "u": (("time", z, middle_y, side_x), along(X[:-1], MIDDLE_Y, 0) * RISING),
            "v": (("time", z, side_y, middle_x), along(MIDDLE_X, Y, 1) * RISING),
        },
        {name: (name, line, {"units": "m"}) for name, line in lines.items()},
    )
    for name, words in (("u", "zonal direction (+ = east)"), ("v", "meridional direction")):
        ds[name].attrs = {"units": "m/s", "long_name": f"Velocity in the {words}."}
    ds = ds.assign_coords({z: (z, [-30.0, -10.0], {"units": "m"}), "time": ("time", [0.0])})
    core = np.ones((16, 24), dtype=bool)
    core[:, -1] = False
    truth = in_plane(MIDDLE_X, MIDDLE_Y, unit="m", speed_unit="m/s", undated=True, core=core)
    return ds, replace(truth, tolerance=3 * AVERAGED)


class Turned:
    """A grid in metres whose rows are turned against x."""

    def __init__(self) -> None:
        self.turn = np.radians(20)

    def places(self, i: Any, j: Any) -> tuple[Floats, Floats]:
        x, y, cos, sin = 100.0 * i, 80.0 * j, np.cos(self.turn), np.sin(self.turn)
        return x * cos - y * sin + 5e5, x * sin + y * cos + 4e6

    def flow(self, x: Any, y: Any, _time: Any = 0.0) -> tuple[Floats, Floats]:
        return plane((np.asarray(x) - 5e5) / 600, (np.asarray(y) - 4e6) / 600)

    def components(self, i: Any, j: Any) -> tuple[Floats, Floats]:
        """Return the components along rows and columns."""
        u, v = self.flow(*self.places(i, j))
        cos, sin = np.cos(self.turn), np.sin(self.turn)
        return u * cos + v * sin, v * cos - u * sin

    def truth(self, x: Any, y: Any) -> Truth:
        points = np.stack([np.ravel(x), np.ravel(y)], axis=-1)
        more = {"unit": "m", "speed_unit": "m/s", "undated": True, "tolerance": 5e-3}
        return at_points(points, flow=self.flow, **more)


@form()
def x_and_y_by_their_long_names() -> Any:
    """XBeach: positions globalx and globaly over both axes."""
    grid = Turned()
    x, y = grid.places(I, J)
    dims = ("globaltime", "ny", "nx")
    ds = xr.Dataset()
    for name, values, axis in zip(("ue", "ve"), grid.flow(x, y), "xy", strict=True):
        words = f"Eulerian velocity in cell centre, {axis}-component"
        ds[name] = (dims, values[None], {"units": "m/s", "long_name": words})
    for axis, values in zip("xy", (x, y), strict=True):
        attrs = {"units": "m", "long_name": f"local {axis} coordinate"}
        ds = ds.assign_coords({f"global{axis}": (dims[1:], values, attrs)})
    time = ("globaltime", [10.0], {"units": "s", "axis": "T"})
    return ds.assign_coords(globaltime=time), grid.truth(x, y)


@variants(["declared", "transposed"])
def first_axis_along_x(kind: str) -> Any:
    """Delft3D-FLOW: the first axis is along x, sides come before cells, and a row is a dummy.

    Without the topology nothing tells that u is along the first axis: a notice proposes to
    transpose the dataset.
    """
    grid = Turned()
    i, j = np.arange(18.0)[:, None] + np.zeros(15), np.zeros((18, 1)) + np.arange(15.0)
    x, y = grid.places(i - 0.5, j - 0.5)
    u, v = grid.components(i, j - 0.5)[0], grid.components(i - 0.5, j)[1]
    dummy = (i == 0) | (j == 0)
    u[:, 0] = v[0] = -999.0
    x[dummy] = y[dummy] = 0.0
    ds = xr.Dataset(
        {
            "U1": (("time", "K", "MC", "N"), u[None, None], {"location": "edge1"}),
            "V1": (("time", "K", "M", "NC"), v[None, None], {"location": "edge2"}),
        },
        {"XZ": (("M", "N"), x), "YZ": (("M", "N"), y), "time": dates([0.0])},
    )
    for name, values in zip(("XCOR", "YCOR"), grid.places(i, j), strict=True):
        ds = ds.assign_coords({name: (("MC", "NC"), values)})
    for name in ("U1", "V1"):
        words = f"{name[0]}-velocity per layer in {name[0]}-point"
        ds[name].attrs |= {"units": "m/s", "long_name": words, "grid": "grid"}
    for name in ("XZ", "YZ", "XCOR", "YCOR"):
        standard_name = f"projection_{name[0].lower()}_coordinate"
        ds[name].attrs = {"units": "m", "standard_name": standard_name}
    truth = grid.truth(x[~dummy], y[~dummy])
    if kind == "transposed":
        return ds.transpose(..., "N", "NC", "M", "MC"), truth
    topology = {"cf_role": "grid_topology", "topology_dimension": 2, "node_dimensions": "MC NC"}
    topology["face_dimensions"] = "M:MC (padding: low) N:NC (padding: low)"
    topology |= {"node_coordinates": "XCOR YCOR", "face_coordinates": "XZ YZ"}
    return ds.assign(grid=((), 0, topology)), truth
