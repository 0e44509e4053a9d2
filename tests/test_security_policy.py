"""Each guarantee of the security policy names tests that exist."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
POLICY = (ROOT / ".github" / "SECURITY.md").read_text(encoding="utf-8")
ROWS = [
    [cell.strip() for cell in line.strip("|").split(" | ")]
    for line in POLICY.splitlines()
    if line.startswith("| ") and not line.startswith(("| guarantee", "| ---"))
]


FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)


@cache
def functions_of(path: Path) -> set[str]:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return {node.name for node in tree.body if isinstance(node, FUNCTIONS)}


def test_the_policy_has_guarantees() -> None:
    assert len(ROWS) > 15 and all(len(row) == 2 for row in ROWS)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row[0][:40])
def test_a_guarantee_names_tests_that_exist(row: list[str]) -> None:
    named = re.findall(r"`([^`]+)`", row[1])
    assert named
    for name in named:
        path, _, test = name.partition("::")
        assert test in functions_of(ROOT / "tests" / path), name
