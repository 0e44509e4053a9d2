"""The velocity of a flow, from which a client traces the slices itself.

It takes a fraction of the bytes of slices. What travels is the velocity in index space, the nodes'
positions with a ghost line around them, and what is blanked, of all nodes that paths of the drawn
ones may reach. ``shaders/webgl2/trace.glsl`` follows the paths, ``shaders/webgl2/layers.glsl``
makes texels of them as ``TextureSet`` does. A client that cannot trace gets the slices.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Floats, Halves
from flowtex._util.arrays import norm
from flowtex._util.cache import ByteCache, WeakCache
from flowtex.field.formula.formula import Formula, gradient_trees
from flowtex.field.grids.poles import Poles
from flowtex.field.interpolation import fill_blanked, nearest_known
from flowtex.field.uncertainty import unknown_share
from flowtex.rendering.tile_choice import CELL_PIXELS
from flowtex.rendering.webgl.protocol import Header, Parts, plain_list
from flowtex.textures.crossing import shown_speed
from flowtex.textures.geometry import SurfaceGeometry
from flowtex.textures.texture_set import UNCERTAIN_LAYER, TextureSet
from flowtex.textures.tiles.blocks import BLOCK_CELLS
from flowtex.textures.tiles.grid_pyramid import TILE_BLOCKS
from flowtex.textures.tiles.pyramid import PATH_CELLS
from flowtex.textures.value_ranges import range_rules
from flowtex.trace.sampler import RESTING_CELLS, STILL_CELLS, STOPPED_SPEED, Charts
from flowtex.trace.slices import drawn_lags
from flowtex.trace.structure.formula_lines import formula_rates

LEAST_SIZE = 1e-4  #: Least size of a cell in typical ones.
CELL_SHARE = 2**-13  #: Unit of positions as a share of a small cell of the finest level.
SMALL_CELLS = 1.0  #: Percentile of small cells.
RATE_UNIT = 2.0**-9  #: Steps of a rate as a share of that along wide cells.
WIDE_CELLS = 95  #: Percentile of wide cells.
SPEED_UNIT = 2.0**-12  #: Least step of the speed in typical speeds: the error is half of it.
SPEED_STEPS = 2**9  #: Least steps of a speed in its own unit: an error of 2^-10 at most.
NODE_BYTES = 4  #: Bytes of a node at one time, about.
MOST_STEPS = 64  #: Steps whose flow a client holds to follow the paths to one of them, at most.
HALF_MAX = 65504.0  #: Greatest number in half precision.
CACHE_BYTES = 64_000_000  #: Bytes of packed steps that are cached.
LEAST_STEPS = 2  #: Least number of packed steps that are cached.
DEPTH = 20  #: Levels below the grid that is sent: enough for the deepest zoom.
PREFIX = "formula."  #: Before the name of a parameter among the settings, in the client as well.


@dataclass(frozen=True, eq=False)
class PackedStep:
    """Slopes of one destination time, (layers, H, W, channels), and ``extra``, (n, H, W)."""

    slopes: Halves
    extra: Halves

    @property
    def nbytes(self) -> int:
        """Size of the slopes, which are nearly all of it."""
        return self.slopes.nbytes


class Packing:
    """Packed slices of a texture set; those requested last are cached.

    A slope has so many ``channels``, two in a plane and in image coordinates. ``extra`` are the
    layers whose fourth channel says something: unit, reach, speed, how far the direction is not
    known, reach forward, that again, and speed again.
    """

    def __init__(self, textures: TextureSet) -> None:
        self._textures = textures
        if textures.geometry.planar or textures.image is not None:
            self.channels = 2
        else:
            self.channels = 4
        if textures.geometry.field.uncertainty:
            unknown = [UNCERTAIN_LAYER]
        else:
            unknown = []
        if textures.sides == 2:
            ahead = [len(textures.lags) + n for n in (1, *unknown)]
        else:
            ahead = []
        if textures.in_cells:
            last = [textures.count - 1]
        else:
            last = []
        self.extra = [0, 1, 2, *unknown, *ahead, *last]
        self._steps: ByteCache[int, PackedStep] = ByteCache(CACHE_BYTES, min_count=LEAST_STEPS)

    def step(self, step: int) -> PackedStep:
        """Return a step, which is traced if necessary."""
        return self._steps.get(step, lambda: self._packed(step))

    @property
    def nbytes(self) -> int:
        """Size of the steps that are cached."""
        return self._steps.nbytes

    def _packed(self, step: int) -> PackedStep:
        layers = self._textures.layers(step)
        parts = layers[..., : self.channels], layers[self.extra, :, :, 3]
        return PackedStep(*(np.ascontiguousarray(part, dtype="<f2") for part in parts))


_packings: WeakCache[Packing] = WeakCache()


def packing_of(textures: TextureSet) -> Packing:
    """Return the packing of a texture set, shared by all views that draw it."""
    # A packing keeps its textures alive, so their number is its own while it lives.
    return _packings.get(id(textures), lambda: Packing(textures))


def half(values: AnyArray) -> Halves:
    """Round to half precision, clipped to its greatest number."""
    return np.ascontiguousarray(np.clip(values, -HALF_MAX, HALF_MAX), dtype="<f2")


def can_trace(textures: TextureSet) -> bool:
    """Return whether a client can trace a flow: on a structured surface, with signs."""
    field = textures.geometry.field
    store = textures.store
    structured = isinstance(textures.geometry, SurfaceGeometry) and textures.image is None
    if not structured or field.sign_free or store.given:
        return False
    sizes = _sizes(textures) / _size(textures)
    if not (sizes.min() > LEAST_SIZE and sizes.max() < HALF_MAX):
        return False
    return store.streamlines or len(steps_around(textures, len(field.times) // 2)) <= MOST_STEPS


def steps_around(textures: TextureSet, step: int) -> list[int]:
    """Return the steps whose flow a client traces the slices of a step from."""
    store = textures.store
    times = textures.geometry.field.times
    if store.streamlines:
        return [step]
    reach = float(store.lags[-1] * store.unit.flat[0])
    within_reach = np.abs(times - times[step]) < reach
    padded = np.pad(within_reach, 1)
    return [int(n) for n in np.flatnonzero(within_reach | padded[:-2] | padded[2:])]


def _sizes(textures: TextureSet) -> Floats:
    """Return the lengths of cells in which velocities are measured, (J, I)."""
    store = textures.store
    if store.parameter == "arclength":
        return store.unit
    return drawn_lags(textures.geometry.field, "arclength")[1]


def _size(textures: TextureSet) -> float:
    return float(np.median(_sizes(textures)))


def _poles_header(poles: Poles, frame: Floats) -> list[Header]:
    """Return the numbers by which positions near poles are found, in the axes of a frame."""
    near = Charts(poles).near
    headers = []
    for pole in poles:
        header: Header = {
            "component": pole.component,
            "line": pole.line,
            "inward": pole.inward,
            "near": near,
            "plane": plain_list(pole.size * pole.plane @ frame.T),
        }
        headers.append(header)
    return headers


def trace_header(textures: TextureSet, depth: int) -> Header:
    """Return the numbers of tracing and of laying out the texels; ``depth`` is that of the root."""
    geometry = textures.grid
    surface = geometry.field.surface
    store = textures.store
    timed = store.parameter == "time"
    last = float(store.lags[-1])
    rest = (STILL_CELLS / last if store.streamlines else 0.0) if timed else RESTING_CELLS
    rows = geometry.rows
    columns = geometry.columns
    valid = geometry.field.valid
    parts = ["padded", "unit"]
    if _is_blanked(valid):
        parts += ["open", "nearest"]
    if not (geometry.planar or geometry.is_smooth):
        parts += ["normal"]
    at_poles = {}
    if surface.poles is not None:
        parts += ["rays"]
        at_poles["poles"] = _poles_header(surface.poles, geometry.frame)
    return {
        "parts": parts,
        # Of all nodes, and the one that the texel before the first would hold.
        "nodes": [int(n) for n in geometry.field.shape],
        "first": [rows.first - rows.before, columns.first - columns.before],
        "drawn": [rows.first, columns.first],
        "closed": [bool(p) for p in surface.periodic],
        # By how much a position grows with a period.
        "offset": plain_list(surface.offset @ geometry.frame.T),
        "middle": plain_list(_middle(textures, _position_unit(textures, depth))),
        "unit": _size(textures),
        "pace": float(textures.pace),
        "timed": {"unit": float(store.unit.flat[0]), "speed": textures.typical_speed}
        if timed
        else None,
        "pathlines": not store.streamlines,
        "rest": rest,
        **({"uncertain": True} if geometry.field.uncertainty else {}),
        **at_poles,
        **({} if timed or np.isinf(store.long_enough) else {"longest": store.long_enough}),
    }


def _position_unit(textures: TextureSet, depth: int) -> float:
    """Return a power of two that is the same for all levels: they share nodes."""
    whole = textures.grid.whole
    sizes = norm(whole.tangents)
    small = np.percentile(sizes[sizes > whole.extent / 2**24], SMALL_CELLS)  # not at a pole
    return float(np.exp2(np.floor(np.log2(small * CELL_SHARE)) - depth))


def _middle(textures: TextureSet, unit: float) -> Floats:
    geometry = textures.grid
    return np.rint(geometry.local(geometry.surface.center) / unit) * unit


def surface_parts(textures: TextureSet, depth: int) -> Parts:
    """Return the arrays of the nodes at all times, multiples of powers of two, by the depth."""
    geometry = textures.grid
    surface = geometry.surface
    unit = _position_unit(textures, depth)
    parts: Parts = {"unit": half(_sizes(textures) / _size(textures))}
    padded = (surface.padded - geometry.center) @ geometry.frame.T - _middle(textures, unit)
    unit = max(unit, np.ldexp(1.0, int(np.frexp(np.abs(padded).max())[1]) - 24))
    # No zero is below zero.
    parts["padded"] = np.ascontiguousarray(np.rint(padded / unit) * unit + 0.0, "<f4")
    if surface.poles is not None:
        parts["rays"] = np.stack([pole.rays / pole.size for pole in surface.poles]).astype("<f4")
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
    """Return the velocity of one time, (J, I, 3 to 5), rounded as paths and colours allow.

    The channels are the rate along i and j, in cells per length of a cell; the speed, in multiples
    of the typical speed; where that is another one, or the field is uncertain, the speed as
    :func:`shown_speed` has it; and the uncertainty.
    """
    field = textures.geometry.field.at_step(step)
    flow = field.index_velocity
    valid = field.valid
    typical = textures.typical_speed
    speed = fill_blanked(np.asarray(flow.speed[0]), valid)
    components = fill_blanked(np.asarray(flow.components[0]), valid)
    rate = np.zeros_like(components)
    moves = speed > STOPPED_SPEED * speed.max()
    cells = components * _sizes(textures)[..., None]
    np.divide(cells, speed[..., None], out=rate, where=moves[..., None])
    channels = [rate[..., 0], rate[..., 1], speed / typical]
    shown = fill_blanked(shown_speed(field, 0, typical), valid)
    if field.uncertainty:
        channels += [shown, unknown_share(field, 0)]
    elif (shown < 0).any():
        channels.append(shown)
    share, exponent = np.frexp(channels[2:])
    channels[2:] = np.ldexp(np.rint(share * SPEED_STEPS), exponent) / SPEED_STEPS
    # Around a pole there are wide cells that no path of a drawn node comes to.
    across = (norm(field.surface.tangents) / _sizes(textures))[:, *textures.grid.drawn]
    wide = np.maximum(np.percentile(across[:, ::4, ::4], WIDE_CELLS, axis=(1, 2)), LEAST_SIZE)
    unit = np.array([*RATE_UNIT / 2 ** np.rint(np.log2(wide)), *[SPEED_UNIT] * len(channels[2:])])
    return half(np.rint(np.stack(channels, axis=-1) / unit) * unit + 0.0)


def client_formula(textures: TextureSet) -> Formula | None:
    """Return the formula from which a client computes a flow itself, if it can.

    That is one in the plane, of texts alone, that has a value everywhere; and the field still has
    the nodes and velocities that it was made with. ``client/src/formula.ts`` is the other side.
    """
    field = textures.geometry.field
    formula = field.formula
    if formula is None or formula.surface or field.scalars or not field.valid.all():
        return None
    if any(each.tree is None for each in formula.expressions):
        return None
    same = all(formula_rates(field.at_step(n)) for n in {0, len(field.times) - 1})
    if same:
        return formula
    return None


def formula_header(formula: Formula, shape: tuple[int, int]) -> Header:
    """Return a formula's part of the header, for a root of this many nodes (J, I)."""
    shapes = []
    for level in range(DEPTH + 1):
        shapes.append([(n - 1) * 2 ** (DEPTH - level) + 1 for n in shape])
    return {
        "formula": {
            "trees": [each.tree for each in formula.expressions],
            "gradient": gradient_trees(formula),
            "names": list(formula.ranges),
            "ends": [list(ends) for ends in formula.ranges.values()],
            "range": range_rules(),
        },
        "pyramid": {
            "depth": DEPTH,
            "finest": 0,
            "blocks": [[-(-(n - 1) // BLOCK_CELLS) for n in each] for each in shapes],
            "shapes": shapes,
            "tileBlocks": TILE_BLOCKS,
            "cellPixels": CELL_PIXELS,
            "pathCells": PATH_CELLS,
        },
    }


def parameter_rows(formula: Formula) -> list[Header]:
    """Return the parameters as rows of the table of settings."""
    found = []
    for name, each in formula.parameters.items():
        found.append(
            {
                **{"name": PREFIX + name, "label": name, "default": each.value, "low": each.low},
                **{"high": each.high, "affects": "uniform", "text": "A parameter of the formula."},
                **{"logarithmic": False, "condition": "", "control": "slider", "whole": False},
                **{"choices": [], "needs": []},
            }
        )
    return found
