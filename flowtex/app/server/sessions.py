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

What a process of its own would give is isolation: a crash of one page would not end the others,
and two pages would draw on two cores. What it takes is ten times the memory, a start of seconds,
and a second set of ports and secrets, for pages that stand still most of the time. So there is
one process, and what separates the pages is that they share nothing that can be changed: each has
a trame server, a state, a window, and settings of its own; only fields and their traces are
shared, which are never written again.

A session is known by a token that cannot be guessed and lives in its browser tab. It waits for
its page for some minutes, so that a page that is loaded again comes back to its own state; then
it ends, and with it its window, its tasks and its trame server, which trame itself would keep
for ever.
"""

from __future__ import annotations

import asyncio
import gc
import itertools
import logging
import os
from collections.abc import Callable, Iterator
from typing import Any

from trame.app import get_server
from trame.app.core import AVAILABLE_SERVERS

from flowtex.app.server.routes import Routes
from flowtex.app.server.session import Session

__all__ = ["FullError", "MakeApp", "Sessions", "usual_limit"]

#: Makes an application on a trame server. An application has ``server``, ``stream`` (a
#: :class:`~flowtex.app.streaming.stream.FrameStream`) and ``close()``.
MakeApp = Callable[[Any], Any]

#: Pages for each core, at most, and the memory that each may come to need, in bytes: a screen of
#: 2,560 x 1,600 takes about that much. Pages at rest need no core.
PAGES_PER_CORE, PAGE_BYTES = 8, 250e6
#: Seconds without a connection after which a session makes room for a newcomer.
AWAY = 30.0

_count = itertools.count(1)
_log = logging.getLogger(__name__)


class FullError(Exception):
    """There are as many sessions as may be."""


def usual_limit() -> int:
    """Return how many sessions this machine has room for."""
    try:
        cores = len(os.sched_getaffinity(0))
        free = os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):  # neither Linux nor a BSD
        return PAGES_PER_CORE * (os.cpu_count() or 1)
    return int(max(2, min(PAGES_PER_CORE * cores, free // PAGE_BYTES)))


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
        """Make the first session before anybody asks for it.

        What is wrong with a mesh or a setting is told then, and the first visitor does not wait.

        Parameters
        ----------
        app
            The application of the first session, where there is one already.

        Returns
        -------
        dict
            Folders that all pages want served, by route.
        """
        self._ready, static = await (self._make() if app is None else self._begin(app))
        return static

    async def find(self, token: str | None) -> Session:
        """Return the session of a page: its own, or a new one.

        Parameters
        ----------
        token
            What the page remembers, if anything. When another page is connected with it, such
            as that of a copied tab, the page gets a session of its own.

        Raises
        ------
        FullError
            When there is no room for a new one.
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
            await self._make_room()
            return (await self._make())[0]

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
            await self.end(session)
            raise

    async def _make_room(self) -> None:
        if len(self) < self.limit:
            return
        longest = max(self, key=lambda session: session.away)
        if longest.away < AWAY:
            raise FullError
        await self.end(longest)

    async def end(self, session: Session) -> None:
        """End a session, and leave nothing of it."""
        if self._by_token.pop(session.token, None) is None:
            return
        try:
            await session.end()
        except Exception:  # what one page does wrong must not end the others
            _log.exception("a session could not be ended in full")
        del session
        # Applications and VTK's objects point at each other. They are freed here, where their
        # window was made, and not in whatever thread next fills up.
        gc.collect()

    async def sweep(self, every: float = 5.0) -> None:
        """End sessions that nobody has come back to, for as long as the task lives."""
        while True:
            await asyncio.sleep(min(every, max(60 * self.idle / 4, 0.05)))
            for session in self:
                if session is not self._ready and session.away > 60 * self.idle:
                    await self.end(session)

    async def close(self) -> None:
        """End all sessions."""
        self._ready = None
        for session in self:
            await self.end(session)
