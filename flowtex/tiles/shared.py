"""The pyramid of a field, whatever its surface is made of."""

from __future__ import annotations

from collections.abc import Callable

from flowtex._util.cache import WeakCache
from flowtex.field import FlowField
from flowtex.tiles.pyramid import Pyramid
from flowtex.tiles.triangle_pyramid import TrianglePyramid

#: Where a field keeps what makes its pyramid; fields that are made of this one have none.
_OWN = "_pyramid"

_pyramids: WeakCache[Pyramid] = WeakCache()


def have_pyramid(field: FlowField, make: Callable[[FlowField, str, str], Pyramid]) -> None:
    """Give a field levels that it does not hold itself, made for a parameter and lines."""
    field.__dict__[_OWN] = make


def has_pyramid(field: FlowField) -> bool:
    """Whether a field has levels that it does not hold itself."""
    return _OWN in field.__dict__


def shared_pyramid(field: FlowField, parameter: str, lines: str = "pathlines") -> Pyramid:
    """Return the pyramid of a field, one for all that show the field at the same time."""
    kind = Pyramid if field.triangles is None else TrianglePyramid
    make = field.__dict__.get(_OWN, kind)
    # A pyramid keeps its field alive, so the number of the field is its own meanwhile.
    key = (id(field), parameter, lines)
    return _pyramids.get(key, lambda: make(field, parameter, lines))
