"""Inspection of a file before any reader opens it, by its content and its name."""

from __future__ import annotations

import math
import re
import struct
from collections import Counter
from collections.abc import Callable
from functools import lru_cache
from mmap import ACCESS_READ, mmap
from os.path import realpath
from pathlib import Path
from typing import Any, NoReturn

from flowtex._util.memory import check_memory
from flowtex.errors import FieldError, import_extra
from flowtex.sources.inspection import vtk_files
from flowtex.sources.inspection.foam_files import case_of, check_foam
from flowtex.sources.inspection.obj_files import check_obj
from flowtex.sources.inspection.ply_files import check_ply
from flowtex.sources.inspection.stl_files import check_stl
from flowtex.sources.inspection.tecplot_files import check_tecplot, is_tecplot_text
from flowtex.sources.inspection.vtk_files import Data
from flowtex.sources.inspection.vtk_legacy import check_vtk_legacy
from flowtex.sources.reader_errors import check_count

#: Suffixes of NetCDF, and its first bytes in the classic forms.
NETCDF = (".nc", ".nc4", ".nc3", ".cdf", ".netcdf")
MAGICS = (b"CDF\x01", b"CDF\x02", b"CDF\x05")
#: Bytes of a value by the number of its type.
SIZES = {1: 1, 2: 1, 3: 2, 4: 4, 5: 4, 6: 8, 7: 1, 8: 2, 9: 4, 10: 8, 11: 8}
#: Most variables of a dataset; the time that xarray needs grows with their square.
MOST_VARIABLES = 2_000
#: Number of records that the writer did not know.
STREAMING = (0xFFFFFFFF, 0xFFFFFFFFFFFFFFFF)
#: Bytes that identify most files.
HEAD_BYTES = 256
GRIB_SUFFIXES = (".grib", ".grb")
#: Most files of a series or of several blocks that are inspected.
MOST_MEMBERS = 100_000
#: Suffixes of files that describe a grid whose pieces lie in other files.
PARALLEL = (".pvti", ".pvtp", ".pvtr", ".pvts", ".pvtu")
#: Documents of a group, and of all arrays.
DOCUMENTS = ("zarr.json", ".zgroup", ".zmetadata")
#: First bytes of files that Git LFS has not fetched.
LFS_MAGIC = b"version https://git-lfs"
GRIB_MAGIC = b"GRIB"
GRIB_END = b"7777"  #: Last bytes of a message.
#: Sections that may follow one of edition 2; after a last 7 a message repeats some, or ends.
NEXT_SECTIONS = {"1": "23", "2": "3", "3": "4", "4": "5", "5": "6", "6": "7", "7": "234"}
#: Least bytes of a section.
SECTION_BYTES = {"1": 21, "2": 5, "3": 14, "4": 9, "5": 11, "6": 6, "7": 5}
#: Least value of a GRIB 1 length that counts units of several bytes.
LONG_MESSAGE = 0x800000
#: Bytes of such a unit.
LONG_UNIT = 120
#: Flag of GRIB 1 that a section has the grid.
HAS_GRID = 0x80
#: Flag of GRIB 1 that a section marks missing values.
HAS_BITMAP = 0x40
#: Flags of GRIB 1 for values that are not simply packed.
NOT_SIMPLE = 0xD0
#: Number of columns or rows in the header of a reduced grid.
MISSING = 0xFFFF
#: Numbers of latitude-longitude and Gaussian grids, by the edition.
LATLON = {1: (0, 4, 10, 14), 2: (0, 1, 2, 3, 40, 41, 42, 43)}
#: Basic angles that stand for degrees, in GRIB 2.
DEGREES = (0, 0xFFFFFFFF)
#: Greatest latitude in degrees.
POLE = 90.0
#: Most bits of padding behind the packed values.
PADDING = 16


def inspect_file(path: Path, *, whole: bool = True) -> None:
    """Check a file before a reader opens it.

    Members of a series and blocks are inspected as well, each once for each time of change, and
    folders of Zarr.

    Parameters
    ----------
    path
        The file.
    whole
        Whether arrays are read as a whole, as readers of meshes do.

    Raises
    ------
    FieldError
        When the file is incomplete, needs too much memory, or links to other files.
    """
    if path.is_dir() and any((path / name).is_file() for name in DOCUMENTS):
        check_zarr(path)
    case = case_of(path)
    if case is not None:
        check_foam(case)
    waiting = [(path, False)]
    seen = {realpath(path)}
    while waiting:
        file, is_piece = waiting.pop()
        if not file.is_file():
            continue  # the reader that needs it raises the error
        state = file.stat()
        try:
            members = _members(file, state.st_mtime_ns, state.st_size, whole, is_piece)
        except FieldError as error:
            if file == path:
                raise
            raise FieldError(f"{file}: {error}") from error
        for member in members:
            if len(seen) < MOST_MEMBERS and realpath(member) not in seen:
                seen.add(realpath(member))
                waiting.append((member, file.suffix.lower() in PARALLEL))


