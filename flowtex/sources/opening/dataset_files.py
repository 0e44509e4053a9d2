"""Files of ocean and weather models as datasets: NetCDF, Zarr, GRIB, and winds in JSON."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Sequence
from itertools import takewhile
from pathlib import Path
from typing import Any

from flowtex._util.arguments import brief
from flowtex._util.extras import import_extra
from flowtex.errors import FieldError
from flowtex.sources.datasets.select import find_pairs
from flowtex.sources.inspection.inspect_file import inspect_file
from flowtex.sources.inspection.netcdf import SUFFIXES as NETCDF
from flowtex.sources.opening.series import Opened, are_steps, of_tree
from flowtex.sources.opening.tables import read_csv, read_vec, read_winds

GRIB = (".grib", ".grb", ".grib2", ".grb2")
ZARR, JSON = (".zarr",), (".json", ".geojson")
TABLES = {".csv": read_csv, ".vec": read_vec}
#: Suffixes of files that are opened by xarray.
SUFFIXES = (*NETCDF, *GRIB, *ZARR, *JSON, *TABLES)
#: The newest Python for which the wheels of eccodes have its library.
ECCODES_UNTIL = (3, 13)


def is_dataset_file(path: Path) -> bool:
    """Return whether a path is a file, or a Zarr store, that xarray opens."""
    if path.is_dir():
        return any((path / name).is_file() for name in ("zarr.json", ".zgroup", ".zmetadata"))
    return path.suffix.lower() in SUFFIXES


def file_and_group(path: Path) -> tuple[Path, str]:
    """Return the file of a path such as ``model.nc/ocean``, and the group in it."""
    files = (p for p in path.parents if p.suffix.lower() in NETCDF and p.is_file())
    file = next(files, path)
    return file, "" if file == path else path.relative_to(file).as_posix()


def dataset_paths(path: Any) -> list[Path]:
    """Return the paths of data of the Earth, or of groups as ``model.nc/ocean``; else none."""
    items = path if isinstance(path, (list, tuple)) else [path]
    if not all(isinstance(item, (str, os.PathLike)) for item in items):
        msg = f"path is {brief(path)}; expected the path of a file, or a list of paths"
        raise FieldError(msg)
    paths = [Path(item).expanduser() for item in items]
    files = [file_and_group(p)[0] for p in paths]
    all_exist = paths and all(map(is_dataset_file, files)) and all(file.exists() for file in files)
    return paths if all_exist else []


def common_name(paths: Sequence[Path]) -> str:
    """Return a word for captions: the common beginning of the names of files."""
    stems = [path.stem for path in paths]
    common = takewhile(lambda letters: len(set(letters)) == 1, zip(*stems, strict=False))
    shared = "".join(letters[0] for letters in common)
    return shared.rstrip("_-. 0123456789") if len(stems) > 1 and len(shared) > 2 else stems[0]


def belong_together(paths: Sequence[Path]) -> bool:
    """Return whether files are read together: steps of a series, or parts without a pair."""
    opened = [open_files(path) for path in paths]
    series = all(len(parts) == 1 for parts in opened) and are_steps([ds for (ds, *_) in opened])
    return series or not all(find_pairs(parts) for parts in opened)


def open_datasets(paths: Sequence[Path]) -> Opened:
    """Open files that belong together: parts of one model's output, or steps of a series."""
    opened = [open_files(path) for path in paths]
    parts = (ds for datasets in opened for ds in datasets)
    return Opened(parts, [close for datasets in opened for close in datasets.closers])


def open_files(path: Path) -> Opened:
    """Open one file; GRIB has a dataset for each group of messages with common axes."""
    xarray = import_extra("xarray", "xarray")
    # Its library must be loaded before those of other readers, which contain another PROJ.
    import_extra("pyproj", "xarray")
    path, group = file_and_group(path)
    suffix = path.suffix.lower()
    inspect_file(path, whole=False)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if suffix in JSON:
            return Opened([read_winds(path)])
        if suffix in TABLES:
            return Opened([TABLES[suffix](path)])
        if suffix in GRIB:
            parts = import_cfgrib().open_datasets(str(path), backend_kwargs={"indexpath": ""})
            return Opened.of(parts, parts)
        options: dict[str, Any] = {"decode_timedelta": False}
        if path.is_dir():
            import_extra("zarr", "xarray")
            options["engine"] = "zarr"
        try:
            ds = xarray.open_dataset(path, **options)
        except ValueError as error:
            if "decode time" not in str(error):
                raise
            # Times that no calendar has stay numbers.
            options["decode_times"] = False
            ds = xarray.open_dataset(path, **options)
        if not group and any(array.ndim for array in ds.data_vars.values()):
            return Opened.of([ds], [ds])
        tree = xarray.open_datatree(path, **options)
        if group and f"/{group}" not in tree.groups:
            groups = ", ".join(tree.groups[1:]) or "none: there are no groups"
            msg = f"the group {group!r} does not exist; expected {groups}"
            raise FieldError(msg)
        return Opened.of([of_tree(tree[group] if group else tree, path)], [ds, *tree.subtree])


def import_cfgrib() -> Any:
    """Import the reader of GRIB; the error for a missing package has the remedy."""
    try:
        return import_extra("cfgrib", "grib")
    except (ModuleNotFoundError, RuntimeError) as error:
        absent = isinstance(error, ModuleNotFoundError)
        if absent and sys.version_info[:2] <= ECCODES_UNTIL:
            raise
        if not absent and "ecCodes" not in str(error):
            raise
        until = ".".join(map(str, ECCODES_UNTIL))
        msg = (
            "reading GRIB needs the library ecCodes, which is missing: its wheels support Python "
            f"up to {until}. Use such a Python, or cfgrib from conda-forge, which includes the "
            "library"
        )
        raise ModuleNotFoundError(msg, name="cfgrib") from error
