"""Flows from formulas: their syntax, values and exact derivatives."""

from __future__ import annotations

from flowtex.field.formula.formula import Formula, Parameter

__all__ = ["Formula", "Parameter"]
