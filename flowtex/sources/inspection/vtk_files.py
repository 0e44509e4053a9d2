"""Files of VTK in XML: all arrays that are declared are present, and fit into memory.

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
from typing import Literal, TypeAlias
from xml.parsers import expat

import numpy as np

from flowtex._util.memory import check_memory
from flowtex.errors import FieldError
from flowtex.sources.reader_errors import check_count

#: A file that is mapped into memory; an empty one cannot be mapped.
Data: TypeAlias = mmap | bytes
#: Words up to the longest that VTK reads at once.
WORD = re.compile(rb"\S{1,255}")
_NUMBER = rb"(?:\s*+[0-9+\-.eEdDnNaAiIfFtTyY]++(?!\S))"
_NUMBERS = re.compile(_NUMBER + b"*+")
#: Most repetitions that a pattern may name.
MOST_REPEATED = 2**32 - 2


def count_numbers(data: Data, most: int | None, begin: int, end: int) -> tuple[int, int]:
    """Return the count of numbers from ``begin``, at most ``most``, and where they end."""
    if most is not None:
        fitting = min(most, (end - begin + 1) // 2, MOST_REPEATED)
        if match := re.compile(_NUMBER + b"{%d}+" % fitting).match(data, begin, end):
            return fitting, match.end()
    stop = _NUMBERS.match(data, begin, end).end()  # type: ignore[union-attr]
    return sum(1 for _ in WORD.finditer(data, begin, stop)), stop


#: Endings of files of one mesh, of its pieces, of blocks and of series.
SUFFIXES = (
    *(".vti", ".vtp", ".vtr", ".vts", ".vtu", ".pvti", ".pvtp", ".pvtr", ".pvts", ".pvtu"),
    *(".vtm", ".vtmb", ".pvd", ".vtpd"),
)
CHUNK_BYTES = 1 << 20
#: Greatest number of a block; VTK makes as many.
MOST_BLOCKS = 100_000
_TAG = re.compile(rb"""<(?:[^>"']|"[^"]*"|'[^']*')*>\s*""")
_INTEGER = re.compile(rb"\d+")
_BITS = re.compile(r"(?:U?Int|Float)(8|16|32|64)")
#: Elements of cells in XML, whose number of cells is the attribute ``NumberOfVerts`` and so on.
CELL_TAGS = ("Verts", "Lines", "Strips", "Polys", "Cells")


def is_xml(head: bytes) -> bool:
    """Return whether a file with this beginning may be XML."""
    return head.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<")


def check_vtk_xml(path: Path, data: Data, *, is_piece: bool = False) -> list[Path]:
    """Check that the arrays of a file fit into it and into memory; return the files that it names.

    Parameters
    ----------
    path
        The file.
    data
        Its bytes.
    is_piece
        Whether it has a part of a grid that another file describes.

    Raises
    ------
    FieldError
        When the file is cut, is in UTF-16, or declares more than memory holds.
    """
    if b"\0" in data[:4]:
        raise FieldError("the file is in UTF-16, which VTK does not write; convert it to UTF-8")
    document = _Document(data)
    times = Counter[str]()
    # VTK makes the whole of a structured grid, of which the file may have a part.
    copies = max(1, -(-document.whole // max(document.points, 1)))
    for array in document.arrays:
        document.check(array)
        nbytes = (array.values or 0) * array.bits // 8 * copies
        times[array.attributes.get("TimeStep", "")] += nbytes
    check_memory(max(times.values(), default=0), "the file")
    points = max(document.points, document.whole)
    check_memory(max(24 * points, document.parallel), "the grid")
    if not is_piece:
        check_count(document.covered, document.cells, "WholeExtent", "cells")
        check_count(document.nodes, document.whole, "WholeExtent", "nodes")
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
        self.header = 4
        self.compressed = ""
        self.order: Literal["little", "big"] = "little"
        #: Begin of the appended data, and whether they are in base64.
        self._base = len(data)
        self._encoded = False
        #: Numbers of values of the connectivity of cells, and of those that their offsets need.
        self._joined: dict[tuple[int, str], dict[str, int]] = {}
        #: Bytes of the arrays that VTK makes for the pieces of other files.
        self.parallel = 0
        self._path: list[str] = []
        self._piece: dict[str, str] = {}
        self._axis = self._pieces = 0
        #: First and last node of the whole grid along each axis.
        self._extent: list[int] = []
        #: Points of all pieces, and of the whole grid where it is structured.
        self.points = self.whole = 0
        #: Cells of the whole grid where it is structured, and cells and nodes of its pieces.
        self.cells = self.covered = self.nodes = 0
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
        if self._path:
            parent = self._path[-1]
        else:
            parent = ""
        self._path.append(tag)
        if tag == "VTKFile":
            self._start_file(attributes)
        elif tag == "AppendedData":
            after = self._after_tag(self._parser.CurrentByteIndex)
            # An underscore stands before the data.
            self._base = max(self._data.find(b"_", after) + 1, after)
            self._encoded = attributes.get("encoding", "base64") == "base64"
            raise _Appended
        elif tag == "DataSet" or (tag == "Piece" and "Source" in attributes):
            self._cover(attributes.get("Extent", ""))
            _check_whole("index", attributes.get("index", "0"), MOST_BLOCKS)
            self.members += filter(None, (attributes.get("file"), attributes.get("Source")))
        elif "WholeExtent" in attributes:
            self._extent = _ends(attributes["WholeExtent"])
            self.whole = math.prod(_sides(attributes["WholeExtent"]))
            self.cells = _cells(attributes["WholeExtent"])
        elif tag == "Piece" and len(self._path) == 3:  # VTK reads only those of the grid
            self._piece = attributes
            self._pieces += 1
            self._check_piece()
            self.points += self._tuples("PointData") or 0
        elif tag == "Block":
            _check_whole("index", attributes.get("index", "0"), MOST_BLOCKS)
        elif tag in ("Coordinates", "Points"):
            self._axis = 0
        elif tag in ("DataArray", "Array"):
            self._array(parent, attributes)
        elif tag == "PDataArray" and parent in ("PPointData", "PPoints"):
            components = _whole(attributes.get("NumberOfComponents", "1"))
            self.parallel += 8 * components * self.whole

    def _start_file(self, attributes: dict[str, str]) -> None:
        """Take how the data of a file are stored."""
        if attributes.get("byte_order") == "BigEndian":
            self.order = "big"
        else:
            self.order = "little"
        if attributes.get("header_type") == "UInt64":
            self.header = 8
        else:
            self.header = 4
        self.compressed = attributes.get("compressor", "")

    def _check_piece(self) -> None:
        """Raise a FieldError for a negative count, or nodes outside of the whole grid."""
        for key, text in self._piece.items():
            if key.startswith("NumberOf"):
                _check_whole(key, text)
        if "Extent" not in self._piece or not self._extent:
            return
        self._cover(self._piece["Extent"])
        ends = _ends(self._piece["Extent"])
        firsts = zip(ends[::2], self._extent[::2], strict=False)
        lasts = zip(ends[1::2], self._extent[1::2], strict=False)
        is_inside = all(a >= b for a, b in firsts) and all(a <= b for a, b in lasts)
        if len(ends) != 6 or not is_inside:
            raise FieldError(
                f"a piece has the Extent {self._piece['Extent']!r}, outside of the WholeExtent "
                f"{self._extent}; the file is damaged, write or copy it again"
            )

    def _cover(self, extent: str) -> None:
        """Count the cells and nodes of a piece of a structured grid."""
        if extent:
            self.covered += _cells(extent)
            self.nodes += math.prod(_sides(extent))

    def _array(self, section: str, attributes: dict[str, str]) -> None:
        for key in ("NumberOfComponents", "NumberOfTuples", "offset"):
            _check_whole(key, attributes.get(key, "0"))
        name = attributes.get("Name", "")
        kind = attributes.get("type", "")
        bits = _BITS.fullmatch(kind)
        if kind == "Bit":
            width = 1
        elif bits:
            width = int(bits[1])
        else:
            width = 8
        values = self._tuples(section, name)
        if section == "FieldData" or values is None:
            declared = attributes.get("NumberOfTuples")
            if declared is None:
                values = None
            else:
                values = _whole(declared)
        if values is not None:
            values *= _whole(attributes.get("NumberOfComponents", "1"))
        begin = self._parser.CurrentByteIndex
        name = name or section
        self.arrays.append(_Array(name, section, width, values, attributes, self._pieces, begin))

    def _tuples(self, section: str, name: str = "") -> int | None:
        """Return the number of tuples of an array; ``None`` where another array has it."""
        count = {}
        for key in self._piece:
            if key != "Extent":
                count[key] = _whole(self._piece.get(key, "0"))
        if "Extent" in self._piece:
            sides = _sides(self._piece["Extent"])
            points = math.prod(sides)
            cells = _cells(self._piece["Extent"])
        else:
            sides = ()
            points = count.get("NumberOfPoints", 0)
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
        """Raise a FieldError if the file has less or more of an array than declared."""
        label = f"the array {array.name}"
        is_topology = array.section in CELL_TAGS and array.name in ("offsets", "connectivity")
        form = array.attributes.get("format", "ascii").lower()
        begin = self._after_tag(array.begin)
        if form == "ascii":
            values, end = count_numbers(self._data, array.values, begin, array.end)
            rest, _ = count_numbers(self._data, 1, end, array.end)
            values += rest
            tail = _INTEGER.findall(self._data, max(begin, array.end - 64), array.end)
            if is_topology:
                last = int((tail or [b"0"])[-1])
            else:
                last = None
        else:
            place = begin, array.end, True
            if form == "appended":
                offset = self._base + _whole(array.attributes.get("offset", "0"))
                place = offset, len(self._data), self._encoded
            if array.values == 0 and place[0] >= place[1]:
                return  # an empty array may have no header
            block = _Block(self._data, self, place, label)
            values = block.nbytes * 8 // array.bits
            if is_topology:
                last = block.last(array.bits // 8)
            else:
                last = None
        if array.values is not None:
            check_count(values, array.values, label, "values")
            if values > array.values and array.attributes.get("type") != "String":
                raise FieldError(
                    f"the file is damaged: {label} has more than the {array.values:,} values that "
                    "its piece declares; write or copy it again"
                )
        if is_topology and last is not None:
            ends = self._joined.setdefault((array.piece, array.section), {})
            ends[array.name] = last if array.name == "offsets" else values
            if len(ends) == 2:
                check_count(ends["connectivity"], ends["offsets"], "the offsets of cells", "nodes")

    def _after_tag(self, begin: int) -> int:
        match = _TAG.match(self._data, begin)
        if match:
            return match.end()
        return begin


class _Appended(Exception):
    """The elements have ended, and data follow."""


class _Block:
    """The bytes of one array or of its compressed blocks, after a header with their number."""

    def __init__(
        self, data: Data, document: _Document, place: tuple[int, int, bool], what: str
    ) -> None:
        self._data = data
        self._order = document.order
        self._word = document.header
        self._begin, end, self._encoded = place
        room = max(end - self._begin, 0)
        if self._encoded:
            self._room = room * 3 // 4
        else:
            self._room = room
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
        if blocks:
            self.nbytes = full * (blocks - 1) + self._last_size
        else:
            self.nbytes = 0
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
                begin = begin + encoded_head
                offset = offset - head
        text = self._data[begin + offset // 3 * 4 : begin + -(-(offset + count) // 3) * 4]
        try:
            return base64.b64decode(text)[offset % 3 :][:count]
        except binascii.Error:
            return b""


def _sides(extent: str) -> tuple[int, ...]:
    """Return the nodes along the axes of an extent such as ``"0 9 0 9 0 0"``."""
    ends = [_whole(word) for word in extent.split()]
    return tuple(max(b - a + 1, 0) for a, b in zip(ends[::2], ends[1::2], strict=False))


def _cells(extent: str) -> int:
    """Return the number of cells of an extent."""
    sides = _sides(extent)
    if len(sides) != 3:
        return 0
    return math.prod(max(side - 1, 1) for side in sides)


def _ends(extent: str) -> list[int]:
    """Return the first and last node along each axis of an extent."""
    return [_whole(word) for word in extent.split()]


def _check_whole(name: str, text: str, most: int | None = None) -> None:
    """Raise a FieldError if the whole number in an attribute ``name`` is negative or too large."""
    value = _whole(text)
    if value < 0 or (most is not None and value > most):
        if most is None:
            expected = "0 or more"
        else:
            expected = f"0 to {most:,}"
        raise FieldError(
            f"the file is damaged: {name} is {text[:40]!r}; expected {expected}. Write or copy it "
            "again"
        )


def _whole(word: str) -> int:
    """Return a whole number as VTK reads it: 0 for other words."""
    match = re.match(r"\s*[+-]?\d{1,20}", word)
    if match:
        return int(match.group())
    return 0


def _refuse_entity(name: str, *_: object) -> None:
    raise FieldError(
        f"the file declares the XML entity {name}, so it is refused: VTK files have no entities"
    )
