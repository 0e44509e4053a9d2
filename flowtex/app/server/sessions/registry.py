"""The sessions of a server: one for each page, in its process or in one of its own.

A session is known by a token that lives in its browser tab. It waits some minutes for its page, so
that a reloaded page finds its state; then its window, its tasks and its trame server end, or
its process. ``flowtex show`` and ``flowtex demo`` serve a process for each session where the system
can fork (``process.py``); a script and other systems have all in their own process (``local.py``).
"""

from __future__ import annotations

import asyncio
import gc
import logging
import os
import time
from abc import ABC, abstractmethod
from collections.abc import Awaitable, Callable, Iterator
from contextlib import suppress

from aiohttp import WSCloseCode, web
from wslink.protocol import MAX_MSG_SIZE

from flowtex._util.memory import available_bytes, give_back
from flowtex._util.whole_file import remove_stale_folders
from flowtex.app.server.files import Respond
from flowtex.app.server.security import new_secret

#: Pages for each core, at most; pages at rest need none.
PAGES_PER_CORE = 8
#: Memory that a page may come to need, in bytes, as with a screen of 2,560 x 1,600.
PAGE_BYTES = 250e6
#: Seconds without a connection after which a session makes room for a newcomer.
REPLACE_AFTER_S = 30.0
#: Seconds that a page may take to load, between its session and its connection.
LOADING_S = 120.0
#: Seconds for which a page that asks for its session waits for the connection of its earlier self
#: to end. When it does not, the tab has been copied.
RECONNECT_WAIT_S = 2.0
#: Seconds between two signs of life of a connection.
HEARTBEAT_S = 20.0
#: Seconds for which a connection that ends waits for the page to say so too.
CLOSE_S = 2.0
#: What wslink adds to a message, in bytes, at most.
MESSAGE_OVERHEAD_BYTES = 4096
_log = logging.getLogger(__name__)


class Session(ABC):
    """A session, its token, and the connection of its page."""

    def __init__(self, files: str, token: str = "") -> None:
        self.token = token or new_secret()  #: Known to the page alone.
        self.files = files  #: Token below which the files of the session are.
        self.static: dict[str, str] = {}  #: Folders that all pages need, by route.
        #: Called with the reason when the session is lost.
        self.lost: Callable[[str], None] = _log.error
        self._left = time.monotonic()
        self._loading = False
        self._sockets: set[web.WebSocketResponse] = set()

    @property
    def connected(self) -> bool:
        """Whether a page is connected."""
        return bool(self._sockets)

    @property
    def away(self) -> float:
        """Seconds for which no page has been connected."""
        if self.connected:
            return 0.0
        return time.monotonic() - self._left

    def expect(self) -> None:
        """Wait for a page that loads and connects."""
        self._left = time.monotonic()
        self._loading = True

    def is_idle(self, limit: float) -> bool:
        """Return whether no page has been connected for ``limit`` seconds, and none is loading."""
        if self._loading:
            limit = max(limit, LOADING_S)
        return self.away > limit

    @abstractmethod
    async def respond(self, name: str, request: web.Request) -> web.StreamResponse:
        """Answer a request for a file, or an upload."""

    @abstractmethod
    async def carry(self, socket: web.WebSocketResponse) -> None:
        """Carry messages between page and application; raise for one that no page of ours sends."""

    async def connect(self, request: web.Request) -> web.StreamResponse:
        """Connect a page, in place of another one."""
        socket = web.WebSocketResponse(
            max_msg_size=MAX_MSG_SIZE + MESSAGE_OVERHEAD_BYTES,
            heartbeat=HEARTBEAT_S,
            timeout=CLOSE_S,
            compress=False,
        )
        await socket.prepare(request)
        others = list(self._sockets)
        self._sockets.add(socket)
        self._loading = False
        for other in others:
            await other.close(code=WSCloseCode.GOING_AWAY, message=b"opened in another page")
        try:
            await self.carry(socket)
        except Exception as error:  # a message that no page of ours sends
            _log.warning("a connection was ended: %s: %s", type(error).__name__, error)
            await socket.close(code=WSCloseCode.POLICY_VIOLATION)
        finally:
            self._sockets.discard(socket)
            self._left = time.monotonic()
        return socket

    async def disconnect(self) -> None:
        """Close the connection."""
        for socket in list(self._sockets):
            with suppress(ConnectionError):
                await socket.close(code=WSCloseCode.GOING_AWAY, message=b"the session has ended")

    @abstractmethod
    async def end(self) -> None:
        """Close the connection and end the session."""


#: Opens a session.
OpenSession = Callable[[], Awaitable[Session]]


