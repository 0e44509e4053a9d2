"""The Earth behind a field that has a projection: lines, land, and the globe below."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import scipy

from flowtex._util.array_types import Bools, Floats
from flowtex._util.arrays import bounds, norm
from flowtex._util.cache import WeakCache
from flowtex._util.colours import is_light, rgb
from flowtex.field import FlowField
from flowtex.field.earth.coast import Coast
from flowtex.field.earth.map_lines import MapLines, coastlines, graticule
from flowtex.field.earth.on_land import on_land
from flowtex.field.earth.projection import EARTH_RADIUS
from flowtex.field.validation import NO_DATA


@dataclass(frozen=True, eq=False)
class Ground:
    """Cells without data, in the shape of a field's cells."""

    land: Bools
    missing: Bools  #: Those at sea.


class Stroke(NamedTuple):
    """How a line is drawn: its colour, opacity, and width in pixels."""

    color: str
    opacity: float
    width: float


#: Lines by their options, from below to above.
STROKES = {"graticule": Stroke("black", 0.4, 1.0), "coastlines": Stroke("black", 0.8, 1.1)}
USUAL_HEIGHT_PX = 600  #: Height of a picture in which lines have their width.
WIDTH_RANGE = (0.6, 2.0)  #: Range of the factor by which the width changes with the height.
SPACINGS = (200e3, 80e3, 20e3, 0.0)  #: Distances of the points of lines in metres.
SPACING_PX = 2.0  #: Most pixels between two points of a line.
WIDER = 1e-3  #: Share of the extent by which the box of a map is wider than its surface.
#: Share of black or white, whichever differs more, in the colour of places without data at sea.
MISSING_SHARE = 0.1
MOST_ASKED = 200_000  #: Most cells of a grid that are looked up on the coasts.
FRINGE = 2  #: Cells across up to which a strip beside land is land.
LAND = "land"  #: What a legend says of land without data.
LOWER = 1e-5  #: Distance of the globe below the surface and the sagitta of its cells, in radii.


_grounds: WeakCache[Ground] = WeakCache()


def map_box(field: FlowField) -> Floats:
    """Return the slightly widened bounds of the nodes, also of those on land, (2, 3)."""
    surface = field.surface
    box = bounds(surface.points[surface.has_position])
    margin = WIDER * np.ptp(box, axis=0).max()
    return np.asarray(box + np.array([[-margin], [margin]]))


def map_lines(
    field: FlowField, *, has_globe: bool, coast: Coast | None = None
) -> dict[str, MapLines]:
    """Return coasts and graticule by the names of the options that show them.

    Around a field that covers a part of the Earth, lines are cut where its cells end. If the rest
    of the globe is drawn (``has_globe``), they go around it. The lines of a ``coast`` replace the
    coasts.
    """
    projection = field.projection
    box = map_box(field)
    if projection is None:
        return {}
    if field.surface.is_closed:  # which has no border
        whole = coastlines(projection, coast=coast)
        return {"coastlines": whole, "graticule": graticule(projection, box)}
    middles, reach = _cells(field)
    tree = scipy.spatial.cKDTree(middles)

    def are_in_cells(lines: MapLines) -> Bools:
        distances, nearest = tree.query(lines.points)
        # A point of the graticule may be a node, whose distance is the reach, up to rounding.
        return np.asarray(distances <= (1 + 1e-6) * reach[nearest])

    fine = graticule(projection, box)
    fine_graticule = fine.within(are_in_cells(fine))
    if not has_globe:
        coasts = coastlines(projection, box, coast)
        cut_coasts = coasts.within(are_in_cells(coasts))
        return {"coastlines": cut_coasts, "graticule": fine_graticule}
    whole = graticule(projection)
    # A line of both would be drawn twice, and darker.
    around = whole.within(~are_in_cells(whole))
    coasts = coastlines(projection, coast=coast)
    return {"coastlines": coasts, "graticule": around.and_(fine_graticule)}


def ground_cells(field: FlowField, *, tiled: bool = False, coast: Coast | None = None) -> Ground:
    """Return which cells without data are land and which only lack data; see empty_cells.

    Coasts decide, or lines of the user that close, see :func:`on_land`. Masks of models do not
    match them exactly: what lies within a cell or two of land is land as well.
    """
    if coast is not None and not coast.is_closed:
        coast = None
    make = partial(_ground_of, field, tiled=tiled, coast=coast)
    return _grounds.get((tiled, coast), make, owner=field)


