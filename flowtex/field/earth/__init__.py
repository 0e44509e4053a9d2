"""The Earth: from longitude and latitude to a globe or a flat map, and back."""

from __future__ import annotations

from flowtex.field.earth.projection import (
    DEGREE,
    EARTH_RADIUS,
    GLOBE,
    NAMES,
    MapLines,
    Projection,
    ProjectionError,
    coastlines,
    graticule,
    place_text,
)

__all__ = [
    "DEGREE",
    "EARTH_RADIUS",
    "GLOBE",
    "NAMES",
    "MapLines",
    "Projection",
    "ProjectionError",
    "coastlines",
    "graticule",
    "place_text",
]
