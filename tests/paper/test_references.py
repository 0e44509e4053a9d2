"""The methods of the paper's related work: symmetries, exact solutions, and their known faults."""

from __future__ import annotations

import numpy as np
import pytest
from measures import streaks
from numpy.typing import NDArray

from flowtex import FlowField
from flowtex.rendering.camera import Camera
from paper.references import ImageSpace, draw_texture, forssell_lic, lic

Floats = NDArray[np.float64]
KERNELS = ("box", "hann")


def swirl(rows: int = 41, columns: int = 53) -> Floats:
    """A flow of all directions, with no vectors opposed along an edge but by chance."""
    y, x = np.mgrid[-1 : 1 : rows * 1j, -1 : 1 : columns * 1j]
    return np.stack([0.3 - y + 0.2 * x, x + 0.5 * y * x], axis=-1)


def noise(rng: np.random.Generator, *shape: int) -> Floats:
    return rng.standard_normal(shape)


# --- LIC ------------------------------------------------------------------------------------


@pytest.mark.parametrize("kernel", KERNELS)
def test_lic_has_the_symmetries_of_its_image(kernel: str, rng: np.random.Generator) -> None:
    v, n = swirl(), noise(rng, 41, 53)
    plain = lic(v, n, 15.0, kernel)
    turned = np.swapaxes(v, 0, 1)[..., ::-1]
    np.testing.assert_allclose(lic(turned, n.T, 15.0, kernel).T, plain, atol=1e-9)
    mirrored = lic(v[:, ::-1] * [-1, 1], n[:, ::-1], 15.0, kernel)
    np.testing.assert_allclose(mirrored[:, ::-1], plain, atol=1e-9)
    np.testing.assert_allclose(lic(-v, n, 15.0, kernel), plain, atol=1e-12)
    np.testing.assert_allclose(lic(7 * v, n, 15.0, kernel), plain, atol=1e-9)
    np.testing.assert_allclose(lic(v, 2 * n + 1, 15.0, kernel), 2 * plain + 1, atol=1e-12)


@pytest.mark.parametrize("axis", [0, 1])
def test_lic_of_a_straight_flow_is_a_convolution(axis: int, rng: np.random.Generator) -> None:
    n = noise(rng, 30, 30)
    v = np.zeros((30, 30, 2))
    v[..., 1 - axis] = 3.0
    result = lic(v, n, 6.0, "box", periodic=(True, True))
    # A box 6 long covers five pixels and half of two more.
    parts = [(k, 0.5 if abs(k) == 3 else 1.0) for k in range(-3, 4)]
    expected = sum(w * np.roll(n, k, axis=axis) for k, w in parts)
    np.testing.assert_allclose(result, np.asarray(expected) / 6, atol=1e-12)


# --- Forssell and Cohen ---------------------------------------------------------------------


Shot = tuple[Camera, tuple[int, int]]  #: A camera, and width and height of its picture in pixels.


def sheet(x: Floats, y: Floats, velocity: tuple[float, float] = (1.0, 0.0)) -> FlowField:
    """A flat grid of lines at x and y."""
    points = np.stack(np.meshgrid(x, y), axis=-1)
    return FlowField.from_arrays(points, np.broadcast_to(velocity, points.shape), periodic="")


def above(x: float, y: float, size: tuple[int, int], height: float) -> Shot:
    """Straight view of the x-y plane, x to the right and y up."""
    return Camera((x, y, 5.0), (x, y, 0.0), (0, 1, 0), True, height / 2), size


def test_computational_space_knows_nothing_of_the_surface() -> None:
    v = swirl(21, 31)
    points = np.stack(np.meshgrid(np.arange(31.0), np.arange(21.0)), axis=-1)
    flat = FlowField.from_arrays(points, v, periodic="")
    linear = np.array([[2.0, 0.3], [-0.5, 0.1], [0.7, 1.0]])
    bent = FlowField.from_arrays(points @ linear.T, v @ linear.T, periodic="")
    one, other = (forssell_lic(f, (40, 60), 12.0) for f in (flat, bent))
    np.testing.assert_allclose(one, other, atol=1e-9)
    # With texels that are square on the surface it is LIC of the image.
    fine = forssell_lic(flat, (20, 30), 12.0, seed=5)
    middle = 0.25 * (v[1:, 1:] + v[:-1, 1:] + v[1:, :-1] + v[:-1, :-1])
    white = np.random.default_rng(5).standard_normal((20, 30))
    np.testing.assert_allclose(fine, lic(middle, white, 12.0), atol=1e-9)


def test_a_texture_lies_on_its_surface() -> None:
    field = sheet(np.linspace(0, 6, 13), np.linspace(0, 4, 9))
    texture = np.arange(24.0).reshape(4, 6)
    shot = above(3, 2, (80, 60), 6.0)
    squares = draw_texture(texture, field, *shot, smooth=False)
    assert np.isnan(squares[:10]).all()
    assert np.isnan(squares[:, :10]).all()
    np.testing.assert_array_equal(squares[45:50, 12:18], 0.0)
    # Each texel is ten pixels wide, and row 0 of the texture is at the bottom.
    np.testing.assert_array_equal(squares[10:50, 10:70][::-10, ::10], texture)
    smooth = draw_texture(texture, field, *shot)
    middle = smooth[15:45, 15:65]
    np.testing.assert_allclose(np.diff(middle, axis=1), 0.1, atol=1e-9)
    np.testing.assert_allclose(np.diff(middle, axis=0), -0.6, atol=1e-9)


# --- in the image ---------------------------------------------------------------------------

PLAIN = sheet(np.linspace(-40, 40, 9), np.linspace(-40, 40, 9))


def rolled(degrees: float, size: tuple[int, int] = (120, 120), height: float = 40.0) -> Shot:
    a = np.radians(degrees)
    up = (float(np.sin(a)), float(np.cos(a)), 0.0)
    return Camera((0, 0, 5), (0, 0, 0), up, True, height / 2), size


def judged(images: ImageSpace, picture: Floats) -> dict[str, float]:
    mask = np.zeros(picture.shape, bool)
    mask[20:-20, 20:-20] = True
    return streaks(picture, images.way[..., 0], -images.way[..., 1], mask)


@pytest.mark.parametrize("degrees", [0, 30, 135])
def test_streaks_have_the_direction_of_the_flow(degrees: float) -> None:
    images = ImageSpace(*rolled(degrees), PLAIN)
    result = judged(images, images.frames(40))
    assert result["angle"] < 5
    assert result["coherence"] > 0.55
