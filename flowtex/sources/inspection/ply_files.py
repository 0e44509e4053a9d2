"""Check of PLY: VTK trusts each count and each number of a corner in it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NoReturn

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex._util.memory import check_memory
from flowtex.errors import FieldError
from flowtex.sources.inspection.vtk_files import Data
from flowtex.sources.reader_errors import check_count

#: Types of numbers by their names.
KINDS = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
#: Types of counts and of numbers of corners.
WHOLE = ("i1", "u1", "i2", "u2", "i4", "u4")
ORDERS = {b"ascii": "", b"binary_little_endian": "<", b"binary_big_endian": ">"}
#: Most bytes of a header, and of a line of text: VTK reads no more.
MOST_HEADER_BYTES = 100_000
MOST_LINE_BYTES = 4_095
#: Names of the list of corners of a face.
CORNERS = ("vertex_indices", "vertex_index")
#: Least number of corners of a face.
LEAST_CORNERS = 3
REMEDY = "write or copy it again"


@dataclass
class _Element:
    """Points or faces: how many, and the type of each property, of lists also the count's type."""

    name: str
    count: int
    kinds: dict[str, str] = field(default_factory=dict)
    counts: dict[str, str] = field(default_factory=dict)


def check_ply(data: Data) -> None:
    """Raise a FieldError for a header that VTK cannot read, or content that does not match it."""
    begin, order, elements = _header(data)
    if "face" in elements:
        corners = elements["face"].kinds
    else:
        corners = {}
    points = elements["vertex"].count
    check_memory(24 * points, "the points")
    for element in elements.values():
        used = ""
        if element.name == "face":
            used = next(name for name in CORNERS if name in corners)
        if order:
            begin = _check_binary(data, begin, order, element, used, points)
        else:
            begin = _check_text(data, begin, element, used, points)
    if data[begin : begin + MOST_LINE_BYTES].strip():
        _damaged("more follows what its header declares")


def _header(data: Data) -> tuple[int, str, dict[str, _Element]]:
    """Return where the header ends, the byte order, empty for text, and the elements."""
    head = data[:MOST_HEADER_BYTES]
    end = head.find(b"end_header")
    begin = head.find(b"\n", end) + 1
    lines = head[: max(end, 0)].splitlines()
    if end < 0 or not begin or len(lines) < 2 or lines[0].strip() != b"ply":
        _damaged("it has no header from 'ply' to 'end_header'")
    form = lines[1].split()
    if len(form) != 3 or form[0] != b"format" or form[1] not in ORDERS or form[2] != b"1.0":
        _damaged(f"its second line is {_text(lines[1])}; expected such as 'format ascii 1.0'")
    elements: dict[str, _Element] = {}
    for line in lines[2:]:
        words = line.decode("latin-1").split()
        match words:
            case ["comment" | "obj_info", *_]:
                pass
            case ["element", str(name), str(count)] if count.isdecimal() and name not in elements:
                elements[name] = _Element(name, int(count))
            case ["property", "list", str(counts), str(kind), str(name)] if elements:
                element = next(reversed(elements.values()))
                element.counts[name] = _kind(counts)
                element.kinds[name] = _kind(kind)
                if element.counts[name] not in WHOLE:
                    _damaged(f"its header has the line {_text(line)}")
            case ["property", str(kind), str(name)] if elements:
                next(reversed(elements.values())).kinds[name] = _kind(kind)
            case _:
                _damaged(f"its header has the line {_text(line)}")
    _check_elements(elements)
    return begin, ORDERS[form[1]], elements


def _check_elements(elements: dict[str, _Element]) -> None:
    points = elements.get("vertex")
    if points is None or not {"x", "y", "z"} <= points.kinds.keys() - points.counts.keys():
        _damaged("its header has no element 'vertex' with the properties x, y and z")
    faces = elements.get("face")
    if faces is None:
        return
    lists = []
    for name in CORNERS:
        if name in faces.counts:
            lists.append(name)
    if len(lists) != 1 or faces.kinds[lists[0]] not in WHOLE:
        _damaged("its faces have no list 'vertex_indices' of whole numbers")


