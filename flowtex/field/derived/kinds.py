"""The quantities that are derived from the velocity of a field, by name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.field.steps import Steps

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
#: Long names that differ from the names.
LONG_NAMES = {"okubo_weiss": "Okubo-Weiss parameter", "ftle": "FTLE"}
