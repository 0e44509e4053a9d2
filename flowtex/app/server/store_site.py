"""Server of a pyramid: a page, and the objects of its store that it streams.

::

    GET  /<token>/                     the page
    GET  /<token>/store/<run>/<name>   an object of the store

All addresses in the page are relative, so that it works behind any proxy. Names are those of a
pyramid's arrays and numbers of their chunks, and nothing else is served. Objects of another run,
which a browser may still have, have other addresses.
"""

from __future__ import annotations

from collections.abc import Callable, Container

from aiohttp import web

from flowtex.app.server.connections import LimitedServer
from flowtex.app.server.security import LOCAL, guard, is_same
from flowtex.app.server.served_store import ServedStore
from flowtex.app.server.site import serve_until_ended
from flowtex.pyramid.places import DOCUMENT

#: Seconds for which a browser may keep an object.
KEPT_S = 3600
WRONG = "This page opens only with the complete address that flowtex printed."


def store_application(
    served: ServedStore, page: str, token: str, hosts: Container[str] = LOCAL
) -> web.Application:
    """Return a web application of a page and its store, below a token."""
    application = web.Application(client_max_size=0)
    guard(application, hosts=hosts)

    def check(request: web.Request) -> None:
        if not is_same(request.match_info.get("token", ""), token):
            raise web.HTTPForbidden(text=WRONG)

    async def page_handler(request: web.Request) -> web.Response:
        check(request)
        headers = {"Cache-Control": "no-store"}
        return web.Response(text=page, content_type="text/html", headers=headers)

    async def store_handler(request: web.Request) -> web.Response:
        check(request)
        name = request.match_info["name"]
        try:
            body = await served.get(name)
        except LookupError:
            raise web.HTTPNotFound(text="This object does not exist.") from None
        return web.Response(body=body, headers=_headers(name))

    async def to_page(request: web.Request) -> web.Response:
        check(request)
        address = f"{token}/"  # relative: a proxy may have added a prefix
        raise web.HTTPFound(address)

    router = application.router
    router.add_get(f"/{{token}}/store/{served.run}/{{name:.+}}", store_handler)
    router.add_get("/{token}/", page_handler)
    router.add_get("/", page_handler)  # refused without the token
    router.add_get("/{token}", to_page)
    return application


def _headers(name: str) -> dict[str, str]:
    metadata = name.endswith(DOCUMENT)
    return {
        "Content-Type": "application/json" if metadata else "application/octet-stream",
        "Cache-Control": "no-store" if metadata else f"private, max-age={KEPT_S}",
    }


async def run_store(
    served: ServedStore,
    page: str,
    endpoint: tuple[str, int],
    *,
    token: str,
    hosts: Container[str],
    announce: Callable[[str], None],
    open_browser: bool,
) -> None:
    """Serve a page and its store until the task is cancelled."""
    server = LimitedServer(store_application(served, page, token, hosts), handler_cancellation=True)
    await serve_until_ended(
        lambda: server.start(endpoint),
        server.stop,
        (*endpoint, f"{token}/"),
        announce=announce,
        open_browser=open_browser,
    )
