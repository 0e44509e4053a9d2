"""Tables, GeoJSON of points, and JSON of wind maps, as datasets.

Rows of a grid become a grid, with NaN where rows are missing; other rows are points along one
dimension. Columns of positions and time are found by their names.

The JSON of winds and currents is that of grib2json, which leaflet-velocity and earth read: a list
of records, each with ``header`` (``nx``, ``ny``, ``lo1``, ``la1``, ``dx``, ``dy``,
``parameterNumber`` 2 for eastward and 3 for northward) and ``data``, rows from north to south.
"""

from __future__ import annotations

import csv
import io
import json
import os
import re
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex._util.memory import check_memory
from flowtex._util.whole_file import TemporaryFolder
from flowtex.errors import FieldError, import_extra
from flowtex.sources.datasets import is_dataset
from flowtex.sources.datasets.coordinates import LATITUDE, LONGITUDE, OF_POINTS
from flowtex.sources.datasets.space_planes import ATTRIBUTE
from flowtex.sources.models.trajectories import IDENTITIES, TRAJECTORY
from flowtex.sources.opening import component_axes
from flowtex.sources.opening.column_levels import has_positions, with_one_level
from flowtex.sources.opening.column_names import component_names, split_unit
from flowtex.sources.opening.column_values import column_numbers, without_units
from flowtex.sources.opening.named_units import name_and_unit
from flowtex.sources.reader_errors import check_count

if TYPE_CHECKING:
    import xarray as xr

ACROSS = re.compile(rf"^(x|x[-_ ]?coord\w*|x[-_ ]?pos\w*|easting|{OF_POINTS.format('x')})$", re.I)
UPWARD = re.compile(rf"^(y|y[-_ ]?coord\w*|y[-_ ]?pos\w*|northing|{OF_POINTS.format('y')})$", re.I)
LEVELS = re.compile(r"^(z|lev\w*|depth|height|altitude|plev|pressure)$", re.I)
TIMES = re.compile(r"^(t|(valid_?)?(date_?)?time\w*|date)$", re.I)
#: The new name of positions across a plane, which are the same everywhere.
ACROSS_PLANE = "across the plane"
#: Columns that together are dates.
PARTS_OF_DATES = ("year", "month", "day", "hour", "minute", "second")
#: Names and units of columns in the header of a .vec file.
VEC_COLUMN = re.compile(r'"(\S+)\s*([^",]*)"')
#: The column of flags of a .vec file.
VEC_FLAG = "CHC"
#: Most places of a grid for each row, for which rows are a grid.
MOST_PLACES = 4
#: Fewest whole cells of a grid for each row.
FEWEST_CELLS = 0.4
#: Share of the points that must have values, over all times.
FEWEST_ROWS = 0.5
#: Share of identities with moving positions below which identities are stations.
FEWEST_MOVING = 0.5
#: Fewest points whose heights are compared.
FEWEST_OF_VOLUME = 30
#: Mean step of heights between neighbours, in standard deviations of the heights, from which on
#: points fill a volume. It is 1.1 for random points, and small on a surface.
VOLUME_STEP = 0.5
#: Most bytes in memory for one byte of text: in JSON each "[]," is a list.
TEXT_GROWTH = 24
#: Most letters of a row that a message repeats.
MOST_SHOWN = 60


def as_dataset(item: Any, *, several: bool) -> xr.Dataset:
    """Return a dataset, or make one of a table or array.

    Parameters
    ----------
    item
        A dataset, an array, a table, or the text of one.
    several
        Whether an array is one of several, so that it is one component.

    Raises
    ------
    FieldError
        When the item has another type.
    """
    xarray = import_extra("xarray", "xarray")
    if isinstance(item, xarray.Dataset):
        return item
    if isinstance(item, xarray.DataArray):
        return component_axes.of_array(item, several=several)
    if isinstance(item, io.StringIO):
        return _read_text(item)
    if is_dataset(item):
        return of_table(item)
    raise FieldError(
        f"data has type {type(item).__name__}; expected an xarray Dataset, DataTree or DataArray, "
        "a pandas DataFrame, or a list of them"
    )


def _read_text(stream: io.StringIO) -> xr.Dataset:
    """Read columns as from a file."""
    temporary = TemporaryFolder()
    try:
        path = temporary.new_folder() / "table.csv"
        path.write_text(stream.getvalue(), encoding="utf-8")
        return read_csv(path)
    finally:
        temporary.close()


