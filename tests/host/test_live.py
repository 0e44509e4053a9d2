"""Views among the text of a page, and the one that explains a pixel."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from embed import write_scene
from flows import gyre

from flowtex.host.view import asset, web_views
from flowtex.scene.options import Options

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = pytest.mark.browser

PAGE = """<!doctype html><html lang="en"><meta charset="utf-8"><title>gyre</title>
<script src="client.js" defer></script>
<div class="flowtex-explained">
<div class="flowtex-live" data-scene="gyre.js" style="height: 200px; width: 400px"></div></div>"""


def test_a_pixel_is_explained_without_a_server(page: Page, tmp_path: Path) -> None:
    views = web_views(
        gyre(281, 141), Options.split(samples=5, grain=8.0, spacing=1.0, scalars=False)
    )
    write_scene(tmp_path, "gyre", views)
    # Some parts are large enough to lie apart.
    assert len(list(tmp_path.glob("*.js"))) > 1
    (tmp_path / "client.js").write_bytes(asset("core.js").read_bytes())
    (tmp_path / "page.html").write_text(PAGE, encoding="utf-8")
    page.set_viewport_size({"width": 420, "height": 700})
    page.goto((tmp_path / "page.html").as_uri())
    rows = page.locator(".explained-row svg")
    rows.first.wait_for()
    assert rows.count() == 3
    assert rows.first.locator("rect").count() == 5
    assert page.locator(".flowtex circle.dot").count() == 5
    assert page.locator(".card:visible").count() == 0
    level = _level(page.locator(".explained-sum").inner_text())
    samples, zoom = (page.locator(f'input[data-setting="{name}"]') for name in ("samples", "zoom"))
    samples.press("ArrowRight")
    assert rows.first.locator("rect").count() == 7
    for _ in range(4):
        zoom.press("ArrowRight")
    # Twice as close is one level finer.
    assert _level(page.locator(".explained-sum").inner_text()) == pytest.approx(level - 1)
    page.locator(".flowtex").press("Escape")
    page.get_by_text("Click a point").wait_for()
    assert rows.count() == 0


def _level(text: str) -> float:
    found = re.search(r"level (-?[\d.]+)\.", text)
    assert found
    return float(found[1])
