"""The pyramid of a field of any kind, one for all that show the field at the same time."""

from __future__ import annotations

from collections.abc import Callable
from weakref import WeakKeyDictionary

import numpy as np

from flowtex._util.cache import WeakCache
from flowtex.field import FlowField
from flowtex.textures.tiles import triangle_pyramid
from flowtex.textures.tiles.clusters import Levels
from flowtex.textures.tiles.grid_pyramid import GridPyramid
from flowtex.textures.tiles.pyramid import Pyramid
from flowtex.textures.tiles.triangle_pyramid import TrianglePyramid

#: Functions that make the pyramids of fields that do not hold all their levels.
_attached: WeakKeyDictionary[FlowField, Callable[[FlowField, str, str], Pyramid]]
_attached = WeakKeyDictionary()
_pyramids: WeakCache[Pyramid] = WeakCache()


def attach_pyramid(field: FlowField, make: Callable[[FlowField, str, str], Pyramid]) -> None:
    """Attach a pyramid to a field, made for a parameter and lines."""
    _attached[field] = make


def has_pyramid(field: FlowField) -> bool:
    """Return whether a field has an attached pyramid."""
    return field in _attached


def shared_pyramid(field: FlowField, parameter: str, lines: str = "pathlines") -> Pyramid:
    """Return the pyramid of a field, one for all that show the field at the same time."""
    kind: type[GridPyramid | TrianglePyramid]
    if field.triangles is None:
        kind = GridPyramid
    else:
        kind = TrianglePyramid
    make = _attached.get(field, kind)
    # A pyramid keeps its field alive, so the id stays unique.
    key = (id(field), parameter, lines)
    return _pyramids.get(key, lambda: make(field, parameter, lines))


def coarsened_field(field: FlowField, nodes: int) -> FlowField:
    """Return a field with about this many nodes: some of its lines, with the first and the last.

    Nodes of triangles are averaged over bins, at most this many. A smaller field is returned as it
    is, and so is one on triangles that is so large that it has levels.
    """
    if field.valid.size <= nodes:
        return field
    if field.triangles is not None:
        has_levels = field.valid.size > triangle_pyramid.ROOT_NODES
        if has_levels:
            return field
        return Levels(field, nodes)[-1].field
    share = np.sqrt(nodes / field.valid.size)
    rows, columns = (
        np.unique(np.rint(np.linspace(0, n - 1, max(int(n * share), min(n, 8)))).astype(int))
        for n in field.shape
    )
    return field.at_lines(rows, columns)
