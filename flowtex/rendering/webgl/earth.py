"""The Earth below a flow for a client: lines, land, longitude and latitude, and dates."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from flowtex._util.array_types import AnyArray, Floats, Floats32
from flowtex._util.cache import WeakCache
from flowtex._util.colours import rgb
from flowtex.field import FlowField
from flowtex.field.dates import date_text
from flowtex.field.earth.coast import Coast
from flowtex.field.earth.map_lines import MapLines
from flowtex.field.earth.projection import EARTH_RADIUS, Projection
from flowtex.rendering.map_overlay import (
    MISSING_SHARE,
    SPACING_PX,
    SPACINGS,
    STROKES,
    USUAL_HEIGHT_PX,
    WIDTH_RANGE,
    globe_radius,
    ground_cells,
    ground_kinds,
    map_box,
    map_lines,
)
from flowtex.rendering.webgl.protocol import Header, Parts
from flowtex.textures.geometry import DrawnSurface

LINE_STEPS = 65535  #: Steps that a side of the lines' box is divided into.
LONLAT_PLACES = 65  #: Most places with longitude and latitude along a side of a map.
NEAREST_PLACES_M = 5e4  #: Least distance of these places in metres.
FEWEST_PLACES = 4  #: Fewest places along a side: a cubic goes through so many.
ONWARD = (4.0, -6.0, 4.0, -1.0)  #: Weights by which four places in a row continue to the next.
MOST_ONWARD = 3  #: Lines of places that are continued so.


@dataclass(frozen=True, eq=False)
class _Lines:
    """Lines of a field as whole numbers of steps in a box, each point counted from the last."""

    low: Floats
    size: Floats
    parts: dict[str, AnyArray]


def earth_header(
    geometry: DrawnSurface, *, has_land: bool, coast: Coast | None = None
) -> Header | None:
    """Return the part of the header about the Earth; ``None`` for a flow that is elsewhere."""
    field = geometry.field
    if field.projection is None:
        return None
    is_globe = field.projection.is_globe
    lines = _lines_of(geometry, has_land=has_land, coast=coast)
    return {
        "radius": EARTH_RADIUS,
        "below": globe_radius(field) is not None,
        "low": lines.low.tolist(),
        "size": lines.size.tolist(),
        "map": None if is_globe else map_box(field)[:, :2].ravel().tolist(),
        "usualHeight": USUAL_HEIGHT_PX,
        "widthRange": WIDTH_RANGE,
        "missingShare": MISSING_SHARE,
        "kinds": ground_kinds(field, coast),
        "spacings": SPACINGS,
        "spacingPixels": SPACING_PX,
        "strokes": [
            {"option": option, **stroke._asdict(), "color": rgb(stroke.color)}
            for option, stroke in STROKES.items()
        ],
    }


def earth_parts(
    geometry: DrawnSurface, *, has_land: bool, tiled: bool, coast: Coast | None = None
) -> Parts:
    """Return the arrays of the Earth; tiles have none of their own."""
    field = geometry.field
    if field.projection is None or geometry.whole is not field.surface:
        return {}
    parts: Parts = dict(_lines_of(geometry, has_land=has_land, coast=coast).parts)
    if not field.projection.is_globe:
        parts["lonlat"] = _lonlat(field.projection, map_box(field).tobytes())
    ground = ground_cells(field, tiled=tiled, coast=coast)
    for name, cells in (("land", ground.land), ("missing", ground.missing)):
        if cells.any() and field.triangles is not None:
            parts[name] = field.triangles[cells].astype("<u4")
        elif cells.any():
            parts[name] = cells.astype(np.uint8)
    return parts


def dates_of(field: FlowField, times: Floats) -> Header:
    """Return the date at time 0 in ISO 8601, or all in another calendar, and the least step."""
    start = field.start
    if start is None:
        return {"start": None, "dates": [], "step": 0.0}
    if len(field.times) > 1:
        step = float(np.diff(field.times).min())
    else:
        step = 1.0
    if getattr(start, "calendar", "proleptic_gregorian") in ("proleptic_gregorian", "standard"):
        return {"start": start.isoformat()[:23], "dates": [], "step": step}
    dates = [date_text(start, float(time), step) for time in times]
    return {"start": None, "dates": dates, "step": step}


_lines: WeakCache[_Lines] = WeakCache()


def _lines_of(geometry: DrawnSurface, *, has_land: bool, coast: Coast | None) -> _Lines:
    field = geometry.field
    has_globe = has_land and globe_radius(field) is not None

    def make() -> _Lines:
        lines_by_option = map_lines(field, has_globe=has_globe, coast=coast)
        local = {}
        for k, v in lines_by_option.items():
            local[k] = (v.points - geometry.center) @ geometry.frame.T
        points = np.concatenate([*local.values(), np.zeros((1, 3))])
        low = points.min(axis=0)
        size = np.ptp(points, axis=0)
        parts = {}
        for name, lines in lines_by_option.items():
            if len(lines.points):
                parts[name] = _packed(lines, (local[name] - low) / np.where(size > 0, size, 1.0))
        return _Lines(low, size, parts)

    return _lines.get((has_globe, coast), make, owner=field)


def _packed(lines: MapLines, shares: Floats) -> AnyArray:
    """Return steps from each point to the next, and whether a line begins there, (N, 4) uint16."""
    steps = np.zeros((len(shares), 4), dtype=np.uint16)
    places = np.rint(shares * LINE_STEPS).astype(np.int64)
    steps[:, :3] = np.diff(places, axis=0, prepend=0) % (LINE_STEPS + 1)
    steps[lines.starts[:-1], 3] = 1
    return steps


@lru_cache(maxsize=8)
def _lonlat(projection: Projection, box: bytes) -> Floats32:
    """Return unit vectors (M, N, 3) to places spread over a map's box, continued beside it."""
    low, high = np.frombuffer(box).reshape(2, 3)[:, :2]
    spacing = max(float((high - low).max()) / (LONLAT_PLACES - 1), NEAREST_PLACES_M)
    counts = np.maximum(np.rint((high - low) / spacing).astype(int) + 1, FEWEST_PLACES)
    x = np.linspace(low[0], high[0], counts[0])
    y = np.linspace(low[1], high[1], counts[1])
    points = np.stack([*np.meshgrid(x, y), np.zeros((counts[1], counts[0]))], axis=-1)
    a, b = np.radians(projection.lonlat(points))
    directions = np.stack([np.cos(b) * np.cos(a), np.cos(b) * np.sin(a), np.sin(b)], axis=-1)
    for _ in range(MOST_ONWARD):
        for axis in (1, 0):
            for side in (1, -1):
                _continue(directions, axis, side)
    return directions.astype("<f4")


def _continue(directions: Floats, axis: int, side: int) -> None:
    """Extrapolate to unknown places next to four known ones in a row."""
    lines = np.moveaxis(directions, axis, 0)[::side]
    before = [lines[3 - n : len(lines) - 1 - n] for n in range(len(ONWARD))]
    onward = np.tensordot(ONWARD, before, axes=1)
    empty = np.isnan(lines[4:]) & np.isfinite(onward)
    lines[4:][empty] = onward[empty]
