"""Caches: values that live as long as they are in use, and values that fit into some memory."""

from __future__ import annotations

import hashlib
import math
import weakref
from collections import OrderedDict
from collections.abc import Callable, Hashable, Iterable
from typing import Generic, Protocol, TypeVar

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex._util.forks import ProcessLock


class _Sized(Protocol):
    @property
    def nbytes(self) -> int: ...


K = TypeVar("K", bound=Hashable)
V = TypeVar("V")
S = TypeVar("S", bound=_Sized)


class _Gates:
    """One lock for each key that is being computed, so that other keys do not wait."""

    def __init__(self) -> None:
        # A lock lives as long as a thread holds it or waits for it.
        self._gates = weakref.WeakValueDictionary[Hashable, ProcessLock]()
        self._lock = ProcessLock()

    def of(self, key: Hashable) -> ProcessLock:
        with self._lock:
            gate = self._gates.get(key)
            if gate is None:
                gate = self._gates[key] = ProcessLock()
            return gate


class WeakCache(Generic[V]):
    """Values by key, each dropped when nothing else refers to it; for use by any thread."""

    def __init__(self) -> None:
        self._values = weakref.WeakValueDictionary[Hashable, V]()
        self._owned = weakref.WeakKeyDictionary[object, dict[Hashable, V]]()
        self._gates = _Gates()

    def get(self, key: Hashable, make: Callable[[], V], *, owner: object | None = None) -> V:
        """Return the value of a key, computed by the first thread that asks, without asking again.

        An ``owner`` has its own values for each key, which live as long as it does, and must not
        refer to it.
        """
        if owner is not None:
            key = (weakref.ref(owner), key)
        with self._gates.of(key):
            value = self._values.get(key)
            if value is None:
                value = make()
                if owner is not None:
                    self._owned.setdefault(owner, {})[key] = value
                self._values[key] = value
            return value


class ByteCache(Generic[K, S]):
    """Values by key, up to ``max_bytes`` by their ``nbytes``; those used longest ago are dropped.

    At least ``min_count`` stay, at most ``max_count``. All methods may be called from any thread.
    """

    def __init__(self, max_bytes: int, *, min_count: int = 1, max_count: float = math.inf) -> None:
        self.max_bytes = max_bytes
        self.min_count = min_count
        self.max_count = max_count
        self._values: OrderedDict[K, S] = OrderedDict()
        self._gates = _Gates()
        self._lock = ProcessLock()

    def __len__(self) -> int:
        return len(self._values)

    def __contains__(self, key: K) -> bool:
        return key in self._values

    @property
    def nbytes(self) -> int:
        """Size of all values together."""
        with self._lock:
            return self._size()

    def get(
        self, key: K, make: Callable[[], S], is_valid: Callable[[S], bool] = lambda _: True
    ) -> S:
        """Return the valid value of a key, computed once: threads that ask meanwhile wait."""
        with self._gates.of(key):
            value = self.peek(key)
            if value is None or not is_valid(value):
                value = make()
                self.put(key, value)
            return value

    def peek(self, key: K) -> S | None:
        """Return the value of a key and mark it as used; ``None`` where it is missing."""
        with self._lock:
            value = self._values.get(key)
            if value is not None:
                self._values.move_to_end(key)
            return value

    def put(self, key: K, value: S) -> None:
        """Set the value of a key, and drop others until all of them fit."""
        with self._lock:
            self._values[key] = value
            self._values.move_to_end(key)
            # Sizes are added up again: a value may have grown since it was put here.
            while len(self._values) > self.min_count and (
                len(self._values) > self.max_count or self._size() > self.max_bytes
            ):
                self._values.popitem(last=False)

    def values(self) -> list[S]:
        """Return all values, the one used last at the end."""
        with self._lock:
            return list(self._values.values())

    def clear(self) -> None:
        """Drop all values."""
        with self._lock:
            self._values.clear()

    def _size(self) -> int:
        return sum(value.nbytes for value in self._values.values())


def digest(*arrays: AnyArray, words: Iterable[object] = ()) -> bytes:
    """Return a hash, 16 bytes, of arrays' values, types and shapes, and of the words' ``repr``."""
    result = hashlib.blake2b(repr(tuple(words)).encode(), digest_size=16)
    for array in arrays:
        result.update(f"{array.dtype.str}{array.shape}".encode())
        result.update(np.ascontiguousarray(array).reshape(-1).view(np.uint8).data)
    return result.digest()
