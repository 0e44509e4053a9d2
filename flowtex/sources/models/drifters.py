"""Trajectories as points with velocities at one time.

At a time each trajectory has a point, between two of its observations. The velocity is that of the
data, or the difference of positions in time.
"""

from __future__ import annotations

from datetime import datetime, timedelta
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from flowtex._util.array_types import Floats, Indices
from flowtex.errors import FieldError, import_extra
from flowtex.field.dates import span_since
from flowtex.field.earth.projection import EARTH_RADIUS
from flowtex.remedies import Remedy
from flowtex.sources.datasets.axes import TIME, Choice, typed_value
from flowtex.sources.datasets.coordinates import LONGITUDE
from flowtex.sources.datasets.select import find_pairs
from flowtex.sources.models.conventions import with_points
from flowtex.sources.models.scattered import FEWEST
from flowtex.sources.models.trajectories import Tracks, find_trajectories
from flowtex.sources.notices import Record

if TYPE_CHECKING:
    import xarray as xr

#: Length of a gap, in median intervals of a trajectory, from which on nothing is known within it.
GAP = 5.0
#: Most times among which the one with most trajectories is searched.
MOST_TIMES = 2000
#: Most times that the app lists.
MOST_LISTED = 200
#: Names of the differences of positions in time, in the unit of the positions.
MOTION = ("x_change", "y_change")


def as_points(ds: xr.Dataset, choice: Choice, record: Record) -> xr.Dataset:
    """Return trajectories as points at the chosen time, and other datasets as they are.

    The choice is marked as used.

    Raises
    ------
    FieldError
        When few trajectories have a position at the time.
    """
    parts = find_trajectories(ds)
    if parts is None:
        return ds
    tracks = Tracks.of(ds, parts)
    time = _chosen_time(tracks, (TIME, str(parts.time.name)), choice)
    remedies = []
    reason = ""
    if time is None:
        time = _fullest_time(tracks)
        reason = ", which most have"
        other = _fullest_time(tracks, without=time)
        if other != time:
            remedies = [Remedy("sel", {TIME: _typed_time(tracks, other)})]
    points = _points_at(tracks, time)
    count = len(points[tracks.names[0]])
    when = _word(tracks, time)
    if count < FEWEST:
        raise FieldError(
            f"{count} of {tracks.count:,} trajectories have a position at {when}; expected at "
            f"least {FEWEST}. Choose another time, or average the velocities of all times in "
            "boxes: df = ds.to_dataframe(), and flowtex.show(df.groupby([df.lat.round(), "
            'df.lon.round()])[["u", "v"]].mean())'
        )
    text = f"{count:,} of {tracks.count:,} trajectories have a position at {when}{reason}"
    record("select", text, *remedies, notable=bool(reason))
    return _dataset(points, tracks, time, record)


def _chosen_time(tracks: Tracks, names: tuple[str, ...], choice: Choice) -> float | None:
    """Return the time that a choice names; ``None`` without one."""
    for name in names:
        if name in choice.isel:
            choice.used.add(name)
            return _time_by_number(tracks, name, choice.isel[name])
        if name in choice.sel:
            choice.used.add(name)
            return _time_by_value(tracks, name, choice.sel[name])
    return None


def _time_by_number(tracks: Tracks, name: str, number: Any) -> float:
    times = np.unique(tracks.times)
    count = len(times)
    if not isinstance(number, (int, np.integer)) or not -count <= number < count:
        raise FieldError(f"{name} has index {number!r} of {count}; expected 0 to {count - 1}")
    return float(times[number])


def _time_by_value(tracks: Tracks, name: str, value: Any) -> float:
    """Return the time of a date, the first of a day, or of a number."""
    low = float(tracks.times.min())
    high = float(tracks.times.max())
    try:
        begin = end = float("nan")
        if tracks.origin is None:
            begin = end = float(value)
        else:
            begin, end = span_since(tracks.origin, value)
    except (TypeError, ValueError, AttributeError):
        pass
    if begin < low <= end:
        begin = low
    if not low <= begin <= high:
        ends = f"{_word(tracks, low)} to {_word(tracks, high)}"
        raise FieldError(f"{name} is {value!r}; expected one time from {ends}")
    return begin


def _fullest_time(tracks: Tracks, without: float | None = None) -> float:
    """Return the first of the observed times that most trajectories span.

    The time ``without`` is returned only if there is no other.
    """
    times, counts = _counted_times(tracks)
    counts = np.where(times == without, -1, counts)
    return float(times[np.argmax(counts)])


