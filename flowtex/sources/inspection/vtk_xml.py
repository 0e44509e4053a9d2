"""VTK's XML files: their arrays are present, and as long as the pieces declare.

VTK allocates the declared size before it reads the first value.
"""

from __future__ import annotations

import base64
import binascii
import math
import re
import zlib
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Literal
from xml.parsers import expat

import numpy as np

from flowtex.errors import FieldError
from flowtex.sources.inspection.vtk_legacy import Data, count_numbers
from flowtex.sources.reader_errors import check_count, check_memory

#: Endings of files of one mesh, of its pieces, of blocks and of series.
SUFFIXES = (
    *(".vti", ".vtp", ".vtr", ".vts", ".vtu", ".pvti", ".pvtp", ".pvtr", ".pvts", ".pvtu"),
    *(".vtm", ".vtmb", ".pvd", ".vtpd"),
)
CHUNK_BYTES = 1 << 20
_TAG = re.compile(rb"""<(?:[^>"']|"[^"]*"|'[^']*')*>\s*""")
_INTEGER = re.compile(rb"\d+")
_BITS = re.compile(r"(?:U?Int|Float)(8|16|32|64)")
#: Kinds of cells, and the attributes with their counts.
CELLS = {"Verts": "NumberOfVerts", "Lines": "NumberOfLines"}
CELLS |= {"Strips": "NumberOfStrips", "Polys": "NumberOfPolys", "Cells": "NumberOfCells"}


def is_xml(head: bytes) -> bool:
    """Return whether a file with this beginning may be XML."""
    return head.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<")


def check_vtk_xml(path: Path, data: Data) -> list[Path]:
    """Return the files that a file names, if its arrays fit into it and into memory."""
    if b"\0" in data[:4]:
        raise FieldError("the file is in UTF-16, which VTK does not write; convert it to UTF-8")
    document = _Document()
    document.parse(data)
    contents, times = _Contents(data, document), Counter[str]()
    # VTK makes the whole of a structured grid, of which the file may have a part.
    copies = max(1, -(-document.whole // max(document.points, 1)))
    for array in document.arrays:
        contents.check(array)
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
    """The declarations of a file's elements, up to the appended data."""

    def __init__(self) -> None:
        self.arrays: list[_Array] = []
        self.members: list[str] = []
        self.header, self.compressed = 4, ""
        self.order: Literal["little", "big"] = "little"
        #: Begin of the appended data, and whether they are in base64.
        self.appended: int | None = None
        self.encoded = False
        #: Bytes of the arrays that VTK makes for the pieces of other files.
        self.parallel = 0
        self._path: list[str] = []
        self._piece: dict[str, str] = {}
        self._axis = 0
        self._pieces = 0
        #: Points of all pieces, and of the whole grid where it is structured.
        self.points = self.whole = 0
        self._parser = expat.ParserCreate()
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.EntityDeclHandler = _refuse_entity

    def parse(self, data: Data) -> None:
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
            self.appended = self._parser.CurrentByteIndex
            self.encoded = attributes.get("encoding", "base64") == "base64"
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
            cells = sum(count.get(key, 0) for key in CELLS.values())
        match section:
            case "PointData" | "Points":
                return points
            case "CellData":
                return cells
            case "RowData":
                return count.get("NumberOfRows", 0)
            case "Coordinates" if sides:
                self._axis += 1
                return sides[min(self._axis, 3) - 1]
            case _ if section in CELLS and name in ("offsets", "types"):
                return count.get(CELLS[section], 0)
        return None

    def _end(self, _: str) -> None:
        self._stop()
        self._path.pop()

    def _stop(self) -> None:
        if self.arrays and not self.arrays[-1].end:
            self.arrays[-1].end = self._parser.CurrentByteIndex


class _Appended(Exception):
    """The elements have ended, and data follow."""


class _Contents:
    def __init__(self, data: Data, document: _Document) -> None:
        self._data, self._document = data, document
        self._base = len(data)
        #: Numbers of values of the connectivity of cells, and of those that their offsets need.
        self._joined: dict[tuple[int, str], dict[str, int]] = {}
        if document.appended is not None:
            tag = self._after_tag(document.appended)
            # An underscore stands before the data.
            self._base = max(data.find(b"_", tag) + 1, tag)

    def check(self, array: _Array) -> None:
        """Raise a FieldError if the file has less of an array than declared."""
        if array.values == 0:
            return
        label = f"the array {array.name}"
        is_topology = array.section in CELLS and array.name in ("offsets", "connectivity")
        form, begin = array.attributes.get("format", "ascii").lower(), self._after_tag(array.begin)
        if form == "ascii":
            values, _ = count_numbers(self._data, array.values, begin, array.end)
            tail = _INTEGER.findall(self._data, max(begin, array.end - 64), array.end)
            last = int((tail or [b"0"])[-1]) if is_topology else None
        else:
            place = begin, array.end, True
            if form == "appended":
                offset = self._base + _whole(array.attributes.get("offset", "0"))
                place = offset, len(self._data), self._document.encoded
            block = _Block(self._data, self._document, place, label)
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
