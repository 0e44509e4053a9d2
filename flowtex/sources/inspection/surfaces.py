"""PLY and STL: declared elements are present."""

from __future__ import annotations

from pathlib import Path
from typing import BinaryIO

from flowtex.errors import FieldError
from flowtex.sources.inspection.limits import check_count
from flowtex.sources.inspection.numbers import TextScanner

#: Bytes of the types of PLY.
PLY_TYPES = {
    **dict.fromkeys(("char", "uchar", "int8", "uint8"), 1),
    **dict.fromkeys(("short", "ushort", "int16", "uint16"), 2),
    **dict.fromkeys(("int", "uint", "float", "int32", "uint32", "float32"), 4),
    **dict.fromkeys(("double", "float64"), 8),
}
#: A binary STL: a header of 80 bytes, the number of triangles, and 50 bytes for each.
STL_HEAD, STL_TRIANGLE = 84, 50


def check_stl(path: Path) -> None:
    """Raise a FieldError for fewer triangles than declared, or text without its last line."""
    size = path.stat().st_size
    with path.open("rb") as stream:
        head = stream.read(STL_HEAD)
        triangles = int.from_bytes(head[80:84], "little")
        if head.startswith(b"solid") and size != STL_HEAD + STL_TRIANGLE * triangles:
            stream.seek(max(size - 4096, 0))
            check_count(int(b"endsolid" in stream.read()), 1, "a solid", "lines endsolid")
        else:
            check_count(size - STL_HEAD, STL_TRIANGLE * triangles, "the header")


def check_ply(path: Path) -> None:
    """Raise a FieldError for fewer elements than the header declares."""
    with path.open("rb") as stream:
        form, elements = _ply_header(stream)
        text = TextScanner(stream, path.stat().st_size)
        for name, count, properties in elements:
            if form == "ascii":
                found = _text_elements(text, count, properties)
            else:
                found = _binary_elements(text, count, properties, big=form.endswith("big_endian"))
            check_count(found, count, f"element {name}", "of them")


def _ply_header(stream: BinaryIO) -> tuple[str, list[tuple[str, int, list[list[str]]]]]:
    """Return the format, and the elements: name, count and properties, each in words."""
    form = ""
    elements: list[tuple[str, int, list[list[str]]]] = []
    for line in stream:
        words = line.decode(errors="replace").split()
        match words:
            case ["format", form, *_]:
                pass
            case ["element", name, count] if count.isdecimal():
                elements.append((name, int(count), []))
            case ["property", "list", count, kind, _] if elements and {count, kind} <= {*PLY_TYPES}:
                elements[-1][2].append(["list", count, kind])
            case ["property", kind, _] if elements and kind in PLY_TYPES:
                elements[-1][2].append([kind])
            case ["end_header"]:
                return form, elements
            case ["ply" | "comment" | "obj_info", *_] | []:
                pass
            case _:
                break
    fault = f"damaged: its header has {line[:80]!r}" if elements else "truncated"
    msg = f"the file is {fault}; write or copy it again"
    raise FieldError(msg)


def _text_elements(text: TextScanner, count: int, properties: list[list[str]]) -> int:
    """Skip the lines of elements, and return how many are complete."""
    for number in range(count):
        while (line := text.line()) is not None and not line.strip():
            pass
        if line is None or _has_too_few(line.split(), properties):
            return number
    return count


def _has_too_few(words: list[bytes], properties: list[list[str]]) -> bool:
    """Return whether a line lacks properties or entries of lists."""
    needed = 0
    for kind in properties:
        if needed >= len(words):
            return True
        size = words[needed]
        needed += 1 + (int(size) if kind[0] == "list" and size.isdigit() else 0)
    return needed > len(words)


def _binary_elements(
    text: TextScanner, count: int, properties: list[list[str]], *, big: bool
) -> int:
    """Skip elements, and return how many are complete."""
    if all(len(kind) == 1 for kind in properties):
        size = sum(PLY_TYPES[kind[0]] for kind in properties)
        return text.skip(size * count) // size if size else count
    for number in range(count):
        for kind in properties:
            if kind[0] == "list":
                head = text.read(PLY_TYPES[kind[1]])
                size = int.from_bytes(head, "big" if big else "little") * PLY_TYPES[kind[2]]
                if not head or text.skip(size) < size:
                    return number
            elif text.skip(PLY_TYPES[kind[0]]) < PLY_TYPES[kind[0]]:
                return number
    return count
