"""The numbers of the method, read from ``shaders/common/constants.glsl``, which explains each.

They have the same names here, without the prefix. Vectors are rows.
"""

from __future__ import annotations

import re
from statistics import NormalDist
from typing import Any

import numpy as np

from flowtex.rendering.shaders import shader_source

KERNELS = ("hann", "box", "ramp")
#: Values of a texture that stand for all, which are spread as a normal distribution.
MEAN_VALUES = np.array([NormalDist().inv_cdf((n + 0.5) / 16) for n in range(16)])

_DECLARED = re.compile(r"const (\w+) FLOWTEX_(\w+) = ([^;]*);")
_NUMBER = re.compile(r"(?<![\w.])-?(?:0x[0-9a-f]+|[\d.]+(?:e-?\d+)?)")


def _constant(kind: str, value: str) -> Any:
    """Return a constant of a type of GLSL."""
    numbers = _NUMBER.findall(value)
    if kind in ("int", "float"):
        return {"int": int, "float": float}[kind](numbers[0])
    if kind == "mat3":
        return np.array(numbers, dtype=float).reshape(3, 3)
    whole = np.array([int(number, 0) for number in numbers], dtype=np.uint32)
    return whole[0] if kind == "uint" else whole


_CONSTANTS = {
    name: _constant(kind, value)
    for kind, name, value in _DECLARED.findall(shader_source("common/constants.glsl"))
}


def __getattr__(name: str) -> Any:
    if name in _CONSTANTS:
        return _CONSTANTS[name]
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
