"""A thread that does one job after the other, the urgent ones first.

It is a daemon, so that a long trace does not keep a kernel from ending.
"""

from __future__ import annotations

import itertools
import queue
import threading
from collections.abc import Callable

__all__ = ["Worker"]

Job = Callable[[], None]


class Worker:
    """Jobs in a thread of their own.

    Parameters
    ----------
    name
        Name of the thread.
    failed
        Told of an error that a job raised; the next job is done all the same.
    """

    def __init__(self, name: str, failed: Callable[[Exception], None]) -> None:
        self._jobs: queue.PriorityQueue[tuple[int, int, Job]] = queue.PriorityQueue()
        self._count = itertools.count()
        self._failed = failed
        self._closed = threading.Event()
        threading.Thread(target=self._work, name=name, daemon=True).start()

    def do(self, job: Job, *, urgency: int = 0) -> None:
        """Do a job after all that are as urgent or more so."""
        if not self._closed.is_set():
            self._jobs.put((-urgency, next(self._count), job))

    def close(self) -> None:
        """Begin no other job."""
        self._closed.set()
        self._jobs.put((-1_000_000, next(self._count), lambda: None))

    def _work(self) -> None:
        while not self._closed.is_set():
            job = self._jobs.get()[-1]
            if self._closed.is_set():
                return
            try:
                job()
            except Exception as error:  # whoever asked is in another thread
                if not self._closed.is_set():
                    self._failed(error)
