"""The rates of a formula's two coordinates at one time, with their exact gradient."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.field.formula.flow import COMPONENTS, Formula
from flowtex.field.formula.grammar import Tree, evaluate, parse

#: Derivatives of operations by their arguments a and b. Those of steps are zero between these.
_RULES: Mapping[str, tuple[str, ...]] = {
    "neg": ("-1",),
    "/": ("1/b", "-a/b^2"),
    "^": ("b*a^(b - 1)", "a^b*log(a)"),
    "sin": ("cos(a)",),
    "cos": ("-sin(a)",),
    "tan": ("1 + tan(a)^2",),
    "asin": ("1/sqrt(1 - a^2)",),
    "acos": ("-1/sqrt(1 - a^2)",),
    "atan": ("1/(1 + a^2)",),
    "atan2": ("b/(a^2 + b^2)", "-a/(a^2 + b^2)"),
    "sinh": ("cosh(a)",),
    "cosh": ("sinh(a)",),
    "tanh": ("1 - tanh(a)^2",),
    "exp": ("exp(a)",),
    "log": ("1/a",),
    "ln": ("1/a",),
    "log2": (f"{1 / np.log(2)!s}/a",),
    "log10": (f"{1 / np.log(10)!s}/a",),
    "sqrt": ("0.5/sqrt(a)",),
    "abs": ("sign(a)",),
    "hypot": ("a/hypot(a, b)", "b/hypot(a, b)"),
    "mod": ("1", "-floor(a/b)"),
}
#: Step of the differences for functions as a share of a range, and their weights.
FUNCTION_SHARE = 1e-4
WEIGHTS = ((-2, 1 / 12), (-1, -2 / 3), (1, 2 / 3), (2, -1 / 12))


def derivative(tree: Tree, name: str) -> Tree:
    """Return the derivative of a tree with respect to a name."""
    if not isinstance(tree, tuple):
        return 1.0 if tree == name else 0.0
    operation, *parts = tree
    if operation in ("min", "max") and len(parts) > 2:
        parts = [(operation, *parts[:-1]), parts[-1]]
    rates = [derivative(part, name) for part in parts]
    match operation:
        case "+":
            return simple("+", *rates)
        case "*":
            products = [[*parts[:n], rate, *parts[n + 1 :]] for n, rate in enumerate(rates)]
            return simple("+", *(simple("*", *factors) for factors in products))
        case "min" | "max":
            is_first = ("<=" if operation == "min" else ">=", *parts)
            return ("where", is_first, *rates) if any(rates) else 0.0
        case "where":
            return ("where", parts[0], *rates[1:]) if any(rates[1:]) else 0.0
    terms = [
        simple("*", filled(rule, dict(zip("ab", parts, strict=False))), rate)
        for rule, rate in zip(_rules(operation), rates, strict=False)
        if rate != 0
    ]
    return simple("+", *terms)


@cache
def _rules(operation: str) -> tuple[Tree, ...]:
    return tuple(parse(text, "ab") for text in _RULES.get(operation, ()))


def filled(tree: Tree, trees: Mapping[str, Tree]) -> Tree:
    """Return a tree with other trees in place of some of its names."""
    if isinstance(tree, tuple):
        return simple(tree[0], *(filled(part, trees) for part in tree[1:]))
    return trees.get(tree, tree) if isinstance(tree, str) else tree


def simple(operation: str, *parts: Tree) -> Tree:
    """Return the tree of an operation; sums and products without terms 0 and factors 1."""
    if operation in ("+", "*"):
        neutral = 0.0 if operation == "+" else 1.0
        if operation == "*" and 0.0 in parts:
            return 0.0
        parts = tuple(part for part in parts if part != neutral)
        if len(parts) < 2:
            return parts[0] if parts else neutral
    elif operation == "^" and parts[1] == 1.0:
        return parts[0]
    if all(isinstance(part, float) for part in parts):
        with np.errstate(all="ignore"):
            value: Any = float(evaluate((operation, *parts), {}))
        if np.isfinite(value):
            return float(value)
    return (operation, *parts)


class Rates:
    """The rates of both coordinates; places are (N, 2).

    Functions have no trees, so their gradient is that of differences of fourth order. A velocity in
    space gives the rates times the metric of the surface, which vanish at the same places.
    """

    def __init__(self, formula: Formula, time: float) -> None:
        self._formula, self._time = formula, time
        self.ends = np.array(list(formula.ranges.values()))
        self._values = {name: each.value for name, each in formula.parameters.items()} | {"t": time}
        self.trees, self._tangents = _trees(formula)
        self._gradient = gradient_trees(formula)

    @property
    def is_known(self) -> bool:
        """Whether the rates can be computed: not those of functions on a surface."""
        return bool(self.trees) or not self._formula.surface

    def at(self, places: Floats) -> Floats:
        """Return the rates, (N, 2)."""
        if not self.trees:
            x, y = places.T
            return self._formula.velocity(x, y, self._time)
        return self._of(self.trees, places)

    def gradient(self, places: Floats) -> Floats:
        """Return the change of rate k along coordinate m, (N, 2, 2)."""
        if self.trees:
            return self._of(self._gradient, places).reshape(-1, 2, 2)
        steps = FUNCTION_SHARE * np.diag(np.ptp(self.ends, axis=1))
        sides = [sum(w * self.at(places + n * h) for n, w in WEIGHTS) / h.sum() for h in steps]
        return np.stack(sides, axis=-1)

    def positions(self, places: Floats) -> Floats:
        """Return the positions, (N, 3)."""
        points = self._formula.points(places[:, 0], places[:, 1])
        return np.pad(points, ((0, 0), (0, 3 - points.shape[-1])))

    def tangents(self, places: Floats) -> Floats:
        """Return the derivatives of the position along the coordinates, (N, 2, 3)."""
        if not self._tangents:
            return np.broadcast_to(np.eye(2, 3), (len(places), 2, 3))
        return self._of([each for row in self._tangents for each in row], places).reshape(-1, 2, 3)

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

    def _of(self, trees: Sequence[Tree], places: Floats) -> Floats:
        """Return the values of trees, (N, number of trees)."""
        values = self._values | dict(zip(self._formula.ranges, places.T, strict=True))
        result = np.empty((len(places), len(trees)))
        with np.errstate(all="ignore"):
            for k, tree in enumerate(trees):
                result[:, k] = evaluate(tree, values)
        return result


def _trees(formula: Formula) -> tuple[list[Tree], list[list[Tree]]]:
    """Return the trees of the rates and of the tangents; both are empty for functions."""
    trees = [each.tree for each in formula.expressions if each.tree is not None]
    places = [each.tree for each in formula.surface if each.tree is not None]
    if len(trees) < len(formula.expressions) or len(places) < len(formula.surface):
        return [], []
    trees = [filled(tree, dict(zip("xyz", places, strict=False))) for tree in trees]
    tangents = [[derivative(place, name) for place in places] for name in formula.ranges]
    if len(trees) == COMPONENTS:
        along = [[simple("*", a, b) for a, b in zip(row, trees, strict=True)] for row in tangents]
        trees = [simple("+", *row) for row in along]
    return trees, tangents if places else []


def gradient_trees(formula: Formula) -> list[Tree]:
    """Return the trees of the derivatives of the rates, row by row; none for functions."""
    return [derivative(tree, name) for tree in _trees(formula)[0] for name in formula.ranges]
