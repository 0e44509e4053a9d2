"""What the contracts of import-linter cannot express: entries, circles and slow libraries."""

from __future__ import annotations

import json
import subprocess
import sys

import numpy as np
import pytest
from barred import LOAD_VTK, PACKAGE, VTK, is_in, module_name
from scipy import sparse

ROOT = PACKAGE.parent
#: Libraries that are slow to load, or that not every user has.
SLOW = {
    *(*VTK, "matplotlib", "rich", "PIL"),
    *("trame", "trame_client", "trame_rca", "trame_server", "trame_vuetify", "wslink"),
    *("anywidget", "ipywidgets", "traitlets", "IPython"),
    *("xarray", "netCDF4", "pandas", "zarr", "obstore", "dask", "distributed", "h5py"),
    *("av", "cyclopts"),
}
#: Modules that may import some of these when they load; all others do so in functions.
LOAD_SLOW = (
    *LOAD_VTK,
    "host.flow_widget",
    "host.cell",
    "cli",
    "__main__",
    "xarray",
    "pyramid.objects",
    "pyramid.unlisted",
    "_util.zarr_codecs",
    "_util.zarr_internals",
    "_util.zarr_stores",
)
MAX_ENTRIES = 21


def test_package_has_few_entries() -> None:
    # A folder that was moved away leaves its bytecode behind.
    files = [path for path in PACKAGE.rglob("*") if path.is_file() and path.suffix != ".pyc"]
    entries = sorted({path.relative_to(PACKAGE).parts[0] for path in files})
    assert len(entries) <= MAX_ENTRIES, entries


@pytest.mark.parametrize("package", ["flowtex", "paper"])
def test_no_modules_import_each_other_in_a_circle(package: str) -> None:
    graph = pytest.importorskip("grimp").build_graph(package, cache_dir=None)
    modules = sorted(graph.modules)
    imports = [
        [graph.direct_import_exists(importer=a, imported=b) for b in modules] for a in modules
    ]
    _, groups = sparse.csgraph.connected_components(np.array(imports), connection="strong")
    circles = [{m for m, g in zip(modules, groups, strict=True) if g == n} for n in set(groups)]
    assert not [circle for circle in circles if len(circle) > 1]


@pytest.fixture(scope="module")
def loaded() -> dict[str, set[str]]:
    """Return the packages, and theirs, that a fresh process has loaded after each of some imports.

    One process makes them all, so each has what came before it as well; the widget, which alone may
    load a slow library, comes last.
    """
    names = [module_name(path) for path in PACKAGE.rglob("*.py")]
    below = sorted(f"flowtex.{name}" for name in names if name and not is_in(name, LOAD_SLOW))
    assert "flowtex.rendering.diagnostics" in below and "flowtex.host.export" in below
    stages = {"flowtex": ["flowtex"], "below VTK": below, "widget": ["flowtex.host.flow_widget"]}
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
    assert not loaded["flowtex"] & SLOW


def test_slow_libraries_are_imported_in_functions(loaded: dict[str, set[str]]) -> None:
    # SciPy loads its modules when they are used.
    scipy = {"scipy.ndimage", "scipy.sparse", "scipy.spatial", "scipy.special"}
    assert not loaded["below VTK"] & (SLOW - {"rich", "PIL"} | scipy)


def test_widget_needs_no_vtk(loaded: dict[str, set[str]]) -> None:
    assert "anywidget" in loaded["widget"]
    assert not loaded["widget"] & set(VTK)
