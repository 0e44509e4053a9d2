"""Common tools of a page: its state and elements, signals between its parts, and tasks."""

from __future__ import annotations

import asyncio
import itertools
import logging
from collections.abc import Callable, Coroutine, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from trame_client.widgets.core import AbstractElement

_log = logging.getLogger(__name__)
_count = itertools.count(1)


class Signal:
    """An event of the page, and the functions that it calls."""

    def __init__(self) -> None:
        self._listeners: list[Callable[..., object]] = []

    def connect(self, listener: Callable[..., object]) -> None:
        """Call a function at each event, after those that were connected before."""
        self._listeners.append(listener)

    def emit(self, *values: object) -> None:
        """Call the connected functions with these values."""
        for listener in list(self._listeners):
            listener(*values)


def running_loop() -> asyncio.AbstractEventLoop | None:
    """Return the running event loop, or ``None`` in a script."""
    with suppress(RuntimeError):
        return asyncio.get_running_loop()
    return None


def start_task(work: Coroutine[Any, Any, None], failure: str) -> asyncio.Task[None]:
    """Start a task in the background; an error is logged with the text ``failure``."""
    task = asyncio.get_running_loop().create_task(work)

    def log_error(ended: asyncio.Task[None]) -> None:
        if not ended.cancelled() and (error := ended.exception()) is not None:
            _log.error(failure, exc_info=error)

    task.add_done_callback(log_error)
    return task


class PageElement(AbstractElement):
    """An element that ``client/src/app`` makes; its script and style come with it."""

    def __init__(
        self, name: str, properties: Sequence[str], events: Sequence[str] = (), **attributes: Any
    ) -> None:
        super().__init__(f"flowtex-{name}", **attributes)
        self._attr_names += properties
        self._event_names += events
        self.server.enable_module(
            {
                "serve": {"__flowtex": str(Path(__file__).parents[1] / "ui" / "static")},
                "styles": ["__flowtex/flowtex.css"],
                "scripts": ["__flowtex/flowtex.js"],
                "vue_use": ["flowtex_page"],
            }
        )


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

    def on(self, *names: str) -> Callable[[Callable[[], object]], None]:
        """Return a function that connects a listener without arguments to changes of values."""

        def listen(call: Callable[[], object]) -> None:
            self._state.change(*(self.key(name) for name in names))(lambda **_: call())

        return listen
