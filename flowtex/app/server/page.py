"""Common tools of a page: its state, and checks of its values.

A page may send anything instead of a number or a name. Invalid values are dropped or clipped here,
so that no handler has to check again.
"""

from __future__ import annotations

import asyncio
import itertools
import math
from collections.abc import Callable, Container, Mapping
from contextlib import suppress
from typing import Any, TypeGuard

#: Characters of a message to a page, at most.
MESSAGE_LENGTH = 400
_count = itertools.count(1)


def running_loop() -> asyncio.AbstractEventLoop | None:
    """Return the running event loop, or ``None`` in a script."""
    with suppress(RuntimeError):
        return asyncio.get_running_loop()
    return None


class PageState:
    """The part of the state of a trame server, which several may share, that is of one application.

    A listener is called after a change by Python as well as by the page; it compares with the
    present value before it acts.
    """

    def __init__(self, server: Any) -> None:
        self.server = server
        self.prefix = f"flow{next(_count)}_"
        self._state = server.state

    def key(self, name: str) -> str:
        """Return the name of a value on the page."""
        return f"{self.prefix}{name}"

    def get(self, name: str) -> Any:
        """Return a value."""
        return self._state[self.key(name)]

    def set(self, **values: Any) -> None:
        """Change values."""
        for name, value in values.items():
            self._state[self.key(name)] = value

    def send(self, **values: Any) -> None:
        """Change values from a task, and send them to the page at once."""
        with self._state:
            self.set(**values)

    def on(self, call: Callable[[], object], *names: str) -> None:
        """Call a listener without arguments after changes of values."""
        self._state.change(*map(self.key, names))(lambda **_: call())


def number(value: object, low: float = -math.inf, high: float = math.inf) -> float | None:
    """Return a finite number within limits; ``None`` for anything else, a boolean too."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    with suppress(OverflowError):  # a whole number may have any size
        if math.isfinite(value) and low <= value <= high:
            return float(value)
    return None


def clipped(value: object, default: float, low: float, high: float) -> float:
    """Return a number clipped to limits; the default if the value is not a number."""
    checked = number(value)
    if checked is None:
        return default
    return min(max(checked, low), high)


def name_among(value: object, names: Container[str]) -> TypeGuard[str]:
    """Return whether a value is one of some names."""
    return isinstance(value, str) and value in names


def mapping(value: object) -> Mapping[str, Any]:
    """Return a mapping, an empty one for anything else."""
    if isinstance(value, Mapping):
        return value
    return {}


def shortened(text: str, most: int = MESSAGE_LENGTH) -> str:
    """Return a text, cut at its end if it is long."""
    if len(text) <= most:
        return text
    return f"{text[: most - 1]}…"
