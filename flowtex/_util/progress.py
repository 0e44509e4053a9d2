"""Work in threads: pools, a way to cancel work, and progress bars for more than a second.

rich draws the bar from a background thread, in a terminal or a notebook; without threads no bar is
shown. Work inside :func:`stoppable` is cancelled at its next call of :func:`check`.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from typing import TYPE_CHECKING, ParamSpec, TypeVar

from flowtex._util.terminal import terminal

if TYPE_CHECKING:
    from rich.progress import Progress
    from rich.status import Status

P = ParamSpec("P")
T = TypeVar("T")


@cache
def has_threads() -> bool:
    """Return whether a thread can be started here."""
    trial = threading.Thread(target=int, daemon=True)
    try:
        trial.start()
    except RuntimeError:
        return False
    trial.join()
    return True


def pool(size: int, name: str) -> Executor:
    """Return an executor with ``size`` threads; without threads it runs each call at once."""
    return ThreadPoolExecutor(size, name) if has_threads() else _Caller()


def start(work: Callable[[], None], name: str) -> None:
    """Run a function in a daemon thread; without threads, run it at once."""
    if has_threads():
        threading.Thread(target=work, name=name, daemon=True).start()
    else:
        work()


class _Caller(Executor):
    """Run each submitted call at once, in the calling thread."""

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        future: Future[T] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


BAR_DELAY_S = 1.0  #: Time before a bar appears.

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
