"""Imports run down one list, and what is slow or optional is loaded where it is used.

The tables below are the rule. A new module of ``flowtex`` gets its place in ``LAYERS``; a
library that not every user has, or that takes long to load, gets its line in ``ROOMS``.
"""

from __future__ import annotations

import ast
import json
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import pytest

PACKAGE = Path(__file__).resolve().parents[1] / "flowtex"
ROOT_NAME = "flowtex"

# From the bottom to the top: a module imports from lines above its own here, and never from
# one on the same line. The empty name is the package itself.
LAYERS: tuple[tuple[str, ...], ...] = (
    ("errors", "extras", "progress", "whole_file", "_assets", "_version"),
    ("settings",),
    ("field",),
    ("trace",),
    ("textures", "first_look", "moments"),
    ("movie_formats",),
    ("movie_files",),
    ("glsl",),
    ("doctor",),
    ("renderers",),
    ("view", "references"),
    ("probe",),
    ("examples",),
    ("camera", "image_files"),
    ("handle",),
    ("plotter",),
    ("sharing",),
    ("staging",),
    ("preview",),
    ("export",),
    ("studio",),
    ("widget", "app"),
    ("pictures", "movies", "jupyter"),
    ("",),
    ("paper",),
    ("cli",),
)
RENDERERS = ("renderers.cpu", "renderers.vtk", "renderers.webgl")
FRONT_ENDS = (
    "camera",
    "handle",
    "plotter",
    "staging",
    "preview",
    "studio",
    "pictures",
    "movies",
    "jupyter",
    "widget",
    "app",
    "export",
    "paper",
    "cli",
)


@dataclass(frozen=True)
class Room:
    """Where libraries may be imported: when a module loads, and only inside functions."""

    libraries: tuple[str, ...]
    on_load: tuple[str, ...] = ()
    in_functions: tuple[str, ...] = ()


ROOMS = (
    Room(
        ("vtk", "vtkmodules", "pyvista"),
        on_load=("renderers.vtk", "plotter", "pictures"),
        in_functions=("field", "doctor", "examples", *FRONT_ENDS),
    ),
    Room(("matplotlib",), in_functions=("renderers", "view", "examples", *FRONT_ENDS)),
    Room(
        (
            "trame",
            "trame_client",
            "trame_pyvista",
            "trame_rca",
            "trame_server",
            "trame_vtk",
            "trame_vuetify",
            "wslink",
        ),
        on_load=("app",),
    ),
    Room(("anywidget", "ipywidgets", "traitlets", "IPython"), on_load=("widget",)),
    Room(("xarray", "netCDF4", "pandas"), in_functions=("field", "examples")),
    Room(("av",), in_functions=("movie_formats",)),
    Room(("cyclopts",), on_load=("cli",)),
)
SLOW = tuple(library for room in ROOMS for library in room.libraries)


@dataclass(frozen=True)
class Import:
    """One import: who, what, the line, and when it happens."""

    importer: str
    target: str
    line: int
    when: Literal["load", "function", "typing"]

    def __str__(self) -> str:
        return f"flowtex.{self.importer}:{self.line} imports {self.target}".replace(".:", ":")


def module_name(path: Path, package: Path) -> str:
    """Return ``renderers.vtk.actor`` for ``flowtex/renderers/vtk/actor.py``, "" for the package."""
    parts = path.relative_to(package).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imports_of(path: Path, package: Path) -> Iterator[Import]:
    """Read every import of a file, also those inside functions."""
    name = module_name(path, package)
    tree = ast.parse(path.read_text(encoding="utf-8"), str(path))

    def visit(node: ast.AST, when: Literal["load", "function", "typing"]) -> Iterator[Import]:
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield Import(name, alias.name, node.lineno, when)
        elif isinstance(node, ast.ImportFrom):
            for target in _targets(node, package):
                yield Import(name, target, node.lineno, when)
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            when = "function" if when == "load" else when
        elif isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            for guarded in node.body:
                yield from visit(guarded, "typing")
            for otherwise in node.orelse:
                yield from visit(otherwise, when)
            return
        for child in ast.iter_child_nodes(node):
            yield from visit(child, when)

    yield from visit(tree, "load")


def _targets(node: ast.ImportFrom, package: Path) -> list[str]:
    """Return what a ``from`` import loads: submodules by their own name."""
    base = "." * node.level + (node.module or "")
    inside = base.split(".")
    if inside[0] != ROOT_NAME:
        return [base]
    folder = package.joinpath(*inside[1:])
    return sorted(
        {
            f"{base}.{alias.name}"
            if (folder / alias.name).is_dir() or (folder / f"{alias.name}.py").is_file()
            else base
            for alias in node.names
        }
    )


def level_of(name: str) -> int | None:
    """Return a module's line in ``LAYERS``, or None when it has none."""
    top = name.split(".")[0]
    return next((n for n, names in enumerate(LAYERS) if top in names), None)


def is_in(name: str, rooms: tuple[str, ...]) -> bool:
    """Tell whether a module is one of the rooms, or inside one."""
    return any(name == room or name.startswith(f"{room}.") for room in rooms)


