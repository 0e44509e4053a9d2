"""Names of columns as solvers write them: places, and components by letters or numbers.

``Velocity[i]`` of Star-CCM+, ``U:0`` and ``Points_1`` of ParaView become ``Velocity_x``, ``u``
and ``y``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

#: The name of a vector, and the letter or number of one of its components.
COMPONENT = re.compile(r"^(.+?)\s*(?:\[([ijk012])\]|[:_]([012]))$")
#: Numbers and letters of components in their order.
ORDERS = ("012", "ijk")
#: Vectors that are the places of points.
PLACES = re.compile(r"^(points?|positions?|coordinates?|coords?|centroid|cell ?centers?)$", re.I)
#: A name and its unit in brackets, which may have brackets inside, but is no letter of a component.
WITH_UNIT = re.compile(
    r"^(.*?)\s*[\[(](?![ijk012xyz][\])])((?:[^\[\]()]|\([^()]*\))*)[\])]$", re.DOTALL
)


def split_unit(name: str) -> tuple[str, str]:
    """Return the name and the unit of a column; the unit is empty where the name has none."""
    match = WITH_UNIT.match(name)
    if match is None:
        return name.strip(), ""
    return match[1].strip(), match[2].strip()


def component_names(names: Iterable[str]) -> dict[str, str]:
    """Return new names of the columns that are components of one vector.

    Parameters
    ----------
    names
        Names of all columns, without units.

    Returns
    -------
    dict
        New names by old ones. A number at the end is that of a component only where the vector has
        a first and a second one.
    """
    names = list(names)
    vectors: dict[tuple[str, str], dict[int, str]] = {}
    for name in names:
        match = COMPONENT.match(name)
        if match is None:
            continue
        letter = match[2] or match[3]
        order = ORDERS[letter in "ijk"]
        vectors.setdefault((match[1], order), {})[order.index(letter)] = name
    changes = _numbered_places(names)
    for (vector, _), parts in vectors.items():
        if not {0, 1} <= set(parts):
            continue
        new = {name: _component(vector, number) for number, name in parts.items()}
        if not set(new.values()) & set(names):
            changes.update(new)
    return changes


def _numbered_places(names: list[str]) -> dict[str, str]:
    """Return new names of the places x1, x2 and x3, unless other columns are x and y."""
    if not {"x1", "x2"} <= set(names) or {"x", "y", "y1", "y2", "lon", "lat"} & set(names):
        return {}
    changes = {}
    for number, letter in enumerate("xyz", start=1):
        if f"x{number}" in names and letter not in names:
            changes[f"x{number}"] = letter
    return changes


def _component(vector: str, number: int) -> str:
    """Return the name of a component of a vector, or of a coordinate."""
    if PLACES.match(vector):
        return "xyz"[number]
    if vector.lower() == "u":  # the velocity of OpenFOAM
        return "uvw"[number]
    return f"{vector}_{'xyz'[number]}"
