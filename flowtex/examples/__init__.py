"""Example flows.

Each has up to three functions: ``name()`` returns a ``pyvista.StructuredGrid`` with the point array
``velocity``, ``name_series()`` a list of them, one for each time of a time-varying flow, and
``name_field()`` a :class:`~flowtex.FlowField`, which does not need PyVista. Two xarray datasets
resemble the output of models. Flows that take long to compute are included as files; in a clone
``tools/example_data/build.py`` computes them again.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.arguments import checked_number
from flowtex._util.array_types import Floats
from flowtex.errors import FieldError, require_pyvista
from flowtex.examples import _shipped
from flowtex.examples._shipped import ocean, weather
from flowtex.field import FlowField

if TYPE_CHECKING:
    import pyvista as pv

__all__ = [
    "NAMES",
    "airfoil",
    "airfoil_field",
    "cylinder",
    "cylinder_field",
    "cylinder_series",
    "delta_wing",
    "delta_wing_field",
    "double_gyre",
    "double_gyre_field",
    "double_gyre_series",
    "double_gyre_velocity",
    "ocean",
    "to_grid",
    "to_series",
    "vortex",
    "vortex_field",
    "vortex_series",
    "weather",
]

AMPLITUDE = 0.1  #: Amplitude of the streamfunction of the double gyre.
EPSILON = 0.25  #: Amplitude of the oscillating border between the two cells.
PERIOD = 10.0  #: Period of the oscillation.


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
        times = np.linspace(0.0, PERIOD, 41)
    else:
        times = np.zeros(1)
    return double_gyre_at(times, points, EPSILON if time_varying else 0.0)


def double_gyre_at(times: Floats, points: Floats, epsilon: float) -> FlowField:
    """Return the double gyre at times (T,) and points (J, I, 2)."""
    return FlowField.from_arrays(
        points,
        [double_gyre_velocity(points, t, epsilon=epsilon) for t in times],
        times=times,
        periodic="",
        scalars={"vorticity": [gyre_vorticity(points, t, epsilon) for t in times]},
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


def double_gyre(time: float = 0.0) -> pv.StructuredGrid:
    """Return the double gyre at one time of its period of 10.

    Parameters
    ----------
    time : float, default: 0.0
        Any time; at 0 the two gyres have the same size, as in the steady flow.

    Returns
    -------
    pyvista.StructuredGrid
        201 x 101 x 1 nodes on [0, 2] x [0, 1] with arrays ``velocity`` and ``vorticity``.

    Examples
    --------
    >>> import flowtex
    >>> flowtex.examples.double_gyre(time=2.5)["velocity"].shape
    (20301, 3)
    """
    most = sys.float_info.max
    time = checked_number("time", time, -most, most, expected="a finite number such as 2.5")
    return to_grid(double_gyre_at(np.array([time]), gyre_nodes((101, 201)), EPSILON))


def double_gyre_series() -> list[pv.StructuredGrid]:
    """Return one period of :func:`~flowtex.examples.double_gyre`, 41 times from 0 to 10.

    Returns
    -------
    list of pyvista.StructuredGrid

    Examples
    --------
    >>> import flowtex
    >>> float(flowtex.examples.double_gyre_series()[-1].field_data["TimeValue"][0])
    10.0
    """
    return to_series(double_gyre_field(time_varying=True))


def to_grid(field: FlowField, step: int = -1) -> pv.StructuredGrid:
    """Return one time step of a field as a mesh.

    Parameters
    ----------
    field : FlowField
        Surface and velocity.
    step : int, default: -1
        Index of the time step; the last by default.

    Returns
    -------
    pyvista.StructuredGrid
        I x J x 1 nodes with the point array ``velocity``, the field's scalars, and the field
        data ``TimeValue`` if the field is time-varying. Nodes without data are hidden.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.cylinder_field()
    >>> flowtex.examples.to_grid(field, step=0).save("first.vts")
    """
    require_pyvista("a mesh")
    import pyvista as pv

    rows, columns = field.shape
    grid = pv.StructuredGrid()
    grid.points = field.points.reshape(-1, 3)
    grid.dimensions = (columns, rows, 1)
    grid.point_data["velocity"] = field.velocity[step].reshape(-1, 3)
    for name, values in field.scalars.items():
        step_values = values[step if len(values) > 1 else 0]
        if name in field.on_cells:
            grid.cell_data[name] = step_values[:-1, :-1].ravel()
        else:
            grid.point_data[name] = step_values.ravel()
    if not field.steady:
        grid.field_data["TimeValue"] = np.array([field.times[step]])
    if not field.valid.all():
        grid.hide_points((~field.valid).ravel().tolist())
    return grid


def to_series(field: FlowField) -> list[pv.StructuredGrid]:
    """Return every time step of a field, each as from :func:`~flowtex.examples.to_grid`.

    Returns
    -------
    list of pyvista.StructuredGrid

    Examples
    --------
    >>> import flowtex
    >>> len(flowtex.examples.to_series(flowtex.examples.cylinder_field()))
    31
    """
    return [to_grid(field, step) for step in range(len(field.times))]


_DOC = """Return {times} of :func:`~flowtex.examples.{field}`, {form}.

Returns
-------
pyvista.StructuredGrid or list of pyvista.StructuredGrid

Examples
--------
>>> import flowtex
>>> made = flowtex.examples.{name}()
"""


def _made(field: Callable[..., FlowField], convert: Callable[[FlowField], Any]) -> Any:
    """Return the function of an example that converts its field to meshes."""

    def make() -> Any:
        return convert(field())

    times = "the last time"
    form = "as from :func:`~flowtex.examples.to_grid`"
    suffix = ""
    if convert is to_series:
        times = "all times"
        form = "as from :func:`~flowtex.examples.to_series`"
        suffix = "_series"
    make.__name__ = make.__qualname__ = name = field.__name__.replace("_field", suffix)
    make.__doc__ = _DOC.format(times=times, field=field.__name__, form=form, name=name)
    return make


cylinder: Callable[[], pv.StructuredGrid] = _made(cylinder_field, to_grid)
cylinder_series: Callable[[], list[pv.StructuredGrid]] = _made(cylinder_field, to_series)
vortex: Callable[[], pv.StructuredGrid] = _made(vortex_field, to_grid)
vortex_series: Callable[[], list[pv.StructuredGrid]] = _made(vortex_field, to_series)
airfoil: Callable[[], pv.StructuredGrid] = _made(airfoil_field, to_grid)
delta_wing: Callable[[], pv.StructuredGrid] = _made(delta_wing_field, to_grid)


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
