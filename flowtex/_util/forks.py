"""Forks of this process: what a forked process must make anew, and what must go before.

A forked process has a copy of all memory, but of all threads only the one that forked. A lock that
another thread held stays locked, the work of a pool is never done, and libraries that draw or read
with threads of their own wait for them without end. Things that need it are registered here, and
are the only ones in the package that follow forks.
"""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable
from types import TracebackType
from typing import Any, Protocol
from weakref import WeakValueDictionary


class Renewable(Protocol):
    """What a forked process makes anew."""

    def renew(self) -> None:
        """Make anew, in a forked process, what depends on threads of the process before."""


#: By identity, because not all of them are hashable.
_renewable: WeakValueDictionary[int, Renewable] = WeakValueDictionary()
_before: list[Callable[[], None]] = []
_after: list[Callable[[], None]] = []


def renew_after_fork(thing: Renewable) -> None:
    """Renew a thing in each forked process, while it lives."""
    _renewable[id(thing)] = thing


def call_at_fork(
    *, before: Callable[[], None] | None = None, after: Callable[[], None] | None = None
) -> None:
    """Call a function before each fork, in this process, or after it in the forked process."""
    if before is not None:
        _before.append(before)
    if after is not None:
        _after.append(after)


class _Guard:
    """What the threads of one process hold during a block; a forked process makes it anew."""

    _held: Any  # a lock or a semaphore of threading

    def __enter__(self) -> None:
        self._held.acquire()

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._held.release()


class ProcessLock(_Guard):
    """A re-entrant lock for the threads of one process.

    A forked process finds it free, unless the thread that forked holds it.
    """

    def __init__(self) -> None:
        self._held = threading.RLock()
        renew_after_fork(self)

    def acquire(self, timeout: float) -> bool:
        """Wait for the lock for at most ``timeout`` seconds; return whether it was free."""
        is_free: bool = self._held.acquire(timeout=timeout)
        return is_free

    def release(self) -> None:
        """Release the lock."""
        self._held.release()

    def renew(self) -> None:
        """Replace a lock that a thread held which no longer exists."""
        if self._held.acquire(blocking=False):
            self._held.release()
        else:
            self._held = threading.RLock()


class ProcessSemaphore(_Guard):
    """Turns for the threads of one process, ``count`` at once; a forked process has all of them."""

    def __init__(self, count: int) -> None:
        self._count = count
        self.renew()
        renew_after_fork(self)

    def renew(self) -> None:
        """Give back the turns of threads that no longer exist."""
        self._held = threading.Semaphore(self._count)


def _call_before() -> None:
    for function in _before:
        function()


def _call_after() -> None:
    for thing in list(_renewable.values()):
        thing.renew()
    for function in _after:
        function()
    _forget_threads_of_dask()


def _forget_threads_of_dask() -> None:
    """Have dask start new threads: threads from before the fork do not run here."""
    threaded = sys.modules.get("dask.threaded")
    if threaded is None:
        return
    threaded.default_pool = None  # type: ignore[attr-defined]
    threaded.pools.clear()
    threaded.pools_lock = threading.Lock()  # type: ignore[attr-defined]


if hasattr(os, "register_at_fork"):  # not on Windows
    os.register_at_fork(before=_call_before, after_in_child=_call_after)
