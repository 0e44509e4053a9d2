"""Forms of models on triangles, and of points, without or with a convention."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy
import xarray as xr
from form_table import form, variants
from known_flow import DEGREES, Truth, at_points, dates, in_plane, on_earth, plane, wind

from flowtex._util.array_types import Floats, Indices

#: Velocity of three levels, of which the last is at the surface.
RISING = np.array([0.2, 0.5, 1.0])


def scattered() -> tuple[Floats, Floats, Indices]:
    """Return longitude and latitude of 300 nodes around a hole, and triangles."""
    rng = np.random.default_rng(0)
    turn, radius = rng.uniform(0, 2 * np.pi, 300), np.sqrt(rng.uniform(0.2, 1, 300))
    lon, lat = 5 + 4 * radius * np.cos(turn), 45 + 4 * radius * np.sin(turn)
    triangles = scipy.spatial.Delaunay(np.stack([lon, lat], axis=-1)).simplices
    middle = np.stack([lon[triangles].mean(1) - 5, lat[triangles].mean(1) - 45])
    return lon, lat, triangles[np.hypot(*middle) > 1.6]


def with_holes(triangles: Indices) -> str:
    """Return what the record says of as many triangles."""
    return f"{len(triangles):,} triangles"


@variants(["ele 1", "tri 1", "volumes 0", "nv_of_cells 0"], says=with_holes(scattered()[2]))
def faces_by_their_numbers(kind: str) -> Any:
    """FVCOM's forcing, WAVEWATCH III and ANUGA: corners without attributes, counted from 0 or 1."""
    name, first = kind.split()
    lon, lat, triangles = scattered()
    ds = xr.Dataset(
        {name: (("ne", "corner"), triangles.astype("i4") + int(first))},
        {"lon": ("node", lon, DEGREES["lon"]), "lat": ("node", lat, DEGREES["lat"])},
    )
    words = ("East-West", "North-South")
    for letter, values, word in zip("UV", wind(lon, lat), words, strict=True):
        attrs = {"units": "m s-1", "long_name": f"{word} wind component at 10m"}
        ds[f"{letter}wind"] = (("time", "node"), values[None], attrs)
    time = {"units": "days since 1978-01-01 00:00:00 GMT", "long_name": "wind time"}
    return ds.assign(wind_time=("time", [0.0], time)), on_earth(lon[None], lat[None], undated=True)


@form(error=r"the variables are .*xmomentum \(no unit\), ymomentum", never="x and y are named")
def momentum_beside_x_and_y() -> Any:
    """ANUGA: x and y are positions, and no velocity."""
    lon, lat, triangles = scattered()
    ds = xr.Dataset(
        {"volumes": (("face", "corner"), triangles), "x": ("node", lon), "y": ("node", lat)}
    )
    for axis, values in zip("xy", plane(lon, lat), strict=True):
        ds[f"{axis}momentum"] = (("time", "node"), values[None])
    return ds


def schism() -> tuple[list[xr.Dataset], Truth]:
    """Return three files of SCHISM: the mesh with other velocities, and one for each component."""
    lon, lat, triangles = scattered()
    name = "SCHISM_hgrid"
    corners = np.full((len(triangles), 4), -1, "i4")
    corners[:, :3] = triangles + 1
    topology = {"cf_role": "mesh_topology", "topology_dimension": 2}
    topology |= {"node_coordinates": f"{name}_node_x {name}_node_y"}
    topology["face_node_connectivity"] = f"{name}_face_nodes"
    node = f"n{name}_node"
    mesh = xr.Dataset(
        {
            name: ("one", [0], topology),
            f"{name}_node_x": (node, lon, {"units": "degree_E", "standard_name": "longitude"}),
            f"{name}_node_y": (node, lat, {"units": "degree_N", "standard_name": "latitude"}),
            f"{name}_face_nodes": (("faces", "four"), corners, {"start_index": 1}),
        }
    )
    files = [mesh]
    time = ("time", [3600.0], {"units": "seconds since 2023-12-31 23:00:00 +0000"})
    for axis, values in zip("XY", wind(lon, lat), strict=True):
        mesh[f"depthAverageVel{axis}"] = (("time", node), 0.3 * values[None])
        mesh[f"windSpeed{axis}"] = (("time", node), 9 * values[None])
        layers = (("time", node, "nSCHISM_vgrid_layers"), values[None, :, None] * RISING)
        files.append(xr.Dataset({f"horizontalVel{axis}": layers}, {"time": time}))
    files[0] = mesh.assign_coords(time=time)
    return files, on_earth(lon[None], lat[None])


@form(says="other pairs: depthAverageVelX,depthAverageVelY; windSpeedX,windSpeedY")
def mesh_and_components_in_three_files() -> Any:
    return schism()


@form(error=r"horizontalVelX.*has no positions.*Open the file that has them together")
def components_without_the_file_of_the_mesh() -> Any:
    files, _ = schism()
    return files[1:]