class UnavailableError(Exception):
    """No session can be opened; the text gives the reason."""


def usual_limit() -> int:
    """Return the maximum number of sessions of this machine or container."""
    try:
        cores = len(os.sched_getaffinity(0))
    except AttributeError:  # neither Linux nor a BSD
        cores = os.cpu_count() or 1
    return int(max(2, min(PAGES_PER_CORE * cores, available_bytes() // PAGE_BYTES)))


class Sessions:
    """At most ``limit`` sessions; one without a connection for ``idle`` minutes ends."""

    def __init__(self, open_session: OpenSession, *, limit: int, idle: float) -> None:
        self.limit = limit
        self.idle = idle
        self._open = open_session
        self._by_token: dict[str, Session] = {}
        self._ready: Session | None = None
        self._opening = asyncio.Lock()
        self._closed = False

    def __iter__(self) -> Iterator[Session]:
        return iter(list(self._by_token.values()))

    def get(self, token: str) -> Session | None:
        """Return the session of a token."""
        return self._by_token.get(token)

    def files(self, token: str) -> Respond | None:
        """Return the handler of file requests for the token of a session's files."""
        for session in self:
            if session.files == token:
                return session.respond
        return None

    async def prepare(self) -> dict[str, str]:
        """Open the first session, whose errors so appear early; return the folders of all pages."""
        self._ready = await self._begin()
        return self._ready.static

    async def find(self, token: str | None) -> Session:
        """Return the session with the token of a page, or a new one where there is room.

        When another page is connected with the token, such as a copied tab, the page gets its own
        session.

        Raises
        ------
        UnavailableError
            When the limit of pages is reached, and none of them has been away for long.
        """
        session = self._by_token.get(token or "")
        if session is not None:
            end = time.monotonic() + RECONNECT_WAIT_S
            while session.connected and time.monotonic() < end:
                await asyncio.sleep(0.02)
            if not session.connected and session.token in self._by_token:
                session.expect()
                return session
        if self._ready is not None:
            session = self._ready
            self._ready = None
            session.expect()
            return session
        async with self._opening:
            if len(self._by_token) >= self.limit:
                oldest = max(self._by_token, key=lambda other: self._by_token[other].away)
                if self._by_token[oldest].away < REPLACE_AFTER_S:
                    if self.limit == 1:
                        pages = "one page"
                    else:
                        pages = f"{self.limit} pages"
                    raise UnavailableError(
                        f"The limit is {pages} at a time, and all are in use. One becomes free "
                        "soon after somebody closes a page."
                    )
                await self.end(oldest)
            session = await self._begin()
            session.expect()
            return session

    async def _begin(self) -> Session:
        """Open a session, and return it registered by its token."""
        session = await self._open()
        if self._closed:  # meanwhile
            await session.end()
            raise UnavailableError("The server is shutting down. Start it again to open this page.")
        self._by_token[session.token] = session
        session.lost = lambda how: self._forget(session, how)
        return session

    def _forget(self, session: Session, how: str) -> None:
        _log.error("a session was lost: %s", how)
        self._by_token.pop(session.token, None)
        if self._ready is session:
            self._ready = None

    async def end(self, token: str) -> None:
        """End the session of a token, and free its memory."""
        await self._end(token)
        # Applications and VTK's objects refer to each other. They are freed here, in the thread of
        # their window, and not by the next collection in any thread. The caller must hold none.
        gc.collect()
        give_back()

    async def _end(self, token: str) -> None:
        session = self._by_token.pop(token, None)
        if session is None:
            return
        try:
            await session.end()
        except Exception:  # an error of one page must not end the others
            _log.exception("a session could not be ended in full")

    async def sweep(self, every: float = 5.0) -> None:
        """End sessions that no page has reopened, as long as the task runs."""
        while True:
            await asyncio.sleep(min(every, max(60 * self.idle / 4, 0.05)))
            # By tokens: a session that the waiting task held would not be freed when it ends.
            for token in list(self._by_token):
                if self._is_abandoned(token):
                    await self.end(token)

    def _is_abandoned(self, token: str) -> bool:
        session = self._by_token.get(token)
        if session is None or session is self._ready:
            return False
        return session.is_idle(60 * self.idle)

    async def close(self) -> None:
        """End all sessions."""
        self._ready = None
        self._closed = True
        # A page does not wait for another one, which may be suspended.
        await asyncio.gather(*(session.disconnect() for session in self))
        await asyncio.gather(*map(self._end, list(self._by_token)))
        gc.collect()
        await asyncio.to_thread(remove_stale_folders)  # of sessions that had to be killed
