"""An exported module in a site that MyST builds as static HTML: `make integrations`.

MyST's own themes come from the network. The one in ``myst_theme`` shows nothing but the widgets of
the directive ``{anywidget}``, with a model that has no more than that of MyST's themes.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from waiting import HOST_PATIENCE_S, wait_until

import flowtex

if TYPE_CHECKING:
    from playwright.sync_api import Page, Route

pytestmark = [pytest.mark.slow, pytest.mark.browser]

TEXT = """# A flow

:::{anywidget} flow.mjs
{ "height": 260, "samples": 5 }
:::

:::{anywidget} flow.mjs
:::
"""
CONFIG = "version: 1\nproject:\n  title: Flows\nsite:\n  template: ./myst_theme\n"


def test_a_static_site_shows_a_flow_that_can_be_moved(page: Page, tmp_path: Path) -> None:
    if find_spec("mystmd_py") is None:
        pytest.skip("mystmd is not installed: make integrations")
    flowtex.export(flowtex.examples.double_gyre(), tmp_path / "flow.mjs", samples=9)
    (tmp_path / "index.md").write_text(TEXT)
    (tmp_path / "myst.yml").write_text(CONFIG)
    shutil.copytree(Path(__file__).parent / "myst_theme", tmp_path / "myst_theme")
    programs = Path(sys.executable).parent  # Node as well
    subprocess.run(
        [programs / "myst", "build", "--html"],
        cwd=tmp_path,
        env={**os.environ, "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}"},
        check=True,
        timeout=HOST_PATIENCE_S,
    )
    site = tmp_path / "_build" / "html"
    asked = []

    def give(route: Route) -> None:
        asked.append(route.request.url.removeprefix("http://site.test/"))
        route.fulfill(path=site / asked[-1])

    page.set_default_timeout(1000 * HOST_PATIENCE_S)
    page.route("**/*", give)
    page.goto("http://site.test/index.html")
    page.locator('.flowtex[data-sharp="true"]').nth(1).wait_for()
    (module,) = (site / "build").glob("*.mjs")
    assert asked == ["index.html", "page.js", f"build/{module.name}"]
    views = page.locator("flowtex-view")
    boxes = [view.bounding_box() for view in views.all()]
    assert [box and box["height"] for box in boxes] == [260, 480]
    samples = [view.evaluate("view => view.first.settings.samples") for view in views.all()]
    assert samples == [5, 9]
    canvas = page.locator(".flowtex canvas").first
    was = canvas.screenshot()
    page.mouse.move(600, 120)
    page.mouse.down()
    page.mouse.move(650, 120, steps=4)
    page.mouse.up()
    wait_until(lambda: canvas.screenshot() != was, limit=HOST_PATIENCE_S)
