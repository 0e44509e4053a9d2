"""Textures less their local mean: even pictures, of the same contrast everywhere, without seams."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from flows import gyre
from scipy.ndimage import distance_transform_edt, gaussian_filter, uniform_filter

import flowtex
from flowtex._util.array_types import Bools, Floats
from flowtex.app.streaming.viewport import Viewport
from flowtex.rendering.cpu.even import local_mean
from flowtex.rendering.cpu.shade import mean_colours
from flowtex.rendering.even import EvenBlocks
from flowtex.settings import Settings

WIDE = 12.0  #: Deviation of the blur that shows clouds, in pixels.
EDGE = 20  #: Pixels at the edges of a picture that are left out.


def ball() -> Any:
    """Return a sphere with a flow around an axis that wavers."""
    mesh: Any = pv.Sphere(theta_resolution=60, phi_resolution=60)
    x, y, z = mesh.points.T
    velocity = np.column_stack([0.3 * np.sin(6 * z) - y, x, 0.4 * np.cos(5 * x)])
    normal = mesh.points / np.linalg.norm(mesh.points, axis=1, keepdims=True)
    across = (velocity * normal).sum(axis=1, keepdims=True)
    mesh["velocity"] = velocity - across * normal
    return mesh


def grey_of(flow: Any, **options: Any) -> Floats:
    """Draw a flow in one colour and without lights."""
    drawn = flowtex.render(flow, scalars=False, lighting=False, **options)
    return np.asarray(drawn[..., :3].mean(axis=-1))


def cloud(grey: Floats, seen: Bools) -> float:
    """Return the deviation of the picture's blur over its own, away from edges."""
    share = gaussian_filter(seen.astype(float), WIDE)
    blurred = gaussian_filter(np.where(seen, grey, 0.0), WIDE) / np.maximum(share, 1e-6)
    inner = distance_transform_edt(np.pad(seen, 1))[1:-1, 1:-1] > EDGE
    return float(blurred[inner].std() / grey[inner].std())


