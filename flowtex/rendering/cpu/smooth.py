"""A function of position in the place of the noise, to see what the paths do by themselves."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.rendering.cpu.fragments import Fragments
from flowtex.rendering.cpu.lookup_space import SpaceNoise
from flowtex.rendering.cpu.texture import Lookup, LookupMaker, Sums
from flowtex.textures import TextureSet

__all__ = ["smooth"]

Function = Callable[[Floats], Floats]


class _Smooth(Lookup):
    """Weighted mean of a function along the paths of some fragments.

    The second value that is summed is one everywhere, so that the ratio of both sums is the
    mean, whatever the weights are.
    """

    def __init__(
        self,
        function: Function,
        textures: TextureSet,
        fragments: Fragments,
        values: Mapping[str, Any],
    ) -> None:
        geometry = textures.geometry
        self._function, self._frame, self._center = function, geometry.frame, geometry.center
        self._here = fragments.position.value
        noise = SpaceNoise(fragments, values, planar=geometry.planar)
        self.spacing, self.level = noise.spacing, noise.level

    def lookup(self, displacement: Floats, length: Floats) -> Floats:
        """Return the function and one, (N, 2)."""
        del length
        value = self._function((self._here + displacement) @ self._frame + self._center)
        return np.stack([value, np.ones_like(value)], axis=-1)

    def blend(self, sums: Sums) -> Floats:
        """Return the mean."""
        return np.asarray(sums.values[:, 0] / sums.values[:, 1])


def smooth(function: Function, textures: TextureSet) -> LookupMaker:
    """Make a look-up for :func:`render` that averages a function along the paths.

    Parameters
    ----------
    function
        Takes points of the mesh (N, 3) to numbers (N,). A picture without noise is as smooth as
        it is, so two pictures can be compared where noise would only be as random in both.
    textures
        The textures that are drawn, with slopes in space.

    Raises
    ------
    ValueError
        When the slopes are those of the paper's noise texture.
    """
    if textures.space != "physical":
        msg = (
            f"the textures have slopes in {textures.space} space; expected physical ones: build "
            'them with noise="procedural"'
        )
        raise ValueError(msg)
    return lambda fragments, values: _Smooth(function, textures, fragments, values)
