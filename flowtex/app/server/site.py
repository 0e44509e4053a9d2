"""The web server that all pages share: the door, the pages' files, and their connections.

``GET /`` is the door, which keeps secret and session in the browser's tab, and gets these by ``POST
/flowtex/session``. A page, its connection and its files have addresses with tokens. trame's client
looks for its connection beside its page. It accepts another address, but writes it in lower case,
which breaks the tokens and the paths of some proxies.
"""

from __future__ import annotations

import asyncio
import json
import logging
import math
import os
import signal
import socket as sockets
import time
import webbrowser
from collections.abc import Awaitable, Callable, Container, Iterable, Iterator
from contextlib import contextmanager, suppress
from html import escape
from pathlib import Path

from aiohttp import web
from aiohttp.http_exceptions import HttpProcessingError

from flowtex._util.arguments import checked_number
from flowtex._util.terminal import SIGNALS, Ended, announce_end, usual_interrupts
from flowtex._util.whole_file import TemporaryFolder
from flowtex.app.server.files import add_route
from flowtex.app.server.security import (
    FAULT,
    HEAD_S,
    LIMIT,
    LOCAL,
    LimitedServer,
    guard,
    is_same,
    known_hosts,
)
from flowtex.app.server.sessions.registry import (
    OpenSession,
    Sessions,
    UnavailableError,
    usual_limit,
)
from flowtex.errors import FieldError
from flowtex.rendering.diagnostics import has_display

DOOR = Path(__file__).parents[1] / "ui" / "static" / "door.html"
#: Minutes for which a session waits for its page.
IDLE_MINUTES = 15.0
#: Most bytes of a request of the door.
REQUEST_BYTES = 4096
WRONG = "This page opens only with the complete address that flowtex printed, including the secret."
MALFORMED = "This request is not valid for this page."
_log = logging.getLogger(__name__)
#: Records of one place in the code that are written in a window.
MOST_RECORDS = 5
#: Seconds of a window.
WINDOW_S = 60.0
#: Characters of a message, or of a traceback.
MESSAGE_LENGTH = 8_000
#: Errors caused by clients, whose tracebacks are not logged.
OTHERS_FAULTS = HttpProcessingError, web.RequestPayloadError


class ServeError(FieldError):
    """The page cannot be served; the text gives the reason and the remedy.

    Examples
    --------
    >>> import flowtex
    >>> from flowtex.app import serve
    >>> serve(flowtex.examples.airfoil_field(), port=-1)
    Traceback (most recent call last):
    flowtex.app.server.site.ServeError: port is -1; expected 0 to 65535
    """


class Site:
    """Pages on one port, behind a secret; hosts are those of :func:`guard`."""

    def __init__(self, sessions: Sessions, secret: str, *, hosts: Container[str] = LOCAL) -> None:
        self.sessions = sessions
        self.port = 0
        self._secret = secret
        self._hosts = hosts
        self._server: LimitedServer | None = None
        self._sweep: asyncio.Task[None] | None = None

    async def listen(self, endpoint: sockets.socket | tuple[str, int] = ("127.0.0.1", 0)) -> None:
        """Open the first session; admit pages at a host and port, or on a listening socket."""
        self._server = LimitedServer(self._application(await self.sessions.prepare()))
        self.port = await self._server.start(endpoint)
        self._sweep = asyncio.create_task(self.sessions.sweep())

    async def stop(self) -> None:
        """End all sessions, and stop listening."""
        if self._sweep is not None:
            self._sweep.cancel()
            with suppress(asyncio.CancelledError):
                await self._sweep
        await self.sessions.close()
        if self._server is not None:
            await self._server.stop()

    def _application(self, static: dict[str, str]) -> web.Application:
        application = web.Application(client_max_size=REQUEST_BYTES)
        guard(application, hosts=self._hosts)
        router = application.router
        router.add_get("/", self._door)
        router.add_get("/index.html", self._door)
        router.add_get("/page/{token}/index.html", self._page)
        router.add_get("/page/{token}/ws", self._connection)
        router.add_post("/flowtex/session", self._session)
        add_route(application, self.sessions.files)
        index = (Path(static["/"]) / "index.html").read_text(encoding="utf-8")
        # Everything but the connection is two folders above; the first base has precedence.
        self._index = index.replace("<head>", '<head><base href="../../" />', 1)
        # The longest first: the last one is the root, which matches everything.
        for route in sorted(static, reverse=True):
            router.add_static(f"/{route.strip('/')}", static[route])
        return application

    async def _door(self, _request: web.Request) -> web.StreamResponse:
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
        request[LIMIT].reschedule(None)  # a connection has no time limit
        return await session.connect(request)

    async def _session(self, request: web.Request) -> web.StreamResponse:
        try:
            async with asyncio.timeout(HEAD_S):
                secret, token = _secret_and_token(await request.read())
        except ValueError:
            return _answer(400, words=MALFORMED)
        if not is_same(secret, self._secret):
            return _answer(403, words=WRONG)
        try:
            session = await self.sessions.find(token)
        except UnavailableError as error:
            return _answer(503, words=str(error))
        except (FieldError, OSError) as error:
            return _answer(500, words=f"The page could not be opened: {error}")
        except Exception:
            _log.exception("a page could not be opened")
            return _answer(500, words=FAULT)
        return _answer(200, session=session.token)