@pytest.mark.parametrize("grain", [0.6, 1.0, 1.5, 2.0, 3.0, 4.5, 7.0])
def test_local_mean_is_over_two_grains(grain: float) -> None:
    side = 2 * int(15 * grain) + 31
    rows, columns = np.indices((side, side)) - side // 2
    variances = []
    for aside in range(4):
        impulse = np.zeros((side, side))
        impulse[side // 2 + aside, side // 2 - aside] = 1.0
        weights = local_mean(impulse, grain)
        assert weights.sum() == pytest.approx(1.0, rel=0.06)
        variances += [
            (weights * (columns + aside) ** 2).sum(),
            (weights * (rows - aside) ** 2).sum(),
        ]
    # The blur ends a little early.
    assert np.sqrt(np.mean(variances)) == pytest.approx(2 * grain, rel=0.08)


@pytest.mark.parametrize("shift", [(0, 0), (5, 3), (-9, 2)])
def test_blocks_stay_where_they_are_in_the_picture(shift: tuple[int, int]) -> None:
    blocks = EvenBlocks.of(1.5, (14, 50, 17, 60), shift=shift)
    first, by = np.array(blocks.first), np.array(shift)
    assert blocks.side == 4
    np.testing.assert_array_equal((first + by) % blocks.side, 0)
    assert (first <= (14, 17)).all()
    assert (first + blocks.side > (14, 17)).all()
    assert (first + (np.array(blocks.size) - 2) * blocks.side >= (50, 60)).all()


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize("zoom", [3.0, 16.0, 1024.0])
def test_picture_of_a_plane_is_even(zoom: float) -> None:
    grey = grey_of(gyre(), size=(320, 240), zoom=zoom, focus=(0.7, 0.4))
    seen = np.ones(grey.shape, dtype=bool)
    assert cloud(grey, seen) < 0.04


def covered(flow: Any, **options: Any) -> tuple[Floats, Bools]:
    """Draw a flow, and return which pixels it covers wholly."""
    light = grey_of(flow, background="white", **options)
    dark = grey_of(flow, background="black", **options)
    return light, (np.abs(light - dark) < 1.5) & (light < 250)


def apart(grey: Floats, seen: Bools) -> Floats:
    """Return how far each pixel is from the mean of its neighbours that are seen."""
    count = 9.0 * uniform_filter(seen.astype(float), 3) - seen
    total = 9.0 * uniform_filter(np.where(seen, grey, 0.0), 3) - np.where(seen, grey, 0.0)
    return grey - total / np.maximum(count, 1.0)


def doughnut() -> pv.StructuredGrid:
    """Return a torus with a flow around its axis and through its hole."""
    around, across = np.meshgrid(np.linspace(0, 2 * np.pi, 121), np.linspace(0, 2 * np.pi, 61))
    radius = 1.0 + 0.5 * np.cos(across)
    x = radius * np.cos(around)
    y = radius * np.sin(around)
    mesh = pv.StructuredGrid(x, y, 0.5 * np.sin(across))
    ahead = np.stack([-np.sin(around), np.cos(around), 0 * around], axis=-1)
    up = [-np.sin(across) * np.cos(around), -np.sin(across) * np.sin(around), np.cos(across)]
    velocity = ahead + 0.4 * np.sin(3 * x)[..., None] * np.stack(up, axis=-1)
    mesh["velocity"] = velocity.reshape(-1, 3, order="F")
    return mesh


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize("body", [ball, doughnut])
def test_picture_of_a_body_is_even_up_to_its_outline(body: Callable[[], Any]) -> None:
    # Pixels that the body covers in part are mixed with the ground.
    grey, seen = covered(body(), size=(640, 640))
    assert cloud(grey, seen) < 0.05
    inwards = distance_transform_edt(np.pad(seen, 1))[1:-1, 1:-1]
    inside = grey[inwards > 20].std()
    for least, most in ((1, 3), (3, 6), (6, 10)):
        band = (inwards > least) & (inwards <= most)
        assert 0.9 < grey[band].std() / inside < 1.15


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize("body", [ball, doughnut])
def test_outline_of_a_body_has_no_dots(body: Callable[[], Any]) -> None:
    grey, seen = covered(body(), size=(480, 480))
    inwards = distance_transform_edt(np.pad(seen, 1))[1:-1, 1:-1]
    noise = apart(grey, seen)
    outermost = noise[(inwards > 0) & (inwards < 1.5)].std()
    # With dots it is 1.6 to 2.0 times as large.
    assert outermost < 1.5 * noise[inwards > 20].std()


def slanted(degrees: float) -> Any:
    """Return a plane that is seen at an angle, with a flow across the view."""
    mesh: Any = pv.Plane(i_size=4.0, j_size=4.0, i_resolution=20, j_resolution=20)
    mesh["velocity"] = np.tile([1.0, 0.0, 0.0], (mesh.n_points, 1))
    plotter: Any = pv.Plotter(off_screen=True, window_size=[320, 160])
    plotter.disable_anti_aliasing()
    plotter.flowtex.add(mesh, scalars=False, show_scalar_bar=False, lighting=False)
    height = np.sin(np.radians(degrees))
    plotter.camera_position = [
        (0, -10 * np.cos(np.radians(degrees)), 10 * height),
        (0, 0, 0),
        (0, 0, 1),
    ]
    plotter.enable_parallel_projection()
    # The plane fills the picture.
    plotter.camera.parallel_scale = 0.9 * min(2.0 * height, 1.0)
    with closing(plotter):
        return shown(plotter)[..., 0]


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize("degrees", [30.0, 12.0])
def test_streaks_across_the_view_are_as_wide_and_even_where_seen_aslant(degrees: float) -> None:
    facing = slanted(90.0)
    aslant = slanted(degrees)
    assert aslant.std() == pytest.approx(facing.std(), rel=0.06)

    def alike(grey: Floats) -> float:
        return float(np.corrcoef(grey[1:].ravel(), grey[:-1].ravel())[0, 1])

    # Streaks of half the width have neighbours that are nearly independent (0.42 less).
    assert alike(aslant) > alike(facing) - 0.18


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize(
    "changed",
    [{"samples": 1}, {"samples": 15}, {"kernel": "box"}, {"grain": 3.0}, {"spacing": 0.4}],
)
def test_contrast_is_that_of_other_textures(changed: dict[str, Any]) -> None:
    view = {"size": (240, 180), "zoom": 4.0}
    usual, other = grey_of(gyre(), **view), grey_of(gyre(), **view, **changed)
    assert other.std() == pytest.approx(usual.std(), rel=0.06)


@pytest.mark.usefixtures("opengl")
def test_mean_colour_is_that_of_the_colour_bar() -> None:
    drawn = flowtex.render(gyre(), size=(320, 240), zoom=4.0, scalars=False, color="#6688aa")
    table = np.array([[0x66, 0x88, 0xAA, 255]], dtype=np.uint8)
    expected = mean_colours(table, Settings())[0, :3]
    mean = np.asarray(drawn, float)[..., :3].mean(axis=(0, 1))
    np.testing.assert_allclose(mean, expected.astype(float), atol=1.0)


def shown(plotter: Any, **options: Any) -> Floats:
    return np.asarray(plotter.screenshot(return_img=True, **options), float)[..., :3]


def plotter_of(mesh: Any, size: list[int], **options: Any) -> Any:
    plotter: Any = pv.Plotter(off_screen=True, window_size=size, **options)
    plotter.disable_anti_aliasing()
    plotter.flowtex.add(mesh, show_scalar_bar=False, samples=15)
    plotter.camera_position = "iso"
    return plotter


@pytest.mark.usefixtures("opengl")
def test_parts_of_a_large_picture_join_without_a_seam() -> None:
    with closing(plotter_of(ball(), [151, 121])) as plotter:
        joined = shown(plotter, scale=2)
    with closing(plotter_of(ball(), [302, 242])) as plotter:
        whole = shown(plotter)
    assert np.abs(joined - whole).max(axis=-1).mean() < 0.05


@pytest.mark.usefixtures("opengl")
def test_parts_of_an_app_join_without_a_seam() -> None:
    view = Viewport(gyre(), samples=15, zoom=2.0)
    view.resize(200, 150)
    whole = view.draw(200, 150).astype(int)
    joined = np.zeros((150, 200, 3), dtype=np.uint8)
    for _ in view.draw_tiles(joined, 4, side=64):
        pass
    assert np.abs(joined - whole).max() <= 2


@pytest.mark.usefixtures("opengl")
def test_neighbouring_renderers_do_not_mix() -> None:
    with closing(plotter_of(ball(), [240, 160], shape=(1, 2), border=False)) as plotter:
        plotter.camera.zoom(8)
        plotter.subplot(0, 1)
        plotter.flowtex.add(ball(), show_scalar_bar=False, samples=15)
        plotter.camera_position = "iso"
        plotter.camera.zoom(8)
        both = shown(plotter)
    with closing(plotter_of(ball(), [120, 160])) as plotter:
        plotter.camera.zoom(8)
        one = shown(plotter)
    assert np.abs(both[:, :120] - one).max() <= 2
    assert np.abs(both[:, 120:] - one).max() <= 2
