"""Pyramids in stores: fields larger than memory, built once and drawn from anywhere."""

from __future__ import annotations

from flowtex.pyramid.build import Built, build, verify
from flowtex.pyramid.places import PyramidError, is_store
from flowtex.pyramid.stored import open_store
from flowtex.pyramid.stored import open_store as open

__all__ = ["Built", "PyramidError", "build", "is_store", "open", "open_store", "verify"]
