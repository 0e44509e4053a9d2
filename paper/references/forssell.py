"""Line integral convolution in the computational space of a curvilinear surface.

L. Forssell and S. Cohen, "Using line integral convolution for flow visualization: curvilinear
grids, variable-speed animation, and unsteady flows", IEEE Transactions on Visualization and
Computer Graphics 1(2), pp. 133-141, 1995.

The velocity is taken to computational space (i, j) with the inverse Jacobian of the grid. There
the grid is an image of even pixels, on which white noise is smeared as on any other, and the
result is mapped on the surface as a texture. Where cells are large its grains and streaks are
large, where they are long they are long: noise that is even in the texture is stretched with the
grid, and a texture of the grid's own resolution has no more to show from near.

Kept besides is their even length of the kernel on the surface, which their animations need.
Left out: the animations themselves, and time-varying flow.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy import ndimage

from flowtex._util.array_types import Floats
from flowtex.field import FlowField
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu.raster import cover
from paper.references.lic import lic

#: How many times the kernel may grow in texels where they are short on the surface.
MAX_STRETCH = 8.0


def forssell_lic(
    field: FlowField,
    shape: tuple[int, int] | None = None,
    length: float = 20.0,
    kernel: str = "box",
    *,
    even: bool = False,
    seed: int = 0,
    step: int = 0,
) -> Floats:
    """Compute the texture of a surface in computational space.

    Parameters
    ----------
    field
        The flow.
    shape
        Rows and columns of the texture, spread evenly over j and i. By default one texel for
        each node, the grid's own resolution.
    length
        Length of the kernel in texels.
    kernel
        As for :func:`paper.references.lic`.
    even
        Whether the kernel is equally long everywhere on the surface: ``length`` mean texels,
        and up to eight times as many where texels are short.
    seed
        Number of the white noise, which is normal with mean zero and deviation one.
    step
        Which time step.

    Returns
    -------
    numpy.ndarray
        (rows, columns), row 0 at j = 0.

    Raises
    ------
    ValueError
        When the shape is empty, or the length or the kernel is none.
    """
    rows, columns = shape = field.shape if shape is None else shape
    if rows < 1 or columns < 1:
        msg = f"shape is {shape}; expected one row and one column of texels or more"
        raise ValueError(msg)
    velocity, size = texel_velocity(field, shape, step)
    lengths = length * np.minimum(size.mean() / size, MAX_STRETCH) if even else length
    noise = np.random.default_rng(seed).standard_normal(shape)
    return lic(velocity, noise, lengths, kernel, periodic=field.periodic)


def texel_velocity(
    field: FlowField, shape: tuple[int, int], step: int = 0
) -> tuple[Floats, Floats]:
    """Velocity at the texels of a texture, and the size of the texels on the surface.

    Returns
    -------
    velocity
        (rows, columns, 2), along i and along j in texels per unit of time.
    size
        Length on the surface of one texel in the direction of the flow, (rows, columns), in the
        mesh's units; the mean where nothing moves.
    """
    rows, columns = shape
    cells = np.subtract(field.shape, 1)
    j, i = ((np.arange(n) + 0.5) / n * m for n, m in zip(shape, cells, strict=True))
    at = np.meshgrid(j, i, indexing="ij")
    flow = field.index_velocity
    u, v, speed = (
        ndimage.map_coordinates(nodal, at, order=1, mode="nearest")
        for nodal in (*np.moveaxis(flow.components[step], -1, 0), flow.speed[step])
    )
    velocity = np.stack([u * columns / cells[1], v * rows / cells[0]], axis=-1)
    texels = np.linalg.norm(velocity, axis=-1)
    moving = (texels > 0) & (speed > 0)
    size = np.divide(speed, texels, out=np.ones(shape), where=moving)
    size[~moving] = size[moving].mean() if moving.any() else 1.0
    return velocity, size


def draw_texture(
    texture: ArrayLike,
    field: FlowField,
    camera: Camera,
    size: tuple[int, int],
    *,
    smooth: bool = True,
) -> Floats:
    """Draw a texture of computational space on its surface.

    There are no mip levels, as there were none with the methods that made such textures.

    Parameters
    ----------
    texture
        (rows, columns), spread evenly over j and i, row 0 at j = 0.
    field
        The flow whose surface it lies on.
    camera
        From where.
    size
        Width and height of the picture in pixels.
    smooth
        Whether texels are blended where they are larger than pixels; squares otherwise.

    Returns
    -------
    numpy.ndarray
        (H, W), row 0 at the top, NaN where there is no surface.

    Raises
    ------
    ValueError
        When the texture has no rows and columns.
    """
    texels = np.asarray(texture, dtype=float)
    if texels.ndim != 2 or not texels.size:
        msg = f"texture has shape {texels.shape}; expected (rows, columns)"
        raise ValueError(msg)
    coverage = cover(field.surface, camera, size)
    rows, columns = field.shape
    j, i = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, 1, columns), indexing="ij")
    share, _, _ = coverage.mix(np.stack([j, i], axis=-1).reshape(-1, 2))
    at = [share[:, axis] * texels.shape[axis] - 0.5 for axis in (0, 1)]
    width, height = size
    picture = np.full(height * width, np.nan)
    picture[coverage.pixel] = _sampled(texels, at, field.periodic, smooth=smooth)
    return picture.reshape(height, width)


def _sampled(
    texels: Floats, at: list[Floats], periodic: tuple[bool, bool], *, smooth: bool
) -> Floats:
    """Look texels up at positions that count from the middle of the first one.

    An axis that does not go around is clamped to its ends.
    """
    padded = texels
    for axis, around in enumerate(periodic):
        width = [(1, 1) if a == axis else (0, 0) for a in (0, 1)]
        padded = np.pad(padded, width, mode="wrap" if around else "edge")
    where = [a + 1 for a in at]
    return np.asarray(
        ndimage.map_coordinates(padded, where, order=1 if smooth else 0, mode="nearest")
    )
