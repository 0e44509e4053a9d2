"""Messages between processes: a header of JSON, and the bytes of arrays.

Nothing is unpickled: a process that parses an untrusted file may be compromised.
"""

from __future__ import annotations

import json
import math
import re
import struct
from collections.abc import Sequence
from typing import IO, Any

import numpy as np

from flowtex._util.array_types import AnyArray

#: Length of the header.
_PREFIX = struct.Struct(">I")
#: Most bytes of a header.
HEADER_BYTES = 16_000_000
#: Types of arrays: numbers and truth values.
_TYPE = re.compile(r"[<>|][biuf]\d{1,2}")


class MessageError(ValueError):
    """The bytes that were received are not a message."""


def write_message(stream: IO[bytes], value: Any, arrays: Sequence[AnyArray] = ()) -> None:
    """Write a value of JSON, and arrays of numbers."""
    contiguous = [np.ascontiguousarray(array) for array in arrays]
    infos = [[array.dtype.str, np.shape(array)] for array in arrays]
    header = json.dumps({"value": value, "arrays": infos}).encode()
    if len(header) > HEADER_BYTES:
        msg = f"the header of a message has {len(header):,} bytes; expected {HEADER_BYTES:,}"
        raise MessageError(msg)
    stream.write(_PREFIX.pack(len(header)) + header)
    for array in contiguous:
        stream.write(array.reshape(-1).view(np.uint8).data)
    stream.flush()


def read_message(stream: IO[bytes], most_bytes: int) -> tuple[Any, list[AnyArray]] | None:
    """Return a value and arrays, of ``most_bytes`` at most; ``None`` at the end of the stream."""
    prefix = bytearray(_PREFIX.size)
    if not _fill(stream, memoryview(prefix)):
        return None
    (length,) = _PREFIX.unpack(prefix)
    if length > HEADER_BYTES:
        msg = f"the header of a message has {length:,} bytes; expected {HEADER_BYTES:,} at most"
        raise MessageError(msg)
    header = bytearray(length)
    if not _fill(stream, memoryview(header)):
        return None
    try:
        message = json.loads(header)
        value, infos = message["value"], message["arrays"]
        types = [(_type(kind), _shape(shape)) for kind, shape in infos]
    except (ValueError, TypeError, KeyError, RecursionError) as error:
        msg = f"the header of a message is malformed: {error}"
        raise MessageError(msg) from error
    size = sum(kind.itemsize * math.prod(shape) for kind, shape in types)
    if size > most_bytes:
        msg = f"a message declares {size:,} bytes of arrays; expected {most_bytes:,} at most"
        raise MessageError(msg)
    arrays: list[AnyArray] = []
    for kind, shape in types:
        arrays.append(np.empty(shape, kind))
        if not _fill(stream, arrays[-1].reshape(-1).view(np.uint8).data):
            return None
    return value, arrays


def _type(text: Any) -> np.dtype[Any]:
    if not _TYPE.fullmatch(text):
        msg = f"the type {text!r} of an array"
        raise ValueError(msg)
    kind: np.dtype[Any] = np.dtype(text)
    return kind


def _shape(sizes: Any) -> tuple[int, ...]:
    if not all(type(n) is int and n >= 0 for n in sizes):
        msg = f"the shape {sizes!r} of an array"
        raise ValueError(msg)
    return tuple(sizes)


def _fill(stream: IO[bytes], view: memoryview) -> bool:
    """Fill a buffer from a stream; return ``False`` where the stream ends before."""
    filled = 0
    while filled < len(view):
        count = stream.readinto(view[filled:])  # type: ignore[attr-defined]
        if not count:
            return False
        filled += count
    return True
