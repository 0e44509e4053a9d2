"""Legacy files of VTK: all declared arrays are present.

VTK allocates what a keyword declares, and continues with partial data where the file ends early.
"""

from __future__ import annotations

import math
import re
from mmap import mmap
from typing import NoReturn, TypeAlias

from flowtex.errors import FieldError
from flowtex.sources.reader_errors import check_count, check_memory

#: A file that is mapped into memory; an empty one cannot be mapped.
Data: TypeAlias = mmap | bytes
#: Longest word that VTK reads at once.
WORD_LENGTH = 255
_WORD = re.compile(rb"\S{1,%d}" % WORD_LENGTH)
_NUMBER = rb"(?:\s*+[0-9+\-.eEdDnNaAiIfFtTyY]++(?!\S))"
_NUMBERS = re.compile(_NUMBER + b"*+")
#: Most repetitions that a pattern may name.
MOST_REPEATED = 2**32 - 2
MAGIC = b"# vtk DataFile Version"
#: Bytes of a value in the file and in memory; VTK recognises types by the beginning of the name.
TYPES = {
    b"unsigned_char": (1, 1),
    b"signed_char": (1, 1),
    b"char": (1, 1),
    b"unsigned_short": (2, 2),
    b"short": (2, 2),
    b"vtkidtype": (4, 12),
    b"unsigned_int": (4, 4),
    b"int": (4, 4),
    b"unsigned_long": (8, 8),
    b"long": (8, 8),
    b"vtktypeint64": (8, 8),
    b"vtktypeuint64": (8, 8),
    b"float": (4, 4),
    b"double": (8, 8),
}
#: Components of attributes whose keyword is followed by a name and a type.
COMPONENTS = {
    b"vectors": 3,
    b"normals": 3,
    b"tensors6": 6,
    b"tensors": 9,
    b"global_ids": 1,
    b"pedigree_ids": 1,
    b"edge_flags": 1,
}
CELLS = (b"cells", b"vertices", b"lines", b"polygons", b"triangle_strips")
COORDINATES = (b"x_coordinate", b"y_coordinate", b"z_coordinate")
#: Keywords, which VTK also recognises by their beginning.
KEYWORDS = (
    *(*COMPONENTS, *CELLS, *COORDINATES, b"dataset", b"dimensions", b"extent", b"spacing"),
    *(b"origin", b"aspect_ratio", b"points", b"blanking", b"cell_types", b"point_data"),
    *(b"cell_data", b"scalars", b"color_scalars", b"texture_coordinates", b"lookup_table"),
    *(b"field", b"metadata"),
)