@form()
def cells_of_mixed_shapes() -> Any:
    """SUNTANS: triangles and quadrangles among eight corners, and text for a number."""
    x, y = (a.ravel() for a in np.meshgrid(np.linspace(0, 9, 10), np.linspace(0, 5, 6)))
    number = np.arange(60).reshape(6, 10)
    sides = (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1])
    rows = [list(row) for row in np.stack(sides, axis=-1).reshape(-1, 4)]
    split = [part for a, b, c, d in rows[:9] for part in ([a, b, c], [a, c, d])]
    cells = np.full((len(split + rows[9:]), 8), -999999, "i4")
    for row, corners in zip(cells, split + rows[9:], strict=True):
        row[: len(corners)] = corners
    topology = {"cf_role": "mesh_topology", "topology_dimension": "2"}
    topology |= {"node_coordinates": "xp yp", "face_node_connectivity": "cells"}
    ones = np.ones((1, 3, len(cells))) * np.array([1.0, 0.3, 0.2])[:, None]
    attrs = {"mesh": "suntans_mesh", "location": "face", "units": "m s-1"}
    ds = xr.Dataset(
        {
            "suntans_mesh": ((), 0, topology),
            "cells": (("Nc", "numsides"), cells, {"cf_role": "face_node_connectivity"}),
            "uc": (("time", "Nk", "Nc"), ones, attrs | {"long_name": "Eastward velocity"}),
            "vc": (("time", "Nk", "Nc"), 2 * ones, attrs | {"long_name": "Northward velocity"}),
        },
        {
            "xp": ("Np", x, {"standard_name": "Easting"}),
            "yp": ("Np", y, {"standard_name": "Northing"}),
            "z_r": ("Nk", [0.5, 1.5, 2.5], {"standard_name": "ocean_z_coordinate", "units": "m"}),
            "time": dates([0.0]),
        },
    )

    def uniform(x: Any, _y: Any, _time: Any = 0.0) -> tuple[Floats, Floats]:
        return np.ones(np.shape(x)), 2 * np.ones(np.shape(x))

    return ds, at_points(np.stack([x, y], -1), flow=uniform, speed_unit="m/s", undated=True)


@form()
def centres_of_cells_in_radians() -> Any:
    """MPAS by the new names of Omega: LonCell and velocityZonal."""
    lon, lat, _ = scattered()
    words = ("eastward", "northward")
    ds = xr.Dataset()
    for name, values, word in zip(("Zonal", "Meridional"), wind(lon, lat), words, strict=True):
        attrs = {"units": "m s^{-1}", "long_name": f"component in the {word} direction"}
        levels = values[None, :, None] * np.array([1.0, 0.5])
        ds[f"velocity{name}"] = (("time", "NCells", "NVertLayers"), levels, attrs)
    for name, values in (("LonCell", lon), ("LatCell", lat)):
        ds[name] = ("NCells", np.radians(values), {"units": "radians"})
    return ds, on_earth(lon[None], lat[None], undated=True)


@form(error=r"x_wind, y_wind .*; x_sea_water_velocity, y_sea_water_velocity .*Name one")
def wind_and_current_at_particles() -> Any:
    """OpenDrift: the standard names of the current are not those of CF."""
    lon, lat, _ = scattered()
    dims = ("trajectory", "time")
    ds = xr.Dataset(attrs={"featureType": "trajectory"})
    for name, values in (("lon", lon), ("lat", lat)):
        moved = np.stack([values, values + 0.01], axis=1)
        ds[name] = (dims, moved, DEGREES[name])
    for axis, values in zip("xy", wind(lon, lat), strict=True):
        for word, share in (("wind", 5.0), ("sea_water_velocity", 1.0)):
            name = f"{axis}_{word}"
            both = np.stack([share * values] * 2, axis=1)
            ds[name] = (dims, both, {"units": "m/s", "standard_name": name})
    identity = ("trajectory", np.arange(len(lon)), {"cf_role": "trajectory_id"})
    return ds.assign_coords(trajectory=identity, time=dates([0.0, 1.0]))


@variants(["ux uy", "vx vy"])
def components_without_units_by_two_letters(names: str) -> Any:
    """Nek5000 by pymech: ux and uy beside the mesh in three dimensions."""
    x, y = np.linspace(0, 3, 13), np.linspace(0, 2, 9)
    ds = xr.Dataset(coords={"x": x, "y": y, "z": [0.0, 1.0]})
    factor = np.array([1.0, 0.5])[:, None, None]
    for name, values in zip(names.split(), plane(*np.meshgrid(x, y)), strict=True):
        ds[name] = (("time", "z", "y", "x"), (values * factor)[None])
    for name, values in zip(("xmesh", "ymesh"), np.meshgrid(x, y), strict=True):
        ds[name] = (("z", "y", "x"), np.broadcast_to(values, (2, *values.shape)))
    return ds.isel(z=[0]), in_plane(x, y, undated=True)