def of_table(table: Any) -> xr.Dataset:
    """Return the dataset of a table with a row for each point, or each point and time.

    Raises
    ------
    FieldError
        When no columns are lon and lat, or x and y.
    """
    is_counted = type(table.columns).__name__ == "RangeIndex"
    if has_positions(table) and not is_counted:
        first, *_, last = table.columns
        raise FieldError(
            f"the columns are positions, {first} to {last}, as of a table of one component; pass "
            "the tables of both, as in flowtex.show(u, v)"
        )
    frame, attributes = _plain(table)
    columns = list(map(str, frame.columns))
    pair = _pair(columns, LONGITUDE, LATITUDE) or _pair(columns, ACROSS, UPWARD)
    if pair is None:
        raise FieldError(
            f"the table has the columns {', '.join(columns)}; expected lon and lat, or x and y, "
            "beside the components; rename the columns, as in df.rename(columns=...)"
        )
    x, y = pair
    frame = _with_dates(frame)
    frame = frame.dropna(subset=[x, y])
    changes, plane = _along_plane(frame, x, y)
    frame = frame.rename(columns=changes)
    attributes = {changes.get(name, name): value for name, value in attributes.items()}
    frame = frame.drop(columns=ACROSS_PLANE, errors="ignore")
    columns = list(map(str, frame.columns))
    planar = [c for c in columns if (ACROSS.match(c) or UPWARD.match(c)) and c not in pair]
    frame = frame.drop(columns=planar)  # the same positions on a map
    moving = _trajectories(frame, x, y)
    if moving is not None:
        return _with_attributes(moving, attributes, x, y)
    frame, axes = _axes(frame, x, y)
    ds = _nodes(frame, axes, x, y)
    ds = _with_attributes(ds, attributes, x, y)
    if plane:
        ds[x].attrs[ATTRIBUTE] = plane
    for name in axes:
        ds[name].attrs["axis"] = "T" if TIMES.match(name) else "Z"
    return ds


def _along_plane(frame: Any, x: str, y: str) -> tuple[dict[str, str], str]:
    """Return new names of the positions along a plane across x or y, and its place.

    Such are the points of a cut through a volume. The place is as in ``"x=0.5"``; it is empty for
    the plane of x and y.

    Raises
    ------
    FieldError
        For points along one longitude or latitude.
    """
    z = next((name for name in frame.columns if str(name).lower() == "z"), None)
    if z is None or frame[z].nunique() < 2:
        return {}, ""
    for letter, across, other in (("x", x, y), ("y", y, x)):
        if frame[across].nunique() != 1:
            continue
        place = float(frame[across].iloc[0])
        if LONGITUDE.match(x):
            changes = {across: f"{across}_of_plane", other: "x", z: "y"}
            raise FieldError(
                f"all points have {across} = {place:g}; expected a surface of {x} and {y}. To draw "
                f"that of {other} and {z}, rename the positions, and name the components along "
                f'these, as in flowtex.show(df.rename(columns={changes}), u="v", v="w")'
            )
        return {across: ACROSS_PLANE, other: x, z: y}, f"{letter}={place!r}"
    return {}, ""


def _with_attributes(
    ds: xr.Dataset, attributes: dict[str, dict[str, str]], x: str, y: str
) -> xr.Dataset:
    """Return a dataset with the attributes of its columns."""
    for name, attrs in attributes.items():
        if name in ds.variables:
            ds[name].attrs.update(attrs)
    if LONGITUDE.match(x):
        ds[x].attrs["units"] = "degrees_east"
        ds[y].attrs["units"] = "degrees_north"
    return ds


def _trajectories(frame: Any, x: str, y: str) -> xr.Dataset | None:
    """Return rows with an identity, a time and a position that moves; ``None`` for others."""
    columns = []
    for name in frame.columns:
        if name not in (x, y):
            columns.append(str(name))
    identity = next(filter(IDENTITIES.match, columns), None)
    time = next(filter(TIMES.match, columns), None)
    if identity is None or time is None or frame[identity].is_unique:
        return None
    places = frame.groupby(identity)[[x, y]].nunique().max(axis=1)
    if (places > 1).mean() < FEWEST_MOVING:
        return None
    frame = frame.assign(**{time: _times_in(frame, time)})
    data = frame.select_dtypes(["number", "bool"]).columns
    kept = list(dict.fromkeys([identity, time, x, y, *data]))
    ds: xr.Dataset = frame[kept].reset_index(drop=True).to_xarray().drop_vars("index")
    return ds.set_coords([x, y]).assign_attrs(featureType=TRAJECTORY)


