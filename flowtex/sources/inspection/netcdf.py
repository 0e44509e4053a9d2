"""NetCDF classic (CDF-1, 2 and 5): the file is as long as its header declares.

netCDF's library reads zeros, or partial data, from a shorter file.
"""

from __future__ import annotations

import math
import struct
from pathlib import Path
from typing import BinaryIO

from flowtex.errors import FieldError
from flowtex.sources.inspection.limits import check_count, check_memory

SUFFIXES = (".nc", ".nc4", ".nc3", ".cdf", ".netcdf")
MAGICS = (b"CDF\x01", b"CDF\x02", b"CDF\x05")
#: Bytes of a value by the number of its type.
SIZES = {1: 1, 2: 1, 3: 2, 4: 4, 5: 4, 6: 8, 7: 1, 8: 2, 9: 4, 10: 8, 11: 8}
#: Number of records that the writer did not know.
STREAMING = (0xFFFFFFFF, 0xFFFFFFFFFFFFFFFF)


def check_netcdf(path: Path, *, whole: bool) -> None:
    """Raise a FieldError for a file that is shorter than declared, or too large for the memory."""
    with path.open("rb") as stream:
        size = path.stat().st_size
        header = _Header(stream, size)
        check_count(size, header.length(size), "the header")
        for name, shape, nbytes in header.arrays:
            if whole or len(shape) < 2:
                check_memory(nbytes, f"the variable {name}")


class _Header:
    def __init__(self, stream: BinaryIO, size: int) -> None:
        self._stream, self._left = stream, size
        version = self._read(4)[3]
        self._wide = version == 5
        self._offset = ">I" if version == 1 else ">Q"
        self._records = self._number()
        self._dimensions: list[int] = []
        #: Name, shape and bytes of each variable, of one record if it has records.
        self.arrays: list[tuple[str, tuple[int, ...], int]] = []
        #: Begin, bytes, and whether it has records, of each variable.
        self._places: list[tuple[int, int, bool]] = []
        for _ in self._entries():
            self._name()
            self._dimensions.append(self._number())
        self._attributes()
        for _ in self._entries():
            self._variable()

    def length(self, size: int) -> int:
        """Return the declared length of the file in bytes; it has ``size`` bytes."""
        each = [nbytes for _, nbytes, repeated in self._places if repeated]
        # Values are padded to four bytes, except for those of a single variable with records.
        record = each[0] if len(each) == 1 else sum(-(-nbytes // 4) * 4 for nbytes in each)
        records = self._records
        if records in STREAMING:
            start = min((begin for begin, _, repeated in self._places if repeated), default=size)
            records = max(size - start, 0) // record if record else 0
            if records * record + start < size:
                # The last record is incomplete.
                records += 1
        ends = [
            begin + nbytes + (record * (records - 1) if repeated else 0)
            for begin, nbytes, repeated in self._places
            if nbytes and (records or not repeated)
        ]
        return max(ends, default=0)

    def _variable(self) -> None:
        name = self._name()
        ranks = self._number()
        self._fits(ranks, 4)
        numbers = [self._number() for _ in range(ranks)]
        if any(number >= len(self._dimensions) for number in numbers):
            msg = f"the file is damaged: the variable {name} has an undeclared dimension"
            raise FieldError(msg)
        self._attributes()
        kind = self._unpack(">I")
        if kind not in SIZES:
            msg = f"the file is damaged: the variable {name} has the unknown type {kind}"
            raise FieldError(msg)
        self._number()  # its size again, with too few bits for a large one
        begin = self._unpack(self._offset)
        shape = tuple(self._dimensions[number] for number in numbers)
        repeated = bool(shape) and shape[0] == 0
        nbytes = SIZES[kind] * math.prod(shape[1:] if repeated else shape)
        self._places.append((begin, nbytes, repeated))
        times = self._records if repeated and len(shape) == 1 else 1
        if self._records not in STREAMING:
            self.arrays.append((name, shape, nbytes * times))

    def _attributes(self) -> None:
        for _ in self._entries():
            self._name()
            kind = self._unpack(">I")
            nbytes = SIZES.get(kind, 1) * self._number()
            self._read(-(-nbytes // 4) * 4)

    def _entries(self) -> range:
        """Return a range over the entries of a list."""
        self._unpack(">I")  # the kind of entries
        count = self._number()
        self._fits(count, 8)
        return range(count)

    def _name(self) -> str:
        length = self._number()
        return self._read(-(-length // 4) * 4)[:length].decode(errors="replace")

    def _number(self) -> int:
        return self._unpack(">Q" if self._wide else ">I")

    def _unpack(self, form: str) -> int:
        value: int = struct.unpack(form, self._read(struct.calcsize(form)))[0]
        return value

    def _read(self, count: int) -> bytes:
        self._fits(count, 1)
        self._left -= count
        return self._stream.read(count)

    def _fits(self, count: int, nbytes: int) -> None:
        """Raise a FieldError if the rest of the file is too short for a count of entries."""
        if count * nbytes > self._left:
            msg = (
                f"the file is truncated or damaged: its header needs {count * nbytes:,} more "
                f"bytes, but the file has {self._left:,}; write or copy it again"
            )
            raise FieldError(msg)
