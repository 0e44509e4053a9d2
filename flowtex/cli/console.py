"""Input and output of the command line: files as flows, results on stdout, errors on stderr."""

from __future__ import annotations

import importlib.util
import re
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cyclopts import MissingArgumentError

from flowtex._util.arguments import checked_target
from flowtex._util.progress import waiting
from flowtex._util.terminal import terminal
from flowtex.cli.options import UsageError, arguments
from flowtex.errors import install_extra
from flowtex.field.options import FieldOptions
from flowtex.remedies import for_shell, lines_for_shell
from flowtex.scene.fields import read_field
from flowtex.scene.forms import FLAGS
from flowtex.scene.options import Options
from flowtex.textures.images import load_image

if TYPE_CHECKING:
    from flowtex.field import FlowField

Announce = Callable[[str], None]
OPEN_TO_OTHERS = (
    "  Everyone who can reach this machine and has this address can use it;\n  the connection is "
    "not encrypted, so put a proxy with TLS in front of it."
)
#: A word, such as the name of a file, that is too long to print.
LONG_WORD = re.compile(r"(\S{200})\S{200,}(\S{100})")


def complain(error: Exception, colour: str = "red") -> None:
    """Print an error, or a warning, in one paragraph on stderr."""
    whole = _words(error)
    text = LONG_WORD.sub(r"\1…\2", typed(whole)) or type(error).__name__
    say(("flowtex:", f"bold {colour}"), f" {text}", stderr=True)
    lines = lines_for_shell(whole)
    if lines:
        say((lines, "dim"), stderr=True)


def _words(error: Exception) -> str:
    """Return the text of an error; that of a missing option says what it is."""
    if isinstance(error, MissingArgumentError) and error.argument is not None:
        what = str(error.argument.parameter.help)
        return f"missing option {error.argument.name}: {what[0].lower()}{what[1:]}"
    return str(error).strip()


def typed(text: str) -> str:
    """Return a text whose arguments are flags of the shell."""
    return for_shell(text, FLAGS)


def say(*parts: str | tuple[str, str], stderr: bool = False) -> None:
    """Print a line of texts, each alone or with its style."""
    from rich.text import Text

    terminal(stderr=stderr).print(Text.assemble(*parts), soft_wrap=True)


def report(output: object, text: str, figures: str) -> None:
    """Print what was written, and its size or the time that it took."""
    say((str(output), "bold"), f"  {text}  ", (figures, "dim"))


def announcer(description: str, host: str, end_waiting: Callable[[], None]) -> Announce:
    """Return a function that ends the waiting and prints the address of a page."""

    def announce(address: str) -> None:
        end_waiting()
        say(("flowtex", "bold"), f"  {description}\n")
        # A link that is wrapped or has several colours cannot be clicked.
        say("  ", (address, "cyan"), "\n")
        if host not in ("127.0.0.1", "localhost", "::1"):
            say((OPEN_TO_OTHERS, "yellow"))
        say(("  Press Ctrl-C to stop.", "dim"))
        sys.stdout.flush()

    return announce


def describe(field: FlowField) -> str:
    """Return name and size of a field as text."""
    if field.steady:
        times = ""
    else:
        times = f", {len(field.times)} times"
    return f"{field.name or 'flow'}, {field.short_size}{times}"


def load_field(files: Sequence[Path], choice: Mapping[str, Any]) -> FlowField:
    """Return the flow of a file, or of several that belong together.

    Parameters
    ----------
    files
        Paths of the files.
    choice
        Arguments of :class:`FieldOptions`, and ``time``.

    Raises
    ------
    UsageError
        When no file is given.
    FieldError
        When a file cannot be read, or lacks what is chosen.
    """
    if not files:
        raise UsageError("no file is given; name one")
    options = dict(choice)
    mesh: Any = files
    if len(files) == 1:
        mesh = files[0]
    time = options.pop("time", None)
    with waiting(f"Reading {files[0].name}"):
        return read_field(mesh, FieldOptions.of(**options), time)


def check_picture_file(output: Path) -> None:
    """Check that an image could be written, before anything is drawn.

    Raises
    ------
    UsageError
        When Pillow writes no images with this suffix.
    FieldError
        When the folder does not exist or cannot be written.
    """
    from PIL import Image

    Image.init()
    if Image.EXTENSION.get(output.suffix.lower()) not in Image.SAVE:
        suffix = output.suffix
        if suffix:
            fault = f"{suffix!r} is not a picture format"
        else:
            fault = "the file name has no suffix"
        raise UsageError(f"{output}: {fault}; expected .png, .jpg, .webp or .tiff")
    checked_target(output)


def drawing(*groups: object) -> dict[str, Any]:
    """Return the drawing options of flags; raise an error if they conflict."""
    values = arguments(*groups)
    options = Options.split("appearance", "view", **values)
    options.make_settings()
    if options.appearance.image is not None:
        load_image(options.appearance.image)
    return values


def require_app() -> None:
    """Check that the packages of the app are installed.

    Raises
    ------
    UsageError
        When one of them is missing; the error names the command that installs it.
    """
    packages = ("trame", "trame_vuetify", "trame_rca")
    missing = []
    for name in packages:
        if importlib.util.find_spec(name) is None:
            missing.append(name)
    if missing:
        raise UsageError(
            f"the page needs {', '.join(missing)}, which is not installed. To install it:\n  "
            f"{install_extra('app')}"
        )


@contextmanager
def writing(output: object) -> Iterator[None]:
    """Turn an OSError inside a ``with`` block into a UsageError that names the output.

    Raises
    ------
    UsageError
        When the block raises an OSError.
    """
    try:
        yield
    except OSError as error:
        raise UsageError(f"{output}: cannot be written ({error.strerror or error})") from error
