"""Messages of the command line: results on stdout, errors on stderr."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from flowtex.field import FlowField

__all__ = ["announcer", "complain", "describe", "say"]


def complain(error: Exception) -> None:
    """Print an error in one paragraph on stderr."""
    from rich.console import Console

    text = str(error).strip() or type(error).__name__
    console = Console(stderr=True, highlight=False)
    console.print("[bold red]flowtex:[/] ", end="")
    console.print(text, markup=False, soft_wrap=True)


def say(text: str) -> None:
    """Print a line of rich markup."""
    from rich.console import Console

    Console(highlight=False).print(text, soft_wrap=True)


def announcer(field: FlowField, host: str) -> Callable[[str], None]:
    """Return a function that prints the address of a page."""

    def announce(address: str) -> None:
        say(f"[bold]flowtex[/]  {describe(field)}\n")
        # A link that is wrapped or coloured in pieces cannot be clicked.
        say(f"  [cyan]{address}[/]\n")
        if host not in ("127.0.0.1", "localhost", "::1"):
            say(
                "  [yellow]Everybody who can reach this machine and has this address can use it,\n"
                "  and read along: a proxy with TLS keeps it private.[/]"
            )
        say("  [dim]Ctrl-C ends it.[/]")
        sys.stdout.flush()

    return announce


def describe(field: FlowField) -> str:
    """Return name and size of a field in words."""
    rows, columns = field.shape
    times = "" if field.steady else f", {len(field.times)} times"
    return f"{field.name or 'flow'}, {columns} × {rows} nodes{times}"
