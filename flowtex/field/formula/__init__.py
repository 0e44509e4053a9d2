"""Flows from formulas: their expressions, and the fields that they make."""

from __future__ import annotations

from flowtex.field.formula.flow import KNOWN, Formula, Parameter
from flowtex.field.formula.grammar import FormulaError

__all__ = ["KNOWN", "Formula", "FormulaError", "Parameter"]
