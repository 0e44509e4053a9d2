"""Sessions in separate processes, of an application that draws nothing."""

from __future__ import annotations

import math
import os
from collections.abc import AsyncIterable
from types import SimpleNamespace
from typing import Any

from flowtex.app.server.files import Routes
from flowtex.app.server.sessions.local import opener
from flowtex.app.server.sessions.process import HostedSession
from flowtex.app.server.sessions.registry import Sessions
from flowtex.app.server.site import Site
from flowtex.errors import FieldError


class Plain:
    """Tells its process, gives a file, and takes files of four bytes at most."""

    def __init__(self, server: Any) -> None:
        self.server = server
        self.stream = SimpleNamespace(watched=lambda: True)
        self.taken: list[str] = []
        routes = Routes.of(server)
        server.state.update({"flow0_pid": os.getpid(), "flow0_value": 1})
        server.state.flow0_file = routes.give("a b.txt", lambda: (b"words", "text/plain", "ä.txt"))
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
        pass


def host() -> HostedSession:
    return HostedSession(open_site)


def open_site(request: dict[str, Any]) -> tuple[Site, str]:
    if "fault" in request:
        raise FieldError(request["fault"])
    secret = request["secret"]
    sessions = Sessions(opener(Plain, secret), limit=1, idle=math.inf)
    return Site(sessions, secret), "plain"
