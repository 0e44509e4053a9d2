"""Formulas that have a name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

#: Words, expressions, ranges, and parameters with the ends of their sliders.
KNOWN: Mapping[str, tuple[str, tuple[str, str], Mapping[str, Any]]] = {
    "pendulum": (
        "Pendulum",
        ("y", "-sin(x) - b*y"),
        {"x": (-7, 7), "y": (-4, 4), "b": (0.2, 0, 1)},
    ),
    "van_der_pol": (
        "Van der Pol",
        ("y", "mu*(1 - x^2)*y - x"),
        {"x": (-5, 5), "y": (-4, 4), "mu": (1, 0, 4)},
    ),
    "lotka_volterra": (
        "Lotka–Volterra",
        ("x*(a - b*y)", "-y*(c - d*x)"),
        {"x": (0, 4), "y": (0, 3), "a": (1, 0, 2), "b": (1, 0, 2), "c": (1, 0, 2), "d": (1, 0, 2)},
    ),
    "duffing": (
        "Duffing",
        ("y", "x - x^3 - d*y"),
        {"x": (-2, 2), "y": (-1.5, 1.5), "d": (0.2, 0, 1)},
    ),
    "dipole": (
        "Dipole",
        (
            "(x + a)/hypot(x + a, y)^3 - (x - a)/hypot(x - a, y)^3",
            "y/hypot(x + a, y)^3 - y/hypot(x - a, y)^3",
        ),
        {"x": (-3, 3), "y": (-2, 2), "a": (1, 0.1, 2)},
    ),
    "saddle_node": (
        "Saddle-node bifurcation",
        ("r + x^2", "-y"),
        {"x": (-3, 3), "y": (-2, 2), "r": (-1, -2, 2)},
    ),
}
