"""The double gyre: two counter-rotating cells whose common border swings to and fro.

Shadden, Lekien and Marsden, Physica D 212 (2005) 271-304, example 1: the streamfunction is
``A sin(pi f(x, t)) sin(pi y)`` on [0, 2] x [0, 1] with ``f = a x^2 + (1 - 2 a) x`` and
``a = epsilon sin(omega t)``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import Floats
from flowtex.errors import FieldError

AMPLITUDE, EPSILON, PERIOD = 0.1, 0.25, 10.0


def double_gyre_velocity(
    points: ArrayLike,
    time: float = 0.0,
    *,
    amplitude: float = AMPLITUDE,
    epsilon: float = EPSILON,
    period: float = PERIOD,
) -> Floats:
    """Return the exact velocity of the double gyre at any points and time.

    Parameters
    ----------
    points : array_like, shape (..., 2) or (..., 3)
        Positions in [0, 2] x [0, 1]; a third coordinate is not used.
    time : float, default: 0.0
        Time of the velocity.
    amplitude : float, default: 0.1
        A, the strength of the two cells.
    epsilon : float, default: 0.25
        Amplitude of the oscillation of the border between the cells; 0 makes the flow steady.
    period : float, default: 10.0
        Period of the oscillation.

    Returns
    -------
    ndarray, same shape as `points`
        Velocity in units of length per unit of time; a third component is zero.

    Raises
    ------
    FieldError
        When the points have neither two nor three components.

    Examples
    --------
    >>> from flowtex.examples import double_gyre_velocity
    >>> double_gyre_velocity([0.5, 0.25]).round(3)
    array([-0.222,  0.   ])
    """
    positions = np.asarray(points, dtype=np.float64)
    if positions.ndim == 0 or positions.shape[-1] not in (2, 3):
        message = (
            f"points has shape {positions.shape}, expected (..., 2) or (..., 3); stack x and y "
            "with np.stack([x, y], axis=-1)"
        )
        raise FieldError(message)
    f, slope, _ = _border(positions[..., 0], time, epsilon, period)
    y = np.pi * positions[..., 1]
    velocity = np.zeros_like(positions)
    velocity[..., 0] = -np.pi * amplitude * np.sin(np.pi * f) * np.cos(y)
    velocity[..., 1] = np.pi * amplitude * np.cos(np.pi * f) * np.sin(y) * slope
    return velocity


def vorticity(points: Floats, time: float, epsilon: float = EPSILON) -> Floats:
    """Return exact vorticity (...,) at points (..., 2), with the usual amplitude and period."""
    f, slope, bend = _border(points[..., 0], time, epsilon, PERIOD)
    sine, cosine = np.sin(np.pi * f), np.cos(np.pi * f)
    across = np.pi * AMPLITUDE * np.sin(np.pi * points[..., 1])
    return np.asarray(across * (cosine * bend - np.pi * sine * (slope**2 + 1.0)))


def nodes(shape: tuple[int, int]) -> Floats:
    """Return evenly spaced nodes (J, I, 2) of [0, 2] x [0, 1] for a shape (J, I)."""
    rows, columns = shape
    x, y = np.meshgrid(np.linspace(0.0, 2.0, columns), np.linspace(0.0, 1.0, rows))
    return np.stack([x, y], axis=-1)


def _border(x: Floats, time: float, epsilon: float, period: float) -> tuple[Floats, Floats, Floats]:
    """Return the function f, and its first and second derivative by x."""
    a = epsilon * np.sin(2.0 * np.pi * time / period)
    return a * x**2 + (1.0 - 2.0 * a) * x, 2.0 * a * x + 1.0 - 2.0 * a, np.full_like(x, 2.0 * a)
