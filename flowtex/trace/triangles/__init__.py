"""Paths on surfaces of triangles: short ones are integrated, long ones composed of these."""
