"""Locks, threads, caches and children in a forked process, and at the end of the interpreter."""

from __future__ import annotations

import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest
from forked import forked, needs_forks
from waiting import PATIENCE_S

from flowtex._util.cache import ByteCache, WeakCache
from flowtex._util.child.child import FORKS, INHERITED, Child, ChildError
from flowtex._util.forks import ProcessLock, ProcessSemaphore
from flowtex._util.progress import pool

pytestmark = [needs_forks, pytest.mark.threads]


@contextmanager
def thread_inside(guard: Any) -> Iterator[None]:
    """Have another thread hold a lock."""
    inside, leave = threading.Event(), threading.Event()

    def hold() -> None:
        with guard:
            inside.set()
            leave.wait(PATIENCE_S)

    thread = threading.Thread(target=hold)
    thread.start()
    inside.wait(PATIENCE_S)
    yield
    leave.set()
    thread.join()


@pytest.mark.parametrize("guard", [ProcessLock(), ProcessSemaphore(1)], ids=["lock", "semaphore"])
def test_lock_of_another_thread_is_free_in_forked_process(guard: Any) -> None:
    def enter() -> str:
        with guard:
            return "inside"

    with thread_inside(guard):
        assert forked(enter) == "inside"
    assert enter() == "inside"


def test_lock_of_forking_thread_stays_locked_in_forked_process() -> None:
    lock = ProcessLock()

    def taken_by_another_thread() -> bool:
        taken: list[bool] = []
        thread = threading.Thread(target=lambda: taken.append(lock.acquire(0.0)))
        thread.start()
        thread.join()
        return taken[0]

    with lock:
        assert not forked(taken_by_another_thread)
    assert taken_by_another_thread()


def test_pool_with_busy_and_idle_threads_works_in_forked_process() -> None:
    lock = threading.Lock()
    threads = pool(2, "test")
    with threads:
        assert list(threads.map(abs, [-1, -2])) == [1, 2]
        with lock:
            waiting = threads.submit(lock.acquire)
            assert forked(lambda: list(threads.map(abs, [-3, -4, -5]))) == [3, 4, 5]
        assert waiting.result(PATIENCE_S)
        lock.release()
        assert threads.submit(abs, -6).result(PATIENCE_S) == 6


def test_caches_work_in_forked_process_while_a_thread_computes_a_value() -> None:
    sized: ByteCache[str, Any] = ByteCache(1000)
    weak: WeakCache[Any] = WeakCache()
    begun, end = threading.Event(), threading.Event()

    def slow() -> Any:
        begun.set()
        end.wait(PATIENCE_S)
        return np.zeros(1)

    def values() -> tuple[float, float]:
        ones = weak.get("key", lambda: np.ones(1))
        return float(sized.get("key", lambda: np.ones(1))[0]), float(ones[0])

    for get in (sized.get, weak.get):
        thread = threading.Thread(target=get, args=("key", slow))
        thread.start()
        begun.wait(PATIENCE_S)
        begun.clear()
    try:
        assert forked(values) == (1.0, 1.0)
    finally:
        end.set()


@pytest.mark.parametrize("forks", [True, False] if FORKS else [False])
def test_forked_process_has_children_of_its_own(forks: bool) -> None:
    child = Child("child_handler:Handler", forks=forks)

    def number(asked: Child) -> Any:
        answer, _ = asked.request({"do": "sum", "one": 2, "other": 3}, timeout=PATIENCE_S)
        return answer["pid"]

    def ask() -> tuple[str, Any]:
        with pytest.raises(ChildError) as caught:
            number(child)
        child.close()
        own = Child("child_handler:Handler", forks=forks)
        result = number(own)
        own.close()
        return str(caught.value), result

    try:
        before = number(child)
        told, other = forked(ask)
        assert told == INHERITED and other != before
        assert number(child) == before
    finally:
        child.close()


def test_dask_computes_in_forked_process() -> None:
    array = pytest.importorskip("dask.array").arange(8, chunks=2)
    assert array.sum().compute() == 28
    assert forked(lambda: int(array.sum().compute())) == 28


ENDING = """
import atexit, threading
from flowtex._util.progress import pool, start

threads = pool(2, "test")

def last():
    print(list(threads.map(abs, [-1, -2])), list(pool(2, "late").map(abs, [-3])))
    start(lambda: print("started"), "late")

atexit.register(last)
list(threads.map(abs, [-1, -2]))
threading.Thread(target=lambda: threading.main_thread().join() or last()).start()
"""


def test_pools_work_while_the_interpreter_ends() -> None:
    done = subprocess.run(
        [sys.executable, "-c", ENDING], capture_output=True, text=True, timeout=PATIENCE_S
    )
    assert done.stdout.splitlines() == ["[1, 2] [3]", "started"] * 2
    assert (done.stderr, done.returncode) == ("", 0)
