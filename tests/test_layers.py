"""The structure of the package: imports run down one list, and no room grows beyond its measure.

The tables below are the rule. A new module at the top of ``flowtex`` gets its place in
``LAYERS``; a library that not every user has, or that takes long to load, gets its line in
``LIBRARIES``.
"""

from __future__ import annotations

import ast
import json
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Literal

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "flowtex"

# From the bottom to the top: a module imports from lines above its own here, and never from
# another on the same line. The empty name is the package itself.
LAYERS: tuple[tuple[str, ...], ...] = (
    ("errors",),
    ("_util",),
    ("settings",),
    ("field",),
    ("sources",),
    ("trace",),
    ("textures",),
    ("rendering",),
    ("pyramid",),
    ("examples",),
    ("scene",),
    ("web",),
    ("widget", "plotting"),
    ("app",),
    ("",),
    ("xarray",),
    ("cli",),
    ("__main__",),
)
#: The class methods of FlowField read with what is above it, when they are called.
CONSTRUCTORS = ("field.constructors", "sources")
RENDERERS = ("rendering.cpu", "rendering.vtk", "rendering.webgl")
#: Folders of the checkout that import the package and that it knows nothing of.
OUTSIDE = ("benchmarks", "docs", "paper", "tests", "tools")

#: Most entries at the top of the package, modules in a folder, and lines in a source file.
MAX_ENTRIES, MAX_MODULES, MAX_LINES = 21, 15, 600


@dataclass(frozen=True)
class Library:
    """Where libraries may be imported: when a module loads, and only inside functions."""

    names: tuple[str, ...]
    on_load: tuple[str, ...] = ()
    in_functions: tuple[str, ...] = ()


