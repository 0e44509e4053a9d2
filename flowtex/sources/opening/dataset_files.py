"""Files of ocean and weather models as datasets: NetCDF, Zarr, GRIB, and winds in JSON."""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Callable, Container, Iterable, Sequence
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.arguments import brief, checked_source
from flowtex._util.array_types import AnyArray
from flowtex._util.host_arrays import unit_text
from flowtex._util.memory import check_memory
from flowtex._util.xarray_internals import held_array
from flowtex.errors import FieldError, import_extra, import_package
from flowtex.field import units
from flowtex.sources.datasets import labels
from flowtex.sources.datasets.axes import TIMES, Choice, as_slice, is_dates
from flowtex.sources.datasets.select import GRIB_FLAGS, find_pairs
from flowtex.sources.inspection.inspect_file import NETCDF, inspect_file
from flowtex.sources.models.conventions import with_mesh_axes
from flowtex.sources.models.drifters import as_points
from flowtex.sources.models.image_velocimetry import with_image_units
from flowtex.sources.models.sgrid import with_declared_axes
from flowtex.sources.notices import NOTE, Record
from flowtex.sources.opening import component_axes, flow_text, rasters, tables
from flowtex.sources.opening.axis_marks import time_axis, with_axes
from flowtex.sources.opening.column_values import plain_values
from flowtex.sources.opening.named_units import with_named_units
from flowtex.sources.opening.packed_values import has_texts, with_numbers

if TYPE_CHECKING:
    import xarray as xr

#: Names of axes along which later versions follow earlier ones.
VERSIONS = re.compile(r"^(exp_?ver\w*|(\w+_)?versions?)$", re.IGNORECASE)
#: Names of dates as text, which some models write beside less exact times, or instead of them.
LETTERS = ("Times", "xtime")
#: Dates of eight to fourteen digits.
DIGITS = re.compile(
    r"(1[5-9]\d\d|2[0-2]\d\d)(0[1-9]|1[0-2])([0-2]\d|3[01])[T_ ]?(\d\d)?(\d\d)?(\d\d)?Z?"
)
#: Texts of five and more digits, and numbers, that are no dates.
NUMBER = re.compile(r"[-+]?(\d{5,}|\d{1,3})(\.\d*)?")
#: A unit of time of ICON: a date, with the share of the day behind its point.
DAYS_AS_NUMBERS = "%Y%m%d"
#: Errors of times that no calendar has.
UNDATED = (ValueError, OverflowError, TypeError)
GRIB = (".grib", ".grb", ".grib2", ".grb2")
ZARR = (".zarr",)
#: TELEMAC.
SELAFIN = (".slf", ".srf")
JSON = (".json", ".geojson")
TABLES = {
    ".csv": flow_text.read_columns,
    ".txt": flow_text.read_text,
    ".dat": flow_text.read_text,
    ".tsv": flow_text.read_text,
    ".vec": tables.read_vec,
    ".tuv": flow_text.read_text,
    ".raw": flow_text.read_text,
    ".xy": flow_text.read_text,
}
#: Suffixes that files of other content have as well; folders are not searched for them.
COMMON = (".txt", ".dat", ".raw", ".xy", ".tif", ".tiff", ".asc")
#: The suffix of columns of numbers that Tecplot and PLOT3D have as well.
DATA_SUFFIX = ".dat"
#: Suffixes of files that are opened by xarray.
SUFFIXES = (*NETCDF, *GRIB, *ZARR, *SELAFIN, *JSON, *TABLES, *rasters.DRIVERS)


class Datasets(list["xr.Dataset"]):
    """Datasets, and functions that close their files.

    In ``recognised`` ones cf_xarray recognises the axes, and times are dates.
    """

    def __init__(
        self, items: Iterable[xr.Dataset], closers: Iterable[Any] = (), *, recognised: bool = False
    ) -> None:
        super().__init__(items)
        self.closers = tuple(closers)
        self.recognised = recognised
        #: Names of axes along which a choice was used when the datasets were opened.
        self.used: set[str] = set()

    def close(self) -> None:
        """Close the files; a later read opens them again."""
        for close in self.closers:
            close()


