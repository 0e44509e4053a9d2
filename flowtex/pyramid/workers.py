"""Workers for the tasks: threads of this process, or those of a Dask cluster."""

from __future__ import annotations

import ctypes
import os
import pickle
import traceback
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import FIRST_COMPLETED, wait
from contextlib import suppress
from functools import cache
from itertools import islice
from typing import Any

from flowtex._util.extras import import_extra
from flowtex._util.progress import pool
from flowtex.errors import FieldError
from flowtex.pyramid.places import PyramidError, plain_faults

#: Most memory of a task that makes a part of a level, and of one that traces a tile or the root, as
#: ``benchmarks/pyramid.py`` measures; and that of a process, for its imports.
PART_BYTES, TILE_BYTES, OWN_BYTES = 500_000_000, 1_500_000_000, 500_000_000
#: Times that a task is tried.
MOST_TRIALS = 3
#: Parameters of glibc's ``mallopt``, and bytes: those of the heap that may stay free, and those of
#: an array above which it has separate pages, which are returned when it is freed.
TRIM, MMAP = (-1, 64 << 20), (-3, 1 << 20)
#: Most bytes sent to the workers of a cluster; a larger source contains its data.
MOST_SENT = 64_000_000


class Threads:
    """Threads of this process: one for each core, or as many as some memory has room for."""

    def __init__(self, memory: int | str | None = None) -> None:
        self._memory: int | None = None
        if memory is not None:
            try:
                self._memory = int(import_extra("dask.utils", "store").parse_bytes(memory))
            except (ValueError, TypeError, AttributeError) as error:
                msg = f"memory is {memory!r}; expected a number of bytes, or a text such as '2GB'"
                raise FieldError(msg) from error

    def count(self, need: int) -> int:
        """Return how many tasks run at once that need this many bytes each."""
        cores = os.cpu_count() or 1
        if self._memory is None:
            return cores
        return max(min(cores, (self._memory - OWN_BYTES) // need), 1)

    def run(
        self,
        function: Callable[..., None],
        tasks: Sequence[tuple[Any, ...]],
        need: int,
        *arguments: Any,
    ) -> Generator[Exception | None]:
        """Call a function with ``arguments`` and each task; yield the error of each or ``None``."""
        if not tasks:
            return

        def tried(task: tuple[Any, ...]) -> Exception | None:
            result: Exception | None = None
            for _ in range(MOST_TRIALS):
                try:
                    with plain_faults():
                        function(*arguments, *task)
                except Exception as error:
                    # The frames of the error hold all that the task had in memory.
                    for cause in (error, error.__cause__, error.__context__):
                        if cause is not None:
                            traceback.clear_frames(cause.__traceback__)
                    result = error
                else:
                    return None
            return result

        count, left = self.count(need), iter(tasks)
        with pool(count, "flowtex-pyramid") as threads:
            # No more tasks wait than keep all workers busy: the caller may stop after a failure.
            running = {threads.submit(tried, task) for task in islice(left, 2 * count)}
            try:
                while running:
                    done, running = wait(running, return_when=FIRST_COMPLETED)
                    running |= {threads.submit(tried, task) for task in islice(left, len(done))}
                    yield from [future.result() for future in done]
            finally:
                threads.shutdown(wait=True, cancel_futures=True)

    def close(self) -> None:
        """Do nothing: threads leave nothing open."""


class Cluster(Threads):
    """Workers of a Dask cluster, which open the store themselves."""

    def __init__(self, scheduler: Any) -> None:
        super().__init__()
        distributed = import_extra("distributed", "store")
        self._owns_client = isinstance(scheduler, str)
        self._client = distributed.Client(scheduler) if self._owns_client else scheduler
        self._as_completed = distributed.as_completed

    def run(
        self,
        function: Callable[..., None],
        tasks: Sequence[tuple[Any, ...]],
        need: int,
        *arguments: Any,
    ) -> Generator[Exception | None]:
        """Yield the error of each task, or ``None``, in the order in which they end."""
        if not tasks:
            return
        packed = [_packed(argument) for argument in arguments]
        if None in packed:
            # The source contains its data, which would go to each worker.
            yield from super().run(function, tasks, need, *arguments)
            return
        # Results of tasks outlive the worker that has them.
        sent = [self._client.submit(pickle.loads, data, pure=False) for data in packed]
        futures = self._client.map(
            _run_task, tasks, function=function, inputs=sent, pure=False, retries=MOST_TRIALS - 1
        )
        try:
            for future in self._as_completed(futures):
                yield future.exception()
                future.release()
        finally:
            self._client.cancel(futures)

    def close(self) -> None:
        """Disconnect from a cluster that was connected by its address."""
        if self._owns_client:
            self._client.close()


def _run_task(task: tuple[Any, ...], *, function: Callable[..., None], inputs: list[Any]) -> None:
    _set_allocator()
    with plain_faults():
        function(*inputs, *task)


@cache
def _set_allocator() -> None:
    """Let a worker return freed memory.

    Otherwise half of it stays with the allocator, and Dask pauses the worker for good. The setting
    of Dask's nannies returns everything, but tasks take half as long again.
    """
    with suppress(OSError, AttributeError):  # of another C library
        libc = ctypes.CDLL("libc.so.6")
        for parameter, value in (TRIM, MMAP):
            libc.mallopt(parameter, value)


def _packed(value: object) -> bytes | None:
    """Return a value as bytes to send; ``None`` where these are too many."""
    try:
        data: bytes = import_extra("cloudpickle", "store").dumps(value)
    except Exception as error:
        msg = (
            f"the dataset cannot be sent to the workers ({type(error).__name__}: {error}); open it "
            "from a file or a store, or build without a scheduler"
        )
        raise PyramidError(msg) from error
    return data if len(data) <= MOST_SENT else None
