"""The measures of the paper's page on patterns whose figures are known."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from paper import measures, quality

Floats = NDArray[np.float64]
SIZE = (160, 200)
EVERYWHERE = np.pad(np.ones((128, 168), bool), 16)


def noise(rng: np.random.Generator, *sigma: float) -> Floats:
    return np.asarray(gaussian_filter(rng.standard_normal(SIZE), sigma or 0, mode="wrap"))


def test_evenness_tells_stretched_and_uneven_grains(rng: np.random.Generator) -> None:
    even = measures.evenness(noise(rng, 1.5, 1.5), EVERYWHERE)
    assert even.stretch < 1.2 and even.spread < 1.2
    assert measures.evenness(noise(rng, 1.0, 3.0), EVERYWHERE).stretch > 2.2
    uneven = noise(rng, 1.0, 1.0)
    uneven[:, 100:] = noise(rng, 3.0, 3.0)[:, 100:]
    assert measures.evenness(uneven, EVERYWHERE).spread > 2
    nothing = measures.evenness(uneven, np.zeros(SIZE, bool))
    assert np.isnan(nothing.spread)


def test_aliasing_of_a_picture_is_its_error_over_the_deviation(rng: np.random.Generator) -> None:
    truth = noise(rng, 2.0, 2.0)
    assert quality.aliasing(truth, truth, EVERYWHERE) == 0
    off = truth + 0.5 * truth[EVERYWHERE].std()
    assert quality.aliasing(off, truth, EVERYWHERE) == pytest.approx(0.5)
    assert measures.likeness(3 - 2 * truth, truth, EVERYWHERE) == pytest.approx(-1)
    assert abs(measures.likeness(noise(rng), noise(rng), EVERYWHERE)) < 0.05


def test_blur_takes_sharpness(rng: np.random.Generator) -> None:
    picture = noise(rng, 1.0, 1.0)
    blurred = gaussian_filter(picture, 2)
    before, after = (measures.sharpness(p, EVERYWHERE) for p in (picture, blurred))
    assert after < 0.3 * before
