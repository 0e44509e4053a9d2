"""The numbers of the shaders as Python has them."""

from __future__ import annotations

import re

import numpy as np
import pytest

from flowtex.rendering.shaders import KERNELS, const, shader_names, shader_source
from flowtex.textures import texture_set
from flowtex.textures.noise_textures import HALF_LEVELS

NAMES = re.findall(r"FLOWTEX_(\w+) =", shader_source("common/constants.glsl"))


def test_matrices_of_colours_are_inverse() -> None:
    for there, back in (("TO_CONES", "FROM_CONES"), ("TO_LAB", "FROM_LAB")):
        product = getattr(const, there) @ getattr(const, back)
        np.testing.assert_allclose(product, np.eye(3), atol=1e-7)


def test_numbers_that_follow_from_others_do() -> None:
    assert pytest.approx(np.pi) == const.PI
    assert pytest.approx(np.sqrt(0.5)) == const.SQRT_HALF
    assert pytest.approx(const.MOST_GRAIN**2 / 3) == const.GRAIN_VARIANCE
    share = 0.5**7  # of bright grains
    others = const.SPARSE_LOW * (1.0 - share)
    assert pytest.approx(const.SPARSE_HIGH * share, rel=1e-6) == others
    squares = share * const.SPARSE_HIGH**2 + (1.0 - share) * const.SPARSE_LOW**2
    assert pytest.approx(1.0 / 3.0, rel=1e-6) == squares
    mean = 0.5 * const.DASH_SHARE * share * const.DASH_HIGH
    assert pytest.approx(const.DASH_LOW, rel=1e-6) == mean
    squares = const.DASH_SHARE * share * const.DASH_HIGH**2 / 3.0
    assert pytest.approx(1.0 / 3.0, rel=1e-5) == squares - mean**2
    kernels = [name for name in NAMES if name.startswith("KERNEL_")]
    assert [f"KERNEL_{kernel.upper()}" for kernel in KERNELS] == kernels
    assert const.HALF_LEVELS == HALF_LEVELS
    assert HALF_LEVELS - 2 < const.LAST_HALF_LEVEL < HALF_LEVELS - 1
    assert [getattr(const, name) for name in kernels] == [0, 1, 2]


def test_every_constant_of_the_shaders_is_used() -> None:
    text = "".join(
        shader_source(name) for name in shader_names() if name != "common/constants.glsl"
    )
    used = set(re.findall(r"\bFLOWTEX_(\w+)", re.sub(r"//.*", "", text)))
    # The kernel without its own branch.
    assert set(NAMES) - used == {"KERNEL_HANN"}


def test_numbers_are_not_too_small_for_graphics_cards() -> None:
    # Subnormal numbers are zero there, so that a number divided by the greater one of both is NaN.
    least = np.finfo(np.float32).tiny
    for name in NAMES:
        number = np.abs(np.asarray(getattr(const, name), dtype=float))
        assert ((number == 0) | (number >= least)).all(), name


@pytest.mark.parametrize(
    "name", ["AGREED", "EDGE_CELLS", "HALF_MAX", "MOST_LAGS", "UNCERTAIN_LAYER"]
)
def test_textures_are_made_by_the_numbers_of_the_shaders(name: str) -> None:
    assert getattr(const, name) == getattr(texture_set, name)
