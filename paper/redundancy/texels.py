"""Errors of traced positions in texels of the noise, which is what they are seen in."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import ndimage

from flowtex._util.array_types import Floats
from flowtex.trace.slices import TraceSlices


class TexelDensity:
    """Texels of the noise per cell, anywhere on the surface.

    Parameters
    ----------
    texels
        Texels per cell of the mesh: one number, a pair for i and j, or (J, I, 2) at the entries
        of the slices. For a noise texture, its texels over the cells that it covers:
        ``textures.image.by_cell() * [width, height]`` where cells differ. For noise in space,
        the lengths of the cells along both axes over the grain.
    slices
        The slices whose errors are to be judged.
    periodic
        Whether the (j, i) axis is periodic. It decides what counts beyond the border, when there
        are texels for each entry.

    Raises
    ------
    ValueError
        When there are not as many numbers, or one is not positive.
    """

    def __init__(
        self, texels: ArrayLike, slices: TraceSlices, periodic: tuple[bool, bool] = (False, False)
    ) -> None:
        density = np.asarray(texels, dtype=float)
        whole = (*slices.shape, 2)
        if density.shape not in ((), (2,), whole):
            msg = f"texels has shape {density.shape}; expected one number, two, or {whole}"
            raise ValueError(msg)
        if not (np.isfinite(density) & (density > 0)).all():
            msg = (
                f"texels goes from {density.min():g} to {density.max():g}; expected positive "
                "numbers of texels per cell"
            )
            raise ValueError(msg)
        self.even = density.shape != whole
        self._nodal = np.broadcast_to(density, whole)
        size = slices.nodes[-1, -1] - slices.nodes[0, 0]
        self._last = np.array(slices.shape[::-1]) - 1
        self._spacing = np.where(size > 0, size, 1.0) / np.maximum(self._last, 1)
        self._origin = slices.nodes[0, 0]
        self._nodes = slices.nodes
        self._periodic = np.array(periodic[::-1])

    def most(self, slices: TraceSlices) -> Floats:
        """Most texels per cell around any position of the paths, (J, I, 2)."""
        if self.even:
            return self._nodal
        around = ndimage.maximum_filter(self._nodal, (3, 3, 1), mode="nearest")
        result = around.copy()
        for data in _sides(slices):
            for offset in data.reshape(-1, *result.shape):
                i, j = np.moveaxis(np.rint(self._entry(offset)).astype(np.intp), -1, 0)
                np.maximum(result, around[j, i], out=result)
        return result

    def at(self, displacement: NDArray[np.floating]) -> Floats:
        """TexelDensity per cell where displacements (J, I, 2) lead, (J, I, 2)."""
        if self.even:
            return self._nodal
        i, j = np.moveaxis(self._entry(displacement), -1, 0)
        parts = [
            ndimage.map_coordinates(self._nodal[..., axis], [j, i], order=1, mode="nearest")
            for axis in (0, 1)
        ]
        return np.stack(parts, axis=-1)

    def _entry(self, displacement: NDArray[np.floating]) -> Floats:
        """Positions in entries, (J, I, 2) as (i, j), between the first and the last."""
        offset = np.nan_to_num(displacement.astype(float), nan=0.0, posinf=1e9, neginf=-1e9)
        x = (self._nodes + offset - self._origin) / self._spacing
        wrapped = np.mod(x, np.maximum(self._last, 1))
        return np.asarray(np.clip(np.where(self._periodic, wrapped, x), 0, self._last))


def error_in_texels(
    slices: TraceSlices,
    other: TraceSlices,
    texels: ArrayLike,
    periodic: tuple[bool, bool] = (False, False),
) -> float:
    """Greatest distance between the positions of two slices, in texels of the noise.

    The way along i and the way along j are added, which is the most that it can be however the
    axes meet. Entries that are not finite in the first have to be the same in both.

    Parameters
    ----------
    slices, other
        The true slices and those to be judged, of one shape.
    texels, periodic
        As for :class:`TexelDensity`.

    Returns
    -------
    float
        Infinite where an entry that is not finite differs.
    """
    measure = TexelDensity(texels, slices, periodic)
    worst = 0.0
    for true, judged in zip(_sides(slices), _sides(other), strict=True):
        shape = (-1, *slices.shape, 2)
        for one, two in zip(true.reshape(shape), judged.reshape(shape), strict=True):
            finite = np.isfinite(one)
            if not np.array_equal(one[~finite], two[~finite], equal_nan=True):
                return float("inf")
            error = np.zeros(one.shape)
            np.subtract(two, one, out=error, where=finite, dtype=float)
            worst = max(worst, float((np.abs(error) * measure.at(one)).sum(axis=-1).max()))
    return worst


def _sides(slices: TraceSlices) -> list[NDArray[np.floating]]:
    return (
        [slices.displacement] if slices.forward is None else [slices.displacement, slices.forward]
    )
