"""The page of ``flowtex show`` and ``flowtex demo``.

Where the system forks, each session is a process that runs the same command, up to the point where
it would serve: there it opens one session, for the process in front.
"""

from __future__ import annotations

import io
import math
import sys
from collections.abc import Callable, Sequence
from contextlib import redirect_stderr
from contextvars import ContextVar
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from flowtex._util.child import FORKS, prepare
from flowtex._util.progress import waiting
from flowtex.cli.console import announcer, describe, require_app
from flowtex.cli.options import ServeFlags
from flowtex.rendering import diagnostics

if TYPE_CHECKING:
    from flowtex.app import Library
    from flowtex.app.server.sessions.local import MakeApp
    from flowtex.app.server.site import Site

#: Entry point of a forked session, and modules that are loaded before the fork.
ENTRY = "flowtex.cli.commands:hosted"
PRELOAD = (
    "flowtex.sources.remote:prepare_readers",  # sessions share the processes that read files
    *("flowtex.cli.commands", "flowtex.cli.show", "flowtex.app.flow_app", "trame.widgets.vuetify3"),
    *("trame_client.module.vue3", "trame_vuetify.module.v3", "vtkmodules.vtkInteractionWidgets"),
    *("scipy.interpolate", "xarray", "cf_xarray", "netCDF4", "pyproj", "dask.array"),
)

#: The arguments of the running command.
words: ContextVar[Sequence[str]] = ContextVar("words", default=())
#: Called with the application of a page and its description, in the process of a session.
_host: ContextVar[Callable[[MakeApp, str], None] | None] = ContextVar("host", default=None)


def begin() -> None:
    """Load the libraries of the page in the background, where it is served by processes."""
    require_app()
    if FORKS and _host.get() is None:
        prepare(PRELOAD)


def serve_processes(page: ServeFlags | None) -> bool:
    """Serve the page of the running command by processes, and return whether that is possible."""
    if not FORKS or _host.get() is not None:
        return False
    from flowtex.app.server.security import new_secret
    from flowtex.app.server.sessions.process import process_opener
    from flowtex.app.server.site import serve_sessions

    page, secret = page or ServeFlags(), new_secret()
    report = asdict(diagnostics.require_opengl())
    request = {"words": list(words.get()), "secret": secret, "opengl": report}
    first: dict[str, str] = {}
    with waiting("Opening the page") as end_waiting:

        def announce(address: str) -> None:
            end_waiting()
            sys.stderr.write(first["notices"])
            announcer(first["description"], page.host)(address)

        open_session = process_opener(ENTRY, PRELOAD, request, first.update)
        serve_sessions(open_session, secret, **vars(page), announce=announce)
    return True


def serve_library(library: Library, page: ServeFlags | None, options: dict[str, Any]) -> int:
    """Serve flows as a page, or hand them to the session of this process."""
    from flowtex.app.flow_app import app_maker, first_choice, serve
    from flowtex.scene.options import Appearance
    from flowtex.scene.scene import Scene

    page = page or ServeFlags()
    with waiting(f"Reading {library.names[0]}"):
        field = library.field(*first_choice(library, options))
    look = {name: options[name] for name in vars(Appearance()) if name in options}
    Scene.of(field, **look).close()  # raises errors before a page asks
    if (host := _host.get()) is not None:
        host(app_maker(library, None, options), describe(field))
        return 0
    with waiting(f"Tracing {describe(field)}") as end_waiting:
        announce = announcer(describe(field), page.host, end_waiting)
        serve(library, **vars(page), announce=announce, **options)
    return 0


def open_site(
    run: Callable[[Sequence[str]], Any], request: dict[str, Any]
) -> tuple[Site, dict[str, str]]:
    """Return a site with the session that a command makes, and its messages."""
    from flowtex.app.server.sessions.local import opener
    from flowtex.app.server.sessions.registry import Sessions
    from flowtex.app.server.site import Site

    diagnostics.take_report(diagnostics.OpenGLReport(**request["opengl"]))
    sites: list[tuple[MakeApp, str]] = []
    token = _host.set(lambda make_app, description: sites.append((make_app, description)))
    try:
        with redirect_stderr(io.StringIO()) as notices:
            run(request["words"])
    finally:
        _host.reset(token)
    ((make_app, description),), secret = sites, request["secret"]
    site = Site(Sessions(opener(make_app, secret), limit=1, idle=math.inf), secret)
    return site, {"description": description, "notices": notices.getvalue()}
