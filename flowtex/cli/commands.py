"""The program ``flowtex``: its commands and their exit codes.

Each command imports what it needs when it runs, so that ``flowtex --help`` is instant. An error
that the user can correct is one paragraph on stderr, and the program exits with code 2, or with 1
if OpenGL is missing.
"""

from __future__ import annotations

import errno
import io
import math
import os
import signal
import sys
import warnings
from collections.abc import Callable, Sequence
from contextlib import redirect_stderr
from contextvars import ContextVar
from dataclasses import asdict
from functools import partial
from typing import TYPE_CHECKING, Any

from cyclopts import App, CycloptsError

from flowtex._util.child.child import FORKS
from flowtex._util.child.fork_server import fork_server
from flowtex._util.progress import waiting
from flowtex._util.terminal import Ended, ended_by_signals
from flowtex.cli.console import announcer, complain, describe, require_app, say, typed
from flowtex.cli.doctor import doctor
from flowtex.cli.info import info
from flowtex.cli.options import ServeFlags, UsageError
from flowtex.cli.serve import pyramid, serve
from flowtex.cli.write import export, formula, movie, render
from flowtex.errors import FieldError, Notice
from flowtex.rendering import diagnostics

if TYPE_CHECKING:
    from flowtex.app import Library
    from flowtex.app.server.sessions.local import MakeApp
    from flowtex.app.server.sessions.process import HostedSession
    from flowtex.app.server.site import Site

app = App(
    name="flowtex",
    help="Draw the flow on a surface as a texture that stays sharp at every zoom.",
    version=lambda: __import__("flowtex").__version__,
    help_epilogue="Try `flowtex demo`. Add --debug to print the traceback of an error.",
)
# These load the examples, so they are imported when they run, and their help is here.
app.command("flowtex.cli.show:demo", help="Show the examples on a page in the browser.")
app.command("flowtex.cli.show:show", help="Show files or a folder in a window or on a page.")
#: Entry point of a forked session, and modules that are loaded before the fork.
ENTRY = "flowtex.cli.commands:hosted"
PRELOAD = (
    "flowtex.sources.remote:prepare_readers",  # sessions share the processes that read files
    *("flowtex.cli.commands", "flowtex.cli.show", "flowtex.app.flow_app", "trame.widgets.vuetify3"),
    *("trame_client.module.vue3", "trame_vuetify.module.v3", "vtkmodules.vtkInteractionWidgets"),
    *("scipy.interpolate", "xarray", "cf_xarray", "netCDF4", "pyproj", "dask.array"),
)
#: The arguments of the running command.
running_words: ContextVar[Sequence[str]] = ContextVar("words", default=())
#: Called with the application of a page and its description, in the process of a session.
_host: ContextVar[Callable[[MakeApp, str], None] | None] = ContextVar("host", default=None)


for _command in (render, movie, export, formula, info, doctor, pyramid, serve):
    app.command(_command)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command, by default that of the process, and return its exit code.

    It is 0 for success, 2 for an error that the user can correct, and 1 if OpenGL is missing or
    ``doctor`` finds that something is missing; after Ctrl-C, SIGTERM and SIGHUP it is 128 plus the
    number of the signal.

    Raises
    ------
    Exception
        With ``--debug`` any error, otherwise only those that are defects of the program.
    """
    if arguments is None:
        arguments = sys.argv[1:]
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")  # on Windows, files may have a limited encoding
    debug = "--debug" in arguments
    words = [word for word in arguments if word != "--debug"]
    try:
        with warnings.catch_warnings(), ended_by_signals():
            _print_warnings()
            result = _run(words)
    except KeyboardInterrupt:
        return 128 + signal.SIGINT
    except Ended as ended:
        return ended.code
    except Exception as fault:
        error = _of_output(fault)
        is_of_system = isinstance(error, diagnostics.OpenGLMissingError)
        # Other errors than these are defects of the program.
        if debug or not (is_of_system or isinstance(error, (CycloptsError, FieldError))):
            raise
        complain(error)
        if is_of_system:
            return 1
        return 2
    if isinstance(result, int):
        return result
    return 0


def _run(words: Sequence[str]) -> Any:
    running_words.set(words)
    return app(words, exit_on_error=False, print_error=False, result_action="return_value")


def hosted() -> HostedSession:
    """Return a session that runs a command in its own process."""
    from flowtex.app.server.sessions.process import HostedSession

    _print_warnings()
    return HostedSession(partial(open_site, _run))


def _of_output(error: Exception) -> Exception:
    if not isinstance(error, OSError) or error.errno != errno.ENOSPC or error.filename:
        return error
    # What waits to be written would fail again when the process ends.
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return UsageError(f"the output cannot be written ({error.strerror})")


def _print_warnings() -> None:
    warnings.simplefilter("always", Notice)
    warnings.showwarning = _warn  # type: ignore[assignment]


def _warn(message: Warning | str, category: type[Warning], *_: Any) -> None:
    """Print a warning without the line of code that it came from, or a notice on the data."""
    if issubclass(category, Notice):
        say((typed(str(message)), "dim"))
    elif not category.__module__.startswith("xarray."):  # how a file was written
        if not isinstance(message, Warning):
            message = UserWarning(message)
        complain(message, "yellow")


def begin() -> None:
    """Load the libraries of the page in the background, where it is served by processes."""
    require_app()
    if FORKS and _host.get() is None:
        fork_server(PRELOAD)


def serve_processes(page: ServeFlags | None) -> bool:
    """Serve the page of the running command by processes, and return whether that is possible.

    Each is forked, and runs the same command up to the point where it would serve.
    """
    if not FORKS or _host.get() is not None:
        return False
    from flowtex.app.server.security import new_secret
    from flowtex.app.server.sessions.process import process_opener
    from flowtex.app.server.site import serve_sessions

    page = page or ServeFlags()
    secret = new_secret()
    report = asdict(diagnostics.require_opengl())
    request = {"words": list(running_words.get()), "secret": secret, "opengl": report}
    first: dict[str, str] = {}
    with waiting("Opening the page") as end_waiting:

        def announce(address: str) -> None:
            sys.stderr.write(first["notices"])
            announcer(first["description"], page.host, end_waiting)(address)

        open_session = process_opener(ENTRY, PRELOAD, request, first.update)
        serve_sessions(open_session, secret, **vars(page), announce=announce)
    return True


def serve_library(library: Library, page: ServeFlags | None, options: dict[str, Any]) -> int:
    """Serve flows as a page, or hand them to the session of this process."""
    from flowtex.app.flow_app import app_maker, first_choice, serve
    from flowtex.field.options import option_names
    from flowtex.scene.options import Appearance
    from flowtex.scene.scene import Scene

    page = page or ServeFlags()
    with waiting(f"Reading {library.names[0]}"):
        field = library.field(*first_choice(library, options))
    look = {}
    for name in option_names(Appearance):
        if name in options:
            look[name] = options[name]
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
