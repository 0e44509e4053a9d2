"""Scalars that are computed from the velocity at the nodes, and its gradient along a surface."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.field.derived.gradient import NodeGradient, node_gradient, true_velocity
from flowtex.field.derived.vectors import vector_names, with_vector_scalar
from flowtex.field.steps import LazySteps, Steps, map_steps
from flowtex.field.validation import NO_DATA, known_nodes

#: Functions of the gradient a[m, n], the change of component m along direction n.
DERIVED: dict[str, Callable[[Floats], Floats]] = {
    "vorticity": lambda a: a[1, 0] - a[0, 1],
    "divergence": lambda a: a[0, 0] + a[1, 1],
    "shear": lambda a: np.hypot(a[0, 0] - a[1, 1], a[0, 1] + a[1, 0]),
    "okubo_weiss": lambda a: (a[0, 0] - a[1, 1]) ** 2 + 4 * a[0, 1] * a[1, 0],
}
#: Derived scalars of both signs.
SIGNED = frozenset(("vorticity", "divergence", "okubo_weiss"))
#: Scalars for which particles are followed over a horizon, by the field; the tracer adds them.
FOLLOWED: dict[str, Callable[[Any, float], Steps]] = {}
#: Names such as those that other programs give to the components of a vector.
COMPONENT = re.compile(r"[_:.\[ -][xyz012]\]?$", re.IGNORECASE)
#: Long names that differ from the names.
LONG_NAMES = {"okubo_weiss": "Okubo-Weiss parameter", "ftle": "FTLE"}


def derived_steps(name: str, field: Any) -> Steps:
    """Return one of :data:`DERIVED`, (T, J, I); NaN where too few neighbours have data."""
    if name not in DERIVED:
        raise FieldError(
            f"{name!r} cannot be derived; expected one of {', '.join((*DERIVED, *FOLLOWED))}"
        )
    surface, projection, compute = field.surface, field.projection, DERIVED[name]
    whole = node_gradient(surface, projection)

    def scalar(step: Floats, gradient: NodeGradient = whole) -> Floats:
        with np.errstate(invalid="ignore"):
            moved = true_velocity(step, surface.points, projection)
            return gradient.with_poles(compute(gradient.of_vectors(moved)))

    def known_only(number: int) -> Floats:
        gradient = node_gradient(surface, projection, known_nodes(field, number, number))
        return scalar(field.velocity[number], gradient)

    if field.uncertainty == NO_DATA:
        return LazySteps(len(field.times), known_only)
    return map_steps(field.velocity, scalar)


def steps_of(field: Any, name: str) -> Steps:
    """Return nodal values of a field at all times, (T or 1, J, I), by the name of a scalar."""
    if name in field.scalars:
        return field.scalars[name]
    if name == "speed":
        return field.speed
    if name in (other := with_vector_scalar(field, name)).scalars:
        return other.scalars[name]
    known = ("speed", *field.scalars, *vector_names(field), *DERIVED)
    names = ", ".join(map(repr, dict.fromkeys(known)))
    msg = f"the field has no scalar {name!r}; expected one of {names}"
    if COMPONENT.search(name):
        msg += "; a component is named as in 'U_x', or chosen by component=0"
    if name in FOLLOWED:
        msg = f"{name!r} needs a horizon; first call field.with_derived({name!r}, horizon=...)"
    raise FieldError(msg)


def followed_steps(name: str, field: Any, horizon: float | None) -> Steps:
    """Return one of :data:`FOLLOWED` at each node and step of a field, (T, J, I)."""
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
    time = f"({time})" if "/" in time else time
    return f"1/{time}²" if name == "okubo_weiss" else f"1/{time}"
