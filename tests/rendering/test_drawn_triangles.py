"""Surfaces of triangles as VTK draws them, and what of them a view needs."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from flows import folded
from measures import streaks
from plain_pyvista import off_colours
from triangle_meshes import cube, random_plane, soup, surface_of

import flowtex
from flowtex import FlowField
from flowtex.rendering.camera import Camera, apply_camera


def flow(x: Any, y: Any) -> tuple[Any, Any]:
    return -np.sin(2 * np.pi * x) * np.cos(np.pi * y), 2 * np.cos(2 * np.pi * x) * np.sin(np.pi * y)


@cache
def field(nodes: int = 2500) -> FlowField:
    """Two vortices in the unit square, on triangles that face either way."""
    rng = np.random.default_rng(2)
    points, triangles = soup(rng, random_plane(rng, nodes))
    velocity = np.stack(flow(points[:, 0], points[:, 1]), -1)
    return FlowField.from_triangles(points, triangles, velocity, scalars={"x": points[:, 0]})


def test_colours_are_those_that_pyvista_draws(plotter: Any) -> None:
    drawn = field()
    plotter.flowtex.add(drawn, scalars="speed", clim=(0, 2), strength=0.0, lighting=False)
    ours = plotter.screenshot(return_img=True)
    faces: Any = surface_of(drawn).triangles
    mesh: Any = pv.PolyData.from_regular_faces(drawn.points[0], faces)
    mesh["speed"] = drawn.speed[0, 0]
    assert off_colours(ours, mesh, drawn, scalars="speed", cmap="viridis", clim=(0, 2)) < 2


def test_edges_and_picks(plotter: Any) -> None:
    handle = plotter.flowtex.add(field(60), scalars=False)
    plain = plotter.screenshot(return_img=True).astype(float)
    handle.actor.prop.show_edges, handle.actor.prop.edge_color = True, "red"
    plotter.render()
    edged = plotter.screenshot(return_img=True).astype(float)
    red = edged[..., 0] - edged[..., 1] > 20
    assert 0.005 < red.mean() < 0.3
    same = (np.abs(edged - plain).max(axis=-1) < 2)[~red]
    assert same.mean() > 0.85
    from vtkmodules.vtkRenderingCore import vtkCellPicker

    picker = vtkCellPicker()
    width, height = plotter.window_size
    assert picker.Pick(width / 2, height / 2, 0, plotter.renderer)
    np.testing.assert_allclose(picker.GetPickPosition(), (0.5, 0.5, 0.0), atol=0.01)


def test_streaks_go_up_to_a_sharp_edge(plotter: Any) -> None:
    points, triangles = cube(12)
    turning = FlowField.from_triangles(points, triangles, np.cross([0.0, 0.0, 1.0], points))
    plotter.flowtex.add(turning, scalars=False, lighting=False)
    # Less than a cell of the face beside its edge at the right, seen straight.
    middle = np.array([0.96, -1.0, 0.0])
    width, height = plotter.window_size
    camera = Camera(
        tuple(middle - [0, 3, 0]), tuple(middle), (0, 0, 1), parallel=True, parallel_scale=0.02
    )
    apply_camera(camera, plotter.camera)
    plotter.camera_set = True
    plotter.renderer.reset_camera_clipping_range()
    picture = np.asarray(plotter.screenshot(return_img=True))[..., :3]
    mask = np.zeros((height, width), dtype=bool)
    mask[20:-20, 20:-20] = True
    found = streaks(picture, np.ones_like(mask, float), np.zeros_like(mask, float), mask)
    assert found["angle"] < 3
    assert found["coherence"] > 0.9


@pytest.mark.parametrize("zoom", [1.0, 4.0])
@pytest.mark.parametrize("up", [-1.0, 0.0, 1.0])
def test_streaks_beside_a_sharp_edge_lie_in_the_surface(up: float, zoom: float) -> None:
    """Also in triangles that are long across it, whose slices lead into the air.

    The flow goes over the edge, into it or along it in the other plane.
    """
    camera = Camera((-0.2, 0, 3), (-0.2, 0, 0), (0, 1, 0), parallel=True, parallel_scale=0.5 / zoom)
    options: dict[str, Any] = {"scalars": False, "lighting": False, "size": (300, 240)}
    picture = flowtex.render(folded(up), camera=camera, **options)
    x = -0.2 + (np.arange(300) - 149.5) / 240 / zoom
    mask = np.tile((x > -0.35) & (x < -0.02), (240, 1))
    mask[:20] = mask[-20:] = False
    mask[:, :20] = mask[:, -20:] = False
    found = streaks(picture, np.ones(mask.shape), np.full(mask.shape, 0.6), mask)
    assert found["angle"] < 3
    assert found["coherence"] > 0.9
