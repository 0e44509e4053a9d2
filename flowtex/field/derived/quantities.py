"""Scalars that are computed from the velocity at the nodes.

Magnitudes and components of vectors are scalars too: vectors ``U`` have the scalars ``U`` and
``U_x``. The magnitude of a velocity is labelled as the speed, the magnitude of other vectors as
``|B|``. The unit of vectors, or else their name, shows whether they are a velocity.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex._util.arrays import norm
from flowtex.errors import FieldError
from flowtex.field.derived.gradient import NodeGradient, node_gradient, true_velocity
from flowtex.field.finer import check_derivable, finest_of
from flowtex.field.steps import LazySteps, Steps, map_steps, scaled_steps
from flowtex.field.units import NONE, VELOCITIES, factor, measures, parsed, speed_unit
from flowtex.field.validation import NO_DATA, has_late_gaps, known_nodes

#: Functions of the gradient a[m, n], the change of component m along direction n.
DERIVED: dict[str, Callable[[Floats], Floats]] = {
    "vorticity": lambda a: a[1, 0] - a[0, 1],
    "divergence": lambda a: a[0, 0] + a[1, 1],
    "shear": lambda a: np.hypot(a[0, 0] - a[1, 1], a[0, 1] + a[1, 0]),
    "okubo_weiss": lambda a: (a[0, 0] - a[1, 1]) ** 2 + 4 * a[0, 1] * a[1, 0],
}
SIGNED = frozenset(("vorticity", "divergence", "okubo_weiss"))  #: Derived scalars of both signs.
#: Scalars for which particles are followed over a horizon, by the field; the tracer adds them.
FOLLOWED: dict[str, Callable[[Any, float], Steps]] = {}
#: Pattern of the names that other programs give to the components of a vector.
COMPONENT = re.compile(r"[_:.\[ -][xyz012]\]?$", re.IGNORECASE)
#: Long names that differ from the names.
LONG_NAMES = {"okubo_weiss": "Okubo-Weiss parameter", "ftle": "FTLE"}
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


def derived_steps(name: str, field: Any) -> Steps:
    """Return one of :data:`DERIVED`, (T, J, I); NaN where too few neighbours have data.

    Parameters
    ----------
    name
        Name of the quantity, such as ``"vorticity"``.
    field
        The flow.

    Raises
    ------
    FieldError
        When the name is not in :data:`DERIVED`.
    """
    if name not in DERIVED:
        raise FieldError(
            f"{name!r} cannot be derived; expected one of {', '.join((*DERIVED, *FOLLOWED))}"
        )
    surface = field.surface
    projection = field.projection
    gradient = node_gradient(surface, projection)
    if field.uncertainty == NO_DATA or has_late_gaps(field):
        return LazySteps(len(field.times), partial(_of_known, name, field, gradient))
    return map_steps(field.velocity, partial(_derived, name, surface.points, projection, gradient))


def _derived(
    name: str, points: Floats, projection: Any, gradient: NodeGradient, step: Floats
) -> Floats:
    """Return a derived scalar of a step of the velocity, (J, I)."""
    with np.errstate(invalid="ignore"):
        moved = true_velocity(step, points, projection)
        return gradient.with_poles(DERIVED[name](gradient.of_vectors(moved)))


def _of_known(name: str, field: Any, gradient: NodeGradient, number: int) -> Floats:
    """Return a derived scalar of a step, from the nodes that have data there.

    The ``gradient`` is that of all nodes.
    """
    known = known_nodes(field, number, number)
    if (known != field.valid).any():
        gradient = node_gradient(field.surface, field.projection, known)
    return _derived(name, field.surface.points, field.projection, gradient, field.velocity[number])


def steps_of(field: Any, name: str) -> Steps:
    """Return nodal values of a field at all times, (T or 1, J, I), by the name of a scalar.

    Raises
    ------
    FieldError
        When the field has no scalar of this name, and it cannot be derived from the velocity in
        memory.
    """
    if name in field.scalars:
        return field.scalars[name]
    if name == "speed":
        return field.speed
    if name in (other := with_vector_scalar(field, name)).scalars:
        return other.scalars[name]
    if name in DERIVED or name in FOLLOWED:
        check_derivable(field, name)
    vectors: list[str] = []
    if field.projection is None:  # components of a map are not along x and y
        of_components = [part[:-2] for part in field.parts]  # such as U of U_x
        vectors = [field.vectors or UNNAMED, *of_components]
    derived: list[str] = []
    if finest_of(field) is None:  # otherwise this is the coarsest level of a store
        derived = list(DERIVED)
    names = ", ".join(map(repr, dict.fromkeys(["speed", *field.scalars, *vectors, *derived])))
    msg = f"the field has no scalar {name!r}; expected one of {names}"
    if COMPONENT.search(name):
        msg += "; a component is named as in 'U_x', or chosen by component=0"
    if name in FOLLOWED:
        msg = f"{name!r} needs a horizon; first call field.with_derived({name!r}, horizon=...)"
    raise FieldError(msg)


def followed_steps(name: str, field: Any, horizon: float | None) -> Steps:
    """Return one of :data:`FOLLOWED` at each node and step of a field, (T, J, I).

    Parameters
    ----------
    name
        Name of the quantity, such as ``"ftle"``.
    field
        The flow.
    horizon
        Time for which particles are followed, in units of the field; negative backward.

    Raises
    ------
    FieldError
        When the name is not in :data:`FOLLOWED`, or the horizon is missing, zero or not finite.
    """
    if name not in FOLLOWED:
        raise FieldError(
            f"horizon={horizon} is given for {name!r}; only {', '.join(FOLLOWED)} uses it"
        )
    if horizon is None or not (np.isfinite(horizon) and horizon != 0):
        raise FieldError(f"horizon is {horizon} for {name!r}; expected a time other than 0")
    return FOLLOWED[name](field, horizon)


def derived_unit(name: str, field: Any) -> str:
    """Return the unit of a derived scalar of a field; empty where it is unknown."""
    time = field.time_unit
    if not time or (field.velocity_unit and not field.length_unit):
        return ""
    own = speed_unit(field.length_unit, time)
    if field.velocity_unit not in ("", own) and factor(field.velocity_unit, own) is None:
        return ""
    if "/" in time:
        time = f"({time})"
    if name == "okubo_weiss":
        return f"1/{time}²"
    return f"1/{time}"


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


def with_vector_scalar(field: Any, name: str) -> Any:
    """Return a field with the magnitude or a component of its vectors among its scalars.

    Known are the drawn vectors by their name, their components also as in ``speed_x``, and other
    vectors of the mesh. For any other name the field is returned as it is.
    """
    own = field.vectors or UNNAMED
    base, _, letter = name.rpartition("_")
    if base == "speed":
        base = own
    parts = [part for part in field.parts if part.rpartition("_")[0] == name]
    long_name = name
    unit = ""
    steps: Steps
    on_cells: tuple[str, ...] = ()
    if name in field.scalars or field.projection is not None:
        return field
    if name == own or (base == own and letter and letter in LETTERS):
        axis = LETTERS.find(letter)
        long_name = f"{own}_{letter}"
        own_part: Callable[[Floats], Floats] = partial(np.take, indices=axis, axis=-1)
        if name == own:
            long_name = magnitude_label(field.vectors, field.velocity_unit)
            own_part = norm
        steps = scaled_steps(map_steps(field.velocity, own_part), field.speed_scale)
        unit = field.speed_unit
    elif name in field.parts:
        steps = field.parts[name]
    elif parts:
        components = [field.parts[part] for part in parts]
        steps = np.sqrt(sum(map(np.square, components)))
        long_name = f"|{name}|"
        if parts[0] in field.on_cells:
            on_cells = (name,)
    else:
        return field
    units = dict(field.units)
    if unit:
        units[name] = unit
    return field.same_flow(
        scalars={**field.scalars, name: steps},
        on_cells=(*field.on_cells, *on_cells),
        units=units,
        long_names={**field.long_names, name: long_name},
    )