def as_datasets(data: Any, record: Record | None = None, choice: Choice | None = None) -> Datasets:
    """Return datasets with recognised axes: series and regions joined, and of a tree one group.

    Versions are joined as well, unless one of them is chosen. Trajectories become points at the
    chosen time.
    """
    choice = choice or Choice()
    if isinstance(data, Datasets) and data.recognised:
        return data
    xarray = import_extra("xarray", "xarray")
    record = record or Record()
    result = []
    for ds in data if isinstance(data, (list, tuple)) else [data]:
        several = isinstance(data, (list, tuple)) and len(data) > 1
        if isinstance(ds, xarray.DataTree):
            parts = of_tree(ds)
        else:
            parts = [tables.as_dataset(ds, several=several)]
        for part in map(with_image_units, parts):
            note = part.encoding.get(NOTE)
            if note:
                record("select", note, notable=True)
            decoded = with_named_units(_decoded(part), record)
            whole = _one_version(decoded, {*choice.sel, *choice.isel}, record)
            result.append(component_axes.split_components(whole))
    groups: dict[frozenset[Any], list[xr.Dataset]] = {}
    for ds in result:
        groups.setdefault(frozenset(ds.data_vars), []).append(ds)
    result = [ds for group in groups.values() for ds in _together(group, record)]
    if isinstance(data, Datasets):
        closers = data.closers
    else:
        closers = ()
    result = [as_points(ds, choice, record) for ds in result]
    known = Datasets(with_mesh_axes([with_axes(ds) for ds in result]), closers, recognised=True)
    known.used = choice.used
    return known


def _one_version(ds: xr.Dataset, chosen: Container[str], record: Record) -> xr.Dataset:
    """Return a dataset in which later versions fill what the first one lacks, as of ERA5."""
    dim = next((str(d) for d in ds.dims if VERSIONS.match(str(d)) and d not in chosen), "")
    if not dim:
        return ds
    count = ds.sizes[dim]
    if dim in ds.coords:
        names = ", ".join(map(str, ds[dim].values))
    else:
        names = f"{count} versions"
    if "source" in ds.encoding and find_spec("dask") is not None:  # otherwise all of it is read
        ds = ds.chunk({d: 1 for d in ds.dims if TIMES.match(str(d))})
    with import_extra("xarray", "xarray").set_options(keep_attrs=True):
        whole: xr.Dataset = ds.isel({dim: 0}, drop=True)
        for number in range(1, count):
            whole = whole.fillna(ds.isel({dim: number}, drop=True))
    record("select", f"{dim}: {names} are joined, each where those before it lack data")
    return whole.assign_attrs(ds.attrs)


def _together(group: list[xr.Dataset], record: Record) -> list[xr.Dataset]:
    """Join datasets of the same variables: steps of one series, or regions beside each other."""
    if len(group) < 2 or not any(array.ndim > 1 for array in group[0].data_vars.values()):
        return group
    name = time_axis(group)
    times = [np.atleast_1d(ds[name].values) if name in ds else np.empty(0) for ds in group]
    if all(map(len, times)) and len({tuple(map(str, line)) for line in times}) == len(times):
        try:
            return [joined(group, record)]
        except FieldError:  # such as domains of different sizes
            return _apart(group, record)
    xarray = import_extra("xarray", "xarray")
    lines = [{d: ds.indexes[d] for d in ds.dims if d in ds.indexes} for ds in group]
    axes = [d for d in lines[0] if any(not lines[0][d].equals(o.get(d, [])) for o in lines[1:])]
    if not axes or any(lines[0].keys() != other.keys() for other in lines[1:]):
        return _apart(group, record)
    try:
        whole = xarray.combine_by_coords(_chunked([ds.sortby(axes) for ds in group]))
    except (ValueError, KeyError):  # such as regions that overlap
        return _apart(group, record)
    record("select", f"{len(group)} regions joined along {' and '.join(map(str, axes))}")
    return [whole]


