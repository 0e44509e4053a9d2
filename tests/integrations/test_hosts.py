"""The widget in Notebook 7, Panel, Shiny, Solara and Streamlit: `make integrations`.

Each is started with its own file kind, shows a flow, and where it carries messages a drag in the
browser is heard in Python.
"""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from lab import wait_for_kernel
from waiting import HOST_PATIENCE_S, wait_until, wait_until_served

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = [pytest.mark.slow, pytest.mark.browser]

MAKE = """import json, os, pathlib, flowtex
HEARD = pathlib.Path(os.environ["HEARD"])
def flow():
    widget = flowtex.FlowWidget(flowtex.examples.double_gyre(), samples=5, size=(300, 160))
    widget.observe(lambda change: HEARD.write_text(json.dumps(change["new"])), "camera")
    return widget
"""
SHINY = """from shiny.express import ui
from shinywidgets import render_widget
@render_widget
def shown():
    return flow()
"""
SOLARA = """import solara
@solara.component
def Page():
    widget = solara.use_memo(flow, [])
    solara.Column(children=[widget])
"""
PANEL = """import html, panel
page = html.escape(flow().to_html())
frame = f'<iframe srcdoc="{page}" style="width: 100%; height: 400px; border: 0"></iframe>'
panel.pane.HTML(frame).servable()
"""
HOLOVIEWS = """import holoviews, panel
holoviews.extension("bokeh")
field = flowtex.examples.vortex_field().downsample(8).at_steps([0, 1])
flow = flowtex.dynamic_map(field, samples=5)
panel.panel(flow.opts(width=300, height=300, active_tools=["wheel_zoom"])).servable()
"""
STREAMLIT = """import streamlit
streamlit.components.v1.html(flow().to_html(), width=300, height=160)
"""
NOTEBOOK = """from IPython.display import display
display(flow())
"""
#: The text of an application, and what starts it.
HOSTS = {
    "notebook": (
        NOTEBOOK,
        (
            *("jupyter", "notebook", "--no-browser", "--allow-root", "--port={port}"),
            *("--ServerApp.port_retries=0", "--IdentityProvider.token="),
            "--JupyterNotebookApp.expose_app_in_browser=True",
        ),
    ),
    "shiny": (SHINY, ("shiny", "run", "app.py", "--port={port}")),
    "solara": (SOLARA, ("solara", "run", "app.py", "--port={port}", "--no-open")),
    "panel": (PANEL, ("panel", "serve", "app.py", "--port={port}")),
    "holoviews": (HOLOVIEWS, ("panel", "serve", "app.py", "--port={port}")),
    "streamlit": (
        STREAMLIT,
        ("streamlit", "run", "app.py", "--server.port={port}", "--server.headless=true"),
    ),
}
#: Where a host has its page, if that is not the root.
PAGES = {"notebook": "notebooks/app.ipynb", "panel": "app", "holoviews": "app"}
WIDGETS = [host for host in HOSTS if host != "holoviews"]  #: Hosts that show the widget.
FRAMED = ("panel", "streamlit")  #: Hosts that show a frame, from which Python hears nothing.


@contextmanager
def served(host: str, folder: Path) -> Iterator[str]:
    """Give the address of an application of a host."""
    text, words = HOSTS[host]
    (folder / "app.py").write_text(MAKE + text)
    cell = {"cell_type": "code", "id": "flow", "metadata": {}, "outputs": []}
    cells = [{**cell, "execution_count": None, "source": MAKE + text}]
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3"}}
    notebook = {"cells": cells, "metadata": kernel, "nbformat": 4, "nbformat_minor": 5}
    (folder / "app.ipynb").write_text(json.dumps(notebook))
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    program = Path(sys.executable).parent / words[0]
    command = [str(program), *(word.format(port=port) for word in words[1:])]
    address = f"http://127.0.0.1:{port}/{PAGES.get(host, '')}"
    log = folder / "log.txt"
    environment = {**os.environ, "HEARD": str(folder / "heard.json")}
    with log.open("w") as said:
        process = subprocess.Popen(
            command, cwd=folder, env=environment, stdout=said, stderr=subprocess.STDOUT
        )
    try:
        wait_until_served(address, process, log.read_text, HOST_PATIENCE_S)
        yield address
    finally:
        process.terminate()
        process.wait(HOST_PATIENCE_S)


@pytest.mark.parametrize("host", WIDGETS)
def test_a_host_shows_a_flow_that_can_be_moved(page: Page, host: str, tmp_path: Path) -> None:
    if find_spec(host) is None:
        pytest.skip(f"{host} is not installed: make integrations")
    page.set_default_timeout(1000 * HOST_PATIENCE_S)
    with served(host, tmp_path) as address:
        page.goto(address)
        if host == "notebook":
            # Its indicator says "idle" before a kernel is asked for, too.
            wait_for_kernel(page)
            page.locator(".jp-CodeCell .cm-content").click()
            page.keyboard.press("Shift+Enter")
        place = page.frame_locator("iframe") if host in FRAMED else page
        # What the window does not show is not drawn; a slow page may show the view below it.
        place.locator(".flowtex").first.scroll_into_view_if_needed()
        place.locator('.flowtex[data-sharp="true"]').first.wait_for()
        canvas = place.locator(".flowtex canvas").first
        box = canvas.bounding_box()
        assert box is not None and box["width"] > 200 and box["height"] > 90
        was = canvas.screenshot()
        x, y = box["x"] + 100, box["y"] + 60
        # A host may fade out what it shows while it loads, above the view, and take the drag.
        view = place.locator(".flowtex").first
        edge = view.bounding_box()
        assert edge is not None
        view.hover(position={"x": x - edge["x"], "y": y - edge["y"]})
        page.mouse.down()
        page.mouse.move(x + 50, y, steps=4)
        page.mouse.up()
        wait_until(lambda: canvas.screenshot() != was, limit=HOST_PATIENCE_S)
        if host not in FRAMED:
            heard = tmp_path / "heard.json"

            def moved() -> bool:
                with suppress(OSError, ValueError):  # it is being written
                    # The flow lies 0 to 2 along x, and follows the hand to the right.
                    return float(json.loads(heard.read_text())["focal_point"][0]) < 0.95
                return False

            wait_until(moved, (tmp_path / "log.txt").read_text, HOST_PATIENCE_S)


#: Width of what Bokeh's picture shows; null before there is one.
SHOWN = (
    "() => [...(globalThis.Bokeh?.documents ?? [])].flatMap((d) => [...d.all_models])"
    ".find((model) => model.glyph?.type === 'ImageRGBA')?.data_source.data.dw[0] ?? null"
)


def test_a_plot_of_holoviews_is_drawn_again_for_what_it_shows(page: Page, tmp_path: Path) -> None:
    pytest.importorskip("holoviews", reason="make integrations")
    page.set_default_timeout(1000 * HOST_PATIENCE_S)
    with served("holoviews", tmp_path) as address:
        page.goto(address)
        page.wait_for_function(f"({SHOWN})() !== null")
        before = page.evaluate(SHOWN)
        page.mouse.move(150, 150)
        page.mouse.wheel(0, -400)
        page.wait_for_function(f"(width) => ({SHOWN})() < 0.9 * width", arg=before)
