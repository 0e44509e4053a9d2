"""The command line: ``flowtex demo | show | render | movie | export | paper | info | doctor``."""

from __future__ import annotations

from flowtex.cli.commands import main

__all__ = ["main"]
