from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest
from flows import fountain, gyre, lines, swinging
from scipy import ndimage

from flowtex import FlowField, quality
from flowtex._util.array_types import Floats
from flowtex.field.locate import locator
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu.render import Picture, render
from flowtex.rendering.uniforms import ViewState, is_sparse
from flowtex.scene.scene import Scene
from flowtex.settings import Settings

SIZE = (120, 80)
BORDER = quality.SENSE_WINDOW // 2  #: Pixels along the border that are not judged.


@cache
def still(make: Callable[[], FlowField], zoom: float) -> Picture:
    return picture(make().at_step(0), zoom)


def picture(field: FlowField, zoom: float, clock: float = 0.0, **settings: Any) -> Picture:
    scene = Scene(field, Settings(texture="streaklets", grain=1.5, **settings))
    x, y, _ = field.surface.center + 0.11 * field.surface.extent
    camera = Camera((x, y, 5), (x, y, 0), (0, 1, 0), parallel=True, parallel_scale=0.6 / zoom)
    view = ViewState(clock=clock)
    return render(scene.textures, scene.settings, camera, SIZE, view=view)


def sense(drawn: Picture, velocity: Floats) -> float:
    covered = ndimage.binary_erosion(drawn.covered, iterations=2)
    judged = np.pad(covered[BORDER:-BORDER, BORDER:-BORDER], BORDER)
    return quality.sense(drawn.value, velocity[..., 0], velocity[..., 1], judged)


def velocity_of(field: FlowField, drawn: Picture) -> Floats:
    index, _ = locator(field).nearest(np.nan_to_num(drawn.position).reshape(-1, 3))
    components = (
        ndimage.map_coordinates(part, index.T, order=1)
        for part in np.moveaxis(field.velocity[0], -1, 0)
    )
    return np.stack(list(components), axis=-1).reshape(*drawn.covered.shape, 3)


@pytest.mark.parametrize(
    ("make", "zoom", "least"),
    [
        (gyre, 1, 0.9),  # rings around the centres have no head
        (gyre, 4, 0.99),
        (gyre, 1024, 0.99),
        (swinging, 32, 0.95),
    ],
)
def test_a_still_tells_which_way_the_flow_goes(
    make: Callable[[], FlowField], zoom: float, least: float
) -> None:
    field, drawn = make().at_step(0), still(make, zoom)
    velocity = velocity_of(field, drawn)
    assert sense(drawn, velocity) > least
    if zoom == 32:
        turned = FlowField.from_arrays(field.points, -field.velocity[0])
        assert sense(picture(turned, zoom), velocity) < 0.05


@pytest.mark.parametrize(
    ("field", "zoom", "settings"),
    [
        (gyre(), 4, {"motion": "uniform"}),
        (gyre(), 64, {"motion": "speed"}),
        (swinging(), 16, {}),  # grains of a flow that varies in time move with it
        (swinging(), 16, {"lines": "streamlines"}),
    ],
)
def test_so_do_those_in_motion(field: FlowField, zoom: float, settings: dict[str, Any]) -> None:
    drawn = picture(field, zoom, clock=0.3, **settings)
    velocity = velocity_of(field, drawn)
    assert sense(drawn, velocity) > 0.9
    # Streaks, and not dots: the texture changes more across the flow than along it.
    along, across = slopes(drawn, velocity)
    assert across > 2 * along


def slopes(drawn: Picture, velocity: Floats) -> tuple[float, float]:
    """Mean change of a texture along the flow and across it, by pixel."""
    up, right = np.gradient(np.where(drawn.covered, drawn.value, 0.0))
    u, v = np.moveaxis(velocity[..., :2] / np.linalg.norm(velocity, axis=-1, keepdims=True), -1, 0)
    inside = ndimage.binary_erosion(drawn.covered, iterations=2)
    pair = (right * u - up * v, right * v + up * u)  # rows go down
    along, across = (float(np.abs(change[inside]).mean()) for change in pair)
    return along, across


def test_streaklets_are_sparse_and_bright() -> None:
    dense = Scene(gyre(), Settings())
    drawn = still(gyre, 1)
    value = drawn.value[drawn.covered]
    assert value.mean() == pytest.approx(0.0, abs=0.2)
    assert value.std() == pytest.approx(1.0, abs=0.2)
    # Most of the picture is ground, and a few strokes are far brighter than it.
    assert np.median(value) < -0.3
    assert np.percentile(value, 99) > 3.0
    assert not is_sparse(dense.textures, dense.settings)


@pytest.mark.parametrize("zoom", [4.0, 4.76])  # of one octave, and between two
def test_streaklets_lie_at_even_distances(zoom: float) -> None:
    drawn = still(gyre, zoom)
    assert drawn.covered.all()
    inner = (slice(15, -15), slice(15, -15))
    cloud = ndimage.gaussian_filter(drawn.value, 12)[inner].std() / drawn.value.std()
    assert cloud < 0.08  # independent draws: 0.15 and more


def test_a_field_without_a_sign_has_strokes_without_a_head() -> None:
    field = lines()
    drawn = picture(field, 1)
    share = sense(drawn, velocity_of(field, drawn))
    assert 0.2 < share < 0.8


@pytest.mark.parametrize("seed", [1344, 1927, 2368])  # whose grain at the source itself is bright
def test_a_bright_grain_in_a_source_makes_no_disc(seed: int) -> None:
    scene = Scene(fountain(), Settings(texture="streaklets", seed=seed))
    camera = Camera((0.3125, 0.25, 5), (0.3125, 0.25, 0), (0, 1, 0), True, 0.15)
    value = render(scene.textures, scene.settings, camera, (40, 40)).value
    away = np.hypot(*(np.indices(value.shape) - 19.5))
    # All paths pass it, of two sides as long as twelve samples.
    assert (value[(away > 5) & (away < 12)] > 1).mean() < 0.3
