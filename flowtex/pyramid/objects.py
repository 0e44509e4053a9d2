"""The objects of a store as they are read: what does not come is an error in plain words.

Zarr takes an object that is missing for one of zeros. That would draw land, or still water, where
data are lost, so here it is an error. Parts of shards that many tiles need, those of arrays over
the nodes, are kept as they came.
"""

from __future__ import annotations

import asyncio
import math
import re
import weakref
import zlib
from dataclasses import dataclass, replace
from typing import Any

from zarr import AsyncArray
from zarr.codecs import BloscCodec, GzipCodec, ShardingCodec
from zarr.storage import WrapperStore

from flowtex._util.cache import ByteCache
from flowtex.pyramid.places import MOST_REPEATS, ReadFault, fault_words, is_refused

#: Objects, or parts of them, that are on their way at once from one store.
MOST_READS = 16
#: Memory of what is kept of them, packed as it came.
CACHE_BYTES = 200_000_000
#: Files for a browser are read once, to check them.
_FILES = re.compile(r"^\d+/(flow|values|surface)/c/")
_CHUNK = re.compile(r"/c(/\d+)+$")
#: Parameters of the Blosc codec.
BLOSC_NAMES = ("typesize", "cname", "clevel", "shuffle", "blocksize")
#: The window of zlib for data with the header and the check sum of gzip.
_GZIP_WINDOW = 31


@dataclass(frozen=True)
class _Piece:
    buffer: Any

    @property
    def nbytes(self) -> int:
        return len(self.buffer) if self.buffer is not None else 0


class Objects(WrapperStore[Any]):
    """A store of Zarr's to read a pyramid from; errors are each a :class:`ReadFault`.

    One of others may be ``sparse``: it leaves chunks out that have nothing but the fill value.
    """

    def __init__(self, store: Any, *, sparse: bool = False) -> None:
        super().__init__(store)
        self._sparse = sparse
        self._kept: ByteCache[Any, _Piece] = ByteCache(CACHE_BYTES)
        self._gates: weakref.WeakValueDictionary[Any, asyncio.Lock] = weakref.WeakValueDictionary()
        self._reads = asyncio.Semaphore(MOST_READS)

    async def get(self, key: str, prototype: Any, byte_range: Any = None) -> Any:
        """Return an object or a part of it, ``None`` for a missing one that is no chunk."""
        if _FILES.match(key):
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
        if result is None and not self._sparse and _CHUNK.search(key):
            msg = f"{key} is missing"
            raise ReadFault(msg, missing=True)
        return result


class _BoundedGzip(GzipCodec):
    """gzip that unpacks as many bytes as a chunk has, and no more."""

    def _decode_sync(self, chunk_bytes: Any, chunk_spec: Any) -> Any:
        size = math.prod(chunk_spec.shape) * chunk_spec.dtype.to_native_dtype().itemsize
        unpacking = zlib.decompressobj(_GZIP_WINDOW)
        data = unpacking.decompress(chunk_bytes.to_bytes(), size + 1)
        if len(data) != size or not unpacking.eof:
            msg = f"a chunk does not unpack to the {size:,} bytes that its array declares"
            raise ValueError(msg)
        return chunk_spec.prototype.buffer.from_bytes(data)

    async def _decode_single(self, chunk_bytes: Any, chunk_spec: Any) -> Any:
        return await asyncio.to_thread(self._decode_sync, chunk_bytes, chunk_spec)


class _BoundedBlosc(BloscCodec):
    """Blosc of chunks that tell that they unpack to as many bytes as they have."""

    async def _decode_single(self, chunk_bytes: Any, chunk_spec: Any) -> Any:
        size = math.prod(chunk_spec.shape) * chunk_spec.dtype.to_native_dtype().itemsize
        # Blosc writes the size into bytes 4 to 8 of a chunk, and unpacks to no more.
        if int.from_bytes(chunk_bytes.to_bytes()[4:8], "little") != size:
            msg = f"a chunk does not unpack to the {size:,} bytes that its array declares"
            raise ValueError(msg)
        return await super()._decode_single(chunk_bytes, chunk_spec)


def bounded(array: Any) -> Any:
    """Return an array of Zarr's whose chunks take no more memory than the array declares."""

    def of(codec: Any) -> Any:
        if isinstance(codec, ShardingCodec):
            return replace(codec, codecs=tuple(map(of, codec.codecs)))
        if isinstance(codec, BloscCodec):
            return _BoundedBlosc(**{name: getattr(codec, name) for name in BLOSC_NAMES})
        return _BoundedGzip(level=codec.level) if isinstance(codec, GzipCodec) else codec

    metadata = replace(array.metadata, codecs=tuple(map(of, array.metadata.codecs)))
    return AsyncArray(metadata, array.store_path, array.config)
