"""Structured surfaces: closing of axes, geometry, and values at nodes."""
