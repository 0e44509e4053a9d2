"""The Earth: projections, coastlines, meridians and parallels."""

from __future__ import annotations

from flowtex.field.earth.projection import Projection

__all__ = ["Projection"]
