"""The wire format between Python and the client in a browser.

A header, JSON with the shaders' text, comes before parts: named arrays, little endian, each with
its description of name, type, shape and digest. The widget sends descriptions in a message and the
arrays as its buffers, the app serves several parts as one file, an exported page holds each part as
text. ``client/src/protocol.ts`` is the other side.
"""

from __future__ import annotations

import base64
import gzip
import json
import struct
import zlib
from collections.abc import Mapping
from itertools import product
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import AnyArray
from flowtex._util.cache import digest

FORMAT = 6  #: Number of the form of header and parts; a client refuses one that it does not know.
COMPRESSION_LEVEL = 6  #: Level of gzip for the parts of a page.
MOST_DIFFERENCES = 2  #: Highest order of differences of a part along an axis.
SAMPLE = 20_000  #: Numbers of the sample from which the best order is chosen.
LEAST_ROWS = 4  #: Least rows of that sample.
#: Integer types that pack floats, which are multiples of a unit, and their bits.
WHOLE = {"float16": ("<i2", 15), "float32": ("<i4", 24)}
MOST_SCALE = 100  #: Greatest exponent of a unit.

#: Values for JSON by name: a header, a section of one, or the description of a part.
Header: TypeAlias = dict[str, Any]
Parts: TypeAlias = dict[str, AnyArray]  #: Arrays by the names of parts.


def part_info(name: str, array: AnyArray) -> Header:
    """Return the description of a part, for JSON; equal arrays have equal digests."""
    return {
        "name": name,
        "dtype": array.dtype.name,
        "shape": list(array.shape),
        "digest": digest(array).hex(),
    }


def part_buffer(array: AnyArray) -> memoryview:
    """Return the bytes of a part, without a copy where they lie in order."""
    return np.ascontiguousarray(array).reshape(-1).view(np.uint8).data


def parts_file(parts: Mapping[str, AnyArray], *, planes: bool = False) -> bytes:
    """Return parts as one file; as ``planes``, except for texts, if gzip follows.

    It is the length of the descriptions as four bytes, the descriptions in JSON with the number of
    bytes of each part, and the arrays one after the other.
    """
    infos = []
    buffers = []
    packing: Header
    buffer: bytes | memoryview
    for name, array in parts.items():
        if planes and array.ndim > 1:
            packing, buffer = _packed(array)
        else:
            packing = {}
            buffer = part_buffer(array)
        infos.append({**part_info(name, array), "bytes": array.nbytes, **packing})
        buffers.append(buffer)
    text = json.dumps(infos).encode()
    return b"".join((struct.pack("<I", len(text)), text, *buffers))


def file_infos(file: bytes) -> tuple[list[Header], int]:
    """Return the descriptions of the parts of a file, and where its arrays begin."""
    start = 4 + int.from_bytes(file[:4], "little")
    return json.loads(file[4:start]), start


def part_text(array: AnyArray) -> tuple[Header, str]:
    """Return how a part is packed in a page, for its description, and its text."""
    packing, planes = _packed(array)
    return packing, zipped(planes)


def zipped(data: bytes) -> str:
    """Return bytes as they lie in a page: base64 of gzip."""
    return base64.b64encode(gzip.compress(data, COMPRESSION_LEVEL, mtime=0)).decode()


def _packed(array: AnyArray) -> tuple[Header, bytes]:
    """Return how a part is packed, for its description, and bytes that gzip packs well.

    Numbers whose channels are multiples of powers of two are whole numbers, with the exponents as
    ``scale``. The bytes are those of differences of neighbouring numbers, of the orders
    ``differences`` along the rows and along the columns of nodes, with the sign as the last bit.
    The bytes of a channel and of one significance lie side by side. Nothing is lost.
    """
    if array.ndim > 2:
        width, channels = array.shape[-2:]
    else:
        width, channels = (*array.shape, 1)[-2:]
    whole, scale = _whole(array, channels)
    numbers = whole.view(f"<u{whole.itemsize}").reshape(-1, max(width, 1), channels)
    middle = len(numbers) // 2
    sample = numbers[middle : middle + max(SAMPLE // max(width * channels, 1), LEAST_ROWS)]
    choices = product(range(MOST_DIFFERENCES + 1), repeat=2)
    # Differences of the first rows are no differences, of which a sample has too many.
    first = min(MOST_DIFFERENCES, len(sample) - 1)
    best = min(choices, key=lambda orders: len(zlib.compress(_planes(sample, orders, first), 1)))
    return {"differences": list(best), "scale": scale}, _planes(numbers, best)


def _planes(numbers: AnyArray, orders: tuple[int, ...], first: int = 0) -> bytes:
    for axis, order in enumerate(orders):
        for _ in range(order):
            numbers = np.diff(numbers, axis=axis, prepend=numbers.dtype.type(0))
    numbers = np.ascontiguousarray(np.moveaxis(_signed_last(numbers[first:]), -1, 0))
    return numbers.view(np.uint8).reshape(-1, numbers.itemsize).T.tobytes()


def _whole(array: AnyArray, channels: int) -> tuple[AnyArray, list[int] | None]:
    """Return multiples of powers of two as whole numbers, and the exponents of all channels."""
    array = np.ascontiguousarray(array)
    kind = WHOLE.get(array.dtype.name)
    if kind is None or not array.size or not np.isfinite(array).all():
        return array, None
    values = array.reshape(-1, channels)
    scale = np.frexp(np.abs(values).max(axis=0))[1] - kind[1]
    if np.abs(scale).max() > MOST_SCALE:
        return array, None
    multiples = values.astype(np.float32) * np.ldexp(np.float32(1), -scale)
    numbers = multiples.astype(kind[0])
    same = numbers.astype(np.float32).view(np.uint32) == multiples.view(np.uint32)
    if not same.all():  # nor is a zero below zero
        return array, None
    every = np.bitwise_or.reduce(numbers, axis=0)
    shift = np.maximum(np.frexp((every & -every).astype(float))[1] - 1, 0)
    return numbers >> shift.astype(numbers.dtype), (scale + shift).tolist()


def _signed_last(numbers: AnyArray) -> AnyArray:
    """Return whole numbers with the sign as the last bit, so that small ones have small bytes."""
    signed = numbers.view(f"<i{numbers.itemsize}")
    return (numbers << 1) ^ (signed >> (8 * numbers.itemsize - 1)).view(numbers.dtype)


def plain_list(values: ArrayLike) -> list[float]:
    """Return an array as a flat list of Python's own numbers."""
    return [float(v) for v in np.asarray(values).ravel()]
