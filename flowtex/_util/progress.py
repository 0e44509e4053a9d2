"""Long work: a progress bar once it has lasted a second, and a way to stop it.

The bar is drawn by rich, in a terminal or a notebook, and only once the first second has passed,
so short work stays silent. Where rich is missing or nothing can be drawn there is no bar.

Work that goes on in a thread for a person who has changed their mind is stopped by
:func:`stoppable`: it looks now and then, with :func:`check`, whether it is still wanted.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TypeVar

__all__ = ["Stopped", "check", "stoppable", "track"]

T = TypeVar("T")

#: Seconds of silence before a bar appears.
PATIENCE = 1.0

_unwanted: ContextVar[Callable[[], bool] | None] = ContextVar("unwanted", default=None)


class Stopped(Exception):
    """The work is not wanted any more."""


@contextmanager
def stoppable(unwanted: Callable[[], bool]) -> Iterator[None]:
    """Stop the work inside, in this thread, as soon as ``unwanted()`` is true.

    Raises
    ------
    Stopped
        Where the work was stopped.
    """
    token = _unwanted.set(unwanted)
    try:
        yield
    finally:
        _unwanted.reset(token)


def check() -> None:
    """Look whether the work is still wanted.

    Raises
    ------
    Stopped
        When it is not.
    """
    unwanted = _unwanted.get()
    if unwanted is not None and unwanted():
        raise Stopped


def track(items: Iterable[T], total: int, text: str, *, show: bool = True) -> Iterator[T]:
    """Give the items one by one, with a progress bar once they have taken a second.

    Raises
    ------
    Stopped
        When the work is not wanted any more.
    """
    started = time.monotonic()
    bar = None
    try:
        for done, item in enumerate(items):
            check()
            if show and bar is None and time.monotonic() - started > PATIENCE:
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
