"""Example flows.

Each has up to three functions: ``name()`` returns a ``pyvista.StructuredGrid`` with the point array
``velocity``, ``name_series()`` a list of them, one for each time of a time-varying flow, and
``name_field()`` a :class:`~flowtex.FlowField`, which does not need PyVista.

    cylinder     time-varying   O-grid          viscous vortex shedding, Reynolds number 100
    vortex       time-varying   Cartesian       two-dimensional turbulence, periodic both ways
    double_gyre  either         Cartesian       exact at any point and time
    airfoil      steady         O-grid          exact, cells of very different sizes
    delta_wing   steady         curved surface  a winged body, 52 x 62 nodes

Two xarray datasets resemble the output of models, and need the extra ``xarray``: ``ocean()`` has
eight days of currents with a coast, ``weather()`` global winds.

Flows that take long to compute are included as files; in a clone ``tools/example_data/build.py``
computes them again.
"""

from __future__ import annotations

from flowtex.examples._flows import (
    NAMES,
    airfoil,
    airfoil_field,
    cylinder,
    cylinder_field,
    cylinder_series,
    delta_wing,
    delta_wing_field,
    double_gyre,
    double_gyre_field,
    double_gyre_series,
    double_gyre_velocity,
    to_grid,
    to_series,
    vortex,
    vortex_field,
    vortex_series,
)
from flowtex.examples._shipped import ocean, weather

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