VTK = Library(
    ("vtk", "vtkmodules", "pyvista"),
    on_load=("rendering.vtk", "plotting", "app"),
    in_functions=(
        "_util.colours",
        "sources",
        "trace.structure",
        "rendering.diagnostics",
        "examples",
    ),
)
LIBRARIES = (
    VTK,
    Library(
        ("matplotlib",),
        on_load=(
            "plotting.offscreen.figure",
            "plotting.offscreen.axes_kinds",
        ),
        in_functions=(
            "_util.colours",
            "scene.annotations",
            "xarray",
        ),
    ),
    Library(
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
    Library(("anywidget", "ipywidgets", "traitlets", "IPython"), on_load=("widget",)),
    Library(
        ("xarray", "netCDF4", "pandas"),
        on_load=("xarray",),
        in_functions=("field", "sources", "examples"),
    ),
    Library(
        ("zarr", "obstore", "dask", "distributed"),
        on_load=("pyramid.objects",),
        in_functions=("pyramid",),
    ),
    Library(("h5py",), in_functions=("sources.inspection.netcdf",)),
    Library(("av",), in_functions=("plotting.offscreen.encoders",)),
    Library(("cyclopts",), on_load=("cli",)),
)
SLOW = tuple(name for library in LIBRARIES for name in library.names)


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
    """Return ``rendering.vtk.actor`` for ``flowtex/rendering/vtk/actor.py``, "" for the package."""
    parts = path.relative_to(package).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


@cache
def imports_of(path: Path, package: Path, root: str) -> tuple[Import, ...]:
    """Read every import of a file, also those inside functions and under TYPE_CHECKING."""
    name = module_name(path, package)
    tree = ast.parse(path.read_text(encoding="utf-8"), str(path))

    def visit(node: ast.AST, when: Literal["load", "function", "typing"]) -> Iterator[Import]:
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield Import(name, alias.name, node.lineno, when)
        elif isinstance(node, ast.ImportFrom):
            for target in _targets(node, package, root):
                yield Import(name, target, node.lineno, when)
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            when = "function" if when == "load" else when
        elif isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            for guarded in node.body:
                yield from visit(guarded, "typing")
            for otherwise in node.orelse:
                yield from visit(otherwise, when)
            return
        for child in ast.iter_child_nodes(node):
            if not isinstance(child, ast.expr):  # no import is within an expression
                yield from visit(child, when)

    return tuple(visit(tree, "load"))


def _targets(node: ast.ImportFrom, package: Path, root: str) -> list[str]:
    """Return what a ``from`` import loads: submodules by their own name."""
    base = "." * node.level + (node.module or "")
    inside = base.split(".")
    if inside[0] != root:
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
    """Return whether a module is one of the rooms, or inside one."""
    return any(name == room or name.startswith(f"{room}.") for room in rooms)


def faults_in(package: Path) -> list[str]:
    """Return one sentence for each import that breaks the rules."""
    faults = []
    for path in sorted(package.rglob("*.py")):
        name = module_name(path, package)
        if level_of(name) is None:
            faults.append(f"flowtex.{name} has no place: give {name.split('.')[0]!r} one in LAYERS")
            continue
        for imported in imports_of(path, package, "flowtex"):
            inner = imported.target.split(".")[0] == "flowtex"
            faults.extend(_inner(imported) if inner else _outer(imported))
    return faults


def _inner(imported: Import) -> Iterator[str]:
    target = imported.target.removeprefix("flowtex").removeprefix(".")
    own, other = level_of(imported.importer), level_of(target)
    if imported.importer.split(".")[0] != target.split(".")[0]:
        to_sources = (imported.importer, target.split(".")[0]) == CONSTRUCTORS
        if to_sources and imported.when != "load":
            return
        if own is None or other is None or other >= own:
            yield f"{imported}, which is not below it"
        return
    here = [room for room in RENDERERS if is_in(imported.importer, (room,))]
    there = [room for room in RENDERERS if is_in(target, (room,))]
    if here and there and here != there:
        yield f"{imported}: renderers do not know each other"


def _outer(imported: Import) -> Iterator[str]:
    top = imported.target.split(".")[0]
    if imported.target.startswith("."):
        yield f"{imported}: write the absolute name"
    if top in OUTSIDE:
        yield f"{imported}, which is no part of the package"
    for library in LIBRARIES:
        if top not in library.names or is_in(imported.importer, library.on_load):
            continue
        if not is_in(imported.importer, library.in_functions):
            rooms = ", ".join((*library.on_load, *library.in_functions))
            yield f"{imported}, which belongs in {rooms}"
        elif imported.when == "load":
            yield f"{imported} when it loads: import it inside the function that needs it"


def graph_of(package: Path, root: str = "flowtex") -> dict[str, set[str]]:
    """Return which modules of a package each of its modules imports, anywhere in its text."""
    graph: dict[str, set[str]] = {module_name(p, package): set() for p in package.rglob("*.py")}
    for path in package.rglob("*.py"):
        name = module_name(path, package)
        for imported in imports_of(path, package, root):
            if imported.target.split(".")[0] == root:
                graph[name].add(imported.target.removeprefix(root).removeprefix("."))
    return graph


def circles_in(graph: Mapping[str, set[str]]) -> list[list[str]]:
    """Return circles of imports: of modules that import each other, one shortest circle each."""
    circles: list[list[str]] = []
    seen: set[str] = set()
    for start in sorted(graph):
        circle = None if start in seen else _way_back(graph, start)
        if circle:
            circles.append(circle)
            seen |= set(circle)
    return circles


def _way_back(graph: Mapping[str, set[str]], start: str) -> list[str] | None:
    """Shortest way along imports from a module back to itself."""
    ways, visited = [[start]], {start}
    while ways:
        longer = []
        for way in ways:
            for target in sorted(graph.get(way[-1], ())):
                if target == start:
                    return [*way, start]
                if target not in visited:
                    visited.add(target)
                    longer.append([*way, target])
        ways = longer
    return None


def sources() -> list[Path]:
    """Return every source file of the package, of the paper, and of the browser's client."""
    folders = {"flowtex": "*.py", "paper": "*.py", "client/src": "*.ts", "client/tests": "*.ts"}
    return sorted(path for name, kind in folders.items() for path in (ROOT / name).rglob(kind))


# --- the package --------------------------------------------------------------------------------


def test_every_import_keeps_to_the_layers() -> None:
    faults = faults_in(PACKAGE)
    assert not faults, "\n".join(faults)


@pytest.mark.parametrize("root", ["flowtex", "paper"])
def test_no_module_imports_itself_in_a_circle(root: str) -> None:
    circles = circles_in(graph_of(ROOT / root, root))
    assert not circles, "\n".join(" -> ".join(circle) for circle in circles)


def test_something_was_read() -> None:
    imports = [i for path in PACKAGE.rglob("*.py") for i in imports_of(path, PACKAGE, "flowtex")]
    assert {"load", "function"} <= {i.when for i in imports}
    assert any(i.target.startswith("flowtex.") for i in imports)
    graph = graph_of(PACKAGE)
    assert "errors" in graph["settings"] | graph["field"] | graph["field.field"]


def test_the_top_of_the_package_can_be_taken_in_at_a_glance() -> None:
    # A folder that was moved away leaves its bytecode behind.
    files = [path for path in PACKAGE.rglob("*") if path.is_file() and path.suffix != ".pyc"]
    entries = sorted({path.relative_to(PACKAGE).parts[0] for path in files})
    assert len(entries) <= MAX_ENTRIES, entries


def test_no_folder_has_too_many_modules() -> None:
    counts: dict[str, int] = {}
    for path in sources():
        if path.suffix == ".py":
            folder = path.parent.relative_to(ROOT).as_posix()
            counts[folder] = counts.get(folder, 0) + 1
    assert not {folder: count for folder, count in counts.items() if count > MAX_MODULES}


def test_no_source_file_is_too_long() -> None:
    lengths = {
        path.relative_to(ROOT).as_posix(): len(path.read_text(encoding="utf-8").splitlines())
        for path in sources()
    }
    assert not {name: count for name, count in lengths.items() if count > MAX_LINES}


# --- the rules themselves -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("module", "text", "fault"),
    [
        ("field/a.py", "import flowtex.trace", "flowtex.field.a:1 imports flowtex.trace, which"),
        (
            "field/a.py",
            "def f():\n    from flowtex import scene",
            "imports flowtex.scene, which",
        ),
        ("field/a.py", "from flowtex import FlowField", "flowtex.field.a:1 imports flowtex, which"),
        ("web/a.py", "import flowtex.widget", "which is not below it"),
        ("trace/a.py", "import flowtex.trace.b\nimport flowtex.scene", "which is not below it"),
        ("rendering/vtk/a.py", "import flowtex.rendering.cpu.b", "do not know each other"),
        ("sources/a.py", "import pyvista", "imports pyvista when it loads: import it inside"),
        ("sources/a.py", "class A:\n    import pyvista", "imports pyvista when it loads"),
        ("field/a.py", "def f():\n    import pyvista", "which belongs in rendering.vtk"),
        ("field/a.py", "try:\n    import xarray\nexcept ImportError:\n    pass", "when it loads"),
        ("trace/a.py", "def f():\n    import vtkmodules.vtkCommonCore", "belongs in rendering.vtk"),
        ("web/a.py", "def f():\n    import pyvista", "which belongs in rendering.vtk"),
        ("rendering/cpu/a.py", "import pyvista", "which belongs in rendering.vtk"),
        ("cli.py", "def f():\n    from trame.app import get_server", "which belongs in app"),
        ("field/a.py", "from . import surface", "write the absolute name"),
        ("settings.py", "def f():\n    from paper import measures", "no part of the package"),
        ("stray.py", "", "flowtex.stray has no place: give 'stray' one in LAYERS"),
    ],
)
def test_a_broken_rule_is_found(module: str, text: str, fault: str, tmp_path: Path) -> None:
    (tmp_path / "trace").mkdir()
    for name in ("scene.py", "widget.py"):
        (tmp_path / name).touch()
    (tmp_path / module).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / module).write_text(text, encoding="utf-8")
    (sentence,) = faults_in(tmp_path)
    assert fault in sentence


