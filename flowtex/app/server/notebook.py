"""A page in a cell of a notebook.

The kernel serves its application itself, in its own event loop, on this machine's own address
and behind its own secret; the cell holds a frame that shows it. All frames of one application show
the same state, which is also that of the Python objects.

Where the browser cannot reach the kernel's machine, the frame goes through jupyter-server-proxy,
which Jupyter's own token guards as well. JupyterHub is recognised; elsewhere the path of the
proxy is given, as an argument or in ``FLOWTEX_PROXY``.
"""

from __future__ import annotations

import asyncio
import html
import os
import socket
from contextlib import suppress
from types import SimpleNamespace
from typing import Any

from flowtex.app.server.page import start_task
from flowtex.app.server.security import ANY, LOCAL, new_secret
from flowtex.app.server.sessions.local import LocalSession
from flowtex.app.server.sessions.registry import Sessions
from flowtex.app.server.site import Site

#: Height of a frame, in CSS pixels.
HEIGHT_PX = 520
#: Connections that may wait while the kernel runs a cell.
BACKLOG = 64

FRAME = (
    '<iframe src="{address}" title="flowtex" allow="fullscreen; clipboard-write"'
    ' style="display: block; width: 100%; height: {height}px; border: 0; border-radius: 6px">'
    "</iframe>"
)
FAILURE = "the page in the cell has failed"
NO_LOOP = "flowtex: no event loop is running, so nothing is shown; use flowtex.app.serve"


def proxy_path(proxy: str | bool | None = None) -> str | None:  # noqa: FBT001 one question
    """Return the path of jupyter-server-proxy, or ``None`` for a direct connection.

    ``proxy`` is a path such as ``"/user/me/proxy"``, or an address; ``True`` for the usual path,
    ``False`` for none. By default it is that of ``FLOWTEX_PROXY``, or of JupyterHub if its
    environment is found.
    """
    hub = os.environ.get("JUPYTERHUB_SERVICE_PREFIX")
    if proxy is None:
        proxy = os.environ.get("FLOWTEX_PROXY") or hub is not None
    if proxy is False or proxy == "":
        return None
    path = f"{(hub or '').rstrip('/')}/proxy" if proxy is True else str(proxy)
    return path.rstrip("/")


class NotebookPage:
    """Base of an application that a notebook shows; it has ``server`` and ``stream``."""

    _served: _Served | None = None

    def in_cell(self, *, height: int = HEIGHT_PX, proxy: str | bool | None = None) -> Frame:
        """Return what a notebook displays to show the page in a cell.

        Parameters
        ----------
        height
            Height of the frame, in CSS pixels.
        proxy
            Connection of the browser to the kernel: ``True`` for jupyter-server-proxy, its path
            such as ``"/base/proxy"``, or ``False`` for a direct one. By default direct, and on
            JupyterHub through jupyter-server-proxy.

        Raises
        ------
        RuntimeError
            When no event loop runs, as in a plain script.
        """
        if self._served is None:
            try:
                self._served = _Served(self, asyncio.get_running_loop())
            except RuntimeError as error:
                raise RuntimeError(NO_LOOP) from error
        return Frame(self._served.address(proxy_path(proxy)), height)

    def leave_cell(self) -> None:
        """Stop serving; called when the application is closed."""
        served, self._served = self._served, None
        if served is not None:
            served.end()

    def _repr_mimebundle_(
        self, include: Any = None, exclude: Any = None, **kwargs: Any
    ) -> dict[str, str]:
        del include, exclude, kwargs
        try:
            frame = self.in_cell()
        except RuntimeError:
            return {"text/plain": NO_LOOP}
        return {"text/plain": repr(self), "text/html": frame._repr_html_()}


class Frame:
    """A frame in a notebook: the page's address, with its secret, and the height in CSS pixels."""

    def __init__(self, address: str, height: int) -> None:
        self.address = address
        self.height = height

    def __repr__(self) -> str:
        # The address opens the page, so it must not be in a log.
        return f"<flowtex page, {self.height} pixels high>"

    def _repr_html_(self) -> str:
        return FRAME.format(address=html.escape(self.address), height=int(self.height))


class _Served:
    """One application that the kernel serves."""

    def __init__(self, app: Any, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._secret = new_secret()
        # It listens before anything is awaited: the frame's address has the port, and a browser
        # that connects while the cell still runs waits.
        self._socket = socket.create_server(("127.0.0.1", 0), backlog=BACKLOG)
        self._socket.setblocking(False)
        # The owner of the application closes it.
        borrowed_app = SimpleNamespace(server=app.server, stream=app.stream, close=lambda: None)
        sessions = Sessions(
            lambda: LocalSession.open(borrowed_app, self._secret),
            limit=1,
            idle=float("inf"),
            shared=True,
        )
        self._hosts = set(LOCAL)
        self._site = Site(sessions, self._secret, hosts=self._hosts, framed=True)
        self._task = start_task(self._start(), FAILURE)

    async def _start(self) -> None:
        await self._site.prepare()
        await self._site.listen(self._socket)

    def address(self, proxy: str | None) -> str:
        port = self._socket.getsockname()[1]
        if proxy is not None:
            # Jupyter's proxy passes on the name that the browser uses, and guards it by its token.
            self._hosts.add(ANY)
        place = f"http://127.0.0.1:{port}" if proxy is None else f"{proxy}/{port}"
        return f"{place}/?secret={self._secret}"

    def end(self) -> None:
        if not self._loop.is_running():  # the kernel has ended
            self._socket.close()
            return
        self._loop.call_soon_threadsafe(self._start_end)

    def _start_end(self) -> None:
        self._task = start_task(self._end(self._task), FAILURE)

    async def _end(self, starting: asyncio.Task[None]) -> None:
        with suppress(Exception):
            await starting
        await self._site.stop()
        self._socket.close()