def _plain(table: Any) -> tuple[Any, dict[str, dict[str, str]]]:
    """Return a table of pandas with columns of positions, and the units in names of columns."""
    pandas = import_extra("pandas", "xarray")
    frame = table
    if type(table).__module__.startswith("polars"):
        frame = pandas.DataFrame(table.to_dict(as_series=False))
    elif hasattr(table, "to_pandas"):  # of Arrow
        frame = table.to_pandas()
    elif hasattr(table, "to_crs"):
        if not (table.geometry.geom_type == "Point").all():
            kinds = ", ".join(map(str, table.geometry.geom_type.unique()))
            raise FieldError(f"the geometries are {kinds}; expected points")
        on_earth = table.crs is not None
        at = (table.to_crs(4326) if on_earth else table).geometry
        if on_earth:
            names = ("lon", "lat")
        else:
            names = ("x", "y")
        frame = pandas.DataFrame(table.drop(columns=table.geometry.name))
        frame = frame.drop(columns=[n for n in names if n in frame])
        frame = frame.assign(**{names[0]: at.x, names[1]: at.y})
    frame = with_one_level(frame)
    levels = [name for name in frame.index.names if name is not None]
    if levels:
        frame = frame.reset_index(levels)
    named = {column: _split(str(column)) for column in frame.columns}
    changes = component_names(name for name, _ in named.values())
    columns = {}
    attributes = {}
    for column, (name, unit) in named.items():
        columns[column] = changes.get(name, name)
        if unit:
            attributes[columns[column]] = {"units": unit}
    frame, units = without_units(frame.rename(columns=columns))
    attributes = {**{name: {"units": unit} for name, unit in units.items()}, **attributes}
    numbers = {name: column_numbers(frame[name]) for name in frame if frame.columns.is_unique}
    return frame.assign(**numbers), attributes


def _split(column: str) -> tuple[str, str]:
    """Return the name and the unit of a column; words for units remain in names of values."""
    name, unit = split_unit(column)
    if unit:
        return name, unit
    stem, unit = name_and_unit(name)
    if ACROSS.match(stem) or UPWARD.match(stem) or TIMES.match(stem):
        return stem, unit
    return name, ""


def _pair(
    columns: list[str], first: re.Pattern[str], second: re.Pattern[str]
) -> tuple[str, str] | None:
    """Return the columns with the shortest names that match, as ``lon`` before ``lon_bnds``."""
    found = [sorted(filter(p.match, columns), key=len) for p in (first, second)]
    if all(found):
        return (found[0][0], found[1][0])
    return None


def _axes(frame: Any, x: str, y: str) -> tuple[Any, list[str]]:
    """Return the columns of time and level for which the same positions repeat."""
    named = [next(filter(p.match, map(str, frame.columns)), None) for p in (TIMES, LEVELS)]
    time, level = (None if name in (x, y) else name for name in named)
    if time is not None:
        frame = frame.assign(**{time: _times_in(frame, time)})
    for axes in ([], [time], [level], [time, level]):
        if None not in axes and not frame.duplicated([*axes, y, x]).any():
            break
    else:
        names = [name for name in (x, y, time, level) if name is not None]
        same = frame[frame.duplicated(names, keep=False)][names]
        raise FieldError(
            f"{len(same):,} rows repeat a position, such as {same.iloc[0].to_dict()}. Average "
            f"them, as in df.groupby({names!r}).mean(), or draw a part of the table"
        )
    if not axes and time is not None and frame[time].nunique() > max(len(frame) / 2, 1):
        raise FieldError(
            f"nearly each of {len(frame):,} rows has its own {time} and position: a trajectory, or "
            "points that move. To draw many of them at one time, name the column that tells them "
            "apart id; otherwise interpolate the values to a grid, or drop the column"
        )
    return frame, [str(axis) for axis in axes]


def _with_dates(frame: Any) -> Any:
    """Return a table with a column of dates in place of their years, months, days and so on."""
    found = {}
    for name in frame.columns:
        word = str(name).lower()
        if TIMES.match(word):
            return frame
        if word in PARTS_OF_DATES:
            found[word] = name
    if not {"year", "month", "day"} <= set(found):
        return frame
    pandas = import_extra("pandas", "xarray")
    parts = {word: frame[name] for word, name in found.items()}
    try:
        dates = pandas.to_datetime(pandas.DataFrame(parts))
    except (ValueError, TypeError):  # such as months as names
        return frame
    return frame.drop(columns=list(found.values())).assign(time=dates)


