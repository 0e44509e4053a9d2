"""A formula, its values at nodes, and its rates at one time with their exact gradient."""

from __future__ import annotations

import inspect
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.arguments import is_number, near_names
from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.field.formula.grammar import Tree, Values, evaluate, parse, size

__all__ = ["Formula", "Parameter"]

RANGE = (-5.0, 5.0)  #: Default range of a coordinate.
MOST_SIZE = 20_000  #: Most operations and values of a rate, or of one of its derivatives.
MOST = 1e30  #: Greatest speed and length; values beyond are blanked.
TANGENT_SHARE = 1e-5  #: Step of the differences for tangents, as a share of a range.
VARIABLES = ("x", "y", "z", "u", "v", "t")  #: Names of positions and of the time.
_TURN = (-np.pi, np.pi)
#: Surfaces by name: x, y and z, and the ranges of u and v.
SURFACES: Mapping[str, tuple[tuple[str, str, str], Mapping[str, tuple[float, float]]]] = {
    "sphere": (
        ("cos(v)*cos(u)", "cos(v)*sin(u)", "sin(v)"),
        {"u": _TURN, "v": (-np.pi / 2, np.pi / 2)},
    ),
    "torus": (
        ("(1 + 0.4*cos(v))*cos(u)", "(1 + 0.4*cos(v))*sin(u)", "0.4*sin(v)"),
        {"u": _TURN, "v": _TURN},
    ),
    "cylinder": (("cos(u)", "sin(u)", "v"), {"u": _TURN, "v": (-1.5, 1.5)}),
}
COMPONENTS = 3  #: Components of a velocity in space.
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
FUNCTION_SHARE = 1e-4  #: Step of finite differences for functions, as a share of a range.
#: Steps and weights of these finite differences.
WEIGHTS = ((-2, 1 / 12), (-1, -2 / 3), (1, 2 / 3), (2, -1 / 12))


@dataclass(frozen=True)
class Parameter:
    """The value of a parameter, and the range of its slider.

    Examples
    --------
    >>> import flowtex
    >>> flowtex.formula("y", "-x - b*y", b=0.2).formula.parameters["b"]
    Parameter(value=0.2, low=0.0, high=0.4)
    """

    value: float
    low: float
    high: float

    @classmethod
    def of(cls, name: str, raw: Any) -> Parameter:
        """Return the parameter of a value, or of value, low and high.

        Raises
        ------
        FieldError
            When the value is no number, not between low and high, or these are not in order.
        """
        try:
            value, *ends = map(float, (raw,) if is_number(raw) else raw)
            low, high = ends or (sorted((0.0, 2 * value)) if value else (-1.0, 1.0))
        except (TypeError, ValueError, OverflowError):
            value = low = high = np.nan
        if not (low <= value <= high and low < high and np.isfinite(high - low)):
            raise FieldError(
                f"{name} is {raw!r}; expected a number, or value, low and high of a slider, such "
                "as (0.2, 0, 1)"
            )
        return cls(value, float(low), float(high))


@dataclass(frozen=True)
class Expression:
    """One expression: its text, its tree if it has one, and the function of its values."""

    text: str
    tree: Tree | None
    values: Callable[[Values], ArrayLike]

    @classmethod
    def of(cls, source: Any, names: tuple[str, ...]) -> Expression:
        """Read a text, a number, a SymPy expression or a function of some of the names.

        Raises
        ------
        FieldError
            When the source has another type, contains another name, or cannot be parsed.
        """
        if isinstance(source, str) or is_number(source) or hasattr(source, "free_symbols"):
            tree = parse(str(source), names)
        elif callable(source):
            return cls._function(source, names)
        else:
            raise FieldError(
                f"an expression is {source!r}; expected a text, such as '-sin(x)', or a function"
            )
        return cls(str(source), tree, lambda values: evaluate(tree, values))

    @classmethod
    def _function(cls, function: Callable[..., Any], names: tuple[str, ...]) -> Expression:
        text = getattr(function, "__name__", "function")
        try:
            inputs = tuple(inspect.signature(function).parameters)
        except (TypeError, ValueError):
            inputs = ("?",)
        for name in inputs:
            if name not in names:
                raise FieldError(f"the function {text} takes {name}; {near_names(name, names)}")
        return cls(text, None, lambda values: function(**{name: values[name] for name in inputs}))


