"""Datasets of flows on the Earth that are known exactly."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from flowtex._util.array_types import Floats

DEGREES = {"lon": {"units": "degrees_east"}, "lat": {"units": "degrees_north"}}
#: Axis and rate, in m/s at its equator, of a turning Earth.
AXIS, RATE = np.array([0.3, -0.5, 0.8]) / np.linalg.norm([0.3, -0.5, 0.8]), 10.0


def on_sphere(lon: Any, lat: Any) -> Floats:
    """Unit vectors of places in degrees, (..., 3)."""
    a, b = np.radians(lon), np.radians(lat)
    return np.stack([np.cos(b) * np.cos(a), np.cos(b) * np.sin(a), np.sin(b)], axis=-1)


def turning(p: Floats) -> Floats:
    """Velocity of a rigid rotation at unit vectors, (..., 3), in m/s."""
    return RATE * np.cross(AXIS, p)


def east_and_north(lon: Any, lat: Any) -> tuple[Floats, Floats]:
    """Unit vectors eastward and northward, (..., 3)."""
    a, b = np.radians(lon), np.radians(lat)
    zero = np.zeros_like(a)
    return (
        np.stack([-np.sin(a), np.cos(a), zero], axis=-1),
        np.stack([-np.sin(b) * np.cos(a), -np.sin(b) * np.sin(a), np.cos(b)], axis=-1),
    )


def components(lon: Any, lat: Any) -> tuple[Floats, Floats]:
    """Eastward and northward velocity of the rigid rotation."""
    v = turning(on_sphere(lon, lat))
    east, north = east_and_north(lon, lat)
    return np.sum(v * east, axis=-1), np.sum(v * north, axis=-1)


def winds(lon: Any, lat: Any, **more: Any) -> xr.Dataset:
    """The rigid rotation on lines of longitude and latitude, as CF has it."""
    u, v = components(*np.meshgrid(lon, lat))
    return xr.Dataset(
        {
            "u": (("lat", "lon"), u, {"standard_name": "eastward_wind", "units": "m s-1"}),
            "v": (("lat", "lon"), v, {"standard_name": "northward_wind", "units": "m s-1"}),
        },
        {
            "lon": ("lon", np.asarray(lon, dtype=float), DEGREES["lon"]),
            "lat": ("lat", np.asarray(lat, dtype=float), DEGREES["lat"]),
            **more,
        },
    )


def rotated(i: Floats, j: Floats, turn: float) -> tuple[Floats, Floats]:
    """Longitude and latitude of a grid (i, j) in degrees, whose frame is turned and moved."""
    a = np.radians(turn)
    x, y = np.cos(a) * i - np.sin(a) * j, np.sin(a) * i + np.cos(a) * j
    # The stereographic projection keeps right angles.
    x, y = np.radians(x) / 2, np.radians(y) / 2
    square = x**2 + y**2
    p = np.stack([1 - square, 2 * x, 2 * y], axis=-1) / (1 + square)[..., None]
    b = np.radians(50.0)
    p = np.stack(
        [
            np.cos(b) * p[..., 0] - np.sin(b) * p[..., 2],
            p[..., 1],
            np.sin(b) * p[..., 0] + np.cos(b) * p[..., 2],
        ],
        axis=-1,
    )
    return np.degrees(np.arctan2(p[..., 1], p[..., 0])), np.degrees(np.arcsin(p[..., 2]))


def along(lon: Floats, lat: Floats, ahead: tuple[Floats, Floats]) -> Floats:
    """Component of the rotation toward places a little ahead."""
    way = on_sphere(*ahead) - on_sphere(lon, lat)
    share = np.sum(turning(on_sphere(lon, lat)) * way, axis=-1)
    return np.asarray(share / np.linalg.norm(way, axis=-1))


def c_grid(kind: str, turn: float = 0.0, count: int = 40) -> list[xr.Dataset]:
    """The rotation on a staggered grid of one of the models, in datasets as they come in files."""
    c = np.linspace(-8.0, 8.0, count)
    step, tiny = c[1] - c[0], 1e-4
    shift = {"nemo": 0.5, "roms": 0.5, "mitgcm": -0.5, "comodo": -0.5}[kind] * step
    faces = c[:-1] + shift if kind == "roms" else c + shift

    def at(i: Floats, j: Floats) -> tuple[Floats, Floats]:
        return rotated(*np.meshgrid(i, j), turn)

    def ahead(i: Floats, j: Floats, di: float, dj: float) -> Floats:
        return along(*at(i, j), at(i + di, j + dj))

    lon_t, lat_t = at(c, c)
    u, v = ahead(faces, c, tiny, 0.0), ahead(c, faces, 0.0, tiny)
    if kind == "nemo":
        lon_u, lat_u, lon_v, lat_v = *at(faces, c), *at(c, faces)
        dims = ("y", "x")
        named = {"units": "m/s"}
        one = xr.Dataset(
            {"uo": (dims, u, {"long_name": "sea_water_x_velocity", **named})},
            {"nav_lon": (dims, lon_u, DEGREES["lon"]), "nav_lat": (dims, lat_u, DEGREES["lat"])},
        )
        other = xr.Dataset(
            {"vo": (dims, v, {"long_name": "sea_water_y_velocity", **named})},
            {"nav_lon": (dims, lon_v, DEGREES["lon"]), "nav_lat": (dims, lat_v, DEGREES["lat"])},
        )
        return [one, other]
    if kind == "roms":
        return [
            xr.Dataset(
                {"u": (("eta_rho", "xi_u"), u), "v": (("eta_v", "xi_rho"), v)},
                {
                    "lon_rho": (("eta_rho", "xi_rho"), lon_t, DEGREES["lon"]),
                    "lat_rho": (("eta_rho", "xi_rho"), lat_t, DEGREES["lat"]),
                },
            )
        ]
    told = {"c_grid_axis_shift": -0.5} if kind == "comodo" else {}
    names = ("x_c", "x_f", "y_c", "y_f") if kind == "comodo" else ("i", "i_g", "j", "j_g")
    xc, xf, yc, yf = names
    return [
        xr.Dataset(
            {
                "U": ((yc, xf), u, {"standard_name": "sea_water_x_velocity", "units": "m s-1"}),
                "V": ((yf, xc), v, {"standard_name": "sea_water_y_velocity", "units": "m s-1"}),
            },
            {
                "XC": ((yc, xc), lon_t, {**DEGREES["lon"], "standard_name": "longitude"}),
                "YC": ((yc, xc), lat_t, {**DEGREES["lat"], "standard_name": "latitude"}),
                xf: (xf, np.arange(count), told),
                yf: (yf, np.arange(count), told),
            },
        )
    ]
