"""A formula, and its values at nodes."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.arguments import is_number, near_names
from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.field.formula.derivatives import derivative, filled, simple
from flowtex.field.formula.grammar import Tree, Values, evaluate, parse, size

RANGE = (-5.0, 5.0)  #: Default range of a coordinate.
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
MOST_SIZE = 20_000  #: Most operations and values of a rate, or of one of its derivatives.
COMPONENTS = 3  #: Components of a velocity in space.


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
            if is_number(raw):
                raw = (raw,)
            value, *ends = map(float, raw)
            if not ends:
                ends = _default_ends(value)
            low, high = ends
        except (TypeError, ValueError, OverflowError):
            value = low = high = np.nan
        if not (low <= value <= high and low < high and np.isfinite(high - low)):
            raise FieldError(
                f"{name} is {raw!r}; expected a number, or value, low and high of a slider, such "
                "as (0.2, 0, 1)"
            )
        return cls(value, float(low), float(high))


def _default_ends(value: float) -> list[float]:
    """Return the range of the slider of a parameter for which none is given."""
    if value:
        return sorted((0.0, 2 * value))
    return [-1.0, 1.0]


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
    def all_of(cls, sources: Sequence[Any], names: Sequence[str]) -> tuple[Expression, ...]:
        """Read several expressions of the same names."""
        return tuple(cls.of(source, tuple(names)) for source in sources)

    @classmethod
    def _function(cls, function: Callable[..., Any], names: tuple[str, ...]) -> Expression:
        """Return the expression of a function whose arguments are some of the names."""
        text = getattr(function, "__name__", "function")
        try:
            inputs = tuple(inspect.signature(function).parameters)
        except (TypeError, ValueError):
            inputs = ("?",)
        for name in inputs:
            if name not in names:
                raise FieldError(f"the function {text} takes {name}; {near_names(name, names)}")

        def values_of_function(values: Values) -> Any:
            arguments = {name: values[name] for name in inputs}
            return function(**arguments)

        return cls(text, None, values_of_function)


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
        if places:
            most = 3
            expected = "two, the rates of u and v, or three, the velocity along x, y and z"
        else:
            most = 2
            expected = "two, the rates of x and y"
        if not 2 <= len(expressions) <= most:
            raise FieldError(f"{len(expressions)} expressions are given; expected {expected}")
        for name, ends in ranges.items():
            if ends is not None and name not in defaults:
                raise FieldError(
                    f"{name} has a range, but the coordinates here are {' and '.join(defaults)}"
                )
        for name in parameters:
            if name in VARIABLES:
                raise FieldError(
                    f"{name} is a coordinate or the time; give the parameter another name"
                )
        read = {name: Parameter.of(name, value) for name, value in parameters.items()}
        names = (*defaults, *read)
        variables = list(names)
        if places:
            variables += "xyz"
        if timed:
            variables += "t"
        velocity = Expression.all_of(expressions, variables)
        ends_by_name = {}
        for name, default in defaults.items():
            ends_by_name[name] = _range(name, ranges[name] or default)
        result = cls(velocity, ends_by_name, Expression.all_of(places, names), read)
        gradient_trees(result)  # raises an error where it is too large
        return result

    @property
    def texts(self) -> tuple[str, ...]:
        """The expressions as text."""
        return tuple(each.text for each in self.expressions)

    @property
    def parameter_values(self) -> dict[str, float]:
        """The value of each parameter."""
        return {name: each.value for name, each in self.parameters.items()}

    @property
    def title(self) -> str:
        """The expressions as one line."""
        if len(self.texts) == COMPONENTS:
            return f"({', '.join(self.texts)})"
        equations = []
        for name, text in zip(self.ranges, self.texts, strict=True):
            equations.append(f"{name}' = {text}")
        return ", ".join(equations)

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
        return self.parameter_values | dict(zip(self.ranges, (u, v), strict=True))


def _values(expressions: tuple[Expression, ...], values: Values) -> Floats:
    """Evaluate expressions at nodes, (J, I, number of expressions); NaN where one is undefined."""
    shape = np.broadcast_shapes(*map(np.shape, values.values()))
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
    """Return the ends of a coordinate, the lower one first."""
    try:
        low, high = map(float, ends)
    except (TypeError, ValueError, OverflowError):
        low = high = np.nan
    if not (low < high and abs(low) < MOST and abs(high) < MOST):
        raise FieldError(
            f"{name} is {ends!r}; expected two numbers, the lower one first, such as (-7, 7)"
        )
    return low, high


def rate_trees(formula: Formula) -> tuple[list[Tree], list[list[Tree]]]:
    """Return the trees of the rates and of the tangents; both are empty for functions."""
    trees = _trees_of(formula.expressions)
    places = _trees_of(formula.surface)
    if trees is None or places is None:
        return [], []
    place_of = dict(zip("xyz", places, strict=False))
    trees = [filled(tree, place_of) for tree in trees]
    tangents = []
    for name in formula.ranges:
        tangents.append([derivative(place, name) for place in places])
    if len(trees) == COMPONENTS:
        trees = [_product(row, trees) for row in tangents]
    _check_sizes(trees, "a rate")
    if not places:
        return trees, []
    return trees, tangents


def _trees_of(expressions: Sequence[Expression]) -> list[Tree] | None:
    """Return the trees of expressions; ``None`` if one is a function."""
    trees = []
    for each in expressions:
        if each.tree is None:
            return None
        trees.append(each.tree)
    return trees


def _product(first: list[Tree], second: list[Tree]) -> Tree:
    """Return the tree of the scalar product of two vectors."""
    terms = [simple("*", a, b) for a, b in zip(first, second, strict=True)]
    return simple("+", *terms)


def gradient_trees(formula: Formula) -> list[Tree]:
    """Return the trees of the derivatives of the rates, row by row; none for functions."""
    trees, _ = rate_trees(formula)
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
