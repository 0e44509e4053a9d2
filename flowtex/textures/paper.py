"""The paper's own textures: noise on the surface's parameters, and the step size with it.

The noise texture lies on (i, j) (section 3.2). Spread evenly over the texels it is stretched with
the cells; *corrected*, every texel takes the value of an even noise in space at its own position,
as coarse as the texel is large, so that the grain on the surface does not depend on the cells
(figure 6). The step texture holds, for every texel of the noise, the lag in which the flow
crosses it (equation 3). Level n of it counts 2^n times as much, because its texels are twice as
wide at every level (section 4.1).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from flowtex.field import FlowField
from flowtex.trace import SliceStore

__all__ = ["PaperTextures"]

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class PaperTextures:
    """Noise and step size over the parameters of the surface.

    Attributes
    ----------
    noise
        Zero-mean noise of unit variance, (H, W).
    step
        Lag in which the flow crosses a texel, in multiples of the unit of lag, and how many
        texels a grain is long: one image for each destination time, (T, H, W, 2).
    coordinate
        Noise coordinates of the nodes, (J, I, 2): the middle of the texel on a node.
    scale
        Noise coordinates by cell, (2,), for i and j.
    repeat
        Whether the noise goes around along (v, u).
    corrected
        Whether the noise is even on the surface instead of even in the texture.
    """

    noise: Singles
    step: Singles
    coordinate: Singles
    scale: tuple[float, float]
    repeat: tuple[bool, bool]
    corrected: bool

    @classmethod
    def build(
        cls,
        store: SliceStore,
        *,
        resolution: int,
        correction: bool,
        seed: int = 0,
    ) -> PaperTextures:
        """Make both textures for a field.

        Parameters
        ----------
        store
            The flow and its traces.
        resolution
            Texels along the longer side of the surface; the other side gets as many as its
            length on the surface asks for. Rounded up to a power of two.
        correction
            Whether the noise is even on the surface instead of even in the texture.
        seed
            Number of the noise pattern.
        """
        field = store.field
        height, width = _size(field, resolution)
        index = _texel_positions(field, height, width)
        size = _texel_size(field, index)
        if correction:
            noise = _even_noise(field, index, size, seed)
        else:
            noise = np.random.default_rng(seed).standard_normal((height, width))
        steps = _steps(store, index)
        rows, columns = field.shape
        u, v = np.meshgrid(np.linspace(0, 1, columns), np.linspace(0, 1, rows))
        return cls(
            noise=((noise - noise.mean()) / (noise.std() or 1.0)).astype(np.float32),
            step=np.minimum(steps, 6e4).astype(np.float32),
            coordinate=np.stack([u, v], axis=-1).astype(np.float32),
            scale=(1 / (columns - 1), 1 / (rows - 1)),
            repeat=field.periodic,
            corrected=correction,
        )


def _size(field: FlowField, resolution: int) -> tuple[int, int]:
    """Height and width, powers of two in about the proportion of the surface."""
    p_i, p_j = (np.linalg.norm(t, axis=-1)[field.valid] for t in field.surface.tangents)
    rows, columns = field.shape
    lengths = np.array([p_j.mean() * (rows - 1), p_i.mean() * (columns - 1)])
    shares = np.maximum(lengths / lengths.max(), 1 / 8) * resolution
    height, width = (int(2 ** np.ceil(np.log2(max(n, 8)))) for n in shares)
    return height, width


def _texel_positions(field: FlowField, height: int, width: int) -> Floats:
    """Index-space position of the middle of each texel, (H, W, 2)."""
    rows, columns = field.shape
    i = (np.arange(width) + 0.5) / width * (columns - 1)
    j = (np.arange(height) + 0.5) / height * (rows - 1)
    return np.stack(np.meshgrid(i, j), axis=-1)


def _sample(nodal: NDArray[np.generic], index: Floats) -> Floats:
    """Nodal values (J, I) at positions in index space."""
    at = [index[..., 1], index[..., 0]]
    return np.asarray(ndimage.map_coordinates(nodal.astype(float), at, order=1, mode="nearest"))


def _texel_size(field: FlowField, index: Floats) -> Floats:
    """Longer side of each texel on the surface, (H, W)."""
    height, width = index.shape[:2]
    rows, columns = field.shape
    p_i, p_j = (np.linalg.norm(t, axis=-1) for t in field.surface.tangents)
    sides = _sample(p_i, index) * (columns - 1) / width, _sample(p_j, index) * (rows - 1) / height
    return np.maximum(np.maximum(*sides), field.surface.extent * 1e-7)


def _even_noise(field: FlowField, index: Floats, size: Floats, seed: int) -> Floats:
    """Noise even in space, at each texel as coarse as the texel is large.

    A texel takes the random number of the cube of a lattice in space in which it lies. The
    lattice is that power of two of the finest which is nearest to the texel's longer side.
    """
    octave = np.rint(np.log2(size)).astype(np.int64)
    position = field.surface.at(index) - field.surface.center
    cell = np.floor(position / (2.0**octave)[..., None]).astype(np.int64)
    return _hash(cell, octave, seed)


def _hash(cell: NDArray[np.int64], octave: NDArray[np.int64], seed: int) -> Floats:
    """Uniform random number of a lattice cell (..., 3)."""
    primes = np.array([0x9E3779B1, 0x85EBCA77, 0xC2B2AE3D], dtype=np.uint64)
    h = np.zeros(octave.shape, np.uint64)
    for axis in range(3):
        h ^= cell[..., axis].astype(np.uint64) * primes[axis]
    h ^= octave.astype(np.uint64) * np.uint64(0x27D4EB2F165667C5) + np.uint64(seed)
    for shift, factor in ((33, 0xFF51AFD7ED558CCD), (33, 0xC4CEB9FE1A85EC53)):
        h ^= h >> np.uint64(shift)
        h *= np.uint64(factor)
    h ^= h >> np.uint64(33)
    return h.astype(np.float64) / 2.0**64


def _steps(store: SliceStore, index: Floats) -> Floats:
    """Lag in which the flow crosses one texel (equation 3), (H, W).

    What is interpolated between the nodes is the number of texels crossed in a unit of lag; its
    inverse would let one node at rest rule the cells around it.
    """
    field = store.field
    height, width = index.shape[:2]
    rows, columns = field.shape
    texel = np.array([(columns - 1) / width, (rows - 1) / height])
    crossed = (np.abs(field.index_velocity.components) / texel).max(axis=(0, -1))
    if store.parameter == "arclength":
        crossed = _by_length(crossed, field)
    texels = _sample(crossed * store.unit, index)
    return 1 / np.maximum(texels, 1 / float(store.lags[-1]))


def _by_length(crossed: Floats, field: FlowField) -> Floats:
    """Texels crossed in a unit of length; where nothing moves, what the nearest node has."""
    speed = field.speed[0]
    moving = field.valid & (speed > 1e-7 * speed.max())
    if not moving.any():
        return np.zeros_like(crossed)
    found = crossed / np.where(moving, speed, 1.0)
    nearest = ndimage.distance_transform_edt(~moving, return_distances=False, return_indices=True)
    return np.asarray(found[tuple(nearest)])
