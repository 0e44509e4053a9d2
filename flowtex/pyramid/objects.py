"""The objects of a store as they are read; a missing one is an error in plain words.

Zarr takes a missing object for zeros. That would draw land, or still water, where data are lost, so
here it is an error. Parts of shards that many tiles need, those of arrays over
the nodes, are kept as they came.
"""

from __future__ import annotations

import asyncio
import math
import re
import weakref
import zlib
from collections.abc import AsyncIterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from zarr import AsyncArray
from zarr.abc.codec import Codec
from zarr.abc.store import ByteRequest, Store
from zarr.codecs import BloscCodec, GzipCodec, ShardingCodec
from zarr.core.array_spec import ArraySpec
from zarr.core.buffer import Buffer, BufferPrototype
from zarr.core.metadata import ArrayV3Metadata
from zarr.storage import StorePath, WrapperStore

from flowtex._util.cache import ByteCache
from flowtex._util.forks import renew_after_fork
from flowtex.errors import FieldError
from flowtex.pyramid.places import MOST_REPEATS, ReadFault, fault_words, is_refused

MOST_READS = 16  #: Most objects, or parts of them, that are read at once from one store.
CACHE_BYTES = 200_000_000  #: Memory of the objects that are kept, as they were compressed.
#: Files for a browser are read once, to check them.
_FILES = re.compile(r"^\d+/(flow|values|surface)/c/")
_CHUNK = re.compile(r"/c(/\d+)+$")
#: Parameters of the Blosc codec.
BLOSC_NAMES = ("typesize", "cname", "clevel", "shuffle", "blocksize")
_GZIP_WINDOW = 31  #: The window of zlib for data with the header and the check sum of gzip.


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


class _BoundedGzip(GzipCodec):
    """gzip that unpacks as many bytes as a chunk has, and no more."""

    def _decode_sync(self, chunk_bytes: Buffer, chunk_spec: ArraySpec) -> Buffer:
        size = math.prod(chunk_spec.shape) * chunk_spec.dtype.to_native_dtype().itemsize
        unpacking = zlib.decompressobj(_GZIP_WINDOW)
        data = unpacking.decompress(chunk_bytes.to_bytes(), size + 1)
        if len(data) != size or not unpacking.eof:
            raise ValueError(
                f"a chunk does not unpack to the {size:,} bytes that its array declares"
            )
        return chunk_spec.prototype.buffer.from_bytes(data)

    async def _decode_single(self, chunk_bytes: Buffer, chunk_spec: ArraySpec) -> Buffer:
        return await asyncio.to_thread(self._decode_sync, chunk_bytes, chunk_spec)


class _BoundedBlosc(BloscCodec):
    """Blosc for chunks whose header declares as many bytes as they decompress to."""

    def _decode_sync(self, chunk_bytes: Buffer, chunk_spec: ArraySpec) -> Buffer:
        size = math.prod(chunk_spec.shape) * chunk_spec.dtype.to_native_dtype().itemsize
        # Blosc writes the size into bytes 4 to 8 of a chunk, and unpacks to no more.
        if int.from_bytes(chunk_bytes.to_bytes()[4:8], "little") != size:
            raise ValueError(
                f"a chunk does not unpack to the {size:,} bytes that its array declares"
            )
        return super()._decode_sync(chunk_bytes, chunk_spec)


def bounded(metadata: ArrayV3Metadata, store: Store, path: str) -> AsyncArray[ArrayV3Metadata]:
    """Return an array of Zarr's whose chunks take no more memory than the array declares."""

    def limited(codec: Codec) -> Codec:
        if isinstance(codec, ShardingCodec):
            return replace(codec, codecs=tuple(map(limited, codec.codecs)))
        if isinstance(codec, BloscCodec):
            return _BoundedBlosc(**{name: getattr(codec, name) for name in BLOSC_NAMES})
        if isinstance(codec, GzipCodec):
            return _BoundedGzip(level=codec.level)
        return codec

    metadata = replace(metadata, codecs=tuple(map(limited, metadata.codecs)))
    return AsyncArray(metadata, StorePath(store, path))