def faults_in(package: Path) -> list[str]:
    """Return one sentence for each import that breaks the rules."""
    faults = []
    for path in sorted(package.rglob("*.py")):
        name = module_name(path, package)
        if level_of(name) is None:
            faults.append(f"flowtex.{name} has no place: give {name.split('.')[0]!r} one in LAYERS")
            continue
        for found in imports_of(path, package):
            faults.extend(
                _inner(found) if found.target.split(".")[0] == ROOT_NAME else _outer(found)
            )
    return faults


def _inner(found: Import) -> Iterator[str]:
    target = found.target.removeprefix(ROOT_NAME).removeprefix(".")
    own, other = level_of(found.importer), level_of(target)
    if found.importer.split(".")[0] != target.split(".")[0]:
        if own is None or other is None or other >= own:
            yield f"{found}, which is not below it"
        return
    here = [room for room in RENDERERS if is_in(found.importer, (room,))]
    there = [room for room in RENDERERS if is_in(target, (room,))]
    if here and there and here != there:
        yield f"{found}: renderers do not know each other"


def _outer(found: Import) -> Iterator[str]:
    if found.target.startswith("."):
        yield f"{found}: write the absolute name"
    for room in ROOMS:
        if found.target.split(".")[0] not in room.libraries or is_in(found.importer, room.on_load):
            continue
        if not is_in(found.importer, room.in_functions):
            yield f"{found}, which belongs in {', '.join((*room.on_load, *room.in_functions))}"
        elif found.when == "load":
            yield f"{found} when it loads: import it inside the function that needs it"


def test_every_import_keeps_to_the_layers() -> None:
    faults = faults_in(PACKAGE)
    assert not faults, "\n".join(faults)


def test_something_was_read() -> None:
    found = [i for path in PACKAGE.rglob("*.py") for i in imports_of(path, PACKAGE)]
    assert {"load", "function"} <= {i.when for i in found}
    assert any(i.target.startswith("flowtex.") for i in found)


@pytest.mark.parametrize(
    ("module", "text", "fault"),
    [
        ("field/a.py", "import flowtex.trace", "flowtex.field.a:1 imports flowtex.trace, which"),
        ("field/a.py", "def f():\n    from flowtex import view", "imports flowtex.view, which"),
        ("field/a.py", "from flowtex import FlowField", "flowtex.field.a:1 imports flowtex, which"),
        ("app/a.py", "import flowtex.widget", "which is not below it"),
        (
            "renderers/vtk/a.py",
            "import flowtex.rendering.cpu.b",
            "renderers do not know each other",
        ),
        ("field/a.py", "import pyvista", "imports pyvista when it loads: import it inside"),
        ("field/a.py", "class A:\n    import pyvista", "imports pyvista when it loads"),
        ("field/a.py", "try:\n    import xarray\nexcept ImportError:\n    pass", "when it loads"),
        (
            "trace/a.py",
            "def f():\n    import vtkmodules.vtkCommonCore",
            "which belongs in renderers.vtk",
        ),
        ("renderers/cpu/a.py", "import pyvista", "which belongs in renderers.vtk"),
        ("cli.py", "def f():\n    from trame.app import get_server", "which belongs in app"),
        ("field/a.py", "from . import surface", "write the absolute name"),
        ("stray.py", "", "flowtex.stray has no place: give 'stray' one in LAYERS"),
    ],
)
def test_a_broken_rule_is_found(module: str, text: str, fault: str, tmp_path: Path) -> None:
    for made in ("trace", "view.py", "widget.py"):
        (tmp_path / made).touch() if made.endswith(".py") else (tmp_path / made).mkdir()
    (tmp_path / module).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / module).write_text(text, encoding="utf-8")
    (said,) = faults_in(tmp_path)
    assert fault in said


@pytest.mark.parametrize(
    ("module", "text"),
    [
        ("field/a.py", "def f():\n    import pyvista"),
        ("field/a.py", "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import pyvista"),
        ("renderers/vtk/a.py", "import pyvista\nfrom flowtex import glsl"),
        ("cli.py", "import cyclopts\ndef f():\n    import flowtex.app"),
        ("__init__.py", "from flowtex.field import FlowField\nimport numpy"),
    ],
)
def test_a_kept_rule_is_not_reported(module: str, text: str, tmp_path: Path) -> None:
    (tmp_path / "glsl.py").touch()
    (tmp_path / module).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / module).write_text(text, encoding="utf-8")
    assert faults_in(tmp_path) == []


def loaded_by(*modules: str) -> set[str]:
    """Return the top names of what a fresh process has loaded after these imports."""
    code = (
        f"import json, sys\nfor name in {modules!r}:\n    __import__(name)\n"
        "print(json.dumps(sorted({name.split('.')[0] for name in sys.modules})))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return set(json.loads(done.stdout))


def test_importing_flowtex_loads_nothing_slow() -> None:
    loaded = loaded_by(ROOT_NAME)
    assert ROOT_NAME in loaded
    assert not loaded & {*SLOW, "rich", "PIL"}


def test_what_lies_below_vtk_never_loads_it() -> None:
    names = [module_name(path, PACKAGE) for path in PACKAGE.rglob("*.py")]
    rooms = ("renderers.vtk", *FRONT_ENDS)
    below = [f"{ROOT_NAME}.{name}" for name in names if name and not is_in(name, rooms)]
    assert "flowtex.diagnostics" in below
    assert not loaded_by(*sorted(below)) & set(SLOW)
