"""Streaks beside sharp edges are those of the same face without the other one."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import pyvista as pv
from triangle_meshes import polygon, tube

import flowtex
from flowtex._util.array_types import Floats

pytestmark = [
    pytest.mark.usefixtures("opengl"),
    pytest.mark.filterwarnings("ignore::flowtex.errors.Notice"),
]
SIZE = (150, 110)


def graded(rows: int) -> Floats:
    """Return places along the tube, closer to each other at its ends."""
    share = np.linspace(-1, 1, rows + 1)
    return np.asarray(1.5 * np.sin(0.5 * np.pi * share))


TUBES = {
    "long triangles": (polygon(60, 4), np.linspace(-1.5, 1.5, 5)),
    "one row": (polygon(40, 2), np.linspace(-1.5, 1.5, 2)),
    "graded": (polygon(60, 1), graded(24)),
    "box": (polygon(4, 12), np.linspace(-1.5, 1.5, 5)),
    "wedge": (polygon(3, 8), graded(12)),
}


def side_of(mesh: Any, distance: float) -> Floats:
    """Return the brightness of the middle of the side and of its upstream end."""
    view = [(-1.3, -0.5 - distance, 0), (-1.3, 0, 0), (0, 0, 1)]
    options: Any = {"size": SIZE, "grain": 1.5, "camera": view, "scalars": False, "lighting": False}
    picture = flowtex.render(mesh, **options)[..., :3].mean(axis=-1)
    pixel = np.tan(np.radians(15)) * distance / (SIZE[1] / 2)
    middle_x, middle_y = SIZE[0] // 2, SIZE[1] // 2
    left = middle_x - int(0.15 / pixel)
    right = middle_x + int(0.35 / pixel)
    height = int(0.2 / pixel)
    rows = slice(max(middle_y - height, 0), middle_y + height)
    return np.asarray(picture[rows, max(left, 0) : right])


def likeness(name: str, distance: float) -> float:
    """Return the correlation between pictures of a tube with and without ends."""
    sides = []
    for closed in (True, False):
        points, triangles = tube(*TUBES[name], closed=closed)
        mesh: Any = pv.PolyData.from_regular_faces(points, triangles.astype(int))
        mesh["U"] = np.column_stack([np.ones(len(points)), -points[:, 2], points[:, 1]])
        sides.append(side_of(mesh, distance).ravel())
    return float(np.asarray(np.corrcoef(np.stack(sides)))[0, 1])


@pytest.mark.parametrize(
    ("name", "distance"),
    [
        *[("long triangles", 1.2), ("long triangles", 2.5), ("long triangles", 5.0)],
        *[("box", 1.2), ("box", 2.5), ("one row", 1.2), ("graded", 1.2), ("graded", 5.0)],
        ("wedge", 1.2),
    ],
)
def test_streaks_do_not_depend_on_the_face_beyond_an_edge(name: str, distance: float) -> None:
    assert likeness(name, distance) > 0.96


def cylinder(divisions: int, ellipse: float) -> Any:
    """Return a cylinder with a flow around its axis and along it, and so around its discs."""
    mesh: Any = pv.Cylinder(resolution=60, height=3).triangulate()
    if divisions:
        mesh = mesh.subdivide(divisions)
    mesh.points = np.asarray(mesh.points, float) * [1.0, ellipse, 1.0]
    around = [-ellipse * mesh.points[:, 2], mesh.points[:, 1] / ellipse]
    mesh["U"] = np.column_stack([np.ones(mesh.n_points), *around])
    return mesh


def discs_of(mesh: Any) -> Any:
    """Return both discs of a cylinder, without the side."""
    is_disc = (np.abs(mesh.points[mesh.regular_faces, 0]) > 1.499).all(axis=1)
    return mesh.extract_cells(is_disc).extract_surface(algorithm=None)


def disc_in(mesh: Any, distance: float, ellipse: float) -> Floats:
    """Return the brightness of the outer part of the disc at x = -1.5."""
    view = [(-1.5 - distance, 0, 0), (-1.5, 0, 0), (0, 0, 1)]
    options: Any = {
        "size": (160, 160),
        "grain": 1.5,
        "camera": view,
        "scalars": False,
        "lighting": False,
    }
    picture = flowtex.render(mesh, **options)[..., :3].mean(axis=-1)
    place = (np.arange(160) - 79.5) * np.tan(np.radians(15)) * distance / 80
    radius = np.hypot(place[:, None], place / ellipse)
    return np.asarray(picture[(radius > 0.3) & (radius < 0.49)])


@pytest.mark.parametrize(
    ("divisions", "ellipse", "distance", "least"),
    # Beside the rim the local mean has pixels of the side, which the disc alone lacks.
    [(0, 1.0, 3.0, 0.99), (2, 1.0, 1.5, 0.98), (2, 1.5, 3.0, 0.94)],
)
def test_flow_around_a_disc_stays_in_it(
    divisions: int, ellipse: float, distance: float, least: float
) -> None:
    mesh = cylinder(divisions, ellipse)
    pictures = [disc_in(part, distance, ellipse) for part in (mesh, discs_of(mesh))]
    assert np.asarray(np.corrcoef(np.stack(pictures)))[0, 1] > least
