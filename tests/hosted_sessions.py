"""A site of sessions, here or in separate processes, of an application that draws nothing."""

from __future__ import annotations

import math
import os
from collections.abc import AsyncIterable, AsyncIterator
from contextlib import asynccontextmanager
from types import SimpleNamespace
from typing import Any

import aiohttp
from served import Link, enter

from flowtex.app.server.files import Routes
from flowtex.app.server.sessions.local import opener
from flowtex.app.server.sessions.process import HostedSession
from flowtex.app.server.sessions.registry import OpenSession, Sessions
from flowtex.app.server.site import Site
from flowtex.errors import FieldError


class Place:
    """A site in this process, and who goes there."""

    def __init__(self, site: Site, secret: str, http: aiohttp.ClientSession) -> None:
        self.site, self.secret, self.http = site, secret, http
        self.bare = f"http://127.0.0.1:{site.port}/"

    async def enter(self, token: str | None = None) -> tuple[int, dict[str, str]]:
        return await enter(self.http, self.bare, self.secret, token)

    async def token(self, known: str | None = None) -> str:
        status, said = await self.enter(known)
        assert status == 200, said
        return said["session"]

    async def link(self, token: str) -> Link:
        return await Link.open(self.http, self.bare, token, self.secret)

    async def enter_and_link(self, known: str | None = None) -> tuple[str, Link]:
        token = await self.token(known)
        return token, await self.link(token)


@asynccontextmanager
async def place_of(
    open_session: OpenSession, secret: str, *, limit: int = 4, idle: float = 10.0
) -> AsyncIterator[Place]:
    site = Site(Sessions(open_session, limit=limit, idle=idle), secret)
    await site.listen()
    async with aiohttp.ClientSession() as http:
        try:
            yield Place(site, secret, http)
        finally:
            await site.stop()


class Plain:
    """Tells its process, gives a file, and takes files of four bytes at most."""

    def __init__(self, server: Any) -> None:
        self.server = server
        self.stream = SimpleNamespace(watched=lambda: True)
        self.closed = False
        routes = Routes.of(server)
        server.state.update({"flow0_pid": os.getpid(), "flow0_value": 1})
        server.state.flow0_file = routes.give("a b", lambda _: (b"words", "text/plain", "ä.txt"))
        server.state.flow0_sends = routes.take("sent", self.take)

    async def take(self, name: str, chunks: AsyncIterable[bytes]) -> None:
        size = 0
        async for chunk in chunks:
            size += len(chunk)
            if size > 4:
                msg = f"{name} is too large"
                raise FieldError(msg)
        with self.server.state as state:
            state.flow0_value = size

    def close(self) -> None:
        self.closed = True


def host() -> HostedSession:
    return HostedSession(open_site)


def open_site(request: dict[str, Any]) -> tuple[Site, str]:
    if "fault" in request:
        raise FieldError(request["fault"])
    secret = request["secret"]
    sessions = Sessions(opener(Plain, secret), limit=1, idle=math.inf)
    return Site(sessions, secret), "plain"
