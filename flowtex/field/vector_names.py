"""Names of vectors and of their components, and what they tell.

The magnitude of a velocity is labelled as the speed, the magnitude of other vectors as ``|B|``. The
unit of vectors, or else their name, shows whether they are a velocity.
"""

from __future__ import annotations

import re

from flowtex.field.units import NONE, VELOCITIES, measures, parsed

#: Pattern of the names that other programs give to the components of a vector.
COMPONENT = re.compile(r"[_:.\[ -][xyz012]\]?$", re.IGNORECASE)
LETTERS = "xyz"  #: Letters of the components, along the axes of space.
#: Component letter by its name, a number or a letter.
COMPONENTS = dict(zip("012xyz", 2 * LETTERS, strict=True))
UNNAMED = "velocity"  #: Name of vectors that have none.
#: Words of a velocity, also with a number or a letter of a component or a height.
_VELOCITY = re.compile(
    r"vel|velo|velocit(y|ies)|winds?|currents?|flow|drift|speed|"
    r"(vel|[uv])(\d+m?|[uvwxyzijkoa]{1,2}|as?|r|rel|theta|phi|mean|avg)?|uvw?"
)
#: Words of other quantities that are made with these.
_OTHER = re.compile(
    r"stress|shear|flux|densit(y|ies)|grad(ient)?|gradients|force|heat|mass|momentum|rho|energy|"
    r"power|charge|electric|magnetic|curl|rot|vorticity|div|lap|laplacian|acc|acceleration|"
    r"displacements?|disp|potential|pressure|rate|ddt"
)
#: Words of a name: of letters of one case with a first capital, and of digits after them.
_WORDS = re.compile(r"[A-Z]?[a-z]+\d*|[A-Z]+(?![a-z])\d*|\d+")


def is_velocity(name: str, unit: str = "") -> bool:
    """Return whether vectors are a velocity; without a name and a unit they are."""
    if unit.strip().lower() not in NONE and parsed(unit) is not None:
        return measures(unit, VELOCITIES)
    if not name:
        return True
    words = list(map(str.lower, _WORDS.findall(name)))
    return any(map(_VELOCITY.fullmatch, words)) and not any(map(_OTHER.fullmatch, words))


def magnitude_label(name: str, unit: str = "") -> str:
    """Return the text for the magnitude of vectors."""
    if is_velocity(name, unit):
        return "speed"
    if name:
        return f"|{name}|"
    return "magnitude"


def component_name(name: str, axis: str) -> str:
    """Return the name of a component of vectors, by its number or letter."""
    return f"{name}_{COMPONENTS[axis]}"
