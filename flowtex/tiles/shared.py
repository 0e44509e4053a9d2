"""The pyramid of a field, whatever its surface is made of."""

from __future__ import annotations

from flowtex._util.cache import WeakCache
from flowtex.field import FlowField
from flowtex.tiles.pyramid import Pyramid
from flowtex.tiles.triangle_pyramid import TrianglePyramid

__all__ = ["shared_pyramid"]

_pyramids: WeakCache[Pyramid] = WeakCache()


def shared_pyramid(field: FlowField, parameter: str, lines: str = "pathlines") -> Pyramid:
    """Return the pyramid of a field, one for all that show the field at the same time."""
    kind = Pyramid if field.triangles is None else TrianglePyramid
    # A pyramid keeps its field alive, so the number of the field is its own meanwhile.
    key = (id(field), parameter, lines)
    return _pyramids.get(key, lambda: kind(field, parameter, lines))
