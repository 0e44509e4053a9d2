"""Pictures of surfaces of triangles: the flow decides what they show, not the mesh."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from measures import grey, streaks
from scipy.ndimage import binary_erosion
from triangle_meshes import random_plane, sphere

import flowtex
from flowtex._util.array_types import Floats

pytestmark = pytest.mark.usefixtures("opengl")

SIZE = (360, 300)


def wave(points: Floats) -> Floats:
    """A Rossby-Haurwitz wave of number 4: what its stream function gives along the sphere."""
    x, y, z = points.T
    # psi = -z + (x^2 + y^2)^2 z cos(4 lon), of which cos(4 lon) r^4 is a polynomial.
    part = x**4 - 6 * x * x * y * y + y**4
    slope = np.stack(
        [z * (4 * x**3 - 12 * x * y * y), z * (4 * y**3 - 12 * x * x * y), part - 1], axis=-1
    )
    return np.asarray(np.cross(points, slope))


def bend(x: Floats, y: Floats) -> Floats:
    return np.stack([1 + 0.5 * np.sin(3 * y), np.cos(2 * x)], axis=-1)


def spheres() -> dict[str, tuple[Floats, Any]]:
    lon, lat = np.meshgrid(np.linspace(0, 2 * np.pi, 121), np.linspace(-np.pi / 2, np.pi / 2, 61))
    grid = np.stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)], axis=-1)
    number = np.arange(lon.size).reshape(lon.shape)
    a, b = number[:-1, :-1].ravel(), number[:-1, 1:].ravel()
    c, d = number[1:, 1:].ravel(), number[1:, :-1].ravel()
    cut = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)])
    return {"icosphere": sphere(4), "latitudes": (grid.reshape(-1, 3), cut), "grid": (grid, None)}


def picture(points: Floats, triangles: Any) -> Floats:
    if triangles is None:
        velocity = wave(points.reshape(-1, 3)).reshape(points.shape)
        field = flowtex.FlowField.from_arrays(points, velocity)
    else:
        with np.errstate(all="ignore"):
            field = flowtex.FlowField.from_triangles(points, triangles, wave(points))
    return grey(flowtex.render(field, size=SIZE, scalars=False, lighting=False))


@pytest.mark.filterwarnings("ignore:triangles are left out")
def test_a_flow_on_a_sphere_looks_alike_on_every_mesh() -> None:
    pictures = {name: picture(*mesh) for name, mesh in spheres().items()}
    seen = np.logical_and.reduce([image < 254 for image in pictures.values()])
    inside = binary_erosion(binary_erosion(seen, iterations=2) | seen, iterations=25)
    for name in ("icosphere", "latitudes"):
        one, other = pictures[name][inside], pictures["grid"][inside]
        assert np.corrcoef(one, other)[0, 1] > 0.93, name


def test_a_graded_mesh_shows_what_a_grid_of_as_many_nodes_does() -> None:
    points, triangles = random_plane(np.random.default_rng(5), 8000, grading=1000)
    side = int(np.sqrt(len(points)))
    even = np.stack(np.meshgrid(np.linspace(0, 1, side), np.linspace(0, 1, side)), axis=-1)
    fields = [
        flowtex.FlowField.from_triangles(points[:, :2], triangles, bend(*points[:, :2].T)),
        flowtex.FlowField.from_arrays(even, bend(*np.moveaxis(even, -1, 0))),
    ]
    focus = (0.31, 0.57)
    for zoom in (1.0, 16.0, 1024.0):
        pixel = 1 / 0.92 / zoom / SIZE[1]
        px, py = np.meshgrid(
            focus[0] + (np.arange(SIZE[0]) + 0.5 - SIZE[0] / 2) * pixel,
            focus[1] - (np.arange(SIZE[1]) + 0.5 - SIZE[1] / 2) * pixel,
        )
        far = 14 * pixel
        mask = (px > far) & (px < 1 - far) & (py > far) & (py < 1 - far)
        mask[:14], mask[-14:], mask[:, :14], mask[:, -14:] = False, False, False, False
        u, v = np.moveaxis(bend(px, py), -1, 0)
        one, other = (
            streaks(
                flowtex.render(field, size=SIZE, zoom=zoom, focus=focus, scalars=False), u, v, mask
            )
            for field in fields
        )
        assert one["angle"] < 1.1 * other["angle"] + 0.05
        assert one["coherence"] > 0.9 * other["coherence"]
