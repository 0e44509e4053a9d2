"""The grid of MITgcm in 13 tiles (LLC) with components on the sides of cells, around any axis.

Twelve tiles have rows and columns along parallels and meridians, of which six are turned; the one
in the north is a square that a conformal map bends into a cap, so that all rows and columns meet
their neighbours at right angles.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from scipy.special import ellipj, ellipk

from flowtex._util.array_types import AnyArray, Floats

#: Latitude of the border of the cap, and of the southern end, in degrees.
CAP, SOUTH = 60.0, -75.0
#: Places of sides in their cells, which they nearly reach: other tiles go on in other directions.
SIDES = {"western": 1e-3, "southern": 1e-3, "eastern": 1 - 1e-3, "northern": 1 - 1e-3}
#: Parts of the Earth's axis of the rotation, and of others, in metres per second at its equator.
AXIS = (3.0, -5.0, 8.0)


def rotation(p: Floats) -> Floats:
    """Return the velocity of a rotating ball at unit vectors (..., 3), in m/s."""
    return np.cross(AXIS, p)


def unit(lon: Any, lat: Any) -> Floats:
    """Return unit vectors of degrees."""
    a, b = np.radians(lon), np.radians(lat)
    return np.stack([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b) + 0 * a], axis=-1)


def degrees(p: Floats) -> tuple[Floats, Floats]:
    p = p / np.linalg.norm(p, axis=-1, keepdims=True)
    return np.degrees(np.arctan2(p[..., 1], p[..., 0])), np.degrees(np.arcsin(p[..., 2]))


def _in_disc(z: AnyArray) -> AnyArray:
    """Map the square of corners ±1 ± i onto the unit disc, angles kept."""
    whole = ellipk(0.5)
    w = whole * (1 + 1j) / 2 * z - whole
    s, c, d, _ = ellipj(w.real, 0.5)
    s1, c1, d1, _ = ellipj(w.imag, 0.5)
    cn = (c * c1 - 1j * s * d * s1 * d1) / (1 - d**2 * s1**2)
    return np.asarray((1 - 1j) / np.sqrt(2) * cn)


def _cap(a: Floats, b: Floats) -> Floats:
    """Return unit vectors in the cap at places of the square from 0 to 1."""
    z = _in_disc(2 * a - 1 + 1j * (2 * b - 1))
    scale = np.tan(np.radians(90 - CAP) / 2)
    lat = 90 - 2 * np.degrees(np.arctan(np.abs(z) * scale))
    return unit(np.degrees(np.angle(z)), lat)


class Tile(NamedTuple):
    """A tile: unit vectors at numbers of nodes along i and j, from 0 to n."""

    number: int
    n: int

    def at(self, i: Any, j: Any) -> Floats:
        i, j = np.broadcast_arrays(np.asarray(i, float), np.asarray(j, float))
        n, k = self.n, self.number
        if k == 6:
            return _cap(i / n, j / n)
        # Along the border of the cap, and away from it, each from 0 to 1.
        if k < 6:
            along, away = i / n, (2 - k % 3) + 1 - j / n
        else:
            along, away = 1 - j / n, ((k - 7) % 3) + i / n
        side = (along, 0 * along)
        if k >= 3:
            side = (1 + 0 * along, along)
        if k >= 7:
            side = (1 - along, 1 + 0 * along)
        if k >= 10:
            side = (0 * along, 1 - along)
        # Tiles 7 to 9 and 10 to 12 lie beside the sides i = n and j = n of the cap.
        if 7 <= k < 10:
            side = (1 + 0 * along, j / n)
        if k >= 10:
            side = (1 - j / n, 1 + 0 * along)
        if 3 <= k < 6:
            side = (i / n, 0 * along)
        if k < 3:
            side = (0 * along, 1 - i / n)
        lon, _ = degrees(_cap(*side))
        return unit(lon, CAP + (SOUTH - CAP) * away / 3)


def along(tile: Tile, i: Floats, j: Floats, axis: int) -> Floats:
    """Return unit vectors along i (0) or j (1) at places of a tile."""
    h = 1e-4
    steps = ((h, 0.0), (0.0, h))[axis]
    ahead = tile.at(i + steps[0], j + steps[1]) - tile.at(i - steps[0], j - steps[1])
    return np.asarray(ahead / np.linalg.norm(ahead, axis=-1, keepdims=True))


def llc(
    n: int = 12,
    *,
    angles: bool = False,
    face: str = "face",
    sides: tuple[str, str] = ("western", "southern"),
) -> xr.Dataset:
    """Return u and v on sides of cells of the 13 tiles, such as the western and southern ones."""
    middle = np.arange(n) + 0.5
    side_i = np.arange(n) + SIDES[sides[0]]
    side_j = np.arange(n) + SIDES[sides[1]]
    arrays: dict[str, list[Floats]] = {name: [] for name in ("XC", "YC", "U", "V", "CS", "SN")}
    for number in range(13):
        tile = Tile(number, n)
        i, j = np.meshgrid(middle, middle)
        centre = tile.at(i, j)
        lon, lat = degrees(centre)
        a, b = np.radians(lon), np.radians(lat)
        east = np.stack([-np.sin(a), np.cos(a), 0 * a], axis=-1)
        north = np.stack([-np.sin(b) * np.cos(a), -np.sin(b) * np.sin(a), np.cos(b)], axis=-1)
        forward = along(tile, i, j, 0)
        arrays["XC"].append(lon)
        arrays["YC"].append(lat)
        arrays["CS"].append((forward * east).sum(-1))
        arrays["SN"].append((forward * north).sum(-1))
        i, j = np.meshgrid(side_i, middle)
        arrays["U"].append((rotation(tile.at(i, j)) * along(tile, i, j, 0)).sum(-1))
        i, j = np.meshgrid(middle, side_j)
        arrays["V"].append((rotation(tile.at(i, j)) * along(tile, i, j, 1)).sum(-1))
    cells = (face, "j", "i")
    names = {True: "g", False: "right"}
    dims = {
        "U": (face, "j", f"i_{names[sides[0] == 'western']}"),
        "V": (face, f"j_{names[sides[1] == 'southern']}", "i"),
    }
    ds = xr.Dataset({name: (dims.get(name, cells), np.stack(a)) for name, a in arrays.items()})
    attrs = {"U": "sea_water_x_velocity", "V": "sea_water_y_velocity"}
    for name, text in attrs.items():
        ds[name].attrs = {"units": "m s-1", "standard_name": text}
    ds = ds.set_coords(["XC", "YC", "CS", "SN"]).assign_coords({face: np.arange(13)})
    ds.XC.attrs["units"], ds.YC.attrs["units"] = "degrees_east", "degrees_north"
    if not angles:
        ds = ds.drop_vars(["CS", "SN"])
    return ds


def turning(lon: Any, lat: Any, hours: float = 0.0) -> tuple[Floats, Floats]:
    """Return eastward and northward components of the rotation."""
    del hours
    a, b = np.radians(lon), np.radians(lat)
    x, y, z = np.moveaxis(rotation(unit(lon, lat)), -1, 0)
    east = y * np.cos(a) - x * np.sin(a)
    return east, z * np.cos(b) - np.sin(b) * (x * np.cos(a) + y * np.sin(a))
