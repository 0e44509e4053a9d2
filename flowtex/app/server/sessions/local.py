"""A session in this process: an application on a trame server of its own.

Sessions share fields and their traces, which are never written again. trame starts nothing that
listens: its generic end point takes messages from any caller, here the web server that all pages
share (``site.py``). trame itself would keep the server of a session that has ended for ever.
"""

from __future__ import annotations

import asyncio
import itertools
import logging
import os
from collections.abc import Callable, Container, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import wslink.server
from aiohttp import WSMsgType, web
from trame.app import get_server
from trame.app.core import AVAILABLE_SERVERS
from trame_client.widgets.core import HTML_CTX
from trame_server.protocol import CoreServer
from wslink.chunking import UnChunker

from flowtex.app.server.files import Routes
from flowtex.app.server.page import name_among
from flowtex.app.server.sessions.registry import OpenSession, Session

#: Makes an application on a trame server. An application has ``server``, ``stream`` (a
#: :class:`~flowtex.app.streaming.stream.FrameStream`) and ``close()``.
MakeApp = Callable[[Any], Any]
#: Page that is shown when a session has ended.
ENDED = Path(__file__).parents[2] / "ui" / "static" / "ended.html"
_count = itertools.count(1)
#: Most bytes of a message.
MESSAGE_BYTES = 16_000_000
#: Messages that a page may begin before it ends one.
OPEN_MESSAGES = 4
#: Methods of trame that no page of ours calls.
UNUSED = ("application.exit", "application.exit.later", "trame.rca.push", "trame.rca.drop")
#: Events of a page.
EVENTS = ("client_connected", "client_mounted", "client_unmounted", "client_exited")
#: Characters of the name of a trigger.
NAME_LENGTH = 100
_log = logging.getLogger(__name__)


class LimitedMessages(UnChunker):
    """The messages of one connection, joined from their pieces, within limits.

    wslink reserves room for a message when its first piece announces a length, of up to 4 GB. trame
    keeps whatever a page puts into the state, beyond the ``declared`` names, and prints the names
    of ``areas`` and triggers that it does not know.
    """

    def __init__(self, declared: Container[str] = (), areas: Container[str] = ()) -> None:
        super().__init__()
        self._declared = declared
        self._areas = areas

    def set_max_message_size(self, size: int) -> None:
        """Limit messages to this many bytes, and to the general limit."""
        super().set_max_message_size(min(size, MESSAGE_BYTES))

    def process_chunk(self, chunk: bytes) -> Any:
        """Return the message that a piece completes, or ``None`` while pieces are missing.

        Raises
        ------
        ValueError
            When the message is malformed or too long, or too many messages are incomplete.
        """
        message = super().process_chunk(chunk)
        if len(self.pending_messages) > OPEN_MESSAGES:
            self.release_pending_messages()
            raise ValueError(
                f"more than {OPEN_MESSAGES} messages are incomplete; expected one of them to end "
                "first"
            )
        if isinstance(message, dict):
            return self._checked(message)
        return message

    def _checked(self, message: dict[str, Any]) -> dict[str, Any] | None:
        """Return a message without its invalid parts; ``None`` if it is refused as a whole."""
        method = message.get("method")
        args = message.get("args")
        if isinstance(args, list) and args:
            first = args[0]
        else:
            first = None
        if method == "trame.state.update":
            declared = []
            if isinstance(first, list):
                for change in first:
                    if isinstance(change, dict) and name_among(change.get("key"), self._declared):
                        declared.append(change)
            return {**message, "args": [declared], "kwargs": {}}
        if method == "trame.lifecycle.update":
            if name_among(first, EVENTS):
                return {**message, "kwargs": {}}
            return None
        if method == "trame.trigger":  # trame writes unknown names to the log
            is_plain = isinstance(first, str) and len(first) <= NAME_LENGTH and first.isidentifier()
            if is_plain:
                return message
            return None
        if isinstance(method, str) and method.startswith("trame.rca."):
            if name_among(first, self._areas):
                return {**message, "kwargs": {}}
            return None
        return message


def restrict(endpoint: Any) -> None:
    """Remove unused methods from a wslink endpoint, and tracebacks from its errors."""
    for name in UNUSED:
        endpoint.functionMap.pop(name, None)
    send = endpoint.sendWrappedError

    async def send_error(
        rpcid: Any, code: int, message: str, data: Any = None, client_id: Any = None
    ) -> None:
        if isinstance(data, dict):
            _log.error("%s failed\n%s", data.get("method"), data.get("trace"))
        await send(rpcid, code, message, client_id=client_id)

    endpoint.sendWrappedError = send_error
    # It logs the same in three pieces, in spite of disable_logging.
    logging.getLogger("wslink.protocol").disabled = True


