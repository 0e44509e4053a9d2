"""What keeps others out of the page.

trame lets in whoever knows the secret, but its own is a public constant, and it asks no web page
where it comes from: any page open in the same browser could drive the program. So every start
has a secret of its own, which only the printed address carries, and a connection from another
site's page is refused. Who comes without the secret gets a page that says so (``door.html``).
The page itself may load nothing from elsewhere.
"""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Awaitable, Callable
from typing import Any
from urllib.parse import urlsplit

from aiohttp import web

__all__ = ["guard", "is_same", "new_secret"]

#: The page's own scripts need eval: Vue compiles the templates that trame sends it.
POLICY = (
    "default-src 'self' 'unsafe-inline' 'unsafe-eval' blob: data:; connect-src 'self' ws: wss:"
    " blob: data:; object-src 'none'; base-uri 'self'"
)
HEADERS = {
    "Referrer-Policy": "no-referrer",  # the address carries the secret
    "X-Content-Type-Options": "nosniff",
}

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


def new_secret() -> str:
    """Return a secret that cannot be guessed."""
    return secrets.token_urlsafe(24)


def is_same(given: object, secret: str) -> bool:
    """Tell whether a secret is the right one, in a time that tells nothing about it."""
    return isinstance(given, str) and hmac.compare_digest(given.encode(), secret.encode())


def guard(application: web.Application, *, framed: bool = False) -> None:
    """Refuse other sites' pages, and send the headers above with every answer.

    Parameters
    ----------
    application
        What is guarded, before it is started.
    framed
        Whether pages of other sites may hold this one in a frame, as a notebook does.
    """
    policy = POLICY if framed else f"{POLICY}; frame-ancestors 'self'"

    @web.middleware
    async def own_pages_only(request: web.Request, handler: Handler) -> web.StreamResponse:
        origin = request.headers.get("Origin")
        if origin is not None and urlsplit(origin).netloc not in _own_hosts(request):
            raise web.HTTPForbidden(text="This page is not open to other sites.\n")
        return await handler(request)

    async def add_headers(request: Any, response: web.StreamResponse) -> None:
        del request
        response.headers.update({**HEADERS, "Content-Security-Policy": policy})

    application.middlewares.append(own_pages_only)
    application.on_response_prepare.append(add_headers)


def _own_hosts(request: web.Request) -> set[str]:
    """Hosts that the page is known by.

    A proxy keeps the name that the browser used as ``Host``, or hands it on as
    ``X-Forwarded-Host``. A page of another site can set neither: not for a websocket, and for
    anything else the browser asks first, which is refused.
    """
    handed_on = request.headers.get("X-Forwarded-Host", "").split(",")[0].strip()
    return {request.host, handed_on} - {""}
