"""The page in a cell of a real JupyterLab, directly and through jupyter-server-proxy."""

from __future__ import annotations

import asyncio
import io
from typing import TYPE_CHECKING, Any

import aiohttp
import numpy as np
import pytest
from PIL import Image

pytest.importorskip("trame_rca")

from lab import BASE, Lab, LabServer
from served import Link, enter
from waiting import PATIENCE_S, wait_until
from watching import COUNT, DRAWN, SHARP

from flowtex import examples
from flowtex.app import FlowApp
from flowtex.app.server.notebook import proxy_path

if TYPE_CHECKING:
    from playwright.sync_api import Frame, Page

SHOW = """import flowtex
from flowtex.app import FlowApp
app = FlowApp(flowtex.examples.double_gyre_field(), samples=5)
app"""
#: What a kernel finds in its environment on JupyterHub.
HUB = f"__import__('os').environ.update(JUPYTERHUB_SERVICE_PREFIX='{BASE}/')"


@pytest.mark.parametrize(
    ("asked", "environment", "expected"),
    [
        (None, {}, None),
        (None, {"JUPYTERHUB_SERVICE_PREFIX": "/user/Ada/"}, "/user/Ada/proxy"),
        (None, {"FLOWTEX_PROXY": "/base/proxy/"}, "/base/proxy"),
        (False, {"JUPYTERHUB_SERVICE_PREFIX": "/user/Ada/"}, None),
        (True, {}, "/proxy"),
        ("https://other.example/proxy/", {}, "https://other.example/proxy"),
    ],
)
def test_the_proxy_is_found(
    asked: Any, environment: dict[str, str], expected: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("JUPYTERHUB_SERVICE_PREFIX", "FLOWTEX_PROXY"):
        monkeypatch.delenv(name, raising=False)
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    assert proxy_path(asked) == expected


@pytest.mark.usefixtures("opengl")
def test_without_a_loop_it_says_what_to_do() -> None:
    app = FlowApp(examples.double_gyre_field(), samples=3)
    assert "flowtex.app.serve" in app._repr_mimebundle_()["text/plain"]
    with pytest.raises(RuntimeError, match="no event loop"):
        app.in_cell()
    app.close()


@pytest.mark.usefixtures("opengl")
async def test_all_frames_show_the_application_that_python_has() -> None:
    app = FlowApp(examples.double_gyre_field(), samples=3)
    html = app._repr_mimebundle_()["text/html"]
    frame = app.in_cell(height=300)
    bare, _, secret = frame.address.partition("?secret=")
    assert frame.address in html and secret not in repr(frame) and "300px" in frame._repr_html_()
    async with aiohttp.ClientSession() as http:
        (_, one), (_, other) = [await enter(http, bare, secret) for _ in range(2)]
        assert one == other
        links = [await Link.open(http, bare, one["session"], secret) for _ in range(2)]
        with app.server.state:
            app.server.state.answer = 42
        for link in links:
            await link.until(lambda link=link: link.state.get("answer") == 42)
        app.close()
        for link in links:
            await asyncio.wait_for(link._task, PATIENCE_S)
        with pytest.raises(aiohttp.ClientError):
            async with asyncio.timeout(PATIENCE_S):
                while True:
                    await enter(http, bare, secret)


def frame_of(page: Page) -> Frame:
    frame = page.locator("iframe[title=flowtex]").element_handle().content_frame()
    assert frame is not None
    return frame


def drawn(page: Page, frame: Frame, before: int = 0) -> Any:
    """Wait for the next full picture, and return the frame as (h, w) greys."""
    frame.wait_for_function(f"n => ({COUNT})() > n && ({SHARP})()", arg=before)
    frame.evaluate(DRAWN)
    with Image.open(io.BytesIO(page.locator("iframe[title=flowtex]").screenshot())) as picture:
        return np.asarray(picture.convert("L"), dtype=float)[140:300, 80:-30]


@pytest.mark.slow
@pytest.mark.browser
@pytest.mark.usefixtures("opengl")
def test_a_cell_shows_a_flow_that_both_sides_can_change(page: Page, jupyter: LabServer) -> None:
    """Through the proxy, as on JupyterHub; without it the page is that of a server."""
    page.set_viewport_size({"width": 700, "height": 700})
    asked: list[str] = []
    page.on("websocket", lambda socket: asked.append(socket.url))
    notebook = Lab(page, jupyter)
    assert notebook.said(HUB) == "None"
    notebook.run(SHOW)
    page.locator("iframe[title=flowtex]").wait_for()
    frame = frame_of(page)
    before = drawn(page, frame)
    assert np.abs(np.diff(before, axis=0)).mean() > 5
    (link,) = [url for url in asked if "/page/" in url]
    assert f"{BASE}/proxy/" in link
    assert "secret" not in frame.url

    # The browser to Python, and Python to the browser.
    count = int(frame.evaluate(COUNT))
    frame.locator(".picture").hover(position={"x": 200, "y": 200})
    for _ in range(8):
        page.mouse.wheel(0, -100)
    closer = drawn(page, frame, count)
    assert np.abs(closer - before).mean() > 5
    assert float(notebook.said("app.viewport.zoom")) > 3
    assert notebook.said("app.area.reset_camera()") == "None"
    # A picture of the closer view may still be on its way.
    wait_until(lambda: np.abs(drawn(page, frame) - before).mean() < 1)

    assert notebook.said("app.close()") == "None"
    frame.get_by_text("lost its connection").wait_for()
