"""The examples of docs/architecture.md, as a page runs them."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import unquote, urlsplit

import pytest

import flowtex
from flowtex.host.still import preview_png
from flowtex.host.view import WebView, client_module
from flowtex.rendering.webgl.protocol import parts_file
from flowtex.scene.scene import Scene

if TYPE_CHECKING:
    from playwright.sync_api import Page, Route

TEXT = (Path(__file__).parents[2] / "docs" / "architecture.md").read_text("utf-8")
EXAMPLES = re.findall(r"```js\n(.+?)```", TEXT, re.DOTALL)
PAGE = """<!doctype html><title>Example</title><div style="height: 300px" id="here"></div>
<script>const element = document.getElementById("here"), heard = [];</script>
<script type="module">{}</script>"""


@pytest.mark.browser
@pytest.mark.parametrize("example", EXAMPLES, ids=["host", "source", "painter"])
def test_an_example_shows_a_flow(page: Page, example: str) -> None:
    view = WebView(Scene(flowtex.examples.double_gyre_field(shape=(21, 41))))
    view.scene.settings.samples = 5
    data = view.data()
    files = {
        "/": PAGE.format(example).encode(),
        "/flowtex.mjs": client_module().encode(),
        "/header": json.dumps(data.header(view.scene.settings)).encode(),
        "/parts/whole/": parts_file(data.surface() | data.step(0)),
        "/parts/position/": parts_file(replace(data, traces=False).surface()),
    }

    def answer(route: Route) -> None:
        path = unquote(urlsplit(route.request.url).path)
        if path.startswith("/picture/"):
            _, _, width, height, camera = path.split("/", 4)
            size = (int(width), int(height))
            files[path] = preview_png(view, size, camera=json.loads(camera))
        kind = "text/javascript" if path.endswith("mjs") else "text/html"
        route.fulfill(body=files[path], content_type=kind)

    page.route("http://site.test/**", answer)
    page.goto("http://site.test/")
    page.locator('.flowtex[data-sharp="true"]').wait_for()
    page.locator("[data-name=home]").click()
    if "heard" in example:
        page.locator(".flowtex canvas").focus()
        page.keyboard.press("ArrowRight")
        page.wait_for_function("() => heard.length && heard.at(-1)[0] !== 1")