def _secret_and_token(body: bytes) -> tuple[str, str | None]:
    """Return the secret and token that a door sends; a ValueError without valid texts."""
    try:
        request = json.loads(body)
        secret = request["secret"]
        token = request.get("session")
    except (RecursionError, LookupError, TypeError, AttributeError):
        raise ValueError(MALFORMED) from None
    if not isinstance(secret, str) or not isinstance(token, str | None):
        raise ValueError(MALFORMED)
    f"{secret}{token}".encode()  # half of a surrogate pair is a UnicodeError, which is a ValueError
    return secret, token


def _answer(status: int, **values: str) -> web.Response:
    return web.json_response(values, status=status, headers={"Cache-Control": "no-store"})


def serve_sessions(
    open_session: OpenSession,
    secret: str,
    *,
    host: str,
    port: int,
    allow_host: Iterable[str] = (),
    limit: int | None = None,
    idle: float = IDLE_MINUTES,
    open_browser: bool,
    announce: Callable[[str], None],
) -> None:
    """Serve sessions until Ctrl-C; :func:`flowtex.app.serve` has the arguments and the errors."""
    if limit is not None:
        checked_number("limit", limit, 1, expected="1 or more pages", error=ServeError)
    for name, value, low, high, expected in (
        ("port", port, 0, 65535, "0 to 65535"),
        ("idle", idle, math.ulp(0.0), math.inf, "a positive number of minutes"),
    ):
        checked_number(name, value, low, high, expected=expected, error=ServeError)
    hosts = known_hosts(host, allow_host)

    async def serve() -> None:
        sessions = Sessions(open_session, limit=limit or usual_limit(), idle=idle)
        site = Site(sessions, secret, hosts=hosts)

        async def listen() -> int:
            await site.listen((host, port))
            return site.port

        await serve_until_ended(
            listen,
            site.stop,
            (host, port, f"?secret={secret}"),
            announce=announce,
            open_browser=open_browser and has_display(),
        )

    with suppress(KeyboardInterrupt, asyncio.CancelledError), usual_interrupts():
        asyncio.run(serve())


async def serve_until_ended(
    listen: Callable[[], Awaitable[int]],
    stop: Callable[[], Awaitable[None]],
    endpoint: tuple[str, int, str],
    *,
    announce: Callable[[str], None],
    open_browser: bool,
) -> None:
    """Serve until the task is cancelled, or a signal ends the process.

    Parameters
    ----------
    listen
        Starts the server, and returns its port.
    stop
        Stops the server.
    endpoint
        Host, port and the rest of the address of the page.
    announce
        Called with the address when the server listens.
    open_browser
        Whether the page is opened in the browser of this machine.

    Raises
    ------
    ServeError
        When the port cannot be used, as when another program listens there.
    Ended
        When a signal ended the server, after it has stopped.
    """
    host, port, rest = endpoint
    main = asyncio.current_task()
    loop = asyncio.get_running_loop()
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
            raise ServeError(
                f"cannot listen on {host}:{port} ({error.strerror or error}); choose another "
                "port, or 0 for a free one"
            ) from error
        address = f"http://{_host_name(host)}:{port}/{rest}"
        announce(address)
        if open_browser:
            folder = TemporaryFolder()  # removed with the variable
            loop.run_in_executor(None, webbrowser.open, _redirection(address, folder.path))
        with suppress(asyncio.CancelledError), bounded_log():
            await asyncio.Event().wait()
    finally:
        await stop()
        if received:
            raise Ended(received[0])


def _host_name(host: str) -> str:
    if host in ("0.0.0.0", "::", ""):
        if hasattr(os, "uname"):
            return os.uname().nodename
        return "localhost"
    if ":" in host:
        return f"[{host}]"
    return host


def _redirection(address: str, folder: Path) -> str:
    """Write a page, for this user alone, that redirects to an address; return its URL."""
    # Other users can read the arguments of a browser in the list of processes.
    file = folder / "flowtex.html"
    file.touch(0o600)
    file.write_text(f'<meta http-equiv="refresh" content="0; url={escape(address)}">', "utf-8")
    return file.as_uri()


class RepeatFilter(logging.Filter):
    """Drops repeated records, and shortens long ones; ``clock`` is in seconds."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        super().__init__()
        self._clock = clock
        #: For each place in the code: when its window began, and its records since.
        self._windows: dict[object, tuple[float, int]] = {}

    def filter(self, record: logging.LogRecord) -> bool:
        """Return whether a record is written; cut it, and keep tracebacks of defects only."""
        if record.exc_info:
            kind = record.exc_info[0]
        else:
            kind = None
        place = (record.pathname, record.lineno, kind)
        now = self._clock()
        began, count = self._windows.get(place, (now, 0))
        if now - began >= WINDOW_S:
            began = now
            count = 0
        self._windows[place] = began, count + 1
        if count >= MOST_RECORDS:
            return False
        record.msg = _cut(record.getMessage())
        record.args = ()
        if kind and issubclass(kind, OTHERS_FAULTS):
            record.exc_info = record.exc_text = None
        elif record.exc_info:
            record.exc_text = _cut(logging.Formatter().formatException(record.exc_info))
        return True


def _cut(text: str) -> str:
    half = MESSAGE_LENGTH // 2
    if len(text) <= MESSAGE_LENGTH:
        return text
    return f"{text[:half]} … {text[-half:]}"


@contextmanager
def bounded_log() -> Iterator[None]:
    """Filter the log of this process, including that of libraries."""
    handlers = logging.getLogger().handlers or [logging.lastResort or logging.NullHandler()]
    repeats = RepeatFilter()
    for handler in handlers:
        handler.addFilter(repeats)
    try:
        yield
    finally:
        for handler in handlers:
            handler.removeFilter(repeats)
