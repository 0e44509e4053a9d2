"""Imports inside the application run one way, and in no circle."""

from __future__ import annotations

import ast
from graphlib import TopologicalSorter
from pathlib import Path

APP = Path(__file__).resolve().parents[2] / "flowtex" / "app"
#: From the bottom to the top: a room imports from itself and from those before it.
ROOMS = ("server", "streaming", "controllers", "flow_app", "__init__")


def app_imports() -> dict[str, set[str]]:
    """Modules of the application that each module imports, also in functions and for types."""
    modules = {".".join(p.relative_to(APP).with_suffix("").parts): p for p in APP.rglob("*.py")}
    graph: dict[str, set[str]] = {}
    for name, path in modules.items():
        imports = [
            n for n in ast.walk(ast.parse(path.read_text())) if isinstance(n, ast.ImportFrom)
        ]
        targets = {str(n.module).removeprefix("flowtex.app.") for n in imports}
        targets |= {f"{target}.__init__" for target in targets}
        graph[name] = targets & set(modules)
    return graph


def test_imports_run_from_room_to_room_one_way() -> None:
    for name, targets in app_imports().items():
        for target in targets:
            rooms = [ROOMS.index(module.split(".")[0]) for module in (target, name)]
            assert rooms == sorted(rooms), f"flowtex.app.{name} imports {target}"


def test_no_module_imports_itself_by_way_of_others() -> None:
    order = list(TopologicalSorter(app_imports()).static_order())
    assert len(order) > 25 and order[-1] == "__init__"
