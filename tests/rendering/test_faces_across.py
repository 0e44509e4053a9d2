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
