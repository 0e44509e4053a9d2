"""Winds and currents of web maps: JSON of the components with a header each.

The form is that of grib2json, which leaflet-velocity and earth read: a list of records, each with
``header`` (``nx``, ``ny``, ``lo1``, ``la1``, ``dx``, ``dy``, ``parameterNumber`` 2 for eastward and
3 for northward) and ``data``, rows from north to south.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.extras import import_extra
from flowtex.errors import FieldError
from flowtex.sources.inspection.limits import check_count, check_memory
from flowtex.sources.opening.tables import TEXT_GROWTH, of_features

if TYPE_CHECKING:
    import xarray as xr

#: Names of the components by the number of the parameter.
NUMBERS = {2: "u", 3: "v"}
WORDS = {"u": "eastward_wind", "v": "northward_wind"}


def read_winds(path: Path) -> xr.Dataset:
    """Read the components of the first level and time."""
    xarray = import_extra("xarray", "xarray")
    try:
        check_memory(TEXT_GROWTH * path.stat().st_size, "the file")
        records = json.loads(path.read_text(encoding="utf-8"))
    except FieldError:
        raise
    except (ValueError, RecursionError) as error:
        msg = f"it is not valid JSON ({error})"
        raise FieldError(msg) from error
    if isinstance(records, dict) and records.get("type") == "FeatureCollection":
        return of_features(records)
    if not isinstance(records, list) or not all(isinstance(r, dict) for r in records):
        msg = (
            "it is not a list of records with header and data, as used by leaflet-velocity and "
            "earth"
        )
        raise FieldError(msg)
    components: dict[str, Any] = {}
    for record in records:
        header = record.get("header")
        header = header if isinstance(header, dict) else {}
        name = NUMBERS.get(header.get("parameterNumber", 0))
        if name and name not in components:
            components[name] = _component(xarray, header, record.get("data"), name)
    if len(components) < 2:
        missing = " and ".join(n for n in WORDS if n not in components)
        msg = f"the record of the component {missing} is missing (parameterNumber 2 and 3)"
        raise FieldError(msg)
    try:
        merged: xr.Dataset = xarray.merge(list(components.values()), join="exact")
    except ValueError as error:
        msg = f"the two components have different grids ({error})"
        raise FieldError(msg) from error
    return merged


def _component(xarray: Any, header: dict[str, Any], data: Any, name: str) -> Any:
    """Return one record as an array on latitude and longitude."""
    try:
        columns, rows = int(header["nx"]), int(header["ny"])
        if min(columns, rows) < 1:
            msg = f"nx is {columns} and ny {rows} of the component {name}; expected 1 or more"
            raise FieldError(msg)
        check_count(len(data), columns * rows, f"the component {name}", "numbers")
        lon = float(header["lo1"]) + abs(float(header["dx"])) * np.arange(columns)
        south = -1.0 if float(header["la1"]) >= float(header.get("la2", -90.0)) else 1.0
        lat = float(header["la1"]) + south * abs(float(header["dy"])) * np.arange(rows)
        values = np.array([np.nan if v is None else v for v in data], dtype=float)
        values = values.reshape(rows, columns)
    except FieldError:
        raise
    except (KeyError, TypeError, ValueError, OverflowError) as error:
        msg = f"the record of the component {name} is damaged ({error})"
        raise FieldError(msg) from error
    coordinates: dict[str, Any] = {
        "latitude": ("latitude", lat, {"units": "degrees_north"}),
        "longitude": ("longitude", lon, {"units": "degrees_east"}),
    }
    if isinstance(header.get("refTime"), str):
        try:
            start = np.datetime64(header["refTime"].replace("Z", ""))
            hours = np.timedelta64(round(3600 * float(header.get("forecastTime", 0))), "s")
            coordinates["time"] = start.astype("datetime64[s]") + hours
        except ValueError:
            pass  # the date has another form
    unit = str(header.get("parameterUnit", "m/s")).replace("m.s-1", "m/s")
    attributes = {"standard_name": WORDS[name], "units": unit}
    dims = ("latitude", "longitude")
    return xarray.DataArray(values, coordinates, dims, name, attributes)
