"""Parts of a page read back as ``client/src/protocol.ts`` does."""

from __future__ import annotations

import base64
import gzip
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex.rendering.webgl.protocol import file_infos


def unpacked(info: dict[str, Any], text: str) -> NDArray[Any]:
    """Return the array of a part from its description and its text."""
    return from_planes(info, gzip.decompress(base64.b64decode(text)))


def parts_of(file: bytes) -> dict[str, NDArray[Any]]:
    """Return the arrays of a file of parts as planes."""
    infos, start = file_infos(file)
    parts = {}
    for info in infos:
        parts[info["name"]] = from_planes(info, file[start : start + info["bytes"]])
        start += info["bytes"]
    return parts


def from_planes(info: dict[str, Any], data: bytes) -> NDArray[Any]:
    """Return the array of a part from its description and its bytes."""
    kind = np.dtype(info["dtype"])
    planes = np.frombuffer(data, np.uint8)
    channels = np.ascontiguousarray(planes.reshape(kind.itemsize, -1).T).view(f"<u{kind.itemsize}")
    numbers = channels.reshape(info["stride"], -1).T
    for _ in range(info["differences"]):
        numbers = np.cumsum(numbers, axis=0, dtype=numbers.dtype)
    numbers = np.ascontiguousarray(numbers)
    result: NDArray[Any] = numbers.view(kind)
    if info["scale"] is not None:
        result = np.ldexp(numbers.view("<i4"), info["scale"]).astype("<f4")
    return result.reshape(info["shape"])
