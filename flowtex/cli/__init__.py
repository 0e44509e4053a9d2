"""The command line: ``flowtex demo | show | render | movie | export | info | doctor``."""

from __future__ import annotations

from flowtex.cli.commands import main

__all__ = ["main"]
