"""A tripolar grid: parallels and meridians, and a cap in the north with two poles, which folds.

The cap is that of Murray (1996): confocal curves between two poles on its border, at right angles.
A component is that of a rotating ball along the rows or the columns of the grid.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from llc_grid import degrees, rotation, unit

from flowtex._util.array_types import Floats

#: Columns, rows of the south, and rows of the cap.
COLUMNS, OF_SOUTH, OF_CAP = 120, 60, 24
#: Rows of cells up to the fold.
ROWS = OF_SOUTH + OF_CAP
#: Southern end, border of the cap, and longitude of the first pole, in degrees.
SOUTH, CAP, POLE = -70.0, 65.0, 73.0
X = {"units": "m s-1", "standard_name": "sea_water_x_velocity"}
Y = {"units": "m s-1", "standard_name": "sea_water_y_velocity"}


def place(i: Any, j: Any) -> Floats:
    """Return unit vectors at numbers of sides along the columns and rows, also beyond the fold."""
    i, j = np.broadcast_arrays(np.asarray(i, float), np.asarray(j, float))
    over = j > ROWS
    i = np.where(over, COLUMNS - i, i) % COLUMNS
    j = np.where(over, 2 * ROWS - j, j)
    angle = 2 * np.pi * i / COLUMNS
    # Curves of the bipolar cap are straight where the two poles are far left and right.
    on_border = np.exp(1j * angle)
    with np.errstate(divide="ignore", invalid="ignore"):
        strip = np.log((1 + on_border) / (1 - on_border)).real
        share = np.clip((j - OF_SOUTH) / OF_CAP, 0, None)
        height = np.where(np.sin(angle) >= 0, 1, -1) * np.pi / 2 * (1 - share)
        z = np.tanh((strip + 1j * height) / 2)
    z = np.where(np.isfinite(z), z, np.sign(np.cos(angle)))
    scale = np.tan(np.radians(90 - CAP) / 2)
    lat = 90 - 2 * np.degrees(np.arctan(np.abs(z) * scale))
    cap = unit(POLE + np.degrees(np.angle(z)), lat)
    south = unit(POLE + np.degrees(angle), SOUTH + (CAP - SOUTH) * j / OF_SOUTH)
    return np.where((j <= OF_SOUTH)[..., None], south, cap)


def component(i: Any, j: Any, *, axis: int) -> Floats:
    """Return the component along rows (0) or columns (1)."""
    h = 1e-3
    across, upward = ((h, 0.0), (0.0, h))[axis]
    ahead = place(i + across, j + upward) - place(i - across, j - upward)
    # At a pole on the fold there is no direction.
    ahead /= np.maximum(np.linalg.norm(ahead, axis=-1, keepdims=True), 1e-12)
    return np.asarray((rotation(place(i, j)) * ahead).sum(-1))


def lonlat(dims: tuple[str, str], i: Any, j: Any) -> tuple[Any, Any]:
    lon, lat = degrees(place(*np.meshgrid(i, j)))
    return (dims, lon, {"units": "degrees_east"}), (dims, lat, {"units": "degrees_north"})


def mom6(*, symmetric: bool, nominal: bool) -> xr.Dataset:
    """MOM6: components on sides, without or with the first ones, and perhaps nominal axes."""
    i, j = np.arange(COLUMNS) + 0.5, np.arange(ROWS) + 0.5
    i_side, j_side = np.arange(COLUMNS) + 1.0, np.arange(ROWS) + 1.0
    if symmetric:
        i_side, j_side = np.arange(COLUMNS + 1.0), np.arange(ROWS + 1.0)
    lines = {"xh": i, "xq": i_side, "yh": j, "yq": j_side}
    ds = xr.Dataset(
        {
            "uo": (("yh", "xq"), component(*np.meshgrid(i_side, j), axis=0), X),
            "vo": (("yq", "xh"), component(*np.meshgrid(i, j_side), axis=1), Y),
        }
    )
    for end, dims in (("", ("yh", "xh")), ("_u", ("yh", "xq")), ("_v", ("yq", "xh"))):
        lon, lat = lonlat(dims, lines[dims[1]], lines[dims[0]])
        ds = ds.assign_coords({f"geolon{end}": lon, f"geolat{end}": lat})
    if nominal:
        for name, line in lines.items():
            values, word = 3 * line - 287, "degrees_E"
            if name.startswith("y"):
                values, word = SOUTH + (90 - SOUTH) * line / ROWS, "degrees_N"
            ds = ds.assign_coords({name: (name, values, {"units": word})})
    return ds


def nemo(pivot: str, kind: str, *, halo: bool = True) -> Any:
    """NEMO: the fold through T or F points, and columns and a row that repeat others.

    Positions are those of each component, of a mesh mask in a third dataset, or all in one.
    """
    i = np.arange(COLUMNS) + 0.5
    if halo:
        i = np.arange(-1, COLUMNS + 1) + 0.5
    j = np.arange(0, ROWS + 1) + 0.5
    if pivot == "T":
        j = np.arange(1.0, ROWS + 2)
    sides = {"t": (i, j), "u": (i + 0.5, j), "v": (i, j + 0.5), "f": (i + 0.5, j + 0.5)}
    dims = ("y", "x")
    u = xr.Dataset({"uo": (dims, component(*np.meshgrid(*sides["u"]), axis=0), X)})
    v = xr.Dataset({"vo": (dims, component(*np.meshgrid(*sides["v"]), axis=1), Y)})
    places = {}
    for letter, lines in sides.items():
        places[f"glam{letter}"], places[f"gphi{letter}"] = lonlat(dims, *lines)
    if kind == "own":
        u = u.assign_coords(nav_lon=places["glamu"], nav_lat=places["gphiu"])
        return [u, v.assign_coords(nav_lon=places["glamv"], nav_lat=places["gphiv"])]
    if kind == "mesh mask":
        return [u, v, xr.Dataset(places)]
    return u.merge(v).assign_coords(places)
