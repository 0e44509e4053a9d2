"""What keeps others out of the page.

trame lets in whoever knows the secret, but its own is a public constant, and it asks no web page
where it comes from: any page open in the same browser could drive the program. So every start
has a secret of its own, which only the printed address carries, and a connection from another
site's page is refused. Who comes without the secret gets a page that says so (``door.html``).
The page itself may load nothing from elsewhere.

wslink reserves room for a whole message when its first piece announces a length of up to 4 GB, so
messages are limited as well: nothing that the page sends is larger than a picture.
"""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Awaitable, Callable
from typing import Any
from urllib.parse import urlsplit

from aiohttp import web
from wslink.chunking import UnChunker

__all__ = ["LimitedMessages", "guard", "is_same", "new_secret"]

#: Bytes of a message, and messages that a page may begin before it ends one.
MESSAGE_BYTES, OPEN_MESSAGES = 16_000_000, 4

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


def is_same(text: object, secret: str) -> bool:
    """Tell whether a secret is the right one, in a time that tells nothing about it."""
    return isinstance(text, str) and hmac.compare_digest(text.encode(), secret.encode())


def guard(application: web.Application, *, framed: bool = False) -> None:
    """Refuse other sites' pages, and send the headers above with every answer.

    With ``framed``, pages of other sites may hold this one in a frame, as a notebook does.
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


class LimitedMessages(UnChunker):
    """The messages of one connection, joined from their pieces, within limits."""

    def set_max_message_size(self, size: int) -> None:
        """Allow messages of so many bytes, or as many as any may have."""
        super().set_max_message_size(min(size, MESSAGE_BYTES))

    def process_chunk(self, chunk: bytes) -> Any:
        """Take a piece; return the message when it is the last one."""
        message = super().process_chunk(chunk)
        if len(self.pending_messages) > OPEN_MESSAGES:
            self.release_pending_messages()
            msg = (
                f"more than {OPEN_MESSAGES} messages were begun; expected one of them to end first"
            )
            raise ValueError(msg)
        return message
