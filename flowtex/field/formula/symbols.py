"""Expressions of sympy as trees, node by node, without loading sympy or parsing text."""

from __future__ import annotations

from collections.abc import Collection
from functools import reduce
from typing import Any

from flowtex.field.formula.grammar import FUNCTIONS, MOST_DEPTH, FormulaError, Tree

#: Operations for classes of sympy with other names.
_NAMES = {
    "Add": "+",
    "Mul": "*",
    "Pow": "^",
    "StrictLessThan": "<",
    "StrictGreaterThan": ">",
    "LessThan": "<=",
    "GreaterThan": ">=",
    "ceiling": "ceil",
}


def is_symbolic(expression: object) -> bool:
    """Return whether this is an expression of sympy's."""
    return type(expression).__module__.startswith("sympy.") and hasattr(expression, "args")


def tree_of(expression: Any, names: Collection[str], depth: int = 0) -> Tree:
    """Return the tree of an expression with these names.

    Raises a FormulaError for operations that formulas do not have.
    """
    kind = type(expression).__name__
    if depth > MOST_DEPTH:
        msg = f"{kind} is nested more than {MOST_DEPTH} levels deep; simplify it"
        raise FormulaError(msg)
    if kind in ("Symbol", "Dummy"):
        if expression.name in names:
            return str(expression.name)
        listed = ", ".join(sorted(names))
        msg = (
            f"{expression.name} is unknown; known are {listed}. Give a parameter its value, as in "
            f"{expression.name}=1"
        )
        raise FormulaError(msg)
    if not expression.args:
        try:
            return float(expression)
        except (TypeError, ValueError) as error:
            msg = f"the sympy expression {expression} is not a real number; expected one"
            raise FormulaError(msg) from error
    if kind == "Piecewise":
        pairs = [(p.args[0], p.args[1]) for p in expression.args]
        values = [tree_of(value, names, depth + 1) for value, _ in pairs]
        last: Tree = float("nan")
        for value, (_, holds) in zip(values[::-1], pairs[::-1], strict=True):
            always = type(holds).__name__ == "BooleanTrue"
            last = value if always else ("where", tree_of(holds, names, depth + 1), value, last)
        return last
    name = _NAMES.get(kind, kind.lower())
    if name not in (*_NAMES.values(), *FUNCTIONS):
        functions = ", ".join(FUNCTIONS)
        msg = (
            f"the sympy function {kind} is not allowed in a formula; expected + - * / ^ and "
            f"{functions}"
        )
        raise FormulaError(msg)
    arguments = [tree_of(part, names, depth + 1) for part in expression.args]
    if name == "^":
        return reduce(lambda base, power: (name, base, power), arguments)
    return (name, *arguments)
