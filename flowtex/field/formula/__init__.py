"""Flows from formulas: their expressions, and the fields that they make."""

from __future__ import annotations

from flowtex.field.formula.flow import Formula, Parameter
from flowtex.field.formula.grammar import FormulaError
from flowtex.field.formula.known import KNOWN

__all__ = ["KNOWN", "Formula", "FormulaError", "Parameter"]
