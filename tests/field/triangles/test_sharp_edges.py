"""Values beside sharp edges are those of the face, up to the edge."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from triangle_meshes import cube, joined, sheet, soup, sphere, surface_of

from flowtex import FlowField
from flowtex._util.array_types import Floats, Indices
from flowtex.field.quantities import PointValues
from flowtex.field.triangles.sharp_edges import split_nodes
from flowtex.field.triangles.triangle_nodes import connected_items, triangle_normals
from flowtex.textures.tiles.clusters import Levels
from flowtex.trace.trace import paths

pytestmark = pytest.mark.filterwarnings("ignore::flowtex.errors.Notice")

WIND = np.array([0.3, 0.2, 1.0])
BODIES: dict[str, Callable[[], Any]] = {
    "box": lambda: pv.Box(level=1),
    "grid cells": lambda: pv.ImageData(dimensions=(3, 2, 3)).extract_surface(algorithm=None),
    "octahedron": pv.Octahedron,
    "icosahedron": pv.Icosahedron,
    "prism": lambda: pv.Cylinder(resolution=8),
}


def triangles_of(mesh: Any) -> tuple[Floats, Indices]:
    """Return nodes, of which sides share some, and triangles of a mesh."""
    joined = mesh.triangulate().clean()
    return np.asarray(joined.points, float), joined.regular_faces.astype(int)


def in_plane(velocity: Floats, crosses: Floats) -> Floats:
    """Return the parts of velocities in the planes of triangles with some normals, (M, 3)."""
    unit = crosses / np.linalg.norm(crosses, axis=1, keepdims=True)
    return np.asarray(velocity - np.sum(velocity * unit, axis=1, keepdims=True) * unit)


def values(field: FlowField, places: Floats) -> list[PointValues]:
    """Return the values at places (N, 3)."""
    found = [field.at(*place.tolist()) for place in places]
    return [point for point in found if point is not None]


def speeds(field: FlowField, places: Floats) -> Floats:
    """Return the speeds at places, (N,)."""
    return np.array([point.speed for point in values(field, places)], dtype=float)


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("own_nodes", [False, True])
def test_speed_is_that_in_the_face(name: str, own_nodes: bool) -> None:
    points, triangles = triangles_of(BODIES[name]())
    if own_nodes:
        points, triangles = soup(np.random.default_rng(1), (points, triangles))
    field = FlowField.from_triangles(points, triangles, np.tile(WIND, (len(points), 1)))
    expected = np.linalg.norm(in_plane(WIND, triangle_normals(points, triangles)), axis=1)
    for shares in ([0.9, 0.05, 0.05], [0.01, 0.5, 0.49]):
        places = np.einsum("k,mkc->mc", shares, points[triangles])
        np.testing.assert_allclose(speeds(field, places), expected, atol=1e-6)


def test_surface_without_sharp_edges_keeps_its_nodes() -> None:
    for points, triangles in (sphere(1), triangles_of(pv.Cylinder(resolution=40, capping=False))):
        field = FlowField.from_triangles(points, triangles, np.tile(WIND, (len(points), 1)))
        np.testing.assert_array_equal(field.points[0], points)
        np.testing.assert_array_equal(field.triangles, triangles)


def test_smooth_surface_is_read_without_neighbours_of_triangles() -> None:
    points, triangles = sphere(3)
    field = FlowField.from_triangles(points, triangles, np.tile(WIND, (len(points), 1)))
    surface: Any = field.surface
    assert not surface.flipped.any()
    assert "neighbours" not in surface.__dict__


def test_noise_has_no_faces_and_a_box_beside_it_keeps_its_own(rng: np.random.Generator) -> None:
    terrain = sheet(rng.normal(size=(60, 60)))
    box = cube(10)
    points, triangles = joined(terrain, (box[0] + [0, 0, 20], box[1]))
    split, origin = split_nodes(points, triangles)
    new = origin[len(points) :]
    assert (new >= len(terrain[0])).all()
    # A cube of 10 x 10 squares a side has 12 edges with 9 nodes inside, and 8 corners.
    assert len(new) == 12 * 9 + 8 * 2
    np.testing.assert_array_equal(split[: len(terrain[1])], terrain[1])


def test_faces_in_noise_are_not_searched(
    rng: np.random.Generator, monkeypatch: pytest.MonkeyPatch
) -> None:
    searches: list[int] = []

    def recorded(begins: Indices, ends: Indices, count: int) -> Indices:
        searches.append(count)
        return connected_items(begins, ends, count)

    monkeypatch.setattr("flowtex.field.triangles.sharp_edges.connected_items", recorded)
    points, triangles = sheet(rng.normal(size=(60, 60)))
    split, origin = split_nodes(points, triangles)
    assert split is triangles
    assert len(origin) == len(points)
    # Only chains of sharp edges are connected, not the corners of faces.
    assert searches == [len(points)]


@pytest.mark.parametrize("name", BODIES)
def test_faces_do_not_depend_on_the_order_of_corners(name: str, rng: np.random.Generator) -> None:
    points, triangles = triangles_of(BODIES[name]())
    smooth_points, smooth = sphere(2)
    points = np.concatenate([points, smooth_points + 5])
    triangles = np.concatenate([triangles, smooth + len(points) - len(smooth_points)])
    split, origin = split_nodes(points, triangles)
    turned = rng.random(len(triangles)) < 0.4
    mixed, mixed_origin = split_nodes(
        points, np.where(turned[:, None], triangles[:, ::-1], triangles)
    )
    same = np.where(turned[:, None], mixed[:, ::-1], mixed)
    pairs = np.unique(np.stack([split.ravel(), same.ravel()]), axis=1)
    assert len(origin) == len(mixed_origin) == pairs.shape[1] > len(points)
    np.testing.assert_array_equal(split[-len(smooth) :], triangles[-len(smooth) :])


def test_face_keeps_its_own_values() -> None:
    mesh: Any = pv.Cube(clean=False).triangulate()  # four nodes for each side
    mesh["U"] = np.tile(WIND, (mesh.n_points, 1))
    crosses = triangle_normals(np.asarray(mesh.points, float), mesh.regular_faces)
    side = np.abs(crosses).argmax(axis=1)
    mesh["side"] = np.zeros(mesh.n_points)
    mesh["side"][mesh.regular_faces] = side[:, None]
    field = FlowField.from_pyvista(mesh)
    places = 0.499 + 0.001 * np.eye(3)  # each beside the corner, on another side
    assert [point.scalars["side"] for point in values(field, places)] == [0, 1, 2]


def test_mean_of_cells_is_that_of_one_face() -> None:
    mesh: Any = pv.Box(level=2).triangulate().clean()
    mesh.clear_data()
    points, triangles = np.asarray(mesh.points, float), mesh.regular_faces
    mesh.cell_data["U"] = in_plane(WIND, triangle_normals(points, triangles))
    field = FlowField.from_pyvista(mesh)
    places = np.einsum("k,mkc->mc", [0.9, 0.05, 0.05], points[triangles])
    expected = np.linalg.norm(mesh.cell_data["U"], axis=1)
    np.testing.assert_allclose(speeds(field, places), expected, atol=1e-6)


def test_path_crosses_an_edge_between_the_nodes_of_both_faces() -> None:
    points, triangles = cube(6)
    velocity = np.tile([1.0, 0.0, -1.0], (len(points), 1))
    field = FlowField.from_triangles(points, triangles, velocity)
    surface = surface_of(field)
    assert surface.is_closed
    on_top = [point.index[::-1] for point in values(field, np.array([[0.5, 0.1, 1.0]]))]
    found = paths(field, on_top, [0.25, 1.0], parameter="time", forward=True)
    places = surface.at(found.positions[:, 0])
    np.testing.assert_allclose(places, [[0.75, 0.1, 1.0], [1.0, 0.1, 0.5]], atol=1e-6)


def test_faces_stay_apart_at_coarser_levels() -> None:
    points, triangles = cube(40)
    mixed, corners = soup(np.random.default_rng(2), (points, triangles))
    field = FlowField.from_triangles(mixed, corners, np.tile(WIND, (len(mixed), 1)))
    levels = Levels(field, 1000)
    assert len(levels) > 2
    for level in levels:
        surface = surface_of(level.field)
        assert surface.is_closed
        area = np.linalg.norm(surface.crosses, axis=1) / 2
        assert area.sum() == pytest.approx(24.0)
        speed = level.field.index_velocity.speed[0, 0][surface.triangles]
        expected = np.linalg.norm(in_plane(WIND, surface.crosses), axis=1)
        np.testing.assert_allclose(speed, expected[:, None] + np.zeros(3), atol=1e-6)
