"""Files of ocean and weather models as datasets: NetCDF, Zarr, GRIB, and winds in JSON."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Sequence
from importlib.util import find_spec
from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flowtex._util.extras import import_extra
from flowtex.errors import FieldError
from flowtex.field.datasets.pairs import find_pairs
from flowtex.field.datasets.wind_json import read_winds
from flowtex.field.io.inspection.files import inspect_file

if TYPE_CHECKING:
    import xarray as xr

NETCDF = (".nc", ".nc4", ".nc3", ".cdf", ".netcdf")
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


def dataset_paths(path: Any) -> list[Path]:
    """Return the paths of data of the Earth, of one or of several; nothing for anything else."""
    several = path if isinstance(path, (list, tuple)) else [path]
    if not all(isinstance(one, (str, os.PathLike)) for one in several):
        msg = f"path is {path!r}; expected the path of a file, or a list of paths"
        raise FieldError(msg)
    paths = [Path(one).expanduser() for one in several]
    known = paths and all(map(is_dataset_file, paths)) and all(one.exists() for one in paths)
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
    series = all(len(one) == 1 and _alike(one[0], several[0][0]) for one in several)
    return series or not all(find_pairs(one) for one in several)


def open_datasets(paths: Sequence[Path]) -> list[xr.Dataset]:
    """Open files that belong together: parts of one model's output, or steps of a series."""
    several = [open_files(path) for path in paths]
    if len(several) == 1:
        return several[0]
    if all(len(one) == 1 and _alike(one[0], several[0][0]) for one in several):
        return [_joined([one[0] for one in several], paths)]
    return [ds for one in several for ds in one]


def open_files(path: Path) -> list[xr.Dataset]:
    """Open one file; GRIB gives a dataset for each group of messages that share their axes."""
    xarray = import_extra("xarray", "xarray")
    # Its library has to be loaded before those of other readers, which bring their own PROJ.
    import_extra("pyproj", "xarray")
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
            return [xarray.open_dataset(path, **options)]
        except ValueError as error:
            if "decode time" not in str(error):
                raise
            # Of times that no calendar has, the numbers are left.
            return [xarray.open_dataset(path, decode_times=False, **options)]


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


def _alike(one: xr.Dataset, other: xr.Dataset) -> bool:
    """Whether two datasets are steps of one series: the same variables, which hold a velocity."""
    return set(one.data_vars) == set(other.data_vars) and bool(find_pairs([one]))


def _joined(datasets: list[Any], paths: Sequence[Path]) -> Any:
    """Join steps of a series in the order of their times."""
    xarray = import_extra("xarray", "xarray")
    import_extra("cf_xarray", "xarray")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        axes = [ds.cf.guess_coord_axis().cf.axes.get("T", []) for ds in datasets]
    name = axes[0][0] if axes[0] and axes[0] == axes[-1] else "time"
    dates = _dates_in_names(paths)
    if dates is not None and name in datasets[0] and datasets[0][name].dtype.kind in "fiu":
        # The numbers of the times have no unit.
        datasets = [
            ds.assign_coords({name: [d]}) if name in ds.dims else ds
            for ds, d in zip(datasets, dates, strict=True)
        ]
    if find_spec("dask") is not None:
        # Else all that is joined is read at once.
        datasets = [ds.chunk() for ds in datasets]
    try:
        return xarray.concat(
            datasets,
            dim=name,
            data_vars="minimal",
            coords="minimal",
            compat="override",
            join="exact",
        ).sortby(name)
    except (ValueError, KeyError) as error:
        msg = (
            f"the files are not steps of one series: {error}. Give only files that belong together"
        )
        raise FieldError(msg) from error


def _dates_in_names(paths: Sequence[Path]) -> list[Any] | None:
    """Return the dates in the names of files, as in ``winds_20020101.nc``, all different."""
    import re

    import numpy as np

    found = [re.search(r"(?<!\d)(\d{4})-?(\d{2})-?(\d{2})(?!\d)", path.stem) for path in paths]
    try:
        dates = [np.datetime64("-".join(match.groups())) for match in found if match]
    except ValueError:
        return None
    return dates if len(set(dates)) == len(paths) else None