def _times_in(frame: Any, time: str) -> Any:
    """Return a column of times as numbers or dates; raises a FieldError for others."""
    column = frame[time]
    if column.dtype.kind in "fiu":
        return column
    try:
        return import_extra("pandas", "xarray").to_datetime(column, utc=True).dt.tz_convert(None)
    except (ValueError, TypeError) as error:
        raise FieldError(
            f"the column {time!r} has {column.iloc[0]!r}; expected dates or numbers"
        ) from error


def _nodes(frame: Any, axes: list[str], x: str, y: str) -> xr.Dataset:
    """Return the columns of numbers on a grid, if rows are those of one, or at points."""
    data = frame.select_dtypes(["number", "bool"]).columns
    frame = frame[list(dict.fromkeys([*axes, y, x, *data]))]
    points = frame.drop_duplicates([x, y])
    if not _is_grid(points[x].to_numpy(), points[y].to_numpy()):
        return _points(frame, points, axes, x, y)
    grid: xr.Dataset = frame.set_index([*axes, y, x]).to_xarray()
    return grid


def _is_grid(a: AnyArray, b: AnyArray) -> bool:
    (columns, i) = np.unique(a, return_inverse=True)
    (rows, j) = np.unique(b, return_inverse=True)
    if not 0 < len(columns) * len(rows) <= MOST_PLACES * len(a):
        return False
    present = np.zeros((len(rows), len(columns)), dtype=bool)
    present[j, i] = True
    cells = present[1:, 1:] & present[1:, :-1] & present[:-1, 1:] & present[:-1, :-1]
    return bool(cells.sum() >= FEWEST_CELLS * len(a))


def _check_surface(points: Any, x: str, y: str) -> None:
    """Raise a FieldError for points that fill a volume, of which a surface would be meaningless."""
    z = next((name for name in points.columns if str(name).lower() == "z"), None)
    if z is None or LONGITUDE.match(x) or len(points) < FEWEST_OF_VOLUME:
        return
    from scipy.spatial import KDTree

    places = points[[x, y]].to_numpy(dtype=float)
    heights = points[z].to_numpy(dtype=float)
    size = np.maximum(np.ptp(places, axis=0), np.finfo(float).tiny)
    _, nearest = KDTree(places / size).query(places / size, k=2)
    neighbours = np.asarray(nearest)[:, 1]  # the first one is the point itself
    steps = np.abs(heights[neighbours] - heights)
    if np.nanmean(steps) > VOLUME_STEP * np.nanstd(heights) > 0:
        low, middle, high = np.nanquantile(heights, (0.45, 0.5, 0.55))
        raise FieldError(
            f"the points fill a volume: {z} of neighbours in {x} and {y} differs by "
            f"{np.nanmean(steps):.3g} on average; expected points of a surface. Choose a layer, as "
            f"in df[df[{z!r}].between({low:.4g}, {high:.4g})] around {middle:.4g}, or drop {z} to "
            "draw all points in one plane"
        )


def _points(frame: Any, points: Any, axes: list[str], x: str, y: str) -> xr.Dataset:
    _check_surface(points, x, y)
    places = len(points) * int(np.prod([frame[axis].nunique() for axis in axes]))
    if len(frame) < FEWEST_ROWS * places:
        raise FieldError(
            f"{len(points):,} positions differ along {' and '.join(axes)}: points that move. "
            f"Choose rows of one {axes[0]}, or interpolate the values to a grid"
        )
    number = frame.groupby([x, y], sort=False).ngroup()
    at = {name: ("point", points[name].to_numpy()) for name in (x, y)}
    rows = frame.drop(columns=[x, y]).assign(point=number)
    ds: xr.Dataset = rows.set_index([*axes, "point"]).to_xarray()
    return ds.drop_vars("point").assign_coords(at)


def of_features(collection: dict[str, Any]) -> xr.Dataset:
    """Return the dataset of points in GeoJSON, whose properties are columns.

    Raises
    ------
    FieldError
        When a feature is no point.
    """
    pandas = import_extra("pandas", "xarray")
    rows = []
    for feature in collection.get("features", []):
        geometry = feature.get("geometry") or {}
        if geometry.get("type") != "Point":
            raise FieldError(
                f"a feature has the geometry {geometry.get('type')!r}; expected points"
            )
        lon, lat, *_ = geometry["coordinates"]
        rows.append({**(feature.get("properties") or {}), "lon": lon, "lat": lat})
    return of_table(pandas.DataFrame(rows))


