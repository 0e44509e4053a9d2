from __future__ import annotations

import gc
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from flowtex._util.cache import ByteCache, WeakCache, digest


class Thing:
    """Something that can be referred to weakly and has a size."""

    def __init__(self, nbytes: int = 0) -> None:
        self.nbytes = nbytes


def test_a_value_is_shared_while_somebody_holds_it_and_dropped_afterwards() -> None:
    cache: WeakCache[Thing] = WeakCache()
    first = cache.get("key", Thing)
    assert cache.get("key", Thing) is first
    assert cache.get("other", Thing) is not first
    del first
    gc.collect()
    calls: list[str] = []

    def make() -> Thing:
        calls.append("key")
        return Thing()

    cache.get("key", make)
    assert calls == ["key"]


def test_a_value_with_an_owner_lives_as_long_as_the_owner() -> None:
    cache: WeakCache[Thing] = WeakCache()
    owner, other = Thing(), Thing()
    number = cache.get("key", lambda: Thing(7), owner=owner).nbytes
    gc.collect()
    assert number == cache.get("key", Thing, owner=owner).nbytes == 7
    assert cache.get("key", Thing, owner=other).nbytes == 0
    # Another object, even at the same address, gets its own value.
    held = cache.get("key", Thing, owner=owner)
    del owner
    gc.collect()
    assert cache.get("key", Thing, owner=Thing()) is not held


@pytest.mark.parametrize("kind", ["weak", "bytes"])
def test_threads_that_ask_together_get_one_value_and_other_keys_do_not_wait(kind: str) -> None:
    cache: WeakCache[Thing] | ByteCache[str, Thing]
    cache = WeakCache() if kind == "weak" else ByteCache(100)
    begun, go_on = threading.Event(), threading.Event()
    calls: list[str] = []

    def slow() -> Thing:
        calls.append("slow")
        begun.set()
        assert go_on.wait(10)
        return Thing()

    with ThreadPoolExecutor(4) as pool:
        first = pool.submit(cache.get, "slow", slow)
        assert begun.wait(10)
        second = pool.submit(cache.get, "slow", slow)
        assert isinstance(cache.get("quick", Thing), Thing)
        go_on.set()
        assert first.result(10) is second.result(10)
    assert calls == ["slow"]


def test_values_used_longest_ago_are_dropped_when_there_are_too_many_bytes() -> None:
    cache: ByteCache[str, Thing] = ByteCache(10)
    a, b = Thing(4), Thing(4)
    cache.put("a", a)
    cache.put("b", b)
    assert cache.get("a", Thing) is a
    cache.put("c", Thing(4))
    assert "a" in cache
    assert "b" not in cache
    assert cache.nbytes == 8
    assert cache.peek("b") is None


def test_a_digest_tells_values_types_shapes_and_words_apart() -> None:
    a = np.arange(6.0)
    several = [
        digest(a),
        digest(a + 1),
        digest(a.astype(np.float32)),
        digest(a.reshape(2, 3)),
        digest(a, words=("x",)),
        digest(a, a),
    ]
    assert len(set(several)) == len(several)
    assert digest(a.reshape(2, 3).T) == digest(np.ascontiguousarray(a.reshape(2, 3).T))
