"""Ranges of values for the colours of a pyramid, from the tasks that read the nodes.

Each task keeps the least and the greatest value of its part, and some of its values: those of every
2^n-th row and column, a million of the whole surface. They stay in the store, so that a build that
continues knows them. The whole range is exact, the robust one has the percentiles of that sample.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from flowtex._util.array_types import AnyArray, Floats
from flowtex._util.vectors import norm
from flowtex.field.steps import Nodes, typical_steps
from flowtex.pyramid.checks import About
from flowtex.pyramid.layout import (
    SHARD_CHUNKS,
    TILE_CELLS,
    Arrays,
    Part,
    create_array,
    empty_field,
    parts_along,
)
from flowtex.textures.tiles import ends_of

if TYPE_CHECKING:
    from zarr import Group

SAMPLES = "samples"
#: Nodes of a sample of one quantity at one time.
MOST_SAMPLES = 1 << 20


def create_samples(group: Group, about: About) -> None:
    """Create the array of samples."""
    parts = parts_along((about["nodes"][0], about["nodes"][1]))
    size = (len(_quantities(about)), 2 + math.prod(_shape(about)))
    each = zip(("time", "row", "column"), (len(_steps(about)), *parts), strict=True)
    whole = zip(("quantity", "value"), size, strict=True)
    axes = {**{axis: (n, 1) for axis, n in each}, **{axis: (n, n) for axis, n in whole}}
    create_array(group, SAMPLES, "float64", axes)


def write_samples(array: Arrays, about: About, part: Part, nodes: Nodes) -> None:
    """Add the values of a part of level 0, if ranges are taken from its step."""
    if part.step not in _steps(about):
        return
    step, shape = _spacing(about), _shape(about)
    values = {**nodes.scalars}
    if "speed" not in values:
        values["speed"] = norm(nodes.velocity) * empty_field(about).speed_scale
    result = np.full((len(values), 2 + math.prod(shape)), np.nan)
    for row, name in zip(result, _quantities(about), strict=True):
        known_values: Floats = np.where(nodes.valid, values[name], np.nan)
        row[:2] = ends_of(known_values, robust=False) or (np.nan, np.nan)
        sample = known_values[::step, ::step]
        row[2:].reshape(shape)[: sample.shape[0], : sample.shape[1]] = sample
    array(SAMPLES)[_steps(about).index(part.step), part.row, part.column] = result


def ranges_of(samples: AnyArray, about: About) -> dict[str, list[tuple[float, float]]]:
    """Return the ends of scalars and of the speed, the whole range and the robust one."""
    ranges = {}
    for number, name in enumerate(_quantities(about)):
        values = samples[:, :, :, number]
        whole = ends_of(values[..., :2], robust=False)
        robust = ends_of(values[..., 2:], robust=True)
        if whole is not None:
            ranges[name] = [whole, whole if robust is None else robust]
    return ranges


def _quantities(about: About) -> list[str]:
    return list(dict.fromkeys([*about["scalars"], "speed"]))


def _steps(about: About) -> list[int]:
    """Return the steps that ranges are taken from."""
    return typical_steps(len(about["times"]))


def _spacing(about: About) -> int:
    """Return the rows and columns from one node of a sample to the next, a power of two."""
    step = 1
    while math.prod(about["nodes"]) > MOST_SAMPLES * step * step and step < TILE_CELLS:
        step *= 2
    return step


def _shape(about: About) -> tuple[int, int]:
    """Return rows and columns of the sample of a part."""
    rows, columns = (chunks * TILE_CELLS // _spacing(about) for chunks in SHARD_CHUNKS)
    return rows, columns
