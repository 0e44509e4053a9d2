"""Thread pools; on platforms without threads, such as WebAssembly, the caller does the work."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from functools import cache
from typing import ParamSpec, TypeVar

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
        """Run a call and return its finished future."""
        future: Future[T] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future
