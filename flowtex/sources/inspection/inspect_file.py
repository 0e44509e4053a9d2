"""Inspection of a file before any reader opens it, by its content and its name."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import BinaryIO

from flowtex.errors import FieldError
from flowtex.sources.inspection import grib, netcdf, vtk_legacy, vtk_xml
from flowtex.sources.inspection.others import check_other
from flowtex.sources.inspection.zarr_folder import DOCUMENTS, check_zarr

#: Bytes that identify most files.
HEAD_BYTES = 256
GRIB_SUFFIXES = (".grib", ".grb")
#: Most files of a series or of several blocks that are inspected.
MOST_MEMBERS = 100_000


def inspect_file(path: Path, *, whole: bool = True) -> None:
    """Raise a FieldError for a file that is incomplete, needs too much memory, or links to others.

    Members of a series and blocks are inspected as well, each once for each time of change, and
    folders of Zarr. ``whole`` is whether arrays are read as a whole, as those of meshes.
    """
    if path.is_dir() and any((path / name).is_file() for name in DOCUMENTS):
        check_zarr(path)
    waiting, seen = [path], {path.resolve()}
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
            msg = f"{file}: {error}"
            raise FieldError(msg) from error
        for member in members:
            if len(seen) < MOST_MEMBERS and member.resolve() not in seen:
                seen.add(member.resolve())
                waiting.append(member)


@lru_cache(maxsize=1024)
def _members(path: Path, _changed: int, size: int, whole: bool) -> tuple[Path, ...]:  # noqa: FBT001
    """Inspect one file, and return the files that it names."""
    with path.open("rb") as stream:
        head = stream.read(HEAD_BYTES)
        is_hdf5 = _is_hdf5(stream, size)
    suffix = path.suffix.lower()
    check_other(path, head)
    if is_hdf5:
        netcdf.check_hdf5(path, whole=whole)
    if head.startswith(netcdf.MAGICS):
        netcdf.check_netcdf(path, whole=whole)
    elif suffix in netcdf.SUFFIXES and not is_hdf5:
        beginning = f"it begins with {head[:8]!r}" if head else "it is empty"
        msg = f"this is not a NetCDF file: {beginning}; expected 'CDF', or HDF5"
        raise FieldError(msg)
    if head.startswith(grib.MAGIC) or suffix.startswith(GRIB_SUFFIXES):
        grib.check_grib(path)
    if suffix == ".vtk":
        vtk_legacy.check_vtk_legacy(path)
    is_xml = suffix in vtk_xml.SUFFIXES or vtk_xml.is_xml(head)
    return tuple(vtk_xml.check_vtk_xml(path)) if is_xml else ()


def _is_hdf5(stream: BinaryIO, size: int) -> bool:
    """Return whether HDF5 begins somewhere, perhaps after a block of the user."""
    at = 0
    while at < size:
        stream.seek(at)
        if stream.read(len(netcdf.HDF5_MAGIC)) == netcdf.HDF5_MAGIC:
            return True
        at = 2 * at or 512
    return False
