"""Checks of the description in a store, before it is used.

A seal, a hash of the whole description, reveals accidental damage. A wrong description may have a
valid seal, so types and sizes are checked as well: they decide how much memory is taken.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex._util.cache import digest
from flowtex.field.steps import Nodes
from flowtex.pyramid.places import FORMAT, DamageError, PyramidError
from flowtex.textures.tiles.pyramid import level_shape

#: Nodes along an axis, steps, levels, characters of a text, and scalars, at most.
MOST_NODES, MOST_STEPS, MOST_LEVELS, MOST_LETTERS, MOST_SCALARS = 10**7, 10**6, 40, 10_000, 1000
#: Nodes of the coarsest level, which is read whole, at most.
MOST_ROOT_NODES = 1_000_000

Check = Callable[[Any], bool]
#: The description of a field and its pyramid, as the store has it; ``_ABOUT`` lists its entries.
About: TypeAlias = Mapping[str, Any]


def sealed(about: About) -> dict[str, Any]:
    """Return the description of a pyramid with its seal; a dictionary without one is rejected."""
    return {**about, "seal": _seal(about)}


def _seal(about: About) -> str:
    text = json.dumps({k: v for k, v in about.items() if k != "seal"}, sort_keys=True)
    return digest(words=(text,)).hex()


def _flag(value: object) -> bool:
    return isinstance(value, bool)


def _text(value: object) -> bool:
    return isinstance(value, str) and len(value) <= MOST_LETTERS


def _whole(least: int, most: int) -> Check:
    return lambda value: type(value) is int and least <= value <= most


def _number(value: Any) -> bool:
    return type(value) in (int, float) and math.isfinite(value)


def _either(*values: object) -> Check:
    return lambda value: value in values and type(value) is not bool


def _list(check: Check, least: int, most: int | None = None) -> Check:
    most = least if most is None else most
    return lambda v: isinstance(v, list) and least <= len(v) <= most and all(map(check, v))


def _or_none(check: Check) -> Check:
    return lambda value: value is None or check(value)


def _by_name(check: Check) -> Check:
    return lambda v: (
        isinstance(v, dict)
        and len(v) <= MOST_SCALARS
        and all(_text(name) and check(value) for name, value in v.items())
    )


def _rising(check: Check) -> Check:
    return lambda v: check(v) and all(a < b for a, b in pairwise(v))


def _date(value: Any) -> bool:
    parts = _list(_whole(0, 100_000), 7)
    return isinstance(value, list) and len(value) == 2 and parts(value[0]) and _text(value[1])


def _projection(value: Any) -> bool:
    if not (isinstance(value, list) and len(value) == 3):
        return False
    return _text(value[0]) and _list(_number, 2)(value[1]) and _number(value[2])


def is_scalar_name(name: str) -> bool:
    """Return whether a name is a valid path of an array in its group."""
    return bool(name) and "/" not in name and name not in (".", "..", "zarr.json")


_ENDS = _list(_list(_number, 2), 2)
#: Required entries of the description of a pyramid; more are allowed.
_ABOUT: dict[str, Check] = {
    **dict.fromkeys(("name", "length_unit", "time_unit", "version"), _text),
    **dict.fromkeys(("fingerprint", "source"), _text),
    **dict.fromkeys(("axes", "late", "has_position"), _flag),
    "levels_done": _or_none(_flag),
    "nodes": _list(_whole(2, MOST_NODES), 2),
    "times": _rising(_list(_number, 1, MOST_STEPS)),
    "start": _or_none(_date),
    "projection": _or_none(_projection),
    "periodic": _list(_flag, 2),
    "periods": _list(_list(_number, 3), 2),
    "depth": _whole(0, MOST_LEVELS),
    "tile_cells": _whole(1, 4096),
    "parameter": _either("arclength", "time"),
    "lines": _either("pathlines", "streamlines"),
    "components": _either(2, 3),
    "height": _number,
    "scalars": lambda v: _by_name(_whole(1, MOST_STEPS))(v) and all(map(is_scalar_name, v)),
    **dict.fromkeys(("uncertainty", "velocity_unit", "vectors"), _or_none(_text)),
    "units": _by_name(_text),
    "long_names": _by_name(_text),
    "on_cells": _or_none(_list(_text, 0, MOST_SCALARS)),
    "ranges": _or_none(_by_name(_ENDS)),
}


def check_about(about: Any, place: str) -> dict[str, Any]:
    """Return the description of a pyramid; a PyramidError says that it is not as it was written."""
    version = about.get("format") if isinstance(about, dict) else None
    if version != FORMAT:
        msg = (
            f"{place} has format {str(version)[:40]!r}; expected {FORMAT!r}. Build it again, or "
            "use the version of flowtex that wrote it"
        )
        raise PyramidError(msg)
    wrong = [name for name, check in _ABOUT.items() if not check(about.get(name))]
    if not wrong and math.prod(level_shape(about["nodes"], about["depth"])) > MOST_ROOT_NODES:
        wrong = ["depth"]
    if not wrong and about.get("uncertainty") and about["uncertainty"] not in about["scalars"]:
        wrong = ["uncertainty"]
    if wrong or about.get("seal") != _seal(about):
        names = f" ({', '.join(wrong)})" if wrong else ""
        msg = f"the metadata of {place} are damaged{names}; build it again"
        raise DamageError(msg)
    result: dict[str, Any] = about
    return result


def part_digest(nodes: Nodes, about: About, step: int) -> bytes:
    """Return a hash of the values of a part of a level, as they are written."""
    scalars = {k: v for k, v in sorted(nodes.scalars.items()) if step < about["scalars"][k]}
    values = [nodes.velocity[..., : about["components"]], *scalars.values()]
    arrays: list[AnyArray] = [np.asarray(array, np.float32) for array in values]
    if step == 0:
        arrays += [nodes.points, nodes.valid]
        if nodes.has_position is not None:
            arrays.append(nodes.has_position)
    return digest(*arrays, words=scalars)
