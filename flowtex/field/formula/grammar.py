"""The language of formulas: tokens, a parser by binding powers, and values in NumPy.

A formula becomes a tree of plain Python: a number, a name, or a tuple of an operation and its
arguments, such as ``("+", "x", ("*", 2.0, ("sin", "y")))``. The grammar makes nothing else, and
nothing in it is run as code. The tree goes to the browser as JSON, where ``client/src/formula.ts``
computes the same values.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from functools import reduce
from typing import Any, NoReturn

import numpy as np

from flowtex._util.arguments import near_names
from flowtex.errors import FieldError

Tree = float | str | tuple[Any, ...]
#: Numbers or arrays by name.
Values = Mapping[str, Any]

#: Functions of one argument with the same name in NumPy.
SAME_NAMES = (
    *("sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "log", "log2"),
    *("log10", "sqrt", "abs", "sign", "floor", "ceil"),
)
#: Operations, each with its number of arguments; ``None`` means two or more.
OPERATIONS: dict[str, tuple[Any, int | None]] = {
    "+": (np.add, None),
    "*": (np.multiply, None),
    "/": (np.divide, 2),
    "^": (np.power, 2),
    "<": (lambda a, b: np.less(a, b) * 1.0, 2),
    ">": (lambda a, b: np.greater(a, b) * 1.0, 2),
    "<=": (lambda a, b: np.less_equal(a, b) * 1.0, 2),
    ">=": (lambda a, b: np.greater_equal(a, b) * 1.0, 2),
    "neg": (np.negative, 1),
    **{name: (getattr(np, name), 1) for name in SAME_NAMES},
    "ln": (np.log, 1),
    "atan2": (np.arctan2, 2),
    "hypot": (np.hypot, 2),
    "mod": (lambda a, b: a - b * np.floor(np.divide(a, b)), 2),
    "min": (np.minimum, None),
    "max": (np.maximum, None),
    "where": (lambda a, b, c: np.where(a, b, c), 3),
}
#: Names of functions in formulas.
FUNCTIONS = tuple(name for name in OPERATIONS if name.isalnum() and name != "neg")
CONSTANTS = {"pi": np.pi, "e": np.e}  #: Named numbers.

#: Binding power of each operator to its right.
BINDING = {
    **dict.fromkeys(("<", ">", "<=", ">="), 1),
    **{"+": 2, "-": 2, "*": 3, "/": 3, "^": 5, "**": 5},
}
SIGN_BINDING = 4  #: Binding power of a sign, which is weaker than a power.
MOST_LETTERS = 2000  #: Greatest length of a formula.
MOST_DEPTH = 60  #: Greatest depth of nesting.
_TOKEN = re.compile(
    r" *(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<name>[^\W\d]\w*)"
    r"|(?P<sign>\*\*|<=|>=|[-+*/^(),<>]))"
)
#: Typographic signs.
_PRINTED = str.maketrans({"\u2212": "-", "\u00b7": "*", "\u00d7": "*"})


class FormulaError(FieldError):
    """A formula cannot be read; the text points at the position.

    Examples
    --------
    >>> import flowtex
    >>> flowtex.formula("y", "-sin(x")
    Traceback (most recent call last):
    flowtex.field.formula.grammar.FormulaError: ...
    """


def parse(text: str, names: Collection[str]) -> Tree:
    """Return the tree of a formula with these names.

    Raises a FormulaError for other texts, which points at the place.
    """
    return _Parser(text, names).whole()


def evaluate(tree: Tree, values: Values) -> Any:
    """Return the value of a tree, an array if its names have arrays."""
    if isinstance(tree, str):
        return values[tree]
    if not isinstance(tree, tuple):
        return tree
    function, count = OPERATIONS[tree[0]]
    arguments = [evaluate(part, values) for part in tree[1:]]
    return function(*arguments) if count else reduce(function, arguments)


class _Parser:
    """A parser of one formula after Pratt: each operator has a binding power."""

    def __init__(self, text: str, names: Collection[str]) -> None:
        self.text = re.sub(r"\s", " ", text).translate(_PRINTED)
        self.names = names
        if len(text) > MOST_LETTERS:
            raise FormulaError(
                f"the formula has {len(text)} characters; expected {MOST_LETTERS} at most"
            )
        #: Kind, text and place of each token; the last one is the end.
        self.tokens: list[tuple[str, str, int]] = []
        at, end = 0, len(self.text.rstrip())
        while at < end:
            match = _TOKEN.match(self.text, at)
            if match is None:
                at += len(self.text[at:]) - len(self.text[at:].lstrip())
                self.fail(f"{self.text[at]!r} is not allowed in a formula", at)
            kind = str(match.lastgroup)
            self.tokens.append((kind, match[kind], match.start(kind)))
            at = match.end()
        self.tokens.append(("end", "", end))
        self.next = 0
        self.depth = 0

    def fail(self, problem: str, at: int | None = None) -> NoReturn:
        at = self.tokens[self.next][2] if at is None else at
        raise FormulaError(f"{problem}\n  {self.text}\n  {' ' * at}^")

    def take(self) -> tuple[str, str, int]:
        token = self.tokens[self.next]
        self.next = min(self.next + 1, len(self.tokens) - 1)
        return token

    def expect(self, sign: str, instead: str) -> None:
        kind, text, _ = self.tokens[self.next]
        if text != sign:
            problem = "the formula ends" if kind == "end" else f"here is {text!r}"
            self.fail(f"{problem} and {instead}")
        self.take()

    def whole(self) -> Tree:
        tree = self.expression(0)
        kind, text, _ = self.tokens[self.next]
        if kind == "sign":
            self.fail(f"{text!r} is unexpected here")
        if kind != "end":
            self.fail(f"an operator is missing before {text!r}; write * for a product")
        return tree

    def expression(self, binding: int) -> Tree:
        """Read as long as operators bind more tightly than ``binding``."""
        self.depth += 1
        if self.depth > MOST_DEPTH:
            self.fail(f"the formula is nested more than {MOST_DEPTH} levels deep; simplify it")
        left = self.operand()
        while BINDING.get(self.tokens[self.next][1], 0) > binding:
            left = self.operation(left)
        self.depth -= 1
        return left

    def operation(self, left: Tree) -> Tree:
        _, sign, at = self.take()
        if BINDING[sign] == 1 and isinstance(left, tuple) and BINDING.get(left[0]) == 1:
            self.fail("a comparison can have only two sides; write (a < b)*(b < c)", at)
        is_power = BINDING[sign] == BINDING["^"]
        right = self.expression(BINDING[sign] - is_power)
        if sign == "-":
            sign, right = "+", ("neg", right)
        if sign in ("+", "*") and isinstance(left, tuple) and left[0] == sign:
            return self.checked((*left, right), at)
        return self.checked(("^" if is_power else sign, left, right), at)

    def checked(self, tree: tuple[Any, ...], at: int) -> Tree:
        """Return a tree; refuse one that is too deep, as from many operators in a row."""
        if _depth(tree) > MOST_DEPTH:
            self.fail(f"the formula is nested more than {MOST_DEPTH} levels deep; simplify it", at)
        return tree

    def operand(self) -> Tree:
        kind, text, at = self.take()
        match kind, text:
            case "number", _:
                value = float(text)
                if np.isinf(value):
                    self.fail(f"{text} is too large", at)
                return value
            case "name", _:
                return self.named(text, at)
            case _, "+":
                return self.expression(SIGN_BINDING)
            case _, "-":
                return self.checked(("neg", self.expression(SIGN_BINDING)), at)
            case _, "(":
                tree = self.expression(0)
                self.expect(")", 'a ")" is missing')
                return tree
        problem = "the formula ends" if kind == "end" else f"here is {text!r}"
        return self.fail(f"{problem} and a number, a name or a ( is missing", at)

    def named(self, name: str, at: int) -> Tree:
        is_called = self.tokens[self.next][1] == "("
        if name in self.names and not is_called:
            return name
        if name in FUNCTIONS:
            return self.call(name, at)
        if is_called:
            if name in (*self.names, *CONSTANTS):
                self.fail(f"{name} is not a function; write {name}*( for a product", at)
            self.fail(f"the function {name!r} does not exist; {near_names(name, FUNCTIONS)}", at)
        if name in CONSTANTS:
            return CONSTANTS[name]
        if name == "t":
            self.fail("t is the time; give times=, such as times=np.linspace(0, 10, 41)", at)
        names = ", ".join(sorted(self.names))
        return self.fail(
            f"{name} is unknown; known are {names}. Give a parameter its value, as in {name}=1", at
        )

    def call(self, name: str, at: int) -> Tree:
        count = OPERATIONS[name][1]
        self.expect("(", f"{name} is a function; write {name}(x)")
        arguments = [self.expression(0)]
        while self.tokens[self.next][1] == ",":
            self.take()
            arguments.append(self.expression(0))
        self.expect(")", f'a ")" of {name} is missing')
        if len(arguments) != count if count else len(arguments) < 2:
            expected = count or "two or more"
            self.fail(f"{name} has {len(arguments)} arguments; expected {expected}", at)
        return self.checked((name, *arguments), at)


def _depth(tree: Tree) -> int:
    return 1 + max(map(_depth, tree[1:])) if isinstance(tree, tuple) else 0