def count_numbers(data: Data, most: int | None, begin: int, end: int) -> tuple[int, int]:
    """Return the count of numbers from ``begin``, at most ``most``, and where they end."""
    if most is not None:
        fitting = min(most, (end - begin + 1) // 2, MOST_REPEATED)
        if match := re.compile(_NUMBER + b"{%d}+" % fitting).match(data, begin, end):
            return fitting, match.end()
    stop = _NUMBERS.match(data, begin, end).end()  # type: ignore[union-attr]
    return sum(1 for _ in _WORD.finditer(data, begin, stop)), stop


class TextScanner:
    """One pass through words, numbers and blocks of bytes."""

    def __init__(self, data: Data) -> None:
        self._data, self._at = data, 0

    def word(self) -> bytes:
        """Return the next word, empty at the end."""
        match = _WORD.search(self._data, self._at)
        self._at = match.end() if match else len(self._data)
        return match.group() if match else b""

    def next_word(self) -> bytes:
        """Return the next word, and stay before it."""
        word = self.word()
        self._at -= len(word)
        return word

    def line(self) -> bytes | None:
        """Return the rest of the line without its end, ``None`` at the end of the file."""
        begin, length = self._at, len(self._data)
        stop = self._data.find(b"\n", begin)
        stop = length if stop < 0 else stop
        self._at = min(stop + 1, length)
        return None if begin == length else self._data[begin:stop].removesuffix(b"\r")

    def skip(self, count: int) -> int:
        """Skip bytes, and return their number."""
        count = min(count, len(self._data) - self._at)
        self._at += count
        return count

    def joins(self) -> bool:
        """Return whether a newline was skipped last, and none follows."""
        at = self._at
        return self._data[at - 1 : at] == b"\n" and self._data[at : at + 1] not in (b"\n", b"\r")

    def read(self, count: int) -> bytes:
        """Return the next bytes, at most ``count``."""
        count = self.skip(count)
        return self._data[self._at - count : self._at]

    def numbers(self, most: int) -> int:
        """Skip numbers, at most ``most``, up to another word; return their count."""
        count, self._at = count_numbers(self._data, most, self._at, len(self._data))
        return count


def check_vtk_legacy(data: Data) -> None:
    """Raise a FieldError for a file that ends early, or does not fit into memory."""
    _Legacy(TextScanner(data)).check()


class _Legacy:
    """One pass through a file as by VTK's reader, which refuses unknown content."""

    def __init__(self, text: TextScanner) -> None:
        self._text = text
        self._binary = False
        self._version = 0
        #: Number of points or cells of the current attributes.
        self._tuples = 0
        #: Bytes of all arrays in memory.
        self._total = 0

    def check(self) -> None:
        head = (self._text.line() or b"").removeprefix(MAGIC)
        version = re.fullmatch(rb"\s*(\d+)\.\d+\s*", head)
        if version is None:
            _refuse(head, "the version of a legacy file of VTK")
        self._version = int(version[1])
        self._text.line()  # the title
        self._binary = self._text.word().lower().startswith(b"binary")
        while word := self._text.word().lower():
            keyword = next((k for k in KEYWORDS if word.startswith(k)), None)
            if keyword is None:
                _refuse(word, "a keyword")
            self._section(keyword)
        check_memory(self._total, "the file")

    def _section(self, keyword: bytes) -> None:
        match keyword:
            case _ if keyword in CELLS:
                self._cells(keyword)
            case _ if keyword in COMPONENTS:
                name = keyword + b" " + self._text.word()
                self._array(name, self._text.word(), self._tuples, COMPONENTS[keyword])
            case b"point_data" | b"cell_data":
                self._tuples = self._count(keyword)
            case b"scalars" | b"color_scalars" | b"texture_coordinates":
                self._scalars(keyword)
            case b"lookup_table":
                name = keyword + b" " + self._text.word()
                kind = b"unsigned_char" if self._binary else b"float"
                self._array(name, kind, self._count(keyword), 4)
            case b"field":
                self._text.word()
                for _ in range(self._count(keyword)):
                    self._field_array()
            case b"metadata":
                self._metadata(0)
            case _:
                self._geometry(keyword)

    def _geometry(self, keyword: bytes) -> None:
        match keyword:
            case b"dataset":
                self._text.word()
            case b"dimensions" | b"extent":
                ends = [self._number() for _ in range(3 if keyword == b"dimensions" else 6)]
                sides = (
                    ends
                    if len(ends) == 3
                    else [b - a + 1 for a, b in zip(ends[::2], ends[1::2], strict=True)]
                )
                # PyVista makes points of grids that have none.
                check_memory(24 * math.prod(max(n, 0) for n in sides), "the grid")
            case b"spacing" | b"origin" | b"aspect_ratio":
                self._text.numbers(3)
            case b"cell_types":
                self._array(keyword, b"int", self._count(keyword), 1)
            case _:
                count = self._count(keyword)
                components = 3 if keyword == b"points" else 1
                self._array(keyword, self._text.word(), count, components)

    def _cells(self, word: bytes) -> None:
        first, second = self._count(word), self._count(word)
        if self._version < 5:
            self._array(word, b"int", second, 1)
            return
        for count in (first, second) if first else ():
            name = self._text.word()
            self._array(word + b" " + name, self._text.word(), count, 1)

    def _scalars(self, word: bytes) -> None:
        name = self._text.word()
        label = word + b" " + name
        if word.startswith(b"color_scalars"):
            kind = b"unsigned_char" if self._binary else b"float"
            self._array(label, kind, self._tuples, self._count(label))
        elif word.startswith(b"texture_coordinates"):
            components = self._count(label)
            self._array(label, self._text.word(), self._tuples, components)
        else:
            kind, components = self._text.word(), 1
            if self._text.next_word().lower() != b"lookup_table":
                components = self._count(label)
            self._text.word()
            self._text.word()  # the table's name
            self._array(label, kind, self._tuples, components)

    def _field_array(self) -> None:
        name = self._text.word()
        if name == b"NULL_ARRAY":
            return
        check_count(int(bool(name)), 1, "FIELD", "arrays more")
        components, tuples = self._count(name), self._count(name)
        self._array(b"FIELD " + name, self._text.word(), tuples, components)

    def _array(self, name: bytes, kind: bytes, tuples: int, components: int) -> None:
        """Skip the values of an array, which must have as many as it declares."""
        kind, label = kind.lower(), name.decode(errors="replace")
        values = tuples * components
        if kind.startswith((b"string", b"utf8_string", b"variant")):
            self._words(kind, values, label)
        elif kind.startswith(b"bit"):
            self._values(values, (values + 7) // 8, label)
        else:
            sizes = next((size for start, size in TYPES.items() if kind.startswith(start)), None)
            if sizes is None:
                _refuse(kind, f"the type of {label}")
            self._total += sizes[1] * values
            self._values(values, sizes[0] * values, label)
        # VTK writes metadata after the values.
        if self._text.next_word().lower().startswith(b"metadata"):
            self._text.word()
            self._metadata(components)

    def _values(self, values: int, nbytes: int, label: str) -> None:
        if not self._binary:
            check_count(self._text.numbers(values), values, label, "numbers")
        elif nbytes:
            self._text.line()
            check_count(self._text.skip(nbytes), nbytes, label)
            if self._text.joins():
                # The newline behind a shorter block was taken for its last byte.
                raise FieldError(
                    f"the file is damaged: no newline follows the {nbytes:,} bytes of {label}, so "
                    "at least one of them is missing; write or copy it again"
                )

    def _words(self, kind: bytes, values: int, label: str) -> None:
        """Skip texts: lines, or in binary files bytes after their number."""
        self._text.line()
        for number in range(values):
            if kind.startswith(b"variant") or not self._binary:
                present = self._text.line() is not None
            else:
                present = bool(head := self._text.read(1))
                if present:
                    length = 2 ** (3 - (head[0] >> 6))
                    head += self._text.read(length - 1)
                    mask = (1 << (8 * length)) - 1 if length == 8 else (1 << (8 * length - 2)) - 1
                    size = int.from_bytes(head, "big") & mask
                    check_count(self._text.skip(size), size, label)
            if not present:
                check_count(number, values, label, "texts")

    def _metadata(self, components: int) -> None:
        self._text.line()
        while line := self._text.line():
            if line.lower().startswith(b"component_names"):
                for _ in range(components):
                    self._text.line()

    def _number(self) -> int:
        word = self._text.word()
        if not re.fullmatch(rb"[+-]?\d{1,20}", word):
            _refuse(word, "a whole number")
        return int(word)

    def _count(self, label: bytes) -> int:
        count = self._number()
        if count < 0:
            raise FieldError(
                f"the file is damaged: {label.decode()} declares {count}; write or copy it again"
            )
        return count


def _refuse(word: bytes, expected: str) -> NoReturn:
    text = word[:40].decode(errors="replace")
    fault = f"has {text!r}" if word else "ends"
    raise FieldError(
        f"the file is truncated or damaged: it {fault} where {expected} was expected; write or "
        "copy it again"
    )
