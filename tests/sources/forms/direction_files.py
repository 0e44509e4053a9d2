"""Velocities whose components are along a radius and angles, or that are speed and direction."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv
import xarray as xr
from known_flow import AVERAGED, Truth, at_points, in_plane, on_earth, plane, wind
from supported import Made, supported

KIND = "Components along other directions"
X = np.linspace(-1.0, 1.2, 24)
Y = np.linspace(-0.9, 1.0, 19)
RADII = np.linspace(0.2, 1.0, 15)
ANGLES = np.linspace(0.0, 2 * np.pi, 36, endpoint=False)


def along_radius_and_angle(x: Any, y: Any) -> tuple[Any, Any]:
    """Return the flow in the plane along the radius and counterclockwise around the origin."""
    angle = np.arctan2(y, x)
    u, v = plane(x, y)
    cos, sin = np.cos(angle), np.sin(angle)
    return u * cos + v * sin, v * cos - u * sin


def disc(radii: Any, angles: Any) -> tuple[Any, Any]:
    """Return x and y of a grid with a row for each radius."""
    radius, angle = np.meshgrid(radii, angles, indexing="ij")
    return radius * np.cos(angle), radius * np.sin(angle)


@supported(
    KIND,
    "grid in r and phi, components along these",
    'flowtex.show(ds, u="u", v="v", components="polar")',
    "turned to x and y; names such as `u_r` and `u_phi` need no argument",
)
def grid_in_r_and_phi(folder: Path) -> Made:
    x, y = disc(RADII, ANGLES)
    radial, around = along_radius_and_angle(x, y)
    dims = ("r", "phi")
    ds = xr.Dataset({"u": (dims, radial), "v": (dims, around)}, {"r": RADII, "phi": ANGLES})
    return {"ds": ds}, in_plane(x, y)


@supported(
    KIND,
    "grid in x and y, components along a radius and an angle",
    'flowtex.show(x, y, u_r, u_phi, components="polar")',
    "the angle is that around the origin, counterclockwise",
)
def polar_components_on_x_and_y(folder: Path) -> Made:
    radial, around = along_radius_and_angle(*np.meshgrid(X, Y))
    return {"x": X, "y": Y, "u_r": radial, "u_phi": around}, in_plane(X, Y)


@supported(
    KIND,
    "staggered grid in r and phi, as of FARGO",
    "flowtex.show(ds)",
    "averaged from the sides of cells, and then turned",
)
def staggered_disc(folder: Path) -> Made:
    sides = np.linspace(0.2, 1.0, 61)
    step = 2 * np.pi / 144
    angles = np.arange(144) * step
    middles = (sides[1:] + sides[:-1]) / 2
    radial, _ = along_radius_and_angle(*disc(sides, angles + step / 2))
    _, around = along_radius_and_angle(*disc(middles, angles))
    ds = xr.Dataset(
        {"vrad": (("r_side", "phi"), radial), "vtheta": (("r", "phi_side"), around)},
        {"r": middles, "phi": angles + step / 2, "r_side": sides, "phi_side": angles},
    )
    truth = in_plane(*disc(middles, angles + step / 2), tolerance=AVERAGED)
    return {"ds": ds}, truth


def shell(sides: int = 90) -> tuple[Any, Any, Any, Any]:
    """Return colatitudes and longitudes of the sides and of the middles of cells."""
    step = np.pi / sides
    return (
        np.linspace(0.0, np.pi, sides + 1),
        np.arange(2 * sides) * step,
        (np.arange(sides) + 0.5) * step,
        (np.arange(2 * sides) + 0.5) * step,
    )


def on_shell(colatitudes: Any, longitudes: Any) -> tuple[Any, Any]:
    """Return the flow on the Earth along colatitude and longitude, southward and eastward."""
    lon, lat = np.meshgrid(np.degrees(longitudes), 90.0 - np.degrees(colatitudes))
    east, north = wind(lon, lat)
    return -north, east


def shell_truth(colatitudes: Any, longitudes: Any, **more: Any) -> Truth:
    return on_earth(np.degrees(longitudes), 90.0 - np.degrees(colatitudes), **more)


@supported(
    KIND,
    "spherical shell in theta and phi",
    "flowtex.show(ds, globe=True)",
    '`u_theta` is southward, `u_phi` eastward; of other names with `components="spherical"`',
)
def spherical_shell(folder: Path) -> Made:
    _, _, colatitudes, longitudes = shell(30)
    south, east = on_shell(colatitudes, longitudes)
    dims = ("theta", "phi")
    places = {"theta": colatitudes, "phi": longitudes}
    ds = xr.Dataset({"u_theta": (dims, south), "u_phi": (dims, east)}, places)
    return {"ds": ds}, shell_truth(colatitudes, longitudes)


@supported(
    KIND,
    "staggered spherical shell",
    "flowtex.show(ds, globe=True)",
    "averaged from the sides of cells",
)
def staggered_shell(folder: Path) -> Made:
    theta_sides, phi_sides, theta, phi = shell()
    south, _ = on_shell(theta_sides, phi)
    _, east = on_shell(theta, phi_sides)
    ds = xr.Dataset(
        {"v_theta": (("theta_f", "phi"), south), "v_phi": (("theta", "phi_f"), east)},
        {"theta": theta, "phi": phi, "theta_f": theta_sides, "phi_f": phi_sides},
    )
    return {"ds": ds}, shell_truth(theta, phi, tolerance=AVERAGED)


@supported(
    KIND,
    "mesh, vectors along radius, angle and z",
    'flowtex.show(mesh, components="cylindrical")',
    'also two arrays, `u="u_r"`, `v="u_phi"`; around the z axis through the origin',
)
def cylindrical_mesh(folder: Path) -> Made:
    mesh = pv.ImageData(dimensions=(24, 19, 1), spacing=(0.1, 0.1, 1), origin=(-1.0, -0.9, 0.0))
    x, y, z = np.asarray(mesh.points).T
    radial, around = along_radius_and_angle(x, y)
    mesh.point_data["velocity"] = np.stack([radial, around, 0 * z], axis=-1)
    return {"mesh": mesh}, at_points(np.stack([x, y], axis=-1))


def speed_beside(angle: Any, **attrs: str) -> tuple[xr.Dataset, Truth]:
    """Return the speed on the Earth beside an angle in radians, under names without a meaning."""
    lon, lat = np.linspace(0.0, 40.0, 21), np.linspace(-20.0, 20.0, 15)
    east, north = wind(*np.meshgrid(lon, lat))
    dims = ("lat", "lon")
    speed = (dims, np.hypot(east, north), {"units": "m/s"})
    ds = xr.Dataset(
        {"ff": speed, "dd": (dims, angle(east, north), attrs)}, {"lon": lon, "lat": lat}
    )
    return ds, on_earth(lon, lat)


SPEED = 'flowtex.show(ds, vectors="ff", direction="dd")'


@supported(
    KIND,
    "speed and direction in degrees, as of stations and scatterometers",
    SPEED,
    '"from" in a name or an attribute: where it comes from, clockwise from north',
)
def speed_and_direction_from(folder: Path) -> Made:
    attrs = {"units": "degree", "long_name": "wind direction (from)"}
    ds, truth = speed_beside(lambda u, v: np.degrees(np.arctan2(-u, -v)) % 360, **attrs)
    return {"ds": ds}, truth


@supported(
    KIND,
    "speed and direction of a current or of waves",
    SPEED,
    '"to" or "towards": where it goes, clockwise from north; also in radians',
)
def speed_and_direction_to(folder: Path) -> Made:
    attrs = {"units": "rad", "long_name": "direction towards which the current goes"}
    ds, truth = speed_beside(lambda u, v: np.arctan2(u, v), **attrs)
    return {"ds": ds}, truth


@supported(
    KIND,
    "magnitude and angle",
    SPEED,
    '"counterclockwise", "mathematical" or "from x", or the name `angle`: from x, or from east',
)
def magnitude_and_angle(folder: Path) -> Made:
    attrs = {"units": "degree", "comment": "counter-clockwise from east"}
    ds, truth = speed_beside(lambda u, v: np.degrees(np.arctan2(v, u)), **attrs)
    return {"ds": ds}, truth
