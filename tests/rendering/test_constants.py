"""GLSL and NumPy have the same numbers, by the same names."""

from __future__ import annotations

import re

import numpy as np
import pytest

from flowtex.rendering import constants
from flowtex.rendering.shaders import shader_names, shader_source
from flowtex.textures.paper import HALF_LEVELS
from flowtex.textures.texture_set import MOST_LAGS

#: Type, name and value of each constant in GLSL.
GLSL = {
    name: (kind, [float(int(n.rstrip("u"), 0)) if "u" in n else float(n) for n in numbers])
    for kind, name, value in re.findall(
        r"const (\w+) FLOWTEX_(\w+) = ([^;]*);", shader_source("common/constants.glsl")
    )
    for numbers in [re.findall(r"0x[0-9a-f]+u|-?[\d.]+(?:e-?\d+)?u?", re.sub(r"\w+\(", "", value))]
}
#: Kernels by name, and what legends are made by, in Python alone.
PYTHON_ONLY = {"KERNELS", "MEAN_VALUES"}


@pytest.mark.parametrize("name", GLSL)
def test_a_constant_of_the_shaders_is_that_of_python(name: str) -> None:
    kind, numbers = GLSL[name]
    expected = np.ravel(getattr(constants, name)).astype(float)
    assert len(numbers) == {"mat3": 9, "uvec3": 3, "uvec2": 2}.get(kind, 1)
    # Single precision, and the inverse matrices are written with ten digits.
    tolerance = 1e-6 if kind == "mat3" else 1e-8 * abs(expected)
    assert np.all(np.abs(np.array(numbers) - expected) <= tolerance)


def test_python_has_no_constant_that_the_shaders_lack() -> None:
    names = {name for name in vars(constants) if name.isupper()}
    assert names - PYTHON_ONLY == set(GLSL)


def test_every_constant_of_the_shaders_is_used() -> None:
    text = "".join(
        shader_source(name) for name in shader_names() if name != "common/constants.glsl"
    )
    used = set(re.findall(r"\bFLOWTEX_(\w+)", re.sub(r"//.*", "", text)))
    # The kernel without its own branch.
    assert set(GLSL) - used == {"KERNEL_HANN"}


def test_arrays_of_the_shaders_have_the_length_that_the_textures_have() -> None:
    assert GLSL["MOST_LAGS"][1] == [MOST_LAGS]
    assert GLSL["HALF_LEVELS"][1] == [HALF_LEVELS]