def opener(make_app: MakeApp, secret: str) -> OpenSession:
    """Return a function that opens sessions in this process.

    Parameters
    ----------
    make_app
        Makes the application of a session for its trame server.
    secret
        Word that a connection to a session must send.

    Raises
    ------
    BaseException
        By the returned function: any error of making or starting the application, after the server
        of the session has been removed.
    """

    async def open_session() -> Session:
        server = get_server(f"flowtex-session-{next(_count)}")
        try:
            session = LocalSession(make_app(server))
        except BaseException:
            AVAILABLE_SERVERS.pop(server.name, None)
            raise
        try:
            await session.start(secret)
        except BaseException:
            await session.end()
            raise
        return session

    return open_session


class LocalSession(Session):
    """One application, and the end point of its trame server."""

    def __init__(self, app: Any) -> None:
        self.app = app
        self._routes = Routes.of(app.server)
        super().__init__(self._routes.token)
        self._endpoint: Any = None
        self._task: asyncio.Task[None] | None = None

    async def start(self, secret: str) -> None:
        """Start the trame server of the application."""
        server = self.app.server
        web_servers: list[Any] = []
        self.app.stream.watched = lambda: self.connected
        server.state.trame__template_error = ENDED.read_text(encoding="utf-8")
        # Defaults of trame's own command line reach it without showing up in a list of processes.
        server.cli.set_defaults(authKey=secret)
        server.controller.on_server_bind.add(web_servers.append)
        with _quiet_trame():
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
        self._endpoint = web_servers[0].ws
        restrict(self._endpoint)
        self.static = web_servers[0].config["static"]

    async def respond(self, name: str, request: web.Request) -> web.StreamResponse:
        """Answer a request for a file, or an upload."""
        return await self._routes.respond(name, request)

    async def carry(self, socket: web.WebSocketResponse) -> None:
        """Carry messages between a page and its application until one of them ends.

        Raises
        ------
        ValueError
            When the page sends text; messages are binary.
        """

        async def send(is_binary: bool, content: Any) -> None:  # noqa: FBT001 wslink's call
            with suppress(ConnectionError):  # the page is gone, and the loop below ends
                if is_binary:
                    await socket.send_bytes(content)
                else:
                    await socket.send_str(content)

        link = await self._endpoint.connect()
        # trame-rca's object for all areas of a page, where there is one.
        areas, _ = self._endpoint.functionMap.get("trame.rca.size", (None, None))
        server = self.app.server
        self._endpoint.unchunkers[link.client_id] = LimitedMessages(
            server.state, getattr(areas, "_area_adapters", ())
        )
        link.on_message(send)
        try:
            async for message in socket:
                if message.type == WSMsgType.BINARY:
                    await link.send(True, message)
                elif message.type == WSMsgType.TEXT:
                    raise ValueError("received text; expected bytes")
        finally:
            # wslink's endpoint forgets the connection, but not the data that it holds for it.
            await self._endpoint.onClose(link.client_id)
            self._endpoint.authentified_client_ids.discard(link.client_id)
            await link.close()

    async def end(self) -> None:
        """Close the connection and the application, and forget the trame server."""
        server = self.app.server
        self._routes.close()
        await self.disconnect()
        try:
            self.app.close()
        finally:
            await server.stop()
            if self._task is not None:
                await self._task
            AVAILABLE_SERVERS.pop(server.name, None)
            # Both libraries keep a reference to the server that they used last.
            if CoreServer.server is server:
                CoreServer.server = None
                wslink.server.ws_server = None
            if getattr(HTML_CTX, "_server", None) is server:
                HTML_CTX._server = None


@contextmanager
def _quiet_trame() -> Iterator[None]:
    """Keep trame from reading this program's arguments and from printing."""
    quiet = {"TRAME_ARGS": "", "WSLINK_READY_MSG": ""}
    before = {}
    for name in quiet:
        if name in os.environ:
            before[name] = os.environ[name]
    os.environ.update(quiet)
    try:
        yield
    finally:
        for name in quiet:
            os.environ.pop(name, None)
        os.environ.update(before)
