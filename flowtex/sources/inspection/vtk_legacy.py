"""Legacy files of VTK: all arrays that are declared are present, and fit into memory.

VTK takes the sizes of cells as they are, and would read outside of its memory.
"""

from __future__ import annotations

import math
import re
import warnings
from typing import NoReturn

import numpy as np

from flowtex._util.array_types import Indices
from flowtex._util.memory import check_memory
from flowtex.errors import FieldError
from flowtex.sources.inspection.vtk_files import WORD, Data, count_numbers
from flowtex.sources.reader_errors import check_count

MAGIC = b"# vtk DataFile Version"
#: Bytes of a value by the beginning of its type's name, as VTK recognises it.
TYPES = {
    **dict.fromkeys((b"unsigned_char", b"signed_char", b"char"), 1),
    **dict.fromkeys((b"unsigned_short", b"short"), 2),
    **dict.fromkeys((b"vtkidtype", b"unsigned_int", b"int", b"float"), 4),
    **dict.fromkeys((b"unsigned_long", b"long", b"vtktypeint64", b"vtktypeuint64", b"double"), 8),
}
#: Types of whole numbers of eight bytes.
WIDE = (b"vtktypeint64", b"vtktypeuint64", b"long", b"unsigned_long")
#: Number of the type of polyhedra.
POLYHEDRON = 42
#: Components of attributes whose keyword is followed by a name and a type.
COMPONENTS = {b"vectors": 3, b"normals": 3, b"tensors6": 6, b"tensors": 9}
COMPONENTS |= dict.fromkeys((b"global_ids", b"pedigree_ids", b"edge_flags"), 1)
CELLS = (b"cells", b"vertices", b"lines", b"polygons", b"triangle_strips")
#: Keywords, which VTK also recognises by their beginning.
KEYWORDS = (
    *(*COMPONENTS, *CELLS, b"x_coordinate", b"y_coordinate", b"z_coordinate", b"dataset"),
    *(b"dimensions", b"extent", b"spacing", b"origin", b"aspect_ratio", b"points", b"blanking"),
    *(b"cell_types", b"point_data", b"cell_data", b"scalars", b"color_scalars"),
    *(b"texture_coordinates", b"lookup_table", b"field", b"metadata"),
)


def check_vtk_legacy(data: Data) -> None:
    """Raise a FieldError for a file that ends early, or does not fit into memory."""
    check_memory(_Legacy(data).total, "the file")


