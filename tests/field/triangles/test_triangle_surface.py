"""Geometry of a surface of triangles, and points on it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import property_test
from triangle_meshes import cube, random_plane, soup, sphere, surface_of

from flowtex import FlowField
from flowtex.field.locate import locate, locator
from flowtex.field.quantities import values_at


def rotating(mesh: tuple[np.ndarray, np.ndarray]) -> FlowField:
    points, triangles = mesh
    return FlowField.from_triangles(points, triangles, np.cross([0.0, 0.0, 1.0], points))


def test_a_sphere_is_known(rng: np.random.Generator) -> None:
    for mesh in (sphere(4), soup(rng, sphere(4))):
        field = rotating(mesh)
        surface = surface_of(field)
        outward = np.einsum("jic,jic->ji", surface.normals, surface.points)
        np.testing.assert_allclose(np.abs(outward), 1, atol=1e-5)
        assert (np.sign(outward) == np.sign(outward[0, 0])).all()
        np.testing.assert_allclose(np.linalg.norm(surface.tangents, axis=-1), 1)
        np.testing.assert_allclose(np.cross(*surface.tangents), surface.normals, atol=1e-12)
        assert field.normal_share < 1e-3
        np.testing.assert_allclose(
            field.speed[0, 0], np.hypot(*field.points[0, :, :2].T), atol=1e-5
        )
        assert surface.frame is None
        assert field.shape == (1, len(sphere(4)[0]))


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5])
def test_flow_out_of_a_large_surface_is_estimated(
    monkeypatch: pytest.MonkeyPatch, share: float
) -> None:
    monkeypatch.setattr("flowtex.field.triangles.triangle_surface.MOST_MEASURED", 3000)
    points, triangles = sphere(5)
    along = np.cross([0.0, 0.0, 1.0], points) * np.sqrt(1.5)
    velocity = np.sqrt(1 - share**2) * along + share * points
    field = FlowField.from_triangles(points, triangles, velocity)
    assert field.normal_share == pytest.approx(share, abs=2e-3)


def test_a_plane_is_flat_wherever_it_lies(rng: np.random.Generator) -> None:
    points, triangles = random_plane(rng, 200, grading=1000)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    field = FlowField.from_triangles(points @ turn + [3.0, 1, 7], triangles, points)
    assert field.surface.frame is not None
    # The middle of its box need not lie in its plane.
    part = triangles[points[triangles].max(axis=1)[:, 0] < points[triangles].max(axis=1)[:, 1]]
    half = FlowField.from_triangles(points @ turn, part, points)
    assert half.surface.frame is not None
    assert np.linalg.norm(surface_of(field).crosses, axis=1).sum() == pytest.approx(2)
    sizes = field.surface.cell_size
    assert sizes.max() > 30 * sizes.min()


@property_test(40)
@given(st.integers(0, 10**6))
def test_a_point_of_the_surface_is_found_again(seed: int) -> None:
    rng = np.random.default_rng(seed)
    meshes = (sphere(3), cube(5), random_plane(rng, 100, grading=300))
    field = rotating(meshes[seed % 3])
    surface = surface_of(field)
    count = len(surface.triangles)
    shares = rng.dirichlet([0.5, 0.5, 0.5], 50)
    index = surface.index_of(rng.integers(0, count, 50), shares)
    points = surface.at(index)
    found, distance = locator(field).nearest(points)
    assert distance.max() < 1e-7
    np.testing.assert_allclose(surface.at(found[:, ::-1]), points, atol=1e-7)


def test_values_at_a_point_are_linear(rng: np.random.Generator) -> None:
    points, triangles = random_plane(rng, 150)
    times = [0.0, 1.0]
    steps = np.stack([np.column_stack([points[:, 1], points[:, 0]]) * t for t in (1.0, 3.0)])
    field = FlowField.from_triangles(
        points, triangles, steps, times=times, scalars={"height": points @ [1.0, 2, 0]}
    )
    at = locate(field, (0.4, 0.7))
    assert at is not None
    values = values_at(field, at, 0.5)
    np.testing.assert_allclose(values.position, [0.4, 0.7, 0], atol=1e-12)
    np.testing.assert_allclose(values.velocity, [1.4, 0.8, 0], atol=1e-12)
    assert values.scalars["height"] == pytest.approx(1.8)


def test_the_speed_on_sharp_edges_is_that_of_the_faces() -> None:
    points, triangles = cube(6)
    field = FlowField.from_triangles(points, triangles, np.tile([1.0, 1.0, 0.0], (len(points), 1)))
    on_side = np.abs(np.abs(field.points[0, :, :2]).max(axis=1) - 1) < 1e-9
    upright = on_side & (np.abs(field.points[0, :, 2]) < 0.9)
    # Every side of the cube shows one of the two components, and so does the edge between two.
    np.testing.assert_allclose(
        field.speed[0, 0, upright][field.speed[0, 0, upright] > 1e-9], 1, atol=1e-9
    )
    assert field.speed.max() == pytest.approx(np.sqrt(2))
