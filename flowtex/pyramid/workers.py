"""Who does the tasks: threads of this process, or the workers of a Dask cluster."""

from __future__ import annotations

import ctypes
import io
import os
import traceback
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import FIRST_COMPLETED, wait
from contextlib import suppress
from functools import cache
from itertools import islice
from typing import Any

from flowtex._util.extras import import_extra
from flowtex._util.notices import notify
from flowtex._util.threads import pool
from flowtex.errors import FieldError
from flowtex.pyramid.places import PyramidError, plain_faults

#: Most memory that a task takes: one that makes a part of a level, and one that traces a tile or
#: the root, as ``benchmarks/pyramid.py`` measures. A process has its own besides, for what is
#: imported.
PART_BYTES, TILE_BYTES, OWN_BYTES = 500_000_000, 1_500_000_000, 500_000_000
#: Times that a task is tried.
MOST_TRIALS = 3
#: Parameters of glibc's ``mallopt``, and bytes: arrays above the second have their own pages, which
#: go back when they are freed; of others so much may stay free.
TRIM, MMAP = (-1, 64 << 20), (-3, 1 << 20)
#: Size of what may be sent to the workers of a cluster; a source that is larger holds its data.
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
            if self._memory < OWN_BYTES + TILE_BYTES:
                notify(
                    f"memory is {_words(self._memory)}, but a task may need {_words(TILE_BYTES)} "
                    f"in addition to {_words(OWN_BYTES)} for all tasks; tasks run one at a time, "
                    "and may exceed the limit",
                    UserWarning,
                )

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
        *given: Any,
    ) -> Generator[Exception | None]:
        """Yield what became of tasks as they end; arguments are ``given`` and those of a task."""
        if not tasks:
            return

        def tried(task: tuple[Any, ...]) -> Exception | None:
            result: Exception | None = None
            for _ in range(MOST_TRIALS):
                try:
                    with plain_faults():
                        function(*given, *task)
                except Exception as error:
                    # The frames that it came through hold all that the task had in memory.
                    for one in (error, error.__cause__, error.__context__):
                        if one is not None:
                            traceback.clear_frames(one.__traceback__)
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
        """Nothing is kept open."""


class Cluster(Threads):
    """Workers of a Dask cluster, which open the store themselves."""

    def __init__(self, scheduler: Any) -> None:
        super().__init__()
        distributed = import_extra("distributed", "store")
        self._own = isinstance(scheduler, str)
        self._client = distributed.Client(scheduler) if self._own else scheduler
        self._as_completed = distributed.as_completed
        self._check_memory()

    def run(
        self,
        function: Callable[..., None],
        tasks: Sequence[tuple[Any, ...]],
        need: int,
        *given: Any,
    ) -> Generator[Exception | None]:
        """Yield what became of each task, in the order in which they end."""
        if not tasks:
            return
        packed = [_packed(one) for one in given]
        if None in packed:
            # It holds its data, which would go to each worker.
            yield from super().run(function, tasks, need, *given)
            return
        # Made by a task, what is given outlives the worker that has it.
        sent = [self._client.submit(_unpacked, data, pure=False) for data in packed]
        futures = self._client.map(
            _called, tasks, function=function, given=sent, pure=False, retries=MOST_TRIALS - 1
        )
        try:
            for future in self._as_completed(futures):
                yield future.exception()
                future.release()
        finally:
            self._client.cancel(futures)

    def close(self) -> None:
        """Leave the cluster, where it was given by its address."""
        if self._own:
            self._client.close()

    def _check_memory(self) -> None:
        """Say which workers have less memory than tasks may take before Dask pauses them."""
        dask = import_extra("dask", "store")
        share = dask.config.get("distributed.worker.memory.pause", 0.8) or 1.0
        workers = self._client.scheduler_info(n_workers=-1)["workers"]
        needs = {
            name: (worker["memory_limit"], (OWN_BYTES + worker["nthreads"] * TILE_BYTES) / share)
            for name, worker in workers.items()
        }
        few = {name: (limit, need) for name, (limit, need) in needs.items() if 0 < limit < need}
        if few:
            name, (limit, need) = next(iter(few.items()))
            notify(
                f"{len(few)} of {len(workers)} workers have too little memory: {name} has "
                f"{_words(limit)}, but its threads may need {_words(need)}; give it more memory, "
                "or fewer threads",
                UserWarning,
            )


def _called(task: tuple[Any, ...], *, function: Callable[..., None], given: list[Any]) -> None:
    _set_allocator()
    with plain_faults():
        function(*given, *task)


@cache
def _set_allocator() -> None:
    """Have a worker give memory back.

    Without, half of it stays with the allocator, and Dask pauses the worker for good. What nannies
    of Dask set gives everything back, for which tasks take half as long again.
    """
    with suppress(OSError, AttributeError):  # of another C library
        libc = ctypes.CDLL("libc.so.6")
        for parameter, value in (TRIM, MMAP):
            libc.mallopt(parameter, value)


class _Limited(io.BytesIO):
    """A file in memory that takes so much and no more."""

    def write(self, data: Any) -> int:
        """Take some bytes."""
        if self.tell() + memoryview(data).nbytes > MOST_SENT:
            raise _TooLargeError
        return super().write(data)


class _TooLargeError(Exception):
    """There is more than is sent."""


def _packed(thing: Any) -> bytes | None:
    """Return something as bytes that are sent; ``None`` where these are too many."""
    file = _Limited()
    try:
        import_extra("cloudpickle", "store").Pickler(file).dump(thing)
    except _TooLargeError:
        return None
    except Exception as error:
        msg = (
            f"the dataset cannot be sent to the workers ({type(error).__name__}: {error}); open it "
            "from a file or a store, or build without a scheduler"
        )
        raise PyramidError(msg) from error
    return file.getvalue()


def _unpacked(data: bytes) -> Any:
    import pickle

    return pickle.loads(data)


def _words(size: float) -> str:
    return f"{size / 1e9:.3g} GB"
