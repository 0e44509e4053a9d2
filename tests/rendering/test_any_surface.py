"""Pictures of surfaces of triangles: the flow decides what they show, not the mesh."""

from __future__ import annotations

from functools import cache
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


def rotation(points: Floats) -> Floats:
    return np.asarray(np.cross([0.3, 0.2, 1.0], points))


def wave(points: Floats) -> Floats:
    """A Rossby-Haurwitz wave of number 4: what its stream function gives along the sphere."""
    x, y, z = points.T
    # psi = -z + (x^2 + y^2)^2 z cos(4 lon), of which cos(4 lon) r^4 is a polynomial.
    part = x**4 - 6 * x * x * y * y + y**4
    slope = np.stack(
        [z * (4 * x**3 - 12 * x * y * y), z * (4 * y**3 - 12 * x * x * y), part - 1], axis=-1
    )
    return np.asarray(np.cross(points, slope))


@cache
def spheres() -> dict[str, tuple[Floats, Any]]:
    lon, lat = np.meshgrid(np.linspace(0, 2 * np.pi, 181), np.linspace(-np.pi / 2, np.pi / 2, 91))
    grid = np.stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)], axis=-1)
    number = np.arange(lon.size).reshape(lon.shape)
    a, b, c, d = (
        number[rows, columns].ravel()
        for rows, columns in (
            (slice(None, -1), slice(None, -1)),
            (slice(None, -1), slice(1, None)),
            (slice(1, None), slice(1, None)),
            (slice(1, None), slice(None, -1)),
        )
    )
    cut = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)])
    return {"icosphere": sphere(5), "latitudes": (grid.reshape(-1, 3), cut), "grid": (grid, None)}


def picture(points: Floats, triangles: Any, flow: Any) -> Floats:
    if triangles is None:
        velocity = flow(points.reshape(-1, 3)).reshape(points.shape)
        field = flowtex.FlowField.from_arrays(points, velocity)
    else:
        with np.errstate(all="ignore"):
            field = flowtex.FlowField.from_triangles(points, triangles, flow(points))
    return grey(flowtex.render(field, size=SIZE, scalars=False, lighting=False))


@pytest.mark.filterwarnings("ignore:triangles are left out")
@pytest.mark.parametrize("flow", [rotation, wave])
def test_a_flow_on_a_sphere_looks_alike_on_every_mesh(flow: Any) -> None:
    pictures = {name: picture(*mesh, flow) for name, mesh in spheres().items()}
    seen = np.logical_and.reduce([image < 254 for image in pictures.values()])
    inside = binary_erosion(binary_erosion(seen, iterations=2) | seen, iterations=25)
    for name in ("icosphere", "latitudes"):
        one, other = pictures[name][inside], pictures["grid"][inside]
        assert np.corrcoef(one, other)[0, 1] > 0.93, name


@pytest.mark.parametrize("zoom", [1.0, 16.0, 1024.0])
def test_a_graded_mesh_shows_what_a_grid_of_as_many_nodes_does(zoom: float) -> None:
    points, triangles = random_plane(np.random.default_rng(5), 8000, grading=1000)
    side = int(np.sqrt(len(points)))
    x, y = np.meshgrid(np.linspace(0, 1, side), np.linspace(0, 1, side))
    even = np.stack([x, y], axis=-1)
    # Where the mesh is coarse and where it is fine, with the same nodes to the eye.
    found = {}
    for name in ("grid", "triangles"):
        where = even if name == "grid" else points[:, :2]
        u, v = 1 + 0.5 * np.sin(3 * where[..., 1]), np.cos(2 * where[..., 0])
        velocity = np.stack([u, v], axis=-1)
        if name == "grid":
            field = flowtex.FlowField.from_arrays(where, velocity)
        else:
            field = flowtex.FlowField.from_triangles(where, triangles, velocity)
        focus = (0.31, 0.57)
        image = flowtex.render(field, size=SIZE, zoom=zoom, focus=focus, scalars=False)
        pixel = 1 / 0.92 / zoom / SIZE[1]
        px, py = np.meshgrid(
            focus[0] + (np.arange(SIZE[0]) + 0.5 - SIZE[0] / 2) * pixel,
            focus[1] - (np.arange(SIZE[1]) + 0.5 - SIZE[1] / 2) * pixel,
        )
        u, v = 1 + 0.5 * np.sin(3 * py), np.cos(2 * px)
        far = 14 * pixel
        mask = (px > far) & (px < 1 - far) & (py > far) & (py < 1 - far)
        mask[:14], mask[-14:], mask[:, :14], mask[:, -14:] = False, False, False, False
        found[name] = streaks(image, u, v, mask)
    one, other = found["triangles"], found["grid"]
    assert one["angle"] < 1.1 * other["angle"] + 0.05
    assert one["coherence"] > 0.9 * other["coherence"]