@lru_cache(maxsize=1024)
def _members(
    path: Path,
    _changed: int,
    size: int,
    whole: bool,  # noqa: FBT001
    is_piece: bool,  # noqa: FBT001
) -> tuple[Path, ...]:
    if not size:  # it cannot be mapped
        return _inspect(path, b"", whole=whole, is_piece=is_piece)
    with path.open("rb") as stream, mmap(stream.fileno(), 0, access=ACCESS_READ) as data:
        return _inspect(path, data, whole=whole, is_piece=is_piece)


def _inspect(path: Path, data: Data, *, whole: bool, is_piece: bool) -> tuple[Path, ...]:
    import h5py

    # HDF5 may begin after a block of the user.
    head = data[:HEAD_BYTES]
    is_hdf5 = h5py.is_hdf5(path)
    suffix = path.suffix.lower()
    if is_hdf5:
        check_hdf5(path, whole=whole)
    if head.startswith(MAGICS):
        check_netcdf(data, whole=whole)
    elif suffix in NETCDF and not is_hdf5:
        raise FieldError(f"this is not a NetCDF file: {_other_content(head)}")
    if head.startswith(GRIB_MAGIC) or suffix.startswith(GRIB_SUFFIXES):
        check_grib(data)
    if suffix == ".vtk":
        check_vtk_legacy(data)
    if is_tecplot_text(path):
        check_tecplot(data)
    if suffix == ".ply":
        check_ply(data)
    if suffix == ".obj":
        check_obj(data)
    if suffix == ".stl":
        check_stl(data)
    if suffix in vtk_files.SUFFIXES or vtk_files.is_xml(head):
        return tuple(vtk_files.check_vtk_xml(path, data, is_piece=is_piece))
    return ()


def _other_content(head: bytes) -> str:
    """Return what a file is that begins like no NetCDF, and a remedy."""
    if not head:
        return "it is empty; write or copy it again"
    if head.startswith(LFS_MAGIC):
        return "it is a pointer of Git LFS; get its content by git lfs pull"
    if head.lstrip().startswith(b"<"):
        return (
            "it is HTML or XML, which servers send with an error or in place of a login; open it "
            "as text to read it, and download the data again"
        )
    return (
        f"it begins with {head[:8]!r}; expected 'CDF', or HDF5. If it has another format, give it "
        "the ending of that, such as .grib or .csv; otherwise write or copy it again"
    )


def check_zarr(folder: Path) -> None:
    """Raise a FieldError for a codec that is not listed, or an array that needs too much memory."""
    import_extra("zarr", "xarray")
    from flowtex._util.zarr_stores import check_arrays, checked_folder

    check_arrays(checked_folder(folder))


def check_grib(data: Data) -> None:
    """Raise a FieldError for a cut last message, or a grid that does not fit into memory."""
    at = data.find(GRIB_MAGIC)
    number = 0
    while at >= 0:  # between two messages any bytes may lie
        number += 1
        label = f"message {number}"
        head = data[at : at + 16]
        check_count(len(head), 16, label)
        length = int.from_bytes(head[8:16] if head[7] == 2 else head[4:7], "big")
        if head[7] == 1 and length >= LONG_MESSAGE:
            # The exact length follows only from the sections.
            length = (length - LONG_MESSAGE) * LONG_UNIT - LONG_UNIT
        check_count(len(data) - at, length, label)
        points = _points(data, at, head[7], at + length, label)
        check_memory(8 * points, f"the grid of {label}")
        if head[7] == 2:
            _check_sections(data, at + 16, at + length, label)
        at = data.find(GRIB_MAGIC, at + max(length, 4))


def _check_sections(data: Data, place: int, end: int, label: str) -> None:
    """Raise a FieldError unless the sections of a message are whole and follow one another.

    ecCodes ends the process, or reads for ever, where they do not.
    """
    allowed = "1"
    while place + 5 <= end and data[place : place + 4] != GRIB_END:
        length = int.from_bytes(data[place : place + 4], "big")
        section = str(data[place + 4])
        if section not in allowed:
            raise FieldError(
                f"{label} has section {section} where {' or '.join(allowed)} was expected; the "
                "file is corrupt, write or copy it again"
            )
        if not SECTION_BYTES[section] <= length <= end - place:
            break
        allowed = NEXT_SECTIONS[section]
        place += length
    is_complete = allowed == NEXT_SECTIONS["7"]
    if place + 4 != end or data[place:end] != GRIB_END or not is_complete:
        raise FieldError(f"the sections of {label} do not match its length; the file is corrupt")


def _check_latitude(latitude: float, label: str) -> None:
    """Raise a FieldError for a latitude without its sign that is beyond a pole."""
    if latitude > POLE:
        raise FieldError(
            f"{label} has the latitude {latitude:g}; expected -90 to 90: it is damaged"
        )


