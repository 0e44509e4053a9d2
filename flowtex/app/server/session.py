"""One application, its trame server, and the connection of its page.

trame is told to start nothing that listens: its generic end point takes messages from whoever
brings them, and the web server that all pages share brings them.
"""

from __future__ import annotations

import asyncio
import logging
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import wslink.server
from aiohttp import WSCloseCode, WSMsgType, web
from trame.app.core import AVAILABLE_SERVERS
from trame_client.widgets.core import HTML_CTX
from trame_server.protocol import CoreServer
from wslink.protocol import MAX_MSG_SIZE

from flowtex.app.server.messages import Messages
from flowtex.app.server.routes import Routes
from flowtex.app.server.security import new_secret

__all__ = ["Session"]

#: Seconds for which a page that asks for its session waits for the connection of its earlier self
#: to end. When it does not, somebody has made a copy of the tab.
PATIENCE = 2.0
#: Seconds between two signs of life of a connection.
HEARTBEAT = 20.0
#: What wslink adds to a message, in bytes, at most.
OVERHEAD = 4096

_log = logging.getLogger(__name__)

ENDED = Path(__file__).parents[1] / "ui" / "static" / "ended.html"


class Session:
    """One application and the connection of its page.

    Attributes
    ----------
    token
        What the page is known by.
    app
        The application.
    routes
        Files that it hands out.
    """

    def __init__(self, app: Any) -> None:
        self.token = new_secret()
        self.app = app
        self.routes = Routes.of(app.server)
        self._left = time.monotonic()
        self._sockets: set[web.WebSocketResponse] = set()
        self._endpoint: Any = None
        self._task: asyncio.Task[None] | None = None

    @property
    def connected(self) -> bool:
        """Whether a page is connected."""
        return bool(self._sockets)

    @property
    def away(self) -> float:
        """Seconds for which no page has been connected."""
        return 0.0 if self.connected else time.monotonic() - self._left

    def expect(self) -> None:
        """Count the time without a page from this moment on."""
        self._left = time.monotonic()

    async def start(self, secret: str) -> dict[str, Any]:
        """Start the trame server, and return what it wants served: folders, by route."""
        server = self.app.server
        bound: list[Any] = []
        self.app.stream.watched = lambda: self.connected
        server.state.trame__template_error = ENDED.read_text(encoding="utf-8")
        # Defaults of trame's own command line reach it without showing up in a list of processes.
        server.cli.set_defaults(authKey=secret)
        server.controller.on_server_bind.add(bound.append)
        with _trame_kept_quiet():
            self._task = server.start(
                exec_mode="task",
                backend="generic",
                port=0,
                timeout=0,
                thread=True,
                open_browser=False,
                show_connection_info=False,
                disable_logging=True,
            )
        await server.ready
        self._endpoint = bound[0].ws
        static: dict[str, Any] = bound[0].config["static"]
        return static

    async def connect(self, request: web.Request, *, shared: bool) -> web.StreamResponse:
        """Carry messages between a page and its application until one of them ends."""
        socket = web.WebSocketResponse(
            max_msg_size=MAX_MSG_SIZE + OVERHEAD, heartbeat=HEARTBEAT, compress=False
        )
        await socket.prepare(request)
        earlier = [] if shared else list(self._sockets)
        self._sockets.add(socket)
        for other in earlier:
            await other.close(code=WSCloseCode.GOING_AWAY, message=b"opened in another page")

        async def send(is_binary: bool, content: Any) -> None:  # noqa: FBT001 wslink's call
            with suppress(ConnectionError):  # the page has gone, which the loop below is told
                await (socket.send_bytes if is_binary else socket.send_str)(content)

        link = await self._endpoint.connect()
        self._endpoint.unchunkers[link.client_id] = Messages()
        link.on_message(send)
        try:
            async for message in socket:
                if message.type in (WSMsgType.BINARY, WSMsgType.TEXT):
                    await link.send(message.type == WSMsgType.BINARY, message)
        except Exception as error:  # a message that no page of ours sends
            _log.warning("a connection was ended: %s: %s", type(error).__name__, error)
            await socket.close(code=WSCloseCode.POLICY_VIOLATION)
        finally:
            self._sockets.discard(socket)
            self.expect()
            # wslink's endpoint forgets the connection, but not what it has gathered for it.
            await self._endpoint.onClose(link.client_id)
            self._endpoint.authentified_client_ids.discard(link.client_id)
            await link.close()
        return socket

    async def is_free(self) -> bool:
        """Wait a little until no page is connected, and tell whether that is so."""
        end = time.monotonic() + PATIENCE
        while self.connected and time.monotonic() < end:
            await asyncio.sleep(0.02)
        return not self.connected

    async def end(self) -> None:
        """Close the connection and the application, and forget the trame server."""
        self.routes.close()
        for socket in list(self._sockets):
            with suppress(ConnectionError):
                await socket.close(code=WSCloseCode.GOING_AWAY, message=b"the session has ended")
        try:
            self.app.close()
        finally:
            await self._stop()

    async def _stop(self) -> None:
        server = self.app.server
        await server.stop()
        if self._task is not None:
            await self._task
        AVAILABLE_SERVERS.pop(server.name, None)
        # Each library keeps the server that it used last.
        if CoreServer.server is server:
            CoreServer.server = None
            wslink.server.ws_server = None
        if getattr(HTML_CTX, "_server", None) is server:
            HTML_CTX._server = None


@contextmanager
def _trame_kept_quiet() -> Iterator[None]:
    """Keep trame from reading this program's arguments, and from printing on its own."""
    ours = {"TRAME_ARGS": "", "WSLINK_READY_MSG": ""}
    before = {name: os.environ.get(name) for name in ours}
    os.environ.update(ours)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
