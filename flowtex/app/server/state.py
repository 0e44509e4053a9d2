"""The part of a page's state that belongs to one application.

Several applications may share a trame server, so each puts a prefix of its own before the names
of its state. A value is set by Python or by the page; who listens with :meth:`PageState.on` is
told of either, so a listener compares with what it has before it acts.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

__all__ = ["PageState"]

_count = itertools.count(1)


class PageState:
    """State of a trame server, under a prefix.

    Parameters
    ----------
    server
        The trame server.

    Attributes
    ----------
    server
        The trame server.
    prefix
        What each name begins with on the page.
    """

    def __init__(self, server: Any) -> None:
        self.server = server
        self.prefix = f"flow{next(_count)}_"
        self._state = server.state

    def key(self, name: str) -> str:
        """Return the name that the page has for a value."""
        return f"{self.prefix}{name}"

    def get(self, name: str) -> Any:
        """Return a value."""
        return self._state[self.key(name)]

    def set(self, **values: Any) -> None:
        """Change values."""
        for name, value in values.items():
            self._state[self.key(name)] = value

    def send(self, **values: Any) -> None:
        """Change values from a task, and tell the page at once."""
        with self._state:
            self.set(**values)

    def on(self, *names: str) -> Callable[[Callable[[], Any]], None]:
        """Call a function without arguments after each change of some values."""

        def listen(call: Callable[[], Any]) -> None:
            self._state.change(*(self.key(name) for name in names))(lambda **_: call())

        return listen
