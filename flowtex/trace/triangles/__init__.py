"""Paths on surfaces of triangles: short ones are integrated, long ones composed of these."""

from __future__ import annotations

from flowtex.trace.triangles.trace import triangle_paths, triangle_slices

__all__ = ["triangle_paths", "triangle_slices"]
