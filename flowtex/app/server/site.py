"""The web server that all pages share: the door, the pages' files, and their connections.

::

    GET  /                         the door: keeps secret and session in the browser's tab
    POST /flowtex/session          secret and token for a token: of one's own session, or a new one
    GET  /page/<token>/index.html  trame's page with ?secret=..., without it the door
    GET  /page/<token>/ws          the connection of a session
    GET  /flowtex/<token>/<name>   what a session hands out
    GET  /...                      scripts and styles, the same for all pages

trame's client looks for its connection beside its page. It can be told another address, but
writes that in small letters, which loses the tokens and the paths of some proxies.
"""

from __future__ import annotations

import asyncio
import json
import logging
import os
import signal
import socket as sockets
import webbrowser
from collections.abc import Awaitable, Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from aiohttp import web

from flowtex._util.ending import SIGNALS, Ended, announce_end
from flowtex.app.server.files import add_route
from flowtex.app.server.security import guard, is_same, new_secret
from flowtex.app.server.sessions import FullError, MakeApp, Sessions
from flowtex.errors import FieldError
from flowtex.settings import SettingsError

__all__ = ["ServeError", "Site", "run_site", "serve_until_ended"]

DOOR = Path(__file__).parents[1] / "ui" / "static" / "door.html"
#: Seconds that connections have to end in.
SHUTDOWN_S = 2.0
#: Bytes of what the door sends, at most.
REQUEST_BYTES = 4096

WRONG = "This page opens with the whole address that flowtex printed, the secret included."
FULL = (
    "There is room for {pages} at a time here, and all places are taken. One becomes free soon "
    "after somebody closes a page."
)
BROKEN = "The page could not be made: {error}"
FAULT = "The page could not be made. The program that serves it has printed why."

_log = logging.getLogger(__name__)


class ServeError(RuntimeError):
    """The page cannot be served; the text says why and what to do.

    Examples
    --------
    >>> import flowtex
    >>> from flowtex.app import serve
    >>> serve(flowtex.examples.airfoil_field(), port=-1)
    Traceback (most recent call last):
    flowtex.app.server.site.ServeError: port is -1; expected 0 to 65535
    """


class Site:
    """Pages on one port.

    Parameters
    ----------
    sessions
        The sessions of the pages.
    secret
        What the door asks for.
    framed
        Whether pages of other sites may hold these in a frame, as a notebook does.
    """

    def __init__(self, sessions: Sessions, secret: str, *, framed: bool = False) -> None:
        self.sessions = sessions
        self.port = 0
        self._secret = secret
        self._framed = framed
        self._runner: web.AppRunner | None = None
        self._sweep: asyncio.Task[None] | None = None

    async def prepare(self, app: Any = None) -> None:
        """Make the first session, with an application that there is already if any."""
        application = self._application(await self.sessions.prepare(app))
        # What ends the program is told to it, and not to the web server.
        self._runner = web.AppRunner(
            application, handle_signals=False, access_log=None, shutdown_timeout=SHUTDOWN_S
        )
        await self._runner.setup()

    async def listen(self, where: sockets.socket | tuple[str, int] = ("127.0.0.1", 0)) -> None:
        """Let pages in, after :meth:`prepare`, at a host and port, or on a socket that listens."""
        if self._runner is None:
            msg = "nothing is there to let in to; call prepare() first"
            raise RuntimeError(msg)
        site: web.BaseSite = (
            web.TCPSite(self._runner, *where)
            if isinstance(where, tuple)
            else web.SockSite(self._runner, where)
        )
        await site.start()
        self.port = self._runner.addresses[0][1]
        self._sweep = asyncio.create_task(self.sessions.sweep())

    async def stop(self) -> None:
        """End all sessions, and listen no more."""
        if self._sweep is not None:
            self._sweep.cancel()
            with suppress(asyncio.CancelledError):
                await self._sweep
        await self.sessions.close()
        if self._runner is not None:
            await self._runner.cleanup()

    def _application(self, static: dict[str, Any]) -> web.Application:
        application = web.Application(client_max_size=REQUEST_BYTES)
        guard(application, framed=self._framed)
        router = application.router
        router.add_get("/", self._door)
        router.add_get("/index.html", self._door)
        router.add_get("/page/{token}/index.html", self._page)
        router.add_get("/page/{token}/ws", self._connection)
        router.add_post("/flowtex/session", self._session)
        add_route(application, self.sessions.routes)
        index = (Path(static["/"]) / "index.html").read_text(encoding="utf-8")
        # Everything but the connection lies two folders above; the first base counts.
        self._index = index.replace("<head>", '<head><base href="../../" />', 1)
        # The longest first: the last one is the root, which would take all.
        for route in sorted(static, reverse=True):
            router.add_static(f"/{route.strip('/')}", static[route])
        return application

    async def _door(self, request: web.Request) -> web.StreamResponse:
        del request
        return web.FileResponse(DOOR, headers={"Cache-Control": "no-store"})

    async def _page(self, request: web.Request) -> web.StreamResponse:
        if "secret" not in request.query:  # a page that is loaded again
            return await self._door(request)
        return web.Response(
            text=self._index, content_type="text/html", headers={"Cache-Control": "no-store"}
        )

    async def _connection(self, request: web.Request) -> web.StreamResponse:
        session = self.sessions.get(request.match_info["token"])
        if session is None:
            raise web.HTTPNotFound
        return await session.connect(request, shared=self.sessions.shared)

    async def _session(self, request: web.Request) -> web.StreamResponse:
        request_data = await _json(request)
        if not is_same(request_data.get("secret"), self._secret):
            return _answer(403, words=WRONG)
        token = request_data.get("session")
        try:
            session = await self.sessions.find(token if isinstance(token, str) else None)
        except FullError:
            return _answer(503, words=FULL.format(pages=_pages(self.sessions.limit)))
        except (FieldError, SettingsError, OSError) as error:
            return _answer(500, words=BROKEN.format(error=error))
        except Exception:
            _log.exception("a page could not be made")
            return _answer(500, words=FAULT)
        return _answer(200, session=session.token)