@dataclass(frozen=True, eq=False)
class Formula:
    """The formula of a field.

    Attributes
    ----------
    expressions
        The rates of the two coordinates, or the three components of the velocity in space.
    ranges
        Ranges of the two coordinates: ``x`` and ``y``, or ``u`` and ``v`` on a surface.
    surface
        The three expressions of a surface in space; empty on the plane.
    parameters
        By name.

    Examples
    --------
    >>> import flowtex
    >>> formula = flowtex.formula("y", "-sin(x)", x=(-7, 7)).formula
    >>> formula.texts, formula.ranges["x"]
    (('y', '-sin(x)'), (-7.0, 7.0))
    """

    expressions: tuple[Expression, ...]
    ranges: Mapping[str, tuple[float, float]]
    surface: tuple[Expression, ...]
    parameters: Mapping[str, Parameter]

    @classmethod
    def of(
        cls,
        expressions: tuple[Any, ...],
        surface: Any,
        ranges: Mapping[str, Any],
        parameters: Mapping[str, Any],
        *,
        timed: bool,
    ) -> Formula:
        """Read the arguments of :func:`flowtex.formula`.

        Parameters
        ----------
        expressions
            Components of the velocity: two, or three along x, y and z.
        surface
            Name of a surface, or its three expressions; ``None`` for the plane.
        ranges
            Ends of each coordinate, by its name; ``None`` for the default.
        parameters
            Value, or value, low and high, by the name of the parameter.
        timed
            Whether expressions may contain the time ``t``.

        Raises
        ------
        FieldError
            When the number of expressions does not fit the surface, a range belongs to no
            coordinate, a parameter has the name of a coordinate, or an expression cannot be read.
        """
        places, defaults = _surface(surface)
        if len(expressions) not in ((2, 3) if places else (2,)):
            if places:
                expected = "two, the rates of u and v, or three, the velocity along x, y and z"
            else:
                expected = "two, the rates of x and y"
            raise FieldError(f"{len(expressions)} expressions are given; expected {expected}")
        for name, ends in ranges.items():
            if ends is not None and name not in defaults:
                raise FieldError(
                    f"{name} has a range, but the coordinates here are {' and '.join(defaults)}"
                )
        if taken := [name for name in parameters if name in VARIABLES]:
            raise FieldError(
                f"{taken[0]} is a coordinate or the time; give the parameter another name"
            )
        read = {name: Parameter.of(name, value) for name, value in parameters.items()}
        names = (*defaults, *read)
        values = (*names, *("xyz" if places else ""), *("t" if timed else ""))
        result = cls(
            tuple(Expression.of(each, values) for each in expressions),
            {name: _range(name, ranges[name] or defaults[name]) for name in defaults},
            tuple(Expression.of(each, names) for each in places),
            read,
        )
        gradient_trees(result)  # raises an error where it is too large
        return result

    @property
    def texts(self) -> tuple[str, ...]:
        """The expressions as text."""
        return tuple(each.text for each in self.expressions)

    @property
    def title(self) -> str:
        """The expressions as one line."""
        if len(self.texts) == COMPONENTS:
            return f"({', '.join(self.texts)})"
        return ", ".join(f"{n}' = {text}" for n, text in zip(self.ranges, self.texts, strict=True))

    def coordinates(self, shape: tuple[int, int]) -> tuple[Floats, Floats]:
        """Return evenly spaced coordinates of nodes, (J, I)."""
        lines = []
        for ends, n in zip(self.ranges.values(), shape[::-1], strict=True):
            lines.append(np.linspace(*ends, n))
        u, v = np.meshgrid(*lines)
        return u, v

    def points(self, u: Floats, v: Floats) -> Floats:
        """Return the positions (J, I, 2 or 3) at coordinates (J, I)."""
        if not self.surface:
            return np.stack([u, v], axis=-1)
        return _values(self.surface, self._named(u, v))

    def velocity(self, u: Floats, v: Floats, time: float) -> Floats:
        """Return the velocity (J, I, 2 or 3) at coordinates (J, I), NaN where it is undefined."""
        values = {**self._named(u, v), "t": time}
        if self.surface:
            values |= dict(zip("xyz", np.moveaxis(self.points(u, v), -1, 0), strict=True))
        rates = _values(self.expressions, values)
        if not self.surface or len(self.expressions) == COMPONENTS:
            return rates
        along = np.zeros((*u.shape, COMPONENTS))
        for k, (low, high) in enumerate(self.ranges.values()):
            h = TANGENT_SHARE * (high - low)
            if k == 0:
                du = h
                dv = 0.0
            else:
                du = 0.0
                dv = h
            tangent = (self.points(u + du, v + dv) - self.points(u - du, v - dv)) / (2 * h)
            along += rates[..., k, None] * tangent
        return along

    def _named(self, u: Floats, v: Floats) -> Values:
        numbers = {name: each.value for name, each in self.parameters.items()}
        return numbers | dict(zip(self.ranges, (u, v), strict=True))


