"""The data of a formula for the client, instead of velocities at nodes.

The client computes the rates at the nodes that it draws, and those of any level below: there is no
finest one. ``client/src/formula.ts`` is the other side.
"""

from __future__ import annotations

import numpy as np

from flowtex.field.formula import Formula
from flowtex.rendering.tile_choice import CELL_PIXELS
from flowtex.rendering.webgl.protocol import Header
from flowtex.textures import TextureSet
from flowtex.textures.tiles import BLOCK_CELLS, PATH_CELLS, TILE_BLOCKS

#: Levels below the grid that is sent: enough for the deepest zoom.
DEPTH = 20
#: Before the name of a parameter among the settings, in the client as well.
PREFIX = "formula."


def client_formula(textures: TextureSet) -> Formula | None:
    """Return the formula from which a client computes a flow itself, if it can.

    That is one in the plane, of texts alone, that has a value everywhere; and the field still has
    the nodes and velocities that it was made with.
    """
    field = textures.geometry.field
    formula = field.formula
    if formula is None or formula.surface or field.scalars or not field.valid.all():
        return None
    if any(each.tree is None for each in formula.expressions):
        return None
    u, v = formula.coordinates(field.shape)
    pairs = [(field.points, formula.points(u, v))]
    pairs += [
        (field.velocity[n], formula.velocity(u, v, float(field.times[n])))
        for n in {0, len(field.times) - 1}
    ]
    same = all(np.allclose(a[..., :2], b) and not a[..., 2].any() for a, b in pairs)
    return formula if same else None


def formula_header(formula: Formula, shape: tuple[int, int]) -> Header:
    """Return a formula's part of the header, for a root of this many nodes (J, I)."""
    shapes = [[(n - 1) * 2 ** (DEPTH - level) + 1 for n in shape] for level in range(DEPTH + 1)]
    return {
        "formula": {
            "trees": [each.tree for each in formula.expressions],
            "names": list(formula.ranges),
            "ends": [list(ends) for ends in formula.ranges.values()],
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
    return [
        {
            **{"name": PREFIX + name, "label": name, "default": each.value, "low": each.low},
            **{"high": each.high, "affects": "uniform", "text": "A parameter of the formula."},
            **{"logarithmic": False, "condition": "", "control": "slider", "whole": False},
            **{"choices": [], "needs": []},
        }
        for name, each in formula.parameters.items()
    ]
