"""Protection of the page against others.

trame admits everybody who knows a public constant, from the page of any site. So every start has
its own secret, which only the printed address carries; without it a browser gets ``door.html``. The
page may load nothing from elsewhere. For a browser, a site whose name suddenly points to this
machine (DNS rebinding) is still the same site, so the server answers only to numeric addresses and
known names. Connections are limited in number, and requests in time.
"""

from __future__ import annotations

import asyncio
import errno
import hmac
import ipaddress
import logging
import os
import platform
import re
import secrets
import socket as sockets
from collections.abc import Awaitable, Callable, Container, Iterable
from contextlib import suppress
from typing import Any
from urllib.parse import SplitResult, urlsplit

from aiohttp import web

from flowtex.errors import FieldError

#: Names of this machine that only itself can use.
LOCAL = frozenset({"localhost"})
#: Stands for every name.
ANY = "*"

#: The page's own scripts need eval: Vue compiles the templates that trame sends it.
POLICY = (
    "default-src 'self' 'unsafe-inline' 'unsafe-eval' blob: data:; connect-src 'self' ws: wss:"
    " blob: data:; object-src 'none'; base-uri 'self'; frame-ancestors 'self'"
)
HEADERS = {
    "Referrer-Policy": "no-referrer",  # the address carries the secret
    "X-Content-Type-Options": "nosniff",
}

FAULT = "The request failed. The server has printed the reason."

_log = logging.getLogger(__name__)


def new_secret() -> str:
    """Return a secret that cannot be guessed."""
    return secrets.token_urlsafe(24)


def is_same(text: object, secret: str) -> bool:
    """Return whether a secret is correct, in a time that reveals nothing about it."""
    return isinstance(text, str) and hmac.compare_digest(
        text.encode(errors="surrogatepass"), secret.encode()
    )


def known_hosts(host: str, allowed: Iterable[str] = ()) -> frozenset[str]:
    """Return the names of a server that listens on ``host``.

    On JupyterHub, and behind another proxy of Jupyter, any name is valid: the proxy passes on an
    unknown name, and Jupyter's own token guards it.

    Raises
    ------
    FieldError
        When an item of ``allowed`` is not the name of a host, or has a port.
    """
    names = [*LOCAL, host]
    if host in ("0.0.0.0", "::", ""):
        names.append(platform.node())
    if os.environ.get("JUPYTERHUB_SERVICE_PREFIX"):
        names.append(ANY)
    for name in allowed:
        if name != ANY and not re.fullmatch(r"[\w.-]+", name):
            raise FieldError(
                f"allow_host is {name!r}; expected a host name without scheme and port, such as "
                f"'flow.example.org', or {ANY!r} for any"
            )
        names.append(name)
    return frozenset(name.lower() for name in names)


def guard(application: web.Application, *, hosts: Container[str] = LOCAL) -> None:
    """Limit times, refuse other sites and unknown hosts, and write errors only to the log.

    Parameters
    ----------
    application
        The application, to which handlers around each request are added.
    hosts
        Names of hosts under which browsers may ask for pages.

    Raises
    ------
    HTTPForbidden
        By a handler, when a request has another host name or comes from another site.
    HTTPBadRequest
        By a handler, when the body of a request cannot be read.
    HTTPNotFound
        By a handler, when the name of a file is too long.
    HTTPRequestTimeout
        By a handler, when the answer takes longer than ``ANSWER_S``.
    HTTPInternalServerError
        By a handler, in place of any other error, whose text is only logged.
    """

    @web.middleware
    async def own_pages_only(request: web.Request, handler: Handler) -> web.StreamResponse:
        _check_source(request, hosts)
        return await handler(request)

    application.middlewares.extend((_faults_to_log, _in_time, own_pages_only))
    application.on_response_prepare.append(_add_headers)


def _check_source(request: web.Request, hosts: Container[str]) -> None:
    """Refuse a request that has another host name or comes from another site."""
    name = (_split(f"//{request.headers.get('Host', '')}").hostname or "").removesuffix(".")
    if not (ANY in hosts or name in hosts or _is_address(name)):
        words = (
            f"The server does not accept the host name {name[:100]!r}; allow it with "
            "--allow-host NAME.\n"
        )
        raise web.HTTPForbidden(text=words)
    origin = request.headers.get("Origin")
    if origin is not None and _split(origin).netloc not in _own_hosts(request):
        raise web.HTTPForbidden(text="Other sites cannot use this page.\n")


