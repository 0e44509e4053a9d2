"""Checks of Zarr stores: the codecs that their documents name, and the sizes of their arrays.

A codec of a store is a Python class that decodes its chunks, and one of them unpickles, so a store
could execute code. A store is opened only through :class:`CheckedStore`, which refuses all codecs
but those of a list, in every document that Zarr reads.
"""

from __future__ import annotations

import asyncio
import json
import math
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import zarr
from zarr.abc.buffer import Buffer, BufferPrototype
from zarr.abc.store import ByteRequest, Store
from zarr.storage import LocalStore, WrapperStore

from flowtex._util.memory import check_memory
from flowtex.errors import FieldError

#: Documents from which Zarr takes metadata of arrays, of both formats.
DOCUMENTS = ("zarr.json", ".zarray", ".zgroup", ".zmetadata")
#: Ending of documents, and of their names in others, that have attributes alone.
ATTRIBUTES = ".zattrs"
#: Codecs of bytes and numbers in Zarr 2; in Zarr 3 their names begin with ``numcodecs.``.
NUMBER_CODECS = frozenset(
    (
        *("blosc", "bz2", "gzip", "lz4", "lzma", "zlib", "zstd"),
        *("astype", "bitround", "delta", "fixedscaleoffset", "packbits", "quantize", "shuffle"),
        *("adler32", "crc32", "crc32c", "fletcher32", "jenkins_lookup3"),
        *("pcodec", "zfpy"),
    )
)
#: Codecs of texts and bytes of any length.
TEXT_CODECS = frozenset(("vlen-bytes", "vlen-utf8"))
#: Codecs of Zarr 2.
OLD_CODECS = NUMBER_CODECS | TEXT_CODECS | {"categorize"}
#: Codecs of Zarr 3.
CODECS = TEXT_CODECS | {
    *("blosc", "bytes", "cast_value", "crc32c", "endian", "gzip", "scale_offset"),
    *("sharding_indexed", "transpose", "zstd"),
    *(f"numcodecs.{name}" for name in NUMBER_CODECS),
}
#: Most bytes of a number.
NUMBER_BYTES = 8


class CheckedStore(WrapperStore[Store]):
    """A store of Zarr's that raises a FieldError for a document with a codec that is not listed."""

    async def get(
        self, key: str, prototype: BufferPrototype, byte_range: ByteRequest | None = None
    ) -> Buffer | None:
        """Return an object or a part of it, ``None`` for a missing one.

        Raises
        ------
        FieldError
            When the object is a metadata document that fails :func:`check_document`.
        """
        result = await self._store.get(key, prototype, byte_range)
        folder, _, name = key.rpartition("/")
        if result is not None and name in DOCUMENTS:
            try:
                check_document(result.to_bytes(), folder)
            except FieldError:
                _expect_failures()
                raise
        return result


def _expect_failures() -> None:
    """Have asyncio print no error of the tasks that now read a store.

    Zarr reads all arrays at once, raises the first error, and leaves the others to asyncio.
    """
    for task in asyncio.all_tasks():
        task.add_done_callback(_take_error)


def _take_error(task: asyncio.Task[Any]) -> None:
    if not task.cancelled():
        task.exception()


def checked_folder(folder: Path) -> CheckedStore:
    """Return the store of Zarr's in a folder, to read."""
    return CheckedStore(LocalStore(folder, read_only=True))


def check_document(data: bytes, folder: str) -> None:
    """Raise a FieldError for metadata, of a node in a folder, with a codec that is not listed."""
    try:
        document = json.loads(data)
    except (ValueError, RecursionError):  # Zarr cannot read it either
        return
    _check_node(document, folder)


def _check_node(node: Any, name: str) -> None:
    if not isinstance(node, dict):
        return
    for codec, known in _codecs(node):
        if not (isinstance(codec, str) and codec in known):
            expected = ", ".join(sorted(known))
            raise FieldError(
                f"the array {name or 'at the root'} has the codec {str(codec)[:40]!r}, which is "
                f"refused, because a codec may run any program; expected {expected}. Write the "
                "array without it, or open the store with xarray and pass the dataset"
            )
    _check_sizes(node, name)
    for holder in (node, node.get("consolidated_metadata")):
        if isinstance(holder, dict):
            members = holder.get("metadata")
        else:
            members = None
        if isinstance(members, dict):
            for key, member in members.items():
                if not key.endswith(ATTRIBUTES):
                    _check_node(member, key.removesuffix("/.zarray"))


def _codecs(node: dict[str, Any]) -> Iterator[tuple[Any, frozenset[str]]]:
    """Yield the name of each codec in the metadata of an array, with the names that are allowed.

    A document may have entries of both formats, so all of them count.
    """
    for entry in (*_entries(node.get("filters")), *_entries(node.get("compressor"))):
        yield _name(entry, "id"), OLD_CODECS
    for entry in _chain(node):
        yield _name(entry, "name"), CODECS


def _chain(node: dict[str, Any]) -> Iterator[Any]:
    """Yield the entries of all codecs of Zarr 3, also of those inside of shards."""
    waiting = _entries(node.get("codecs"))
    while waiting:
        entry = waiting.pop()
        yield entry
        inner = _configuration(entry)
        waiting += _entries(inner.get("codecs"))
        waiting += _entries(inner.get("index_codecs"))


def _configuration(entry: Any) -> dict[str, Any]:
    if isinstance(entry, dict) and isinstance(entry.get("configuration"), dict):
        configuration: dict[str, Any] = entry["configuration"]
        return configuration
    return {}


def _check_sizes(node: dict[str, Any], name: str) -> None:
    """Raise a FieldError for a shape, or a chunk's shape, that is no list of whole numbers.

    Zarr takes ``true`` for 1, and divides by the sides of chunks.
    """
    _check_shape(node, "shape", 0, name)
    _check_shape(node, "chunks", 1, name)
    for entry in (node.get("chunk_grid"), *_chain(node)):
        _check_shape(_configuration(entry), "chunk_shape", 1, name)


def _check_shape(node: dict[str, Any], key: str, least: int, name: str) -> None:
    if key not in node:
        return
    shape = node[key]
    is_list = isinstance(shape, list)
    if is_list and all(type(side) is int and side >= least for side in shape):
        return
    raise FieldError(
        f"the array {name or 'at the root'} has the {key} {json.dumps(shape)[:80]}; expected a "
        f"list of whole numbers of {least} or more: the store is damaged, write or copy it again"
    )


def _entries(value: Any) -> list[Any]:
    if value is None:
        return []
    if isinstance(value, list):
        return [*value]
    return [value]


def _name(entry: Any, key: str) -> Any:
    if isinstance(entry, dict):
        return entry.get(key)
    return entry


def check_arrays(store: Store) -> None:
    """Raise a FieldError for a line of coordinates, or a chunk, that does not fit into memory.

    ``store`` is, or wraps, a :class:`CheckedStore`, which checks the codecs of its arrays.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of files beside the arrays
        members = zarr.open_group(store, mode="r").members(max_depth=None)
    for name, array in members:
        if not isinstance(array, zarr.Array):
            continue
        count = math.prod(array.chunks)
        if array.ndim < 2:
            count = max(count, math.prod(array.shape))
        check_memory(count * NUMBER_BYTES, f"the variable {name}")