def read_csv(path: Path) -> xr.Dataset:
    """Read columns separated by commas, semicolons, tabs or spaces, below a header.

    Raises
    ------
    FieldError
        When the first line has numbers in place of names, a row has another number of values, or
        the file does not fit into memory.
    """
    pandas = import_extra("pandas", "xarray")
    check_memory(TEXT_GROWTH * path.stat().st_size, "the file")
    with path.open(encoding="utf-8-sig") as file:
        header = next((line for line in file if line.strip() and not line.startswith("#")), "")
    separator = max(",;\t", key=header.count)
    options = {"sep": separator if separator in header else r"\s+", "comment": "#"}
    _check_rows(path, separator if separator in header else None)
    frame = pandas.read_csv(path, skipinitialspace=True, encoding="utf-8-sig", **options)
    if any(re.fullmatch(r"[-+.\deE]+", str(name).strip()) for name in frame.columns):
        raise FieldError(
            f"its first line is {header.strip()[:60]!r}; expected names of columns above the "
            "numbers, such as lon,lat,u,v"
        )
    _check_end(frame)
    return of_table(frame)


def _check_rows(path: Path, separator: str | None, *, header: int = 0) -> None:
    """Raise a FieldError for a row with fewer values than there are columns.

    pandas fills it with missing values. ``separator`` is ``None`` for white space, and ``header``
    the number of columns if the first line does not have their names alone.
    """
    count = header
    number = 0
    row: list[str] = []
    try:
        with path.open(encoding="utf-8-sig", errors="replace", newline="") as file:
            if header:
                file.readline()
            for number, row in _rows(file, separator):
                count = count or _names(row)
                if len(row) < count:
                    raise cut_row(number + bool(header), row, f"{len(row)} of {count} values")
    except csv.Error as error:
        raise FieldError(f"its rows cannot be read ({error}); write or copy it again") from error
    if row and len(row) <= count and not row[-1].strip() and not _ends_with_line(path):
        raise cut_row(number + bool(header), row, "no end and no last value")


def cut_row(number: int, row: list[str], fault: str) -> FieldError:
    """Return the error for a row of a text that ends too early."""
    text = ", ".join(row)
    if len(text) > MOST_SHOWN:
        text = text[:MOST_SHOWN] + "…"
    return FieldError(
        f"line {number:,} has {fault}: {text!r}. The file is truncated or damaged; write or copy "
        "it again, or remove the line"
    )


def _names(row: list[str]) -> int:
    """Return the number of columns in a header, which may end with a separator."""
    named = []
    for place, name in enumerate(row, start=1):
        if name.strip():
            named.append(place)
    return named[-1]


def _ends_with_line(path: Path) -> bool:
    with path.open("rb") as file:
        file.seek(-1, os.SEEK_END)
        return file.read() in (b"\n", b"\r")


def _rows(file: TextIO, separator: str | None) -> Iterator[tuple[int, list[str]]]:
    """Yield the rows with values, without comments, and the numbers of their lines."""
    if separator is None:
        for number, line in enumerate(file, start=1):
            values = line.partition("#")[0].split()
            if values:
                yield number, values
        return
    reader = csv.reader(file, delimiter=separator, skipinitialspace=True)
    for row in reader:
        text, comment, _ = separator.join(row).partition("#")
        if not text.strip():
            continue
        if comment:
            row = text.split(separator)
        yield reader.line_num, row


def _check_end(frame: Any) -> None:
    """Raise a FieldError if the last row alone has no number in a column of numbers."""
    pandas = import_extra("pandas", "xarray")
    if len(frame) < 2:
        return
    for name in frame.columns:
        column = frame[name]
        if column.dtype.kind in "biufcMm":
            continue
        unread = pandas.to_numeric(column, errors="coerce").isna() & column.notna()
        if unread.iloc[-1] and unread.sum() == 1:
            raise FieldError(
                f"the last row has {column.iloc[-1]!r} in the column {str(name)!r} of numbers. The "
                "file is truncated or damaged; write or copy it again, or remove the row"
            )


