"""The velocity of a flow, from which a client traces the slices itself.

It takes a fraction of the bytes of slices, and of the time. What travels is the velocity in index
space, the nodes' positions with a ghost line around them, and what is blanked, of all nodes that
paths of the drawn ones may reach. ``shaders/webgl2/trace.glsl`` follows the paths, the first cells
with steps of half a cell, and composes longer ones; ``shaders/webgl2/layers.glsl`` makes texels of
them as :class:`~flowtex.textures.TextureSet` does.
"""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import AnyArray, Bools
from flowtex._util.vectors import norm
from flowtex.field.interpolation import fill_blanked, nearest_known
from flowtex.rendering.webgl.packing import HALF_MAX, half
from flowtex.rendering.webgl.protocol import Header, Parts, plain_list
from flowtex.textures import SurfaceGeometry, TextureSet
from flowtex.trace.sampler import STOPPED_SPEED

__all__ = ["can_trace", "surface_parts", "trace_header", "velocity_part"]

#: Share of the typical speed by which that along the surface may differ from the whole one.
SAME_SPEED_SHARE = 1e-3
#: Least size of a cell in typical ones.
LEAST_SIZE = 1e-4
#: Error of a position as a share of a small cell, and which percentile that is.
CELL_SHARE, SMALL_CELLS = 2**-11, 1.0
#: Bytes of a node at one time, about.
NODE_BYTES = 4


def can_trace(textures: TextureSet) -> bool:
    """Whether a client can trace a flow: along streamlines by length, without poles, with signs.

    Half precision has to hold the sizes of its cells.
    """
    field, store = textures.geometry.field, textures.store
    sizes = store.unit / np.median(store.unit)
    return (
        bool(sizes.min() > LEAST_SIZE and sizes.max() < HALF_MAX)
        and isinstance(textures.geometry, SurfaceGeometry)
        and textures.paper is None
        and field.surface.poles is None
        and not field.sign_free
        and not store.given
        and store.streamlines
        and store.parameter == "arclength"
    )


def trace_header(textures: TextureSet) -> Header:
    """Return the numbers of tracing and of laying out the texels."""
    geometry = textures.grid
    surface = geometry.field.surface
    rows, columns = geometry.rows, geometry.columns
    valid, parts = geometry.field.valid, ["padded", "unit"]
    if _is_blanked(valid):
        parts += ["open", "nearest"]
    if not (geometry.planar or geometry.is_smooth):
        parts += ["normal"]
    return {
        "parts": parts,
        # Of all nodes, and the one that the texel before the first would hold.
        "nodes": [int(n) for n in geometry.field.shape],
        "first": [rows.first - rows.before, columns.first - columns.before],
        "drawn": [rows.first, columns.first],
        "closed": [bool(p) for p in surface.periodic],
        # By how much a position grows with a period.
        "offset": plain_list(surface.offset @ geometry.frame.T),
        "middle": plain_list(geometry.frame @ (surface.center - geometry.center)),
        "unit": float(np.median(textures.store.unit)),
        "pace": float(textures.pace),
    }


def surface_parts(textures: TextureSet) -> Parts:
    """Return the arrays of the nodes that are the same at all times."""
    geometry = textures.grid
    surface, unit = geometry.field.surface, textures.store.unit
    padded = (surface.padded - surface.center) @ geometry.frame.T
    parts: Parts = {"unit": half(unit / np.median(unit))}
    # Multiples of a power of two are packed well, if they are much smaller than a cell.
    small = float(np.percentile(norm(surface.tangents), SMALL_CELLS))
    least = np.ldexp(1.0, int(np.floor(np.log2(max(small, 1e-30) * CELL_SHARE))))
    if np.abs(padded).max() < least * 2**24:
        padded = np.rint(padded / least) * least
    parts["padded"] = np.ascontiguousarray(padded, "<f4")
    valid = geometry.field.valid
    if _is_blanked(valid):
        rows, columns = nearest_known(valid)
        j, i = np.indices(valid.shape)
        parts["open"] = np.pad(surface.cells, ((0, 1), (0, 1))).astype(np.uint8)
        parts["nearest"] = np.stack([columns - i, rows - j], axis=-1).astype("<i2")
    return parts


def _is_blanked(valid: Bools) -> bool:
    return bool(not valid.all() and valid.any())


def velocity_part(textures: TextureSet, step: int) -> AnyArray:
    """Return the velocity of one time, (J, I, 3 or 4).

    It is the rate along i and j in cells in a unit of lag, the speed along the surface in multiples
    of the typical one, and the whole speed where that is another.
    """
    field = textures.geometry.field.at_step(step)
    flow, valid, typical = field.index_velocity, field.valid, textures.typical_speed
    speed = fill_blanked(np.asarray(flow.speed[0]), valid)
    components = fill_blanked(np.asarray(flow.components[0]), valid)
    rate = np.zeros_like(components)
    moves = speed > STOPPED_SPEED * speed.max()
    cells = components * textures.store.unit[..., None]
    np.divide(cells, speed[..., None], out=rate, where=moves[..., None])
    channels = [rate[..., 0], rate[..., 1], speed / typical]
    whole = np.asarray(field.speed[0])
    if np.abs(whole - flow.speed[0])[valid].max(initial=0.0) > SAME_SPEED_SHARE * typical:
        channels.append(fill_blanked(whole, valid) / typical)
    return half(np.stack(channels, axis=-1))
