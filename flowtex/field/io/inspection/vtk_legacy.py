"""Legacy files of VTK: all arrays that are declared are there.

VTK allocates what a keyword declares, and goes on with what it has where the file ends early.
"""

from __future__ import annotations

import math
import re
from pathlib import Path

from flowtex.errors import FieldError
from flowtex.field.io.inspection.limits import check_count, check_memory
from flowtex.field.io.inspection.numbers import TextScanner

__all__ = ["MAGIC", "check_vtk_legacy"]

MAGIC = b"# vtk DataFile Version"
#: Bytes of a value in the file and in memory; VTK tells types by how their names begin.
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


def check_vtk_legacy(path: Path) -> None:
    """Refuse a file that ends early, or whose arrays do not fit into memory.

    Raises
    ------
    FieldError
        With what is missing.
    """
    with path.open("rb") as stream:
        _Legacy(TextScanner(stream, path.stat().st_size)).check()


class _Legacy:
    """Goes through a file as VTK's reader does.

    Where a word is met that the format has not, VTK's reader ends as well, with an error.
    """

    def __init__(self, text: TextScanner) -> None:
        self._text = text
        self._binary = False
        self._version = 0
        #: Points or cells that attributes are given for.
        self._tuples = 0
        #: Bytes of all arrays in memory.
        self._total = 0

    def check(self) -> None:
        version = (self._text.line() or b"").removeprefix(MAGIC).split(b".")[0].strip()
        self._version = int(version) if version.isdigit() else 0
        self._text.line()  # the title
        self._binary = self._text.word().lower().startswith(b"binary")
        while (word := self._text.word().lower()) and self._section(word):
            pass
        check_memory(self._total, "the file")

    def _section(self, word: bytes) -> bool:
        """Check what a keyword declares; return whether it is known."""
        attribute = next((name for name in COMPONENTS if word.startswith(name)), None)
        if word in CELLS:
            self._cells(word)
        elif attribute is not None:
            name = self._text.word()
            self._array(
                attribute + b" " + name, self._text.word(), self._tuples, COMPONENTS[attribute]
            )
        elif word.startswith((b"point_data", b"cell_data")):
            self._tuples = self._count(word)
        elif word.startswith((b"scalars", b"color_scalars", b"texture_coordinates")):
            self._scalars(word)
        elif word.startswith(b"lookup_table"):
            name = self._text.word()
            kind = b"unsigned_char" if self._binary else b"float"
            self._array(b"LOOKUP_TABLE " + name, kind, self._count(word), 4)
        elif word.startswith(b"field"):
            self._text.word()
            for _ in range(self._count(word)):
                if not self._field_array():
                    break
        elif word.startswith(b"metadata"):
            self._metadata(0)
        else:
            return self._geometry(word)
        return True

    def _geometry(self, word: bytes) -> bool:
        if word == b"dataset":
            self._text.word()
        elif word in (b"dimensions", b"extent"):
            ends = [self._number() for _ in range(3 if word == b"dimensions" else 6)]
            sides = (
                ends
                if len(ends) == 3
                else [b - a + 1 for a, b in zip(ends[::2], ends[1::2], strict=True)]
            )
            # PyVista makes points of grids that have none.
            check_memory(24 * math.prod(max(n, 0) for n in sides), "the grid")
        elif word in (b"spacing", b"origin", b"aspect_ratio"):
            self._text.numbers(3)
        elif word in (b"points", b"x_coordinates", b"y_coordinates", b"z_coordinates", b"blanking"):
            count = self._count(word)
            self._array(word, self._text.word(), count, 3 if word == b"points" else 1)
        elif word == b"cell_types":
            self._array(word, b"int", self._count(word), 1)
        else:
            return False
        return True

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
        what = word + b" " + name
        if word.startswith(b"color_scalars"):
            kind = b"unsigned_char" if self._binary else b"float"
            self._array(what, kind, self._tuples, self._count(what))
        elif word.startswith(b"texture_coordinates"):
            components = self._count(what)
            self._array(what, self._text.word(), self._tuples, components)
        else:
            kind, components = self._text.word(), 1
            if self._text.next_word().lower() != b"lookup_table":
                components = self._count(what)
            self._text.word()
            self._text.word()  # the table's name
            self._array(what, kind, self._tuples, components)

    def _field_array(self) -> bool:
        """Check an array of a field; return whether there is one."""
        name = self._text.word()
        if name == b"NULL_ARRAY":
            return True
        check_count(int(bool(name)), 1, "FIELD", "arrays more")
        components, tuples = self._count(name), self._count(name)
        self._array(b"FIELD " + name, self._text.word(), tuples, components)
        return True

    def _array(self, name: bytes, kind: bytes, tuples: int, components: int) -> None:
        """Go over the values of an array, and refuse one that has fewer than it declares."""
        kind, what = kind.lower(), name.decode(errors="replace")
        values = tuples * components
        if kind.startswith((b"string", b"utf8_string", b"variant")):
            self._words(kind, values, what)
        elif kind.startswith(b"bit"):
            self._values(values, (values + 7) // 8, what)
        else:
            sizes = next((size for start, size in TYPES.items() if kind.startswith(start)), None)
            if sizes is None:
                return
            self._total += sizes[1] * values
            self._values(values, sizes[0] * values, what)
        self._metadata_after(components)

    def _values(self, values: int, nbytes: int, what: str) -> None:
        if not self._binary:
            check_count(self._text.numbers(values), values, what, "numbers")
        elif nbytes:
            self._text.line()
            check_count(self._text.skip(nbytes), nbytes, what)

    def _words(self, kind: bytes, values: int, what: str) -> None:
        """Go over texts: lines, or in binary files bytes whose number comes before them."""
        self._text.line()
        for number in range(values):
            if kind.startswith(b"variant") or not self._binary:
                there = self._text.line() is not None
            else:
                there = bool(head := self._text.read(1))
                if there:
                    length = 2 ** (3 - (head[0] >> 6))
                    head += self._text.read(length - 1)
                    mask = (1 << (8 * length)) - 1 if length == 8 else (1 << (8 * length - 2)) - 1
                    size = int.from_bytes(head, "big") & mask
                    check_count(self._text.skip(size), size, what)
            if not there:
                check_count(number, values, what, "texts")

    def _metadata_after(self, components: int) -> None:
        """Go over what VTK writes of an array after its values."""
        if self._text.next_word().lower().startswith(b"metadata"):
            self._text.word()
            self._metadata(components)

    def _metadata(self, components: int) -> None:
        self._text.line()
        while line := self._text.line():
            if line.lower().startswith(b"component_names"):
                for _ in range(components):
                    self._text.line()

    def _number(self) -> int:
        """Return a whole number, as VTK reads it: 0 where there is none, which ends its reading."""
        match = re.match(rb"[+-]?\d{1,20}", self._text.word())
        return int(match.group()) if match else 0

    def _count(self, what: bytes) -> int:
        count = self._number()
        if count < 0:
            msg = f"the file is broken: {what.decode()} declares {count}; write or copy it again"
            raise FieldError(msg)
        return count
