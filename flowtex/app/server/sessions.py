"""A state of its own for each page: one application object a session, all in one process.

The other way would be one process for each page, as wslink's launcher has it. Both were measured
(two cores, software OpenGL, the cylinder of the examples, a page of 1,000 x 700):

==========================  ===============  ===============
a page more costs           in one process   its own process
==========================  ===============  ===============
time until it answers       0.4 s            6 s
memory                      50 MB            500 MB
traces of the flow          shared           made again
an end that leaves nothing  tested           by the system
==========================  ===============  ===============

A process of its own would isolate pages from a crash of another, and let two draw on two cores,
for ten times the memory and a start of seconds. So there is one process, and pages share nothing
that can be changed: each has a trame server, a state, a window, and settings of its own; only
fields and their traces are shared, which are never written again.

A session is known by a token that cannot be guessed and lives in its browser tab. It waits for
its page for some minutes, so that a page that is loaded again comes back to its own state; then
it ends, and with it its window, its tasks and its trame server, which trame itself would keep for
ever. trame starts nothing that listens: its generic end point takes messages from whoever brings
them, and the web server that all pages share (:mod:`flowtex.app.server.site`) brings them.
"""

from __future__ import annotations

import asyncio
import gc
import itertools
import logging
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import wslink.server
from aiohttp import WSCloseCode, WSMsgType, web
from trame.app import get_server
from trame.app.core import AVAILABLE_SERVERS
from trame_client.widgets.core import HTML_CTX
from trame_server.protocol import CoreServer
from wslink.protocol import MAX_MSG_SIZE

from flowtex._util.memory import available_bytes, give_back
from flowtex.app.server.files import Routes
from flowtex.app.server.messages import LimitedMessages, restrict
from flowtex.app.server.security import new_secret

#: Makes an application on a trame server. An application has ``server``, ``stream`` (a
#: :class:`~flowtex.app.streaming.stream.FrameStream`) and ``close()``.
MakeApp = Callable[[Any], Any]

#: Pages for each core, at most, and the memory that each may come to need, in bytes: a screen of
#: 2,560 x 1,600 takes about that much. Pages at rest need no core.
PAGES_PER_CORE, PAGE_BYTES = 8, 250e6
#: Seconds without a connection after which a session makes room for a newcomer.
REPLACE_AFTER_S = 30.0
#: Seconds that a page may take to load, between its session and its connection.
LOADING_S = 120.0
#: Seconds for which a page that asks for its session waits for the connection of its earlier self
#: to end. When it does not, somebody has made a copy of the tab.
RECONNECT_WAIT_S = 2.0
#: Seconds between two signs of life of a connection.
HEARTBEAT_S = 20.0
#: Seconds for which a connection that ends waits for the page to say so too.
CLOSE_S = 2.0
#: What wslink adds to a message, in bytes, at most.
MESSAGE_OVERHEAD_BYTES = 4096
#: What the page shows when its session has ended.
ENDED = Path(__file__).parents[1] / "ui" / "static" / "ended.html"

_count = itertools.count(1)
_log = logging.getLogger(__name__)


class Session:
    """One application, the token that its page is known by, and the connection of the page."""

    def __init__(self, app: Any) -> None:
        self.token = new_secret()
        self.app = app
        self.routes = Routes.of(app.server)
        self._left = time.monotonic()
        self._loading = False
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
        """Give a page time to load, and to connect."""
        self._left, self._loading = time.monotonic(), True

    def is_idle(self, limit: float) -> bool:
        """Whether no page has been connected for ``limit`` seconds, and none is loading."""
        return self.away > max(limit, LOADING_S if self._loading else 0.0)

    async def start(self, secret: str) -> dict[str, Any]:
        """Start the trame server, and return what it wants served: folders, by route."""
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
        static: dict[str, Any] = web_servers[0].config["static"]
        return static

    async def connect(self, request: web.Request, *, shared: bool) -> web.StreamResponse:
        """Carry messages between a page and its application until one of them ends."""
        socket = web.WebSocketResponse(
            max_msg_size=MAX_MSG_SIZE + MESSAGE_OVERHEAD_BYTES,
            heartbeat=HEARTBEAT_S,
            timeout=CLOSE_S,
            compress=False,
        )
        await socket.prepare(request)
        others = [] if shared else list(self._sockets)
        self._sockets.add(socket)
        self._loading = False
        for other in others:
            await other.close(code=WSCloseCode.GOING_AWAY, message=b"opened in another page")

        async def send(is_binary: bool, content: Any) -> None:  # noqa: FBT001 wslink's call
            with suppress(ConnectionError):  # the page has gone, which the loop below is told
                await (socket.send_bytes if is_binary else socket.send_str)(content)

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
                    msg = "a text came; expected bytes"
                    raise ValueError(msg)
        except Exception as error:  # a message that no page of ours sends
            _log.warning("a connection was ended: %s: %s", type(error).__name__, error)
            await socket.close(code=WSCloseCode.POLICY_VIOLATION)
        finally:
            self._sockets.discard(socket)
            self._left = time.monotonic()
            # wslink's endpoint forgets the connection, but not what it has gathered for it.
            await self._endpoint.onClose(link.client_id)
            self._endpoint.authentified_client_ids.discard(link.client_id)
            await link.close()
        return socket

    async def is_free(self) -> bool:
        """Wait a little until no page is connected, and tell whether that is so."""
        end = time.monotonic() + RECONNECT_WAIT_S
        while self.connected and time.monotonic() < end:
            await asyncio.sleep(0.02)
        return not self.connected

    async def disconnect(self) -> None:
        """Close the connection."""
        for socket in list(self._sockets):
            with suppress(ConnectionError):
                await socket.close(code=WSCloseCode.GOING_AWAY, message=b"the session has ended")

    async def end(self) -> None:
        """Close the connection and the application, and forget the trame server."""
        self.routes.close()
        await self.disconnect()
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


