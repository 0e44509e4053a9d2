"""Flows in closed form: the double gyre, and a lifting Joukowski airfoil.

The double gyre is two counter-rotating cells whose common border swings to and fro. Shadden, Lekien
and Marsden, Physica D 212 (2005) 271-304, example 1: the streamfunction is
``A sin(pi f(x, t)) sin(pi y)`` on [0, 2] x [0, 1] with ``f = a x^2 + (1 - 2 a) x`` and
``a = epsilon sin(omega t)``.

The circle of radius R around ``CENTER`` passes through 1, and ``z = s + 1 / s`` maps it to an
airfoil with a cusped trailing edge. The flow around the circle has the one circulation that
makes the flow leave that edge smoothly (the Kutta condition).

    circle's plane                      airfoil's plane, chord 1
    s = CENTER + R exp(eta + i phi)     eta constant: rings, phi constant: lines outwards

Rings crowd at the wall, and the map itself crowds the nodes at the trailing edge, where the first
and last column meet: the flow crosses this seam below the edge and follows it behind.
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


#: Middle of the circle, whose real part, negative, gives thickness and whose imaginary part camber;
#: angle of the stream of unit speed to the x axis.
CENTER, INCIDENCE = -0.1 + 0.08j, np.radians(8.0)
#: Radius of the circle, the angle on it of the trailing edge, and the circulation, clockwise.
RADIUS, EDGE = abs(1.0 - CENTER), np.angle(1.0 - CENTER)
CIRCULATION = 4.0 * np.pi * RADIUS * np.sin(INCIDENCE - EDGE)
_CIRCLE = CENTER + RADIUS * np.exp(1j * (EDGE + np.linspace(0.0, 2.0 * np.pi, 4001)))
#: Extent of the mapped airfoil along x.
CHORD = np.ptp((_CIRCLE + 1.0 / _CIRCLE).real)


def airfoil_arrays(shape: tuple[int, int], extent: float) -> tuple[Floats, Floats]:
    """Return nodes (J, I, 2), outwards and around, and the velocity (J, I, 2) there.

    They begin at the trailing edge, (1, 0), and go clockwise, along the lower side first; the last
    column repeats the first. The outer ring is ``extent`` chords from the airfoil, roughly.
    """
    rows, columns = shape
    angles = EDGE - np.linspace(0.0, 2.0 * np.pi, columns)
    angles[-1] = angles[0]
    out = np.linspace(0.0, 1.0, rows)[:, None]
    # A sixth of the even spacing at the wall; growth from cell to cell stays below a tenth.
    rings = np.log(extent * CHORD / RADIUS) * (out / 6.0 + 5.0 / 6.0 * out**2)
    s = RADIUS * np.exp(rings + 1j * angles)
    circle = CENTER + s
    z = (circle + 1.0 / circle - 2.0) / CHORD + 1.0
    turn, swirl = np.exp(1j * INCIDENCE), 1j * CIRCULATION / (2.0 * np.pi)
    flow = 1.0 / turn - RADIUS**2 * turn / s**2 + swirl / s
    stretch = 1.0 - circle**-2.0
    # Both vanish at the trailing edge: there the quotient is that of their derivatives.
    at_edge = np.abs(stretch) < 1e-9
    limit = (2.0 * RADIUS**2 * turn / s**3 - swirl / s**2) * circle**3 / 2.0
    w = np.where(at_edge, limit, flow / np.where(at_edge, 1.0, stretch))
    return np.stack([z.real, z.imag], axis=-1), np.stack([w.real, -w.imag], axis=-1)