@pytest.mark.parametrize(
    ("module", "text"),
    [
        ("sources/a.py", "def f():\n    import pyvista"),
        (
            "sources/a.py",
            "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import pyvista",
        ),
        ("rendering/vtk/a.py", "import pyvista\nfrom flowtex.rendering import shader_text"),
        ("cli.py", "import cyclopts\ndef f():\n    import flowtex.app"),
        ("__init__.py", "from flowtex.field import FlowField\nimport numpy"),
    ],
)
def test_a_kept_rule_is_not_reported(module: str, text: str, tmp_path: Path) -> None:
    (tmp_path / module).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / module).write_text(text, encoding="utf-8")
    assert faults_in(tmp_path) == []


@pytest.mark.parametrize(
    ("files", "circle"),
    [
        ({"a.py": "import flowtex.b", "b.py": "import flowtex.a"}, ["a", "b", "a"]),
        (
            {"a.py": "def f():\n    from flowtex import b", "b.py": "from flowtex.a import x"},
            ["a", "b", "a"],
        ),
        (
            {
                "a.py": "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n"
                "    from flowtex.c import C",
                "b.py": "import flowtex.a",
                "c.py": "import flowtex.b",
            },
            ["a", "c", "b", "a"],
        ),
        (
            {"d/__init__.py": "from flowtex.d.e import x", "d/e.py": "from flowtex.d import y"},
            ["d", "d.e", "d"],
        ),
        ({"a.py": "import flowtex.b", "b.py": "import flowtex.c", "c.py": "import a"}, None),
    ],
)
def test_a_circle_is_found(files: dict[str, str], circle: list[str] | None, tmp_path: Path) -> None:
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    assert circles_in(graph_of(tmp_path)) == ([] if circle is None else [circle])


