"""Work in threads: pools, a way to cancel work, and progress bars for more than a second.

rich draws the bar from a background thread, in a terminal or a notebook; without threads no bar is
shown. Work inside :func:`stoppable` is cancelled at its next call of :func:`check`.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

from flowtex._util.arguments import brief
from flowtex._util.forks import renew_after_fork
from flowtex._util.terminal import terminal
from flowtex.errors import FieldError

if TYPE_CHECKING:
    from rich.progress import Progress
    from rich.status import Status

P = ParamSpec("P")
T = TypeVar("T")


def has_threads() -> bool:
    """Return whether a thread can be started here, and now."""
    # At the end of the interpreter functions registered with atexit still run, without threads.
    return threading.main_thread().is_alive() and _knows_threads()


@cache
def _knows_threads() -> bool:
    trial = threading.Thread(target=int, daemon=True)
    try:
        trial.start()
    except RuntimeError:
        return False
    trial.join()
    return True


def pool(size: int, name: str) -> Executor:
    """Return an executor with ``size`` threads; without threads it runs each call at once."""
    if has_threads():
        return _Threads(size, name)
    return _Caller()


def start(work: Callable[[], None], name: str) -> None:
    """Run a function in a daemon thread; without threads, run it at once."""
    if has_threads():
        threading.Thread(target=work, name=name, daemon=True).start()
    else:
        work()


class _Threads(Executor):
    """Threads of the present process: a forked process starts its own.

    Their work at the time of a fork is lost in the forked process; who submitted it forgets it.
    When the interpreter ends, calls run at once.
    """

    def __init__(self, size: int, name: str) -> None:
        self._size = size
        self._name = name
        self._is_closed = False
        self._threads = ThreadPoolExecutor(size, name)
        renew_after_fork(self)

    def renew(self) -> None:
        """Replace threads that a forked process does not have."""
        if not self._is_closed:
            self._threads = ThreadPoolExecutor(self._size, self._name)

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        try:
            return self._threads.submit(fn, *args, **kwargs)
        except RuntimeError:
            if self._is_closed:
                raise
            # Python starts no threads while the interpreter ends.
            return _Caller().submit(fn, *args, **kwargs)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:  # noqa: FBT001, FBT002
        self._is_closed = True
        self._threads.shutdown(wait=wait, cancel_futures=cancel_futures)


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
    """Raise :class:`Stopped` in the work inside, in this thread, once ``cancelled()`` is true.

    Raises
    ------
    FieldError
        When it is not a function.
    """
    if not callable(cancelled):
        raise FieldError(
            f"cancelled is {brief(cancelled)}; expected a function without arguments that returns "
            "True once the work is to be cancelled"
        )
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
    show = show and has_threads() and _may_show()
    start = time.monotonic()
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


def finish(work: Generator[None, None, T], total: int, text: str) -> T:
    """Return the result of work that yields before each of its parts, with a bar."""
    results: list[T] = []

    def parts() -> Iterator[None]:
        results.append((yield from work))

    for _ in track(parts(), total, text):
        pass
    return results[0]


def _may_show() -> bool:
    """Return whether output may be seen: rich, which takes a while to load, knows for certain."""
    if "IPython" in sys.modules or "FORCE_COLOR" in os.environ or "TTY_COMPATIBLE" in os.environ:
        return True
    stream: Any = sys.stderr  # None without a console
    return stream is not None and bool(stream.isatty())


def _bar() -> Progress:
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn
    from rich.progress import TimeRemainingColumn as TimeColumn

    text = TextColumn("{task.description}", markup=False)
    columns = (text, BarColumn(), TaskProgressColumn(), TimeColumn())
    return Progress(*columns, console=terminal(stderr=True), transient=True)
