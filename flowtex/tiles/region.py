"""From a part of a level, with what lies around it, to the tile in its middle.

Nothing else is needed than that part and a few numbers of the whole surface. Tiles that are made
for a view, in a task of their own or on another machine are therefore the same, bit for bit.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flowtex.field import FlowField
from flowtex.field.surface import Surface
from flowtex.textures import TextureSet
from flowtex.textures.geometry import SurfaceGeometry
from flowtex.trace import SliceStore

#: Share of its length up to which a path must not be cut, and of the paths of a tile that may be.
NEEDED_SHARE, MOST_CUT_SHARE = 0.75, 5e-3


class Whole(NamedTuple):
    """What all tiles have from the whole surface.

    Attributes
    ----------
    surface
        That of the coarsest level, whose frame, middle and size the tiles have.
    speed
        Typical speed of the flow.
    cell
        Size of its small cells.
    parameter, lines
        As for :class:`~flowtex.trace.SliceStore`.
    """

    surface: Surface
    speed: float
    cell: float
    parameter: str
    lines: str


class Region(NamedTuple):
    """A part of a level: a tile, and a halo as wide as its paths are long.

    Attributes
    ----------
    field
        The flow there.
    drawn
        Rows and columns of the tile.
    open_sides
        Whether the surface goes on before and after the rows, and the columns.
    longest
        Length of the paths.
    compose
        Whether there are so few nodes that paths may be composed.
    """

    field: FlowField
    drawn: tuple[slice, slice]
    open_sides: tuple[tuple[bool, bool], tuple[bool, bool]]
    longest: float
    compose: bool


def tile_of(region: Region, whole: Whole) -> TextureSet:
    """Return the textures of the tile in a region; layers are traced when they are asked for."""
    field, longest = region.field, region.longest
    geometry = SurfaceGeometry.of_tile(field, region.drawn, whole.surface, region.open_sides)
    nodes = np.zeros(field.shape, dtype=bool)
    nodes[geometry.texels] = True
    store = SliceStore(
        field,
        parameter=whole.parameter,
        lines=whole.lines,
        compose=(field.steady or whole.lines == "streamlines") and region.compose,
        longest=longest,
        cell=whole.cell,
        nodes=nodes,
    )
    return TextureSet(geometry, store, whole_speed=whole.speed, longest=longest)


def is_cut(textures: TextureSet, step: int) -> bool:
    """Whether paths of a tile end where its window does, though the surface goes on.

    Slices may have longer lags than are needed: they double. The last part of a path weighs little.
    What lies around a tile of triangles is as wide as its paths are long.
    """
    if not isinstance(textures.geometry, SurfaceGeometry):
        return False
    slices = textures.store.at(step).part(*textures.geometry.texels)
    needed = NEEDED_SHARE * textures.longest / (slices.unit * textures.pace)
    for moved, reach in (
        (slices.displacement, slices.reach),
        (slices.forward, slices.forward_reach),
    ):
        if moved is None or reach is None:
            continue
        there = slices.nodes + moved[0, -1]
        gone = np.zeros(reach[0].shape, dtype=bool)
        for axis, (before, after) in enumerate(textures.grid.open_sides):
            at, last = there[..., 1 - axis], textures.geometry.field.shape[axis] - 1
            gone |= (before & (at < 0)) | (after & (at > last))
        if (gone & (reach[0] < needed)).mean() > MOST_CUT_SHARE:
            return True
    return False
