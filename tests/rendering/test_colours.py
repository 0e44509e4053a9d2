"""Colour maps under the texture: lightness keeps its order, and hue stays."""

from __future__ import annotations

from typing import Any

import matplotlib
import numpy as np
import pytest

from flowtex._util.array_types import Floats
from flowtex._util.colours import ColourScale, colour_table
from flowtex.rendering.cpu.shade import mean_colours, shade
from flowtex.settings import Settings


def lightness(colours: Floats) -> Floats:
    """CIE L* of sRGB colours, by the standard's own formula."""
    linear = np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)
    y = linear @ np.array([0.2126, 0.7152, 0.0722])
    return np.asarray(np.where(y > 0.008856, 116 * np.cbrt(y) - 16, 903.3 * y))


def chroma(colours: Floats) -> Floats:
    """CIE C*ab of sRGB colours, by the standard's own formula."""
    linear = np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)
    to_xyz = np.array(
        [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    )
    xyz = linear @ to_xyz.T / to_xyz.sum(axis=1)
    roots = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    a = 500 * (roots[..., 0] - roots[..., 1])
    b = 200 * (roots[..., 1] - roots[..., 2])
    return np.asarray(np.hypot(a, b))


@pytest.fixture(scope="module")
def values() -> Floats:
    return np.random.default_rng(1).standard_normal(4000)


@pytest.mark.parametrize("strength", [0.3, 0.65, 1.0])
@pytest.mark.parametrize("name", ["viridis", "cividis", "magma", "gray", "Blues_r"])
def test_a_map_that_grows_lighter_still_does(name: str, strength: float, values: Floats) -> None:
    colours = matplotlib.colormaps[name](np.linspace(0, 1, 33))[:, :3]
    assert (np.diff(lightness(colours)) > 0).all()
    settings = Settings(strength=strength)
    mean = [lightness(shade(colour, values, settings)).mean() for colour in colours]
    assert (np.diff(mean) > 0).all()


@pytest.mark.parametrize("name", ["viridis", "coolwarm", "plasma"])
def test_the_texture_shows_on_every_colour(name: str, values: Floats) -> None:
    colours = matplotlib.colormaps[name](np.linspace(0, 1, 33))[:, :3]
    spread = [lightness(shade(colour, values, Settings())).std() for colour in colours]
    assert min(spread) > 8
    assert max(spread) / min(spread) < 1.6


@pytest.mark.parametrize("name", ["viridis", "cividis", "RdBu_r", "turbo"])
def test_colours_keep_their_chroma_under_the_texture(name: str, values: Floats) -> None:
    colours = matplotlib.colormaps[name](np.linspace(0, 1, 33))[:, :3]
    kept = [chroma(shade(c, values, Settings())).mean() / chroma(c) for c in colours]
    assert min(kept) > 0.78
    assert np.mean(kept) > 0.88


def test_yellow_is_not_drawn_as_white(values: Floats) -> None:
    yellow = np.array(matplotlib.colormaps["viridis"](0.97)[:3])
    drawn = shade(yellow, values, Settings())
    assert (drawn.min(axis=-1) > 0.9).mean() < 0.02


def test_without_strength_or_contrast_colours_are_what_they_were(values: Floats) -> None:
    colours = np.random.default_rng(2).random((50, 3))
    drawn = shade(colours, values[:50], Settings(strength=0.0))
    np.testing.assert_allclose(drawn, colours, atol=2e-4)


@pytest.mark.parametrize("options", [{}, {"strength": 0.4}, {"contrast": 2.0}])
@pytest.mark.parametrize("name", ["viridis", "coolwarm"])
def test_a_legend_has_the_mean_colours_of_shaded_noise(
    name: str, options: dict[str, Any], values: Floats
) -> None:
    settings, table = Settings(**options), colour_table(name)[::15]
    even = (values - values.mean()) / values.std()
    means = [255 * shade(colour, even, settings).mean(axis=0) for colour in table[:, :3] / 255]
    np.testing.assert_allclose(mean_colours(table, settings)[:, :3], means, atol=4)


def test_an_image_keeps_the_colours_of_the_map() -> None:
    table = colour_table("viridis")
    np.testing.assert_array_equal(mean_colours(table, Settings(noise="image")), table)


def test_places_on_a_map() -> None:
    numbers = [-1, 0, 1, 10, 100, 1000, np.nan]
    shares = ColourScale(low=1, high=100, log_scale=True).places(np.array(numbers))
    np.testing.assert_allclose(shares, [0, 0, 0, 0.5, 1, 1, np.nan])
    assert list(ColourScale(low=0, high=2).places(np.array([0.0, 1.0, 9.0]))) == [0, 0.5, 1]
