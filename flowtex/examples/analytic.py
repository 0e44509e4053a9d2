"""Velocities of the example flows that have a formula, as arrays."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import Floats
from flowtex.errors import FieldError

AMPLITUDE = 0.1  #: Amplitude of the streamfunction of the double gyre.
EPSILON = 0.25  #: Amplitude of the oscillating border between the two cells.
PERIOD = 10.0  #: Period of the oscillation.


def double_gyre_velocity(
    points: ArrayLike, time: float = 0.0, *, epsilon: float = EPSILON
) -> Floats:
    """Return the exact velocity of the double gyre at any points and time.

    Parameters
    ----------
    points : array_like, shape (..., 2) or (..., 3)
        Positions in [0, 2] x [0, 1]; a third coordinate is not used.
    time : float, default: 0.0
        Time of the velocity.
    epsilon : float, default: 0.25
        Amplitude of the oscillation of the border between the cells; 0 makes the flow steady.

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
        raise FieldError(
            f"points has shape {positions.shape}, expected (..., 2) or (..., 3); stack x and y "
            "with np.stack([x, y], axis=-1)"
        )
    f, slope, _ = _border(positions[..., 0], time, epsilon)
    y = np.pi * positions[..., 1]
    velocity = np.zeros_like(positions)
    velocity[..., 0] = -np.pi * AMPLITUDE * np.sin(np.pi * f) * np.cos(y)
    velocity[..., 1] = np.pi * AMPLITUDE * np.cos(np.pi * f) * np.sin(y) * slope
    return velocity


def gyre_vorticity(points: Floats, time: float, epsilon: float = EPSILON) -> Floats:
    """Return exact vorticity (...,) at points (..., 2)."""
    f, slope, bend = _border(points[..., 0], time, epsilon)
    sine = np.sin(np.pi * f)
    cosine = np.cos(np.pi * f)
    across = np.pi * AMPLITUDE * np.sin(np.pi * points[..., 1])
    return np.asarray(across * (cosine * bend - np.pi * sine * (slope**2 + 1.0)))


def gyre_nodes(shape: tuple[int, int]) -> Floats:
    """Return evenly spaced nodes (J, I, 2) of [0, 2] x [0, 1] for a shape (J, I)."""
    rows, columns = shape
    x, y = np.meshgrid(np.linspace(0.0, 2.0, columns), np.linspace(0.0, 1.0, rows))
    return np.stack([x, y], axis=-1)


def _border(x: Floats, time: float, epsilon: float) -> tuple[Floats, Floats, Floats]:
    """Return the function f, and its first and second derivative by x."""
    a = epsilon * np.sin(2.0 * np.pi * time / PERIOD)
    return a * x**2 + (1.0 - 2.0 * a) * x, 2.0 * a * x + 1.0 - 2.0 * a, np.full_like(x, 2.0 * a)


#: Centre of the circle: a negative real part gives thickness, the imaginary part camber.
CENTER = -0.1 + 0.08j
INCIDENCE = np.radians(8.0)  #: Angle between the free stream and the x axis.
RADIUS = abs(1.0 - CENTER)  #: Radius of the circle.
EDGE = np.angle(1.0 - CENTER)  #: Angle of the trailing edge on the circle.
CIRCULATION = 4.0 * np.pi * RADIUS * np.sin(INCIDENCE - EDGE)  #: Circulation, clockwise.
_CIRCLE = CENTER + RADIUS * np.exp(1j * (EDGE + np.linspace(0.0, 2.0 * np.pi, 4001)))
CHORD = np.ptp((_CIRCLE + 1.0 / _CIRCLE).real)  #: Extent of the mapped airfoil along x.


def airfoil_arrays(shape: tuple[int, int], extent: float) -> tuple[Floats, Floats]:
    """Return nodes (J, I, 2), outwards and around, and the velocity (J, I, 2) there.

    ``z = s + 1 / s`` maps the circle around ``CENTER`` through 1 to the airfoil. Nodes begin at the
    trailing edge, (1, 0), and go clockwise, along the lower side first; the last column repeats the
    first. The outer ring is ``extent`` chords from the airfoil, roughly.
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
    turn = np.exp(1j * INCIDENCE)
    swirl = 1j * CIRCULATION / (2.0 * np.pi)
    flow = 1.0 / turn - RADIUS**2 * turn / s**2 + swirl / s
    stretch = 1.0 - circle**-2.0
    # Both vanish at the trailing edge: there the quotient is that of their derivatives.
    at_edge = np.abs(stretch) < 1e-9
    limit = (2.0 * RADIUS**2 * turn / s**3 - swirl / s**2) * circle**3 / 2.0
    w = np.where(at_edge, limit, flow / np.where(at_edge, 1.0, stretch))
    return np.stack([z.real, z.imag], axis=-1), np.stack([w.real, -w.imag], axis=-1)
