"""The objects of a store as they are read: what does not come is an error in plain words.

Zarr takes an object that is missing for one of zeros. That would draw land, or still water, where
data are lost, so here it is an error. Parts of shards that many tiles need, those of arrays over
the nodes, are kept as they came.
"""

from __future__ import annotations

import asyncio
import re
import weakref
from dataclasses import dataclass
from typing import Any

from zarr.storage import WrapperStore

from flowtex._util.cache import ByteCache
from flowtex.pyramid.places import MOST_REPEATS, ReadFault, fault_words, is_refused

__all__ = ["Objects"]

#: Objects, or parts of them, that are on their way at once from one store.
MOST_READS = 16
#: Memory of what is kept of them, packed as it came.
CACHE_BYTES = 200_000_000
#: Traces of a tile are read once: whoever draws keeps them.
_TRACES = re.compile(r"^\d+/traces/c/")
_CHUNK = re.compile(r"/c(/\d+)+$")


@dataclass(frozen=True)
class _Piece:
    buffer: Any

    @property
    def nbytes(self) -> int:
        return len(self.buffer) if self.buffer is not None else 0


class Objects(WrapperStore[Any]):
    """A store of Zarr's to read a pyramid from; errors are each a :class:`ReadFault`."""

    def __init__(self, store: Any) -> None:
        super().__init__(store)
        self._kept: ByteCache[Any, _Piece] = ByteCache(CACHE_BYTES)
        self._gates: weakref.WeakValueDictionary[Any, asyncio.Lock] = weakref.WeakValueDictionary()
        self._reads = asyncio.Semaphore(MOST_READS)

    async def get(self, key: str, prototype: Any, byte_range: Any = None) -> Any:
        """Return an object or a part of it, ``None`` for a missing one that is no chunk."""
        if _TRACES.match(key):
            return await self._read(key, prototype, byte_range)
        name = (key, repr(byte_range))
        gate = self._gates.setdefault(name, asyncio.Lock())
        async with gate:
            piece = self._kept.peek(name)
            if piece is None:
                piece = _Piece(await self._read(key, prototype, byte_range))
                self._kept.put(name, piece)
            return piece.buffer

    async def _read(self, key: str, prototype: Any, byte_range: Any) -> Any:
        async with self._reads:
            for trial in range(MOST_REPEATS + 1):
                try:
                    result = await self._store.get(key, prototype, byte_range)
                    break
                except Exception as error:
                    # An answer that was begun is not asked for again by obstore.
                    if "Interrupted" in str(error) and trial < MOST_REPEATS:
                        continue
                    if is_refused(error) and key != "zarr.json" and not _CHUNK.search(key):
                        return None
                    msg = f"{key} {fault_words(error)}"
                    raise ReadFault(msg) from None
        if result is None and _CHUNK.search(key):
            msg = f"{key} is missing"
            raise ReadFault(msg)
        return result
