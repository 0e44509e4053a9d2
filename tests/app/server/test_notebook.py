"""The page in the cell of a notebook, without a browser: tests/test_jupyterlab.py has one."""

from __future__ import annotations

import asyncio
from typing import Any

import aiohttp
import pytest

pytest.importorskip("trame_rca")

from served import Link, enter
from waiting import PATIENCE_S

from flowtex import examples
from flowtex.app import FlowApp
from flowtex.app.server.notebook import proxy_path


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
