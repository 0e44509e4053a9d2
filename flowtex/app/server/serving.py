"""Serving pages on one port of this machine until Ctrl-C, each with a state of its own."""

from __future__ import annotations

import asyncio
import os
import signal
import webbrowser
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from flowtex.app.controllers.library import Library
from flowtex.app.flow_app import MAKING, FlowApp
from flowtex.app.server.security import new_secret
from flowtex.app.server.sessions import MakeApp, Sessions, usual_limit
from flowtex.app.server.site import Site
from flowtex.diagnostics import has_display

__all__ = ["IDLE", "ServeError", "serve"]

#: Minutes for which a session waits for its page.
IDLE = 15.0


class ServeError(RuntimeError):
    """The page cannot be served; the text says why and what to do."""


def serve(
    field: Any,
    *,
    host: str = "127.0.0.1",
    port: int = 0,
    limit: int | None = None,
    idle: float = IDLE,
    folder: str | Path | None = None,
    open_browser: bool = True,
    announce: Callable[[str], None] | None = None,
    **options: Any,
) -> None:
    """Show a flow on a page, until Ctrl-C.

    Each browser tab that opens the address has a state of its own: camera, settings and time are
    nobody else's. Fields and their traces are shared.

    Parameters
    ----------
    field
        What :class:`FlowApp` shows: a :class:`~flowtex.FlowField`, a mesh, the path of a file or
        of a folder; or a function that takes a trame server and returns an application on it,
        such as a :class:`FlowApp`.
    host
        Address to listen on. With another than this machine's own, everybody on the network who
        has the page's address can use it.
    port
        Port to listen on; 0 takes one that is free.
    limit
        Pages at one time, at most; by default what the cores and the free memory have room for.
    idle
        Minutes for which a page's state is kept after the page was closed.
    folder
        Folder whose files a page may open besides; none by default.
    open_browser
        Whether to open the page where there is a browser.
    announce
        Called with the page's address, which holds its secret; printed by default.
    **options
        Arguments and settings of ``plotter.flowtex.add``; none with a function.

    Raises
    ------
    FieldError, SettingsError
        When the mesh or a setting does not fit.
    ServeError
        When the port or the host cannot be listened on, or ``limit`` or ``idle`` is out of range.
    TypeError
        When options are given with a function.
    """
    if limit is not None and limit < 1:
        msg = f"limit is {limit}; expected 1 or more pages"
        raise ServeError(msg)
    if not idle > 0:
        msg = f"idle is {idle:g}; expected a positive number of minutes"
        raise ServeError(msg)
    make_app = _maker(field, folder, options)
    opened = _open if open_browser and has_display() else None
    with suppress(KeyboardInterrupt, asyncio.CancelledError):
        asyncio.run(
            _serve(make_app, host, port, limit or usual_limit(), idle, announce or print, opened)
        )


def _maker(field: Any, folder: str | Path | None, options: dict[str, Any]) -> MakeApp:
    """Return what makes an application for each page."""
    if callable(field):
        given = [*options, *(["folder"] if folder is not None else [])]
        if given:
            msg = f"{', '.join(given)} cannot go with a function; give them to what it makes"
            raise TypeError(msg)
        made: MakeApp = field
        return made
    # One library for all: files that are open and flows that are traced are shared.
    making = {name: options.pop(name, None) for name in MAKING}
    library = Library.of(field, folder=folder, **making)
    return lambda server: FlowApp(library, server=server, **options)


async def _serve(
    make_app: MakeApp,
    host: str,
    port: int,
    limit: int,
    idle: float,
    announce: Callable[[str], None],
    opened: Callable[[str], None] | None,
) -> None:
    secret = new_secret()
    site = Site(Sessions(make_app, secret, limit=limit, idle=idle), secret)
    main = asyncio.current_task()
    with suppress(NotImplementedError):  # on Windows
        asyncio.get_running_loop().add_signal_handler(
            signal.SIGTERM, lambda: main and main.cancel()
        )
    try:
        await site.prepare()
        try:
            await site.listen((host, port))
        except OSError as error:
            msg = (
                f"cannot listen on {host}:{port} ({error.strerror or error}); choose another port, "
                "or 0 for one that is free"
            )
            raise ServeError(msg) from error
        address = f"http://{_shown(host)}:{site.port}/?secret={secret}"
        announce(address)
        if opened is not None:
            opened(address)
        with suppress(asyncio.CancelledError):
            await asyncio.Event().wait()
    finally:
        await site.stop()


def _shown(host: str) -> str:
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
