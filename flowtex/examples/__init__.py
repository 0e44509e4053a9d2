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

Two datasets of xarray's are like those that models write, and need the extra ``xarray``:
``ocean()`` has eight days of currents with a coast, ``weather()`` winds all over the Earth.

What takes long to compute is shipped as a file; in a checkout ``tools/example_data/build.py``
computes those files again.
"""

from __future__ import annotations

from flowtex.examples._double_gyre import double_gyre_velocity
from flowtex.examples._earth import ocean, weather
from flowtex.examples._fields import (
    NAMES,
    airfoil_field,
    cylinder_field,
    delta_wing_field,
    double_gyre_field,
    liquid_oxygen_post_field,
    vortex_field,
)
from flowtex.examples._meshes import (
    airfoil,
    cylinder,
    cylinder_series,
    delta_wing,
    double_gyre,
    double_gyre_series,
    liquid_oxygen_post,
    to_grid,
    to_series,
    vortex,
    vortex_series,
)

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
    "ocean",
    "to_grid",
    "to_series",
    "vortex",
    "vortex_field",
    "vortex_series",
    "weather",
]
