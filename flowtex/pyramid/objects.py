"""The objects of a store as they are read: what does not come is an error in plain words.

Zarr takes an object that is missing for one of zeros. That would draw land, or still water, where
data are lost, so here it is an error. Parts of shards that many tiles need, those of arrays over
the nodes, are kept as they came.
"""

from __future__ import annotations

import asyncio
import json
import math
import re
import weakref
import zlib
from collections.abc import AsyncIterator, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from zarr import AsyncArray
from zarr.codecs import BloscCodec, GzipCodec, ShardingCodec
from zarr.core.buffer import default_buffer_prototype
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
#: What arrays of a velocity are called for the most part.
KNOWN_NAMES = (
    *("u", "v", "U", "V", "u10", "v10", "uo", "vo", "ua", "va", "ugos", "vgos"),
    *("water_u", "water_v", "uwnd", "vwnd"),
)
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
    """A store of Zarr's to read a pyramid from; errors are each a :class:`ReadFault`."""

    #: Whether chunks may be left out that have nothing but the fill value.
    sparse = False

    def __init__(self, store: Any) -> None:
        super().__init__(store)
        self._kept: ByteCache[Any, _Piece] = ByteCache(CACHE_BYTES)
        self._gates: weakref.WeakValueDictionary[Any, asyncio.Lock] = weakref.WeakValueDictionary()
        self._reads = asyncio.Semaphore(MOST_READS)

    async def get(self, key: str, prototype: Any, byte_range: Any = None) -> Any:
        """Return an object or a part of it, ``None`` for a missing one that is not a chunk."""
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
                    # An answer that was begun is not requested again by obstore.
                    if "Interrupted" in str(error) and trial < MOST_REPEATS:
                        continue
                    if is_refused(error) and key != "zarr.json" and not _CHUNK.search(key):
                        return None
                    msg = f"{key} {fault_words(error)}"
                    raise ReadFault(msg) from None
        if result is None and not self.sparse and _CHUNK.search(key):
            msg = f"{key} is missing"
            raise ReadFault(msg, missing=True)
        return result


class OthersObjects(Objects):
    """A store of others; on the web, where nothing is listed, arrays are found by their names."""

    sparse = True

    def __init__(self, store: Any, names: tuple[str, ...] = ()) -> None:
        super().__init__(store)
        self._names = names

    def __reduce__(self) -> Any:
        """Give what another process makes it of."""
        return OthersObjects, (self._store, self._names)

    async def list_dir(self, prefix: str) -> AsyncIterator[str]:
        """Give what is in a group: its levels, or the velocity with what lies along its axes."""
        try:
            listed = [name async for name in self._store.list_dir(prefix)]
        except Exception:
            listed = await self._found(prefix.strip("/"))
        for name in listed:
            yield name

    async def _found(self, group: str) -> list[str]:
        levels = level_names((await self._metadata(group)).get("attributes", {}))
        some = await self._present(group, levels or (*self._names, *KNOWN_NAMES))
        beside = {str(name) for one in some.values() for name in one.get("dimension_names") or ()}
        return list(some | await self._present(group, beside - {*some}))

    async def _present(self, group: str, names: Iterable[str]) -> dict[str, dict[str, Any]]:
        found = await asyncio.gather(*(self._metadata(f"{group}/{name}") for name in names))
        return {name: one for name, one in zip(names, found, strict=True) if one}

    async def _metadata(self, path: str) -> dict[str, Any]:
        """Return the metadata of a group or an array; empty if it has none."""
        key = f"{path}/zarr.json".lstrip("/")
        buffer = await self.get(key, default_buffer_prototype())
        metadata = {} if buffer is None else json.loads(buffer.to_bytes())
        return metadata if isinstance(metadata, dict) else {}


def level_names(attributes: Mapping[str, Any]) -> list[str]:
    """Return the paths of levels, from the metadata of ndpyramid or of zarr-conventions."""
    told = attributes.get("multiscales")
    if isinstance(told, list):  # of the former there is one in a list
        told = told[0] if told else {}
    if not isinstance(told, dict):
        return []
    levels = [*told.get("layout", []), *told.get("datasets", [])]
    return [str(one.get("asset", one.get("path"))) for one in levels if isinstance(one, dict)]


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
    """Blosc for chunks whose header declares as many bytes as they decompress to."""

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
