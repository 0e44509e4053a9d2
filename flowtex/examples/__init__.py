"""Example flows.

Each has up to three functions: ``name()`` returns a ``pyvista.StructuredGrid`` with the point array
``velocity``, ``name_series()`` a list of them, one for each time of a time-varying flow, and
``name_field()`` a :class:`~flowtex.FlowField`, which does not need PyVista. Two xarray datasets
resemble the output of models. Flows that take long to compute are included as files; in a clone
``tools/example_data/build.py`` computes them again.
"""

from __future__ import annotations

from flowtex.examples._shipped import ocean, weather
from flowtex.examples.analytic import double_gyre_velocity
from flowtex.examples.fields import (
    NAMES,
    airfoil_field,
    cylinder_field,
    delta_wing_field,
    double_gyre_field,
    vortex_field,
)
from flowtex.examples.grids import (
    airfoil,
    cylinder,
    cylinder_series,
    delta_wing,
    double_gyre,
    double_gyre_series,
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
    "ocean",
    "to_grid",
    "to_series",
    "vortex",
    "vortex_field",
    "vortex_series",
    "weather",
]
