"""Plain arrays as a field, for all functions that draw: by position, by name, or with labels.

:mod:`flowtex.field.plain_arrays` has the forms of the arrays. Dictionaries, such as those of
``numpy.load`` and ``scipy.io.loadmat``, and structured arrays have them by name. Positions on the
Earth, and scattered points, become a dataset, which the readers of datasets place.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.arguments import brief
from flowtex._util.array_types import AnyArray
from flowtex._util.host_arrays import host_array, is_array, unit_text
from flowtex.errors import FieldError, import_extra, notify
from flowtex.field import units
from flowtex.field.field import FlowField
from flowtex.field.matched_labels import matched
from flowtex.field.options import FieldOptions
from flowtex.field.plain_arrays import PlainFlow, are_named, fields_of, has_files, read_plain
from flowtex.field.validation import with_gaps
from flowtex.remedies import Remedy, sentence
from flowtex.sources.datasets.directions import BY_WORD, MEANINGS, MOST_RADIANS, SPEEDS
from flowtex.sources.datasets.directions import in_components as components_of
from flowtex.sources.datasets.own_values import with_values
from flowtex.sources.named_dataset import named_dataset
from flowtex.sources.opening.column_levels import as_array, has_positions
from flowtex.sources.read_fields import field_of_dataset

if TYPE_CHECKING:
    import xarray as xr

#: Arguments that have no meaning for arrays.
NOT_OF_ARRAYS = (
    *("plane", "slice", "contour", "block", "preference"),
    *("level", "sel", "isel", "dims", "mask"),
)
#: Names of the positions, in small letters.
PLACES = (("x", "y", "z"), ("x", "y"))
EARTH_PLACES = (("lon", "lat"), ("longitude", "latitude"))
#: Names of the components, in small letters.
VELOCITIES = (
    *(("u", "v", "w"), ("u", "v")),
    *(("vx", "vy", "vz"), ("vx", "vy"), ("ux", "uy")),
    ("velocity",),
)
#: Names of the places of points, (N, 2 or 3), and of their velocities, in small letters.
POINTS = ("points", "positions", "position", "pos", "coordinates", "coords", "xyz", "xy")
POINT_VELOCITIES = ("velocities", "velocity", "vel", "vectors")
TIMES = ("time", "times", "t")  #: Names of times, in small letters.


def is_plain(data: Any) -> bool:
    """Return whether data are arrays, by position or by name, without loading a library."""
    if isinstance(data, Mapping) or has_files(data):
        return any(is_array(data[name]) for name in data)
    if isinstance(data, tuple):
        return bool(data) and all(map(is_array, data))
    return is_array(data)


def are_labelled(data: Any) -> bool:
    """Return whether data are labelled arrays by position: ``u, v`` or ``x, y, u, v``.

    They are DataArrays, or two tables whose rows and columns are positions.
    """
    if not isinstance(data, tuple) or len(data) not in (2, 4):
        return False
    if len(data) == 2 and all(map(has_positions, data)):
        return True
    return all(type(item).__name__ == "DataArray" for item in data)


def read_arrays(data: Any, options: FieldOptions, scalars: Mapping[str, Any]) -> FlowField:
    """Return the field of plain arrays, with scalars of the same nodes.

    Raises
    ------
    FieldError
        When an argument is for other data, or names or shapes have no meaning.
    """
    options.refuse(NOT_OF_ARRAYS, "meshes, files and datasets, but these are arrays")
    if are_named(data):
        return _read_named(data, options, scalars)
    if options.vectors is not None:
        raise FieldError(f"vectors is {options.vectors!r}, but the arrays have no names; omit it")
    if isinstance(data, tuple):
        arrays = data
    else:
        arrays = (data,)
    if isinstance(options.direction, str):
        raise FieldError(
            f"direction is {options.direction!r}, but the arrays have no names; expected an array "
            "of angles, as in flowtex.show(x, y, speed, direction=angle)"
        )
    if options.direction is not None:
        *places, speed = arrays
        arrays = (*_positions(places), *in_components(speed, options.direction, options))
        options = _without_angle(options)
    return _field(read_plain(arrays), options, scalars)


def read_labelled(data: tuple[Any, ...], options: FieldOptions) -> FlowField:
    """Return the field of arrays ``u, v`` or ``x, y, u, v``, by their labels."""
    return field_of_dataset(*labelled_dataset(data, options))


def labelled_dataset(
    data: tuple[Any, ...], options: FieldOptions
) -> tuple[xr.Dataset, FieldOptions]:
    """Return arrays ``u, v`` or ``x, y, u, v`` as a dataset, and options with their names."""
    *places, u, v = data
    if has_positions(u):
        u = as_array(u)
        v = as_array(v)
    if None in (u.name, v.name) or u.name == v.name:
        u = u.rename("u")
        v = v.rename("v")
    ds: xr.Dataset = u.to_dataset().assign({v.name: v})
    for name, place in zip("xy", places, strict=False):
        ds = ds.assign_coords({place.name or name: place})
    if options.vectors is None:
        options = replace(options, vectors=f"{u.name},{v.name}")
    return ds, options


def _field(
    flow: PlainFlow,
    options: FieldOptions,
    scalars: Mapping[str, Any],
    *,
    on_earth: bool = False,
) -> FlowField:
    if options.max_edge is not None and not flow.scattered:
        raise FieldError("max_edge applies to scattered points, but the arrays are a grid; omit it")
    on_earth = on_earth or options.projection is not None or bool(options.globe)
    if on_earth or flow.scattered or options.components is not None:
        return _labelled_field(flow, options, scalars, on_earth=on_earth)
    return FlowField.from_arrays(
        flow.points,
        flow.velocity,
        times=options.times,
        periodic=options.periodic,
        sign_free=bool(options.sign_free),
        scalars=scalars,
        length_unit=options.length_unit or flow.length_unit,
        time_unit=options.time_unit or "",
        velocity_unit=options.velocity_unit or flow.velocity_unit,
    )


def _labelled_field(
    flow: PlainFlow, options: FieldOptions, scalars: Mapping[str, Any], *, on_earth: bool
) -> FlowField:
    """Return the field of arrays that a reader of datasets or tables places."""
    data: Any = _dataset(flow, options.times, scalars, on_earth=on_earth)
    if flow.scattered:
        # Rows of a lattice in any order become a grid.
        data = _table_of(data)
    chosen = replace(options, vectors="u,v", times=None)
    if on_earth and options.components is None:
        chosen = replace(chosen, components="earth")
    return field_of_dataset(data, replace(chosen, uncertainty=None))


def _positions(places: list[Any]) -> tuple[Any, ...]:
    """Return x and y of the arrays before a speed."""
    if len(places) == 1 and isinstance(places[0], tuple):
        return places[0]
    if len(places) in (0, 2):
        return tuple(places)
    raise FieldError(
        f"{len(places) + 1} arrays are given beside direction; expected a speed, or x, y and a "
        "speed, as in flowtex.show(x, y, speed, direction=angle)"
    )


def in_components(speed: Any, angle: Any, options: FieldOptions) -> tuple[AnyArray, AnyArray]:
    """Return the components of a speed along angles, by default counterclockwise from x.

    Angles without a unit that are all within 2π are radians, others degrees.

    Raises
    ------
    FieldError
        When the shapes differ, or ``components`` is for components.
    """
    speed, angle = matched(("speed", "direction"), (speed, angle))
    length = host_array("the speed", speed)
    turn = host_array("direction", angle)
    if np.iscomplexobj(length) or np.iscomplexobj(turn) or length.shape != turn.shape:
        raise FieldError(
            f"the speed has shape {length.shape} and direction {turn.shape}; expected one shape, "
            "and real numbers"
        )
    word = options.components
    if word is None:
        word = "angle"
        text = "direction is an angle counterclockwise from x, as nothing says otherwise"
        goes = Remedy("components", "to", f"if it is {MEANINGS['to']},")
        comes = Remedy("components", "from", f"if it is {MEANINGS['from']},")
        notify(sentence(text, (goes, comes)), remedies=(goes, comes))
    if word not in BY_WORD:
        expected = ", ".join(f"{key!r} ({words})" for key, words in MEANINGS.items())
        raise FieldError(f"components is {word!r} beside direction; expected {expected}")
    unit = unit_text(angle) or "degree"
    if not unit_text(angle) and np.nanmax(np.abs(turn), initial=0.0) <= MOST_RADIANS:
        unit = "radian"
    factor = units.factor(unit, "radian")
    if factor is None:
        raise FieldError(f"direction has the unit {unit!r}; expected degrees or radians")
    return components_of(BY_WORD[word], length, turn * factor, None)


def _without_angle(options: FieldOptions) -> FieldOptions:
    """Return the options of components that a speed and its angles gave."""
    return replace(options, direction=None, components=None)


def _dataset(
    flow: PlainFlow, times: Any, scalars: Mapping[str, Any], *, on_earth: bool
) -> xr.Dataset:
    """Return a dataset of arrays on x and y, or on longitude and latitude in degrees."""
    xarray = import_extra("xarray", "xarray")
    points = flow.points
    if not isinstance(points, tuple):
        points = tuple(np.moveaxis(points, -1, 0))
    if len(points) != 2:
        raise FieldError(
            f"{len(points)} positions are given; expected two, longitude and latitude, or x and y"
        )
    if on_earth:
        names = ("lon", "lat")
    else:
        names = ("x", "y")
    one, other = (with_gaps(name, part) for name, part in zip(names, points, strict=True))
    if flow.scattered:
        dims: tuple[str, ...] = ("point",)
        coordinates = {names[0]: (dims, one), names[1]: (dims, other)}
    elif one.ndim == 1:
        dims = names[::-1]
        coordinates = {names[0]: ((names[0],), one), names[1]: ((names[1],), other)}
    else:
        dims = ("j", "i")
        coordinates = {names[0]: (dims, one), names[1]: (dims, other)}
    velocity = with_gaps("velocity", flow.velocity)
    series = ("time", *dims)
    arrays = {"u": velocity[..., 0], "v": velocity[..., 1], **scalars}
    variables = {}
    for name, array in arrays.items():
        values = with_gaps(name, array)
        variables[name] = series[-values.ndim :], values
    ds = xarray.Dataset(variables, coordinates)
    if times is not None:
        ds = ds.assign_coords(time=("time", host_array("times", times)))
    for name in "uv":
        ds[name].attrs["units"] = flow.velocity_unit
    place_units = ("degrees_east", "degrees_north") if on_earth else (flow.length_unit,) * 2
    for name, unit in zip(names, place_units, strict=True):
        ds[name].attrs["units"] = unit
    return ds


def _table_of(points: xr.Dataset) -> Any:
    """Return points as a table, whose columns are named with their units."""
    columns = {}
    for name, array in points.reset_coords().items():
        if array.attrs.get("units"):
            unit = array.attrs["units"]
        else:
            unit = ""
        columns[str(name)] = f"{name} [{unit}]" if unit else str(name)
    frame: Any = points.reset_coords().to_dataframe().reset_index(drop=True)
    return frame.rename(columns=columns)


def _read_named(data: Any, options: FieldOptions, scalars: Mapping[str, Any]) -> FlowField:
    """Return the field of arrays by name; other arrays of the same nodes are scalars."""
    keys = [str(key) for key in fields_of(data) or data]
    known: dict[str, str] = {}
    for key in keys:
        if is_array(data[key]):
            known.setdefault(key.lower(), key)
    if len({np.shape(data[key]) for key in known.values()}) == 1 and np.ndim(data[keys[0]]) == 1:
        frame = _frame_of(data, list(known.values()))
        return field_of_dataset(frame, replace(options, uncertainty=None))
    columns = _columns_of_points(data, known, options.vectors)
    if columns:
        frame = import_extra("pandas", "xarray").DataFrame(columns)
        return field_of_dataset(frame, replace(options, vectors=None, uncertainty=None))
    lon_lat = _first(EARTH_PLACES, known)
    places = _first(PLACES, known) or lon_lat
    velocity = _velocity_names(options, known)
    if not velocity:
        return _read_by_other_names(data, places, known, options, scalars)
    parts = [data[key] for key in velocity]
    if options.direction is not None:
        parts = list(in_components(*_speed_and_angle(data, velocity, options), options))
        options = _without_angle(options)
    flow = read_plain(_by_position([data[key] for key in places], parts))
    shape = np.shape(flow.velocity)[:-1]
    nodal = {}
    for key in known.values():
        if key not in (*places, *velocity) and np.shape(data[key]) in (shape, shape[-2:]):
            nodal[key] = data[key]
    times = _times_of(data, known, options, shape[:-2])
    options = replace(options, vectors=None, times=times)
    on_earth = bool(places) and places == lon_lat
    return _field(flow, options, {**nodal, **scalars}, on_earth=on_earth)


def _read_by_other_names(
    data: Any,
    places: tuple[str, ...],
    known: Mapping[str, str],
    options: FieldOptions,
    scalars: Mapping[str, Any],
) -> FlowField:
    """Return the field of arrays whose components have names that datasets have, such as u10."""
    ds = None
    if places:
        times = _times_of(data, known, options)
        ds = named_dataset(data, places, known.values(), times)
    if ds is None:
        raise FieldError(
            f"the arrays are named {', '.join(known.values())}; expected x, y, u and v. Name the "
            "components, as in vectors='vx,vy', or pass the arrays by position: x, y, u, v"
        )
    for name, values in scalars.items():
        ds = with_values(ds, name, values, "scalars")
    return field_of_dataset(ds, replace(options, times=None, uncertainty=None))


def _times_of(
    data: Any, known: Mapping[str, str], options: FieldOptions, steps: tuple[int, ...] | None = None
) -> Any:
    """Return the times that the user gives, or those among the arrays, (T,); ``None`` without any.

    ``steps`` is the shape (T,) that they have, where it is known.
    """
    if options.times is not None:
        return options.times
    for name, key in known.items():
        count = np.size(data[key])
        # Files of MATLAB have lines as (1, N) or (N, 1).
        is_line = count == max(np.shape(data[key]), default=0)
        if name in TIMES and is_line and steps in (None, (count,)):
            return host_array(name, data[key]).ravel()
    return None


def _frame_of(data: Any, names: list[str]) -> Any:
    """Return arrays (N,) by name as the columns of a table, in one order of their labels."""
    arrays = matched(names, [data[name] for name in names])
    columns = {}
    for name, array in zip(names, arrays, strict=True):
        columns[name] = host_array(name, array)
    return import_extra("pandas", "xarray").DataFrame(columns)


def _columns_of_points(
    data: Any, known: Mapping[str, str], vectors: str | None
) -> dict[str, AnyArray]:
    """Return the columns of points (N, 2 or 3) and their vectors; empty for other arrays."""
    places = _first_shaped(data, known, POINTS)
    names: tuple[str, ...] = POINT_VELOCITIES
    if vectors is not None:
        names = (vectors.lower(),)
    velocity = _first_shaped(data, known, names)
    if not places or not velocity or len(data[places]) != len(data[velocity]):
        return {}
    columns = {}
    for key, letters in ((places, "xyz"), (velocity, "uvw")):
        values = host_array(key, data[key])
        unit = unit_text(data[key])
        for letter, column in zip(letters, values.T, strict=False):
            columns[f"{letter} [{unit}]" if unit else letter] = column
    for key in known.values():
        if key not in columns and np.shape(data[key]) == (len(data[places]),):
            columns[key] = host_array(key, data[key])
    return columns


def _first_shaped(data: Any, known: Mapping[str, str], names: Iterable[str]) -> str:
    """Return the first of several names of an array (N, 2 or 3); empty without one."""
    for name in names:
        key = known.get(name, "")
        if key and np.ndim(data[key]) == 2 and np.shape(data[key])[1] in (2, 3):
            return key
    return ""


def _by_position(places: list[Any], velocity: list[Any]) -> tuple[Any, ...]:
    """Return arrays in the form that the numbers of positions and components allow."""
    if len(velocity) == 2:
        return (*places[:2], *velocity)
    if len(velocity) == 1:
        joined = velocity[0]
    else:
        joined = list(map(np.asanyarray, velocity))
    if not places:
        return (joined,)
    return (tuple(places), joined)


def _speed_and_angle(data: Any, names: tuple[str, ...], options: FieldOptions) -> tuple[Any, Any]:
    """Return the arrays of a speed and its direction, which the user names or gives."""
    if isinstance(options.direction, str):
        return data[names[0]], data[names[-1]]
    return data[names[0]], options.direction


def _velocity_names(options: FieldOptions, known: Mapping[str, str]) -> tuple[str, ...]:
    """Return the names of the components, those that the user names first."""
    vectors = options.vectors
    if vectors is None and options.direction is not None:
        return _speed_names(options.direction, known)
    if vectors is None:
        return _first(VELOCITIES, known)
    names = tuple(name.strip() for name in vectors.split(","))
    missing = [name for name in names if name not in known.values()]
    if missing:
        raise FieldError(
            f"vectors is {vectors!r}, and there is no array {missing[0]!r}; expected names among "
            f"{', '.join(known.values())}"
        )
    return names


def _speed_names(direction: Any, known: Mapping[str, str]) -> tuple[str, ...]:
    """Return the name of the only speed, and that of its direction if this is a name as well."""
    speeds = list(filter(SPEEDS.search, known.values()))
    if isinstance(direction, str) and direction in speeds:
        speeds.remove(direction)
    if len(speeds) != 1:
        raise FieldError(
            f"direction is {brief(direction)}; name the speed as well, as in "
            'vectors="speed", direction="angle"'
        )
    if not isinstance(direction, str):
        return (speeds[0],)
    if direction not in known.values():
        raise FieldError(
            f"direction is {direction!r}, and there is no such array; expected a name among "
            f"{', '.join(known.values())}"
        )
    return speeds[0], direction


def _first(choices: Iterable[tuple[str, ...]], known: Mapping[str, str]) -> tuple[str, ...]:
    """Return the first of several groups of names that all exist, as they are spelt."""
    for names in choices:
        if all(name in known for name in names):
            return tuple(known[name] for name in names)
    return ()
