"""The texture laid over a colour, in Oklab: ``shaders/common/shade.glsl``."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import Bytes, Floats
from flowtex.rendering.shaders import MEAN_VALUES, const
from flowtex.settings import Settings


def shade(colour: ArrayLike, value: Floats, settings: Settings) -> Floats:
    """Lay the texture, (...), over colours from 0 to 1, (3,) or (..., 3), as ``flowtexShade``."""
    lab = np.broadcast_to(_to_oklab(np.asarray(colour, dtype=float)), (*value.shape, 3))
    strength = settings.strength
    lightness = lab[..., 0]
    base = lightness + strength * (
        const.BASE_DARK + (const.BASE_LIGHT - const.BASE_DARK) * lightness - lightness
    )
    light = np.clip(base + const.TONE_RANGE * strength * tone(value, settings.contrast), 0.0, 1.0)
    return _from_oklab(np.concatenate([light[..., None], lab[..., 1:]], axis=-1))


def mean_colours(table: Bytes, settings: Settings) -> Bytes:
    """Mean colours of a picture where the colour map has the colours of a table, (N, 4)."""
    if settings.noise == "image":
        return table
    shaded = table.copy()
    values = np.broadcast_to(MEAN_VALUES, (len(table), len(MEAN_VALUES)))
    colours = shade(table[:, None, :3] / 255.0, values, settings)
    shaded[:, :3] = np.rint(255 * colours.mean(axis=1))
    return shaded


def tone(value: Floats, contrast: float) -> Floats:
    """How far the texture lightens, from -1 to 1."""
    return np.asarray(2.0 / (1.0 + np.exp(-const.TONE_SLOPE * contrast * value)) - 1.0)


def paint(colour: ArrayLike, picture: Floats, settings: Settings) -> Floats:
    """Lay a picture, colours times opacity and opacity (..., 4), over colours."""
    if settings.show_level:
        strength = const.LEVEL_STRENGTH * settings.strength
    else:
        strength = settings.strength
    below = np.asarray(colour, dtype=float) * (1.0 - strength * picture[..., 3:])
    return np.asarray(below + strength * picture[..., :3])


def _to_oklab(colour: Floats) -> Floats:
    c = np.clip(colour, 0.0, 1.0)
    linear = np.where(
        c < const.SRGB_KNEE,
        c / const.SRGB_SLOPE,
        ((c + const.SRGB_OFFSET) / const.SRGB_SCALE) ** const.SRGB_POWER,
    )
    return np.asarray(np.cbrt(linear @ const.TO_CONES) @ const.TO_LAB)


def _from_oklab(lab: Floats) -> Floats:
    roots = lab @ const.FROM_LAB
    linear = _in_range(roots**3 @ const.FROM_CONES, lab[..., :1] ** 3)
    curved = const.SRGB_SCALE * np.power(linear, 1.0 / const.SRGB_POWER) - const.SRGB_OFFSET
    return np.asarray(np.where(linear < const.SRGB_LINEAR_KNEE, linear * const.SRGB_SLOPE, curved))


def _in_range(linear: Floats, grey: Floats) -> Floats:
    """Mix linear colours (..., 3) with greys (..., 1) until all are from 0 to 1."""
    chroma = linear - grey
    room = np.abs((chroma >= 0.0) - grey) / np.maximum(np.abs(chroma), const.LEAST_CHROMA)
    share = np.minimum(room.min(axis=-1, keepdims=True), 1.0)
    return np.asarray(np.clip(grey + share * chroma, 0.0, 1.0))
