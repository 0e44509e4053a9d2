"""The table of supported data: a form, one line of code that draws it, and its files.

The tests run each line and compare the flow at every node; the page "Supported data" shows the
lines.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from form_table import read
from known_flow import Truth

import flowtex

#: Variables that a line uses, by name, and the flow that it must draw.
Made = tuple[Mapping[str, Any], Truth]


@dataclass(frozen=True)
class Supported:
    """A form in which people store a flow, and the line of code that draws it."""

    kind: str
    form: str
    code: str
    reads: str  #: How flowtex reads it.
    make: Callable[[Path], Made]  #: Writes the files that the line names into a folder.
    needs: str = ""  #: Package that must be installed.


#: All rows of the table.
ROWS: list[Supported] = []


def supported(
    kind: str, form: str, code: str, reads: str, needs: str = ""
) -> Callable[[Callable[[Path], Made]], Callable[[Path], Made]]:
    """Register a function that makes the data of a row."""

    def register(make: Callable[[Path], Made]) -> Callable[[Path], Made]:
        ROWS.append(Supported(kind, form, code, reads, make, needs))
        return make

    return register


def shown(code: str, variables: Mapping[str, Any]) -> tuple[Any, dict[str, Any]]:
    """Run a line of code, and return the data and the options that it would draw."""
    calls = []

    def show(*data: Any, **options: Any) -> None:
        whole = data if len(data) > 1 else data[0]
        calls.append((whole, options))

    names = {"flowtex": SimpleNamespace(show=show, FlowField=flowtex.FlowField), **variables}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        exec(code, names)
    (call,) = calls
    return call


def drawn(code: str, variables: Mapping[str, Any]) -> flowtex.FlowField:
    """Run a line of code, and return the field that it would draw."""
    data, options = shown(code, variables)
    return read(data, **options)
