"""Vectors along a radius and angles become vectors along x, y and z."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
import pyvista as pv
from scipy.spatial import cKDTree

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.errors import FieldError

#: The flows of these tests go through their meshes.
pytestmark = pytest.mark.filterwarnings(
    "ignore:.*of the flow is normal to the surface:flowtex.errors.Notice"
)


def sphere() -> tuple[pv.PolyData, Floats]:
    """Return a sphere and a flow around an oblique axis at its points, along x, y and z."""
    grid = pv.Sphere(theta_resolution=24, phi_resolution=18)
    return grid, np.cross([0.3, -0.2, 1.0], np.asarray(grid.points, dtype=float))


def spherical_components(places: Floats, flow: Floats) -> Floats:
    """Return vectors along the radius, southward and eastward, (N, 3), by finite differences."""
    x, y, z = places.T
    radius = np.linalg.norm(places, axis=1)
    colatitude, longitude = np.arccos(z / radius), np.arctan2(y, x)

    def at(r: Floats, c: Floats, a: Floats) -> Floats:
        return np.stack([r * np.sin(c) * np.cos(a), r * np.sin(c) * np.sin(a), r * np.cos(c)], -1)

    step = 1e-6
    moved = (
        at(radius + step, colatitude, longitude) - at(radius - step, colatitude, longitude),
        at(radius, colatitude + step, longitude) - at(radius, colatitude - step, longitude),
        at(radius, colatitude, longitude + step) - at(radius, colatitude, longitude - step),
    )
    columns = []
    for difference in moved:
        length = np.linalg.norm(difference, axis=1)
        direction = difference / np.maximum(length, 1e-12)[:, None]
        columns.append((flow * direction).sum(axis=1))
    return np.stack(columns, axis=-1)


@pytest.mark.parametrize("names", ["velocity", "south,east"])
def test_spherical_components_at_every_node(names: str) -> None:
    grid, flow = sphere()
    # The direction of longitude is unknown at the poles.
    inside = np.abs(grid.points[:, 2]) < 0.499
    parts = spherical_components(np.asarray(grid.points, dtype=float), flow)
    grid["velocity"], grid["south"], grid["east"] = parts, parts[:, 1], parts[:, 2]
    field = FlowField.from_pyvista(grid, vectors=names, components="spherical")
    order = cKDTree(grid.points).query(field.points)[1]
    assert np.allclose(field.velocity[0][inside[order]], flow[order][inside[order]], atol=1e-5)
    assert "angle from z" in field.reading.of("components")[0]


def test_cylindrical_components_on_cells_are_turned_before_the_average() -> None:
    """A uniform flow stays uniform, also around the axis, where directions change fast."""
    grid = pv.ImageData(dimensions=(8, 8, 1), spacing=(0.25, 0.25, 1), origin=(-0.9, -0.8, 0.0))
    x, y, _ = np.asarray(grid.cell_centers().points).T
    angle = np.arctan2(y, x)
    grid.cell_data["velocity"] = np.stack([np.cos(angle), -np.sin(angle), 0 * x], axis=-1)
    field = FlowField.from_pyvista(grid, components="cylindrical")
    assert np.allclose(field.velocity[0], (1.0, 0.0, 0.0))


def test_cylindrical_components_of_a_volume_and_of_a_cut() -> None:
    grid = pv.ImageData(dimensions=(9, 8, 7), origin=(-4.1, -3.2, 0.0))
    x, y, _ = np.asarray(grid.points).T
    angle = np.arctan2(y, x)
    grid["velocity"] = np.stack([np.cos(angle), -np.sin(angle), 0 * x + 3], axis=-1)
    for choice in ({"plane": "k=3"}, {"slice": "z=2.5"}, {"slice": "x=0.2"}):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            field = FlowField.from_pyvista(grid, components="cylindrical", **choice)
        assert np.allclose(field.velocity[0][field.valid], (1.0, 0.0, 3.0), atol=1e-6)


def test_fill_values_of_polar_components_stay_missing() -> None:
    grid = pv.ImageData(dimensions=(8, 7, 1), origin=(1.0, 1.0, 0.0))
    parts = np.random.default_rng(1).uniform(0.5, 1.5, (grid.n_points, 2))
    parts[[5, 20]] = -9999.0
    grid["radial"], grid["around"] = parts.T
    with pytest.warns(UserWarning, match="-9999"):
        field = FlowField.from_pyvista(grid, vectors="radial,around", components="polar")
    assert (~field.valid).sum() == 2
    assert np.abs(field.velocity[0]).max() < 3


def test_directions_that_a_mesh_does_not_have() -> None:
    with pytest.raises(FieldError, match=r"components is 'earth'; expected for a mesh 'polar' \("):
        FlowField.from_pyvista(sphere()[0], vectors="Normals", components="earth")
