"""How many connections a server has, for how long, and which are refused."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import pytest

pytest.importorskip("aiohttp")
pytest.importorskip("wslink")

import aiohttp
from aiohttp import web
from waiting import PATIENCE_S

from flowtex.app.server import security
from flowtex.app.server.security import LIMIT, LimitedServer, guard

HALF = b"GET / HTTP/1.1\r\nHost: localhost\r\nX-Slow: "
FORM = b"POST /form HTTP/1.1\r\nHost: localhost\r\nContent-Length: 4\r\n"
Stream = tuple[asyncio.StreamReader, asyncio.StreamWriter]


class Place:
    """A server with a page, a socket and a form, and what connects to it."""

    def __init__(self, port: int) -> None:
        self.port = port
        self.streams: list[Stream] = []

    async def begin(self, text: bytes = HALF, address: str = "127.0.0.1") -> Stream:
        """Connect, and send the first part of a request."""
        stream = await asyncio.open_connection("127.0.0.1", self.port, local_addr=(address, 0))
        self.streams.append(stream)
        stream[1].write(text)
        await stream[1].drain()
        return stream

    async def begin_form(self) -> Stream:
        """Send half of a form, of which the server waits for the rest."""
        stream = await self.begin(FORM + b"Expect: 100-continue\r\n\r\n")
        assert await stream[0].readuntil(b"\r\n\r\n") == b"HTTP/1.1 100 Continue\r\n\r\n"
        stream[1].write(b"ab")
        return stream

    @asynccontextmanager
    async def socket(self) -> AsyncIterator[aiohttp.ClientWebSocketResponse]:
        """Connect as a page does."""
        async with (
            aiohttp.ClientSession() as http,
            http.ws_connect(f"http://127.0.0.1:{self.port}/ws") as socket,
        ):
            yield socket

    async def status(self) -> int:
        """Ask for the page on its own connection."""
        async with (
            aiohttp.ClientSession() as http,
            http.get(f"http://127.0.0.1:{self.port}/") as answer,
        ):
            return answer.status


@asynccontextmanager
async def place(most: int | None = None) -> AsyncIterator[Place]:
    async def page(request: web.Request) -> web.Response:
        return web.Response(text="a page")

    async def socket(request: web.Request) -> web.WebSocketResponse:
        request[LIMIT].reschedule(None)
        made = web.WebSocketResponse()
        await made.prepare(request)
        async for message in made:
            await made.send_str(message.data)
        return made

    async def form(request: web.Request) -> web.Response:
        return web.Response(body=await request.read())

    application = web.Application()
    guard(application)
    application.router.add_get("/", page)
    application.router.add_get("/ws", socket)
    application.router.add_post("/form", form)
    server = LimitedServer(application, most=most)
    here = Place(await server.start(("127.0.0.1", 0)))
    try:
        yield here
    finally:
        for _, writer in here.streams:
            writer.close()
        await server.stop()


async def ended(stream: Stream) -> bytes:
    """Wait for the server to end a connection; return what it said."""
    async with asyncio.timeout(PATIENCE_S):
        try:
            return await stream[0].read()
        except ConnectionError:
            return b""


async def test_connections_beyond_the_maximum_are_refused(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    async with place(4) as here, here.socket() as socket:
        half = [await here.begin() for _ in range(8)]
        for stream in half[3:]:
            assert await ended(stream) == b""
        half[0][1].write(b"no\r\n\r\n")
        assert (await half[0][0].readline()).startswith(b"HTTP/1.1 200")
        await socket.send_str("here")
        assert await socket.receive_str(timeout=PATIENCE_S) == "here"
    assert not caplog.records


async def test_a_head_and_a_body_have_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(security, "LINGER_S", 0.0)

    def later(seconds: float) -> None:
        loop = asyncio.get_running_loop()
        now = loop.time
        monkeypatch.setattr(loop, "time", lambda: now() + seconds)

    async with place() as here, here.socket() as socket:
        half, form = await here.begin(), await here.begin_form()
        whole = await here.begin(HALF + b"no\r\n\r\n")
        assert (await whole[0].readline()).startswith(b"HTTP/1.1 200")
        later(security.HEAD_S + 1)
        assert await ended(half) == b""
        assert (await ended(whole)).endswith(b"a page")  # which came before its time was over
        assert not form[0].at_eof()
        later(security.ANSWER_S)
        assert (await ended(form)).startswith(b"HTTP/1.1 408")
        await socket.send_str("here")
        assert await socket.receive_str(timeout=PATIENCE_S) == "here"
