"""The texture laid over a colour, in Oklab: ``shaders/common/shade.glsl``."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import Floats
from flowtex.settings import Settings

__all__ = ["paint", "shade", "tone"]


#: Linear colours to cone responses, and their cube roots to Oklab; vectors are rows.
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


def shade(colour: ArrayLike, value: Floats, settings: Settings) -> Floats:
    """Lay the texture over a colour, as ``flowtexShade`` does.

    Parameters
    ----------
    colour
        Red, green and blue from 0 to 1, (3,) or (..., 3).
    value
        The texture, (...).
    settings
        Contrast and strength are taken from them.

    Returns
    -------
    numpy.ndarray
        Colours from 0 to 1, (..., 3).
    """
    lab = np.broadcast_to(_to_oklab(np.asarray(colour, dtype=float)), (*value.shape, 3))
    strength = settings.strength
    lightness = lab[..., 0]
    base = lightness + strength * (0.36 + 0.44 * lightness - lightness)
    light = np.clip(base + 0.34 * strength * tone(value, settings.contrast), 0.0, 1.0)
    tiny = np.finfo(float).tiny
    up = (1.0 - light) / np.maximum(1.0 - base, tiny)
    room = np.where(light < base, light / np.maximum(base, tiny), up)
    return _from_oklab(np.concatenate([light[..., None], lab[..., 1:] * room[..., None]], axis=-1))


def tone(value: Floats, contrast: float) -> Floats:
    """How far the texture lightens, from -1 to 1."""
    return np.asarray(2.0 / (1.0 + np.exp(-1.1 * contrast * value)) - 1.0)


def paint(colour: ArrayLike, picture: Floats, settings: Settings) -> Floats:
    """Lay a picture over a colour, as ``flowtexPaint`` does.

    Parameters
    ----------
    colour
        Red, green and blue from 0 to 1, (3,) or (..., 3).
    picture
        Red, green and blue times opacity, and opacity, (..., 4).
    settings
        Strength is taken from them.

    Returns
    -------
    numpy.ndarray
        Colours from 0 to 1, (..., 3).
    """
    strength = 0.5 * settings.strength if settings.show_level else settings.strength
    below = np.asarray(colour, dtype=float) * (1.0 - strength * picture[..., 3:])
    return np.asarray(below + strength * picture[..., :3])


def _to_oklab(colour: Floats) -> Floats:
    c = np.clip(colour, 0.0, 1.0)
    linear = np.where(c < 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
    return np.asarray(np.cbrt(linear @ TO_CONES) @ TO_LAB)


def _from_oklab(lab: Floats) -> Floats:
    roots = lab @ np.linalg.inv(TO_LAB)
    linear = np.clip(roots**3 @ np.linalg.inv(TO_CONES), 0.0, 1.0)
    curved = 1.055 * np.power(linear, 1.0 / 2.4) - 0.055
    return np.where(linear < 0.0031308, linear * 12.92, curved)
