"""Inspection of a file before any reader opens it, by its content and its name."""

from __future__ import annotations

import math
import warnings
from functools import lru_cache
from mmap import ACCESS_READ, mmap
from os.path import realpath
from pathlib import Path

from flowtex.errors import FieldError, import_extra
from flowtex.sources.inspection import netcdf, vtk_files
from flowtex.sources.inspection.vtk_files import Data
from flowtex.sources.reader_errors import check_count, check_memory

#: Bytes that identify most files.
HEAD_BYTES = 256
GRIB_SUFFIXES = (".grib", ".grb")
#: Most files of a series or of several blocks that are inspected.
MOST_MEMBERS = 100_000
#: Documents of a group, and of all arrays.
DOCUMENTS = ("zarr.json", ".zgroup", ".zmetadata")
#: Most bytes of a number.
NUMBER_BYTES = 8
GRIB_MAGIC = b"GRIB"
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
    """Raise a FieldError for a file that is incomplete, needs too much memory, or links to others.

    Members of a series and blocks are inspected as well, each once for each time of change, and
    folders of Zarr. ``whole`` is whether arrays are read as a whole, as those of meshes.
    """
    if path.is_dir() and any((path / name).is_file() for name in DOCUMENTS):
        check_zarr(path)
    waiting, seen = [path], {realpath(path)}
    while waiting:
        file = waiting.pop()
        if not file.is_file():
            continue  # the reader that needs it raises the error
        state = file.stat()
        try:
            members = _members(file, state.st_mtime_ns, state.st_size, whole)
        except FieldError as error:
            if file == path:
                raise
            raise FieldError(f"{file}: {error}") from error
        for member in members:
            if len(seen) < MOST_MEMBERS and realpath(member) not in seen:
                seen.add(realpath(member))
                waiting.append(member)


@lru_cache(maxsize=1024)
def _members(path: Path, _changed: int, size: int, whole: bool) -> tuple[Path, ...]:  # noqa: FBT001
    if not size:  # it cannot be mapped
        return _inspect(path, b"", whole=whole)
    with path.open("rb") as stream, mmap(stream.fileno(), 0, access=ACCESS_READ) as data:
        return _inspect(path, data, whole=whole)


def _inspect(path: Path, data: Data, *, whole: bool) -> tuple[Path, ...]:
    head, is_hdf5, suffix = data[:HEAD_BYTES], netcdf.is_hdf5(path), path.suffix.lower()
    if is_hdf5:
        netcdf.check_hdf5(path, whole=whole)
    if head.startswith(netcdf.MAGICS):
        netcdf.check_netcdf(data, whole=whole)
    elif suffix in netcdf.SUFFIXES and not is_hdf5:
        beginning = f"it begins with {head[:8]!r}" if head else "it is empty"
        raise FieldError(f"this is not a NetCDF file: {beginning}; expected 'CDF', or HDF5")
    if head.startswith(GRIB_MAGIC) or suffix.startswith(GRIB_SUFFIXES):
        check_grib(data)
    if suffix == ".vtk":
        vtk_files.check_vtk_legacy(data)
    is_xml = suffix in vtk_files.SUFFIXES or vtk_files.is_xml(head)
    return tuple(vtk_files.check_vtk_xml(path, data)) if is_xml else ()


def check_zarr(folder: Path) -> None:
    """Raise a FieldError for a line of coordinates, or a chunk, that does not fit into memory."""
    zarr = import_extra("zarr", "xarray")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of files beside the arrays
        members = zarr.open_group(folder, mode="r").members(max_depth=None)
    for name, array in members:
        if isinstance(array, zarr.Array):
            sizes = [math.prod(array.chunks)] + [math.prod(array.shape)] * (array.ndim < 2)
            check_memory(max(sizes) * NUMBER_BYTES, f"the variable {name}")


def check_grib(data: Data) -> None:
    """Raise a FieldError for a cut last message, or a grid that does not fit into memory."""
    at = data.find(GRIB_MAGIC)
    number = 0
    while at >= 0:  # between two messages any bytes may lie
        number += 1
        label, head = f"message {number}", data[at : at + 16]
        check_count(len(head), 16, label)
        length = int.from_bytes(head[8:16] if head[7] == 2 else head[4:7], "big")
        if head[7] == 1 and length >= LONG_MESSAGE:
            # The exact length follows only from the sections.
            length = (length - LONG_MESSAGE) * LONG_UNIT - LONG_UNIT
        check_count(len(data) - at, length, label)
        points = _points(data, at, head[7], at + length, label)
        check_memory(8 * points, f"the grid of {label}")
        at = data.find(GRIB_MAGIC, at + max(length, 4))


def _points(data: Data, at: int, edition: int, end: int, label: str) -> int:
    """Return the number of points of the largest grid of a message.

    Raises a FieldError for latitudes beyond a pole, which may crash ecCodes, and for packed values
    whose size does not match the declared bits, because ecCodes would decode other values.
    """

    def number(begin: int, count: int) -> int:
        return int.from_bytes(data[begin : begin + count], "big")

    def check_latitudes(unit: int, count: int, *places: int) -> None:
        for word in (number(begin, count) for begin in places):
            latitude = (word & ~(1 << 8 * count - 1)) / unit
            if latitude > POLE:
                raise FieldError(
                    f"{label} has the latitude {latitude:g}; expected -90 to 90: it is damaged"
                )

    place, most, count, bits = at + 16, 0, 0, 0
    if edition == 1:
        flags, grid = number(at + 15, 1), at + 8 + number(at + 8, 3)
        if not flags & HAS_GRID:
            return 0
        values = grid + number(grid, 3)
        most = number(grid + 6, 2) * number(grid + 8, 2)
        if number(grid + 5, 1) in LATLON[1]:
            check_latitudes(1_000, 3, grid + 10, grid + 17)
        simple = not (flags & HAS_BITMAP or number(values + 3, 1) & NOT_SIMPLE)
        if simple and MISSING not in (number(grid + 6, 2), number(grid + 8, 2)):
            _check_packed(number(values, 3) - 11, most, number(values + 10, 1), label)
        return most
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
    # ecCodes reads for ever where sections do not lead to the end.
    if place + 4 != end or data[place:end] != b"7777":
        raise FieldError(f"the sections of {label} do not match its length; the file is corrupt")
    return most


def _check_packed(nbytes: int, count: int, bits: int, label: str) -> None:
    """Raise a FieldError if the size of a section does not match the bits of each value."""
    check_count(nbytes, -(-count * bits // 8), f"the packing of {label}")
    if 8 * nbytes >= count * (bits + 1) + PADDING:
        raise FieldError(
            f"{label} declares {bits} bits for each of {count:,} values, but its {nbytes:,} bytes "
            "have room for more; the file is corrupt, write or copy it again"
        )