def _values(expressions: tuple[Expression, ...], values: Values) -> Floats:
    """Evaluate expressions at nodes, (J, I, number of expressions); NaN where one is undefined."""
    shape = next(np.shape(value) for value in values.values() if np.ndim(value))
    result = np.empty((*shape, len(expressions)))
    with np.errstate(all="ignore"):
        for k, each in enumerate(expressions):
            try:
                result[..., k] = each.values(values)
            except (TypeError, ValueError) as error:
                raise FieldError(
                    f"{each.text} does not return numbers at nodes of shape {shape}: {error}"
                ) from error
        result[~(np.abs(result) < MOST)] = np.nan
    return result


def _surface(surface: Any) -> tuple[tuple[Any, ...], Mapping[str, tuple[float, float]]]:
    """Return the expressions of a surface, and its coordinates with their usual ranges."""
    if surface is None:
        return (), {"x": RANGE, "y": RANGE}
    if isinstance(surface, str) and surface in SURFACES:
        return SURFACES[surface]
    if not isinstance(surface, (tuple, list)) or len(surface) != COMPONENTS:
        names = ", ".join(SURFACES)
        raise FieldError(
            f"surface is {surface!r}; expected x, y and z of u and v, or one of {names}"
        )
    return tuple(surface), {"u": RANGE, "v": RANGE}


def _range(name: str, ends: Any) -> tuple[float, float]:
    try:
        low, high = map(float, ends)
    except (TypeError, ValueError, OverflowError):
        low = high = np.nan
    if not (low < high and abs(low) < MOST and abs(high) < MOST):
        raise FieldError(
            f"{name} is {ends!r}; expected two numbers, the lower one first, such as (-7, 7)"
        )
    return low, high


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
            is_first = ("<=" if operation == "min" else ">=", *parts)
            if any(rates):
                return ("where", is_first, *rates)
            return 0.0
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
        return simple(tree[0], *(filled(part, trees) for part in tree[1:]))
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


class Rates:
    """The rates of both coordinates; places are (N, 2).

    Functions have no trees, so their gradient is that of differences of fourth order. A velocity in
    space gives the rates times the metric of the surface, which vanish at the same places.
    """

    def __init__(self, formula: Formula, time: float) -> None:
        self._formula = formula
        self._time = time
        self.ends = np.array(list(formula.ranges.values()))
        self._values = {name: each.value for name, each in formula.parameters.items()} | {"t": time}
        self.trees, self._tangents = _trees(formula)
        self._gradient = gradient_trees(formula)

    @property
    def is_known(self) -> bool:
        """Whether the rates can be computed, which functions on a surface do not allow."""
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
        sides = []
        for h in steps:
            sides.append(sum(w * self.at(places + n * h) for n, w in WEIGHTS) / h.sum())
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
    tangents = []
    for name in formula.ranges:
        tangents.append([derivative(place, name) for place in places])
    if len(trees) == COMPONENTS:
        along = [[simple("*", a, b) for a, b in zip(row, trees, strict=True)] for row in tangents]
        trees = [simple("+", *row) for row in along]
    _check_sizes(trees, "a rate")
    return trees, tangents if places else []


def gradient_trees(formula: Formula) -> list[Tree]:
    """Return the trees of the derivatives of the rates, row by row; none for functions."""
    trees, _ = _trees(formula)
    gradient = []
    for tree in trees:
        for name in formula.ranges:
            gradient.append(derivative(tree, name))
    _check_sizes(gradient, "a derivative")
    return gradient


def _check_sizes(trees: Sequence[Tree], what: str) -> None:
    """Raise a FieldError for a tree of too many operations and values."""
    for tree in trees:
        count = size(tree)
        if count > MOST_SIZE:
            raise FieldError(
                f"{what} of the formula has {count:,} operations and values; expected at most "
                f"{MOST_SIZE:,}. Simplify its expressions"
            )
