"""The notebooks run from top to bottom, and are stored without what they show."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from waiting import PATIENCE_S

FOLDER = Path(__file__).parents[1] / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
#: Seconds that a cell may take.
CELL_S = 10 * PATIENCE_S
#: Those that run in a file of tests of their own, beside the others.
OF_EARTH = ("ocean", "pyramid", "weather")


def read(path: Path) -> Any:
    nbformat = pytest.importorskip("nbformat")
    return nbformat.read(path, as_version=4)


def name(path: Path) -> str:
    return path.stem


def test_there_are_notebooks() -> None:
    assert len(NOTEBOOKS) >= 5


@pytest.mark.parametrize("path", NOTEBOOKS, ids=name)
def test_a_notebook_is_stored_without_output(path: Path) -> None:
    notebook = read(path)
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert cells
    assert all(cell.outputs == [] and cell.execution_count is None for cell in cells)
    assert "widgets" not in notebook.metadata
    assert notebook.cells[0].cell_type == "markdown"
    assert notebook.cells[0].source.startswith("# ")


def test_the_dye_can_be_seen(opengl: Any) -> None:
    cells = [cell.source for cell in read(FOLDER / "your_data.ipynb").cells]
    arrays, dye = (next(c for c in cells if text in c) for text in ("from_arrays", "image=dye"))
    drawing = dye.replace("flowtex.FlowWidget(", "pixels = flowtex.render(")
    drawing = drawing.replace("size=(0, 320)", "size=(800, 320)")
    found: dict[str, Any] = {}
    pictures = []
    for image in ("dye", "0 * dye"):
        exec(f"{arrays}\n{drawing}".replace("image=dye", f"image={image}"), found)
        pictures.append(found["pixels"].astype(int))
    off = np.abs(pictures[0] - pictures[1]).max(axis=-1)
    assert (off > 60).mean() > 0.08


@contextmanager
def started() -> Iterator[Any]:
    """Start a kernel, in the folder of the notebooks."""
    pytest.importorskip("nbclient")
    pytest.importorskip("anywidget")
    from jupyter_client.manager import KernelManager

    manager = KernelManager(kernel_name="python3")
    environment = {**os.environ, "MPLBACKEND": "module://matplotlib_inline.backend_inline"}
    manager.start_kernel(cwd=str(FOLDER), env=environment)
    try:
        yield manager
    finally:
        manager.shutdown_kernel(now=True)


@pytest.fixture(scope="module")
def kernel(opengl: Any) -> Iterator[Any]:
    """One kernel for all notebooks, each of which begins without names."""
    with started() as manager:
        yield manager


@pytest.mark.slow
@pytest.mark.parametrize("path", [p for p in NOTEBOOKS if p.stem not in OF_EARTH], ids=name)
def test_a_notebook_runs(path: Path, kernel: Any) -> None:
    run(path, kernel)


def smaller(code: str) -> str:
    """Return code whose pictures, not arrays, have a quarter of the width and of the height."""
    return re.sub(
        r"""((?<= )size=|"size": )([(\[])(\d{3,}), (\d{3,})""",
        lambda m: f"{m[1]}{m[2]}{int(m[3]) // 4}, {int(m[4]) // 4}",
        code,
    )


def run(path: Path, kernel: Any, before: str = "", changes: dict[str, str] | None = None) -> None:
    """Run a notebook from top to bottom; it shows a widget, and no warning."""
    import nbclient

    nbformat: Any = pytest.importorskip("nbformat.v4")

    notebook = read(path)
    for cell in notebook.cells:
        cell.source = smaller(cell.source)
        for old, new in (changes or {}).items():
            cell.source = re.sub(rf"\b{old}\b", new, cell.source)
    notebook.cells.insert(0, nbformat.new_code_cell(f"%reset -f\n{before}"))
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
