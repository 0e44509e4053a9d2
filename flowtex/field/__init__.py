"""Surface and velocity, as arrays on a mesh."""

from __future__ import annotations

from flowtex.errors import FieldError
from flowtex.field.field import FlowField
from flowtex.field.triangles.triangle_surface import Surface

__all__ = ["FieldError", "FlowField", "Surface"]
