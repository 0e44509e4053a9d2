"""The readers from which fields are made: of arrays by name, meshes, files and datasets.

Readers return fields, so they lie above :class:`flowtex.FlowField` and register here, by which its
constructors find them. ``flowtex/__init__.py`` names their module, which is loaded when the first
one is called.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import Any, Literal

#: What a reader reads.
Kind = Literal["arrays", "mesh", "file", "dataset"]

_modules: list[str] = []


def register_readers(module: str) -> None:
    """Let a module read what the keys of its ``READERS`` say, by the functions there."""
    _modules.append(module)


def reader(kind: Kind) -> Callable[..., Any]:
    """Return the function that makes a field of what it reads and its options."""
    readers: dict[Kind, Callable[..., Any]] = importlib.import_module(_modules[-1]).READERS
    return readers[kind]
