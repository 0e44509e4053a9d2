"""NetCDF classic (CDF-1, 2 and 5): the file is as long as its header declares.

netCDF's library reads zeros, or partial data, from a shorter file. HDF5, which NetCDF-4, CGNS,
Exodus and VTKHDF are, leads to no other file: external storage, external links and virtual datasets
would make the reader read any file that the author of this one names.
"""

from __future__ import annotations

import math
import re
import struct
from collections import Counter
from pathlib import Path
from typing import Any, NoReturn

from flowtex.errors import FieldError
from flowtex.sources.inspection.vtk_files import Data
from flowtex.sources.reader_errors import check_count, check_memory

SUFFIXES = (".nc", ".nc4", ".nc3", ".cdf", ".netcdf")
MAGICS = (b"CDF\x01", b"CDF\x02", b"CDF\x05")
#: Bytes of a value by the number of its type.
SIZES = {1: 1, 2: 1, 3: 2, 4: 4, 5: 4, 6: 8, 7: 1, 8: 2, 9: 4, 10: 8, 11: 8}
#: Most variables of a dataset; the time that xarray needs grows with their square.
MOST_VARIABLES = 2_000
#: Number of records that the writer did not know.
STREAMING = (0xFFFFFFFF, 0xFFFFFFFFFFFFFFFF)


def check_netcdf(data: Data, *, whole: bool) -> None:
    """Raise a FieldError for a file that is shorter than declared, or too large for the memory."""
    header = _Header(data)
    check_count(len(data), header.length(len(data)), "the header")
    for name, shape, nbytes in header.arrays:
        if whole or len(shape) < 2:
            check_memory(nbytes, f"the variable {name}")


def check_variables(count: int) -> None:
    """Raise a FieldError for too many variables, or other entries of a header."""
    if count > MOST_VARIABLES:
        raise FieldError(
            f"the file has {count:,} variables, dimensions or attributes; expected at most "
            f"{MOST_VARIABLES:,}. Write those that are drawn to another file"
        )


class _Header:
    def __init__(self, data: Data) -> None:
        self._data, self._at = data, 0
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
        numbers = [self._number() for _ in range(self._number())]
        self._attributes()
        kind = self._unpack(">I")
        if kind not in SIZES or any(number >= len(self._dimensions) for number in numbers):
            raise FieldError(f"the file is damaged: the type or dimensions of {name} are unknown")
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
        self._unpack(">I")  # the kind of entries
        count = self._number()
        check_variables(count)
        return range(count)

    def _name(self) -> str:
        length = self._number()
        return self._read(-(-length // 4) * 4)[:length].decode(errors="replace")

    def _number(self) -> int:
        return self._unpack(">Q" if self._wide else ">I")

    def _unpack(self, form: str) -> int:
        try:
            value: int = struct.unpack_from(form, self._data, self._at)[0]
        except (struct.error, OverflowError) as error:
            text = f"its header needs more than {len(self._data):,} bytes"
            raise FieldError(f"the file is truncated or damaged: {text}") from error
        self._at += struct.calcsize(form)
        return value

    def _read(self, count: int) -> bytes:
        self._at += count
        return self._data[self._at - count : self._at]


def is_hdf5(path: Path) -> bool:
    """Return whether HDF5 begins somewhere in a file, perhaps after a block of the user."""
    import h5py

    return bool(h5py.is_hdf5(path))


def check_hdf5(path: Path, *, whole: bool) -> None:
    """Raise a FieldError for a file that links to others, is cut, or does not fit into memory."""
    import h5py

    try:
        with h5py.File(path, "r", locking=False) as file:
            links: list[tuple[bytes, int]] = []
            # This follows no link out of the file.
            file.id.links.visit(lambda name, link: links.append((name, link.type)), info=True)
            parents = Counter(name.rpartition(b"/")[0] for name, _ in links)
            check_variables(0 if whole else max(parents.values(), default=0))
            for path_in, kind in sorted(links, key=lambda link: link[1] == h5py.h5l.TYPE_HARD):
                name = path_in.decode(errors="replace")
                if kind == h5py.h5l.TYPE_HARD:
                    _check_object(h5py, h5py.h5o.open(file.id, path_in), name, whole=whole)
                elif kind != h5py.h5l.TYPE_SOFT:
                    external = kind == h5py.h5l.TYPE_EXTERNAL
                    target = file.id.links.get_val(path_in)[0] if external else b"unknown"
                    _refuse(f"{name} is an external link", target.decode(errors="replace"))
    except (OSError, RuntimeError, KeyError, ValueError) as error:
        if isinstance(error, FieldError):
            raise
        ends = re.search(r"eof = (\d+).*base_addr = (\d+), stored_eof = (\d+)", str(error))
        if ends:
            size, base, declared = map(int, ends.groups())
            check_count(size, base + declared, "the header")
        raise FieldError(
            f"the file is damaged: HDF5 reports: {error}; write or copy it again"
        ) from error


def _check_object(h5py: Any, item: Any, name: str, *, whole: bool) -> None:
    if not isinstance(item, h5py.h5d.DatasetID):
        return
    storage = item.get_create_plist()
    if storage.get_external_count():
        target = storage.get_external(0)[0].decode(errors="replace")
        _refuse(f"{name} has external storage", target)
    layout = storage.get_layout()
    if layout == h5py.h5d.VIRTUAL:
        names = {storage.get_virtual_filename(n) for n in range(storage.get_virtual_count())}
        for target in names - {"."}:
            _refuse(f"{name} is a virtual dataset", target)
    size, shape = item.get_type().get_size(), item.shape or ()
    if layout == h5py.h5d.CHUNKED:
        check_memory(size * math.prod(storage.get_chunk()), f"one chunk of {name}")
    if whole and shape and item.get_space().get_simple_extent_dims(1)[0] == h5py.h5s.UNLIMITED:
        shape = shape[1:]
    if whole or len(shape) < 2:
        check_memory(size * math.prod(shape), f"the dataset {name}")


def _refuse(link: str, target: str) -> NoReturn:
    raise FieldError(
        f"{link} in the file {target!r}, but only data in the file itself are read; copy "
        "everything into one file, for example with ds.to_netcdf"
    )
