"""The program ``flowtex``: its commands, and the exit code of what goes wrong.

Each command imports what it needs when it runs, so that ``flowtex --help`` is instant. An error
that the user can mend is one paragraph on stderr, and the program ends with code 2, or 1 where
there is no OpenGL to draw with.
"""

from __future__ import annotations

import io
import signal
import sys
import warnings
from collections.abc import Sequence
from difflib import get_close_matches
from functools import partial
from typing import TYPE_CHECKING, Any

from cyclopts import App, CycloptsError, UnknownOptionError

from flowtex._util.ending import Ended, ended_by_signals
from flowtex.cli import page
from flowtex.cli.console import complain
from flowtex.cli.formula import formula
from flowtex.cli.info import info
from flowtex.cli.options import UsageError
from flowtex.cli.pyramid import pyramid
from flowtex.cli.serve import serve
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
# These load the examples, so they are imported when they run; their help has to stand here.
app.command("flowtex.cli.show:demo", help="Show the examples on a page in the browser.")
app.command("flowtex.cli.show:show", help="Show files or a folder in a window or on a page.")
for _command in (render, movie, export, formula, info, pyramid, serve):
    app.command(_command)


@app.command
def doctor() -> int:
    """Look at what flowtex runs on, and say what is missing."""
    from flowtex import diagnostics

    return diagnostics.main()


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command, by default that of the process, and return the exit code.

    It is 0 when all went well, 2 when something was asked for that cannot be, 1 when there is no
    OpenGL, and for ``doctor`` when something is missing; after Ctrl-C, SIGTERM and SIGHUP it is 128
    and the number of the signal.
    """
    words = list(sys.argv[1:] if arguments is None else arguments)
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")  # Windows writes to files in fewer characters
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
        complain(_unknown(error) if isinstance(error, UnknownOptionError) else error)
        return code
    finally:
        warnings.showwarning = print_warning
    return result if isinstance(result, int) else 0


def _run(words: Sequence[str]) -> Any:
    page.words.set(words)
    return app(words, exit_on_error=False, print_error=False, result_action="return_value")


def hosted() -> HostedSession:
    """Return a session that runs a command, in a process of its own."""
    from flowtex.app.server.sessions.process import HostedSession

    warnings.showwarning = _warn  # type: ignore[assignment]
    return HostedSession(partial(page.open_site, _run))


def _unknown(error: UnknownOptionError) -> UsageError:
    """Return the error for a flag that a command has not, with one that may be meant."""
    flag = (error.token.keyword or error.token.value).partition("=")[0]
    off = "--no-" if flag.startswith("--no-") else "--"
    names = [name for argument in error.argument_collection or () for name in argument.names]
    words = [name.removeprefix(off) for name in names if name.startswith(off)]
    near = get_close_matches(flag.removeprefix(off), words, n=1)
    command = " ".join(["flowtex", *(error.command_chain or ())])
    hint = f"did you mean {off}{near[0]}?" if near else f"`{command} --help` lists all options"
    return UsageError(f"{command} has no option {flag}; {hint}")


def _warn(message: Warning | str, *_: Any) -> None:
    """Print a warning without the line of code that it came from."""
    complain(message if isinstance(message, Warning) else UserWarning(message), "yellow")


def _exit_code(error: Exception) -> int | None:
    """Exit code for what the user can mend; ``None`` for a fault of the program."""
    from flowtex.diagnostics import OpenGLMissingError

    if isinstance(error, OpenGLMissingError):
        return 1
    return 2 if isinstance(error, (CycloptsError, FieldError)) else None