def _pages(count: int) -> str:
    return "one page" if count == 1 else f"{count} pages"


async def _json(request: web.Request) -> dict[str, Any]:
    try:
        request_data = json.loads(await request.read())
    except ValueError:
        request_data = None
    return request_data if isinstance(request_data, dict) else {}


def _answer(status: int, **values: str) -> web.Response:
    return web.json_response(values, status=status, headers={"Cache-Control": "no-store"})


async def run_site(
    make_app: MakeApp,
    host: str,
    port: int,
    *,
    limit: int,
    idle: float,
    announce: Callable[[str], None],
    open_browser: bool,
) -> None:
    """Serve pages until the task is cancelled; :func:`flowtex.app.serve` has the parameters."""
    secret = new_secret()
    site = Site(Sessions(make_app, secret, limit=limit, idle=idle), secret)

    async def listen() -> int:
        await site.prepare()
        await site.listen((host, port))
        return site.port

    await serve_until_ended(
        listen,
        site.stop,
        (host, port, f"?secret={secret}"),
        announce=announce,
        open_browser=open_browser,
    )


async def serve_until_ended(
    listen: Callable[[], Awaitable[int]],
    stop: Callable[[], Awaitable[None]],
    where: tuple[str, int, str],
    *,
    announce: Callable[[str], None],
    open_browser: bool,
) -> None:
    """Serve until the task is cancelled, or a signal raises :class:`Ended`.

    ``listen`` returns the port; ``where`` is host, port and the rest of the address.
    """
    host, port, rest = where
    main, loop = asyncio.current_task(), asyncio.get_running_loop()
    received: list[int] = []

    def end(number: int) -> None:
        received.append(number)
        announce_end(number)
        if main is not None:
            main.cancel()

    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            with suppress(NotImplementedError):  # on Windows
                loop.add_signal_handler(number, end, number)
    try:
        try:
            port = await listen()
        except OSError as error:
            msg = (
                f"cannot listen on {host}:{port} ({error.strerror or error}); choose another port, "
                "or 0 for one that is free"
            )
            raise ServeError(msg) from error
        address = f"http://{_host_name(host)}:{port}/{rest}"
        announce(address)
        if open_browser:
            _open(address)
        with suppress(asyncio.CancelledError):
            await asyncio.Event().wait()
    finally:
        await stop()
        if received:
            raise Ended(received[0])


def _host_name(host: str) -> str:
    """Name of this machine in an address."""
    if host in ("0.0.0.0", "::", ""):
        return os.uname().nodename if hasattr(os, "uname") else "localhost"
    return f"[{host}]" if ":" in host else host


def _open(address: str) -> None:
    """Open a browser without waiting for it; where there is none, the address is printed."""

    def in_thread() -> None:
        with suppress(webbrowser.Error):
            webbrowser.open(address)

    asyncio.get_running_loop().run_in_executor(None, in_thread)