def missing_colour(background: Sequence[float]) -> Floats:
    """Return the colour of places without data at sea, near that of the background (3,)."""
    ink = 1.0 - float(is_light(background))
    return np.asarray(background, dtype=float) * (1 - MISSING_SHARE) + (ink * MISSING_SHARE)


def ground_kinds(field: FlowField, coast: Coast | None = None) -> tuple[str, ...]:
    """Return what a legend says of places without data: ``LAND`` and ``NO_DATA``, or nothing.

    Land alone needs no legend. The globe around a field that covers a part of it has no data.
    """
    if field.projection is None:
        return ()
    ground = ground_cells(field, coast=coast)
    has_globe = globe_radius(field) is not None
    if not has_globe and not ground.missing.any():
        return ()
    if ground.land.any():
        return LAND, NO_DATA
    return (NO_DATA,)


def ground_colours(
    field: FlowField, land: Any, background: Any, coast: Coast | None = None
) -> dict[str, Floats]:
    """Return the kinds of places without data, with their colours from 0 to 1.

    ``land`` and ``background`` are colours; without land nothing is drawn there. ``coast`` are
    lines of the user.
    """
    if land is None:
        return {}
    colours = {LAND: np.asarray(rgb(land)), NO_DATA: missing_colour(rgb(background))}
    return {kind: colours[kind] for kind in ground_kinds(field, coast)}


def _ground_of(field: FlowField, *, tiled: bool, coast: Coast | None) -> Ground:
    empty = empty_cells(field, tiled=tiled)
    nothing = np.zeros_like(empty)
    if field.projection is None or not empty.any():
        return Ground(nothing, nothing)
    surface = field.surface
    step = 1
    asked = empty
    if empty.ndim == 2:
        step = math.ceil(math.sqrt(np.count_nonzero(empty) / MOST_ASKED))
        asked = np.zeros_like(empty)
        asked[::step, ::step] = empty[::step, ::step]
    corners = surface.points.reshape(-1, 3)[surface.nodes_of(asked)]
    lon, lat = field.projection.lonlat(corners.mean(axis=1))
    land = np.zeros_like(empty)
    land[asked] = on_land(lon, lat, coast)
    if empty.ndim == 2:
        land = empty & _with_fringe(land, empty, step)
    return Ground(land, empty & ~land)


def _with_fringe(land: Bools, empty: Bools, step: int) -> Bools:
    """Return land and places without data beside it, of a grid whose steps are all known."""
    near = scipy.ndimage.binary_dilation(land, np.ones((2 * step + 1, 2 * step + 1), dtype=bool))
    sea = empty & ~near
    wide = scipy.ndimage.binary_opening(sea, np.ones((FRINGE, FRINGE), dtype=bool))
    beside = scipy.ndimage.binary_dilation(near, np.ones((3, 3), dtype=bool), iterations=FRINGE)
    return np.asarray(near | (sea & ~wide & beside))


def empty_cells(field: FlowField, *, tiled: bool = False) -> Bools:
    """Return which cells of a field have their positions and are not drawn.

    The shape is (J - 1, I - 1), or (M,) of triangles. If that is the coarsest level of a
    structured field in tiles all cells may be seen so, where finer ones have no data.
    """
    surface = field.surface
    seen_through = tiled and field.triangles is None
    if seen_through:
        return surface.placed_cells
    return surface.placed_cells & ~surface.cells


def globe_radius(field: FlowField) -> float | None:
    """Return the radius of the sphere below a globe; ``None`` for a map or all of the Earth."""
    surface = field.surface
    if not surface.on_globe or surface.is_closed:
        return None
    # A cell is deepest below the sphere through its corners at the middle of those.
    longest = _cells(field)[1].max(initial=0.0)
    return float(np.sqrt(max(EARTH_RADIUS**2 - longest**2, 0.0))) - LOWER * EARTH_RADIUS


def _cells(field: FlowField) -> tuple[Floats, Floats]:
    surface = field.surface
    corners = surface.points.reshape(-1, 3)[surface.nodes_of(surface.cells | empty_cells(field))]
    middles = corners.mean(axis=1)
    return middles, norm(corners - middles[:, None]).max(axis=1)
