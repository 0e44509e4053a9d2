"""Files of ocean and weather models as datasets: NetCDF, Zarr, GRIB, and winds in JSON."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Sequence
from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flowtex._util.extras import import_extra
from flowtex.errors import FieldError
from flowtex.field.datasets.pairs import find_pairs
from flowtex.field.datasets.series import are_steps, joined, of_tree
from flowtex.field.datasets.wind_json import read_winds
from flowtex.field.io.inspection.files import inspect_file
from flowtex.field.io.inspection.netcdf import SUFFIXES as NETCDF

if TYPE_CHECKING:
    import xarray as xr

GRIB = (".grib", ".grb", ".grib2", ".grb2")
ZARR, JSON = (".zarr",), (".json",)
#: Suffixes of files that are opened by xarray.
SUFFIXES = (*NETCDF, *GRIB, *ZARR, *JSON)
#: The newest Python for which the wheels of eccodes have its library.
ECCODES_UNTIL = (3, 13)


def is_dataset_file(path: Path) -> bool:
    """Whether a path is a file, or a Zarr store, that is opened here."""
    if path.is_dir():
        return any((path / name).is_file() for name in ("zarr.json", ".zgroup", ".zmetadata"))
    return path.suffix.lower() in SUFFIXES


def file_and_group(path: Path) -> tuple[Path, str]:
    """Return the file of a path such as ``model.nc/ocean``, and the group in it."""
    files = (one for one in path.parents if one.suffix.lower() in NETCDF and one.is_file())
    file = next(files, path)
    return file, "" if file == path else path.relative_to(file).as_posix()


def dataset_paths(path: Any) -> list[Path]:
    """Return the paths of data of the Earth, of one or of several; nothing for anything else.

    A path may go on to a group inside a file: ``model.nc/ocean``.
    """
    several = path if isinstance(path, (list, tuple)) else [path]
    if not all(isinstance(one, (str, os.PathLike)) for one in several):
        msg = f"path is {path!r}; expected the path of a file, or a list of paths"
        raise FieldError(msg)
    paths = [Path(one).expanduser() for one in several]
    files = [file_and_group(one)[0] for one in paths]
    known = paths and all(map(is_dataset_file, files)) and all(one.exists() for one in files)
    return paths if known else []


def common_name(paths: Sequence[Path]) -> str:
    """Return a word for captions: what the names of the files begin with."""
    stems = [path.stem for path in paths]
    alike = takewhile(lambda letters: len(set(letters)) == 1, zip(*stems, strict=False))
    shared = "".join(letters[0] for letters in alike)
    return shared.rstrip("_-. 0123456789") if len(stems) > 1 and len(shared) > 2 else stems[0]


def belong_together(paths: Sequence[Path]) -> bool:
    """Whether several files are to be read together: steps of a series, or parts without a pair."""
    several = [open_files(path) for path in paths]
    series = all(len(one) == 1 for one in several) and are_steps([ds for (ds, *_) in several])
    return series or not all(find_pairs(one) for one in several)


def open_datasets(paths: Sequence[Path]) -> list[xr.Dataset]:
    """Open files that belong together: parts of one model's output, or steps of a series."""
    several = [open_files(path) for path in paths]
    if len(several) == 1:
        return several[0]
    parts = [ds for one in several for ds in one]
    return [joined(parts)] if len(parts) == len(several) and are_steps(parts) else parts


def open_files(path: Path) -> list[xr.Dataset]:
    """Open one file; GRIB gives a dataset for each group of messages that share their axes."""
    xarray = import_extra("xarray", "xarray")
    # Its library has to be loaded before those of other readers, which bring their own PROJ.
    import_extra("pyproj", "xarray")
    path, group = file_and_group(path)
    suffix = path.suffix.lower()
    inspect_file(path, whole=False)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if suffix in JSON:
            return [read_winds(path)]
        if suffix in GRIB:
            return list(import_cfgrib().open_datasets(str(path), backend_kwargs={"indexpath": ""}))
        options: dict[str, Any] = {"decode_timedelta": False}
        if path.is_dir():
            import_extra("zarr", "xarray")
            options["engine"] = "zarr"
        try:
            ds = xarray.open_dataset(path, **options)
        except ValueError as error:
            if "decode time" not in str(error):
                raise
            # Of times that no calendar has, the numbers are left.
            options["decode_times"] = False
            ds = xarray.open_dataset(path, **options)
        if not group and any(array.ndim for array in ds.data_vars.values()):
            return [ds]
        tree = xarray.open_datatree(path, **options)
        if group and f"/{group}" not in tree.groups:
            groups = ", ".join(tree.groups[1:]) or "none: there are no groups"
            msg = f"the group {group!r} does not exist; expected {groups}"
            raise FieldError(msg)
        return [of_tree(tree[group] if group else tree, path)]


def import_cfgrib() -> Any:
    """Import what reads GRIB; the error for what is missing has the remedy."""
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
