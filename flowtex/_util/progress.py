"""Progress bars for work of more than a second, and a way to cancel work in a thread.

rich draws the bar from a background thread, in a terminal or a notebook; without threads no bar is
shown. Work inside :func:`stoppable` is cancelled at its next call of :func:`check`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, TypeVar

from flowtex._util.terminal import terminal
from flowtex._util.threads import has_threads

if TYPE_CHECKING:
    from rich.progress import Progress
    from rich.status import Status

T = TypeVar("T")

#: Time before a bar appears.
BAR_DELAY_S = 1.0

_waiting: list[Status] = []
_cancelled: ContextVar[Callable[[], bool] | None] = ContextVar("cancelled", default=None)


class Stopped(Exception):
    """The work was cancelled."""


@contextmanager
def stoppable(cancelled: Callable[[], bool]) -> Iterator[None]:
    """Raise :class:`Stopped` in the work inside, in this thread, once ``cancelled()`` is true."""
    token = _cancelled.set(cancelled)
    try:
        yield
    finally:
        _cancelled.reset(token)


def check() -> None:
    """Raise :class:`Stopped` if the surrounding :func:`stoppable` work was cancelled."""
    cancelled = _cancelled.get()
    if cancelled is not None and cancelled():
        raise Stopped


@contextmanager
def waiting(text: str) -> Iterator[Callable[[], None]]:
    """Show a text in a terminal until the block ends, a bar appears, or the result is called."""
    from rich.text import Text

    status = terminal(stderr=True).status(Text(text))
    _waiting.append(status)
    try:
        if has_threads():
            status.start()
        yield status.stop
    finally:
        status.stop()
        _waiting.remove(status)


def track(items: Iterable[T], total: int, text: str, *, show: bool = True) -> Iterator[T]:
    """Yield the items, with a progress bar once they have taken a second."""
    show, start = show and has_threads(), time.monotonic()
    bar = task = None
    try:
        for count, item in enumerate(items):
            check()
            if show and bar is None and time.monotonic() - start > BAR_DELAY_S:
                bar = _bar()
                task = bar.add_task(text, total=total)
                for status in _waiting:
                    status.stop()
                bar.start()
            if bar is not None and task is not None:
                bar.update(task, completed=count)
            yield item
    finally:
        if bar is not None:
            bar.stop()


def _bar() -> Progress:
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn
    from rich.progress import TimeRemainingColumn as TimeColumn

    text = TextColumn("{task.description}", markup=False)
    columns = (text, BarColumn(), TaskProgressColumn(), TimeColumn())
    return Progress(*columns, console=terminal(stderr=True), transient=True)
