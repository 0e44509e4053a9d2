"""A JupyterLab that Chromium drives."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from playwright.sync_api import Page

__all__ = ["Lab", "lab"]

TOKEN = "test"
OPTIONS = (
    "--no-browser",
    "--allow-root",
    "--ip=127.0.0.1",
    "--port=0",
    "--ServerApp.log_level=INFO",
    f"--IdentityProvider.token={TOKEN}",
    "--LabApp.expose_app_in_browser=True",
)
QUIET = {"fetchNews": "false", "checkForUpdates": False, "doNotDisturbMode": True}
#: A window without the focus has no current widget until it is told of one.
SHOWN = """() => {
  document.querySelector(".jp-Notebook")?.dispatchEvent(new FocusEvent("focus"));
  return Boolean(window.jupyterapp?.shell?.currentWidget?.sessionContext);
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


class Lab:
    """One notebook in a JupyterLab."""

    def __init__(self, page: Page, address: str, name: str = "test.ipynb") -> None:
        self.page = page
        self._count = 0
        page.goto(f"{address}/doc/tree/{name}?token={TOKEN}")
        page.wait_for_function(SHOWN)
        page.evaluate(READY)

    def run(self, code: str) -> None:
        """Run a cell; what it prints is waited for by :meth:`said`."""
        self.page.evaluate(RUN, code)

    def said(self, code: str) -> str:
        """Run a cell and return what it prints of an expression."""
        self._count += 1
        self.run(f"print('<<{self._count}:', {code}, ':{self._count}>>', flush=True)")
        found = self.page.locator(".jp-OutputArea-output pre", has_text=f":{self._count}>>").first
        found.wait_for()
        return found.inner_text().split(":", 1)[1].rsplit(":", 1)[0].strip()


@contextmanager
def lab(folder: Path, names: Sequence[str] = ("test.ipynb",), *words: str) -> Iterator[str]:
    """Yield the address of a JupyterLab with empty notebooks in a folder."""
    for name in names:
        (folder / name).write_text(json.dumps(_empty_notebook()))
    settings = folder / "settings" / "@jupyterlab" / "apputils-extension"
    settings.mkdir(parents=True)
    (settings / "notification.jupyterlab-settings").write_text(json.dumps(QUIET))
    own = (
        f"--ServerApp.root_dir={folder}",
        f"--LabApp.user_settings_dir={folder / 'settings'}",
        *words,
    )
    log = folder / "log.txt"
    with log.open("w") as file:
        process = subprocess.Popen(
            [sys.executable, "-m", "jupyterlab", *OPTIONS, *own], stdout=file, stderr=file
        )
    try:
        yield _address(process, log)
    finally:
        process.terminate()
        process.wait(20)


def _empty_notebook() -> dict[str, Any]:
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    return {"cells": [], "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}


def _address(process: subprocess.Popen[bytes], log: Path) -> str:
    for _ in range(600):
        found = re.search(r"http://127\.0\.0\.1:\d+[^\s?]*(?=/lab\?token=)", log.read_text())
        if found:
            return found.group()
        if process.poll() is not None:
            break
        time.sleep(0.1)
    pytest.fail(f"JupyterLab did not start:\n{log.read_text()}")
