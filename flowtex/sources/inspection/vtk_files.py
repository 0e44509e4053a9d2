"""Files of VTK, legacy and XML: all arrays that are declared are present, and fit into memory.

VTK allocates what is declared before it reads the first value, and continues with partial data if
a file ends early.
"""

from __future__ import annotations

import base64
import binascii
import math
import re
import zlib
from collections import Counter
from dataclasses import dataclass
from mmap import mmap
from pathlib import Path
from typing import Literal, NoReturn, TypeAlias
from xml.parsers import expat

import numpy as np

from flowtex.errors import FieldError
from flowtex.sources.reader_errors import check_count, check_memory

#: A file that is mapped into memory; an empty one cannot be mapped.
Data: TypeAlias = mmap | bytes
#: Words up to the longest that VTK reads at once.
_WORD = re.compile(rb"\S{1,255}")
_NUMBER = rb"(?:\s*+[0-9+\-.eEdDnNaAiIfFtTyY]++(?!\S))"
_NUMBERS = re.compile(_NUMBER + b"*+")
#: Most repetitions that a pattern may name.
MOST_REPEATED = 2**32 - 2
MAGIC = b"# vtk DataFile Version"
#: Bytes of a value by the beginning of its type's name, as VTK recognises it.
TYPES = {
    **dict.fromkeys((b"unsigned_char", b"signed_char", b"char"), 1),
    **dict.fromkeys((b"unsigned_short", b"short"), 2),
    **dict.fromkeys((b"vtkidtype", b"unsigned_int", b"int", b"float"), 4),
    **dict.fromkeys((b"unsigned_long", b"long", b"vtktypeint64", b"vtktypeuint64", b"double"), 8),
}
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