# --- what a fresh process loads -----------------------------------------------------------------


@pytest.fixture(scope="module")
def loaded() -> dict[str, set[str]]:
    """Return the packages, and theirs, that a fresh process has loaded after each of some imports.

    One process makes them all, so each has what came before it as well; the widget, which alone may
    load a library of ``SLOW``, comes last.
    """
    names = [module_name(path, PACKAGE) for path in PACKAGE.rglob("*.py")]
    rooms = (*VTK.on_load, "widget", "cli", "__main__", "xarray", "pyramid.objects")
    below = sorted(f"flowtex.{name}" for name in names if name and not is_in(name, rooms))
    assert "flowtex.rendering.diagnostics" in below and "flowtex.web.export" in below
    stages = {"flowtex": ["flowtex"], "below VTK": below, "flowtex.widget": ["flowtex.widget"]}
    code = (
        f"import json, sys\nfound = {{}}\nfor stage, modules in {stages!r}.items():\n"
        "    for name in modules:\n        __import__(name)\n"
        "    parts = [name.split('.') for name in sys.modules]\n"
        "    found[stage] = sorted({'.'.join(some[:n]) for some in parts for n in (1, 2)})\n"
        "print(json.dumps(found))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return {stage: set(names) for stage, names in json.loads(done.stdout).items()}


def test_importing_flowtex_loads_nothing_slow(loaded: dict[str, set[str]]) -> None:
    assert "flowtex" in loaded["flowtex"]
    assert not loaded["flowtex"] & {*SLOW, "rich", "PIL"}


def test_what_lies_below_vtk_never_loads_it_nor_does_the_export(
    loaded: dict[str, set[str]],
) -> None:
    assert not loaded["below VTK"] & set(SLOW)
    # SciPy loads its modules when they are used.
    scipy = {"scipy.ndimage", "scipy.sparse", "scipy.spatial", "scipy.special"}
    assert not loaded["below VTK"] & scipy


def test_the_widget_needs_no_vtk(loaded: dict[str, set[str]]) -> None:
    assert "anywidget" in loaded["flowtex.widget"]
    assert not loaded["flowtex.widget"] & set(VTK.names)
