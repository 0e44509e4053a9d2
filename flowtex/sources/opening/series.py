"""Preparation of datasets: units by any name, times as dates, steps of a series, groups."""

from __future__ import annotations

import re
import warnings
from collections.abc import Sequence
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex._util.extras import import_extra
from flowtex.errors import FieldError
from flowtex.sources.datasets.select import find_pairs
from flowtex.sources.models.conventions import with_mesh_axes
from flowtex.sources.opening.components import split_components
from flowtex.sources.opening.tables import as_dataset

if TYPE_CHECKING:
    import xarray as xr

#: Names of dates as text, which some models write beside less exact times, or instead of them.
LETTERS = ("Times", "xtime")
#: A unit of time of ICON: a date, with the share of the day behind its point.
DAYS_AS_NUMBERS = "%Y%m%d"


class Datasets(list["xr.Dataset"]):
    """Datasets whose axes cf_xarray recognises, with times as dates."""


def as_datasets(data: Any) -> Datasets:
    """Return datasets of xarray's with recognised axes, which takes long at first.

    Steps of a series become one dataset, and a tree the dataset of its group with a velocity.
    """
    if isinstance(data, Datasets):
        return data
    xarray = import_extra("xarray", "xarray")
    result = []
    for ds in data if isinstance(data, (list, tuple)) else [data]:
        several = isinstance(data, (list, tuple)) and len(data) > 1
        part = of_tree(ds) if isinstance(ds, xarray.DataTree) else as_dataset(ds, several=several)
        result.append(split_components(_decoded(part)))
    if len(result) > 1 and are_steps(result) and _times_differ(result):
        with suppress(FieldError):  # such as domains of different sizes
            result = [joined(result)]
    return Datasets(with_mesh_axes([_with_axes(ds) for ds in result]))


def of_tree(tree: xr.DataTree, file: Path | None = None) -> xr.Dataset:
    """Return the dataset of the one group of a tree that has a velocity, or that of its root.

    The error for several groups names the path of one in ``file``, if the tree is from one.
    """
    parts = {node.path: node.to_dataset() for node in tree.subtree}
    groups = [path for path, ds in parts.items() if find_pairs([ds])]
    if len(groups) > 1 and groups[0] != tree.path:
        listed = ", ".join(groups)
        example = f"tree[{groups[0]!r}]" if file is None else repr(f"{file}{groups[0]}")
        msg = f"the groups {listed} have a velocity; give one, as in {example}"
        raise FieldError(msg)
    return parts[groups[0] if groups else tree.path]


def _decoded(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset with ``Unit``, ``Units`` and ``unit`` as units, and times as dates."""
    named = {
        name: value
        for name, variable in ds.variables.items()
        for key, value in variable.attrs.items()
        if str(key).lower() in ("unit", "units") and "units" not in variable.attrs
    }
    if named:
        ds = ds.copy()
        for name, unit in named.items():
            ds[name].attrs["units"] = unit
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with suppress(ValueError, OverflowError, TypeError):  # times of no calendar
            ds = import_extra("xarray", "xarray").decode_cf(ds, decode_timedelta=False)
    return _dated(ds)


def _dated(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset with dates along its axis of time, if other variables or units have them."""
    for name in LETTERS:
        if name not in ds.variables or not ds[name].dims or ds[name].dtype.kind not in "SUO":
            continue
        dim = str(ds[name].dims[0])
        texts = [
            (row.decode() if isinstance(row, bytes) else str(row)).strip(" \0")
            for row in (ds[name].values if ds[name].ndim == 1 else map(b"".join, ds[name].values))
        ]
        try:
            dates = np.array([t.replace("_", "T").rstrip("Z") for t in texts], "datetime64[ms]")
        except ValueError:
            continue
        if ds.sizes[dim] == len(dates) and not np.isnat(dates).any():
            return ds.assign_coords({dim: (dim, dates.astype("datetime64[ns]"), {"axis": "T"})})
    for axis in ds.dims:
        line = ds.coords.get(axis)
        if line is not None and DAYS_AS_NUMBERS in str(line.attrs.get("units", "")):
            return ds.assign_coords({axis: (axis, _days(line.values), {"axis": "T"})})
    return ds


def _days(numbers: AnyArray) -> AnyArray:
    whole = np.floor(numbers).astype(int)
    days = np.array([f"{n:08d}" for n in whole])
    dates = [np.datetime64(f"{d[:4]}-{d[4:6]}-{d[6:]}", "s") for d in days]
    seconds = np.round((numbers - whole) * 86400).astype("timedelta64[s]")
    return np.asarray(np.array(dates) + seconds, dtype="datetime64[ns]")


def _with_axes(ds: xr.Dataset) -> xr.Dataset:
    import_extra("cf_xarray", "xarray")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        guessed: xr.Dataset = ds.cf.guess_coord_axis()
        return guessed


def _times_differ(datasets: Sequence[xr.Dataset]) -> bool:
    """Return whether no two of several datasets have a time in common."""
    name = _time_axis(datasets)
    times = [np.atleast_1d(ds[name].values) if name in ds else np.empty(0) for ds in datasets]
    texts = [str(time) for line in times for time in line]
    return all(map(len, times)) and len(set(texts)) == len(texts)


def _time_axis(datasets: Sequence[xr.Dataset]) -> str:
    """Return the name of the axis of time, ``"time"`` where none is recognised."""
    axes = [_with_axes(ds).cf.axes.get("T", []) for ds in (datasets[0], datasets[-1])]
    return str(axes[0][0]) if axes[0] and axes[0] == axes[-1] else "time"


def are_steps(datasets: Sequence[xr.Dataset]) -> bool:
    """Return whether datasets may be steps of one series: with the same variables."""
    same = {frozenset(ds.data_vars) for ds in datasets}
    return len(same) == 1 and bool(find_pairs([datasets[0]]))


def joined(datasets: Sequence[xr.Dataset]) -> xr.Dataset:
    """Join steps of a series in the order of their times."""
    xarray = import_extra("xarray", "xarray")
    datasets = [_decoded(ds) for ds in datasets]
    name = _time_axis(datasets)
    dates = _dates_in_names([Path(str(ds.encoding.get("source", ""))) for ds in datasets])
    if dates is not None and name in datasets[0] and datasets[0][name].dtype.kind in "fiu":
        # The times are numbers without a unit.
        datasets = [
            ds.assign_coords({name: [d]}) if name in ds.dims else ds
            for ds, d in zip(datasets, dates, strict=True)
        ]
    if find_spec("dask") is not None:
        # Otherwise joining reads all data.
        datasets = [ds.chunk() for ds in datasets]
    try:
        series: xr.Dataset = xarray.concat(
            datasets,
            dim=name,
            data_vars="minimal",
            coords="minimal",
            compat="override",
            join="exact",
        ).sortby(name)
        return series
    except (ValueError, KeyError) as error:
        msg = (
            f"the files are not steps of one series: {error}. Give only files that belong together"
        )
        raise FieldError(msg) from error


def _dates_in_names(paths: Sequence[Path]) -> list[np.datetime64] | None:
    """Return the dates in the names of files, as in ``winds_20020101.nc``, all different."""
    matches = [re.search(r"(?<!\d)(\d{4})-?(\d{2})-?(\d{2})(?!\d)", path.stem) for path in paths]
    try:
        dates = [np.datetime64("-".join(match.groups())) for match in matches if match]
    except ValueError:
        return None
    return dates if len(set(dates)) == len(paths) else None