def count_numbers(data: Data, most: int | None, begin: int, end: int) -> tuple[int, int]:
    """Return the count of numbers from ``begin``, at most ``most``, and where they end."""
    if most is not None:
        fitting = min(most, (end - begin + 1) // 2, MOST_REPEATED)
        if match := re.compile(_NUMBER + b"{%d}+" % fitting).match(data, begin, end):
            return fitting, match.end()
    stop = _NUMBERS.match(data, begin, end).end()  # type: ignore[union-attr]
    return sum(1 for _ in _WORD.finditer(data, begin, stop)), stop


def check_vtk_legacy(data: Data) -> None:
    """Raise a FieldError for a file that ends early, or does not fit into memory."""
    check_memory(_Legacy(data).total, "the file")


class _Legacy:
    """One pass through a file as by VTK's reader, which refuses unknown content."""

    def __init__(self, data: Data) -> None:
        self._data, self._at = data, 0
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
        while word := self._word().lower():
            self._section(word)

    def _word(self) -> bytes:
        """Return the next word, empty at the end."""
        match = _WORD.search(self._data, self._at)
        self._at = match.end() if match else len(self._data)
        return match.group() if match else b""

    def _is_next(self, beginning: bytes) -> bool:
        match = _WORD.search(self._data, self._at)
        return match is not None and match.group().lower().startswith(beginning)

    def _line(self) -> bytes | None:
        """Return the rest of the line without its end, ``None`` at the end of the file."""
        begin, length = self._at, len(self._data)
        stop = self._data.find(b"\n", begin)
        stop = length if stop < 0 else stop
        self._at = min(stop + 1, length)
        return None if begin == length else self._data[begin:stop].removesuffix(b"\r")

    def _skip(self, count: int) -> bytes:
        begin, self._at = self._at, min(self._at + count, len(self._data))
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
            case b"lookup_table":
                name = keyword + b" " + self._word()
                self._array(name, byte, self._count(keyword), 4)
            case b"color_scalars":
                name = keyword + b" " + self._word()
                self._array(name, byte, self._tuples, self._count(name))
            case b"texture_coordinates":
                name, components = keyword + b" " + self._word(), self._count(keyword)
                self._array(name, self._word(), self._tuples, components)
            case b"scalars":
                name, kind = keyword + b" " + self._word(), self._word()
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
                count, components = self._count(keyword), 3 if keyword == b"points" else 1
                self._array(keyword, self._word(), count, components)

    def _cells(self, word: bytes) -> None:
        first, second = self._count(word), self._count(word)
        if self._version < 5:
            self._array(word, b"int", second, 1)
            return
        for count in (first, second) if first else ():
            name = self._word()
            self._array(word + b" " + name, self._word(), count, 1)

    def _field_array(self) -> None:
        name = self._word()
        if name == b"NULL_ARRAY":
            return
        check_count(int(bool(name)), 1, "FIELD", "arrays more")
        components, tuples = self._count(name), self._count(name)
        self._array(b"FIELD " + name, self._word(), tuples, components)

    def _array(self, name: bytes, kind: bytes, tuples: int, components: int) -> None:
        """Skip the values of an array, which must have as many as it declares."""
        kind, label = kind.lower(), name.decode(errors="replace")
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
        if not self._binary:
            count, self._at = count_numbers(self._data, values, self._at, len(self._data))
            check_count(count, values, label, "numbers")
        elif nbytes:
            self._line()
            check_count(len(self._data) - self._at, nbytes, label)
            self._at += nbytes
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
            head = self._line() if lines else self._skip(1) or None
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


def _refuse(word: bytes, expected: str) -> NoReturn:
    fault = f"has {word[:40].decode(errors='replace')!r}" if word else "ends"
    text = "the file is truncated or damaged"
    raise FieldError(f"{text}: it {fault} where {expected} was expected; write or copy it again")


#: Endings of files of one mesh, of its pieces, of blocks and of series.
SUFFIXES = (
    *(".vti", ".vtp", ".vtr", ".vts", ".vtu", ".pvti", ".pvtp", ".pvtr", ".pvts", ".pvtu"),
    *(".vtm", ".vtmb", ".pvd", ".vtpd"),
)
CHUNK_BYTES = 1 << 20
_TAG = re.compile(rb"""<(?:[^>"']|"[^"]*"|'[^']*')*>\s*""")
_INTEGER = re.compile(rb"\d+")
_BITS = re.compile(r"(?:U?Int|Float)(8|16|32|64)")
#: Elements of cells in XML, whose number of cells is the attribute ``NumberOfVerts`` and so on.
CELL_TAGS = ("Verts", "Lines", "Strips", "Polys", "Cells")


def is_xml(head: bytes) -> bool:
    """Return whether a file with this beginning may be XML."""
    return head.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<")


def check_vtk_xml(path: Path, data: Data) -> list[Path]:
    """Return the files that a file names, if its arrays fit into it and into memory."""
    if b"\0" in data[:4]:
        raise FieldError("the file is in UTF-16, which VTK does not write; convert it to UTF-8")
    document, times = _Document(data), Counter[str]()
    # VTK makes the whole of a structured grid, of which the file may have a part.
    copies = max(1, -(-document.whole // max(document.points, 1)))
    for array in document.arrays:
        document.check(array)
        nbytes = (array.values or 0) * array.bits // 8 * copies
        times[array.attributes.get("TimeStep", "")] += nbytes
    check_memory(max(times.values(), default=0), "the file")
    points = max(document.points, document.whole)
    check_memory(max(24 * points, document.parallel), "the grid")
    return [path.parent / name for name in document.members]


@dataclass
class _Array:
    """The declaration of an array; ``values`` is ``None`` where another array has the count."""

    name: str
    section: str
    bits: int
    values: int | None
    attributes: dict[str, str]
    piece: int
    begin: int  #: Begin of its tag.
    end: int = 0  #: End of its content.


class _Document:
    """The declarations of a file's elements, up to the appended data, and their content."""

    def __init__(self, data: Data) -> None:
        self._data = data
        self.arrays: list[_Array] = []
        self.members: list[str] = []
        self.header, self.compressed = 4, ""
        self.order: Literal["little", "big"] = "little"
        #: Begin of the appended data, and whether they are in base64.
        self._base, self._encoded = len(data), False
        #: Numbers of values of the connectivity of cells, and of those that their offsets need.
        self._joined: dict[tuple[int, str], dict[str, int]] = {}
        #: Bytes of the arrays that VTK makes for the pieces of other files.
        self.parallel = 0
        self._path: list[str] = []
        self._piece: dict[str, str] = {}
        self._axis = self._pieces = 0
        #: Points of all pieces, and of the whole grid where it is structured.
        self.points = self.whole = 0
        self._parser = expat.ParserCreate()
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.EntityDeclHandler = _refuse_entity
        try:
            # After the elements expat would read the rest of a part as well.
            for at in range(0, len(data), CHUNK_BYTES):
                self._parser.Parse(data[at : at + CHUNK_BYTES])
            self._parser.Parse(b"", True)  # noqa: FBT003
        except _Appended:
            pass
        except expat.ExpatError as error:
            endings = "no element found", "unclosed token", "unclosed CDATA"
            cut = any(word in str(error) for word in endings)
            fault = "is truncated: its XML ends early" if cut else "is not valid XML"
            raise FieldError(f"the file {fault} ({error}); write or copy it again") from error

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._stop()
        parent = self._path[-1] if self._path else ""
        self._path.append(tag)
        if tag == "VTKFile":
            self.order = "big" if attributes.get("byte_order") == "BigEndian" else "little"
            self.header = 8 if attributes.get("header_type") == "UInt64" else 4
            self.compressed = attributes.get("compressor", "")
        elif tag == "AppendedData":
            after = self._after_tag(self._parser.CurrentByteIndex)
            # An underscore stands before the data.
            self._base = max(self._data.find(b"_", after) + 1, after)
            self._encoded = attributes.get("encoding", "base64") == "base64"
            raise _Appended
        elif tag == "DataSet" or (tag == "Piece" and "Source" in attributes):
            self.members += filter(None, (attributes.get("file"), attributes.get("Source")))
        elif "WholeExtent" in attributes:
            self.whole = math.prod(_sides(attributes["WholeExtent"]))
        elif tag == "Piece" and len(self._path) == 3:  # VTK reads only those of the grid
            self._piece, self._pieces = attributes, self._pieces + 1
            self.points += self._tuples("PointData") or 0
        elif tag in ("Coordinates", "Points"):
            self._axis = 0
        elif tag in ("DataArray", "Array"):
            self._array(parent, attributes)
        elif tag == "PDataArray" and parent in ("PPointData", "PPoints"):
            components = _whole(attributes.get("NumberOfComponents", "1"))
            self.parallel += 8 * components * self.whole

    def _array(self, section: str, attributes: dict[str, str]) -> None:
        name, kind = attributes.get("Name", ""), attributes.get("type", "")
        bits = _BITS.fullmatch(kind)
        width = 1 if kind == "Bit" else int(bits[1]) if bits else 8
        values = self._tuples(section, name)
        if section == "FieldData" or values is None:
            declared = attributes.get("NumberOfTuples")
            values = None if declared is None else _whole(declared)
        if values is not None:
            values *= _whole(attributes.get("NumberOfComponents", "1"))
        begin, name = self._parser.CurrentByteIndex, name or section
        self.arrays.append(_Array(name, section, width, values, attributes, self._pieces, begin))

    def _tuples(self, section: str, name: str = "") -> int | None:
        """Return the number of tuples of an array; ``None`` where another array has it."""
        count = {key: _whole(self._piece.get(key, "0")) for key in self._piece if key != "Extent"}
        if "Extent" in self._piece:
            sides = _sides(self._piece["Extent"])
            points, cells = math.prod(sides), math.prod(max(n - 1, 1) for n in sides)
        else:
            sides, points = (), count.get("NumberOfPoints", 0)
            cells = sum(count.get(f"NumberOf{tag}", 0) for tag in CELL_TAGS)
        if section == "Coordinates" and sides:
            self._axis += 1
            return sides[min(self._axis, 3) - 1]
        if section in CELL_TAGS and name in ("offsets", "types"):
            return count.get(f"NumberOf{section}", 0)
        rows = count.get("NumberOfRows", 0)
        known = {"PointData": points, "Points": points, "CellData": cells, "RowData": rows}
        return known.get(section)

    def _end(self, _: str) -> None:
        self._stop()
        self._path.pop()

    def _stop(self) -> None:
        if self.arrays and not self.arrays[-1].end:
            self.arrays[-1].end = self._parser.CurrentByteIndex

    def check(self, array: _Array) -> None:
        """Raise a FieldError if the file has less of an array than declared."""
        if array.values == 0:
            return
        label = f"the array {array.name}"
        is_topology = array.section in CELL_TAGS and array.name in ("offsets", "connectivity")
        form, begin = array.attributes.get("format", "ascii").lower(), self._after_tag(array.begin)
        if form == "ascii":
            values, _ = count_numbers(self._data, array.values, begin, array.end)
            tail = _INTEGER.findall(self._data, max(begin, array.end - 64), array.end)
            last = int((tail or [b"0"])[-1]) if is_topology else None
        else:
            place = begin, array.end, True
            if form == "appended":
                offset = self._base + _whole(array.attributes.get("offset", "0"))
                place = offset, len(self._data), self._encoded
            block = _Block(self._data, self, place, label)
            values = block.nbytes * 8 // array.bits
            last = block.last(array.bits // 8) if is_topology else None
        if array.values is not None:
            check_count(values, array.values, label, "values")
        if is_topology and last is not None:
            ends = self._joined.setdefault((array.piece, array.section), {})
            ends[array.name] = last if array.name == "offsets" else values
            if len(ends) == 2:
                check_count(ends["connectivity"], ends["offsets"], "the offsets of cells", "nodes")

    def _after_tag(self, begin: int) -> int:
        match = _TAG.match(self._data, begin)
        return match.end() if match else begin


class _Appended(Exception):
    """The elements have ended, and data follow."""


class _Block:
    """The bytes of one array, after a header with their number, or those of compressed blocks."""

    def __init__(
        self, data: Data, document: _Document, place: tuple[int, int, bool], what: str
    ) -> None:
        self._data, self._order, self._word = data, document.order, document.header
        self._begin, end, self._encoded = place
        room = max(end - self._begin, 0)
        self._room = room * 3 // 4 if self._encoded else room
        self._sizes: list[int] = []
        if not document.compressed:
            (self.nbytes,) = self._header(1, what)
            check_count(self._room - self._word, self.nbytes, what)
            return
        self._zlib = document.compressed == "vtkZLibDataCompressor"
        blocks, full, last = self._header(3, what)
        self._sizes = self._header(3 + blocks, what)[3:]
        check_count(self._room - (3 + blocks) * self._word, sum(self._sizes), what)
        self._last_size = last or full
        self.nbytes = full * (blocks - 1) + self._last_size if blocks else 0
        check_memory(full, f"one block of {what}")

    def last(self, nbytes: int) -> int | None:
        """Return the last value, an integer of this many bytes; ``None`` if unknown."""
        if self.nbytes < nbytes:
            return 0
        if not self._sizes:
            data = self._read(self._word + self.nbytes - nbytes, nbytes, self._word)
        elif self._zlib:
            head = (3 + len(self._sizes)) * self._word
            packed = self._read(head + sum(self._sizes[:-1]), self._sizes[-1], head)
            try:
                data = zlib.decompressobj().decompress(packed, self._last_size)[-nbytes:]
            except zlib.error:  # VTK reports it
                return None
        else:
            return None
        return int.from_bytes(data, self._order, signed=True)

    def _header(self, count: int, what: str) -> list[int]:
        check_count(self._room, count * self._word, what)
        data = self._read(0, count * self._word, 0)
        check_count(len(data), count * self._word, what)
        kind = np.dtype(f"u{self._word}").newbyteorder(self._order)
        return np.frombuffer(data, kind).tolist()

    def _read(self, offset: int, count: int, head: int) -> bytes:
        """Return bytes of the block, whose first ``head`` may be encoded separately."""
        if not self._encoded:
            return self._data[self._begin + offset : self._begin + offset + count]
        begin = self._begin
        if head:
            encoded_head = -(-head // 3) * 4
            if self._sizes or b"=" in self._data[begin : begin + encoded_head]:
                begin, offset = begin + encoded_head, offset - head
        text = self._data[begin + offset // 3 * 4 : begin + -(-(offset + count) // 3) * 4]
        try:
            return base64.b64decode(text)[offset % 3 :][:count]
        except binascii.Error:
            return b""


def _sides(extent: str) -> tuple[int, ...]:
    """Return the nodes along the axes of an extent such as ``"0 9 0 9 0 0"``."""
    ends = [_whole(word) for word in extent.split()]
    return tuple(max(b - a + 1, 0) for a, b in zip(ends[::2], ends[1::2], strict=False))


def _whole(word: str) -> int:
    """Return a whole number as VTK reads it: 0 for other words."""
    match = re.match(r"\s*[+-]?\d{1,20}", word)
    return int(match.group()) if match else 0


def _refuse_entity(name: str, *_: object) -> None:
    raise FieldError(
        f"the file declares the XML entity {name}, so it is refused: VTK files have no entities"
    )