def _apart(group: list[xr.Dataset], record: Record) -> list[xr.Dataset]:
    """Return datasets that cannot be joined, of whose velocities the first is drawn."""
    if find_pairs(group[:1]):
        text = f"{len(group)} datasets of one velocity cannot be joined; the first one is drawn"
        record("select", text, notable=True)
    return group


def of_tree(tree: xr.DataTree, file: Path | None = None) -> list[xr.Dataset]:
    """Return the one group of a tree (of a file) with a velocity, or its root.

    Where no group has both components, all groups with variables are returned.

    Raises
    ------
    FieldError
        When several groups have a velocity, and the root has none.
    """
    parts = {node.path: node.to_dataset() for node in tree.subtree}
    groups = [path for path, ds in parts.items() if find_pairs([ds])]
    if len(groups) > 1 and groups[0] != tree.path:
        listed = ", ".join(groups)
        if file is None:
            example = f"tree[{groups[0]!r}]"
        else:
            example = repr(f"{file}{groups[0]}")
        raise FieldError(f"the groups {listed} have a velocity; give one, as in {example}")
    if groups:
        return [parts[groups[0]]]
    filled = [ds for ds in parts.values() if ds.data_vars]
    if find_pairs(filled):
        return filled
    return [parts[tree.path]]


def _plain(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset of NumPy's types; units of pint are attributes, dates with a zone UTC."""
    plain: dict[str, Any] = {}
    for key, variable in ds.variables.items():
        name = str(key)
        held = held_array(variable)
        if hasattr(held, "magnitude"):
            attrs = {**variable.attrs, "units": unit_text(held)}
            plain[name] = (variable.dims, held.magnitude, attrs)
        elif not isinstance(variable.dtype, np.dtype):
            values = plain_values(variable.to_index() if variable.ndim == 1 else variable.data)
            plain[name] = (variable.dims, np.reshape(values, variable.shape), variable.attrs)
    own = list(plain)
    if not own:
        return ds
    coordinates = {name: plain.pop(name) for name in own if name in ds.coords}
    return ds.drop_vars(own).assign_coords(coordinates).assign(plain)


def _decoded(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset with ``Unit``, ``Units`` and ``unit`` as units, and times as dates."""
    ds = _plain(ds)
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
    ds = with_numbers(ds)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with suppress(*UNDATED):
            unread = _without_calendar(ds)
            xarray = import_extra("xarray", "xarray")
            ds = xarray.decode_cf(ds, decode_times=unread, decode_timedelta=False)
    return _dated(with_declared_axes(ds))


def _without_calendar(ds: xr.Dataset) -> dict[str, bool]:
    """Return ``False`` for each variable with times of no calendar, as "hours since analysis"."""
    xarray = import_extra("xarray", "xarray")
    unread = {}
    for name, variable in ds.variables.items():
        if "since" not in str(variable.attrs.get("units", "")):
            continue
        try:
            xarray.decode_cf(xarray.Dataset({name: variable}), decode_timedelta=False)
        except UNDATED:
            unread[str(name)] = False
            if "bounds" in variable.attrs:
                unread[str(variable.attrs["bounds"])] = False
    return unread


def _dated(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset with dates along its axis of time, if texts or numbers have them."""
    for name in (*LETTERS, *(n for n, c in ds.coords.items() if c.dims == (n,))):
        if name not in ds.variables or not ds[name].dims or ds[name].dtype.kind not in "SUO":
            continue
        if ds[name].dtype.kind == "O" and is_dates(ds[name]):
            continue
        dim = str(ds[name].dims[0])
        rows: Iterable[Any] = ds[name].values
        if ds[name].ndim > 1:
            rows = map(b"".join, ds[name].values)
        texts = []
        for row in rows:
            texts.append((row.decode() if isinstance(row, bytes) else str(row)).strip(" \0"))
        dates = _dates_of(texts)
        if dates is not None and ds.sizes[dim] == len(dates):
            return ds.assign_coords({dim: (dim, dates, {"axis": "T"})})
    for name, c in ds.coords.items():  # such as 20240130
        bare = c.dims == (name,) and c.dtype.kind in "iu" and "units" not in c.attrs
        if bare and TIMES.match(str(name)):
            dates = _dates_of([str(number) for number in c.values.tolist()], digits=True)
            if dates is not None:
                return ds.assign_coords({name: (name, dates, {"axis": "T"})})
    for axis in ds.dims:
        line = ds.variables.get(axis)
        if line is not None and DAYS_AS_NUMBERS in str(line.attrs.get("units", "")):
            days = np.floor(line.values).astype(int)
            dates = np.array([f"{d // 10**4:04}-{d // 100 % 100:02}-{d % 100:02}" for d in days])
            seconds = np.round((line.values - days) * 86400).astype("timedelta64[s]")
            times = (dates.astype("datetime64[s]") + seconds).astype("datetime64[ns]")
            return ds.assign_coords({axis: (axis, times, {"axis": "T"})})
    return ds


def _dates_of(texts: list[str], *, digits: bool = False) -> AnyArray | None:
    """Return the dates of texts, (N,), of zones in UTC; ``None`` if one is no date.

    With ``digits`` only those of eight to fourteen digits are dates.
    """
    forms = []
    for text in texts:
        found = DIGITS.fullmatch(text)
        if found is None and (digits or NUMBER.fullmatch(text)):
            return None
        if found is None:
            forms.append(text.replace("_", "T"))
            continue
        clock = [part or "00" for part in found.groups()[3:]]
        forms.append("-".join(found.groups()[:3]) + "T" + ":".join(clock))
    pandas = import_extra("pandas", "xarray")
    try:
        dates = pandas.to_datetime(forms, utc=True, format="ISO8601")
    except (ValueError, OverflowError):
        return None
    return np.asarray(dates.tz_localize(None), dtype="datetime64[ns]")


def joined(datasets: Sequence[xr.Dataset], record: Record | None = None) -> xr.Dataset:
    """Join steps of a series in the order of their times, on the positions that all have.

    Raises
    ------
    FieldError
        When the datasets are not steps of one series, such as on different grids.
    """
    xarray = import_extra("xarray", "xarray")
    record = record or Record()
    datasets = [_decoded(ds) for ds in datasets]
    name = time_axis(datasets)
    dates = _dates_in_names([Path(str(ds.encoding.get("source", ""))) for ds in datasets])
    if dates is not None and name in datasets[0].dims and datasets[0][name].dtype.kind in "fiu":
        # The times are numbers without a unit.
        datasets = [ds.assign_coords({name: [d]}) for ds, d in zip(datasets, dates, strict=True)]
    datasets = _alike(datasets, name, record)
    try:
        rules: dict[str, Any] = {"data_vars": "different", "coords": "different"}
        rules |= {"compat": "equals", "join": "exact"}
        series: xr.Dataset = xarray.concat(_chunked(datasets), dim=name, **rules).sortby(name)
        return series
    except (ValueError, KeyError) as error:
        raise FieldError(
            f"the files are not steps of one series: {error}. Give only files that belong together"
        ) from error


def _chunked(datasets: list[xr.Dataset]) -> list[xr.Dataset]:
    """Return datasets of arrays that are joined without reading all data, where Dask is present."""
    if find_spec("dask") is not None:
        return [ds.chunk() for ds in datasets]
    return datasets


def _alike(datasets: list[xr.Dataset], name: str, record: Record) -> list[xr.Dataset]:
    """Return steps of a series on the labels that all have along each axis, in one order."""
    for dim in map(str, datasets[0].dims):
        if dim == name or dim not in datasets[0].indexes:
            continue
        lines = [np.asarray(ds[dim].values) for ds in datasets if dim in ds.indexes]
        if len(lines) < len(datasets):
            continue
        degrees = units.is_angle(str(datasets[0][dim].attrs.get("units", "")))
        if degrees and lines[0].dtype.kind in "fiu":
            period = 360.0
        else:
            period = None
        kept = lines[0]
        for line in lines[1:]:
            kept = kept[labels.match(kept, line, period).one]
        if not len(kept):
            continue
        if len(kept) < max(map(len, lines)):
            text = f"{dim}: {len(kept)} values that all steps have in common"
            record("align", text, notable=True)
        parts = []
        for ds, line in zip(datasets, lines, strict=True):
            found = labels.match(kept, line, period).other
            if not np.array_equal(line, kept):
                part = ds.isel({dim: as_slice(found)})
            else:
                part = ds
            parts.append(part.assign_coords({dim: (dim, kept, datasets[0][dim].attrs)}))
        datasets = parts
    return datasets


def _dates_in_names(paths: Sequence[Path]) -> list[np.datetime64] | None:
    """Return the dates in the names of files, as in ``winds_20020101.nc``, all different."""
    matches = [re.search(r"(?<!\d)(\d{4})-?(\d{2})-?(\d{2})(?!\d)", path.stem) for path in paths]
    try:
        dates = []
        for match in matches:
            if match:
                dates.append(np.datetime64("-".join(match.groups())))
    except ValueError:
        return None
    if len(set(dates)) == len(paths):
        return dates
    return None


def is_dataset_file(path: Path) -> bool:
    """Return whether a path is a file, or a Zarr store, that xarray opens."""
    if path.is_dir():
        return any((path / name).is_file() for name in ("zarr.json", ".zgroup", ".zmetadata"))
    suffix = path.suffix.lower()
    if suffix == DATA_SUFFIX:
        return path.is_file() and flow_text.has_columns(path)
    return suffix in SUFFIXES


def file_and_group(path: Path) -> tuple[Path, str]:
    """Return the file of a path such as ``model.nc/ocean``, and the group in it."""
    files = (p for p in path.parents if p.suffix.lower() in NETCDF and p.is_file())
    file = next(files, path)
    return file, "" if file == path else path.relative_to(file).as_posix()


def dataset_paths(given: Any) -> list[Path]:
    """Return the paths of dataset files, or of groups as ``model.nc/ocean``; else none.

    Raises
    ------
    FieldError
        When it is no path or list of paths, or a path is invalid.
    """
    if isinstance(given, (list, tuple)):
        items = given
    else:
        items = [given]
    if not all(isinstance(item, (str, os.PathLike)) for item in items):
        raise FieldError(f"path is {brief(given)}; expected the path of a file, or a list of paths")
    paths = [Path(item).expanduser() for item in items]
    for path in paths:
        checked_source(path)
    files = [file_and_group(p)[0] for p in paths]
    all_exist = paths and all(map(is_dataset_file, files)) and all(file.exists() for file in files)
    if all_exist:
        return paths
    return []


def common_name(paths: Sequence[Path]) -> str:
    """Return a word for captions: the common beginning of the names of files."""
    stems = [path.stem for path in paths]
    shared = os.path.commonprefix(stems)  # noqa: RUF071
    if len(stems) > 1 and len(shared) > 2:
        return shared.rstrip("_-. 0123456789")
    return stems[0]


def belong_together(paths: Sequence[Path]) -> bool:
    """Return whether files are read together: steps of a series, or parts without a pair."""
    opened = [open_files(path) for path in paths]
    alike = len({frozenset(ds.data_vars) for parts in opened for ds in parts}) == 1
    series = alike and all(len(parts) == 1 for parts in opened) and bool(find_pairs(opened[0]))
    return series or not all(find_pairs(parts) for parts in opened)


def open_datasets(paths: Sequence[Path]) -> Datasets:
    """Open files that belong together: parts of one model's output, or steps of a series."""
    opened = [open_files(path) for path in paths]
    parts = (ds for datasets in opened for ds in datasets)
    return Datasets(parts, [close for datasets in opened for close in datasets.closers])


def _checked_zarr(path: Path) -> Any:
    """Return the Zarr store in a folder, whose metadata are checked as they are read."""
    import_extra("zarr", "xarray")
    from flowtex._util.zarr_stores import checked_folder

    return checked_folder(path)


def open_files(path: Path) -> Datasets:
    """Open one file; GRIB has a dataset for each group of messages with common axes.

    Raises
    ------
    FieldError
        When the file is damaged or too large, or the group does not exist.
    ModuleNotFoundError
        When a package that reads the format is not installed.
    """
    xarray = import_extra("xarray", "xarray")
    # Its library must be loaded before those of other readers, which contain another PROJ.
    import_extra("pyproj", "xarray")
    path, group = file_and_group(path)
    suffix = path.suffix.lower()
    inspect_file(path, whole=False)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if suffix in JSON:
            return Datasets([tables.read_winds(path)])
        if suffix in TABLES:
            return Datasets([TABLES[suffix](path)])
        if suffix in rasters.DRIVERS:
            return Datasets([rasters.read_raster(path)])
        if suffix in SELAFIN:
            return Datasets([_selafin(path)])
        if suffix in GRIB:
            read: dict[str, Any] = {"indexpath": "", "read_keys": [GRIB_FLAGS]}
            parts = import_cfgrib().open_datasets(str(path), backend_kwargs=read)
            return Datasets(parts, _closers(parts))
        options: dict[str, Any] = {"decode_timedelta": False}
        place: Any = path
        if path.is_dir() or suffix in ZARR:
            place = _checked_zarr(path)
            options["engine"] = "zarr"
        ds = _opened(place, options)
        ds.encoding["source"] = str(path)
        if not group and any(array.ndim for array in ds.data_vars.values()):
            return Datasets([ds], _closers([ds]))
        tree = xarray.open_datatree(place, **options)
        if group and f"/{group}" not in tree.groups:
            groups = ", ".join(tree.groups[1:]) or "none: there are no groups"
            raise FieldError(f"the group {group!r} does not exist; expected {groups}")
        parts = of_tree(tree[group] if group else tree, path)
        return Datasets(parts, _closers([ds, *tree.subtree]))


def _opened(place: Any, options: dict[str, Any]) -> xr.Dataset:
    """Open a file; the options that it needs besides are added to these."""
    xarray = import_extra("xarray", "xarray")
    ds: xr.Dataset
    try:
        ds = xarray.open_dataset(place, **options)
    except ValueError:  # times that no calendar has stay numbers
        options["decode_times"] = False
        ds = xarray.open_dataset(place, **options)
    if has_texts(ds):
        ds.close()
        options["mask_and_scale"] = False
        ds = xarray.open_dataset(place, **options)
    return ds


def _selafin(path: Path) -> xr.Dataset:
    """Read a file of TELEMAC as a whole, as its reader cannot open it again for each step."""
    import_package("xarray-selafin", "a SELAFIN file of TELEMAC")
    check_memory(path.stat().st_size, "the file")
    with import_extra("xarray", "xarray").open_dataset(path, engine="selafin") as ds:
        whole: xr.Dataset = ds.load()
    return whole


def _closers(parts: Iterable[Any]) -> list[Callable[[], None]]:
    """Return functions that close datasets again and again, as xarray opens a file for each read.

    The method ``close`` works only once.
    """
    found = []
    for part in parts:
        if part._close is not None:
            found.append(part._close)
    return found


def import_cfgrib() -> Any:
    """Import the reader of GRIB.

    Raises
    ------
    ModuleNotFoundError
        When cfgrib or its library ecCodes is missing; the error has the remedy.
    """
    try:
        return import_extra("cfgrib", "grib")
    except RuntimeError as error:
        raise ModuleNotFoundError(
            f"reading GRIB needs the library ecCodes, which is missing ({error}); install cfgrib "
            "from conda-forge, which includes it",
            name="cfgrib",
        ) from error
