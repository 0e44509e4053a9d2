"""Progress bars for work of more than a second, and a way to cancel work in a thread.

The bar is drawn by rich, in a terminal or a notebook; without rich there is none. Work inside
:func:`stoppable` is cancelled at its next call of :func:`check`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TypeVar

__all__ = ["Stopped", "check", "stoppable", "track"]

T = TypeVar("T")

#: Time before a bar appears.
BAR_DELAY_S = 1.0

_cancelled: ContextVar[Callable[[], bool] | None] = ContextVar("cancelled", default=None)


class Stopped(Exception):
    """The work was cancelled."""


@contextmanager
def stoppable(cancelled: Callable[[], bool]) -> Iterator[None]:
    """Cancel the work inside, in this thread, once ``cancelled()`` is true.

    Raises
    ------
    Stopped
        Where the work was stopped.
    """
    token = _cancelled.set(cancelled)
    try:
        yield
    finally:
        _cancelled.reset(token)


def check() -> None:
    """Raise where the work was cancelled.

    Raises
    ------
    Stopped
        When :func:`stoppable` says so.
    """
    cancelled = _cancelled.get()
    if cancelled is not None and cancelled():
        raise Stopped


def track(items: Iterable[T], total: int, text: str, *, show: bool = True) -> Iterator[T]:
    """Yield the items, with a progress bar once they have taken a second.

    Raises
    ------
    Stopped
        When the work is cancelled.
    """
    started = time.monotonic()
    bar = None
    try:
        for done, item in enumerate(items):
            check()
            if show and bar is None and time.monotonic() - started > BAR_DELAY_S:
                bar = _Bar(text, total)
            if bar is not None:
                bar.move(done)
            yield item
    finally:
        if bar is not None:
            bar.close(total)


class _Bar:
    """A rich progress bar, or nothing where rich is not installed."""

    def __init__(self, text: str, total: int) -> None:
        try:
            from rich.console import Console
            from rich.progress import Progress
        except ImportError:
            self._progress = None
            return
        self._progress = Progress(console=Console(stderr=True), transient=True)
        self._task = self._progress.add_task(text, total=total)
        self._progress.start()

    def move(self, done: int) -> None:
        if self._progress is not None:
            self._progress.update(self._task, completed=done)

    def close(self, total: int) -> None:
        if self._progress is not None:
            self._progress.update(self._task, completed=total)
            self._progress.stop()
            self._progress = None
