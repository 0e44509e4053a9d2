"""The language of formulas: trees from texts in Python's syntax, and their values in NumPy.

A formula becomes a tree of plain Python: a number, a name, or a tuple of an operation and its
arguments, such as ``("+", "x", ("*", 2.0, ("sin", "y")))``. Other nodes of Python's parser are
refused, and nothing is run as code. The tree goes to the browser as JSON, where
``client/src/formula.ts`` computes the same values.
"""

from __future__ import annotations

import ast
import re
import sys
import unicodedata
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import reduce
from typing import Any, NoReturn

import numpy as np

from flowtex._util.arguments import near_names
from flowtex.errors import FieldError

Tree = float | str | tuple[Any, ...]
Values = Mapping[str, Any]  #: Numbers or arrays by name.

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

MOST_LETTERS = 2000  #: Greatest length of a formula.
MOST_DEPTH = 60  #: Greatest depth of nesting.
#: Operations by the classes of Python; a difference is the sum with a negative term.
_SIGNS = {ast.Add: "+", ast.Sub: "+", ast.Mult: "*", ast.Div: "/", ast.Pow: "^"}
_COMPARISONS = {ast.Lt: "<", ast.Gt: ">", ast.LtE: "<=", ast.GtE: ">="}
_FOREIGN = re.compile(r"[^\w.+*/(),<>= -]")  #: Characters that no formula has.
#: Typographic signs.
_PRINTED = str.maketrans({"\u2212": "-", "\u00b7": "*", "\u00d7": "*", "^": "**"})


def parse(text: str, names: Collection[str]) -> Tree:
    """Return the tree of a formula with these names.

    Raises a FieldError for other texts, which points at the place.
    """
    return _Reader(text, names).whole()


def evaluate(tree: Tree, values: Values) -> Any:
    """Return the value of a tree for values of its names, which may be arrays."""
    if isinstance(tree, str):
        return values[tree]
    if not isinstance(tree, tuple):
        return tree
    function, count = OPERATIONS[tree[0]]
    arguments = [evaluate(part, values) for part in tree[1:]]
    if count:
        return function(*arguments)
    return reduce(function, arguments)


class Program:
    """The steps that compute the values of trees, of which equal parts are computed once."""

    def __init__(self, trees: Sequence[Tree]) -> None:
        #: The leaves, and ``None`` for the values of operations.
        self._leaves: list[float | str | None] = []
        #: The places of an operation and of its arguments, with its function.
        self._steps: list[tuple[int, Any, tuple[int, ...]]] = []
        self._known: dict[tuple[str | int, ...], int] = {}
        self._visited: dict[int, int] = {}
        self._results = [self._place(tree) for tree in trees]
        self._names = [
            (place, leaf) for place, leaf in enumerate(self._leaves) if isinstance(leaf, str)
        ]
        self._visited.clear()

    def __call__(self, values: Values) -> list[Any]:
        """Return what :func:`evaluate` returns for each tree."""
        found: list[Any] = self._leaves.copy()
        for place, name in self._names:
            found[place] = values[name]
        for place, function, parts in self._steps:
            found[place] = function(*[found[part] for part in parts])
        return [found[place] for place in self._results]

    def _place(self, tree: Tree) -> int:
        """Return where the value of a tree is."""
        if not isinstance(tree, tuple):
            # Zeros with different signs are equal, but their texts are not.
            return self._new_or_known((repr(tree),), tree)
        if id(tree) not in self._visited:
            self._visited[id(tree)] = self._place_of_operation(*tree)
        return self._visited[id(tree)]

    def _place_of_operation(self, name: str, *parts: Tree) -> int:
        function, count = OPERATIONS[name]
        places = [self._place(part) for part in parts]
        if count:
            return self._new_or_known((name, *places), None, function)
        first = places[0]
        for other in places[1:]:
            first = self._new_or_known((name, first, other), None, function)
        return first

    def _new_or_known(
        self, key: tuple[Any, ...], leaf: float | str | None, function: Any = None
    ) -> int:
        if key not in self._known:
            self._known[key] = place = len(self._leaves)
            self._leaves.append(leaf)
            if function is not None:
                self._steps.append((place, function, key[1:]))
        return self._known[key]


def size(tree: Tree) -> int:
    """Return the number of operations and values of a tree; parts that it repeats count again."""
    known: dict[int, int] = {}

    def counted(part: Tree) -> int:
        if not isinstance(part, tuple):
            return 1
        if id(part) not in known:
            known[id(part)] = 1 + sum(map(counted, part[1:]))
        return known[id(part)]

    return counted(tree)


