"""Faces of a body across the flow, on which the flow along the surface is nothing or rounding."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import pyvista as pv

import flowtex

pytestmark = [
    pytest.mark.usefixtures("opengl"),
    pytest.mark.filterwarnings("ignore::flowtex.errors.Notice"),
]
SIZE = (210, 150)
FOCUS = np.array([0.0, 0.0, 0.5])  #: A point on the edge of the inlet.


def box() -> Any:
    """Return the surface of a box along the flow."""
    return pv.ImageData(dimensions=(31, 11, 11), spacing=(0.1, 0.1, 0.1)).extract_surface(
        algorithm=None
    )


def cylinder() -> Any:
    """Return a closed cylinder along the flow."""
    mesh: Any = pv.Cylinder(center=(1.5, 0.5, 0.5), direction=(1, 0, 0), height=3, resolution=40)
    return mesh.triangulate().subdivide(2)


def with_flow(mesh: Any, noise: float = 0.0) -> Any:
    """Return a mesh in uniform flow along x."""
    random = np.random.default_rng(0)
    mesh["U"] = np.array([1.0, 0.0, 0.0]) + random.normal(0, noise, (mesh.n_points, 3))
    return mesh


def camera(distance: float) -> Any:
    """See the inlet and a side from a distance from an edge between both."""
    return [FOCUS + distance * np.array([-3.0, -3.0, 2.0]), FOCUS, (0, 0, 1)]


@pytest.mark.parametrize("make", [box, cylinder])
@pytest.mark.parametrize("distance", [1.0, 0.5, 0.1])
def test_face_across_the_flow_has_no_black_pixels(make: Callable[[], Any], distance: float) -> None:
    picture = flowtex.render(with_flow(make()), size=SIZE, camera=camera(distance))
    assert picture.max(axis=-1).min() > 12


def contrast(mesh: Any, **options: Any) -> float:
    """Return the standard deviation of the middle of a picture, straight against the flow."""
    view = [(-4, 0.5, 0.5), (1, 0.5, 0.5), (0, 0, 1)]
    picture = flowtex.render(mesh, size=SIZE, camera=view, scalars=False, lighting=False, **options)
    middle = picture[SIZE[1] // 3 : 2 * SIZE[1] // 3, 2 * SIZE[0] // 5 : 3 * SIZE[0] // 5]
    return float(middle.astype(float).std())


def bent() -> Any:
    """Return a grid whose first half lies across the flow, and its second half along it."""
    s, t = np.meshgrid(np.linspace(-1, 2, 61), np.linspace(0, 1, 21))
    return pv.StructuredGrid(np.maximum(s, 0.0), t, np.minimum(s, 0.0) + 1)


@pytest.mark.parametrize("make", [box, cylinder, bent])
def test_noise_on_a_face_across_the_flow_is_faded(make: Callable[[], Any]) -> None:
    for seen in (contrast(with_flow(make(), 1e-3)), contrast(with_flow(make(), 1e-3), arrows=True)):
        assert seen < 3
    assert contrast(with_flow(make(), 0.1)) > 12


@pytest.mark.parametrize("strength", [0.003, 1.0])
def test_secondary_flow_in_a_section_is_drawn(strength: float) -> None:
    y, z = np.meshgrid(np.linspace(0, 1, 31), np.linspace(0, 1, 31))
    turning = np.stack([0 * y, 0.5 - z, y - 0.5], axis=-1)
    points = np.stack([0 * y, y, z], axis=-1)
    field = flowtex.FlowField.from_arrays(points, np.array([1.0, 0.0, 0.0]) + strength * turning)
    assert contrast(field) == pytest.approx(contrast(field.from_arrays(points, turning)), abs=0.5)


def test_rounding_in_a_section_is_faded() -> None:
    y, z = np.meshgrid(np.linspace(0, 1, 31), np.linspace(0, 1, 31))
    noise = np.random.default_rng(0).normal(0, 3e-8, (31, 31, 3))
    points = np.stack([0 * y, y, z], axis=-1)
    assert contrast(flowtex.FlowField.from_arrays(points, np.array([1.0, 0.0, 0.0]) + noise)) < 1
