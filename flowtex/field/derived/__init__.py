"""Scalars that are computed from the velocity at the nodes."""

from __future__ import annotations

from flowtex.field.derived.gradient import NodeGradient, node_gradient, true_positions
from flowtex.field.derived.scalars import (
    DERIVED,
    FOLLOWED,
    LONG_NAMES,
    derived_steps,
    derived_unit,
    followed_steps,
    speed_unit,
)

__all__ = [
    "DERIVED",
    "FOLLOWED",
    "LONG_NAMES",
    "NodeGradient",
    "derived_steps",
    "derived_unit",
    "followed_steps",
    "node_gradient",
    "speed_unit",
    "true_positions",
]