def _check_text(data: Data, begin: int, element: _Element, used: str, points: int) -> int:
    """Check an element in text, one line for each, and return where it ends."""
    for number in range(element.count):
        end = data.find(b"\n", begin)
        if end < 0:
            end = len(data)
        label = f"{element.name} {number:,}"
        if begin >= len(data):
            check_count(number, element.count, f"the element {element.name}", "lines")
        if end - begin > MOST_LINE_BYTES:
            _damaged(f"{label} is a line of more than {MOST_LINE_BYTES:,} bytes")
        words = data[begin:end].split()
        at = 0
        for name in element.kinds:
            count = 1
            if name in element.counts:
                count = _whole(words, at, label)
                at += 1
            if name == used:
                listed = [_whole(words, at + k, label) for k in range(min(count, len(words)))]
                _check_corners(np.array(listed), count, points, label)
            at += count
        if at != len(words):
            _damaged(f"{label} has {len(words)} numbers; expected {at}")
        begin = end + 1
    return begin


def _check_binary(
    data: Data, begin: int, order: str, element: _Element, used: str, points: int
) -> int:
    """Check an element in binary, and return where it ends."""
    label = f"the element {element.name}"
    if not element.counts:
        record = np.dtype([(name, order + kind) for name, kind in element.kinds.items()])
        check_count(len(data) - begin, element.count * record.itemsize, label)
        return begin + element.count * record.itemsize
    even = _even_record(data, begin, order, element)
    if even is not None and _check_even(data, begin, element, even, used, points):
        return begin + element.count * even.itemsize
    for number in range(element.count):
        for name, kind in element.kinds.items():
            count = 1
            if name in element.counts:
                (count,) = _numbers(data, begin, order + element.counts[name], 1, label).tolist()
                begin += np.dtype(element.counts[name]).itemsize
            values = _numbers(data, begin, order + kind, count, label)
            if name == used:
                _check_corners(values, count, points, f"{element.name} {number:,}")
            begin += values.nbytes
    return begin


def _even_record(data: Data, begin: int, order: str, element: _Element) -> np.dtype | None:
    """Return the type of an element if all have lists as long as the first; else ``None``."""
    fields: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
    at = begin
    for name, kind in element.kinds.items():
        if name not in element.counts:
            fields.append((name, order + kind))
            at += np.dtype(kind).itemsize
            continue
        form = order + element.counts[name]
        if not element.count or at + np.dtype(form).itemsize > len(data):
            return None
        (count,) = _numbers(data, at, form, 1, name).tolist()
        size = np.dtype(kind).itemsize * count
        at += np.dtype(form).itemsize + size
        if count < 0 or at > len(data):
            return None
        fields += [(f"count of {name}", form), (name, order + kind, (count,))]
    return np.dtype(fields)


def _check_even(
    data: Data, begin: int, element: _Element, record: np.dtype, used: str, points: int
) -> bool:
    """Return whether all lists of an element are as long as the first, and check the corners."""
    if begin + element.count * record.itemsize > len(data):
        return False
    # A copy: an array that shares the mapped file would keep it open.
    rows = np.frombuffer(data[begin : begin + element.count * record.itemsize], record)
    for name in element.counts:
        counts = rows[f"count of {name}"]
        if (counts != counts[0]).any():
            return False
    if used:
        corners = rows[used]
        _check_corners(corners, corners.shape[1], points, "one face")
    return True


def _numbers(data: Data, begin: int, form: str, count: int, label: str) -> AnyArray:
    size = np.dtype(form).itemsize
    if count < 0:
        _damaged(f"a list of {label} has {count} numbers")
    check_count(len(data) - begin, count * size, label)
    return np.frombuffer(data[begin : begin + count * size], form)


def _check_corners(corners: AnyArray, count: int, points: int, label: str) -> None:
    if count < LEAST_CORNERS:
        _damaged(f"{label} has {count} corners; expected {LEAST_CORNERS} or more")
    if corners.size and (corners.min() < 0 or corners.max() >= points):
        low = int(corners.min())
        high = int(corners.max())
        _damaged(f"{label} refers to points {low} to {high}, but there are {points:,}")


def _whole(words: list[bytes], at: int, label: str) -> int:
    if at < len(words):
        word = words[at]
    else:
        word = b""
    try:
        return int(word)
    except ValueError:
        _damaged(f"{label} has {_text(word)} where a whole number was expected")


def _kind(name: str) -> str:
    if name not in KINDS:
        _damaged(f"its header has the type {name[:40]!r}; expected one of {', '.join(KINDS)}")
    return KINDS[name]


def _text(line: bytes) -> str:
    return repr(line[:40].decode(errors="replace"))


def _damaged(fault: str) -> NoReturn:
    raise FieldError(f"the file is damaged, or not PLY as VTK reads it: {fault}; {REMEDY}")
