"""The camera: what it fits, how it moves, and what it refuses."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from camera_moves import rotate, zoom_by
from earth_fields import ocean, winds
from flows import gyre, torus

from flowtex import FlowField
from flowtex.field.earth.projection import Projection
from flowtex.rendering.camera import CAMERA_LIMITS, Camera, can_share_camera

ASPECT = 1.6
ASIDE = Camera((2.4, -1.9, 1.5), (0.1, 0.2, -0.1), (0.0, 0.6, 0.8), view_angle=25.0)
STRAIGHT = Camera((1.0, 0.5, 5.0), (1.0, 0.5, 0.0), (0.0, 1.0, 0.0), True, 0.6)


def vtk_camera(camera: Camera) -> Any:
    from vtkmodules.vtkRenderingCore import vtkCamera

    from flowtex.rendering.camera import apply_camera

    result = vtkCamera()
    apply_camera(camera, result)
    return result


def test_a_globe_is_seen_from_above_its_data_with_north_up() -> None:
    projection = Projection("globe")

    def seen(camera: Camera) -> tuple[float, float]:
        lon, lat = projection.lonlat(np.array(camera.position))
        return float(lon), float(lat)

    whole = Camera.fit(winds().surface, ASPECT)
    assert seen(whole) == pytest.approx((0, 20))
    assert whole.up == (0, 0, 1)
    part = Camera.fit(ocean().surface, ASPECT)
    assert seen(part) == pytest.approx((6, -20), abs=1.5)  # the middle of what is not a land
    assert part.axes[1][2] > 0.9
    for lat in (90.0, -90.0):
        pole = projection.positions(np.array(0.0), np.array(lat))
        camera = Camera.fit(winds().surface, ASPECT, focus=pole)
        below = camera.project(projection.positions(np.array(0.0), np.array(0.7 * lat)), ASPECT)
        assert below == pytest.approx([0, -abs(below[1]) if lat > 0 else abs(below[1])], abs=1e-9)
    aside = Camera.fit(winds().surface, ASPECT, toward=(0, 1, 0), up=(1, 0, 0))
    assert aside.position[1] > 0 and aside.up == (1, 0, 0)


@pytest.mark.parametrize("camera", [ASIDE, STRAIGHT])
def test_vtk_takes_and_gives_it_back(camera: Camera) -> None:
    from flowtex.rendering.camera import read_camera

    assert read_camera(vtk_camera(camera)) == camera


def test_a_camera_turned_over_a_pole_is_read_as_it_looks() -> None:
    from vtkmodules.vtkRenderingCore import vtkCamera

    from flowtex.rendering.camera import apply_camera, read_camera

    turned, again = vtkCamera(), vtkCamera()
    turned.SetPosition(0, 0, 3)
    for _ in range(5):
        turned.Elevation(20)
    apply_camera(read_camera(turned), again)
    seen = [
        [camera.GetModelViewTransformMatrix().GetElement(row, column) for column in range(4)]
        for camera in (turned, again)
        for row in range(3)
    ]
    assert np.array(seen[:3]) == pytest.approx(np.array(seen[3:]))


@pytest.mark.parametrize("camera", [ASIDE, STRAIGHT])
@pytest.mark.parametrize(("dx", "dy"), [(0.3, 0.0), (0.0, -0.4), (-0.7, 0.2)])
def test_a_turn_is_that_of_vtk(camera: Camera, dx: float, dy: float) -> None:
    other = vtk_camera(camera)
    other.Azimuth(-90 * dx * ASPECT)
    other.Elevation(-90 * dy)
    other.OrthogonalizeViewUp()
    turned = rotate(camera, dx, dy, ASPECT)
    assert turned.position == pytest.approx(other.GetPosition(), abs=1e-12)
    assert turned.focal_point == camera.focal_point
    assert turned.up == pytest.approx(other.GetViewUp(), abs=1e-12)


@pytest.mark.parametrize("camera", [ASIDE, STRAIGHT])
def test_the_matrix_is_that_of_vtk(camera: Camera) -> None:
    other = vtk_camera(camera)
    other.SetClippingRange(0.01, 100.0)
    matrix = other.GetCompositeProjectionTransformMatrix(ASPECT, -1, 1)
    theirs = np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)])
    ours = camera.matrix(ASPECT)
    for point in np.random.default_rng(1).uniform(-0.8, 0.8, (20, 3)):
        a, b = ours @ [*point, 1.0], theirs @ [*point, 1.0]
        assert a[:2] / a[3] == pytest.approx(b[:2] / b[3], abs=1e-9)
        assert camera.project(point, ASPECT) == pytest.approx(a[:2] / a[3], abs=1e-12)


@pytest.mark.parametrize("camera", [ASIDE, STRAIGHT])
def test_what_lies_on_a_ray_is_seen_where_the_ray_was_sent(camera: Camera) -> None:
    start, along = camera.ray(0.4, -0.7, ASPECT)
    for reach in (0.5, 3.0):
        assert camera.project(start + reach * along, ASPECT) == pytest.approx((0.4, -0.7))


def test_points_behind_a_camera_in_perspective_have_no_place() -> None:
    behind = np.array(ASIDE.position) - 0.1 * ASIDE.axes[2]
    assert np.isnan(ASIDE.project(behind, ASPECT)).all()


@pytest.mark.parametrize("field", [gyre(), torus()])
@pytest.mark.parametrize("aspect", [0.5, 1.0, 3.0])
def test_the_whole_surface_fits_and_fills(field: Any, aspect: float) -> None:
    surface = field.surface
    places = np.abs(Camera.fit(surface, aspect).project(surface.points[surface.valid], aspect))
    inside = 1 - 2 * CAMERA_LIMITS.margin
    assert places.max() == pytest.approx(inside, abs=0.02)


@pytest.mark.parametrize("field", [gyre(), torus()])
def test_zoom_narrows_the_view(field: Any) -> None:
    focus = tuple(field.surface.points[3, 5])
    near, nearer = (Camera.fit(field.surface, 1.5, zoom=z, focus=focus) for z in (40, 80))
    assert near.focal_point == pytest.approx(focus)
    assert near.height / nearer.height == pytest.approx(2)


@pytest.mark.parametrize("camera", [ASIDE, STRAIGHT])
@pytest.mark.parametrize("factor", [3.0, 0.5])
def test_a_zoom_keeps_the_point_under_the_pointer(camera: Camera, factor: float) -> None:
    start, along = camera.ray(0.5, -0.25, ASPECT)
    target = start + along * 2.0
    closer = zoom_by(camera, factor, 0.5, -0.25, aspect=ASPECT, whole=camera, target=target)
    assert closer.project(target, ASPECT) == pytest.approx((0.5, -0.25), abs=1e-9)
    assert closer.height < camera.height if factor > 1 else closer.height > camera.height


def test_in_perspective_it_comes_closer_and_then_narrows() -> None:
    whole = Camera.fit(torus().surface, ASPECT)
    near = zoom_by(whole, 4, aspect=ASPECT, whole=whole)
    assert near.distance == pytest.approx(whole.distance / 4)
    assert near.view_angle == pytest.approx(CAMERA_LIMITS.view_angle)
    nearest = zoom_by(whole, 64, aspect=ASPECT, whole=whole)
    assert nearest.distance == pytest.approx(whole.distance / CAMERA_LIMITS.closest)
    assert nearest.height == pytest.approx(whole.height / 64)


def test_a_dictionary_holds_it_whole() -> None:
    assert Camera.from_dict(ASIDE.to_dict()) == ASIDE
    changed = Camera.from_dict({"view_angle": 12}, ASIDE)
    assert changed.view_angle == 12
    assert changed.position == ASIDE.position


def test_a_camera_out_of_reach_of_the_surface_is_told() -> None:
    surface = gyre().surface
    camera = Camera.fit(surface)
    assert camera.is_near(surface)
    assert not replace(camera, position=(1e12, 0, 0)).is_near(surface)


def plane(*axes: int, height: float = 0.0) -> FlowField:
    """A square that spans two axes."""
    v, u = np.mgrid[-1:1:5j, -1:1:5j]
    points = np.full((5, 5, 3), height)
    points[..., axes[0]], points[..., axes[1]] = u, v
    velocity = np.zeros((5, 5, 3))
    velocity[..., axes[0]] = 1.0
    return FlowField.from_arrays(points, velocity)


def test_planes_across_each_other_do_not_share_a_camera() -> None:
    first = plane(0, 1).surface
    assert can_share_camera(first, plane(0, 1, height=0.1).surface)
    for axes in ((1, 2), (0, 2)):
        assert not can_share_camera(first, plane(*axes).surface)
