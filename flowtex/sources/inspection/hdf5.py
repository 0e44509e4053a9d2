"""HDF5, and NetCDF-4, CGNS, Exodus and VTKHDF, which are HDF5: no other files are read.

Datasets may lie in other files (external storage and virtual datasets), and so may groups (external
links). Otherwise the author of a file could make the reader read any other file.
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any, NoReturn

from flowtex.errors import FieldError
from flowtex.sources.inspection.limits import check_count, check_memory
from flowtex.sources.inspection.others import check_attributes

MAGIC = b"\x89HDF\r\n\x1a\n"


def check_hdf5(path: Path, *, whole: bool) -> None:
    """Raise a FieldError for a file that links to others, is cut, or does not fit into memory."""
    import h5py

    try:
        with h5py.File(path, "r", locking=False) as file:
            check_attributes(file.attrs)
            links: list[tuple[bytes, int]] = []
            # This follows no link out of the file.
            file.id.links.visit(lambda name, link: links.append((name, link.type)), info=True)
            for name, kind in links:
                if kind not in (h5py.h5l.TYPE_HARD, h5py.h5l.TYPE_SOFT):
                    external = kind == h5py.h5l.TYPE_EXTERNAL
                    target = file.id.links.get_val(name)[0] if external else b"unknown"
                    target = target.decode(errors="replace")
                    _refuse(f"{name.decode(errors='replace')} is an external link", target)
            for name, kind in links:
                if kind == h5py.h5l.TYPE_HARD:
                    item = h5py.h5o.open(file.id, name)
                    _check_object(h5py, item, name.decode(errors="replace"), whole=whole)
    except (OSError, RuntimeError, KeyError, ValueError) as error:
        if isinstance(error, FieldError):
            raise
        ends = re.search(r"eof = (\d+).*base_addr = (\d+), stored_eof = (\d+)", str(error))
        if ends:
            size, base, declared = map(int, ends.groups())
            check_count(size, base + declared, "the header")
        msg = f"the file is damaged: HDF5 reports: {error}; write or copy it again"
        raise FieldError(msg) from error


def _check_object(h5py: Any, item: Any, name: str, *, whole: bool) -> None:
    if not isinstance(item, h5py.h5d.DatasetID):
        return
    storage = item.get_create_plist()
    if storage.get_external_count():
        target = storage.get_external(0)[0].decode(errors="replace")
        _refuse(f"{name} has external storage", target)
    layout = storage.get_layout()
    if layout == h5py.h5d.VIRTUAL:
        targets = (storage.get_virtual_filename(n) for n in range(storage.get_virtual_count()))
        for target in targets:
            if target != ".":
                _refuse(f"{name} is a virtual dataset", target)
    size, shape = item.get_type().get_size(), item.shape or ()
    if layout == h5py.h5d.CHUNKED:
        check_memory(size * math.prod(storage.get_chunk()), f"one chunk of {name}")
    if whole and shape and item.get_space().get_simple_extent_dims(1)[0] == h5py.h5s.UNLIMITED:
        shape = shape[1:]
    if whole or len(shape) < 2:
        check_memory(size * math.prod(shape), f"the dataset {name}")


def _refuse(link: str, target: str) -> NoReturn:
    msg = (
        f"{link} in the file {target!r}, but only data in the file itself are read; copy "
        "everything into one file, for example with ds.to_netcdf"
    )
    raise FieldError(msg)