def _points_of_edition_1(
    at: int, number: Callable[[int, int], int], check_latitudes: Callable[..., None], label: str
) -> int:
    """Return the number of points of a message of the first edition, as :func:`_points` does."""
    flags = number(at + 15, 1)
    grid = at + 8 + number(at + 8, 3)
    if not flags & HAS_GRID:
        return 0
    values = grid + number(grid, 3)
    columns = number(grid + 6, 2)
    rows = number(grid + 8, 2)
    if number(grid + 5, 1) in LATLON[1]:
        check_latitudes(1_000, 3, grid + 10, grid + 17)
    is_simple = not (flags & HAS_BITMAP or number(values + 3, 1) & NOT_SIMPLE)
    if is_simple and MISSING not in (columns, rows):
        _check_packed(number(values, 3) - 11, columns * rows, number(values + 10, 1), label)
    return columns * rows


def _points(data: Data, at: int, edition: int, end: int, label: str) -> int:
    """Return the number of points of the largest grid of a message.

    Raises a FieldError for latitudes beyond a pole, which may crash ecCodes, and for packed values
    whose size does not match the declared bits, because ecCodes would decode other values.
    """

    def number(begin: int, count: int) -> int:
        return int.from_bytes(data[begin : begin + count], "big")

    def check_latitudes(unit: int, count: int, *places: int) -> None:
        for begin in places:
            _check_latitude((number(begin, count) & ~(1 << 8 * count - 1)) / unit, label)

    if edition == 1:
        return _points_of_edition_1(at, number, check_latitudes, label)
    place = at + 16
    most = 0
    count = 0
    bits = 0
    while place + 9 <= end:
        length = number(place, 4)
        if not 5 <= length <= end - place:
            break
        match data[place + 4]:
            case 3:
                most = max(most, number(place + 6, 4))
                if number(place + 12, 2) in LATLON[2] and number(place + 38, 4) in DEGREES:
                    check_latitudes(1_000_000, 4, place + 46, place + 55)
            case 5:
                # Of simple packing; the length of others depends on the values.
                count = number(place + 5, 4) if number(place + 9, 2) == 0 else 0
                bits = number(place + 19, 1)
            case 7 if count:
                _check_packed(length - 5, count, bits, label)
        place += length
    return most


def _check_packed(nbytes: int, count: int, bits: int, label: str) -> None:
    """Raise a FieldError if the size of a section does not match the bits of each value."""
    check_count(nbytes, -(-count * bits // 8), f"the packing of {label}")
    if 8 * nbytes >= count * (bits + 1) + PADDING:
        raise FieldError(
            f"{label} declares {bits} bits for each of {count:,} values, but its {nbytes:,} bytes "
            "have room for more; the file is corrupt, write or copy it again"
        )


def check_netcdf(data: Data, *, whole: bool) -> None:
    """Raise a FieldError for a classic file that is shorter than declared, or too large.

    netCDF's library reads zeros, or partial data, from a shorter file.
    """
    header = _Header(data)
    check_count(len(data), header.length(len(data)), "the header")
    for name, shape, nbytes in header.arrays:
        if whole or len(shape) < 2:
            check_memory(nbytes, f"the variable {name}")


def check_variables(count: int) -> None:
    """Check the number of variables, or of other entries of a header.

    Raises
    ------
    FieldError
        When there are more than ``MOST_VARIABLES``.
    """
    if count > MOST_VARIABLES:
        raise FieldError(
            f"the file has {count:,} variables, dimensions or attributes; expected at most "
            f"{MOST_VARIABLES:,}. Write those that are drawn to another file"
        )


class _Header:
    """Header of a NetCDF file in one of the classic formats."""

    def __init__(self, data: Data) -> None:
        self._data = data
        self._at = 0
        version = self._read(4)[3]
        self._wide = version == 5
        if version == 1:
            self._offset = ">I"
        else:
            self._offset = ">Q"
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
        """Return the length that the header declares, in bytes; ``size`` is the actual length.

        A file that is shorter has been cut off.
        """
        each = [nbytes for _, nbytes, has_records in self._places if has_records]
        # Values are padded to four bytes, except for those of a single variable with records.
        if len(each) == 1:
            record = each[0]
        else:
            record = sum(-(-nbytes // 4) * 4 for nbytes in each)
        records = self._records
        if records in STREAMING:
            start = min(
                (begin for begin, _, has_records in self._places if has_records), default=size
            )
            if record:
                records = max(size - start, 0) // record
            else:
                records = 0
            if records * record + start < size:
                # The last record is incomplete.
                records += 1
        ends = [
            begin + nbytes + (record * (records - 1) if has_records else 0)
            for begin, nbytes, has_records in self._places
            if nbytes and (records or not has_records)
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
        if repeated and len(shape) == 1:
            times = self._records
        else:
            times = 1
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


def check_hdf5(path: Path, *, whole: bool) -> None:
    """Check an HDF5 file before a reader opens it.

    External storage, external links and virtual datasets would make the reader read any file that
    the author of this one names.

    Parameters
    ----------
    path
        The file.
    whole
        Whether datasets are read as a whole.

    Raises
    ------
    FieldError
        When the file links to others, is cut or damaged, or does not fit into memory.
    """
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
                    if external:
                        target = file.id.links.get_val(path_in)[0]
                    else:
                        target = b"unknown"
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
    size = item.get_type().get_size()
    shape = item.shape or ()
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
