"""A scene tells what a change makes necessary, and makes nothing twice."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import flowtex
from flowtex.field.steps import LazySteps
from flowtex.host.flow_widget import FlowWidget
from flowtex.scene.scene import Scene
from flowtex.settings import Settings
from flowtex.textures.images import ImageError


def field(steps: int = 1) -> flowtex.FlowField:
    y, x = np.mgrid[0:1:9j, 0:2:17j]
    points = np.stack([x, y], axis=-1)
    velocity = np.stack([np.stack([1 + 0 * x, x * k], axis=-1) for k in range(1, steps + 1)])
    times = None if steps == 1 else np.arange(steps) * 2.0
    return flowtex.FlowField.from_arrays(points, velocity, times=times, scalars={"height": y})


@pytest.mark.parametrize(
    ("name", "value", "affects", "textures", "traces"),
    [
        ("samples", 9, "uniform", True, True),
        ("lod", False, "uniform", True, True),
        ("noise", "image", "shader", False, True),
        ("noise", "texture", "shader", False, True),
        ("seed", 3, "uniform", True, True),
        ("parameter", "time", "trace", False, False),
    ],
)
def test_a_change_costs_what_the_table_says(
    name: str, value: object, affects: str, textures: bool, traces: bool
) -> None:
    scene = Scene(field(), image=np.ones((1, 1, 4), np.float32))
    heard: list[str] = []
    before, store = scene.textures, scene.store
    scene.observe(heard.append)
    scene.settings.update(**{name: value})
    assert heard == [affects]
    assert (scene.textures is before) == textures
    assert (scene.store is store) == traces


@pytest.mark.parametrize(("name", "value"), [("seed", 3), ("resolution", 64)])
def test_a_noise_texture_is_made_again_for_a_seed_and_a_resolution(name: str, value: int) -> None:
    scene = Scene(field(), Settings(noise="texture", resolution=32))
    heard: list[str] = []
    before = scene.textures.image
    scene.observe(heard.append)
    scene.settings.update(**{name: value})
    after = scene.textures.image
    assert heard == ["textures"]
    assert before is not None and after is not None
    assert not np.array_equal(before.texels, after.texels)
    assert after.texels.shape == (
        max(scene.settings.resolution // 2, 8),
        scene.settings.resolution,
        1,
    )
    scene.settings.noise = "procedural"
    assert scene.textures.image is None


def test_a_closed_view_hears_nothing() -> None:
    scene = Scene(field())
    heard: list[str] = []
    scene.observe(heard.append)
    scene.close()
    scene.settings.samples = 5
    assert heard == []


def test_time_lies_between_two_steps() -> None:
    scene = Scene(field(3))
    scene.time = 3.0
    assert scene.moment == (1, 2, 0.5)
    x = scene.field.points[..., 0]
    np.testing.assert_allclose(
        scene.scalar("speed"), (np.hypot(1, 2 * x) + np.hypot(1, 3 * x)) / 2, rtol=1e-12
    )
    scene.time = 4.0
    assert scene.moment == (1, 2, 1.0)


def test_only_the_steps_that_are_shown_are_traced() -> None:
    scene = Scene(field(5), Settings())
    scene.textures.layers(3)
    assert 3 in scene.store._cache
    assert len(scene.store._cache) == 1


@pytest.mark.parametrize("image", [np.zeros((2, 2, 7)), "missing.png"])
def test_an_appearance_with_an_image_that_is_refused_changes_nothing(image: object) -> None:
    scene = Scene(field())
    before, shown, heard = scene.appearance, scene.field, list[str]()
    scene.observe(heard.append)
    with pytest.raises(ImageError):
        scene.appearance = replace(before, scalars="vorticity", color="red", image=image)
    assert scene.appearance is before and scene.image is None and heard == []
    assert scene.field is shown
    assert scene.settings.noise == "procedural"


def test_the_first_time_shown_is_when_something_moves() -> None:
    velocity = np.ones((3, 4, 5, 2))
    velocity[0] = 0.0
    y, x = np.mgrid[:4.0, :5.0]
    nodes = np.stack([x, y], axis=-1)
    field = flowtex.FlowField.from_arrays(nodes, velocity, times=[0.0, 2.0, 5.0])
    scene = Scene(field)
    assert scene.time == 2.0
    scene.time = "last"
    assert scene.time == 5.0
    scene.time = "first"
    assert scene.time == 0.0


@pytest.mark.parametrize("lazy", [False, True])
def test_pictures_and_values_have_one_default_time(lazy: bool) -> None:
    """The first time that moves is shown, by a plotter, a widget, a page and `field.at`."""
    grid = np.stack(np.meshgrid(np.linspace(0, 1, 5), np.linspace(0, 1, 4)), axis=-1)
    strength = np.array([0.0, 2.0, 1.0, 1.0, 1.0])
    velocity = strength[:, None, None, None] * np.ones((5, 4, 5, 2))
    steps: Any = velocity
    if lazy:
        steps = LazySteps(5, lambda step: velocity[step])
    field = flowtex.FlowField.from_arrays(grid, steps, times=[0.0, 1.0, 2.0, 3.0, 4.0])
    assert Scene(field).time == field.first_time == 1.0
    value = field.at(0.5, 0.5)
    assert value is not None and value.time == 1.0
    assert value.speed == pytest.approx(np.hypot(2.0, 2.0))
    assert FlowWidget(field).time == 1.0
