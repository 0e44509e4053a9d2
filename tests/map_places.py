"""Places of flat maps, and what is drawn there, by the plainest search."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyproj
import xarray as xr
from earth_data import DEGREES, components

from flowtex import FlowField
from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.field.triangles.triangle_surface import TriangleSurface


def turned_frame(lon_0: float, lat_p: float) -> Any:
    """Change of longitudes and latitudes around another pole into those of the Earth."""
    frame = f"+proj=ob_tran +o_proj=longlat +o_lon_p=0 +o_lat_p={lat_p} +lon_0={lon_0} +R=1"
    return pyproj.Transformer.from_crs(frame, "+proj=longlat +R=1", always_xy=True)


def winds(lon: Floats, lat: Floats) -> xr.Dataset:
    """The rotation on lines, or at places (J, I)."""
    is_line = lon.ndim == 1
    u, v = components(*np.meshgrid(lon, lat)) if is_line else components(lon, lat)
    dims = ("lat", "lon") if is_line else ("y", "x")
    named = {"units": "m s-1"}
    return xr.Dataset(
        {
            "u": (dims, u, {"standard_name": "eastward_wind", **named}),
            "v": (dims, v, {"standard_name": "northward_wind", **named}),
        },
        {
            "lon": (dims[1:] if is_line else dims, lon, DEGREES["lon"]),
            "lat": (dims[:1] if is_line else dims, lat, DEGREES["lat"]),
        },
    )


def drawn_triangles(field: FlowField) -> Indices:
    """Return the nodes of the drawn triangles, or of two in each drawn cell, (M, 3)."""
    if isinstance(field.surface, TriangleSurface):
        return field.surface.corners_of(field.surface.drawn)
    j, i = np.nonzero(field.surface.cells)
    columns = field.shape[1]
    a = j * columns + i
    halves = (a, a + 1, a + columns + 1), (a, a + columns + 1, a + columns)
    return np.concatenate([np.stack(half, axis=-1) for half in halves])


def drawn_at(field: FlowField, places: Floats) -> tuple[Bools, Floats]:
    """Return which places (P, 2) are drawn, and the vectors there, NaN elsewhere."""
    corners = drawn_triangles(field)
    points = field.points.reshape(-1, 3)[corners, :2]
    nodal = np.asarray(field.velocity[0]).reshape(-1, 3)[corners, :2]
    (a, b, c), (va, vb, vc) = np.moveaxis(points, 1, 0), np.moveaxis(nodal, 1, 0)

    def cross(p: Floats, q: Floats) -> Floats:
        return np.asarray(p[..., 0] * q[..., 1] - p[..., 1] * q[..., 0])

    found, vectors = np.zeros(len(places), bool), np.full((len(places), 2), np.nan)
    low, high = np.min([a, b, c], axis=0), np.max([a, b, c], axis=0)
    for n, p in enumerate(places):
        near = np.flatnonzero(((low <= p) & (p <= high)).all(axis=1))
        u, v, d = b[near] - a[near], c[near] - a[near], p - a[near]
        with np.errstate(invalid="ignore", divide="ignore"):
            s, t = cross(d, v) / cross(u, v), cross(u, d) / cross(u, v)
        for k in np.flatnonzero((s >= 0) & (t >= 0) & (s + t <= 1))[:1]:
            m, found[n] = near[k], True
            vectors[n] = (1 - s[k] - t[k]) * va[m] + s[k] * vb[m] + t[k] * vc[m]
    return found, vectors
