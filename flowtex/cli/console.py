"""Input and output of the command line: files as flows, results on stdout, errors on stderr."""

from __future__ import annotations

import re
import sys
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flowtex._util.notices import Notice
from flowtex._util.progress import waiting
from flowtex._util.terminal.console import terminal
from flowtex.cli.options import UsageError, flag_names
from flowtex.scene.options import FieldOptions

if TYPE_CHECKING:
    from flowtex.field import FlowField


def complain(error: Exception, colour: str = "red") -> None:
    """Print an error, or a warning, in one paragraph on stderr."""
    text = in_flags(str(error).strip()) or type(error).__name__
    say(("flowtex:", f"bold {colour}"), f" {text}", stderr=True)


def in_flags(text: str) -> str:
    """Return a message with arguments as flags: ``plane="k=20"`` is ``--plane k=20``."""
    names = "|".join([*flag_names(), "fresh", "seconds", "fps", "quality", "memory"])

    def flag(match: re.Match[str]) -> str:
        return f"--{match['name'].replace('_', '-')} {match['value']}"

    def quoted_flag(match: re.Match[str]) -> str:
        quote = match["quote"] if " " in match["value"] else ""
        return f"--{match['name'].replace('_', '-')} {quote}{match['value']}{quote}"

    text = re.sub(r"\b(i?sel)=\{'(\w+)': ([^{}]+)\}", r"--\1 \2=\3", text)
    text = re.sub(rf"(?:^|(?<=: |\. ))(?P<name>{names}) (?P<value>is |applies )", flag, text)
    text = re.sub(
        rf"\b(?P<name>{names})=True\b", lambda m: f"--{m['name'].replace('_', '-')}", text
    )
    start = rf"(?<!--beside )\b(?P<name>{names})="
    text = re.sub(rf"""{start}(?P<quote>["'])(?P<value>[^"']+)(?P=quote)""", quoted_flag, text)
    return re.sub(rf"""{start}(?P<value>[^\s"';,)]+)""", flag, text)


def say(*parts: str | tuple[str, str], stderr: bool = False) -> None:
    """Print a line of texts, each alone or with its style."""
    from rich.text import Text

    terminal(stderr=stderr).print(Text.assemble(*parts), soft_wrap=True)


def announcer(
    description: str, host: str, end_waiting: Callable[[], None] | None = None
) -> Callable[[str], None]:
    """Return a function that ends the waiting and prints the address of a page."""

    def announce(address: str) -> None:
        if end_waiting is not None:
            end_waiting()
        say(("flowtex", "bold"), f"  {description}\n")
        # A link that is wrapped or has several colours cannot be clicked.
        say("  ", (address, "cyan"), "\n")
        if host not in ("127.0.0.1", "localhost", "::1"):
            warning = (
                "  Everyone who can reach this machine and has this address can use it;\n  the "
                "connection is not encrypted, so put a proxy with TLS in front of it."
            )
            say((warning, "yellow"))
        say(("  Press Ctrl-C to stop.", "dim"))
        sys.stdout.flush()

    return announce


def describe(field: FlowField) -> str:
    """Return name and size of a field as text."""
    times = "" if field.steady else f", {len(field.times)} times"
    return f"{field.name or 'flow'}, {field.short_size}{times}"


def load_field(files: Sequence[Path], choice: Mapping[str, Any]) -> FlowField:
    """Return the flow of a file, or of several that belong together."""
    if not files:
        msg = "no file is given; name one"
        raise UsageError(msg)
    options, mesh = dict(choice), files[0] if len(files) == 1 else files
    time = options.pop("time", None)
    with waiting(f"Reading {files[0].name}"), notices():
        return FieldOptions(**options).field(mesh, time)


@contextmanager
def notices() -> Iterator[None]:
    """Print notices on the choice of data, and pass on all other warnings."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", Notice)
        yield
    for warning in caught:
        if issubclass(warning.category, Notice):
            say((in_flags(str(warning.message)), "dim"))
        elif not warning.category.__module__.startswith("xarray."):  # how a file was written
            warnings.warn_explicit(
                warning.message, warning.category, warning.filename, warning.lineno
            )
