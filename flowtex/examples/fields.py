"""Example flows as fields, which do not need PyVista."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.examples import _shipped
from flowtex.examples.analytic import (
    EPSILON,
    PERIOD,
    airfoil_arrays,
    double_gyre_velocity,
    gyre_nodes,
    gyre_vorticity,
)
from flowtex.field import FlowField


def cylinder_field() -> FlowField:
    """Return one period of vortex shedding behind a circular cylinder, Reynolds number 100.

    A solution of the two-dimensional Navier-Stokes equations in vorticity and streamfunction,
    with Fourier modes around the cylinder and fourth-order differences outwards.

    Returns
    -------
    FlowField
        31 times, the last one period after the first, on an O-grid of 65 circles (j, from the wall
        outwards to a radius of 15) and 161 nodes around (i, anticlockwise from straight downstream,
        so that the wake crosses the seam where the first and last column coincide). Lengths are in
        diameters, speeds in free-stream speeds; the scalar is ``vorticity``.

    Notes
    -----
    Numbers are rounded to 16 bits, velocities with an error of at most 3e-5 free-stream speeds.

    Examples
    --------
    >>> import flowtex
    >>> len(flowtex.examples.cylinder_field().times)
    31
    """
    points, velocity, vorticity, times = _shipped.cylinder_arrays()
    return FlowField.from_arrays(
        points,
        velocity,
        times=times,
        periodic="i",
        scalars={"vorticity": vorticity},
        name="cylinder",
        length_unit="diameters",
        time_unit="diameters / free-stream speed",
    )


def vortex_field() -> FlowField:
    """Return vortices of decaying two-dimensional turbulence in a periodic box.

    A solution of the Navier-Stokes equations by a dealiased pseudo-spectral method, with the shape
    of the vortex dataset of Li and Shen.

    Returns
    -------
    FlowField
        31 times, 0.04 apart, and 100 x 100 nodes on [0, 1] x [0, 1], periodic along both axes: the
        last row and column repeat the first. The root-mean-square speed was 1 before the vortices
        formed. The scalar is ``vorticity``. All units are arbitrary.

    Examples
    --------
    >>> import flowtex
    >>> flowtex.examples.vortex_field().periodic
    (True, True)
    """
    points, velocity, vorticity, times = _shipped.vortex_arrays()
    return FlowField.from_arrays(
        points,
        velocity,
        times=times,
        periodic="ij",
        scalars={"vorticity": vorticity},
        name="vortex",
        length_unit="boxes",
    )


def double_gyre_field(
    time_varying: bool = False,  # noqa: FBT001, FBT002 - the one choice, and clear by its name
    shape: tuple[int, int] = (101, 201),
) -> FlowField:
    """Return the double gyre, two cells whose common border swings to and fro, exact at the nodes.

    Parameters
    ----------
    time_varying : bool, default: False
        Whether the border between the gyres oscillates: 41 times over one period of 10 units of
        time, the last equal to the first. Otherwise the flow is steady (epsilon = 0).
    shape : tuple of int, default: (101, 201)
        Number of nodes (J, I) on [0, 2] x [0, 1].

    Returns
    -------
    FlowField
        The scalar is ``vorticity``; all units are arbitrary.

    Notes
    -----
    Shadden, Lekien and Marsden, Physica D 212 (2005) 271-304, example 1: the streamfunction is
    ``A sin(pi f(x, t)) sin(pi y)`` with ``f = a x^2 + (1 - 2 a) x``, ``a = epsilon sin(omega t)``.

    Examples
    --------
    >>> import flowtex
    >>> gyre = flowtex.examples.double_gyre_field(time_varying=True, shape=(21, 41))
    >>> gyre.velocity.shape
    (41, 21, 41, 3)
    """
    points = gyre_nodes(shape)
    if time_varying:
        return double_gyre_at(np.linspace(0.0, PERIOD, 41), points, EPSILON)
    return double_gyre_at(np.zeros(1), points, 0.0)


def double_gyre_at(times: Floats, points: Floats, epsilon: float) -> FlowField:
    """Return the double gyre at times (T,) and points (J, I, 2)."""
    return FlowField.from_arrays(
        points,
        [double_gyre_velocity(points, time, epsilon=epsilon) for time in times],
        times=times,
        periodic="",
        scalars={"vorticity": [gyre_vorticity(points, time, epsilon) for time in times]},
        name="double gyre",
    )


def airfoil_field(shape: tuple[int, int] = (65, 193), extent: float = 2.5) -> FlowField:
    """Return the steady flow around a cambered Joukowski airfoil, exact at the nodes.

    Parameters
    ----------
    shape : tuple of int, default: (65, 193)
        Number of nodes (J, I) of the O-grid: rings from the wall outwards, and nodes from the
        trailing edge clockwise, the last of which coincides with the first.
    extent : float, default: 2.5
        Distance of the outermost ring from the middle of the airfoil, in chords.

    Returns
    -------
    FlowField
        Lengths are in chords and speeds in free-stream speeds; the angle of attack is 8 degrees.
        The scalar ``pressure`` is the pressure coefficient, 1 at stagnation points.

    Notes
    -----
    The flow is inviscid: it slips along the wall, and leaves the cusped trailing edge smoothly (the
    Kutta condition). The areas of cells differ by a factor of more than 100,000.

    Examples
    --------
    >>> import flowtex
    >>> flowtex.examples.airfoil_field(shape=(33, 97)).size_text
    '97 x 33 nodes (I x J)'
    """
    points, velocity = airfoil_arrays(shape, extent)
    return FlowField.from_arrays(
        points,
        velocity,
        periodic="i",
        scalars={"pressure": 1.0 - np.sum(velocity**2, axis=-1)},
        name="airfoil",
        length_unit="chords",
        time_unit="chords / free-stream speed",
    )


def delta_wing_field() -> FlowField:
    """Return the steady flow over the upper side of a winged body like a shuttle orbiter.

    A curved surface and a flow along it in closed form. It replaces the shuttle dataset of Li and
    Shen, which was not published, and has the same number of nodes.

    Returns
    -------
    FlowField
        52 nodes across (j, from the left edge to the right) and 62 from nose to tail (i). Lengths
        are in body lengths, with x along the body and z upward, and speeds in free-stream speeds;
        the angle of attack is 12 degrees. The scalar is ``height``.

    Notes
    -----
    The flow separates along one line of each wing and attaches along another, as beneath the
    vortices of a real wing, but it is synthetic: it does not solve an equation of motion. The areas
    of cells differ by a factor of more than 100.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.delta_wing_field()
    >>> field.surface.frame is None  # it is curved
    True
    """
    file = _shipped.load(_shipped.DELTA_WING)
    points = file["points"]
    velocity = file["velocity"]
    return FlowField.from_arrays(
        points,
        velocity,
        periodic="",
        scalars={"height": points[..., 2]},
        name="delta wing",
        length_unit="body lengths",
        time_unit="body lengths / free-stream speed",
    )


#: Names under which the examples are offered, each with the function that makes its field.
NAMES: dict[str, Callable[[], FlowField]] = {
    "cylinder": cylinder_field,
    "vortex": vortex_field,
    "double_gyre": double_gyre_field,
    "airfoil": airfoil_field,
    "delta_wing": delta_wing_field,
}
