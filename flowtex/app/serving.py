"""Serving the page on one port of this machine until Ctrl-C."""

from __future__ import annotations

import asyncio
import os
import signal
import webbrowser
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

from flowtex.app.flow_app import FlowApp
from flowtex.app.security import guard, new_secret
from flowtex.doctor import has_display

__all__ = ["ServeError", "serve"]

#: Seconds that connections have to end in.
FAREWELL = 2.0


class ServeError(RuntimeError):
    """The page cannot be served; the text says why and what to do."""


def serve(
    field: Any,
    *,
    host: str = "127.0.0.1",
    port: int = 0,
    open_browser: bool = True,
    announce: Callable[[str], None] | None = None,
    **options: Any,
) -> None:
    """Show a flow on a page, until Ctrl-C.

    Parameters
    ----------
    field
        A :class:`~flowtex.FlowField`, or what ``plotter.flowtex.add`` takes.
    host
        Address to listen on. With another than this machine's own, everybody on the network who
        has the page's address can use it.
    port
        Port to listen on; 0 takes one that is free.
    open_browser
        Whether to open the page where there is a browser.
    announce
        Called with the page's address, which holds its secret; printed by default.
    **options
        Arguments and settings of ``plotter.flowtex.add``.

    Raises
    ------
    FieldError, SettingsError
        When the mesh or a setting does not fit.
    ServeError
        When the port or the host cannot be listened on.
    """
    with _trame_kept_quiet(), suppress(KeyboardInterrupt):
        opened = _open if open_browser and has_display() else None
        asyncio.run(_serve(FlowApp(field, **options), host, port, announce or print, opened))


async def _serve(
    app: FlowApp,
    host: str,
    port: int,
    announce: Callable[[str], None],
    opened: Callable[[str], None] | None,
) -> None:
    server, secret = app.server, new_secret()
    # Defaults of trame's own command line reach it without showing up in a list of processes.
    server.cli.set_defaults(authKey=secret, nowscompress=True)

    def bound(web: Any) -> None:
        app.stream.watched = guard(web.app)

    def ready(**_: Any) -> None:
        shown = host if host not in ("0.0.0.0", "::") else os.uname().nodename
        address = f"http://{shown}:{server.port}/?secret={secret}"
        announce(address)
        if opened is not None:
            opened(address)

    server.controller.on_server_bind.add(bound)
    server.controller.on_server_ready.add(ready)
    serving = server.start(
        exec_mode="coroutine",
        host=host,
        port=port,
        timeout=0,
        thread=True,
        open_browser=False,
        show_connection_info=False,
        disable_logging=True,
    )
    main = asyncio.current_task()
    with suppress(NotImplementedError):  # on Windows
        asyncio.get_running_loop().add_signal_handler(
            signal.SIGTERM, lambda: main and main.cancel()
        )
    try:
        await serving
    except OSError as error:
        msg = (
            f"cannot listen on {host}:{port} ({error.strerror or error}); choose another port, "
            "or 0 for one that is free"
        )
        raise ServeError(msg) from error
    except asyncio.CancelledError:
        with suppress(TimeoutError, asyncio.InvalidStateError):
            await asyncio.wait_for(server.stop(), FAREWELL)
    finally:
        app.close()


def _open(address: str) -> None:
    """Open a browser without waiting for it; where there is none, the address is printed."""

    def in_thread() -> None:
        with suppress(webbrowser.Error):
            webbrowser.open(address)

    asyncio.get_running_loop().run_in_executor(None, in_thread)


@contextmanager
def _trame_kept_quiet() -> Iterator[None]:
    """Keep trame from reading this program's arguments, and from printing on its own."""
    ours = {"TRAME_ARGS": "", "WSLINK_READY_MSG": ""}
    before = {name: os.environ.get(name) for name in ours}
    os.environ.update(ours)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
