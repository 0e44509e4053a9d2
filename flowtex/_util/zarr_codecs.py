"""Codecs of Zarr that unpack no more bytes than the array of a chunk declares."""

from __future__ import annotations

import asyncio
import math
import zlib
from dataclasses import replace

from zarr import AsyncArray
from zarr.abc.buffer import Buffer
from zarr.abc.codec import Codec
from zarr.abc.store import Store
from zarr.codecs import BloscCodec, GzipCodec, ShardingCodec
from zarr.storage import StorePath

from flowtex._util.zarr_internals import ArraySpec, ArrayV3Metadata

#: Parameters of the Blosc codec.
BLOSC_NAMES = ("typesize", "cname", "clevel", "shuffle", "blocksize")
_GZIP_WINDOW = 31  #: The window of zlib for data with the header and the check sum of gzip.


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
