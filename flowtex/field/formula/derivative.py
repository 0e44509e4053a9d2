"""Derivatives of formulas: the tree of a derivative, from that of a formula."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np

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