def read_vec(path: Path) -> xr.Dataset:
    """Read vectors of particle image velocimetry; those with a flag of 0 or less are blank.

    Raises
    ------
    FieldError
        When the first line does not declare the variables, a row has another number of values, or
        the file does not fit into memory.
    """
    pandas = import_extra("pandas", "xarray")
    check_memory(TEXT_GROWTH * path.stat().st_size, "the file")
    with path.open(encoding="utf-8", errors="replace") as file:
        header = file.readline()
    _, found, columns = header.partition("VARIABLES=")
    names = VEC_COLUMN.findall(columns.partition("DATASETAUXDATA")[0].partition("ZONE")[0])
    if not found or len(names) < 4:
        raise FieldError(
            f"its first line is {header[:60]!r}; expected VARIABLES= with X, Y, U and V"
        )
    labels = [name if not unit else f"{name} [{unit.strip()}]" for name, unit in names]
    _check_rows(path, ",", header=len(names))
    frame = pandas.read_csv(path, skiprows=1, header=None, names=labels, skipinitialspace=True)
    if VEC_FLAG in frame:
        flow = []
        for c in labels:
            if c.split()[0] in ("U", "V", "W"):
                flow.append(c)
        frame[flow] = frame[flow].where(frame[VEC_FLAG] > 0)
    return of_table(frame)


def read_winds(path: Path) -> xr.Dataset:
    """Read the components of the first level and time from the JSON of wind maps, or GeoJSON.

    Raises
    ------
    FieldError
        When the file is neither, or a component is missing, damaged or on another grid.
    """
    xarray = import_extra("xarray", "xarray")
    check_memory(TEXT_GROWTH * path.stat().st_size, "the file")
    try:
        records = json.loads(path.read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as error:
        raise FieldError(f"it is not valid JSON ({error})") from error
    if isinstance(records, dict) and records.get("type") == "FeatureCollection":
        return of_features(records)
    if isinstance(records, dict) and "refs" in records:
        raise FieldError(
            "these are references of kerchunk to parts of other files; use "
            f'flowtex.show(xarray.open_dataset("{path.name}", engine="kerchunk"))'
        )
    if not isinstance(records, list) or not all(isinstance(r, dict) for r in records):
        raise FieldError("it is not a list of records with header and data, as of leaflet-velocity")
    components: dict[str, Any] = {}
    for number, name in ((2, "eastward"), (3, "northward")):
        headers = [r.get("header", {}) for r in records]
        found = [n for n, header in enumerate(headers) if header.get("parameterNumber") == number]
        if not found:
            raise FieldError(f"the record of the {name} component is missing ({number=})")
        try:
            component = _component(headers[found[0]], records[found[0]]["data"], name)
        except (KeyError, TypeError, ValueError, OverflowError) as error:
            if isinstance(error, FieldError):
                raise
            raise FieldError(f"the record of the {name} component is damaged ({error})") from error
        components["u" if number == 2 else "v"] = component
    try:
        whole: xr.Dataset = xarray.merge([a.rename(n) for n, a in components.items()], join="exact")
    except ValueError as error:
        raise FieldError(f"the two components have different grids ({error})") from error
    return whole


def _component(header: dict[str, Any], data: Any, name: str) -> xr.DataArray:
    columns = int(header["nx"])
    rows = int(header["ny"])
    check_count(min(columns, rows), 1, f"the {name} component", "columns and rows")
    check_count(len(data), columns * rows, f"the {name} component", "numbers")
    lon = float(header["lo1"]) + abs(float(header["dx"])) * np.arange(columns)
    if float(header["la1"]) >= float(header.get("la2", -90.0)):
        south = -1.0
    else:
        south = 1.0
    lat = float(header["la1"]) + south * abs(float(header["dy"])) * np.arange(rows)
    coordinates: dict[str, Any] = {
        "latitude": ("latitude", lat, {"units": "degrees_north"}),
        "longitude": ("longitude", lon, {"units": "degrees_east"}),
    }
    with suppress(KeyError, ValueError, AttributeError):  # the date may have another form
        hours = np.timedelta64(round(3600 * float(header.get("forecastTime", 0))), "s")
        start = np.datetime64(header["refTime"].replace("Z", "")).astype("datetime64[s]")
        coordinates["time"] = start + hours
    unit = str(header.get("parameterUnit", "m/s")).replace("m.s-1", "m/s")
    values = np.array(data, dtype=float).reshape(rows, columns)
    return import_extra("xarray", "xarray").DataArray(
        values,
        coordinates,
        ("latitude", "longitude"),
        attrs={"standard_name": f"{name}_wind", "units": unit},
    )
