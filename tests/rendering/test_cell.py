"""Paths beside critical points: exact solutions, and where the slices are left alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
import pyvista as pv
from flows import across, gyre, lines, scattered_gyre, swinging
from matrix import SIZE, straight
from scipy.linalg import expm
from triangle_meshes import polygon, random_plane, soup

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.field.locate import locate
from flowtex.rendering.cpu.render import render
from flowtex.rendering.uniforms import ViewState, is_near
from flowtex.scene.probe import probe
from flowtex.scene.scene import Scene
from flowtex.settings import Settings

#: In cells of a grid of 40 by 40 nodes; neither on a node nor in the middle of a cell.
POINT = np.array([19.87, 19.29])
CELL = 1 / 39
FLOWS = {
    "saddle": [[1.0, 0.3], [0.2, -1.0]],
    "centre": [[0.1, -1.0], [1.3, -0.1]],
    "node": [[-1.0, 0.3], [0.1, -0.6]],
    "focus": [[-0.4, -1.0], [1.0, -0.3]],
}


def linear(name: str) -> FlowField:
    y, x = np.mgrid[0:1:40j, 0:1:40j]
    points = np.stack([x, y], -1)
    return FlowField.from_arrays(points, (points - CELL * POINT) @ np.transpose(FLOWS[name]))


def scattered(name: str) -> FlowField:
    """The same on triangles, whose sides are about as long as those of the cells."""
    points, triangles = random_plane(np.random.default_rng(4), 1500)
    mixed = soup(np.random.default_rng(4), (points, triangles))
    velocity = (mixed[0][:, :2] - CELL * POINT) @ np.transpose(FLOWS[name])
    return FlowField.from_triangles(*mixed, velocity)


def exact(name: str, start: Floats, length: float) -> Floats:
    """Points of the path through ``start`` that are about a twentieth apart, (N, 2)."""
    matrix, sides = np.array(FLOWS[name]), []
    for side in (-1, 1):
        points = [start]
        for _ in range(int(20 * length)):
            if np.linalg.norm(points[-1]) < 0.05:
                break
            time = 0.05 / np.linalg.norm(matrix @ points[-1])
            points.append(expm(side * time * matrix) @ points[-1])
        sides += points
    return np.array(sides)


@pytest.mark.parametrize(
    ("make", "parameter"), [(linear, "arclength"), (linear, "time"), (scattered, "time")]
)
@pytest.mark.parametrize("name", FLOWS)
def test_a_path_beside_a_critical_point_is_exact(
    name: str, parameter: str, make: Callable[[str], FlowField]
) -> None:
    field = make(name)
    scene = Scene(field, Settings(parameter=parameter, grain=1.5))
    # Far enough from a point where paths end, in pixels.
    starts = [[3.0, 8.0], [-14.0, 5.0]] if name in ("saddle", "centre") else [[20.0, 30.0]]
    for cells, start in product([0.02, 1e-3], np.array(starts)):
        place = locate(field, [*(CELL * (POINT + cells * start)), 0.0])
        assert place is not None
        found = probe(scene, place, pixel=cells * CELL)
        points = (found.points[:, :2] / CELL - POINT) / cells
        off = np.linalg.norm(points[:, None] - exact(name, start, 30.0), axis=-1).min(axis=1)
        # Half precision moves the critical point by some ten-thousandths of a cell.
        assert off.max() < 0.1 + 4e-4 / cells
        steps = np.linalg.norm(np.diff(points, axis=0), axis=-1)
        np.testing.assert_allclose(steps, 1.05, rtol=0.05)
        assert len(points) == 49


@pytest.mark.parametrize("make", [linear, scattered])
@pytest.mark.parametrize("name", ["saddle", "centre"])
def test_a_path_longer_than_the_cell_of_a_critical_point_is_exact(
    name: str, make: Callable[[str], FlowField]
) -> None:
    scene = Scene(make(name), Settings(parameter="time"))
    # A side of the path is one and a half cells long.
    cells = 1 / 24
    if make is linear:
        cells = 1 / 16
    for start in np.array([[2.0, 5.0], [-4.0, 3.0], [5.0, -1.0]]):
        place = locate(scene.field, [*(CELL * (POINT + cells * start)), 0.0])
        assert place is not None
        found = probe(scene, place, pixel=cells * CELL)
        points = (found.points[:, :2] / CELL - POINT) / cells
        off = np.linalg.norm(points[:, None] - exact(name, start, 30.0), axis=-1).min(axis=1)
        assert off.max() < 0.3


@pytest.mark.parametrize("make", [linear, scattered])
@pytest.mark.parametrize("name", ["saddle", "centre"])
def test_paths_across_cells_around_a_critical_point_are_exact(
    name: str, make: Callable[[str], FlowField]
) -> None:
    scene = Scene(make(name), Settings())
    # A cell is nine pixels wide, and a side of the path three cells long.
    cells = 1 / 9
    off = []
    for angle, radius in product(np.linspace(0, 2 * np.pi, 12, endpoint=False), [4.0, 9.0]):
        start = radius * np.array([np.cos(angle), np.sin(angle)])
        place = locate(scene.field, [*(CELL * (POINT + cells * start)), 0.0])
        assert place is not None
        found = probe(scene, place, pixel=cells * CELL)
        points = (found.points[:, :2] / CELL - POINT) / cells
        away = np.linalg.norm(points[:, None] - exact(name, start, 30.0), axis=-1).min(axis=1)
        off.append(np.sqrt(away**2 @ found.weights))
    assert np.mean(off) < 0.3


def fan(name: str) -> FlowField:
    """The same about the middle of a disc in triangles that are long and thin."""
    corners = polygon(60, 1)
    faces = [(0, first, first + 1) for first in range(1, 59)]
    points = np.column_stack([corners, np.zeros(60)])
    disc = pv.PolyData.from_regular_faces(points, faces).subdivide(2)
    velocity = disc.points[:, :2] @ np.transpose(FLOWS[name])
    return FlowField.from_triangles(disc.points[:, :2], disc.regular_faces, velocity)


@pytest.mark.parametrize(("name", "parameter"), [("saddle", "time"), ("centre", "arclength")])
def test_a_path_across_thin_triangles_beside_a_critical_point_is_exact(
    name: str, parameter: str
) -> None:
    scene = Scene(fan(name), Settings(parameter=parameter))
    pixel = 1 / 300  # a triangle is 6 pixels wide and 75 long
    for start in np.array([[3.0, 2.0], [-4.0, 3.0], [5.0, -1.0]]):
        place = locate(scene.field, [*(pixel * start), 0.0])
        assert place is not None
        points = probe(scene, place, pixel=pixel).points[:, :2] / pixel
        off = np.linalg.norm(points[:, None] - exact(name, start, 30.0), axis=-1).min(axis=1)
        assert off.max() < 0.5


def test_a_path_ends_in_a_node() -> None:
    i, j = POINT + np.array([0.005, 0.0])
    found = probe(Scene(linear("node")), (j, i), pixel=1e-3 * CELL)
    # Five pixels from the node there is room for four samples, and a fifth that fades.
    assert (found.weights[found.lags < 0] > 0).sum() == 5
    assert len(found.lags) == 24 + 1 + 5


@pytest.mark.parametrize(
    ("field", "zoom", "near"),
    [(gyre, 0.5, False), (gyre, 8.0, True), (scattered_gyre, 0.06, False)],
)
def test_from_afar_the_slices_are_left_alone(
    field: Callable[[], FlowField], zoom: float, near: bool
) -> None:
    scene, camera = Scene(field(), Settings()), straight(zoom, (0.5, 0.5))
    view = ViewState(eye=camera.eye, pixel=2 * camera.parallel_scale / SIZE[1])
    assert is_near(scene.textures, scene.settings, view) == near
    plain, cells = (
        render(scene.textures, scene.settings, camera, SIZE, view=v).value
        for v in (replace(view, pixel=np.inf), ViewState())
    )
    assert np.array_equal(plain, cells, equal_nan=True) != near


def test_where_the_flow_does_not_turn_no_view_is_near() -> None:
    y, x = np.mgrid[0:1:20j, 0:1:20j]
    wind = FlowField.from_arrays(np.stack([x, y], -1), np.stack([1 + x, 0.3 * y], -1))
    assert not is_near(Scene(wind).textures, Settings(), ViewState())
    points, triangles = random_plane(np.random.default_rng(4), 400)
    scattered_wind = FlowField.from_triangles(points, triangles, 1 + points[:, :2])
    assert not is_near(Scene(scattered_wind).textures, Settings(), ViewState())
    assert not is_near(Scene(lines()).textures, Settings(), ViewState())
    for settings in (Settings(lines="pathlines"), Settings(lines="streamlines")):
        textures = Scene(swinging(), settings).textures
        assert is_near(textures, settings, ViewState()) == (settings.lines == "streamlines")


def test_in_perspective_the_nearest_point_counts() -> None:
    textures, settings = Scene(linear("saddle")).textures, Settings()
    middle = textures.geometry.center
    view = ViewState(focus=middle, pixel=16 * CELL / (24 * 1.05))
    assert not is_near(textures, settings, view)
    eye = np.append(middle + np.array([0.0, 0.0, 1.0]), 1.0)
    assert is_near(textures, settings, replace(view, eye=eye))


def test_paths_stay_in_a_face_at_a_sharp_edge_from_farther_away() -> None:
    textures, settings = Scene(across()).textures, Settings()
    for cells, near in ((4, True), (40, False)):
        view = ViewState(pixel=cells * 0.5 / (24 * 1.05))
        assert is_near(textures, settings, view) == near
