"""The structure of a flow: critical points, and the lines between them."""

from __future__ import annotations

from flowtex.trace.structure.critical_points import (
    KINDS,
    CriticalPoint,
    CriticalPoints,
    critical_points,
)
from flowtex.trace.structure.separatrices import (
    Separatrices,
    Separatrix,
    separatrices,
    separatrices_between,
)

__all__ = [
    "KINDS",
    "CriticalPoint",
    "CriticalPoints",
    "Separatrices",
    "Separatrix",
    "critical_points",
    "separatrices",
    "separatrices_between",
]
