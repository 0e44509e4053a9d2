"""A field on fewer nodes, for a first picture or a search."""

from __future__ import annotations

import numpy as np

from flowtex.field import FlowField
from flowtex.textures.tiles import triangle_pyramid
from flowtex.textures.tiles.clusters import levels_of


def coarsened_field(field: FlowField, nodes: int) -> FlowField:
    """Return a field with about this many nodes: some of its lines, with the first and the last.

    Nodes of triangles are averaged over bins, at most this many. A smaller field is returned as it
    is, and so is one on triangles that is so large that it has levels.
    """
    if field.valid.size <= nodes:
        return field
    if field.triangles is not None:
        has_levels = field.valid.size > triangle_pyramid.ROOT_NODES
        return field if has_levels else levels_of(field, nodes)[-1].field
    share = np.sqrt(nodes / field.valid.size)
    rows, columns = (
        np.unique(np.rint(np.linspace(0, n - 1, max(int(n * share), min(n, 8)))).astype(int))
        for n in field.shape
    )
    return field.at_lines(rows, columns)
