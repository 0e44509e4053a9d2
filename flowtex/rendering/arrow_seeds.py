"""Positions of arrows on a surface: points nested by octaves, as even as possible at each.

An octave halves the area of a seed. Of its candidates, spread over the surface by hashed numbers,
the one farthest from all seeds is taken, then the next, as long as they keep the octave's distance.
So a seed has a *radius*, its distance from all before it, and a view shows those whose radius is
long enough on the screen. For finer octaves the cells in view are divided into parts with a
candidate each. ``client/src/arrowseeds.ts`` has the same for the browser.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import scipy
from numpy.typing import NDArray

from flowtex._util.array_types import Bools, Floats, Floats32, Indices
from flowtex._util.arrays import norm
from flowtex.rendering.shaders import const
from flowtex.rendering.tile_choice import TileView
from flowtex.textures.geometry import SurfaceGeometry
from flowtex.textures.tiles.grid_pyramid import TILE_CELLS, GridPyramid
from flowtex.textures.tiles.pyramid import TileKey
from flowtex.textures.triangle_geometry import TriangleGeometry

OCTAVE = float(np.sqrt(0.5))  #: Distance of seeds in an octave over that in the one before.
MOST_OCTAVES = 80  #: Most octaves.
CANDIDATE_AREA = 0.125  #: Area that a candidate has to itself, over the square of that distance.
MOST_CANDIDATES = 50_000  #: Candidates in an octave of the whole surface, at most.
AROUND = 0.5  #: Margin that is seeded beside a view, in heights of it.
AROUND_RADII = 3.0  #: The same in distances of seeds.
CLOSER = 0.75  #: How much closer seeds are than requested, so that nearer views need no new ones.

Hashes = NDArray[np.uint32]


class _Rows:
    """Arrays of one length, which can be indexed and joined together."""

    def __getitem__(self, selection: Indices | Bools) -> Self:
        return type(self)(*(values[selection] for values in vars(self).values()))

    def __add__(self, more: Self) -> Self:
        pairs = zip(vars(self).values(), vars(more).values(), strict=True)
        return type(self)(*map(np.concatenate, pairs))


@dataclass(frozen=True, eq=False)
class Seeds(_Rows):
    """Points of a surface: cell, place (i, j) in it, 0 to 1, position in its frame, and radius."""

    cell: Indices
    place: Floats
    position: Floats
    radius: Floats


@dataclass(frozen=True, eq=False)
class _Parts(_Rows):
    """Parts of cells: cell, lower corner and size in it, and a hashed number of each."""

    cell: Indices
    low: Floats
    size: Floats
    key: Hashes


class ArrowSeeds:
    """Seeds of one surface, made as views ask for them."""

    def __init__(self, geometry: SurfaceGeometry | TriangleGeometry) -> None:
        faces = geometry.faces
        #: Vertices at the corners of each cell, (N, 4); the last two of a triangle are one.
        self.corners = faces[:, [0, 1, 3, 2] if faces.shape[1] == 4 else [0, 1, 2, 2]]
        self._geometry = geometry
        self._nodes: Floats32 = geometry.at_vertices(geometry.position)
        self._cells = _Parts(
            np.arange(len(faces)),
            np.zeros((len(faces), 2)),
            np.ones((len(faces), 2)),
            _mixed(np.arange(len(faces), dtype=np.uint32)),
        )
        self._sums = np.cumsum(self._areas(self._cells))
        none = np.zeros((0, 3))
        self._whole = [Seeds(np.zeros(0, np.intp), none[:, :2], none, none[:, 0])]
        self._last: tuple[TileView, float, Seeds] | None = None

    def seen(self, view: TileView, spacing: float) -> Seeds:
        """Return the seeds of a view that are this many pixels apart, and some more."""
        if self._last is None or not self._covers(*self._last[:2], view, spacing):
            self._last = view, spacing, self._make(view, spacing)
        return self._last[2]

    def _covers(self, last: TileView, least: float, view: TileView, spacing: float) -> bool:
        points = self._corners_of(view)
        last_distance = CLOSER * least * last.pixel(last.distances(points))
        distance = spacing * view.pixel(view.distances(points))
        return bool((last_distance <= distance).all() and _sees(last, points, 0.0).all())

    def _corners_of(self, view: TileView) -> Floats:
        """Return the corners of the visible box around the surface, (8, 3), in mesh coordinates."""
        ahead = np.cross(view.planes[0, :3], view.planes[2, :3])
        center = float(ahead @ self._geometry.center)
        reach = 0.5 * self._geometry.extent * float(np.linalg.norm(ahead))
        return np.array(
            [
                np.linalg.solve(
                    [side[:3], end[:3], ahead], [-side[3], -end[3], center + sign * reach]
                )
                for side in view.planes[:2]
                for end in view.planes[2:]
                for sign in (-1, 1)
            ]
        )

    def _make(self, view: TileView, spacing: float) -> Seeds:
        geometry = self._geometry
        nearest = 1.0
        if view.eye is not None:
            distance = float(norm(geometry.center - view.eye))
            nearest = max(distance - 0.5 * geometry.extent, 0.0)
        least = CLOSER * spacing * view.pixel(np.array(nearest))
        radius = geometry.extent
        parts = self._cells
        seeds = self._whole[0]
        for octave in range(MOST_OCTAVES):
            area = CANDIDATE_AREA * radius**2
            if self._sums[-1] <= MOST_CANDIDATES * area:
                if octave + 1 == len(self._whole):
                    self._whole.append(self._grown(seeds, self._spread(octave, area), radius))
                seeds = self._whole[octave + 1]
            else:
                parts = self._divided(self._needed(parts, view, spacing, radius), area)
                key = _mixed(parts.key + np.uint32(octave))
                chosen = _shares(key) * area < self._areas(parts)
                seeds = self._grown(seeds, self._points(parts[chosen], key[chosen]), radius)
            if radius <= least or not len(parts.cell):
                break
            radius *= OCTAVE
        points = self._mesh_points(seeds.position)
        near = _sees(view, points, 0.0) & (
            seeds.radius >= CLOSER * spacing * view.pixel(view.distances(points))
        )
        return seeds[near]

    def _mesh_points(self, position: Floats) -> Floats:
        return position @ self._geometry.frame + self._geometry.center

    def _spread(self, octave: int, area: float) -> Seeds:
        """Return the candidates of an octave, evenly spread over the areas of all cells."""
        number = np.arange(int(self._sums[-1] / area), dtype=np.uint32)
        key = _mixed(_mixed(np.full(1, octave, np.uint32) + const.OCTAVE_PRIME) + number)
        cell = np.searchsorted(self._sums, (number + _shares(key)) * area, side="right")
        return self._points(self._cells[np.minimum(cell, len(self._sums) - 1)], key)

    def _points(self, parts: _Parts, key: Hashes) -> Seeds:
        first = _mixed(key + const.OCTAVE_PRIME)
        share = np.stack([_shares(first), _shares(_mixed(first + const.OCTAVE_PRIME))], axis=-1)
        place = parts.low + parts.size * share
        position = self._positions(parts.cell, place)
        return Seeds(parts.cell, place, position, np.full(len(place), np.inf))

    def _grown(self, seeds: Seeds, candidates: Seeds, least: float) -> Seeds:
        """Add the candidates that are not too near, the farthest from all others first."""
        most = least / OCTAVE
        distance: Floats = np.full(len(candidates.cell), most)
        if len(seeds.cell):
            nearest = scipy.spatial.cKDTree(seeds.position).query(
                candidates.position, distance_upper_bound=most
            )
            distance = np.minimum(nearest[0], most)
        order = np.argsort(-distance, kind="stable")
        order = order[distance[order] >= least]
        position = candidates.position[order]
        distance = distance[order]
        taken = []
        if len(order):
            neighbours: Any = scipy.spatial.cKDTree(position).query_ball_point(position, most)
            for n, near in enumerate(neighbours):
                if distance[n] < least:
                    continue
                taken.append(n)
                later = np.array([m for m in near if m > n], dtype=np.intp)
                apart = norm(position[later] - position[n])
                distance[later] = np.minimum(distance[later], apart)
        new = candidates[order[taken]]
        return seeds + Seeds(new.cell, new.place, new.position, distance[taken])

    def _needed(self, parts: _Parts, view: TileView, spacing: float, radius: float) -> _Parts:
        middle = self._mesh_points(self._positions(parts.cell, parts.low + 0.5 * parts.size))
        reach = 0.5 * norm(self._sides(parts)).sum(axis=0)
        pixel = view.pixel(np.maximum(view.distances(middle) - reach, 0.0))
        needed = radius >= OCTAVE * CLOSER * spacing * pixel
        return parts[needed & _sees(view, middle, reach + AROUND_RADII * radius)]

    def _divided(self, parts: _Parts, area: float) -> _Parts:
        """Halve parts along their longer sides until none is larger than an area."""
        while (large := self._areas(parts) > area).any():
            large_parts = parts[large]
            rest = parts[~large]
            sides = norm(self._sides(large_parts))
            axis = (sides[1] > sides[0]).astype(int)
            size = large_parts.size.copy()
            rows = np.arange(len(axis))
            size[rows, axis] *= 0.5
            beyond = large_parts.low.copy()
            beyond[rows, axis] += size[rows, axis]
            for low, prime in ((large_parts.low, const.OCTAVE_PRIME), (beyond, const.SEED_PRIME)):
                half = _Parts(large_parts.cell, low, size, _mixed(large_parts.key + prime))
                rest = rest + half
            parts = rest
        return parts

    def _positions(self, cell: Indices, place: Floats) -> Floats:
        return _between(self._nodes[self.corners[cell]].astype(float), place)

    def _sides(self, parts: _Parts) -> Floats:
        """Return the vectors across parts along i and j, (2, n, 3)."""
        ends = [0.0, 0.5], [1.0, 0.5], [0.5, 0.0], [0.5, 1.0]
        at = [self._positions(parts.cell, parts.low + parts.size * np.array(end)) for end in ends]
        return np.array([at[1] - at[0], at[3] - at[2]])

    def _areas(self, parts: _Parts) -> Floats:
        return norm(np.cross(*self._sides(parts)))


def _between(corners: NDArray[np.floating], place: Floats) -> Floats:
    """Interpolate between the corners (n, 4, ...) of cells at places (n, 2)."""
    (i, j) = place.T.reshape(2, -1, *[1] * (corners.ndim - 2))
    values = np.moveaxis(corners, 1, 0)
    low = (1 - i) * values[0] + i * values[1]
    high = (1 - i) * values[2] + i * values[3]
    return np.asarray((1 - j) * low + j * high)


def _sees(view: TileView, points: Floats, reach: Floats | float) -> Bools:
    return view.sees(points, reach + AROUND * view.pixels * view.pixel(view.distances(points)))


def _mixed(key: Hashes) -> Hashes:
    for factor in const.HASH_FACTORS:
        key = (key ^ (key >> const.HASH_SHIFT)) * factor
    return np.asarray(key ^ (key >> const.HASH_SHIFT))


def _shares(key: Hashes) -> Floats:
    return key / 2.0**32


def vertex_data(
    geometry: SurfaceGeometry | TriangleGeometry, corners: Indices, place: Floats, radius: Floats
) -> dict[str, Floats]:
    """Return vertex attributes of seeds between vertices at the ``corners`` (n, 4) of a cell."""
    nodes = geometry.at_vertices(geometry.position)[corners].astype(float)
    across = np.cross(
        nodes[:, 1] + nodes[:, 3] - nodes[:, 0] - nodes[:, 2],
        nodes[:, 2] + nodes[:, 3] - nodes[:, 0] - nodes[:, 1],
    )
    coordinate = geometry.coordinate.reshape(-1, 2)[corners]
    data = {
        "flowtexPosition": _between(nodes, place),
        "flowtexCoordinate": _between(coordinate, place),
        "flowtexNormal": across / np.maximum(norm(across), np.finfo(float).tiny)[:, None],
        "flowtexRadius": radius,
    }
    if geometry.corners is not None:
        data["flowtexCorners"] = geometry.corners[corners[:, 0]].astype(float)
    return data


def in_tile(
    pyramid: GridPyramid, key: TileKey, geometry: SurfaceGeometry, places: Floats
) -> tuple[Bools, Indices, Floats]:
    """Return which places (n, 2) of a root lie in a tile, and the corners and places of cells."""
    lines = zip(pyramid.line_numbers(pyramid.depth), pyramid.line_numbers(key.level), strict=True)
    position = np.stack(
        [
            np.interp(np.interp(x, np.arange(len(root)), root), fine, np.arange(len(fine)))
            for x, (root, fine) in zip(places.T, reversed(list(lines)), strict=True)
        ],
        axis=-1,
    )
    position -= np.array([key.column, key.row]) * TILE_CELLS
    rows, columns = geometry.shape
    cell = np.clip(np.floor(position), 0, (columns - 2, rows - 2)).astype(int)
    inside: Bools = (np.abs(position - cell - 0.5) <= 0.5).all(axis=-1)
    inside &= geometry.cells[cell[:, 1], cell[:, 0]]
    first = cell[inside, 1] * columns + cell[inside, 0]
    corners = first[:, None] + np.array([0, 1, columns, columns + 1])
    return inside, corners, (position - cell)[inside]


def seed_limits() -> dict[str, float]:
    """Return the numbers by which a client finds the same seeds, for JSON."""
    return {
        "octave": OCTAVE,
        "mostOctaves": MOST_OCTAVES,
        "candidateArea": CANDIDATE_AREA,
        "mostCandidates": MOST_CANDIDATES,
        "around": AROUND,
        "aroundRadii": AROUND_RADII,
        "closer": CLOSER,
    }
