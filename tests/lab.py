"""A JupyterLab that Chromium drives."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from waiting import PATIENCE_S, wait_until, wait_until_served

if TYPE_CHECKING:
    from playwright.sync_api import Page

TOKEN = "test"
START = """import sys  #: Without what conftest.py leaves out.
sys.modules["rfc3987_syntax"] = None
from jupyterlab.labapp import main
main()"""
BASE = "/user/Ada"  #: Where the pages lie, as on JupyterHub.
OPTIONS = (
    "--no-browser",
    "--allow-root",
    "--ip=127.0.0.1",
    "--port=0",
    "--ServerApp.log_level=INFO",
    f"--IdentityProvider.token={TOKEN}",
    "--LabApp.expose_app_in_browser=True",
    f"--ServerApp.base_url={BASE}/",
)
SETTINGS: dict[str, dict[str, Any]] = {
    "@jupyterlab/apputils-extension/notification": {
        "fetchNews": "false",
        "checkForUpdates": False,
        "doNotDisturbMode": True,
    },
    "@jupyter-widgets/jupyterlab-manager/plugin": {"saveState": True},
}
#: A window without the focus has no current widget until it is told of one.
SHOWN = """() => {
  document.querySelector(".jp-Notebook")?.dispatchEvent(new FocusEvent("focus"));
  return Boolean(window.jupyterapp?.shell?.currentWidget?.sessionContext);
}"""
#: Opens a notebook in the place of the one that is shown: to load JupyterLab takes seconds.
OPEN = """async (path) => {
  jupyterapp.shell.currentWidget.dispose();
  await jupyterapp.commands.execute("docmanager:open", { path });
}"""
READY = """async () => {
  await jupyterapp.restored;
  const context = jupyterapp.shell.currentWidget.sessionContext;
  await context.ready;
  await context.session.kernel.info;
}"""
RUN = """(code) => {
  const notebook = jupyterapp.shell.currentWidget.content;
  jupyterapp.commands.execute("notebook:insert-cell-below").then(() => {
    notebook.activeCell.model.sharedModel.setSource(code);
    jupyterapp.commands.execute("notebook:run-cell");
  });
}"""
CLEAR = """() => {
  const { sharedModel } = jupyterapp.shell.currentWidget.content.model;
  sharedModel.deleteCellRange(0, sharedModel.cells.length);
}"""
SAVE = "() => jupyterapp.shell.currentWidget.context.save()"  #: Ends when the file is written.


def wait_for_kernel(page: Page) -> None:
    """Wait until the notebook that a page shows has a kernel that answers."""
    page.wait_for_function(SHOWN)
    page.evaluate(READY)


class Lab:
    """A new notebook in a JupyterLab, or one that holds a text, in the place of any before."""

    def __init__(self, page: Page, server: LabServer, text: str = "") -> None:
        self.page = page
        self._count = 0
        name = f"{uuid.uuid4().hex}.ipynb"
        self.path = server.folder / name
        self.path.write_text(text or json.dumps(_empty_notebook()), encoding="utf-8")
        if page.url.startswith(server.address):
            page.evaluate(OPEN, name)
        else:
            page.goto(f"{server.address}/doc/tree/{name}?token={TOKEN}")
        wait_for_kernel(page)

    def run(self, code: str) -> None:
        """Run a cell; what it prints is waited for by :meth:`said`."""
        self.page.evaluate(RUN, code)

    def clear(self) -> None:
        """Take all cells away; what they have defined stays."""
        self.page.evaluate(CLEAR)

    def saved(self) -> str:
        """Save the notebook and return its text."""
        self.page.evaluate(SAVE)
        return self.path.read_text(encoding="utf-8")

    def said(self, code: str) -> str:
        """Run a cell and return what it prints of an expression."""
        self._count += 1
        self.run(f"print('<<{self._count}:', {code}, ':{self._count}>>', flush=True)")
        found = self.page.locator(".jp-OutputArea-output pre", has_text=f":{self._count}>>").first
        found.wait_for()
        return found.inner_text().split(":", 1)[1].rsplit(":", 1)[0].strip()


@dataclass
class LabServer:
    """A JupyterLab, and the folder of its notebooks."""

    address: str
    folder: Path


@contextmanager
def lab(folder: Path) -> Iterator[LabServer]:
    """Yield a JupyterLab, which saves the state of widgets."""
    for plugin, settings in SETTINGS.items():
        file = folder / "settings" / f"{plugin}.jupyterlab-settings"
        file.parent.mkdir(parents=True)
        file.write_text(json.dumps(settings))
    own = (f"--ServerApp.root_dir={folder}", f"--LabApp.user_settings_dir={folder / 'settings'}")
    log = folder / "log.txt"
    with log.open("w") as file_:
        process = subprocess.Popen(
            [sys.executable, "-c", START, *OPTIONS, *own], stdout=file_, stderr=file_
        )
    try:
        address = _address(process, log)
        wait_until_served(f"{address}/api", process, log.read_text)
        yield LabServer(address, folder)
    finally:
        process.terminate()
        process.wait(PATIENCE_S)


def _empty_notebook() -> dict[str, Any]:
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    return {"cells": [], "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}


def _address(process: subprocess.Popen[bytes], log: Path) -> str:
    pattern = r"http://127\.0\.0\.1:\d+[^\s?]*(?=/lab\?token=)"

    def announced() -> re.Match[str] | None:
        assert process.poll() is None, f"JupyterLab did not start:\n{log.read_text()}"
        return re.search(pattern, log.read_text())

    return str(wait_until(announced, log.read_text).group())
