"""The numbers of the method, as ``shaders/common/constants.glsl`` has them by the same names.

That file explains each.
"""

from __future__ import annotations

from statistics import NormalDist

import numpy as np

from flowtex.textures.paper import HALF_LEVELS
from flowtex.textures.texture_set import AGREED, HALF_MAX, MOST_LAGS, UNCERTAIN_LAYER

__all__ = ["AGREED", "HALF_LEVELS", "HALF_MAX", "KERNELS", "MOST_LAGS", "UNCERTAIN_LAYER"]

KERNELS = ("hann", "box", "ramp")
KERNEL_HANN, KERNEL_BOX, KERNEL_RAMP = range(len(KERNELS))
PI = float(np.pi)
LEAST_WEIGHT, LEAST_SPEED = 1e-3, 1e-6
BELL, BELL_BEND, BELL_END = 1.19, 0.06, 3.0
SHARED_TERMS = 24
FADED = 0.3

PARTING = 0.95
NEAR_CELLS, FAR_CELLS = 1.0, 2.0
ALONG_PLANE, OFF_PLANE, EDGE_CELLS = 0.3, 0.5, 8.0

LEAST_SQUARE, LEAST_TEXELS, LEAST_FACING = 1e-38, 1e-6, 0.05
LEVELS_AROUND, HUE_SHIFT, LEVEL_DARKEST, LEVEL_STRENGTH = 6.0, 0.333, 0.35, 0.5

SQRT_HALF = float(np.sqrt(0.5))
LAST_OCTAVE, LAST_HALF_LEVEL = 58.99, 30.99
LEAST_RATE, LEAST_TRAVEL, MANY_PHASES = 0.25, 1e-30, 64.0
AXIS_PRIMES = np.array([0x8DA6B343, 0xD8163841, 0xCB1AB31F], dtype=np.uint32)
OCTAVE_PRIME, SEED_PRIME = np.uint32(0x9E3779B9), np.uint32(0x85EBCA6B)
HASH_SHIFT = np.uint32(15)
HASH_FACTORS = np.array([0x2C1B3C6D, 0x297A2D39], dtype=np.uint32)
MOST_GRAIN = 2.0**31
GRAIN_VARIANCE = MOST_GRAIN**2 / 3
SPARSE_SHARE, SPARSE_HIGH, SPARSE_LOW = 0.008, 6.429101, 0.05184759
TOGETHER = 0.5
DASH_SHARE, DASH_HIGH, DASH_LOW, DASH_PHASES = 0.4, 17.698921, 0.02831827, 256.0

BASE_DARK, BASE_LIGHT = 0.36, 0.80
TONE_RANGE, TONE_SLOPE = 0.34, 1.1
LEAST_LIGHTNESS = 1e-6
#: Values of a texture that stand for all, which are spread as a normal distribution.
MEAN_VALUES = np.array([NormalDist().inv_cdf((n + 0.5) / 16) for n in range(16)])
AMBIENT_LIGHT, DIFFUSE_LIGHT = 0.3, 0.8

ENDLESS, LEAST_REACH = 1e30, 1e-30
STEP_CELLS, MOST_STEPS, BISECTIONS = 0.5, 512, 12
PIECES, MANY_LAGS = 16, 1e4
BORDER_CELLS, LAG_ROUNDING = 1e-2, 1e-5

SRGB_SLOPE, SRGB_OFFSET, SRGB_SCALE, SRGB_POWER = 12.92, 0.055, 1.055, 2.4
SRGB_KNEE, SRGB_LINEAR_KNEE = 0.04045, 0.0031308
#: Vectors are rows.
TO_CONES = np.array(
    [
        [0.4122214708, 0.2119034982, 0.0883024619],
        [0.5363325363, 0.6806995451, 0.2817188376],
        [0.0514459929, 0.1073969566, 0.6299787005],
    ]
)
TO_LAB = np.array(
    [
        [0.2104542553, 1.9779984951, 0.0259040371],
        [0.7936177850, -2.4285922050, 0.7827717662],
        [-0.0040720468, 0.4505937099, -0.8086757660],
    ]
)
FROM_LAB, FROM_CONES = np.linalg.inv(TO_LAB), np.linalg.inv(TO_CONES)
