"""The picture that :func:`render` returns, and its colours."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import Bools, Bytes, Floats
from flowtex.rendering.cpu.levels import level_colour
from flowtex.rendering.cpu.shade import paint, shade
from flowtex.settings import Settings

__all__ = ["Picture"]


@dataclass(frozen=True, eq=False)
class Picture:
    """A flow texture as numbers, row 0 at the top; NaN where there is no surface.

    Attributes
    ----------
    value
        The texture before it is laid over a colour, (H, W), of mean zero and of deviation one.
        For a picture in place of the noise, its mean colours times opacity, and opacity,
        (H, W, 4).
    covered
        Pixels that show the surface, (H, W).
    coordinate
        Texture coordinates (u, v) in the slices, (H, W, 2).
    position
        Points of the mesh, in its own coordinates, (H, W, 3).
    slice_level, noise_level
        Mip level of the slices, and level of detail of the noise, (H, W).
    settings
        What it was drawn with.
    """

    value: Floats
    covered: Bools
    coordinate: Floats
    position: Floats
    slice_level: Floats
    noise_level: Floats
    settings: Settings

    def rgb(
        self, colour: ArrayLike = (0.627, 0.627, 0.627), background: ArrayLike = (1.0, 1.0, 1.0)
    ) -> Bytes:
        """Colour the picture, without lights: those are the business of the other renderers.

        Parameters
        ----------
        colour
            Colour of the surface from 0 to 1, (3,), or one for each pixel, (H, W, 3).
        background
            Colour where there is no surface, (3,).

        Returns
        -------
        numpy.ndarray
            (H, W, 3), 0 to 255.

        Raises
        ------
        ValueError
            When a colour has another shape or lies outside 0 to 1.
        """
        shape = (*self.covered.shape, 3)
        below = _colours("colour", colour, shape)[self.covered]
        if self.settings.show_level:
            below = level_colour(self.noise_level[self.covered])
        lay = shade if self.value.ndim == 2 else paint
        result = _colours("background", background, (3,)) * np.ones(shape)
        result[self.covered] = lay(below, self.value[self.covered], self.settings)
        return np.rint(result * 255.0).astype(np.uint8)


def _colours(name: str, value: ArrayLike, shape: tuple[int, ...]) -> Floats:
    numbers = np.asarray(value, dtype=float)
    if numbers.shape not in ((3,), shape) or not ((numbers >= 0) & (numbers <= 1)).all():
        shapes = " or ".join(map(str, dict.fromkeys([(3,), shape])))
        given = f"of shape {numbers.shape}" if numbers.size > 3 else repr(value)
        msg = f"{name} is {given}; expected red, green and blue from 0 to 1, of shape {shapes}"
        raise ValueError(msg)
    return np.broadcast_to(numbers, shape)
