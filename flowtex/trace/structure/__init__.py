"""The structure of a flow: critical points, and the lines between them."""

from __future__ import annotations

from flowtex.trace.structure.critical_points import (
    KINDS,
    CriticalPoint,
    CriticalPoints,
    critical_points,
    formula_rates,
)
from flowtex.trace.structure.nullclines import nullclines, view_window
from flowtex.trace.structure.orbits import ClosedOrbit, closed_orbits, orbits_around
from flowtex.trace.structure.separatrices import (
    Separatrices,
    Separatrix,
    separatrices,
    separatrices_between,
)

__all__ = [
    "KINDS",
    "ClosedOrbit",
    "CriticalPoint",
    "CriticalPoints",
    "Separatrices",
    "Separatrix",
    "closed_orbits",
    "critical_points",
    "formula_rates",
    "nullclines",
    "orbits_around",
    "separatrices",
    "separatrices_between",
    "view_window",
]
