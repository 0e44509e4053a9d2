"""Flows on the Earth for tests: the air turns with it, and an ocean has land in it."""

from __future__ import annotations

import numpy as np

from flowtex import FlowField
from flowtex.field.earth.projection import Projection


def winds(name: str = "globe", cells: int = 24) -> FlowField:
    """Return a flow around the axis all over the Earth, or up to 80 degrees on a map."""
    north = 90.0 if name == "globe" else 80.0
    # The edges of a map are at either side of the date line, and not the same line.
    east = 180.0 if name == "globe" else 179.999
    lon, lat = np.meshgrid(
        np.linspace(-east, east, 2 * cells + 1), np.linspace(-north, north, cells + 1)
    )
    projection = Projection(name)
    u = 10 * np.cos(np.radians(lat))
    return FlowField.from_arrays(
        projection.positions(lon, lat),
        projection.vectors(lon, lat, u, 0 * u),
        length_unit="m",
        time_unit="s",
        periodic="i",
        projection=projection,
    )


def ocean(name: str = "globe") -> FlowField:
    """Return a flow off the west of Africa, 20 degrees wide, that knows nothing of the land."""
    lon, lat = np.meshgrid(np.linspace(0, 20, 41), np.linspace(-30, -10, 41))
    projection = Projection(name, (10.0, -20.0), 10.0)
    u = np.where(lon > 12, np.nan, 1.0)
    return FlowField.from_arrays(
        projection.positions(lon, lat),
        projection.vectors(lon, lat, u, u),
        length_unit="m",
        time_unit="s",
        projection=projection,
    )
