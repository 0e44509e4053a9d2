"""The widget in a real marimo, driven by Chromium."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from waiting import PATIENCE_S, wait_until_served

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = [
    pytest.mark.slow,
    pytest.mark.browser,
    pytest.mark.skipif(find_spec("marimo") is None, reason="marimo is not installed"),
]

NOTEBOOK = """import marimo
app = marimo.App()

@app.cell
def _():
    import flowtex
    flowtex.show(flowtex.examples.double_gyre(), samples=9, size=(300, 150))
    return (flowtex,)

@app.cell
def _(flowtex):
    widget = flowtex.FlowWidget(flowtex.examples.double_gyre(), samples=9, size=(250, 120))
    widget
    return
"""
SHARP = """() => {
  const inside = (root) => [...root.querySelectorAll("*")]
    .flatMap((part) => [part, ...(part.shadowRoot ? inside(part.shadowRoot) : [])]);
  return inside(document).filter((part) => part.matches('.flowtex[data-sharp="true"]')).length;
}"""


@pytest.fixture
def address(tmp_path: Path) -> Iterator[str]:
    """Yield the address of a marimo that runs the notebook."""
    file = tmp_path / "notebook.py"
    file.write_text(NOTEBOOK)
    words = [sys.executable, "-m", "marimo", "run", str(file), "--headless", "--no-token"]
    process = subprocess.Popen(
        words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=tmp_path
    )
    assert process.stdout is not None
    said = next((line for line in process.stdout if "http://" in line), "")
    address = said[said.find("http://") :].strip().replace("localhost", "127.0.0.1")
    wait_until_served(address, process)
    yield address
    process.terminate()
    process.communicate(timeout=PATIENCE_S)


def test_a_widget_and_what_show_displays_are_drawn(page: Page, address: str) -> None:
    page.goto(address)
    page.wait_for_function(f"() => ({SHARP})() === 2")
