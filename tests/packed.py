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
        data = file[start : start + info["bytes"]]
        is_packed = "differences" in info
        parts[info["name"]] = (
            from_planes(info, data) if is_packed else np.frombuffer(data, np.uint8)
        )
        start += info["bytes"]
    return parts


def from_planes(info: dict[str, Any], data: bytes) -> NDArray[Any]:
    """Return the array of a part from its description and its bytes."""
    kind = np.dtype(info["dtype"])
    planes = np.frombuffer(data, np.uint8)
    signed = np.ascontiguousarray(planes.reshape(kind.itemsize, -1).T).view(f"<u{kind.itemsize}")
    shape = info["shape"]
    width, channels = shape[-2:] if len(shape) > 2 else (*shape, 1)[-2:]
    numbers = ((signed >> 1) ^ -(signed & 1)).reshape(channels, -1, width)
    for axis, order in enumerate(info["differences"], start=1):
        for _ in range(order):
            numbers = np.cumsum(numbers, axis=axis, dtype=numbers.dtype)
    numbers = np.ascontiguousarray(np.moveaxis(numbers, 0, -1))
    result: NDArray[Any] = numbers.view(kind)
    if info["scale"] is not None:
        whole = numbers.view(f"<i{kind.itemsize}")
        result = np.ldexp(whole.astype(float), info["scale"]).astype(kind)
    return result.reshape(shape)