class FullError(Exception):
    """There are as many sessions as may be."""


class ClosedError(Exception):
    """The server ends, and makes no more sessions."""


def usual_limit() -> int:
    """Return how many sessions this machine, or this container, has room for."""
    try:
        cores = len(os.sched_getaffinity(0))
    except AttributeError:  # neither Linux nor a BSD
        cores = os.cpu_count() or 1
    return int(max(2, min(PAGES_PER_CORE * cores, available_bytes() // PAGE_BYTES)))


class Sessions:
    """The sessions of one start.

    Parameters
    ----------
    make_app
        Makes an application on a trame server.
    secret
        What a connection has to know.
    limit
        Sessions at one time, at most.
    idle
        Minutes without a connection after which a session ends.
    shared
        Whether all pages have the first session together, as the cells of a notebook.
    """

    def __init__(
        self, make_app: MakeApp, secret: str, *, limit: int, idle: float, shared: bool = False
    ) -> None:
        self.limit = limit
        self.idle = idle
        self.shared = shared
        self._make_app = make_app
        self._secret = secret
        self._by_token: dict[str, Session] = {}
        self._ready: Session | None = None
        self._making = asyncio.Lock()
        self._closed = False

    def __len__(self) -> int:
        return len(self._by_token)

    def __iter__(self) -> Iterator[Session]:
        return iter(list(self._by_token.values()))

    def get(self, token: str) -> Session | None:
        """Return the session of a token."""
        return self._by_token.get(token)

    def routes(self, token: str) -> Routes | None:
        """Return the routes of a token; it is not that of the session itself."""
        return next((s.routes for s in self if s.routes.token == token), None)

    async def prepare(self, app: Any = None) -> dict[str, Any]:
        """Make the first session, of an application that there is already if any.

        What is wrong with a mesh or a setting is told then, and the first visitor does not wait.
        Returns the folders that all pages want served, by route.
        """
        self._ready, static = await (self._make() if app is None else self._begin(app))
        return static

    async def find(self, token: str | None) -> Session:
        """Return the session of a page: that of its token, or a new one where there is room.

        When another page is connected with the token, such as that of a copied tab, the page gets
        a session of its own.
        """
        if self.shared and self._ready is not None:
            return self._ready
        session = self._by_token.get(token or "")
        if session is not None and await session.is_free() and session.token in self._by_token:
            session.expect()
            return session
        if self._ready is not None:
            session, self._ready = self._ready, None
            session.expect()
            return session
        async with self._making:
            if self._closed:
                raise ClosedError
            await self._make_room()
            session, _ = await self._make()
            session.expect()
            return session

    async def _make(self) -> tuple[Session, dict[str, Any]]:
        server = get_server(f"flowtex-session-{next(_count)}")
        try:
            app = self._make_app(server)
        except BaseException:
            AVAILABLE_SERVERS.pop(server.name, None)
            raise
        return await self._begin(app)

    async def _begin(self, app: Any) -> tuple[Session, dict[str, Any]]:
        session = Session(app)
        self._by_token[session.token] = session
        try:
            return session, await session.start(self._secret)
        except BaseException:
            await self.end(session.token)
            raise

    async def _make_room(self) -> None:
        if len(self) < self.limit:
            return
        token = max(self._by_token, key=lambda token: self._by_token[token].away)
        if self._by_token[token].away < REPLACE_AFTER_S:
            raise FullError
        await self.end(token)

    async def end(self, token: str) -> None:
        """End the session of a token, and leave nothing of it."""
        await self._end(token)
        # Applications and VTK's objects point at each other. They are freed here, where their
        # window was made, and not in whatever thread next fills up. So who calls this holds none.
        gc.collect()
        give_back()

    async def _end(self, token: str) -> None:
        session = self._by_token.pop(token, None)
        if session is None:
            return
        try:
            await session.end()
        except Exception:  # what one page does wrong must not end the others
            _log.exception("a session could not be ended in full")

    async def sweep(self, every: float = 5.0) -> None:
        """End sessions that nobody has come back to, for as long as the task lives."""
        while True:
            await asyncio.sleep(min(every, max(60 * self.idle / 4, 0.05)))
            for token in list(self._by_token):
                if self._is_idle(token):
                    await self.end(token)

    def _is_idle(self, token: str) -> bool:
        session = self._by_token.get(token)
        return session not in (None, self._ready) and session.is_idle(60 * self.idle)

    async def close(self) -> None:
        """End all sessions."""
        self._ready, self._closed = None, True
        # No page waits for another one, which may be asleep.
        await asyncio.gather(*(session.disconnect() for session in self))
        while self._by_token:
            await self._end(next(iter(self._by_token)))
        gc.collect()


@contextmanager
def _quiet_trame() -> Iterator[None]:
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
