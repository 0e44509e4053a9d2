"""EnSight Gold as text: parts and variables have as many values as they declare.

VTK continues with partial data where a file ends early. Binary files, parts of polygons and
polyhedra, and geometries of several times are left to the reader.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from functools import partial
from pathlib import Path

from flowtex.errors import FieldError
from flowtex.sources.inspection.limits import check_count, check_memory
from flowtex.sources.inspection.numbers import TextScanner

#: Values of a variable at each node or element.
COMPONENTS = {"scalar": 1, "vector": 3, "tensor symm": 6, "tensor asym": 9}
_MODEL = re.compile(r"^model:(?:\s+\d+){0,2}\s+(\S+)", re.MULTILINE)
_VARIABLE = re.compile(
    rf"^({'|'.join(COMPONENTS)}) per (node|element):.*[ \t](\S+)[ \t]*$", re.MULTILINE
)
#: Numbers of nodes or elements by part and section.
_Sizes = dict[tuple[int, str], int]


def check_ensight(case: Path) -> None:
    """Raise a FieldError if a file of a case has fewer values than it declares."""
    text = case.read_text(encoding="utf-8", errors="replace")
    model = _MODEL.search(text)
    geometry = case.parent / model[1] if model else case
    if "ensight gold" not in text or not geometry.is_file():
        return
    sizes = _checked(geometry, _geometry)
    for kind, place, name in _VARIABLE.findall(text) if sizes else ():
        check = partial(_variable, sizes=sizes, components=COMPONENTS[kind], place=place)
        for file in sorted(case.parent.glob(re.sub(r"\*+", "*", name))):
            _checked(file, check)


def _checked(file: Path, check: Callable[[TextScanner], _Sizes]) -> _Sizes:
    """Check one file, and return the sizes of its parts."""
    with file.open("rb") as stream:
        if b"binary" in stream.read(80).lower():
            return {}
        stream.seek(0)
        size = file.stat().st_size
        try:
            sizes = check(TextScanner(stream, size))
            # Values stand in columns: the last line is no shorter than that before it.
            stream.seek(max(size - 1000, 0))
            *_, before, last = [b"", b"", *stream.read().split(b"\n")]
            check_count(len(last) if last else len(before), len(before), "the last line")
        except FieldError as error:
            msg = f"{file.name}: {error}"
            raise FieldError(msg) from error
    return sizes


def _geometry(text: TextScanner) -> _Sizes:
    lines = [text.line() or b"" for _ in range(4)]
    ids = [line.split()[-1:] in ([b"given"], [b"ignore"]) for line in lines[2:]]
    sizes: _Sizes = {}
    part = 0
    while word := text.word().decode(errors="replace"):
        if word == "extents":
            _values(text, 6, word)
        elif word == "part":
            part = _number(text, word)
            text.line()
            text.line()  # its name
        elif word == "coordinates":
            sizes[part, "node"] = count = _number(text, word)
            _values(text, count * (3 + ids[0]), f"part {part}")
        elif word == "block" and not (text.line() or b"").strip():
            sides = [_number(text, word) for _ in range(3)]
            sizes[part, "node"] = count = math.prod(sides)
            sizes[part, "element"] = math.prod(max(n - 1, 1) for n in sides)
            _values(text, 3 * count, f"part {part}")
        elif nodes := re.fullmatch(r"(?:g_)?[a-z]+(\d+)|point", word):
            sizes[part, word] = count = _number(text, word)
            _values(text, count * (int(nodes[1] or 1) + ids[1]), f"{word} of part {part}")
        else:
            return {}
    return sizes


def _variable(text: TextScanner, sizes: _Sizes, components: int, place: str) -> _Sizes:
    """Check the values of a variable at nodes or elements."""
    text.line()  # its name
    while text.word() == b"part":
        part = _number(text, "part")
        section = text.word().decode(errors="replace")
        if (text.line() or b"").strip():  # values of only some places
            break
        label = f"{section} of part {part}"
        kind = place if section in ("coordinates", "block") else section
        check_count(int((part, kind) in sizes), 1, label, "places")
        _values(text, components * sizes[part, kind], label)
    return {}


def _number(text: TextScanner, label: str) -> int:
    word = text.word()
    check_count(int(word.isdigit()), 1, label, "whole numbers")
    return int(word)


def _values(text: TextScanner, count: int, label: str) -> None:
    check_memory(8 * count, label)
    check_count(text.numbers(count), count, label, "values")
