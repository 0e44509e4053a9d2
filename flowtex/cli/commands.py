"""The commands.

Each command imports what it needs when it runs, so that ``flowtex --help`` is instant. What goes
wrong for a reason that the user can mend is told in one paragraph on stderr, and the program ends
with code 2, or 1 where there is no OpenGL to draw with.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

from cyclopts import App, CycloptsError, Parameter

from flowtex.cli.checks import (
    check_colours,
    check_image,
    check_output,
    check_page,
    need_opengl,
)
from flowtex.cli.console import complain, nodes, say
from flowtex.cli.options import (
    FILE,
    FLAT,
    PICTURE,
    FieldOptions,
    FrameOptions,
    LookOptions,
    SettingFlags,
    UsageError,
    given,
    read,
)
from flowtex.errors import FieldError
from flowtex.offscreen.encoders import MovieError
from flowtex.settings import SettingsError

__all__ = ["main"]

app = App(
    name="flowtex",
    help="Draw the flow on a surface as a texture that stays sharp at every zoom.",
    version=lambda: __import__("flowtex").__version__,
    help_epilogue="Try `flowtex demo`. Add --debug to see where an error came from.",
)
# These are imported when they run, so the list of commands cannot read what they say of themselves.
for _path, _help in (
    ("flowtex.cli.pages:demo", "Show the examples on a page in the browser."),
    ("flowtex.cli.pages:show", "Show files, or a folder of them, in a window or on a page."),
    ("flowtex.cli.movie:movie", "Write a file as a movie: a loop, or all times of a flow."),
    ("flowtex.cli.paper:paper", "Compute the tables and figures of the paper, and check it."),
):
    app.command(_path, help=_help)


@app.command
def render(
    file: FILE,
    /,
    *,
    output: Annotated[
        Path,
        Parameter(name=["--output", "-o"], help="Picture to write; its suffix is its format."),
    ],
    clock: Annotated[
        float, Parameter(group=PICTURE, help="Moment of the streaming (--motion), in seconds.")
    ] = 0.0,
    which: Annotated[FieldOptions | None, FLAT] = None,
    draw: Annotated[FrameOptions | None, FLAT] = None,
    settings: Annotated[SettingFlags | None, FLAT] = None,
) -> int:
    """Draw a file as a picture."""
    started = time.perf_counter()
    draw = draw or FrameOptions()
    options, size = {**draw.look(), **given(settings), "clock": clock}, draw.pixels()
    check_output(output)
    check_image(options)
    need_opengl()
    field = read(file, which)
    check_colours(field, options)
    from PIL import Image

    from flowtex.offscreen.render import render as draw_picture

    picture = draw_picture(field, size=size, **options)
    try:
        Image.fromarray(picture).save(output)
    except OSError as error:
        msg = f"{output}: cannot be written ({error.strerror or error})"
        raise UsageError(msg) from error
    lost = f", {field.lost:.0%} of the flow leaves the surface" if field.lost > 0.01 else ""
    say(
        f"[bold]{output}[/]  {field.name}, {nodes(field)}{lost}  "
        f"[dim]{size[0]} × {size[1]}, {time.perf_counter() - started:.1f} s[/]"
    )
    return 0


@app.command
def export(
    file: FILE,
    /,
    *,
    output: Annotated[
        Path, Parameter(name=["--output", "-o"], help="Page to write, such as page.html.")
    ],
    steps: Annotated[
        int | None,
        Parameter(group=PICTURE, help="Time steps that the page has; all of them by default."),
    ] = None,
    title: Annotated[
        str | None, Parameter(group=PICTURE, help="Title of the page; the file's name by default.")
    ] = None,
    which: Annotated[FieldOptions | None, FLAT] = None,
    draw: Annotated[LookOptions | None, FLAT] = None,
    settings: Annotated[SettingFlags | None, FLAT] = None,
) -> int:
    """Write a file as one page that draws in any browser, without a server or a network."""
    started = time.perf_counter()
    options = {**(draw or LookOptions()).look(), **given(settings)}
    check_page(output)
    check_image(options)
    field = read(file, which)
    check_colours(field, options)
    if steps is not None and steps < 1:
        msg = f"--steps is {steps}; expected 1 to {len(field.times)}, the steps of the file"
        raise UsageError(msg)
    from flowtex.web import export as export_

    def announce(size: int, count: int) -> None:
        some = "" if count == len(field.times) else f", {count} of them"
        say(f"{field.name}, {nodes(field)}{some}: about {size / 1e6:.1f} MB")

    try:
        page = export_.export(field, output, steps=steps, title=title, announce=announce, **options)
    except OSError as error:
        msg = f"{output}: cannot be written ({error.strerror or error})"
        raise UsageError(msg) from error
    say(
        f"[bold]{output}[/]  [dim]{page.nbytes / 1e6:.2f} MB, "
        f"{time.perf_counter() - started:.1f} s[/]"
    )
    return 0


@app.command
def info(file: FILE, /, *, which: Annotated[FieldOptions | None, FLAT] = None) -> int:
    """Tell what a file holds, and what would be drawn."""
    from flowtex.cli.info import print_info

    print_info(file, which.given() if which is not None else {})
    return 0


@app.command
def doctor() -> int:
    """Look at what flowtex runs on, and say what is missing."""
    from flowtex import diagnostics as doctor_

    return doctor_.main()


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command and return the exit code.

    Parameters
    ----------
    arguments
        Words of the command line; those of the process by default.

    Returns
    -------
    int
        0 when all went well, 2 when something was asked for that cannot be, 1 when there is no
        OpenGL, and for ``doctor`` when something is missing.
    """
    words = list(sys.argv[1:] if arguments is None else arguments)
    debug = "--debug" in words
    words = [word for word in words if word != "--debug"]
    try:
        result = app(words, exit_on_error=False, print_error=False, result_action="return_value")
    except KeyboardInterrupt:
        return 130
    except Exception as error:
        code = _code(error)
        if debug or code is None:
            raise
        complain(error)
        return code
    return result if isinstance(result, int) else 0


def _code(error: Exception) -> int | None:
    """Exit code for what the user can mend; ``None`` for a fault of the program."""
    from flowtex.diagnostics import OpenGLMissingError

    if isinstance(error, OpenGLMissingError):
        return 1
    if isinstance(error, (CycloptsError, FieldError, MovieError, SettingsError, UsageError)):
        return 2
    # The page's own error is known only where the page is.
    serving = sys.modules.get("flowtex.app")
    if serving is not None and isinstance(error, serving.ServeError):
        return 2
    return None
