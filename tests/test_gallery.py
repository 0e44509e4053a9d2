"""The examples of the site's gallery are scripts that people can copy; the site runs them."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "examples"
EXAMPLES = sorted(FOLDER.glob("*/plot_*.py"))
#: What a script may import: nothing that has to be installed for it alone.
ALLOWED = {"flowtex", "numpy", "pyvista", "xarray"}
#: Lines of a script without its text, at most; a title has one line.
LINES, TITLE = 40, 40


def imported(tree: ast.Module) -> set[str]:
    """Packages that a script imports."""
    names = [a.name for node in ast.walk(tree) if isinstance(node, ast.Import) for a in node.names]
    names += [n.module or "" for n in ast.walk(tree) if isinstance(n, ast.ImportFrom)]
    return {name.split(".")[0] for name in names}


def shown(tree: ast.Module) -> list[ast.Call]:
    """Calls of ``flowtex.show``."""
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    return [call for call in calls if ast.unparse(call.func) == "flowtex.show"]


def test_there_is_a_gallery() -> None:
    assert len(EXAMPLES) >= 25
    assert len({path.stem for path in EXAMPLES}) == len(EXAMPLES)  # scenes are named by them


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_is_a_short_script_with_a_title_and_a_text(path: Path) -> None:
    source = path.read_text(encoding="utf-8")
    tree = ast.parse(source, path.name)
    compile(tree, path.name, "exec")
    title, line, *text = (ast.get_docstring(tree) or "").splitlines()
    assert 3 < len(title) <= TITLE
    assert line == "=" * len(title)
    assert len(" ".join(text)) > 80
    assert imported(tree) <= ALLOWED
    assert shown(tree)
    # What only the site knows is not an argument of a script that people run.
    assert not [key for call in shown(tree) for key in call.keywords if key.arg == "steps"]
    assert len(source.splitlines()) - len(text) < LINES


def test_every_folder_of_examples_has_a_heading_and_an_order() -> None:
    folders = {path.parent.name for path in EXAMPLES}
    assert all((FOLDER / name / "GALLERY_HEADER.rst").exists() for name in folders)
    text = (FOLDER.parent / "live.py").read_text(encoding="utf-8")
    (order,) = (line for line in text.splitlines() if line.startswith("SECTIONS = "))
    assert set(ast.literal_eval(order.removeprefix("SECTIONS = "))) == folders
