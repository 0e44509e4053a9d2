"""The measures of pictures on patterns whose figures are known."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

import flowtex
from flowtex import quality
from paper import measures

Floats = NDArray[np.float64]
SIZE = (160, 200)
EVERYWHERE = np.pad(np.ones((128, 168), bool), 16)


def stripes(degrees: float, wave: float = 8.0) -> tuple[Floats, Floats, Floats]:
    """Lines at an angle to the right, anticlockwise, and the direction along them."""
    rows, columns = np.indices(SIZE)
    a = np.radians(degrees)
    across = columns * np.sin(a) + rows * np.cos(a)
    ones = np.ones(SIZE)
    return np.sin(2 * np.pi * across / wave), ones * np.cos(a), ones * np.sin(a)


def noise(rng: np.random.Generator, *sigma: float) -> Floats:
    return np.asarray(gaussian_filter(rng.standard_normal(SIZE), sigma or 0, mode="wrap"))


@pytest.mark.parametrize("degrees", [0, 20, 45, 90, 135, 170])
def test_lines_are_coherent_and_at_their_angle(degrees: float) -> None:
    picture, u, v = stripes(degrees)
    result = quality.alignment(picture, u, v, EVERYWHERE)
    assert result.coherence > 0.99
    assert result.angle < 1.0
    # Neither length nor sign of the flow counts, and a right angle is the farthest.
    assert quality.alignment(picture, -7 * u, -7 * v, EVERYWHERE) == pytest.approx(result, abs=1e-6)
    assert quality.alignment(picture, -v, u, EVERYWHERE).angle > 89


def test_grain_of_smoothed_noise_is_that_of_its_correlation(rng: np.random.Generator) -> None:
    ones = np.ones(SIZE)
    picture = noise(rng, 1.5, 4.0)  # rows, columns
    # White noise behind a Gaussian has a Gaussian correlation, root two as wide.
    half = np.sqrt(2) * np.sqrt(2 * np.log(2))
    result = quality.grain(picture, ones, 0 * ones, EVERYWHERE)
    assert result.along == pytest.approx(4.0 * half, rel=0.12)
    assert result.across == pytest.approx(1.5 * half, rel=0.12)
    turned = quality.grain(picture, 0 * ones, ones, EVERYWHERE)
    assert turned == pytest.approx((result.across, result.along), rel=0.05)


def streaks(
    rng: np.random.Generator, degrees: float, along: float, across: float
) -> tuple[Floats, Floats, Floats]:
    """Noise with a Gaussian correlation of these widths, at an angle, and the direction of it.

    It is made in the frequency domain, and so without the filters that measure it.
    """
    a = np.radians(degrees)
    down, right = np.meshgrid(np.fft.fftfreq(SIZE[0]), np.fft.fftfreq(SIZE[1]), indexing="ij")
    parallel = right * np.cos(a) - down * np.sin(a)
    normal = right * np.sin(a) + down * np.cos(a)
    gain = np.exp(-2 * np.pi**2 * ((along * parallel) ** 2 + (across * normal) ** 2))
    picture = np.fft.ifft2(gain * np.fft.fft2(rng.standard_normal(SIZE))).real
    ones = np.ones(SIZE)
    return picture / picture.std(), ones * np.cos(a), ones * np.sin(a)


@pytest.mark.parametrize("degrees", [0, 30, 75, 120])
@pytest.mark.parametrize(("along", "across"), [(4.0, 1.0), (6.0, 1.5)])
def test_streaks_have_their_angle_and_their_width(
    rng: np.random.Generator, degrees: float, along: float, across: float
) -> None:
    picture, u, v = streaks(rng, degrees, along, across)
    aside = np.radians(10)
    turned_u = u * np.cos(aside) - v * np.sin(aside)
    turned_v = u * np.sin(aside) + v * np.cos(aside)
    straight = quality.alignment(picture, u, v, EVERYWHERE)
    turned = quality.alignment(picture, turned_u, turned_v, EVERYWHERE)
    assert straight.angle < 7
    assert straight.coherence > 0.75
    assert turned.angle == pytest.approx(10, abs=3)
    half = np.sqrt(2) * np.sqrt(2 * np.log(2))
    found = quality.grain(picture, u, v, EVERYWHERE)
    assert found.along == pytest.approx(along * half, rel=0.15)
    assert found.across == pytest.approx(across * half, rel=0.15)


def test_cloud_is_the_share_of_slow_shades(rng: np.random.Generator) -> None:
    picture, _, _ = streaks(rng, 30, 4.0, 1.0)
    rows, columns = np.indices(SIZE)
    shade = np.sqrt(2) * np.sin(2 * np.pi * columns / SIZE[1])
    # White noise behind a Gaussian has a variance in inverse proportion to its widths.
    left = np.sqrt(4.0 * 1.0 / np.hypot(4.0, 12.0) / np.hypot(1.0, 12.0))
    assert quality.cloud(picture) == pytest.approx(left, rel=0.2)
    # A wave of 200 pixels is hardly blurred: exp(-2 (pi 12 / 200)^2) of it remain.
    remains = np.exp(-2 * (np.pi * quality.CLOUD_PIXELS / SIZE[1]) ** 2)
    expected = remains * 3 / np.sqrt(1 + 3**2)
    assert quality.cloud(picture + 3 * shade) == pytest.approx(expected, abs=0.05)
    assert quality.cloud(np.ones(SIZE)) == 0
    # What lies outside the mask has no part in it.
    spoilt = np.where(EVERYWHERE, picture, 50 + rows)
    assert quality.cloud(spoilt, EVERYWHERE) == pytest.approx(
        quality.cloud(np.where(EVERYWHERE, picture, 0), EVERYWHERE)
    )


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        (
            {"u": np.ones((2, 2))},
            r"u has shape \(2, 2\); expected \(160, 200\), as",
        ),
        ({"mask": np.ones((2, 2))}, r"mask has shape \(2, 2\)"),
        ({"mask": np.zeros(SIZE)}, "no pixel is left to measure"),
        ({"picture": np.full(SIZE, np.nan)}, "picture is NaN everywhere"),
        ({"picture": np.ones(3)}, r"picture is float64 of shape \(3,\); expected numbers"),
    ],
)
def test_arrays_that_do_not_fit_raise(given: dict[str, Floats], expected: str) -> None:
    picture, u, v = stripes(30)
    arguments: dict[str, Any] = {"picture": picture, "u": u, "v": v, **given}
    for measure in (quality.alignment, quality.grain, quality.sense):
        with pytest.raises(flowtex.FieldError, match=expected):
            measure(**arguments)


def test_a_sense_is_that_of_heads() -> None:
    ramps = np.tile((np.arange(SIZE[1]) % 25.0) ** 3, (SIZE[0], 1))
    colours = np.repeat(ramps[..., None] / ramps.max() * 255, 3, axis=-1).astype(np.uint8)
    ones, zeros = np.ones(SIZE), np.zeros(SIZE)
    assert quality.sense(ramps, ones, zeros) == quality.sense(colours, ones, zeros) == 1
    assert quality.sense(ramps, -ones, zeros) == 0
    assert quality.sense(ramps.T, zeros.T, -ones.T) == 1
    even, u, v = stripes(30)
    assert quality.sense(even, u, v) == pytest.approx(0.5, abs=0.4)


def test_a_texture_that_is_carried_sticks(rng: np.random.Generator) -> None:
    first = noise(rng, 1.5, 1.5)
    second = np.roll(first, (2, -5), axis=(0, 1))
    assert quality.sticking(first, second, -5, 2) > 0.99
    assert quality.sticking(first, second, 0, 0) < 0.3
    assert quality.sticking(first, first, np.zeros(SIZE), np.zeros(SIZE), EVERYWHERE) > 0.99


def test_spacing_tells_even_marks_from_random_ones(rng: np.random.Generator) -> None:
    lattice = np.stack(np.meshgrid(np.arange(20.0), np.arange(15.0)), axis=-1).reshape(-1, 2)
    assert quality.spacing(lattice) == 0
    assert quality.spacing(7 * lattice + rng.normal(0, 0.5, lattice.shape)) < 0.15
    # Of points at random the distance to the nearest has a Rayleigh distribution.
    random = rng.random((20_000, 2))
    assert quality.spacing(random) == pytest.approx(np.sqrt(4 / np.pi - 1), rel=0.05)


def test_evenness_tells_stretched_and_uneven_grains(rng: np.random.Generator) -> None:
    even = measures.evenness(noise(rng, 1.5, 1.5), EVERYWHERE)
    assert even.stretch < 1.2 and even.spread < 1.2
    assert measures.evenness(noise(rng, 1.0, 3.0), EVERYWHERE).stretch > 2.2
    uneven = noise(rng, 1.0, 1.0)
    uneven[:, 100:] = noise(rng, 3.0, 3.0)[:, 100:]
    assert measures.evenness(uneven, EVERYWHERE).spread > 2
    nothing = measures.evenness(uneven, np.zeros(SIZE, bool))
    assert np.isnan(nothing.spread)
