"""Whom the server answers, under which names, and what it says of its faults."""

from __future__ import annotations

import asyncio
import inspect
import logging
from collections.abc import Awaitable, Callable
from typing import Any

import pytest

pytest.importorskip("aiohttp")
pytest.importorskip("wslink")

from aiohttp import web
from aiohttp.test_utils import TestClient, TestServer

from flowtex.app.server.security import FAULT, guard, is_same, known_hosts
from flowtex.errors import FieldError

Client = TestClient[Any, Any]


def visit(ask: Callable[[Client], Awaitable[None]], **options: Any) -> None:
    """Ask a server whose pages fail in several ways."""

    async def run() -> None:
        application = web.Application()
        guard(application, **options)

        async def page(request: web.Request) -> web.Response:
            if request.query.get("file"):
                raise OSError(28, "No space left on device", "/secret/file")
            if request.query.get("bug"):
                raise ZeroDivisionError
            return web.Response(text="a page")

        application.router.add_get("/{token}/", page)
        async with TestClient(TestServer(application)) as client:
            await ask(client)

    asyncio.run(run())


@pytest.mark.parametrize(
    ("host", "status"),
    [
        *((name, 200) for name in ("localhost", "LOCALHOST:80", "127.0.0.1:8080", "[::1]:80")),
        *((name, 200) for name in ("192.168.1.7:80", "flow.example.org", "flow.example.org.:443")),
        *((name, 403) for name in ("evil.example", "evil.example:80", "localhost.evil.example")),
        *((name, 403) for name in ("127.0.0.1.evil.example", "", "[::1", "a b", "@", "1.2.3")),
    ],
)
def test_names_that_are_not_known_are_refused(host: str, status: int) -> None:
    async def ask(client: Client) -> None:
        # A page whose name was led here is of the same origin to a browser.
        headers = {"Host": host, "Origin": f"http://{host}"} if status == 403 else {"Host": host}
        answer = await client.get("/token/", headers=headers)
        assert answer.status == status
        if status == 403:
            assert "--allow-host NAME" in await answer.text()

    visit(ask, hosts=known_hosts("127.0.0.1", ["flow.example.org"]))


def test_servers_listen_on_this_machine_alone() -> None:
    from flowtex.app import serve
    from flowtex.cli.options import AddressFlags

    assert AddressFlags().host == "127.0.0.1"  # of the shell
    assert inspect.signature(serve).parameters["host"].default == "127.0.0.1"


def test_names_are_of_this_machine_and_those_that_are_given(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("platform.node", lambda: "Node7")
    assert known_hosts("127.0.0.1") == {"localhost", "127.0.0.1"}
    assert known_hosts("0.0.0.0") == {"localhost", "0.0.0.0", "node7"}
    assert "flow.org" in known_hosts("flow.org") and "a.b" in known_hosts("::1", ["A.b"])
    for wrong in ("http://a.b", "a.b:80", "", "a b"):
        with pytest.raises(FieldError, match="expected a host name without scheme and port"):
            known_hosts("127.0.0.1", [wrong])
    monkeypatch.setenv("JUPYTERHUB_SERVICE_PREFIX", "/user/me/")

    async def ask(client: Client) -> None:  # the proxy keeps the name of the hub
        assert (await client.get("/token/", headers={"Host": "hub.example"})).status == 200

    visit(ask, hosts=known_hosts("127.0.0.1"))


def test_a_malformed_origin_is_another_site() -> None:
    async def ask(client: Client) -> None:
        for origin in ("http://[", "null", "", "http://localhost.evil"):
            assert (await client.get("/token/", headers={"Origin": origin})).status == 403

    visit(ask)


def test_faults_go_to_the_log_and_not_to_a_page(caplog: pytest.LogCaptureFixture) -> None:
    async def ask(client: Client) -> None:
        asyncio.get_running_loop().set_debug(True)  # in which aiohttp answers tracebacks
        for fault in ("file", "bug"):
            answer = await client.get("/word/", params={fault: "1"})
            assert answer.status == 500 and await answer.text() == FAULT

    with caplog.at_level(logging.ERROR):
        visit(ask)
    full, bug = caplog.records
    assert "GET /{token}/: OSError" in full.getMessage() and "secret/file" in full.getMessage()
    assert not full.exc_info and bug.exc_info and "ZeroDivisionError" in caplog.text
    assert "word" not in caplog.text


def test_a_secret_may_be_any_text() -> None:
    assert is_same("secret", "secret")
    for other in ("", "\ud800", "sécret", None, 1, b"secret", ["secret"]):
        assert not is_same(other, "secret")
