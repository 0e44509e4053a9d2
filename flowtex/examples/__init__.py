"""Flows to try flowtex on: computed by code in this package, or loaded from well-known files.

Each comes three ways: ``name()`` is one ``pyvista.StructuredGrid`` with the point array
``velocity``, ``name_series()`` a list of them, one for each instant of a time-varying flow, and
``name_field()`` the :class:`~flowtex.FlowField` behind both, which needs no PyVista.

    cylinder     time-varying   O-grid          viscous vortex shedding, Reynolds number 100
    vortex       time-varying   Cartesian       two-dimensional turbulence, periodic both ways
    double_gyre  either         Cartesian       exact at any point and time
    airfoil      steady         O-grid          exact, cells of very different sizes
    delta_wing   steady         curved surface  a winged body, 52 x 62 nodes
    liquid_oxygen_post  steady  plane of a 3D grid   a file of NASA's, not shipped

What takes long to compute is shipped as a file; ``python -m flowtex.examples.build`` makes those
files again.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flowtex.examples._double_gyre import EPSILON, double_gyre_velocity, nodes
from flowtex.examples._fields import (
    NAMES,
    _double_gyre_at,
    airfoil_field,
    cylinder_field,
    delta_wing_field,
    double_gyre_field,
    liquid_oxygen_post_field,
    vortex_field,
)
from flowtex.examples._grids import to_grid, to_series

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
    "liquid_oxygen_post",
    "liquid_oxygen_post_field",
    "to_grid",
    "to_series",
    "vortex",
    "vortex_field",
    "vortex_series",
]


def cylinder() -> pv.StructuredGrid:
    """Vortex shedding behind a cylinder, Reynolds number 100: the last instant of the series.

    Returns
    -------
    pyvista.StructuredGrid
        161 x 65 x 1 nodes around and outwards, lengths in diameters; point arrays ``velocity``
        (free-stream speeds) and ``vorticity``, and the field data ``TimeValue``.

    See Also
    --------
    cylinder_series : The whole period.
    cylinder_field : The same as arrays; its documentation has the details.
    """
    return to_grid(cylinder_field())


def cylinder_series() -> list[pv.StructuredGrid]:
    """One period of vortex shedding behind a cylinder, Reynolds number 100.

    Returns
    -------
    list of pyvista.StructuredGrid
        31 instants as from :func:`cylinder`, the last one period after the first.
    """
    return to_series(cylinder_field())


def vortex() -> pv.StructuredGrid:
    """Vortices of two-dimensional turbulence: the last instant of the series.

    Returns
    -------
    pyvista.StructuredGrid
        100 x 100 x 1 nodes on the unit square, periodic along both axes; point arrays
        ``velocity`` and ``vorticity``, and the field data ``TimeValue``.

    See Also
    --------
    vortex_series : All 31 instants.
    vortex_field : The same as arrays; its documentation has the details.
    """
    return to_grid(vortex_field())


def vortex_series() -> list[pv.StructuredGrid]:
    """Vortices of two-dimensional turbulence.

    Returns
    -------
    list of pyvista.StructuredGrid
        31 instants as from :func:`vortex`.
    """
    return to_series(vortex_field())


def double_gyre(time: float = 0.0) -> pv.StructuredGrid:
    """Double gyre at one time of its period of 10.

    Parameters
    ----------
    time : float, default: 0.0
        Any time; at 0 the two gyres are of one size, as in the steady flow.

    Returns
    -------
    pyvista.StructuredGrid
        201 x 101 x 1 nodes on [0, 2] x [0, 1], with point arrays ``velocity`` and
        ``vorticity``.

    Raises
    ------
    ValueError
        When the time is not a finite number.
    """
    if not np.isfinite(time):
        message = f"time is {time!r}, expected a finite number such as 2.5"
        raise ValueError(message)
    return to_grid(_double_gyre_at(np.array([time]), nodes((101, 201)), EPSILON))


def double_gyre_series() -> list[pv.StructuredGrid]:
    """One period of the double gyre.

    Returns
    -------
    list of pyvista.StructuredGrid
        41 instants as from :func:`double_gyre`, with ``TimeValue`` from 0 to 10.
    """
    return to_series(double_gyre_field(time_varying=True))


def airfoil() -> pv.StructuredGrid:
    """Lifting flow around a Joukowski airfoil, steady and exact.

    Returns
    -------
    pyvista.StructuredGrid
        193 x 65 x 1 nodes around and outwards, lengths in chords; point arrays ``velocity``
        (free-stream speeds) and ``pressure`` (the pressure coefficient).

    See Also
    --------
    airfoil_field : The same as arrays; its documentation has the details.
    """
    return to_grid(airfoil_field())


def delta_wing() -> pv.StructuredGrid:
    """Flow over the upper side of a winged body, steady, on a curved surface.

    Returns
    -------
    pyvista.StructuredGrid
        62 x 52 x 1 nodes along and across, lengths in body lengths; point arrays ``velocity``
        and ``height``.

    See Also
    --------
    delta_wing_field : The same as arrays; its documentation has the details.
    """
    return to_grid(delta_wing_field())


def liquid_oxygen_post(folder: str | Path | None = None, plane: str = "k=20") -> pv.StructuredGrid:
    """Flow around NASA's liquid-oxygen post, one plane of a curvilinear grid.

    Parameters
    ----------
    folder : str or Path, optional
        Folder with ``postxyz.bin`` and ``postq.bin``; by default PyVista downloads them.
    plane : str, default: "k=20"
        Plane of the 38 x 76 x 38 nodes, such as ``"k=1"`` or ``"j=19"``.

    Returns
    -------
    pyvista.StructuredGrid
        The nodes of the plane, with the point array ``velocity`` and the scalars of the file.

    Raises
    ------
    FileNotFoundError
        When the folder lacks one of the files, or they cannot be downloaded.
    FieldError
        When there is no such plane, or nothing moves on it.
    """
    return to_grid(liquid_oxygen_post_field(folder, plane))
