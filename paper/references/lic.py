"""Line integral convolution on the pixels of an image.

B. Cabral and L. Leedom, "Imaging vector fields using line integral convolution", Proceedings of
SIGGRAPH 93, pp. 263-270, 1993.

A line is followed from the middle of every pixel to both sides, from one edge of a pixel to the
next, straight along the vector of the pixel that it is in (their equations 1 to 4). The noise of
a pixel counts with the kernel's integral over the stretch of the line inside of it, and the sum
is divided by all the kernel that was used (equations 5 and 6).

Left out: the moving kernels of their animations, and images other than noise with their own
channels. A line that comes to an edge where the vectors on both sides point at each other goes to
and fro there without getting on; the number of pixels that it may visit ends it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import Bools, Floats
from flowtex.errors import raise_faults

#: Lengths in pixels by which a line may miss a corner between pixels and still pass through it.
CORNER_TOLERANCE_PIXELS = 1e-9

#: Integrals of the kernels from 0 to s, for a kernel that ends at h; both (N,).
KERNELS: dict[str, Callable[[Floats, Floats], Floats]] = {
    "box": lambda s, h: s,
    "hann": lambda s, h: 0.5 * (s + h / np.pi * np.sin(np.pi * s / h)),
}


def lic(
    velocity: ArrayLike,
    noise: ArrayLike,
    length: ArrayLike = 20.0,
    kernel: str = "box",
    *,
    periodic: tuple[bool, bool] = (False, False),
) -> Floats:
    """Smear an image along a flow.

    Parameters
    ----------
    velocity
        Flow at the pixels, (J, I, 2): along a row, to greater i, and along a column, to greater
        j. Only the direction counts. Where it is zero a line ends.
    noise
        The image, (J, I).
    length
        Length of the kernel in pixels, half of it to each side: one number, or (J, I).
    kernel
        ``"box"``, or ``"hann"``, which fades out to both ends.
    periodic
        Whether the (j, i) axis goes around; a line ends at the border otherwise.

    Returns
    -------
    numpy.ndarray
        (J, I). A pixel without flow keeps its noise.

    Raises
    ------
    ValueError
        When the shapes do not fit, a number is not finite, a length is not positive or the
        kernel is unknown; all faults are listed.
    """
    v, image = np.asarray(velocity, dtype=float), np.asarray(noise, dtype=float)
    lengths = np.asarray(length, dtype=float)
    _check(v, image, lengths, kernel)
    speed = np.linalg.norm(v, axis=-1)
    still = speed == 0
    direction = (v / np.where(still, 1.0, speed)[..., None]).reshape(-1, 2).T
    half = np.broadcast_to(lengths / 2, image.shape).ravel()
    total, weights = np.zeros(image.size), np.zeros(image.size)
    for side in (-1.0, 1.0):
        _follow(total, weights, side * direction, image, half, KERNELS[kernel], periodic)
    return np.where(
        still, image, (total / np.where(still.ravel(), 1, weights)).reshape(still.shape)
    )


def _check(v: Floats, image: Floats, lengths: Floats, kernel: str) -> None:
    """Raise one error with every fault."""
    faults = []
    if image.ndim != 2 or v.shape != (*image.shape, 2):
        faults.append(
            f"velocity has shape {v.shape} and noise {image.shape}; expected (J, I, 2) and (J, I)"
        )
    if not (np.isfinite(v).all() and np.isfinite(image).all()):
        faults.append("velocity or noise has NaN or infinite values; replace them, as by 0")
    if lengths.ndim and lengths.shape != image.shape:
        faults.append(f"length has shape {lengths.shape}; expected one number or {image.shape}")
    if not (np.isfinite(lengths) & (lengths > 0)).all():
        faults.append(f"length is {lengths}; expected a positive number of pixels")
    if kernel not in KERNELS:
        faults.append(f"kernel is {kernel!r}; expected one of {', '.join(map(repr, KERNELS))}")
    raise_faults(faults)


def _follow(
    total: Floats,
    weights: Floats,
    direction: Floats,
    image: Floats,
    half: Floats,
    kernel: Callable[[Floats, Floats], Floats],
    periodic: tuple[bool, bool],
) -> None:
    """Add one side of the lines of all pixels to the sums (J * I,)."""
    rows, columns = image.shape
    size, wrap = np.array([[columns], [rows]]), np.array([[periodic[1]], [periodic[0]]])
    texel = image.ravel()
    who = np.arange(texel.size)
    cell = np.stack([who % columns, who // columns])
    at = np.full((2, texel.size), 0.5)
    walked = np.zeros(texel.size)
    # A straight line crosses fewer than 1.5 edges a pixel; a bent one may cut more corners.
    for _ in range(int(2 * half.max()) + 4):
        here = cell[1] * columns + cell[0]
        ahead = direction[:, here]
        step, crossed = _to_edge(at, ahead, half[who] - walked)
        after = walked + step
        weight = kernel(after, half[who]) - kernel(walked, half[who])
        total[who] += weight * texel[here]
        weights[who] += weight
        at = np.where(crossed, ahead < 0, at + ahead * step)
        cell = cell + np.where(crossed, np.sign(ahead), 0).astype(np.intp)
        cell = np.where(wrap, cell % size, cell)
        on = crossed.any(axis=0) & ((cell >= 0) & (cell < size)).all(axis=0)
        if not on.any():
            return
        who, cell, at, walked = who[on], cell[:, on], at[:, on], after[on]


def _to_edge(at: Floats, ahead: Floats, left: Floats) -> tuple[Floats, Bools]:
    """Length of the line inside its pixel, (N,), and the axes along which it then leaves, (2, N).

    ``at`` is the position inside the pixel, from 0 to 1. A line that has no more than ``left`` to
    go, or no vector, leaves along none.
    """
    room = np.where(ahead > 0, 1 - at, at)
    edges = np.divide(room, np.abs(ahead), out=np.full_like(at, np.inf), where=ahead != 0)
    nearest = edges.min(axis=0)
    crossed = (edges <= nearest + CORNER_TOLERANCE_PIXELS) & (nearest < left)
    step = np.where(np.isinf(nearest), 0.0, np.minimum(nearest, left))
    return step, crossed & np.isfinite(edges)
