"""The objects of a store as they are read; a missing one is an error in plain words.

Zarr takes a missing object for zeros. That would draw land, or still water, where data are lost, so
here it is an error. Parts of shards that many tiles need, those of arrays over
the nodes, are kept as they came.
"""

from __future__ import annotations

import asyncio
import re
import weakref
from collections.abc import AsyncIterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from zarr.abc.buffer import Buffer, BufferPrototype
from zarr.abc.store import ByteRequest, Store
from zarr.storage import WrapperStore

from flowtex._util.cache import ByteCache
from flowtex._util.forks import renew_after_fork
from flowtex.errors import FieldError
from flowtex.pyramid.places import MOST_REPEATS, ReadFault, fault_words, is_refused

MOST_READS = 16  #: Most objects, or parts of them, that are read at once from one store.
CACHE_BYTES = 200_000_000  #: Memory of the objects that are kept, as they were compressed.
#: Files for a browser are read once, to check them.
_FILES = re.compile(r"^\d+/(flow|values|surface)/c/")
_CHUNK = re.compile(r"/c(/\d+)+$")


@dataclass(frozen=True)
class _Kept:
    buffer: Buffer | None

    @property
    def nbytes(self) -> int:
        if self.buffer is not None:
            return len(self.buffer)
        return 0


class Objects(WrapperStore[Store]):
    """A store of Zarr's to read a pyramid from; errors are each a :class:`ReadFault`."""

    def __init__(self, store: Store, *, sparse: bool = False) -> None:
        super().__init__(store)
        self._sparse = sparse  # whether chunks of the fill value may be missing
        self._kept: ByteCache[tuple[str, str], _Kept] = ByteCache(CACHE_BYTES)
        self.renew()
        renew_after_fork(self)

    def renew(self) -> None:
        """Make locks for the event loop of this process; a forked one has another."""
        self._gates = weakref.WeakValueDictionary[tuple[str, str], asyncio.Lock]()
        self._reads = asyncio.Semaphore(MOST_READS)

    def __reduce__(self) -> tuple[Any, tuple[Store]]:
        """Return a function and an argument with which another process makes it."""
        return partial(Objects, sparse=self._sparse), (self._store,)

    async def get(
        self, key: str, prototype: BufferPrototype, byte_range: ByteRequest | None = None
    ) -> Buffer | None:
        """Return an object or a part of it, ``None`` for a missing one that is not a chunk."""
        if _FILES.match(key):
            return await self._read(key, prototype, byte_range)
        name = (key, repr(byte_range))
        gate = self._gates.setdefault(name, asyncio.Lock())
        async with gate:
            piece = self._kept.peek(name)
            if piece is None:
                piece = _Kept(await self._read(key, prototype, byte_range))
                self._kept.put(name, piece)
            return piece.buffer

    async def get_ranges(
        self,
        key: str,
        byte_ranges: Sequence[ByteRequest | None],
        *,
        prototype: BufferPrototype,
        **limits: int | None,
    ) -> AsyncIterator[Sequence[tuple[int, Buffer | None]]]:
        """Yield parts of an object with their positions in ``byte_ranges``.

        Zarr 3.2 and later read the chunks of a shard by this method. That of ``WrapperStore`` would
        ask the wrapped store, without what is kept here and without errors for missing objects.
        """
        reads = [self.get(key, prototype, byte_range) for byte_range in byte_ranges]
        yield list(enumerate(await asyncio.gather(*reads)))

    @property
    def _supports_sync_io(self) -> bool:
        """Whether Zarr may read by ``get_sync``, which would go past :meth:`get`."""
        return False

    async def _read(
        self, key: str, prototype: BufferPrototype, byte_range: ByteRequest | None
    ) -> Buffer | None:
        async with self._reads:
            for trial in range(MOST_REPEATS + 1):
                try:
                    result = await self._store.get(key, prototype, byte_range)
                    break
                except FieldError:  # a document that is refused
                    raise
                except Exception as error:
                    # obstore does not repeat a request whose answer was cut off.
                    if "Interrupted" in str(error) and trial < MOST_REPEATS:
                        continue
                    if is_refused(error) and key != "zarr.json" and not _CHUNK.search(key):
                        return None
                    raise ReadFault(f"{key} {fault_words(error)}") from None
        if result is None and not self._sparse and _CHUNK.search(key):
            raise ReadFault(f"{key} is missing", missing=True)
        return result
