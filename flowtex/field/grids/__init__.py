"""Structured surfaces: how their axes close, their geometry, and values at their nodes."""
