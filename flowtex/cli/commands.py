"""The program ``flowtex``: its commands and their exit codes.

Each command imports what it needs when it runs, so that ``flowtex --help`` is instant. An error
that the user can correct is one paragraph on stderr, and the program exits with code 2, or with 1
if OpenGL is missing.
"""

from __future__ import annotations

import io
import signal
import sys
import warnings
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from cyclopts import App, CycloptsError, MissingArgumentError, UnknownOptionError

from flowtex._util.arguments import closest, elsewhere
from flowtex._util.terminal.ending import Ended, ended_by_signals
from flowtex.cli import page
from flowtex.cli.console import complain
from flowtex.cli.formula import formula
from flowtex.cli.info import info
from flowtex.cli.options import UsageError
from flowtex.cli.serve import pyramid, serve
from flowtex.cli.write import export, movie, render
from flowtex.errors import FieldError

if TYPE_CHECKING:
    from flowtex.app.server.sessions.process import HostedSession

app = App(
    name="flowtex",
    help="Draw the flow on a surface as a texture that stays sharp at every zoom.",
    version=lambda: __import__("flowtex").__version__,
    help_epilogue="Try `flowtex demo`. Add --debug to print the traceback of an error.",
)
# These load the examples, so they are imported when they run, and their help is here.
app.command("flowtex.cli.show:demo", help="Show the examples on a page in the browser.")
app.command("flowtex.cli.show:show", help="Show files or a folder in a window or on a page.")
for _command in (render, movie, export, formula, info, pyramid, serve):
    app.command(_command)


@app.command
def doctor() -> int:
    """Check the system that flowtex runs on, and name what is missing."""
    from flowtex.rendering import diagnostics

    return diagnostics.main()


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command, by default that of the process, and return its exit code.

    It is 0 for success, 2 for an error that the user can correct, and 1 if OpenGL is missing or
    ``doctor`` finds that something is missing; after Ctrl-C, SIGTERM and SIGHUP it is 128 plus the
    number of the signal.
    """
    words = list(sys.argv[1:] if arguments is None else arguments)
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")  # on Windows, files may have a limited encoding
    debug = "--debug" in words
    words = [word for word in words if word != "--debug"]
    print_warning = warnings.showwarning
    warnings.showwarning = _warn  # type: ignore[assignment]
    try:
        with ended_by_signals():
            result = _run(words)
    except KeyboardInterrupt:
        return 128 + signal.SIGINT
    except Ended as ended:
        return ended.code
    except Exception as error:
        code = _exit_code(error)
        if debug or code is None:
            raise
        complain(_explained(error))
        return code
    finally:
        warnings.showwarning = print_warning
    return result if isinstance(result, int) else 0


def _run(words: Sequence[str]) -> Any:
    page.words.set(words)
    return app(words, exit_on_error=False, print_error=False, result_action="return_value")


def hosted() -> HostedSession:
    """Return a session that runs a command in its own process."""
    from flowtex.app.server.sessions.process import HostedSession

    warnings.showwarning = _warn  # type: ignore[assignment]
    return HostedSession(partial(page.open_site, _run))


def _explained(error: Exception) -> Exception:
    """Return an error of the parser with a remedy: the help of a missing flag, or a near name."""
    if isinstance(error, MissingArgumentError) and error.argument is not None:
        return UsageError(f"{error.argument.name} is missing: {error.argument.parameter.help}")
    if not isinstance(error, UnknownOptionError):
        return error
    flag = (error.token.keyword or error.token.value).partition("=")[0]
    off = "--no-" if flag.startswith("--no-") else "--"
    names = [name for argument in error.argument_collection or () for name in argument.names]
    words = [name.removeprefix(off) for name in names if name.startswith(off)]
    name = flag.removeprefix(off)
    near = " or ".join(off + word for word in closest(name, words))
    command = " ".join(error.command_chain or ())
    help_ = f"`{' '.join(['flowtex', *command.split()])} --help` lists all options"
    hint = elsewhere(name, words) or (f"did you mean {near}?" if near else help_)
    return UsageError(f"{command or 'flowtex'} has no option {flag}; {hint}")


def _warn(message: Warning | str, *_: Any) -> None:
    """Print a warning without the line of code that it came from."""
    complain(message if isinstance(message, Warning) else UserWarning(message), "yellow")


def _exit_code(error: Exception) -> int | None:
    """Exit code of an error that the user can correct; ``None`` for a defect of the program."""
    from flowtex.rendering.diagnostics import OpenGLMissingError

    if isinstance(error, OpenGLMissingError):
        return 1
    return 2 if isinstance(error, (CycloptsError, FieldError)) else None