class _Legacy:
    """One pass through a file as by VTK's reader, which refuses unknown content."""

    def __init__(self, data: Data) -> None:
        self._data = data
        self._at = 0
        head = (self._line() or b"").removeprefix(MAGIC)
        version = re.fullmatch(rb"\s*(\d+)\.\d+\s*", head)
        if version is None:
            _refuse(head, "the version of a legacy file of VTK")
        self._version = int(version[1])
        self._line()  # the title
        self._binary = self._word().lower().startswith(b"binary")
        #: Number of points or cells of the current attributes.
        self._tuples = 0
        #: Bytes of all arrays.
        self.total = 0
        #: Begin and end of the values of the last array.
        self._place = 0, 0
        #: Places and types of the offsets and the connectivity of cells.
        self._lists: list[tuple[tuple[int, int], bytes]] = []
        while word := self._word().lower():
            self._section(word)

    def _word(self) -> bytes:
        """Return the next word, empty at the end."""
        match = WORD.search(self._data, self._at)
        if match is None:
            self._at = len(self._data)
            return b""
        self._at = match.end()
        return match.group()

    def _is_next(self, beginning: bytes) -> bool:
        match = WORD.search(self._data, self._at)
        return match is not None and match.group().lower().startswith(beginning)

    def _line(self) -> bytes | None:
        """Return the rest of the line without its end, ``None`` at the end of the file."""
        begin = self._at
        length = len(self._data)
        stop = self._data.find(b"\n", begin)
        if stop < 0:
            stop = length
        self._at = min(stop + 1, length)
        if begin == length:
            return None
        return self._data[begin:stop].removesuffix(b"\r")

    def _skip(self, count: int) -> bytes:
        begin = self._at
        self._at = min(self._at + count, len(self._data))
        return self._data[begin : self._at]

    def _number(self) -> int:
        word = self._word()
        if not re.fullmatch(rb"[+-]?\d{1,20}", word):
            _refuse(word, "a whole number")
        return int(word)

    def _count(self, label: bytes) -> int:
        count = self._number()
        if count < 0:
            _refuse(str(count).encode(), f"the size of {label.decode(errors='replace')}")
        return count

    def _section(self, word: bytes) -> None:
        keyword = next((k for k in KEYWORDS if word.startswith(k)), b"")
        byte = b"unsigned_char" if self._binary else b"float"
        match keyword:
            case b"":
                _refuse(word, "a keyword")
            case b"dataset":
                self._word()
            case b"dimensions" | b"extent":
                sides = [self._number() for _ in range(3 if keyword == b"dimensions" else 6)]
                if keyword == b"extent":
                    sides = [b - a + 1 for a, b in zip(sides[::2], sides[1::2], strict=True)]
                # PyVista makes points of grids that have none.
                check_memory(24 * math.prod(max(n, 0) for n in sides), "the grid")
            case b"spacing" | b"origin" | b"aspect_ratio":
                for _ in range(3):
                    self._word()
            case b"point_data" | b"cell_data":
                self._tuples = self._count(keyword)
            case b"metadata":
                self._metadata(0)
            case b"field":
                self._word()
                for _ in range(self._count(keyword)):
                    self._field_array()
            case b"cell_types":
                self._array(keyword, b"int", self._count(keyword), 1)
                self._check_polyhedra(self._integers(b"int"))
            case b"lookup_table":
                name = keyword + b" " + self._word()
                self._array(name, byte, self._count(keyword), 4)
            case b"color_scalars":
                name = keyword + b" " + self._word()
                self._array(name, byte, self._tuples, self._count(name))
            case b"texture_coordinates":
                name = keyword + b" " + self._word()
                components = self._count(keyword)
                self._array(name, self._word(), self._tuples, components)
            case b"scalars":
                name = keyword + b" " + self._word()
                kind = self._word()
                components = 1 if self._is_next(b"lookup_table") else self._count(name)
                self._word()
                self._word()  # the table's name
                self._array(name, kind, self._tuples, components)
            case _ if keyword in CELLS:
                self._cells(keyword)
            case _ if keyword in COMPONENTS:
                name = keyword + b" " + self._word()
                self._array(name, self._word(), self._tuples, COMPONENTS[keyword])
            case _:
                count = self._count(keyword)
                components = 3 if keyword == b"points" else 1
                self._array(keyword, self._word(), count, components)

    def _cells(self, word: bytes) -> None:
        first = self._count(word)
        second = self._count(word)
        if self._version < 5:
            self._array(word, b"int", second, 1)
            self._check_sizes(word.decode(errors="replace"), first)
            return
        for count in (first, second) if first else ():
            name = self._word()
            kind = self._word()
            self._array(word + b" " + name, kind, count, 1)
            self._lists.append((self._place, kind))

    def _check_sizes(self, label: str, cells: int) -> None:
        """Raise a FieldError if the sizes of cells, before the points of each, are wrong.

        VTK would read outside of its memory.
        """
        view = memoryview(self._integers(b"int").data)
        at = 0
        found = 0
        while at < len(view):
            size = view[at]
            if size < 0:
                _refuse(str(size).encode(), f"the size of one of the {label}")
            at += size + 1
            found += 1
        if at != len(view) or found != cells:
            raise FieldError(
                f"the file is damaged: the sizes of {label} do not add up to {cells:,} cells of "
                f"{len(view):,} numbers; write or copy it again"
            )

    def _integers(self, kind: bytes) -> Indices:
        """Return the values of the last array, whole numbers."""
        begin, end = self._place
        text = self._data[begin:end]
        if self._binary:
            size = 4
            if kind.lower() in WIDE:
                size = 8
            return np.frombuffer(text[: len(text) // size * size], f">i{size}").astype(np.int64)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # the rest is no number
            return np.fromstring(text, np.int64, sep=" ")

    def _check_polyhedra(self, types: Indices) -> None:
        """Raise a FieldError for polyhedra whose faces do not fill their part of the connectivity.

        Each has the number of its faces, and before the points of a face their number. VTK would
        read on for minutes, or outside of its memory.
        """
        if len(self._lists) != 2 or POLYHEDRON not in types:
            return
        arrays: list[Indices] = []
        for place, kind in self._lists:
            self._place = place
            arrays.append(self._integers(kind))
        offsets, connectivity = arrays
        for number in np.flatnonzero(types == POLYHEDRON):
            if number + 1 >= len(offsets):
                raise _polyhedron_fault(int(number))
            faces = connectivity[offsets[number] : offsets[number + 1]].tolist()
            at = 1
            found = 0
            while 0 < at < len(faces) and faces[at] >= 0:
                at += faces[at] + 1
                found += 1
            if at != len(faces) or found != faces[0]:
                raise _polyhedron_fault(int(number))

    def _field_array(self) -> None:
        name = self._word()
        if name == b"NULL_ARRAY":
            return
        check_count(int(bool(name)), 1, "FIELD", "arrays more")
        components = self._count(name)
        tuples = self._count(name)
        self._array(b"FIELD " + name, self._word(), tuples, components)

    def _array(self, name: bytes, kind: bytes, tuples: int, components: int) -> None:
        """Skip the values of an array, which must have as many as it declares."""
        kind = kind.lower()
        label = name.decode(errors="replace")
        values = tuples * components
        size = next((size for start, size in TYPES.items() if kind.startswith(start)), 0)
        if kind.startswith((b"string", b"utf8_string", b"variant")):
            self._texts(values, label, lines=kind.startswith(b"variant") or not self._binary)
        elif not size and not kind.startswith(b"bit"):
            _refuse(kind, f"the type of {label}")
        else:
            nbytes = size * values or (values + 7) // 8
            self.total += nbytes
            self._values(values, nbytes, label)
        # VTK writes metadata after the values.
        if self._is_next(b"metadata"):
            self._word()
            self._metadata(components)

    def _values(self, values: int, nbytes: int, label: str) -> None:
        begin = self._at
        if not self._binary:
            count, self._at = count_numbers(self._data, values, self._at, len(self._data))
            check_count(count, values, label, "numbers")
        elif nbytes:
            self._line()
            begin = self._at
            check_count(len(self._data) - self._at, nbytes, label)
            self._at += nbytes
        self._place = begin, self._at
        if self._binary and nbytes:
            # The newline behind a shorter block would be taken for its last byte.
            ends = self._data[self._at - 1 : self._at + 1]
            if ends[:1] == b"\n" and ends[1:] not in (b"\n", b"\r"):
                raise FieldError(
                    f"the file is damaged: no newline follows the {nbytes:,} bytes of {label}, so "
                    "at least one of them is missing; write or copy it again"
                )

    def _texts(self, values: int, label: str, *, lines: bool) -> None:
        """Skip texts: lines, or bytes after their number."""
        self._line()
        for number in range(values):
            if lines:
                head = self._line()
            else:
                head = self._skip(1) or None
            if head is None:
                check_count(number, values, label, "texts")
            elif not lines:
                length = 2 ** (3 - (head[0] >> 6))  # of the number, whose first bits say it
                size = int.from_bytes(head + self._skip(length - 1), "big")
                size &= (1 << (8 * length - (2 if length < 8 else 0))) - 1
                check_count(len(self._data) - self._at, size, label)
                self._at += size

    def _metadata(self, components: int) -> None:
        self._line()
        while line := self._line():
            if line.lower().startswith(b"component_names"):
                for _ in range(components):
                    self._line()


def _polyhedron_fault(number: int) -> FieldError:
    return FieldError(
        f"the file is damaged: the faces of polyhedron {number:,} do not match their counts; write "
        "or copy it again"
    )


def _refuse(word: bytes, expected: str) -> NoReturn:
    if word:
        fault = f"has {word[:40].decode(errors='replace')!r}"
    else:
        fault = "ends"
    text = "the file is truncated or damaged"
    raise FieldError(f"{text}: it {fault} where {expected} was expected; write or copy it again")
