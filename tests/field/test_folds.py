"""Structured surfaces whose cells turn sharply along lines of nodes have values of each face."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import pyvista as pv

import flowtex
from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.errors import Notice

pytestmark = pytest.mark.filterwarnings("ignore:.* of the flow is normal to the surface")

FLOOR_SPEED = 1.0
WIND = (FLOOR_SPEED, 0.0, 0.0)
#: Places on a floor in z = 0 and a wall in x = 0, down to a hundredth of a cell from their edge.
ON_FLOOR = [(-0.9, 0.3, 0.0), (-0.04, 0.5, 0.0), (-0.001, 0.71, 0.0)]
ON_WALL = [(0.0, 0.5, 0.001), (0.0, 0.71, 0.04), (0.0, 0.2, 0.9)]


def grid_of(points: Floats) -> Any:
    """Return a PyVista grid of nodes (J, I, 3)."""
    x, y, z = np.moveaxis(points, -1, 0)[..., None]
    return pv.StructuredGrid(x, y, z)


def floor_and_wall(along: int = 0) -> Any:
    """Return a floor and a wall of 9 x 25 nodes, folded along rows or columns, without data."""
    way, across = np.meshgrid(np.linspace(-1, 1, 25), np.linspace(0, 1, 9), indexing="ij")
    points = np.stack([np.minimum(way, 0), across, np.maximum(way, 0)], axis=-1)
    return grid_of(np.swapaxes(points, 0, along))


def partly_folded() -> Any:
    """Return a floor that becomes a ramp beyond x = 0, ever steeper with y up to 70 degrees."""
    way, across = np.meshgrid(np.linspace(-1, 1, 25), np.linspace(0, 1, 17), indexing="ij")
    slope = np.tan(np.radians(70) * across**2)
    return grid_of(np.stack([way, across, slope * np.maximum(way, 0)], axis=-1))


def duct(*, closed: bool) -> Any:
    """Return the four sides of a duct, around z, maybe without the last column of cells."""
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)])
    around = np.linspace(0, 4, 25)
    if not closed:
        around = around[:-1]
    x, y = (np.interp(around, range(5), corners[:, axis]) for axis in (0, 1))
    z = np.linspace(0, 1, 7)
    sides = [np.broadcast_to(value[:, None], (len(around), 7)) for value in (x, y)]
    return grid_of(np.stack([*sides, np.broadcast_to(z, (len(around), 7))], axis=-1))


def with_wind(mesh: Any, wind: tuple[float, ...] = WIND) -> Any:
    """Add the same velocity at all nodes."""
    mesh["U"] = np.tile(wind, (mesh.n_points, 1))
    return mesh


def speeds(field: FlowField, places: Any) -> list[float]:
    """Return the speeds at places on the surface."""
    found = [field.at(*place) for place in places]
    return [float("nan") if point is None else point.speed for point in found]


@pytest.mark.parametrize("along", [0, 1])
def test_speed_beside_a_fold_is_that_in_the_face(along: int) -> None:
    field = FlowField.from_pyvista(with_wind(floor_and_wall(along)))
    np.testing.assert_allclose(speeds(field, ON_FLOOR), FLOOR_SPEED, atol=1e-12)
    np.testing.assert_allclose(speeds(field, ON_WALL), 0.0, atol=1e-12)


def test_velocity_on_cells_is_averaged_in_each_face() -> None:
    mesh = floor_and_wall()
    is_floor = mesh.cell_centers().points[:, 2:] == 0
    mesh.cell_data["U"] = np.where(is_floor, [WIND], [(0.0, 0.0, 0.5)])
    field = FlowField.from_pyvista(mesh)
    np.testing.assert_allclose(speeds(field, ON_FLOOR), FLOOR_SPEED, atol=1e-12)
    np.testing.assert_allclose(speeds(field, ON_WALL), 0.5, atol=1e-12)


def test_fold_may_end_inside_the_surface() -> None:
    field = FlowField.from_pyvista(with_wind(partly_folded()))
    beside = [(-0.001, 0.97, 0.0), (-0.04, 0.9, 0.0)]
    np.testing.assert_allclose(speeds(field, beside), FLOOR_SPEED, atol=1e-3)


@pytest.mark.parametrize("closed", [True, False])
def test_duct_has_four_faces(closed: bool) -> None:
    field = FlowField.from_pyvista(with_wind(duct(closed=closed), (1.0, 0.5, 0.3)))
    along_x = [(0.5, 0.0, 0.5), (0.99, 0.0, 0.5), (0.01, 0.0, 0.5), (0.01, 1.0, 0.5)]
    along_y = [(1.0, 0.01, 0.5), (1.0, 0.99, 0.5), (0.0, 0.99, 0.5), (0.0, 0.01, 0.5)]
    np.testing.assert_allclose(speeds(field, along_x), np.hypot(1.0, 0.3), rtol=1e-9)
    np.testing.assert_allclose(speeds(field, along_y), np.hypot(0.5, 0.3), rtol=1e-9)


def test_plane_of_a_volume_may_be_folded() -> None:
    sheet = floor_and_wall().points.reshape(9, 25, 3)
    layers = np.stack([sheet, sheet + np.array([0.5, 0.0, -0.5])])
    mesh: Any = pv.StructuredGrid()
    mesh.points = layers.reshape(-1, 3)
    mesh.dimensions = 25, 9, 2
    field = FlowField.from_pyvista(with_wind(mesh), plane="k=0")
    np.testing.assert_allclose(speeds(field, ON_FLOOR), FLOOR_SPEED, atol=1e-12)
    np.testing.assert_allclose(speeds(field, ON_WALL), 0.0, atol=1e-12)


def test_data_of_a_folded_grid_stay() -> None:
    meshes = [with_wind(floor_and_wall(), (speed, 0.0, 0.0)) for speed in (1.0, 2.0)]
    for mesh in meshes:
        mesh["height"] = mesh.points[:, 2]
        mesh.cell_data["number"] = np.arange(mesh.n_cells)
        mesh.hide_points(np.array([0]))
    field = FlowField.from_pyvista(meshes, times=[0.0, 10.0], name="a flow")
    point = field.at(0.0, 0.5, 0.96, time=5.0)
    assert point is not None
    assert point.scalars["height"] == pytest.approx(0.96)
    assert point.scalars["number"] == meshes[0].find_closest_cell((0.0, 0.53, 0.97))
    assert speeds(field, ON_FLOOR)[1] == pytest.approx(1.0)
    assert field.at(-1.0, 0.0, 0.0) is None, "the hidden node"
    assert (field.name, list(field.times)) == ("a flow", [0.0, 10.0])


def test_surface_without_folds_stays_a_grid() -> None:
    turn, z = np.meshgrid(np.linspace(0, 2 * np.pi, 17), np.linspace(0, 1, 5), indexing="ij")
    tube = grid_of(np.stack([np.cos(turn), np.sin(turn), z], axis=-1))
    assert FlowField.from_pyvista(with_wind(tube)).shape == (5, 17)
    # A single sharp side inside the surface is no line.
    x, y = np.meshgrid(np.arange(9.0), np.arange(7.0), indexing="ij")
    dented = np.stack([x, y, np.zeros_like(x)], axis=-1)
    dented[4, 3:5, 2] = 0.8
    dented[3, 3:5, 2] = dented[5, 3:5, 2] = 0.5
    assert FlowField.from_pyvista(with_wind(grid_of(dented))).triangles is None


def test_picture_has_the_colour_of_each_face() -> None:
    picture = flowtex.render(
        with_wind(floor_and_wall()),
        size=(200, 160),
        camera=[(-3, -2, 2.2), (-0.3, 0.5, 0.3), (0, 0, 1)],
        strength=0.0,
        lighting=False,
    )
    pixels = picture[..., :3].reshape(-1, 3)
    count = np.unique(pixels[(pixels != 255).any(axis=1)], axis=0, return_counts=True)[1]
    main = count > 1000
    assert main.sum() == 2
    assert count[~main].sum() < 0.05 * count.sum(), "the rest is at the outline"


def test_picture_of_arrays_with_folds_issues_a_notice() -> None:
    points = floor_and_wall().points.reshape(9, 25, 3).astype(float)
    field = FlowField.from_arrays(points, np.tile(WIND, (9, 25, 1)))
    assert field.shape == (9, 25)
    with pytest.warns(Notice, match="turn by 35 degrees or more"):
        flowtex.render(field, size=(40, 30))
