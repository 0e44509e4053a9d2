"""The rates of a formula at one time, with their exact gradient."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.field.formula.formula import COMPONENTS, Formula, gradient_trees, rate_trees
from flowtex.field.formula.grammar import Program

FUNCTION_SHARE = 1e-4  #: Step of finite differences for functions, as a share of a range.
#: Steps and weights of these finite differences.
WEIGHTS = ((-2, 1 / 12), (-1, -2 / 3), (1, 2 / 3), (2, -1 / 12))


class Rates:
    """The rates of both coordinates; places are (N, 2).

    Functions have no trees, so their gradient is computed by differences of fourth order. For a
    velocity in space, the rates are multiplied by the metric of the surface: the zeros stay.
    """

    def __init__(self, formula: Formula, time: float) -> None:
        self._formula = formula
        self._time = time
        self._names = tuple(formula.ranges)
        self.ends = np.array(list(formula.ranges.values()))
        self._values = formula.parameter_values | {"t": time}
        self.trees, self._tangents = rate_trees(formula)
        self._rates = Program(self.trees)
        self._gradient = Program(gradient_trees(formula))
        self._sides = Program(list(itertools.chain.from_iterable(self._tangents)))

    @property
    def is_known(self) -> bool:
        """Whether the rates can be computed, which functions on a surface do not allow."""
        return bool(self.trees) or not self._formula.surface

    def at(self, places: Floats) -> Floats:
        """Return the rates, (N, 2)."""
        if not self.trees:
            x, y = places.T
            return self._formula.velocity(x, y, self._time)
        return self._of(self._rates, places)

    def gradient(self, places: Floats) -> Floats:
        """Return the change of rate k along coordinate m, (N, 2, 2)."""
        if self.trees:
            return self._of(self._gradient, places).reshape(-1, 2, 2)
        steps = FUNCTION_SHARE * np.diag(np.ptp(self.ends, axis=1))
        sides = []
        for step in steps:
            weighted = [weight * self.at(places + n * step) for n, weight in WEIGHTS]
            sides.append(sum(weighted) / step.sum())
        return np.stack(sides, axis=-1)

    def positions(self, places: Floats) -> Floats:
        """Return the positions, (N, 3)."""
        points = self._formula.points(places[:, 0], places[:, 1])
        return np.pad(points, ((0, 0), (0, 3 - points.shape[-1])))

    def tangents(self, places: Floats) -> Floats:
        """Return the derivatives of the position along the coordinates, (N, 2, 3)."""
        if not self._tangents:
            return np.broadcast_to(np.eye(2, 3), (len(places), 2, 3))
        return self._of(self._sides, places).reshape(-1, 2, 3)

    def area(self, places: Floats) -> Floats:
        """Return the area of a unit of both coordinates, (N,)."""
        one, other = np.moveaxis(self.tangents(places), 1, 0)
        return np.asarray(np.linalg.norm(np.cross(one, other), axis=1))

    def lowered(self, values: Floats, places: Floats) -> Floats:
        """Return rates or gradients (N, 2, ...) divided by the metric, if they contain it."""
        if len(self._formula.expressions) != COMPONENTS:
            return values
        tangents = self.tangents(places)
        metric = np.einsum("nkc,nmc->nkm", tangents, tangents)
        return np.asarray(np.einsum("nkm,nm...->nk...", np.linalg.pinv(metric), values))

    def _of(self, program: Program, places: Floats) -> Floats:
        """Return the values of trees, (N, number of trees)."""
        values: dict[str, Any] = dict(self._values)
        for k, name in enumerate(self._names):
            values[name] = places[:, k]
        with np.errstate(all="ignore"):
            columns = program(values)
        result = np.empty((len(places), len(columns)))
        for k, column in enumerate(columns):
            result[:, k] = column
        return result