class _Reader:
    """A reader of one formula, whose nodes come from the parser of Python."""

    def __init__(self, text: str, names: Collection[str]) -> None:
        self.text = re.sub(r"\s", " ", text).strip().translate(_PRINTED)
        # Python reads different forms of a letter as one.
        self.names = {unicodedata.normalize("NFKC", name): name for name in names}

    def whole(self) -> Tree:
        """Return the tree of the whole text."""
        if len(self.text) > MOST_LETTERS:
            raise FieldError(
                f"the formula has {len(self.text)} characters; expected {MOST_LETTERS} at most"
            )
        if match := _FOREIGN.search(self.text):
            self.fail(f"{match[0]!r} is not allowed in a formula", match.start())
        try:
            return self.tree(ast.parse(self.text, mode="eval").body)
        except SyntaxError as error:
            self.fail(
                f"the formula cannot be read ({error.msg}); expected numbers and names with "
                "+ - * / ^ between them",
                max((error.offset or 1) - 1, 0),
            )
        except (MemoryError, RecursionError):
            self.fail(f"the formula is nested more than {MOST_DEPTH} levels deep; simplify it", 0)

    def fail(self, problem: str, at: ast.expr | int) -> NoReturn:
        if isinstance(at, ast.expr):  # whose place is in bytes
            at = len(self.text.encode()[: at.col_offset].decode())
        raise FieldError(f"{problem}\n  {self.text}\n  {' ' * at}^")

    def tree(self, node: ast.expr, depth: int = 1) -> Tree:
        """Return the tree of a node of Python's syntax."""
        if depth > MOST_DEPTH:
            raise RecursionError

        def inner(part: ast.expr) -> Tree:
            return self.tree(part, depth + 1)

        match node:
            case ast.Constant(value=int() | float() as number):
                if number > sys.float_info.max:
                    self.fail("the number is too large", node)
                return float(number)
            case ast.Name(id=name):
                return self.named(name, node)
            case ast.UnaryOp(op=ast.USub()):
                return ("neg", inner(node.operand))
            case ast.UnaryOp(op=ast.UAdd()):
                return inner(node.operand)
            case ast.BinOp(op=ast.Add() | ast.Sub() | ast.Mult()):
                return self.chain(node, inner)
            case ast.BinOp(op=ast.Div() | ast.Pow()):
                return (_SIGNS[type(node.op)], inner(node.left), inner(node.right))
            case ast.Compare(ops=[op], comparators=[right]) if type(op) in _COMPARISONS:
                return (_COMPARISONS[type(op)], inner(node.left), inner(right))
            case ast.Call(func=ast.Name(id="Piecewise"), args=pairs):  # of sympy
                return self.piecewise(pairs, inner)
            case ast.Call(func=ast.Name(id=name), keywords=[]):
                return self.call(name, node, inner)
        return self.fail("this is not allowed in a formula", node)

    def named(self, name: str, node: ast.expr) -> Tree:
        """Return the tree of a name, or the number of a constant."""
        if name in self.names:
            return self.names[name]
        if name.lower() in CONSTANTS:
            return CONSTANTS[name.lower()]
        if name in FUNCTIONS:
            self.fail(f"{name} is a function; write {name}(x)", node)
        if name == "t":
            self.fail("t is the time; give times=, such as times=np.linspace(0, 10, 41)", node)
        names = ", ".join(sorted(self.names))
        return self.fail(
            f"{name} is unknown; known are {names}. Give a parameter its value, as in {name}=1",
            node,
        )

    def chain(self, node: ast.BinOp, inner: Callable[[ast.expr], Tree]) -> Tree:
        """Read a sum or a product with all its terms, as ``a - b + c``."""
        sign = _SIGNS[type(node.op)]
        parts: list[Tree] = []
        left: ast.expr = node
        while isinstance(left, ast.BinOp) and _SIGNS.get(type(left.op)) == sign:
            part = inner(left.right)
            if isinstance(left.op, ast.Sub):
                part = ("neg", part)
            parts.append(part)
            left = left.left
        return (sign, inner(left), *parts[::-1])

    def piecewise(self, pairs: list[ast.expr], inner: Callable[[ast.expr], Tree]) -> Tree:
        """Read pairs of a value and the condition under which it holds, the first one first."""
        result: Tree = float("nan")
        for pair in reversed(pairs):
            match pair:
                case ast.Tuple(elts=[value, ast.Constant()]):
                    result = inner(value)
                case ast.Tuple(elts=[value, holds]):
                    result = ("where", inner(holds), inner(value), result)
        return result

    def call(self, name: str, node: ast.Call, inner: Callable[[ast.expr], Tree]) -> Tree:
        """Read a function, also by the name that sympy gives it."""
        function = name.lower().replace("ceiling", "ceil")
        if function not in FUNCTIONS:
            if name in (*self.names, *CONSTANTS):
                self.fail(f"{name} is not a function; write {name}*( for a product", node)
            self.fail(f"the function {name!r} does not exist; {near_names(name, FUNCTIONS)}", node)
        count = OPERATIONS[function][1]
        found = len(node.args)
        if count is None and found < 2:
            self.fail(f"{name} has {found} arguments; expected two or more", node)
        if count is not None and found != count:
            self.fail(f"{name} has {found} arguments; expected {count}", node)
        return (function, *map(inner, node.args))
