"""Scalars that are computed from the velocity at the nodes.

Magnitudes and components of vectors are scalars too: vectors ``U`` have the scalars ``U`` and
``U_x``.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from flowtex._util.arguments import brief
from flowtex._util.array_types import Floats
from flowtex._util.arrays import norm
from flowtex.errors import FieldError
from flowtex.field.derived.gradient import NodeGradient, node_gradient, true_velocity
from flowtex.field.derived.kinds import DERIVED, FOLLOWED, LONG_NAMES
from flowtex.field.field_data import Data, FieldData
from flowtex.field.finer import check_derivable, finest_of
from flowtex.field.steps import LazySteps, Steps, map_steps, scaled_steps
from flowtex.field.units import factor, speed_unit
from flowtex.field.validation import NO_DATA
from flowtex.field.vector_names import COMPONENT, LETTERS, UNNAMED, magnitude_label


def derive(field: FieldData, name: str, horizon: float | None = None) -> Steps:
    """Return a scalar that is computed from the velocity, as :meth:`flowtex.FlowField.derive`.

    Raises
    ------
    FieldError
        As there.
    """
    if not isinstance(name, str):
        raise FieldError(f"the quantity is {brief(name)}; expected its name, such as 'vorticity'")
    if field.sign_free:
        raise FieldError(f"{name} needs a direction, but this field is sign-free")
    check_derivable(field, name)
    if horizon is not None or name in FOLLOWED:
        return followed_steps(name, field, horizon)
    return derived_steps(name, field)


def with_derived(field: Data, name: str, horizon: float | None = None) -> Data:
    """Return a field with a scalar of :func:`derive` among its scalars."""
    return field.same_flow(
        scalars={**field.scalars, name: derive(field, name, horizon)},
        units={**field.units, name: derived_unit(name, field)},
        long_names={**field.long_names, name: LONG_NAMES.get(name, name)},
    )


def derived_steps(name: str, field: FieldData) -> Steps:
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
    if field.uncertainty == NO_DATA or field.has_late_gaps:
        return LazySteps(len(field.times), partial(_of_known, name, field, gradient))
    return map_steps(field.velocity, partial(_derived, name, surface.points, projection, gradient))


def _derived(
    name: str, points: Floats, projection: Any, gradient: NodeGradient, step: Floats
) -> Floats:
    """Return a derived scalar of a step of the velocity, (J, I)."""
    with np.errstate(invalid="ignore"):
        moved = true_velocity(step, points, projection)
        return gradient.with_poles(DERIVED[name](gradient.of_vectors(moved)))


def _of_known(name: str, field: FieldData, gradient: NodeGradient, number: int) -> Floats:
    """Return a derived scalar of a step, from the nodes that have data there.

    The ``gradient`` is that of all nodes.
    """
    known = field.known_nodes(number, number)
    if (known != field.valid).any():
        gradient = node_gradient(field.surface, field.projection, known)
    return _derived(name, field.surface.points, field.projection, gradient, field.velocity[number])


def steps_of(field: FieldData, name: str) -> Steps:
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


def followed_steps(name: str, field: FieldData, horizon: float | None) -> Steps:
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


def derived_unit(name: str, field: FieldData) -> str:
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


def with_vector_scalar(field: Data, name: str) -> Data:
    """Return a field with the magnitude or a component of its vectors among its scalars.

    The ``name`` of vectors of the mesh is that of their magnitude, as in ``"U"``, and with a letter
    that of a component, as in ``"U_x"``; ``"speed_x"`` is a component of the drawn vectors. For any
    other name, and on a map, the field is returned as it is.
    """
    if name in field.scalars or field.projection is not None:
        return field
    own = field.vectors or UNNAMED
    base, _, letter = name.rpartition("_")
    if base == "speed":
        base = own
    parts = [part for part in field.parts if part.rpartition("_")[0] == name]
    long_name = name
    unit = ""
    steps: Steps
    on_cells: tuple[str, ...] = ()
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
