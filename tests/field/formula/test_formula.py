"""Flows from formulas: the grammar, sympy and functions, surfaces, and what strangers type."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from strategies import property_test

import flowtex
from flowtex import FieldError
from flowtex.field.formula.derivatives import derivative
from flowtex.field.formula.formula import MOST_SIZE
from flowtex.field.formula.grammar import FUNCTIONS, OPERATIONS, Program, evaluate, parse, size
from flowtex.field.formula.make import KNOWN, is_line, line_field, with_parameter
from flowtex.rendering.webgl.velocity import client_formula
from flowtex.scene.scene import Scene

VALUES = {"x": np.linspace(-2.0, 2.0, 9), "y": np.linspace(0.3, 1.7, 9), "b": 0.5}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("-x^2", lambda x, y, b: -(x**2)),
        ("2^-x*y", lambda x, y, b: 2.0 ** (-x) * y),
        ("2^3^y", lambda x, y, b: 2 ** (3**y)),
        ("x - y - b", lambda x, y, b: (x - y) - b),
        ("x/y/b", lambda x, y, b: (x / y) / b),
        ("x - (y - b)*-x", lambda x, y, b: x - (y - b) * -x),
        ("1.5e-1*x + .5", lambda x, y, b: 0.15 * x + 0.5),
        ("where(x < 0, -x, (x >= 1)*y)", lambda x, y, b: np.where(x < 0, -x, (x >= 1) * y)),
        ("-(x < 0) + (y > 1)", lambda x, y, b: -1.0 * (x < 0) + 1.0 * (y > 1)),
        (
            "mod(x, 0.7) + max(x, y, b)",
            lambda x, y, b: np.mod(x, 0.7) + np.maximum(x, np.maximum(y, b)),
        ),
        (
            "ln(y)*atan2(y, x)**2 \u2212 pi\u00b7e",
            lambda x, y, b: np.log(y) * np.arctan2(y, x) ** 2 - np.pi * math.e,
        ),
    ],
)
def test_a_formula_has_the_values_of_python(text: str, expected: Any) -> None:
    tree = parse(text, VALUES)
    assert_allclose(evaluate(tree, VALUES), expected(**VALUES), rtol=1e-14)


def test_equal_parts_of_formulas_are_computed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    texts = ("hypot(x, y)*(x + y + 1) - 0.0", "max(hypot(x, y), x + y, b)/-0.0")
    trees = [parse(text, ("x", "y", "b")) for text in texts]
    calls = []

    def hypot(a: Any, b: Any) -> Any:
        calls.append((a, b))
        return np.hypot(a, b)

    monkeypatch.setitem(OPERATIONS, "hypot", (hypot, 2))
    program = Program(trees)
    with np.errstate(divide="ignore"):
        found = program(VALUES)
        assert len(calls) == 1
        for value, tree in zip(found, trees, strict=True):
            np.testing.assert_array_equal(value, evaluate(tree, VALUES))


@pytest.mark.parametrize(
    ("text", "place", "words"),
    [
        ("-sin(x", 4, "'(' was never closed"),
        ("2x", 0, "expected numbers and names with + - * / ^ between them"),
        ("x +* 2", 3, "invalid syntax"),
        ("x @ 2", 2, "'@' is not allowed in a formula"),
        ("a*x", 0, "a is unknown; known are x, y. Give a parameter its value, as in a=1"),
        ("x + (1 < x < 2)", 5, "not allowed"),
        ("x)", 1, "unmatched ')'"),
        ("\u2212é*sin(x, y)", 3, "sin has 2 arguments; expected 1"),
        ("sin", 0, "write sin(x)"),
        ("cosx(2)", 0, "did you mean 'cos'"),
        ("x(y)", 0, "write x*("),
        ("x*x.__class__", 2, "not allowed"),
        ("t", 0, "give times="),
        ("", 0, "cannot be read"),
        ("1e999", 0, "too large"),
        ("-" * 100 + "x", 0, "nested more than 60 levels"),
        ("x" + "/x" * 900, 0, "nested more than 60 levels"),
    ],
)
def test_an_error_points_at_the_place(text: str, place: int, words: str) -> None:
    with pytest.raises(FieldError) as caught:
        flowtex.formula("y", text)
    message, shown, caret = str(caught.value).split("\n")
    assert words in message
    assert shown == f"  {text}".replace("\u2212", "-") and caret == " " * (place + 2) + "^"


LETTERS = "xyzuvtb01.9+-*/^()<>=, \n_sincosexplogabsminmaxwhere\u2212\u03b8;'\"[]{}@"
WORDS = [
    *FUNCTIONS,
    *"xyb+-*/^()<,",
    "<=",
    "**",
    "2",
    "0",
    "1e308",
    ".5",
    "pi",
    "lambda",
    "__import__",
]
TEXTS = st.one_of(
    st.text(LETTERS, max_size=30),
    st.lists(st.sampled_from(WORDS), max_size=14).map(" ".join),
    st.recursive(
        st.sampled_from(["x", "y", "b", "2", "0.5", "1e200", "pi"]),
        lambda inner: st.one_of(
            st.tuples(inner, st.sampled_from(list("+-*/^")), inner).map(
                lambda p: f"({''.join(p)})"
            ),
            st.tuples(st.sampled_from(FUNCTIONS), inner).map(lambda p: f"{p[0]}({p[1]})"),
            inner.map(lambda p: f"-{p}"),
        ),
        max_leaves=8,
    ),
)


@property_test(150, fuzz=400)
@given(TEXTS, TEXTS)
@example("__import__('os').system('true')", "x")
@example("x", "x\n+@")
@example("where(x,1,0)/0", "exp(exp(exp(x)))")
def test_what_anybody_types_is_a_flow_or_an_error_that_points(first: str, second: str) -> None:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # of flows at rest
            field = flowtex.formula(first, second, resolution=5, b=0.5)
    except FieldError as error:
        said = ("no value in any cell", "velocity", "characters")
        assert str(error).endswith("^") or any(words in str(error) for words in said), error
    else:
        assert field.formula is not None and np.isfinite(field.velocity).all()
        allowed = {*OPERATIONS, "x", "y", "b"}
        stack = [each.tree for each in field.formula.expressions]
        while stack:
            node = stack.pop()
            assert isinstance(node, (float, str, tuple))
            if isinstance(node, str):
                assert node in allowed
            elif isinstance(node, tuple):
                assert node[0] in OPERATIONS
                stack += node[1:]


def test_sympy_and_functions_make_the_same_field() -> None:
    sympy = pytest.importorskip("sympy")
    x, y, b = sympy.symbols("x y b")
    ends: dict[str, Any] = {"x": (-7, 7), "y": (-4, 4), "b": 0.2, "resolution": 33}
    text = flowtex.formula("y", "-sin(x) - b*abs(y)", **ends)
    symbols = flowtex.formula(y, -sympy.sin(x) - b * sympy.Abs(y), **ends)
    functions = flowtex.formula(lambda y: y, lambda b, x, y: -np.sin(x) - b * np.abs(y), **ends)
    for other in (symbols, functions):
        assert_allclose(other.velocity, text.velocity, atol=1e-15)
    pieces = sympy.Piecewise((x, x < 0), (y, sympy.Ge(y, 1)), (2, True))
    assert_allclose(
        flowtex.formula(pieces, 1, resolution=9).velocity,
        flowtex.formula("where(x < 0, x, where(y >= 1, y, 2))", 1, resolution=9).velocity,
    )
    with pytest.raises(FieldError, match="the function 'gamma' does not exist"):
        flowtex.formula(y, sympy.gamma(x))
    with pytest.raises(FieldError, match="I is unknown"):
        flowtex.formula(y, x * sympy.I)


@pytest.mark.parametrize(
    "surface", ["sphere", ("cos(v)*cos(u)", "cos(v)*sin(u)", "sin(v)"), "torus", "cylinder"]
)
def test_rates_on_a_surface_turn_it_as_vectors_in_space_do(surface: Any) -> None:
    ends: dict[str, Any] = {} if isinstance(surface, str) else {"u": (-3, 3), "v": (-1, 1)}
    rates = flowtex.formula("1", "0", surface=surface, resolution=17, **ends)
    space = flowtex.formula("-y", "x", "0", surface=surface, resolution=17, **ends)
    assert_allclose(rates.velocity, space.velocity, atol=1e-8)
    assert rates.normal_share < 0.02
    assert rates.periodic[1] == isinstance(surface, str)


def test_where_there_is_no_value_it_is_blank() -> None:
    field = flowtex.formula("sqrt(x)", "1/y", resolution=11)
    x, y = field.points[..., 0], field.points[..., 1]
    assert (field.valid == (x >= 0) & (y != 0)).all()


@pytest.mark.parametrize("name", KNOWN)
def test_known_formulas_have_names(name: str) -> None:
    field = flowtex.formula(name, resolution=17)
    assert field.formula is not None and field.name == KNOWN[name][0]
    assert field.valid.mean() > 0.9
    assert all(p.low <= p.value <= p.high for p in field.formula.parameters.values())


@pytest.mark.parametrize(
    "line",
    [
        "y; -sin(x) - b*y; x=-7,7; b=0.2",
        "van der pol",
        "pendulum; b=0.5,0,2",
        "cos(t); x; t=0,1,3",
        "1; 0; surface=torus",
        "where(x >= 0, 1, 2); y",
    ],
)
def test_a_line_is_a_flow(line: str) -> None:
    assert is_line(line) and not is_line("wing.vtu")
    given = line.partition("; b=0.5")[0]
    field = line_field(line)
    assert field.formula is not None
    changed = with_parameter(given, field, "b", 9.0)
    if "b" in field.formula.parameters:
        most = field.formula.parameters["b"].high
        other = line_field(changed).formula
        assert other is not None and other.parameters["b"].value == most
    else:
        assert changed == given


@pytest.mark.parametrize(
    ("change", "drawn"),
    [
        ({}, True),
        ({"velocity": lambda field: -np.asarray(field.velocity)}, False),
        ({"points": lambda field: 2 * field.points}, False),
    ],
)
def test_a_field_that_was_changed_is_not_drawn_from_its_formula(
    change: dict[str, Any], drawn: bool
) -> None:
    field = flowtex.formula("cos(t)*y", "-x + t", times=[0.0, 1.0, 2.0], resolution=33)
    field = replace(field, **{name: make(field) for name, make in change.items()})
    for shown in (field, field.at_step(2)):
        assert (client_formula(Scene.of(shown).textures) is not None) == drawn


LONG = {
    "equal factors": "*".join(["x"] * 1000),
    "factors": "*".join(f"(1 + x/{n})" for n in range(2, 150)),
    "terms": "+".join(f"x^{n}/{n}" for n in range(2, 200)),
    "quotients": "/".join(["x", *["(x + 2)"] * 50]),
    "maximum": f"max({','.join(f'x*{n}' for n in range(300))})",
    "minimum": f"min({','.join(['x', '2*x'] * 300)})",
    "nested": "sin(" * 50 + "x" + ")" * 50,
}


@pytest.mark.parametrize("name", LONG)
def test_derivatives_of_long_formulas_are_short_and_right(name: str) -> None:
    tree = parse(LONG[name], "x")
    rate = derivative(tree, "x")
    assert size(rate) < MOST_SIZE
    x = 0.99
    step = 1e-6
    ends = [evaluate(tree, {"x": x + sign * step}) for sign in (1, -1)]
    assert_allclose(evaluate(rate, {"x": x}), (ends[0] - ends[1]) / (2 * step), rtol=1e-5)


def test_equal_factors_are_a_power() -> None:
    assert size(derivative(parse("*".join(["x"] * 1000), "x"), "x")) < 10
    rate = derivative(parse("x*x*y*x", "xy"), "x")
    assert evaluate(rate, {"x": -2.0, "y": 5.0}) == 3 * 4 * 5


@pytest.mark.parametrize(
    ("rate", "surface", "words"),
    [
        ("*".join(["x"] * 500), ("+".join(["u", "v"] * 300), "v", "u"), "a rate of the formula"),
        (f"{'hypot(x, ' * 55}{'+'.join(['x*y'] * 250)}{')' * 55}", None, "a derivative of the"),
    ],
)
def test_a_formula_that_grows_too_large_names_the_limit(
    rate: str, surface: Any, words: str
) -> None:
    with pytest.raises(FieldError, match=rf"{words}.* at most {MOST_SIZE:,}"):
        flowtex.formula(rate, "1", surface=surface, resolution=9)
