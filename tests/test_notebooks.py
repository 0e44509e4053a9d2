"""The notebooks run from top to bottom, and are stored without what they show."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from waiting import PATIENCE_S

FOLDER = Path(__file__).parents[1] / "notebooks"
CELL_S = 10 * PATIENCE_S  #: Seconds that a cell may take.
#: Words of a notebook of the Earth that are others here, so that it is soon done.
CHANGES: dict[str, dict[str, str]] = {
    "ocean": {},
    "pyramid": {"760": "190", "500": "125"},
    "weather": {},
}
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"), key=lambda path: (path.stem in CHANGES, path.stem))
#: Run by the kernel as it starts: small pictures of widgets that no browser draws, coarse grids of
#: formulas, few samples, and every fifth point and time of the examples.
LESS = """import inspect
import flowtex
import flowtex.host.export
import flowtex.host.flow_widget
for module in (flowtex.host.export, flowtex.host.flow_widget):
    module.PREVIEW = (48, 30)
flowtex.formula.__kwdefaults__["resolution"] = 97
for draws in (flowtex.render, flowtex.movie):
    inspect.unwrap(draws).__kwdefaults__["size"] = (160, 120)
made = flowtex.Settings.__init__
made.__defaults__ = (5, *made.__defaults__[1:])
for name in ("ocean", "weather"):
    data = getattr(flowtex.examples, name)()
    few = {dim: slice(None, None, 5) for dim in data.dims if dim != "level"}
    setattr(flowtex.examples, name, lambda data=data.isel(few): data)
"""
SMALL_ROOTS = "from flowtex.textures.tiles import grid_levels\ngrid_levels.ROOT_NODES = 20_000"


def read(path: Path) -> Any:
    nbformat = pytest.importorskip("nbformat")
    return nbformat.read(path, as_version=4)


def test_notebooks_are_stored_without_output() -> None:
    assert len(NOTEBOOKS) >= 5
    for path in NOTEBOOKS:
        notebook = json.loads(path.read_text())
        first, *rest = notebook["cells"]
        cells = [cell for cell in rest if cell["cell_type"] == "code"]
        assert cells
        assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in cells)
        assert "widgets" not in notebook["metadata"]
        assert first["cell_type"] == "markdown"
        assert "".join(first["source"]).startswith("# ")


@pytest.fixture(scope="module")
def kernel(opengl: Any) -> Iterator[Any]:
    """One kernel for all notebooks, in their folder; each of them begins without names."""
    for module in ("nbclient", "anywidget", "cf_xarray"):
        pytest.importorskip(module)
    from jupyter_client.manager import KernelManager

    manager = KernelManager(kernel_name="python3")
    environment = {**os.environ, "MPLBACKEND": "module://matplotlib_inline.backend_inline"}
    first = [f"--IPKernelApp.code_to_run={LESS}"]
    manager.start_kernel(cwd=str(FOLDER), env=environment, extra_arguments=first)
    try:
        yield manager
    finally:
        manager.shutdown_kernel(now=True)


def smaller(code: str) -> str:
    """Return code whose pictures, not arrays, have a quarter of the width and of the height.

    Movies have eight tenths of a second.
    """
    code = re.sub(r"dpi=\d+", "dpi=40", code).replace("resolution=4096", "resolution=512")
    code = re.sub(r"\bseconds=\d+(?![.\d])", "seconds=0.8", code)
    return re.sub(
        r"""((?<= )size=|"size": )([(\[])(\d{3,}), (\d{3,})""",
        lambda m: f"{m[1]}{m[2]}{int(m[3]) // 4}, {int(m[4]) // 4}",
        code,
    )


@pytest.mark.slow
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path: Path, kernel: Any) -> None:
    """From top to bottom; it shows a widget, and no warning."""
    import nbclient

    nbformat: Any = pytest.importorskip("nbformat.v4")

    notebook = read(path)
    for cell in notebook.cells:
        cell.source = smaller(cell.source)
        for old, new in CHANGES.get(path.stem, {}).items():
            cell.source = re.sub(rf"\b{old}\b", new, cell.source)
    first = SMALL_ROOTS if path.stem in CHANGES else ""
    notebook.cells.insert(0, nbformat.new_code_cell(f"%reset -f\n{first}"))
    client = nbclient.NotebookClient(notebook, timeout=CELL_S, km=kernel)
    try:
        client.execute()
    finally:
        if client.kc is not None:
            client.kc.stop_channels()
    outputs = [out for cell in notebook.cells for out in cell.get("outputs", ())]
    displays = [out.data for out in outputs if "data" in out]
    widgets = [data for data in displays if "application/vnd.jupyter.widget-view+json" in data]
    assert widgets, "no widget was shown"
    messages = [out.text for out in outputs if out.output_type == "stream" and out.name == "stderr"]
    assert not [text for text in messages if "Warning" in text or "Error" in text]
