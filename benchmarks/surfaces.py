"""Surfaces for the benchmarks, computed for a number of nodes, and their flow as a camera sees it.

Each is a PyVista mesh whose ``velocity`` is smooth and tangent to the surface.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import pyvista as pv
from numpy.typing import NDArray
from scenes import gyre, gyre_field
from triangle_meshes import random_plane as random_triangles

from flowtex.examples import airfoil_field, to_grid
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu.raster import cover

Floats = NDArray[np.float64]

#: Speed, as a share of the greatest, below which the direction of the flow counts as unknown.
SLOW = 0.02
#: How much longer sides are at one end of the graded plane.
GRADING = 1000.0
#: Pixels beside an edge of what is seen that are not judged.
BORDER = 14
#: Exponent of the superellipsoids of the airplane: 1 for ellipsoids, less for boxes.
BOXED = 0.85
#: Half axes of these, their middles, and how far their tips are swept back.
PARTS = (
    ((3.0, 0.32, 0.32), (0.0, 0.0, 0.0), 0.0),  # fuselage
    ((0.5, 2.6, 0.06), (0.0, 0.0, -0.1), 0.9),  # wings
    ((0.25, 0.9, 0.04), (2.5, 0.0, 0.1), 0.3),  # tailplane
    ((0.35, 0.04, 0.5), (2.5, 0.0, 0.6), 0.2),  # fin
    ((0.45, 0.15, 0.15), (-0.2, 0.9, -0.3), 0.0),  # engines
    ((0.45, 0.15, 0.15), (-0.2, -0.9, -0.3), 0.0),
)


#: Middles and radii of the holes of a plane.
HOLES = ((0.5, 0.3, 0.12), (1.4, 0.6, 0.2), (1.0, 0.8, 0.07), (1.75, 0.2, 0.05), (0.3, 0.75, 0.09))


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


# --- grids -----------------------------------------------------------------------------------


def tangent(points: Floats, normal: Floats) -> Floats:
    """Project a flow in space to a surface."""
    points, normal = (np.asarray(a, float) for a in (points, normal))
    flow = np.cross([0.3, 0.2, 1.0], points) + np.sin(3 * points[..., [1, 2, 0]])
    normal = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    return np.asarray(flow - np.sum(flow * normal, axis=-1, keepdims=True) * normal)


def shape(nodes: int, ratio: float) -> tuple[int, int]:
    """Return rows and columns of about so many nodes, with so many columns for each row."""
    return round(np.sqrt(nodes / ratio)), round(np.sqrt(nodes * ratio))


def parameters(nodes: int, ratio: float, down: float, across: float) -> list[Floats]:
    """Return even parameters (J, I) of a grid, from 0 to ``across`` and to ``down``."""
    rows, columns = shape(nodes, ratio)
    return list(np.meshgrid(np.linspace(0, across, columns), np.linspace(0, down, rows)))


def grid(*points: Floats, velocity: Floats | None = None) -> Any:
    """Return a mesh of coordinates (J, I), with a velocity in space that is made tangent."""
    place = np.stack(points, axis=-1)
    if velocity is None:
        along = [np.gradient(place, axis=axis, edge_order=2) for axis in (0, 1)]
        velocity = tangent(place, np.cross(*along))
    mesh = pv.StructuredGrid()
    mesh.points, mesh.dimensions = place.reshape(-1, 3), (*place.shape[1::-1], 1)
    mesh["velocity"] = velocity.reshape(-1, 3)
    return mesh


def plane(nodes: int) -> Any:
    """Return the double gyre on an even grid."""
    x, y = parameters(nodes, 2, 1, 2)
    return grid(x, y, 0 * x, velocity=np.stack([*gyre(x, y), 0 * x], axis=-1))


def gyre_grid(nodes: int, *, crooked: bool = False) -> Any:
    """Return the double gyre on a sheared, stretched grid, or on a crooked one."""
    rows, columns = shape(nodes, 2)
    return to_grid(gyre_field(columns, rows, crooked=crooked))


def holed_grid(nodes: int) -> Any:
    """Return the double gyre on a crooked grid with holes, whose nodes and cells are hidden."""
    mesh = gyre_grid(nodes, crooked=True)
    x, y, _ = np.asarray(mesh.points).T
    is_hidden = np.zeros(mesh.n_points, dtype=bool)
    for middle_x, middle_y, radius in HOLES:
        away_x = x - middle_x
        away_y = y - middle_y
        rim = radius * (1 + 0.2 * np.sin(7 * np.arctan2(away_y, away_x)))
        is_hidden |= np.hypot(away_x, away_y) < rim
    mesh.hide_points(is_hidden)
    columns, rows, _ = mesh.dimensions
    nodes_of_cells = is_hidden.reshape(rows, columns)
    sides = nodes_of_cells[:-1] | nodes_of_cells[1:]
    mesh.hide_cells(np.flatnonzero(sides[:, :-1] | sides[:, 1:]), inplace=True)
    return mesh


def o_grid(nodes: int) -> Any:
    """Return the flow around an airfoil, whose innermost cells are thin."""
    return to_grid(airfoil_field(shape(nodes, 2)))


def wave(points: Floats) -> Floats:
    """Velocity of a Rossby-Haurwitz wave of number 4 on a unit sphere around the origin."""
    x, y, z = np.moveaxis(np.asarray(points, float), -1, 0)
    lon, lat = np.arctan2(y, x), np.arcsin(np.clip(z, -1, 1))
    c, s = np.cos(lat), np.sin(lat)
    east = c + c**3 * (4 * s**2 - c**2) * np.cos(4 * lon)
    north = -4 * c**3 * s * np.sin(4 * lon)
    to_east = np.stack([-np.sin(lon), np.cos(lon), 0 * lon], -1)
    to_north = np.stack([-s * np.cos(lon), -s * np.sin(lon), c], -1)
    return np.asarray(east[..., None] * to_east + north[..., None] * to_north)


def sphere(nodes: int) -> Any:
    """Return the wave on a grid of meridians and parallels, from pole to pole."""
    lon, lat = parameters(nodes, 2, np.pi, 2 * np.pi)
    points = -np.sin(lat) * np.cos(lon), -np.sin(lat) * np.sin(lon), -np.cos(lat)
    return grid(*points, velocity=wave(np.stack(points, -1)))


def torus(nodes: int) -> Any:
    """Return a flow on a torus, joined along both parameters."""
    a, b = parameters(nodes, 2, 2 * np.pi, 2 * np.pi)
    return grid((2 + np.cos(b)) * np.cos(a), (2 + np.cos(b)) * np.sin(a), np.sin(b))


def height_field(nodes: int) -> Any:
    """Return a flow over hills."""
    x, y = parameters(nodes, 1, 4, 4)
    return grid(x - 2, y - 2, np.sin(2 * x) * np.cos(2 * y) / 2)


def wing(nodes: int) -> Any:
    """Return a flow around a swept and tapered wing, open at its root and tip."""
    a, span = parameters(nodes, 1, 1, 2 * np.pi)
    chord = 1 - 0.6 * span
    x = chord * (1 + np.cos(a)) / 2 + 1.2 * span
    return grid(x, 2.5 * span, chord * np.sin(a) * (6 - 5 * np.cos(a)) / 100 + 0.2 * span)


# --- triangles -------------------------------------------------------------------------------


def triangulated(mesh: Any) -> Any:
    """Return the triangles of a mesh, with its velocity or a flow that is made tangent."""
    surface = mesh.extract_surface(algorithm="dataset_surface").triangulate()
    if "velocity" not in surface.point_data:
        surface["velocity"] = tangent(surface.points, surface.point_normals)
    return surface


def thin_triangles(nodes: int) -> Any:
    """Return the flow around an airfoil on triangles a thousand times longer than thick."""
    return triangulated(o_grid(nodes))


def graded_plane(nodes: int) -> Any:
    """Return the double gyre on random nodes whose sides grow a thousandfold from the left."""
    points, triangles = random_triangles(np.random.default_rng(0), nodes, grading=GRADING)
    points[:, 0] *= 2
    x, y, z = points.T
    mesh = pv.PolyData.from_regular_faces(points, triangles)
    mesh["velocity"] = np.stack([*gyre(x, y), z], axis=-1)
    return mesh


def ball(nodes: int) -> Any:
    """Return the wave on an icosahedron whose sides are halved again and again."""
    mesh = pv.Icosphere(nsub=round(np.log(nodes / 10) / np.log(4)))
    mesh["velocity"] = wave(mesh.points)
    return mesh


def airplane(nodes: int) -> Any:
    """Return a flow over the joined superellipsoids of an airplane."""
    parts = []
    for axes, middle, sweep in PARTS:
        side = round(np.sqrt(nodes / len(PARTS)))
        longest = np.eye(3)[np.argmax(axes)]
        part = pv.Sphere(radius=1, direction=longest, theta_resolution=side, phi_resolution=side)
        unit = np.sign(part.points) * np.abs(part.points) ** BOXED
        part.points = unit * axes + middle
        part.points[:, 0] += sweep * (unit @ longest) ** 2
        part.clear_data()
        parts.append(part)
    return triangulated(parts[0].append_polydata(*parts[1:]))


def _samples(side: int) -> tuple[Any, Floats]:
    """Return the cube from -1 to 1 with so many samples along each side, and these."""
    volume = pv.ImageData(dimensions=(side,) * 3, spacing=(2 / (side - 1),) * 3, origin=(-1.0,) * 3)
    return volume, np.asarray(volume.points, np.float32).T


def isosurface(nodes: int) -> Any:
    """Return a flow on an isosurface in folds."""
    volume, points = _samples(round(np.sqrt(nodes / 7.3)))
    a, b, c = 5 * points
    volume["height"] = np.sin(a) * np.cos(b) + np.sin(b) * np.cos(c) + np.sin(c) * np.cos(a)
    return triangulated(volume.contour([0.3], scalars="height"))


def nested(nodes: int) -> Any:
    """Return a flow on twelve isosurfaces, each around the one before."""
    volume, (x, y, z) = _samples(round(np.sqrt(nodes / 27)))
    waves = np.sin(5 * x) * np.cos(5 * y) + np.sin(5 * y) * np.cos(5 * z)
    volume["height"] = x**2 + y**2 + z**2 + 0.1 * waves
    return triangulated(volume.contour(np.linspace(0.1, 0.9, 12), scalars="height"))


def tetrahedra(nodes: int) -> Any:
    """Return a flow on a slice through irregular tetrahedra."""
    side = round(np.sqrt(nodes / 3))
    cell = 2 / (side - 1)
    layer = pv.ImageData(
        dimensions=(side, side, 2), spacing=(cell,) * 3, origin=(-1.0, -1.0, -cell / 2)
    ).to_tetrahedra()
    layer.clear_data()
    layer.points += np.random.default_rng(0).uniform(-cell / 4, cell / 4, layer.points.shape)
    return triangulated(layer.slice("z", origin=(0, 0, 0)).rotate_vector((1, 2, 0), 40))


#: Nodes of grids, and of triangles, of which a surface has twice as many.
GRID_NODES = (10_000, 100_000, 1_000_000)
TRIANGLE_NODES = (20_000, 200_000, 500_000)
LARGE_GRID_NODES = (1_000_000, 4_000_000)
LARGE_TRIANGLE_NODES = (650_000, 2_600_000)
GRIDS: dict[str, Callable[[int], Any]] = {
    "plane": plane,
    "sheared plane": gyre_grid,
    "crooked plane": partial(gyre_grid, crooked=True),
    "plane with holes": holed_grid,
    "O-grid": o_grid,
    "height field": height_field,
    "wing": wing,
    "torus": torus,
    "sphere": sphere,
}
TRIANGLES: dict[str, Callable[[int], Any]] = {
    "graded plane": graded_plane,
    "thin triangles": thin_triangles,
    "slice of tetrahedra": tetrahedra,
    "ball": ball,
    "airplane": airplane,
    "isosurface": isosurface,
    "12 isosurfaces": nested,
}
