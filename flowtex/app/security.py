"""What keeps others out of the page.

trame lets in whoever knows the secret, but its own is a public constant, and it asks no web page
where it comes from: any page open in the same browser could drive the program. So every start
has a secret of its own, which only the printed address carries, and a connection from another
site's page is refused. Who comes without the secret gets a page that says so (``door.html``).
The page itself may load nothing from elsewhere.
"""

from __future__ import annotations

import secrets
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from aiohttp import web

__all__ = ["guard", "new_secret"]

DOOR = Path(__file__).with_name("static") / "door.html"

HEADERS = {
    # The page's own scripts need eval: Vue compiles the templates that trame sends it.
    "Content-Security-Policy": (
        "default-src 'self' 'unsafe-inline' 'unsafe-eval' blob: data:; connect-src 'self' ws: wss:;"
        " object-src 'none'; base-uri 'self'"
    ),
    "Referrer-Policy": "no-referrer",  # the address carries the secret
    "X-Content-Type-Options": "nosniff",
}

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


def new_secret() -> str:
    """Return a secret that cannot be guessed."""
    return secrets.token_urlsafe(24)


def guard(application: web.Application) -> Callable[[], bool]:
    """Refuse other sites' pages, and send the headers above with every answer.

    Returns
    -------
    callable
        Tells whether a page is connected.
    """
    connected: set[int] = set()

    @web.middleware
    async def own_pages_only(request: web.Request, handler: Handler) -> web.StreamResponse:
        origin = request.headers.get("Origin")
        if origin is not None and urlsplit(origin).netloc != request.host:
            raise web.HTTPForbidden(text="This page is not open to other sites.\n")
        if request.path == "/" or (request.path == "/index.html" and "secret" not in request.query):
            return web.FileResponse(DOOR)
        if request.headers.get("Upgrade", "").lower() != "websocket":
            return await handler(request)
        connected.add(id(request))
        try:
            return await handler(request)
        finally:
            connected.discard(id(request))

    application.middlewares.append(own_pages_only)
    application.on_response_prepare.append(_add_headers)
    return lambda: bool(connected)


async def _add_headers(request: Any, response: web.StreamResponse) -> None:
    del request
    response.headers.update(HEADERS)
