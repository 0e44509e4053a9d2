"""A few threads that work for all widgets of a process: the urgent jobs first.

Thirty widgets with their own threads would slow each other down, and behind a single thread all
would wait for one long trace. Threads exist while there is work, and are daemons, so that a long
trace does not keep a kernel from ending.
"""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable

from flowtex._util.threads import start

Job = Callable[[], None]
#: Negative urgency, order of arrival, worker, and job.
Entry = tuple[int, int, "Worker", Job]


class WorkerPool:
    """At most ``size`` threads that do the jobs of many workers, one at a time for each worker."""

    def __init__(self, name: str, size: int) -> None:
        self._name, self._size = name, size
        # Garbage collection may close a widget in a thread that holds the lock.
        self._lock = threading.RLock()
        self._count = itertools.count()
        self._waiting: list[Entry] = []
        self._busy: set[Worker] = set()
        self._threads = 0

    def put(self, worker: Worker, job: Job, urgency: int) -> None:
        """Add a job, which is done when its turn comes."""
        with self._lock:
            self._waiting.append((-urgency, next(self._count), worker, job))
            if self._threads == self._size:
                return
            self._threads += 1
        start(self._work, self._name)

    def has(self, worker: Worker) -> bool:
        """Return whether a job of a worker waits or runs."""
        with self._lock:
            return worker in self._busy or any(entry[2] is worker for entry in self._waiting)

    def drop(self, worker: Worker) -> None:
        """Forget the jobs of a worker that have not begun."""
        with self._lock:
            self._waiting = [entry for entry in self._waiting if entry[2] is not worker]

    def _work(self) -> None:
        done: Worker | None = None
        while (entry := self._next(done)) is not None:
            _, _, done, job = entry
            done.run(job)

    def _next(self, done: Worker | None) -> Entry | None:
        with self._lock:
            if done is not None:
                self._busy.discard(done)
            free = [entry for entry in self._waiting if entry[2] not in self._busy]
            if not free:
                self._threads -= 1
                return None
            entry = min(free, key=lambda e: e[:2])
            self._waiting = [other for other in self._waiting if other is not entry]
            self._busy.add(entry[2])
            return entry


class Worker:
    """Jobs that a pool does one after the other.

    ``failed`` is called with an error that a job raised; the next job is done all the same.
    """

    def __init__(self, pool: WorkerPool, failed: Callable[[Exception], None]) -> None:
        self._pool, self._failed = pool, failed
        self._closed = False

    def do(self, job: Job, *, urgency: int = 0) -> None:
        """Do a job after all that are as urgent or more so, also those of other workers."""
        if not self._closed:
            self._pool.put(self, job, urgency)

    @property
    def busy(self) -> bool:
        """Whether something is being done, or waits."""
        return self._pool.has(self)

    def close(self) -> None:
        """Begin no other job."""
        self._closed = True
        self._pool.drop(self)

    def run(self, job: Job) -> None:
        """Do a job in the calling thread."""
        if self._closed:
            return
        try:
            job()
        except Exception as error:  # the caller is in another thread
            if not self._closed:
                self._failed(error)
