"""Any field that is taken is drawn: finite textures, uniforms and pixels."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from strategies import field_arguments, field_of, property_test, setting_values

import flowtex
from flowtex import FlowField
from flowtex._util.colours import NO_COLOURS, ColourScale
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu.render import render
from flowtex.rendering.mesh_levels import MeshLevels
from flowtex.rendering.structure import STRUCTURE
from flowtex.rendering.uniforms import ViewState, uniforms
from flowtex.rendering.webgl.client_data import ClientData, Colours
from flowtex.scene.options import Appearance
from flowtex.scene.scene import Scene
from flowtex.settings import Settings

SIZE = (15, 10)
HALF_MAX = 65504  #: Greatest number in half precision.


def numbers(value: Any) -> list[float]:
    """Check the type of a uniform, and return its numbers."""
    values = value if isinstance(value, (tuple, list)) else [value]
    assert all(type(v) in (bool, int, float) for v in values), value
    return [float(v) for v in values]


def check_picture(scene: Scene) -> None:
    textures, field = scene.textures, scene.field
    for step in range(len(field.times)):
        assert (np.abs(textures.layers(step)) <= HALF_MAX).all()
    camera = Camera.fit(field.surface, SIZE[0] / SIZE[1])
    picture = render(textures, scene.settings, camera, SIZE)
    assert np.isfinite(picture.value[picture.covered]).all()
    assert picture.rgb().shape == (*SIZE[::-1], 3)
    view = ViewState(time=float(field.times[-1]), clock=1e9, focus=np.full(3, 1e30))
    for name, value in uniforms(textures, scene.settings, view).items():
        assert np.isfinite(np.array(numbers(value), np.float32)).all(), name


#: Parts for a browser whose numbers may be unknown, or, of a level that must not be drawn, endless.
UNBOUNDED = ("mesh", "scalars")


def check_client(scene: Scene) -> None:
    """All that a browser gets is finite, but for values that are unknown."""
    field = scene.field
    for name in ("speed", *field.scalars):
        low, high = scene.scalar_range(name)
        assert low < high
        values = scene.scalar(name)[None]
        client = ClientData(
            scene.textures, Colours(name, values=values, scale=ColourScale(NO_COLOURS, low, high))
        )
        json.dumps(client.header(scene.settings), allow_nan=False)
        parts = client.surface() | client.step(client.steps - 1)
        bounded = {key: part for key, part in parts.items() if key.split("/")[0] not in UNBOUNDED}
        assert all(np.isfinite(part).all() for part in bounded.values())
    levels = MeshLevels(field.surface.points, field.surface.cells, field.periodic)
    assert len(levels.triangles(levels.levels(None, 0.1 * field.surface.extent, 100)))


def fitting(values: dict[str, Any], field: FlowField) -> dict[str, Any]:
    """Leave out the structure of a sign-free field and nullclines of a curved one: it has none."""
    absent = (
        STRUCTURE if field.sign_free else ("nullclines",) if field.surface.frame is None else ()
    )
    return {k: v for k, v in values.items() if k not in absent}


def far_node(size: float, step: float, far: int, lost: tuple[int, int]) -> dict[str, Any]:
    """Arguments of a field with a node far from all others, and one without a position."""
    x, y = np.meshgrid(-size + step * np.arange(5), -size + step * np.arange(2))
    x[0, far], x[lost] = 0.0, np.nan
    points = np.stack([x, y, np.full_like(x, -size)], axis=-1)
    velocity = np.random.default_rng(0).standard_normal(points.shape)
    return {"points": points, "velocity": velocity, "periodic": None, "sign_free": False}


@property_test(15, fuzz=30)
@example(far_node(1e6, 0.25, 0, (1, 1)), {"resolution": 16})
@example(far_node(1e18, 5e11, 1, (0, 0)), {"resolution": 16})
@given(field_arguments(), setting_values())
def test_any_field_is_drawn_with_numpy_and_goes_to_a_browser(
    arguments: dict[str, Any], values: dict[str, Any]
) -> None:
    field = field_of(arguments)
    if field is None:
        return
    scene = Scene(field, Settings(**fitting(values, field)))
    check_picture(scene)
    check_client(scene)


# A surface a million times as wide as high is thinner than a pixel.
@pytest.mark.filterwarnings("ignore:The surface is outside|lines is|cells of this grid turn")
@property_test(8)
@given(field_arguments(), setting_values())
def test_any_field_is_drawn_with_vtk(
    opengl: object, arguments: dict[str, Any], values: dict[str, Any]
) -> None:
    field = field_of(arguments)
    if field is None:
        return
    with np.errstate(all="ignore"):  # PyVista's and Matplotlib's own
        pixels = np.asarray(flowtex.render(field, size=SIZE, **fitting(values, field)))
    assert pixels.shape[:2] == SIZE[::-1]


def field_from(points: Any, **options: Any) -> FlowField:
    points = np.asarray(points, dtype=float)
    return FlowField.from_arrays(points, np.roll(points, 1, axis=-1) + 1, **options)


def test_nodes_that_have_collapsed_inside_of_a_surface_have_a_normal() -> None:
    x, y = np.meshgrid(np.arange(5.0), np.arange(5.0))
    points = np.stack([x, y, np.sin(x)], axis=-1)
    points[1:4, 1:4] = points[2, 2]
    check_picture(Scene(field_from(points)))


def test_four_nodes_are_drawn_by_time_also_at_rest() -> None:
    corners = np.stack(np.meshgrid([0.0, 1.0], [0.0, 1.0]), axis=-1)
    with pytest.warns(UserWarning, match="velocity is zero"):
        rest = FlowField.from_arrays(corners, np.zeros((2, 2, 2)))
    for field in (rest, FlowField.from_arrays(corners, np.ones((2, 2, 2)))):
        check_picture(Scene(field, Settings(parameter="time")))


def test_a_ring_of_two_lines_has_image_coordinates() -> None:
    x, y = np.meshgrid([0.0, 1.0, 0.0], np.arange(4.0))
    points = np.stack([x, y], axis=-1)
    look = Appearance.of(image=np.ones((2, 2)))
    check_picture(Scene(field_from(points, periodic="i"), Settings(noise="image"), look))


def test_a_moment_far_from_the_first_has_a_clock() -> None:
    points = np.stack(np.meshgrid(np.arange(4.0), np.arange(4.0)), axis=-1)
    velocity = np.ones((2, 4, 4, 2))
    scene = Scene(FlowField.from_arrays(points, velocity, times=[0.0, 1e60]))
    check_picture(scene)
    values = uniforms(scene.textures, scene.settings, ViewState(time=1e60))
    assert max(values["u_clock"]) <= 4096


@pytest.mark.parametrize("size", [1e-200, 1e300])
def test_scalars_of_any_size_are_coloured(size: float) -> None:
    points = np.stack(np.meshgrid(np.arange(4.0), np.arange(4.0)), axis=-1)
    check_client(Scene(field_from(points, scalars={"s": size * (points[..., 0] - 1.5)})))


@pytest.mark.parametrize("size", [1e-12, 1e12])
def test_a_picture_does_not_depend_on_the_unit_of_length(size: float) -> None:
    points = np.stack(np.meshgrid(np.linspace(0, 1, 8), np.linspace(0, 1, 8)), axis=-1)
    size = 2.0 ** np.rint(np.log2(size))
    velocity = np.roll(points, 1, axis=-1) - [0.3, 0.6]
    pictures = []
    for unit in (1.0, size):
        field = FlowField.from_arrays(points * unit, velocity * 1e40 / unit)
        camera = Camera.fit(field.surface, 1.5)
        pictures.append(render(Scene(field).textures, Settings(), camera, SIZE).value)
    np.testing.assert_allclose(pictures[0], pictures[1], atol=1e-3)