@web.middleware
async def _faults_to_log(request: web.Request, handler: Handler) -> web.StreamResponse:
    """Answer a request; an unexpected error is logged, and not sent."""
    try:
        return await handler(request)
    except web.HTTPException:
        raise
    except web.RequestPayloadError:  # such as a body that is not gzip
        raise web.HTTPBadRequest from None
    except Exception as error:
        if request.transport is None:  # the client no longer waits for the answer
            raise web.HTTPBadRequest from None
        if isinstance(error, OSError) and error.errno == errno.ENAMETOOLONG:
            raise web.HTTPNotFound from None
        # An address contains secrets, so only its pattern is written.
        resource = request.match_info.route.resource
        pattern = ""
        if resource:
            pattern = resource.canonical
        target = f"{request.method} {pattern}"
        expected = isinstance(error, (OSError, FieldError))
        _log.error("%s: %s: %s", target, type(error).__name__, error, exc_info=not expected)
        raise web.HTTPInternalServerError(text=FAULT) from None


@web.middleware
async def _in_time(request: web.Request, handler: Handler) -> web.StreamResponse:
    """Answer a request within ``ANSWER_S``."""
    try:
        async with asyncio.timeout(ANSWER_S) as request[LIMIT]:
            return await handler(request)
    except TimeoutError:
        raise web.HTTPRequestTimeout from None


async def _add_headers(_: web.Request, response: web.StreamResponse) -> None:
    response.headers.update({**HEADERS, "Content-Security-Policy": POLICY})


def _split(address: str) -> SplitResult:
    """Split an address; the parts of a malformed one are empty."""
    try:
        return urlsplit(address)
    except ValueError:
        return urlsplit("")


def _is_address(name: str) -> bool:
    with suppress(ValueError):
        return bool(ipaddress.ip_address(name))
    return False


def _own_hosts(request: web.Request) -> set[str]:
    """Return the host names of the page in a request.

    A proxy keeps the name that the browser used as ``Host``, or passes it on as
    ``X-Forwarded-Host``. A page of another site can set neither: not for a websocket, and otherwise
    the browser asks for permission first, which is refused.
    """
    forwarded = request.headers.get("X-Forwarded-Host", "").split(",")[0].strip()
    return {request.headers.get("Host", ""), forwarded} - {""}


#: Seconds for the head of a request, also the next one of a connection that is kept.
HEAD_S = 30.0
#: Seconds for finding an answer (an upload lasts until it is read).
ANSWER_S = 900.0
#: Most connections at one time.
CONNECTIONS = 512
#: Connections that wait to be let in.
BACKLOG = 64
#: Seconds in which the rest of a request that was answered may come.
LINGER_S = 2.0
#: Seconds in which connections end.
SHUTDOWN_S = 2.0

#: Answers a request.
Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]
#: The time limit of a request.
LIMIT = web.RequestKey("limit", asyncio.Timeout)


class LimitedServer:
    """A web application with ``most`` connections, by default half of the files of the process."""

    def __init__(
        self, application: web.Application, *, most: int | None = None, **options: Any
    ) -> None:
        if most is None:
            self._most = usual_most()
        else:
            self._most = most
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
        name = self._server.sockets[0].getsockname()
        if isinstance(name, tuple):
            return int(name[1])
        return 0

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
        present = 0
        for connection in server.connections:
            transport = connection.transport
            if transport is not None and not transport.is_closing():
                present += 1
        if present < self._most:
            return server()
        return _Refusal()


class _Refusal(asyncio.Protocol):
    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        if isinstance(transport, asyncio.Transport):
            transport.abort()


def usual_most() -> int:
    """Return the maximum number of connections of this process."""
    with suppress(ImportError):  # on Windows
        import resource

        files = resource.getrlimit(resource.RLIMIT_NOFILE)[0]
        if files > 0:
            return max(1, min(CONNECTIONS, files // 2))
        return CONNECTIONS
    return CONNECTIONS
