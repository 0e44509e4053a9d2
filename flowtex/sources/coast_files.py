"""Coasts of a user from GeoJSON, shapefiles, GeoPackages and GeoDataFrames, in any CRS."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator, Mapping
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util.arguments import brief, checked_source
from flowtex._util.array_types import Floats
from flowtex.errors import FieldError, import_extra
from flowtex.field.earth.coast import Coast

#: What ``coastlines`` may be, for messages.
EXPECTED = (
    "expected True, False, a GeoDataFrame or GeoSeries, or the path of a GeoJSON, shapefile or "
    "GeoPackage with lines or polygons"
)
#: Suffixes of files that need no other package.
GEOJSON = (".geojson", ".json")
#: The package that reads all other files.
READER = "geopandas"
#: The reference system of longitudes and latitudes.
LONLAT = "EPSG:4326"


def as_coast(source: Any) -> Any:
    """Return lines of a file or a GeoDataFrame as a :class:`Coast`, and other values as they are.

    Raises
    ------
    FieldError
        When the source cannot be read, or has no lines.
    ModuleNotFoundError
        When the package that reads the file is missing.
    """
    if source is None or isinstance(source, (bool, np.bool_, Coast)):
        return source
    if isinstance(source, (str, os.PathLike)):
        path = checked_source(source)
        if not path.is_file():
            fault = "is a folder"
            if not path.exists():
                fault = "does not exist"
            raise FieldError(
                f"coastlines is {str(source)!r}, which {fault}; expected True, False, or "
                "the path of a GeoJSON, shapefile or GeoPackage with lines or polygons"
            )
        return _read(str(path), path.stat().st_mtime_ns)
    if not hasattr(source, "__geo_interface__"):
        raise FieldError(f"coastlines is {brief(source)}; {EXPECTED}")
    return _of_frame(source, "coastlines")


@cache
def _read(path: str, _changed: int) -> Coast:
    """Return the coast of a file, which is read again when it has changed."""
    if Path(path).suffix.lower() not in GEOJSON:
        return _of_frame(_frame(path), path)
    try:
        content = json.loads(Path(path).read_text("utf-8-sig"))
    except (OSError, ValueError) as error:
        raise FieldError(f"{path}: cannot be read as GeoJSON ({error}); {EXPECTED}") from error
    lines = list(_lines_in(content))
    crs = None
    if isinstance(content, dict) and isinstance(content.get("crs"), dict):
        crs = content["crs"].get("properties", {}).get("name")
    return _coast(lines, crs, path)


def _frame(path: str) -> Any:
    """Return the GeoDataFrame of a file."""
    try:
        geopandas = import_module(READER)
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(
            f"{path}: this file needs {READER}; install it with python -m pip install {READER}, or "
            "convert the file to GeoJSON, as by ogr2ogr coast.geojson FILE",
            name=READER,
        ) from error
    try:
        return geopandas.read_file(path)
    except Exception as error:  # GDAL raises classes of its own
        text = " ".join(str(error).split())
        raise FieldError(f"{path}: cannot be read by {READER} ({text}); {EXPECTED}") from error


def _of_frame(frame: Any, name: str) -> Coast:
    """Return the coast of an object with geometry, such as a GeoDataFrame or a shape."""
    geometry = getattr(frame, "geometry", frame)
    lines = list(_lines_in(geometry.__geo_interface__))
    return _coast(lines, getattr(geometry, "crs", None), name)


def _coast(lines: list[Floats], crs: Any, name: str) -> Coast:
    """Return lines in any reference system as a coast."""
    if not lines:
        raise FieldError(f"{name}: there are no lines or polygons in it; {EXPECTED}")
    if crs is not None and not re.search("CRS84|4326", str(crs)):
        lines = _reprojected(lines, crs, name)
    ends = np.nanmax([np.abs(line).max(axis=0) for line in lines], axis=0)
    if not (ends[0] <= 360.0 and ends[1] <= 90.0):
        raise FieldError(
            f"{name}: positions reach {ends[0]:.6g} and {ends[1]:.6g}; expected longitudes and "
            'latitudes in degrees, or a CRS, as after gdf.set_crs("EPSG:3857")'
        )
    return Coast.of(lines)


def _reprojected(lines: list[Floats], crs: Any, name: str) -> list[Floats]:
    """Return lines in longitude and latitude, without places that have none."""
    pyproj = import_extra("pyproj", "xarray")
    try:
        change = pyproj.Transformer.from_crs(crs, LONLAT, always_xy=True)
    except pyproj.exceptions.CRSError as error:
        raise FieldError(f"{name}: the CRS {brief(str(crs))} is unknown ({error})") from error
    found = []
    for line in lines:
        lonlat = np.stack(change.transform(*line.T, errcheck=False), axis=-1)
        lonlat = lonlat[np.isfinite(lonlat).all(axis=1)]
        if len(lonlat) > 1:
            found.append(lonlat)
    if not found:
        raise FieldError(
            f"{name}: no line has a longitude and latitude by the CRS {brief(str(crs))}"
        )
    return found


def _lines_in(shape: Any) -> Iterator[Floats]:
    """Yield the lines and the borders of polygons in GeoJSON, (M, 2) each."""
    if not isinstance(shape, Mapping):
        return
    for part in (*_listed(shape.get("features")), *_listed(shape.get("geometries"))):
        yield from _lines_in(part)
    yield from _lines_in(shape.get("geometry"))
    depths = {"LineString": 1, "MultiLineString": 2, "Polygon": 2, "MultiPolygon": 3}
    depth = depths.get(str(shape.get("type")))
    if depth is not None:
        yield from _at_depth(shape.get("coordinates"), depth)


def _listed(value: Any) -> list[Any]:
    if isinstance(value, (list, tuple)):
        return list(value)
    return []


def _at_depth(coordinates: Any, depth: int) -> Iterator[Floats]:
    """Yield the lines in nested lists of coordinates."""
    if depth > 1:
        for part in _listed(coordinates):
            yield from _at_depth(part, depth - 1)
        return
    try:
        line = np.array([point[:2] for point in coordinates], dtype=float)
    except (TypeError, ValueError, IndexError) as error:
        raise FieldError(
            f"a line has the coordinates {brief(coordinates)}; expected pairs of numbers"
        ) from error
    if line.ndim == 2 and line.shape[1] == 2 and len(line) > 1:
        yield line
