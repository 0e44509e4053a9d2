"""Threads, and what does their work where a platform has none, as Python in a browser."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from functools import cache
from typing import Any


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
    """Return so many threads with a name; without threads, what is submitted is done at once."""
    return ThreadPoolExecutor(size, name) if has_threads() else _Caller()


def start(work: Callable[[], None], name: str) -> None:
    """Do some work in a thread that a process does not wait for; without threads at once."""
    if has_threads():
        threading.Thread(target=work, name=name, daemon=True).start()
    else:
        work()


class _Caller(Executor):
    """Does in the calling thread what is submitted."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Return the future of a call that has ended."""
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future
