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

#: Number of the form of header and parts; a client refuses one that it does not know.
FORMAT = 4
#: Of gzip, for the parts of a page.
COMPRESSION_LEVEL = 6
#: How often numbers of a part of a page are taken from each other, and how many tell what is best.
MOST_DIFFERENCES, SAMPLE = 2, 20_000
#: Bits of whole numbers that single precision holds, and exponents of their unit.
WHOLE_BITS, MOST_SCALE = 24, 100

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


def parts_file(parts: Mapping[str, AnyArray], *, planes: bool = False) -> bytes:
    """Return parts as one file.

    It is the length of the descriptions as four bytes, the descriptions in JSON with the number of
    bytes of each part, and the arrays one after the other; as ``planes`` where gzip follows.
    """
    infos, buffers = [], []
    for name, array in parts.items():
        packing, buffer = _packed(array) if planes else ({}, part_buffer(array))
        infos.append({**part_info(name, array), "bytes": array.nbytes, **packing})
        buffers.append(buffer)
    text = json.dumps(infos).encode()
    return b"".join((struct.pack("<I", len(text)), text, *buffers))


def file_infos(file: bytes) -> tuple[list[dict[str, Any]], int]:
    """Return the descriptions of the parts of a file, and where its arrays begin.

    Of the file the beginning will do.

    Raises
    ------
    ValueError
        When they are cut short or no JSON.
    """
    start = 4 + int.from_bytes(file[:4], "little")
    return json.loads(file[4:start]), start


def part_text(array: AnyArray) -> tuple[dict[str, Any], str]:
    """Return how a part is packed in a page, for its description, and its bytes: gzip in base64."""
    packing, planes = _packed(array)
    packed = gzip.compress(planes, COMPRESSION_LEVEL, mtime=0)
    return packing, base64.b64encode(packed).decode()


def _packed(array: AnyArray) -> tuple[dict[str, Any], bytes]:
    """Return bytes of a part that gzip packs well, and for its description what they are.

    Numbers that are multiples of a power of two are whole numbers, with its exponent as ``scale``.
    What is packed is by how much numbers differ from those before them, ``differences`` times, in
    each of ``stride`` channels; the bytes of a channel and of one significance lie side by side.
    Nothing is lost.
    """
    whole, scale = _whole(array)
    stride = max(array.shape[-1], 1) if array.ndim > 2 else 1
    numbers = whole.reshape(-1).view(f"<u{whole.itemsize}").reshape(-1, stride)
    some = [_differences(numbers[:SAMPLE], n) for n in range(MOST_DIFFERENCES + 1)]
    order = int(np.argmin([len(gzip.compress(_planes(one), 1)) for one in some]))
    packing = {"differences": order, "stride": stride, "scale": scale}
    return packing, _planes(_differences(numbers, order))


def _whole(array: AnyArray) -> tuple[AnyArray, int | None]:
    """Return single precision as whole numbers, where it is, and the exponent of their unit."""
    array = np.ascontiguousarray(array)
    if array.dtype != np.float32 or not array.size or not np.isfinite(array).all():
        return array, None
    scale = int(np.frexp(np.abs(array).max())[1]) - WHOLE_BITS
    if abs(scale) > MOST_SCALE:
        return array, None
    numbers = np.rint(np.ldexp(array.astype(float), -scale)).astype("<i4")
    same = np.ldexp(numbers, scale).astype(np.float32).tobytes() == array.tobytes()
    return (numbers, scale) if same else (array, None)


def _differences(numbers: AnyArray, order: int) -> AnyArray:
    for _ in range(order):
        numbers = np.concatenate([numbers[:1], np.diff(numbers, axis=0)])
    return numbers


def _planes(numbers: AnyArray) -> bytes:
    """Return the bytes of numbers (N, C), channel by channel in those of one significance."""
    channels = np.ascontiguousarray(numbers.T).reshape(-1)
    return channels.view(np.uint8).reshape(-1, numbers.itemsize).T.tobytes()


def plain_list(values: Any) -> list[float]:
    """Return an array as a flat list of Python's own numbers."""
    return [float(v) for v in np.asarray(values).ravel()]