def _counted_times(tracks: Tracks) -> tuple[Floats, Indices]:
    """Return observed times, (N,), and how many trajectories span each of them."""
    begins = np.sort(tracks.times[tracks.first[:-1]])
    ends = np.sort(tracks.times[tracks.first[1:] - 1])
    times = np.unique(tracks.times)
    times = times[:: -(-len(times) // MOST_TIMES)]
    begun = np.searchsorted(begins, times, side="right")
    ended = np.searchsorted(ends, times, side="left")
    return times, begun - ended


def moments_of(ds: xr.Dataset) -> tuple[list[Any], int]:
    """Return times at which trajectories can be drawn, and the number of the fullest one.

    They are observed times with enough trajectories, as users type them; none for other data.
    """
    parts = find_trajectories(ds)
    if parts is None:
        return [], 0
    tracks = Tracks.of(ds, parts)
    fullest = _fullest_time(tracks)
    times, counts = _counted_times(tracks)
    chosen = times[counts >= FEWEST]
    chosen = chosen[:: max(-(-len(chosen) // MOST_LISTED), 1)]
    chosen = np.union1d(chosen, fullest)
    moments = [_typed_time(tracks, float(time)) for time in chosen]
    return moments, int(np.searchsorted(chosen, fullest))


def _typed_time(tracks: Tracks, time: float) -> Any:
    """Return a time as users type it."""
    if tracks.origin is None:
        return typed_value(time)
    return _word(tracks, time).replace(" ", "T")


def _word(tracks: Tracks, time: float) -> str:
    """Return a time as text."""
    if tracks.origin is None:
        return f"time {time:g} {tracks.unit}".strip()
    moment = tracks.origin + timedelta(seconds=time)
    return str(moment.isoformat(timespec="minutes")).replace("T", " ")


def _moment(tracks: Tracks, time: float) -> Any:
    """Return a time as a date of the calendar."""
    moment = tracks.origin + timedelta(seconds=time)
    if isinstance(moment, datetime):
        return np.datetime64(moment, "ns")
    return np.array(moment, dtype=object)


def _points_at(tracks: Tracks, time: float) -> dict[str, Floats]:
    """Return the values of all columns at a time, and the motion, of trajectories that have it."""
    rows = []
    for begin, end in zip(tracks.first[:-1], tracks.first[1:], strict=True):
        times = tracks.times[begin:end]
        if times[0] <= time <= times[-1]:
            after = max(int(np.searchsorted(times, time)), 1)
            intervals = np.diff(times)
            is_gap = len(times) > 1 and intervals[after - 1] > GAP * np.median(intervals)
            is_observed = times[after - 1] == time or (after < len(times) and times[after] == time)
            if is_observed or not is_gap:
                rows.append(_row_at(tracks, slice(begin, end), time))
    values = np.array(rows, dtype=float).reshape(len(rows), len(tracks.columns) + 2)
    return dict(zip([*tracks.columns, *MOTION], values.T, strict=True))


def _row_at(tracks: Tracks, rows: slice, time: float) -> list[float]:
    """Return the values of one trajectory at a time, and the changes of its position."""
    times = tracks.times[rows]
    lines = {name: column[rows] for name, column in tracks.columns.items()}
    if _is_longitude(tracks):
        longitude = tracks.names[0]
        lines[longitude] = np.unwrap(lines[longitude], period=360.0)
    values = [float(np.interp(time, times, line)) for line in lines.values()]
    changes = [_change_at(times, lines[name], time) for name in tracks.names]
    return [*values, *changes]


def _change_at(times: Floats, line: Floats, time: float) -> float:
    """Return the derivative of a coordinate at a time, from the differences of observations."""
    times, kept = np.unique(times, return_index=True)
    if len(times) < 2:
        return np.nan
    order: Literal[1, 2] = 1
    if len(times) > 2:
        order = 2
    slopes = np.asarray(np.gradient(line[kept], times, edge_order=order))
    return float(np.interp(time, times, slopes))


def _is_longitude(tracks: Tracks) -> bool:
    name = tracks.names[0]
    attrs = tracks.attributes[name]
    return bool(LONGITUDE.match(name)) or attrs.get("standard_name") == "longitude"


def _dataset(points: dict[str, Floats], tracks: Tracks, time: float, record: Record) -> xr.Dataset:
    """Return points as a dataset, with the velocity by differences if there is no other."""
    xarray = import_extra("xarray", "xarray")
    columns: dict[str, Any]
    columns = {name: ("point", points[name], tracks.attributes[name]) for name in tracks.columns}
    places = {name: columns.pop(name) for name in tracks.names}
    if tracks.origin is not None:
        places[TIME] = ((), _moment(tracks, time), {})
    ds = xarray.Dataset(columns, places)
    if find_pairs(with_points([ds])):
        return ds
    text = "the velocity is the difference of positions in time, as the data have no other"
    record("select", text, notable=True)
    return ds.assign(_motion(points, tracks))


def _motion(points: dict[str, Floats], tracks: Tracks) -> dict[str, Any]:
    """Return the velocity from the changes of the positions."""
    first, second = (points[name] for name in MOTION)
    if not _is_longitude(tracks):
        length = str(tracks.attributes[tracks.names[0]].get("units", ""))
        unit = ""
        if length and tracks.unit:
            unit = f"{length}/{tracks.unit}"
        attrs = {"units": unit}
        return {"x_velocity": ("point", first, attrs), "y_velocity": ("point", second, attrs)}
    latitude = np.radians(points[tracks.names[1]])
    east = EARTH_RADIUS * np.radians(first) * np.cos(latitude)
    north = EARTH_RADIUS * np.radians(second)
    attrs = {"units": "m/s"}
    return {
        "eastward_velocity": ("point", east, attrs),
        "northward_velocity": ("point", north, attrs),
    }
