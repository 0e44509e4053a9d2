"""Surfaces of triangles for the benchmarks, and their flow as a camera sees it.

What is computed is always there; files are looked for in the folders that ``FLOWTEX_DATA`` and
``FLOWTEX_CFD`` name. The latter has data sets that PyVista downloads: ``cylinder_Re35.case``,
``disk_out_ref.ex2`` and ``multi.cgns``.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import flowtex
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu.raster import cover

Floats = NDArray[np.float64]

#: Speed, as a share of the greatest, below which the direction of the flow counts as unknown.
SLOW = 0.02
#: Nodes of computed surfaces, and how much longer sides are at one end of the graded plane.
NODES, GRADING = 10_000, 1000.0
#: Pixels beside an edge of what is seen that are not judged.
BORDER = 14


class SurfaceView(NamedTuple):
    """What a camera sees: places, the flow on the screen to the right and up, what to judge."""

    place: Floats
    u: Floats
    v: Floats
    mask: NDArray[np.bool_]


def surface_view(field: Any, camera: Camera, size: tuple[int, int]) -> SurfaceView:
    """Return what a camera sees of a field, (H, W, ...) each; places are NaN beside it."""
    from scipy.ndimage import binary_erosion

    surface = field.surface
    coverage = cover(surface, camera, size)
    points = surface.points.reshape(-1, 3)
    place = coverage.mix(points - surface.center)[0] + surface.center
    velocity = coverage.mix(field.velocity[0].reshape(-1, 3))[0]
    a, b, c = (points[coverage.corners[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    normal /= np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-300)
    velocity -= np.sum(velocity * normal, axis=-1, keepdims=True) * normal
    speed = np.linalg.norm(velocity, axis=-1, keepdims=True)
    ahead = place + 1e-5 * surface.extent * velocity / np.maximum(speed, 1e-300)
    aspect = size[0] / size[1]
    step = (camera.project(ahead, aspect) - camera.project(place, aspect)) * size
    shape = (size[1] * size[0],)
    seen, fast = np.zeros(shape, bool), np.zeros(shape, bool)
    seen[coverage.pixel] = True
    # What is seen at a grazing angle has no streaks that could be told.
    facing = np.abs(np.sum(normal * _ray(camera, place), axis=-1)) > 0.3
    fast[coverage.pixel] = (speed[:, 0] > SLOW * speed.max()) & facing
    whole = np.full((*shape, 5), np.nan)
    whole[coverage.pixel] = np.concatenate([place, step], axis=-1)
    whole = whole.reshape(size[1], size[0], 5)
    inside = binary_erosion(seen.reshape(size[::-1]), iterations=BORDER)
    mask = inside & fast.reshape(size[::-1])
    u, v = np.nan_to_num(whole[..., 3]), np.nan_to_num(whole[..., 4])
    return SurfaceView(whole[..., :3], u, v, mask)


def _ray(camera: Camera, place: Floats) -> Floats:
    ray = np.asarray(camera.eye[:3]) - camera.eye[3] * place
    return np.asarray(ray / np.linalg.norm(ray, axis=-1, keepdims=True))


def as_polydata(field: Any) -> Any:
    """Return PyVista's form of a field, with its vectors as ``velocity``."""
    import pyvista as pv

    mesh = pv.PolyData.from_regular_faces(field.points[0], field.triangles[field.surface.cells])
    mesh.point_data["velocity"] = field.velocity[0, 0]
    return mesh


def random_plane(nodes: int = NODES) -> Any:
    """Return the double gyre on random nodes whose sides grow a thousandfold from the left."""
    from scenes import gyre
    from triangle_meshes import random_plane as plane

    points, triangles = plane(np.random.default_rng(0), nodes, grading=GRADING)
    points[:, 0] *= 2
    velocity = np.stack(gyre(points[:, 0], points[:, 1]), axis=-1)
    return flowtex.FlowField.from_triangles(points, triangles, velocity, name="random plane")


def wave(points: Floats) -> Floats:
    """Velocity of a Rossby-Haurwitz wave of number 4 on a unit sphere around the origin."""
    lon, lat = np.arctan2(points[:, 1], points[:, 0]), np.arcsin(np.clip(points[:, 2], -1, 1))
    c, s = np.cos(lat), np.sin(lat)
    east = c + c**3 * (4 * s**2 - c**2) * np.cos(4 * lon)
    north = -4 * c**3 * s * np.sin(4 * lon)
    to_east = np.stack([-np.sin(lon), np.cos(lon), 0 * lon], -1)
    to_north = np.stack([-s * np.cos(lon), -s * np.sin(lon), c], -1)
    return np.asarray(east[:, None] * to_east + north[:, None] * to_north)


