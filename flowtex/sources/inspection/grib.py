"""GRIB: all messages are complete, and their grids fit into memory."""

from __future__ import annotations

from pathlib import Path
from typing import BinaryIO

from flowtex.errors import FieldError
from flowtex.sources.inspection.limits import check_count, check_memory

MAGIC = b"GRIB"
#: Bytes that are read at once between messages.
CHUNK_BYTES = 1 << 16
#: Messages of GRIB 1 that are too long for three bytes count in units of 120.
LONG_MESSAGE, LONG_UNIT = 0x800000, 120


def check_grib(path: Path) -> None:
    """Raise a FieldError for a cut last message, or a grid that does not fit into memory."""
    size = path.stat().st_size
    with path.open("rb") as stream:
        at = _next(stream, 0)
        number = 0
        while at is not None:
            number += 1
            stream.seek(at)
            head = stream.read(16)
            label = f"message {number}"
            check_count(len(head), 16, label)
            length = int.from_bytes(head[8:16] if head[7] == 2 else head[4:7], "big")
            if head[7] == 1 and length >= LONG_MESSAGE:
                # The exact length follows only from the sections.
                length = (length - LONG_MESSAGE) * LONG_UNIT - LONG_UNIT
            check_count(size - at, length, label)
            points = _points(stream, at, head[7], min(at + length, size), label)
            check_memory(8 * points, f"the grid of {label}")
            at = _next(stream, at + max(length, 4))


def _next(stream: BinaryIO, at: int) -> int | None:
    """Return the position of the next message; between two any bytes may lie."""
    stream.seek(at)
    data = b""
    while part := stream.read(CHUNK_BYTES):
        data = data[-3:] + part
        if (found := data.find(MAGIC)) >= 0:
            return stream.tell() - len(data) + found
    return None


def _points(stream: BinaryIO, at: int, edition: int, end: int, label: str) -> int:
    """Return the number of points of the largest grid of a message."""
    if edition == 1:
        stream.seek(at + 8)
        section = stream.read(8)
        if len(section) < 8 or not section[7] & 0x80:
            return 0
        stream.seek(at + 8 + int.from_bytes(section[:3], "big") + 6)
        columns, rows = stream.read(2), stream.read(2)
        return int.from_bytes(columns, "big") * int.from_bytes(rows, "big")
    place, most = at + 16, 0
    while place + 11 <= end:
        stream.seek(place)
        head = stream.read(10)
        length = int.from_bytes(head[:4], "big")
        if not 5 <= length <= end - place:
            break
        if head[4] == 3:
            most = max(most, int.from_bytes(head[6:10], "big"))
        place += length
    # ecCodes reads for ever where sections do not lead to the end.
    stream.seek(place)
    if place + 4 != end or stream.read(4) != b"7777":
        msg = f"the sections of {label} do not match its length; the file is corrupt"
        raise FieldError(msg)
    return most
