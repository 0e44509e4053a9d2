"""Files that one session hands out over HTTP: downloads, and parts for the browser's client.

A file's address is ``flowtex/<token>/<name>``, below the page. The token cannot be guessed and
belongs to one session, so the address is all that is needed, and nobody else has it. What is
handed out is looked up when it is asked for, and nothing is left of it when the session ends.
"""

from __future__ import annotations

import inspect
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any
from urllib.parse import quote

from aiohttp import web

from flowtex.app.server.security import new_secret

__all__ = ["Content", "Give", "Routes", "add_route"]

#: What a file is: its bytes, or where they lie; its media type; and the name that it is saved
#: under, or ``None`` for what the page uses itself.
Content = tuple[bytes | Path, str, str | None]
Give = Callable[[], Content | Awaitable[Content]]

#: Where trame keeps a session's routes: in what only the server's side sees.
KEY = "flowtex_routes"


class Routes:
    """What one session hands out.

    Attributes
    ----------
    token
        The session's part of the address; it cannot be guessed.
    """

    def __init__(self) -> None:
        self.token = new_secret()
        self._given: dict[str, Give] = {}

    @classmethod
    def of(cls, server: Any) -> Routes:
        """Return the routes of a trame server, made when they are first asked for.

        They are served by :func:`flowtex.app.serve`, and as well where the server is started by
        trame itself.
        """
        if not server.context.has(KEY):
            routes = cls()
            server.context[KEY] = routes
            server.controller.on_server_bind.add(routes.bind)
        found: Routes = server.context[KEY]
        return found

    def bind(self, web_server: Any) -> None:
        """Add the route where trame has a web server of its own."""
        application = getattr(web_server, "app", None)
        if application is not None:
            add_route(application, {self.token: self}.get)

    def give(self, name: str, content: Give) -> str:
        """Hand out a file, in place of an earlier one of that name.

        Parameters
        ----------
        name
            Last part of the address, without a slash.
        content
            Called at each request; returns the bytes or a path, the media type, and the name to
            save it under, or ``None`` when the page is to use it. It may be a coroutine function.

        Returns
        -------
        str
            The address, relative to the page.

        Raises
        ------
        ValueError
            When the name is empty or has a slash.
        """
        if not name or "/" in name:
            msg = f"the name of a file is {name!r}; expected one part of an address, as in 'a.png'"
            raise ValueError(msg)
        self._given[name] = content
        return f"flowtex/{self.token}/{quote(name)}"

    def withdraw(self, name: str) -> None:
        """Hand a file out no more."""
        self._given.pop(name, None)

    def close(self) -> None:
        """Hand nothing out any more."""
        self._given.clear()

    async def answer(self, name: str) -> web.StreamResponse:
        """Return what is asked for.

        Raises
        ------
        aiohttp.web.HTTPNotFound
            When there is nothing of that name.
        """
        give = self._given.get(name)
        if give is None:
            raise web.HTTPNotFound
        made = give()
        body, kind, saved_as = await made if inspect.isawaitable(made) else made
        headers = {
            "Content-Type": kind,
            "Cache-Control": "no-store",
            "X-Content-Type-Options": "nosniff",
        }
        if saved_as is not None:
            # Names in other alphabets travel in the second form, RFC 6266.
            plain = saved_as.encode("ascii", "replace").decode().translate({34: "_", 92: "_"})
            headers["Content-Disposition"] = (
                f"attachment; filename=\"{plain}\"; filename*=UTF-8''{quote(saved_as, safe='')}"
            )
        if isinstance(body, Path):
            if not body.is_file():
                raise web.HTTPNotFound
            return web.FileResponse(body, headers=headers)
        return web.Response(body=body, headers=headers)


def add_route(application: web.Application, find: Callable[[str], Routes | None]) -> None:
    """Serve files below ``/flowtex`` of a web application.

    Parameters
    ----------
    application
        Where the route is added, before it is started.
    find
        Returns the routes of a token, or ``None`` where there is no such session.
    """

    async def handler(request: web.Request) -> web.StreamResponse:
        routes = find(request.match_info["token"])
        if routes is None:
            raise web.HTTPNotFound
        return await routes.answer(request.match_info["name"])

    application.router.add_get("/flowtex/{token}/{name}", handler)