def sphere(subdivisions: int = 5) -> Any:
    """Return the wave on a sphere of triangles."""
    from triangle_meshes import sphere as mesh

    points, triangles = mesh(subdivisions)
    return flowtex.FlowField.from_triangles(points, triangles, wave(points), name="sphere")


def cube(cells: int = 40) -> Any:
    """Return a flow around a slanted axis on a cube."""
    from triangle_meshes import cube as mesh

    points, triangles = mesh(cells)
    velocity = np.cross([0.5, 0.3, 1.0], points)
    return flowtex.FlowField.from_triangles(points, triangles, velocity, name="cube")


def _file(variable: str, name: str) -> str:
    path = Path(os.environ.get(variable, "")) / name
    if not path.is_file():
        raise FileNotFoundError(path)
    return str(path)


def folded_contour(samples: int = 90) -> Any:
    """Return a contour that goes in folds through a volume in a swirl."""
    import pyvista as pv

    volume = pv.ImageData(
        dimensions=(samples,) * 3, spacing=(2 / (samples - 1),) * 3, origin=(-1.0,) * 3
    )
    points = np.asarray(volume.points, float)
    (x, y, z), (a, b, c) = points.T, 5 * points.T
    volume["height"] = np.sin(a) * np.cos(b) + np.sin(b) * np.cos(c) + np.sin(c) * np.cos(a)
    flow = [-y + 0.5 * np.sin(3 * z), x + 0.3 * np.cos(4 * y), 0.5 * np.sin(3 * x)]
    volume["velocity"] = np.stack(flow, axis=-1)
    mesh = volume.contour([0.3], scalars="height")
    points, velocity = np.asarray(mesh.points, float), np.asarray(mesh["velocity"])
    return flowtex.FlowField.from_triangles(
        points, mesh.regular_faces, velocity, name="folded contour"
    )


def boundary_layers() -> Any:
    """Return the flow around an airfoil on long and thin triangles."""
    from flowtex.examples import airfoil_field

    grid = airfoil_field((120, 241))
    rows, columns = grid.shape
    node = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = node[:-1, :-1], node[:-1, 1:], node[1:, 1:], node[1:, :-1]
    corners = [np.stack(part, axis=-1).reshape(-1, 3) for part in ((a, b, c), (a, c, d))]
    points, velocity = grid.points.reshape(-1, 3), grid.velocity[0].reshape(-1, 3)
    return flowtex.FlowField.from_triangles(
        points, np.concatenate(corners), velocity, name="boundary layers"
    )


def bay() -> Any:
    """Return the currents of an ocean model on triangles."""
    return flowtex.FlowField.from_file(_file("FLOWTEX_DATA", "fvcom_sfbofs.nc"))


def slanted_slice() -> Any:
    """Return a slanted cut through a volume."""
    return flowtex.FlowField.from_file(_file("FLOWTEX_DATA", "postxyz.bin"), slice="1,0.4,0.3")


def isosurface() -> Any:
    """Return a surface of constant energy in a volume."""
    return flowtex.FlowField.from_file(
        _file("FLOWTEX_DATA", "postxyz.bin"), contour="StagnationEnergy=1.5"
    )


def cylinder() -> Any:
    """Return the flow around a cylinder on an unstructured mesh."""
    return flowtex.FlowField.from_file(_file("FLOWTEX_CFD", "cylinder_Re35.case"))


def disk() -> Any:
    """Return a cut through the flow above a rotating disk."""
    return flowtex.FlowField.from_file(_file("FLOWTEX_CFD", "disk_out_ref.ex2"), slice="y=0")


def airfoil() -> Any:
    """Return the flow around an airfoil of several elements."""
    return flowtex.FlowField.from_file(_file("FLOWTEX_CFD", "multi.cgns"), slice="y")


SURFACES: dict[str, Callable[[], Any]] = {
    "random plane": random_plane,
    "sphere": sphere,
    "cube": cube,
    "folded contour": folded_contour,
    "boundary layers": boundary_layers,
    "bay": bay,
    "slanted slice": slanted_slice,
    "isosurface": isosurface,
    "cylinder": cylinder,
    "disk": disk,
    "airfoil": airfoil,
    "20,000 triangles": lambda: random_plane(10_000),
    "500,000 triangles": lambda: random_plane(250_000),
    "1,000,000 triangles": lambda: random_plane(500_000),
}
