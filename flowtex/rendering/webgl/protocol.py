"""The wire format between Python and the client in a browser.

::

    ClientData --header()------------> header: JSON, with the shaders' text
                 surface(), step(k)--> parts: named arrays, little endian

Each part goes with its description: name, type, shape and digest. The widget sends descriptions in
a message and the arrays as its buffers, the app serves several parts as one file, an exported page
holds each part as text. ``client/src/protocol.ts`` is the other side.
"""

from __future__ import annotations

import base64
import gzip
import json
import struct
from collections.abc import Mapping
from typing import Any, TypeAlias

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex._util.cache import digest

__all__ = ["FORMAT", "Header", "Parts", "part_buffer", "part_info", "part_text", "parts_file"]

#: Number of the form of header and parts; a client refuses one that it does not know.
FORMAT = 3
#: Of gzip, for the parts of a page: it is written once and read often.
COMPRESSION_LEVEL = 9

Header: TypeAlias = dict[str, Any]
Parts: TypeAlias = dict[str, AnyArray]


def part_info(name: str, array: AnyArray) -> dict[str, Any]:
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


def parts_file(parts: Mapping[str, AnyArray]) -> bytes:
    """Return parts as one file.

    It is the length of the descriptions as four bytes, the descriptions in JSON with the number of
    bytes of each part, and the arrays one after the other.
    """
    infos = [{**part_info(name, array), "bytes": array.nbytes} for name, array in parts.items()]
    text = json.dumps(infos).encode()
    return b"".join((struct.pack("<I", len(text)), text, *map(part_buffer, parts.values())))


def part_text(array: AnyArray) -> str:
    """Return the bytes of a part as text: gzip in base64.

    The bytes of one significance lie side by side, which is where slopes resemble one another.
    """
    planes = np.asarray(part_buffer(array)).reshape(-1, array.itemsize).T
    return base64.b64encode(gzip.compress(planes.tobytes(), COMPRESSION_LEVEL, mtime=0)).decode()
