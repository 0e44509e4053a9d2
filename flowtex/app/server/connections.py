"""Limits of the connections of a web server: their number and their duration.

The head of a request has to arrive within :data:`HEAD_S`, also the next one of a connection that
is kept, and the answer within :data:`ANSWER_S`. Beyond the maximum number of connections, new ones
are closed.
"""

from __future__ import annotations

import asyncio
import socket as sockets
from collections.abc import Awaitable, Callable
from contextlib import suppress
from typing import Any

from aiohttp import web

#: Seconds for the head of a request, and for finding an answer (an upload lasts until it is read).
HEAD_S, ANSWER_S = 30.0, 900.0
#: Connections at one time, at most, and connections that wait to be let in.
CONNECTIONS, BACKLOG = 512, 64
#: Seconds in which the rest of a request that was answered may come, and connections end.
LINGER_S, SHUTDOWN_S = 2.0, 2.0

#: Answers a request.
Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]
#: The time limit of a request.
LIMIT = web.RequestKey("limit", asyncio.Timeout)


def limit_time(application: web.Application) -> None:
    """End requests that take too long, except those that are kept."""

    @web.middleware
    async def in_time(request: web.Request, handler: Handler) -> web.StreamResponse:
        try:
            async with asyncio.timeout(ANSWER_S) as request[LIMIT]:
                return await handler(request)
        except TimeoutError:
            raise web.HTTPRequestTimeout from None

    application.middlewares.append(in_time)


def keep(request: web.Request) -> None:
    """Lift the time limit of a request's connection."""
    request[LIMIT].reschedule(None)


class LimitedServer:
    """A web application on a port.

    It has ``most`` connections at one time; by default half of the files that the process may open
    are left for others. Options are arguments of ``aiohttp.web.AppRunner``.
    """

    def __init__(
        self, application: web.Application, *, most: int | None = None, **options: Any
    ) -> None:
        self._most = usual_most() if most is None else most
        # The program handles signals, not the web server.
        self._runner = web.AppRunner(
            application,
            handle_signals=False,
            access_log=None,
            shutdown_timeout=SHUTDOWN_S,
            keepalive_timeout=HEAD_S,  # counted from the connection on
            lingering_time=LINGER_S,
            **options,
        )
        self._server: asyncio.Server | None = None

    async def start(self, endpoint: sockets.socket | tuple[str, int]) -> int:
        """Listen at a host and port, or on a socket that listens; return the port."""
        await self._runner.setup()
        create = asyncio.get_running_loop().create_server
        if isinstance(endpoint, tuple):
            self._server = await create(self._admit, *endpoint, backlog=BACKLOG)
        else:
            self._server = await create(self._admit, sock=endpoint, backlog=BACKLOG)
        port: int = self._server.sockets[0].getsockname()[1]
        return port

    async def stop(self) -> None:
        """Listen no more, and end all connections."""
        if self._server is not None:
            loop = asyncio.get_running_loop()
            for listener in self._server.sockets:
                with suppress(NotImplementedError):  # on Windows
                    loop.remove_reader(listener.fileno())
            # Accepted connections get their protocol first: asyncio would leave those of a closed
            # server open and unanswered.
            await asyncio.sleep(0)
            self._server.close()
            self._server = None
        await self._runner.cleanup()

    def _admit(self) -> asyncio.Protocol:
        """Return the protocol of a new connection, which ends it if there are too many."""
        server = self._runner.server
        if server is None or self._server is None:  # accepted just before the server stopped
            return _Refusal()
        transports = [connection.transport for connection in server.connections]
        present = sum(t is not None and not t.is_closing() for t in transports)
        return server() if present < self._most else _Refusal()


class _Refusal(asyncio.Protocol):
    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        if isinstance(transport, asyncio.Transport):
            transport.abort()


def usual_most() -> int:
    """Return the maximum number of connections of this process."""
    with suppress(ImportError, OSError):  # on Windows
        import resource

        files = resource.getrlimit(resource.RLIMIT_NOFILE)[0]
        if files != resource.RLIM_INFINITY:
            return max(1, min(CONNECTIONS, files // 2))
    return CONNECTIONS
