"""Derivatives of expressions, and expressions in a simpler form."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
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
        if tree == name:
            return 1.0
        return 0.0
    operation, *parts = tree
    if operation == "*":
        parts = _powers(parts)
        if len(parts) == 1:
            return derivative(parts[0], name)
    if operation in ("*", "min", "max"):
        parts = _halves(operation, parts)
    rates = [derivative(part, name) for part in parts]
    match operation:
        case "+":
            return simple("+", *rates)
        case "*":
            first, second = parts
            changes = simple("*", rates[0], second), simple("*", first, rates[1])
            return simple("+", *changes)
        case "min" | "max":
            if not any(rates):
                return 0.0
            if operation == "min":
                comparison = "<="
            else:
                comparison = ">="
            return ("where", (comparison, *parts), *rates)
        case "where":
            if any(rates[1:]):
                return ("where", parts[0], *rates[1:])
            return 0.0
    terms = []
    for rule, rate in zip(_rules(operation), rates, strict=False):
        if rate != 0:
            terms.append(simple("*", filled(rule, dict(zip("ab", parts, strict=False))), rate))
    return simple("+", *terms)


def _powers(factors: Sequence[Tree]) -> list[Tree]:
    """Return factors with repeated ones joined to powers: x*x*x is x^3."""
    powers: list[Tree] = []
    for factor, count in Counter(factors).items():
        powers.append(simple("^", factor, float(count)))
    return powers


def _halves(operation: str, parts: Sequence[Tree]) -> list[Tree]:
    """Return the two halves of an operation; the derivative grows with n log n of its n parts."""
    middle = len(parts) // 2
    halves: list[Tree] = []
    for half in (parts[:middle], parts[middle:]):
        if len(half) == 1:
            whole = half[0]
        else:
            whole = (operation, *half)
        halves.append(whole)
    return halves


@cache
def _rules(operation: str) -> tuple[Tree, ...]:
    return tuple(parse(text, "ab") for text in _RULES.get(operation, ()))


def filled(tree: Tree, trees: Mapping[str, Tree]) -> Tree:
    """Return a tree with other trees in place of some of its names."""
    if isinstance(tree, tuple):
        operation, *parts = tree
        return simple(operation, *[filled(part, trees) for part in parts])
    if isinstance(tree, str):
        return trees.get(tree, tree)
    return tree


def simple(operation: str, *parts: Tree) -> Tree:
    """Return the tree of an operation; sums and products without terms 0 and factors 1."""
    if operation in ("+", "*"):
        if operation == "+":
            neutral = 0.0
        else:
            neutral = 1.0
        if operation == "*" and 0.0 in parts:
            return 0.0
        parts = tuple(part for part in parts if part != neutral)
        if len(parts) < 2:
            if parts:
                return parts[0]
            return neutral
    elif operation == "^" and parts[1] == 1.0:
        return parts[0]
    if all(isinstance(part, float) for part in parts):
        with np.errstate(all="ignore"):
            value: Any = float(evaluate((operation, *parts), {}))
        if np.isfinite(value):
            return float(value)
    return (operation, *parts)
