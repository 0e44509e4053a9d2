"""Triangles around a pole that a flat map opens into a line, or at which it is torn.

A pole in a triangle becomes a node. The triangles around it are divided until their sides are short
as seen from the pole, because a map bends them, and vectors that are alike point in all directions
there. Then each side that leads to the pole ends at a place of its own, beside the pole.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flowtex._util.array_types import Floats, Indices
from flowtex.field.earth.projection import GLOBE, Projection

EARTH = Projection(GLOBE)
#: Degrees between a pole and the nodes that take its place on a map: a metre. Nodes must be some
#: centimetres apart on every map.
BESIDE_POLE = 1e-5
#: Degrees from a pole at which a map is examined.
EXAMINED = 0.01
#: Longest step around a pole on a map, over the median, beyond which the map is torn there.
TORN_STEP = 5.0
#: Distance from a side or a corner of a triangle, as a share, up to which a pole lies on it.
ON_SIDE = 1e-6
#: Longest side as an angle in degrees, seen from a pole.
WIDEST_SIDE = 15.0
#: Greatest ratio of the distances of the ends of a side from a pole.
GREATEST_RATIO = 2.0
#: Longest side that ends at a pole, in degrees.
LONGEST_SPOKE = 0.5
#: Distance from a pole in degrees, over that of the nodes around it, in which sides are divided.
AROUND = 8.0
#: Most times that sides are divided.
MOST_DIVISIONS = 40


@dataclass(eq=False)
class MeshPlaces:
    """Places on the Earth, each between up to three nodes of a mesh."""

    lon: Floats  #: (P,), in degrees.
    lat: Floats
    nodes: Indices  #: Three nodes of the mesh, (P, 3).
    weights: Floats  #: Their shares, (P, 3).
    west: float  #: Least longitude.

    @classmethod
    def of_nodes(cls, lon: Floats, lat: Floats, west: float) -> MeshPlaces:
        """Return the places of the nodes themselves."""
        nodes = np.repeat(np.arange(len(lon))[:, None], 3, axis=1)
        weights = np.zeros(nodes.shape)
        weights[:, 0] = 1.0
        # A node on the edge of a map lies on its western side.
        return cls(west + (lon - west) % 360.0, lat, nodes, weights, west)

    @property
    def positions(self) -> Floats:
        """Positions on the globe, (P, 3)."""
        return EARTH.positions(self.lon, self.lat)

    def lonlat(self, numbers: Indices) -> tuple[Floats, Floats]:
        """Return longitudes and latitudes of some places."""
        return self.lon[numbers], self.lat[numbers]

    def append(self, lon: Floats, lat: Floats, nodes: Indices, weights: Floats) -> Indices:
        """Add places, and return their numbers."""
        first = len(self.lon)
        self.lon = np.concatenate([self.lon, lon])
        self.lat = np.concatenate([self.lat, lat])
        self.nodes = np.concatenate([self.nodes, nodes])
        self.weights = np.concatenate([self.weights, weights])
        return first + np.arange(len(lon))

    def append_between(
        self, pairs: Indices, share: Floats, place: tuple[Floats, Floats] | None = None
    ) -> Indices:
        """Add places between two others, (K, 2), at shares of the way, and return their numbers.

        ``place`` are their longitudes and latitudes, by default those on great circles.
        """
        nodes, weights = self._mixed(pairs, share)
        if place is None:
            one, other = np.moveaxis(self.positions[pairs], 1, 0)
            lon, lat = EARTH.lonlat((1 - share[:, None]) * one + share[:, None] * other)
            lon = self.west + (lon - self.west) % 360.0
        else:
            lon, lat = place
        return self.append(lon, lat, nodes, weights)

    def _mixed(self, pairs: Indices, share: Floats) -> tuple[Indices, Floats]:
        """Return the three nodes of the most weight between two places each, and the weights."""
        nodes = self.nodes[pairs].reshape(len(pairs), 6)
        parts = np.stack([1 - share, share], axis=-1)[..., None] * self.weights[pairs]
        weights = parts.reshape(len(pairs), 6)
        order = np.argsort(nodes, axis=1, kind="stable")
        nodes = np.take_along_axis(nodes, order, axis=1)
        weights = np.take_along_axis(weights, order, axis=1)
        for k in range(1, 6):
            same = nodes[:, k] == nodes[:, k - 1]
            weights[same, k] += weights[same, k - 1]
            weights[same, k - 1] = 0.0
        most = np.argsort(-weights, axis=1, kind="stable")[:, :3]
        nodes = np.take_along_axis(nodes, most, axis=1)
        weights = np.take_along_axis(weights, most, axis=1)
        nodes = np.where(weights > 0, nodes, nodes[:, :1])  # a node that lacks data has no share
        return nodes, weights / weights.sum(axis=1, keepdims=True)


def torn_poles(projection: Projection) -> list[int]:
    """Return the poles, 1 for the north and -1 for the south, at which a map is torn."""
    lon = np.arange(0.0, 360.0, 10.0)
    found = []
    for sign in (1, -1):
        ring = projection.positions(lon, np.full(len(lon), sign * (90.0 - EXAMINED)))
        steps = np.linalg.norm(ring - np.roll(ring, 1, axis=0), axis=1)
        if np.isfinite(steps).all() and steps.max() > TORN_STEP * np.median(steps):
            found.append(sign)
    return found


def around_pole(
    places: MeshPlaces, triangles: Indices, members: Indices, sign: int
) -> tuple[tuple[Indices, Indices], int | None]:
    """Divide the triangles around a pole, and return them, their members, and the pole's place.

    Places are added. The last value is ``None`` where no triangle contains the pole.
    """
    number, weights = _containing(places, triangles, sign)
    corner = np.argmax(weights, axis=1)
    on_node = weights.max(axis=1) > 1 - ON_SIDE
    # Grids repeat a node at a pole, and another map has opened the pole into nodes beside it.
    beside_pole = np.flatnonzero(_distance(places, sign) < 2 * BESIDE_POLE)
    is_pole = np.isin(triangles, [*triangles[number[on_node], corner[on_node]], *beside_pole])
    if not len(number) and not is_pole.any():
        return (triangles, members), None
    if is_pole.any():
        pole = int(triangles[is_pole][0])
        triangles = np.where(is_pole, pole, triangles)
        whole = (triangles == pole).sum(axis=1) < 2
        triangles = triangles[whole]
        members = members[whole]
        number = number[:0]
    else:
        corners = places.nodes[triangles[number[:1]], 0]
        at = np.array([places.west]), np.array([90.0 * sign])
        pole = int(places.append(*at, corners, weights[:1])[0])
    parts = []
    owners = []
    for k in range(3):
        # The pole takes the place of each corner, unless it lies on the opposite side.
        inside = weights[: len(number), k] > ON_SIDE
        part = triangles[number[inside]].copy()
        part[:, k] = pole
        parts.append(part)
        owners.append(members[number[inside]])
    whole = np.ones(len(triangles), dtype=bool)
    whole[number] = False
    triangles = np.concatenate([triangles[whole], *parts])
    members = np.concatenate([members[whole], *owners])
    return _divided(places, triangles, members, pole, sign), pole


def _containing(places: MeshPlaces, triangles: Indices, sign: int) -> tuple[Indices, Floats]:
    """Return the triangles that contain a pole, (K,), and the shares of their corners, (K, 3)."""
    p = places.positions
    beside_pole = sign * p[:, 2] > 0.2 * np.abs(p).max()
    near = np.flatnonzero(beside_pole[triangles].all(axis=1))
    x, y, z = np.moveaxis(p[triangles[near]], -1, 0)
    # Great circles are straight in this plane, and the pole is its origin.
    x = x / z
    y = y / z
    shares = np.roll(x, -1, axis=1) * np.roll(y, -2, axis=1)
    shares -= np.roll(x, -2, axis=1) * np.roll(y, -1, axis=1)
    area = shares.sum(axis=1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        shares = shares / area
        inside = (shares >= -ON_SIDE).all(axis=1)
    shares = np.where(shares[inside] > ON_SIDE, shares[inside], 0.0)
    return near[inside], shares / shares.sum(axis=1, keepdims=True)


def _divided(
    places: MeshPlaces, triangles: Indices, members: Indices, pole: int, sign: int
) -> tuple[Indices, Indices]:
    """Divide triangles near a pole until their sides are short as seen from it."""
    at_pole = (triangles == pole).any(axis=1)
    radius = AROUND * _distance(places, sign)[triangles[at_pole]].max(initial=0.0)
    near = (_distance(places, sign) < radius)[triangles].all(axis=1)
    far = triangles[~near], members[~near]
    part = triangles[near]
    owner = members[near]
    for _ in range(MOST_DIVISIONS):
        sides = np.sort(np.stack([part, np.roll(part, -1, axis=1)], axis=-1), axis=-1)
        pairs, number = np.unique(sides.reshape(-1, 2), axis=0, return_inverse=True)
        of_side = number.reshape(-1, 3)
        size = _sizes(places, pairs, pole, sign)
        is_long = size > 1.0
        if not is_long.any():
            break
        middle = np.full(len(pairs), -1)
        middle[is_long] = places.append_between(pairs[is_long], np.full(int(is_long.sum()), 0.5))
        part, source = _halved(part, middle[of_side], size[of_side])
        owner = owner[source]
    return np.concatenate([far[0], part]), np.concatenate([far[1], owner])


def _distance(places: MeshPlaces, sign: int) -> Floats:
    """Return the distances of places from a pole in degrees, (P,)."""
    return np.asarray(90.0 - sign * places.lat)


def _sizes(places: MeshPlaces, pairs: Indices, pole: int, sign: int) -> Floats:
    """Return sizes of sides, (K, 2), as seen from a pole; those of more than 1 are divided."""
    distance = np.maximum(_distance(places, sign)[pairs], BESIDE_POLE)
    lon = places.lon[pairs]
    angle = np.abs((lon[:, 1] - lon[:, 0] + 180.0) % 360.0 - 180.0)
    ratio = distance.max(axis=1) / distance.min(axis=1)
    size = np.maximum(angle / WIDEST_SIDE, np.log(ratio) / np.log(GREATEST_RATIO))
    is_spoke = (pairs == pole).any(axis=1)
    is_short = distance.max(axis=1) <= LONGEST_SPOKE
    return np.where(is_spoke, np.where(is_short, 0.0, np.inf), size)


def _halved(triangles: Indices, middle: Indices, size: Floats) -> tuple[Indices, Indices]:
    """Divide triangles at the middles of their sides, (M, 3), or -1 where a side is whole.

    Each is divided first at the side of the greatest ``size``, then its parts at the others. The
    second value has the number of the triangle of each part.
    """
    number = np.arange(len(triangles))
    size = np.where(middle >= 0, size, -1.0)
    for _ in range(3):
        divided = (middle >= 0).any(axis=1)
        order = (np.argmax(size[divided], axis=1)[:, None] + np.arange(3)) % 3
        a, b, c = np.take_along_axis(triangles[divided], order, axis=1).T
        m, on_b, on_c = np.take_along_axis(middle[divided], order, axis=1).T
        _, size_b, size_c = np.take_along_axis(size[divided], order, axis=1).T
        none = np.full(len(m), -1)
        parts = np.stack([a, m, c], axis=-1), np.stack([m, b, c], axis=-1)
        middles = np.stack([none, none, on_c], axis=-1), np.stack([none, on_b, none], axis=-1)
        sizes = np.stack([none, none, size_c], axis=-1), np.stack([none, size_b, none], axis=-1)
        triangles = np.concatenate([triangles[~divided], *parts])
        middle = np.concatenate([middle[~divided], *middles])
        size = np.concatenate([size[~divided], *sizes])
        number = np.concatenate([number[~divided], number[divided], number[divided]])
    return triangles, number


def open_pole(
    places: MeshPlaces, triangles: Indices, members: Indices, pole: int, sign: int
) -> tuple[Indices, Indices]:
    """Let each side that ends at a pole end beside it, in the direction of its other end."""
    at_pole = (triangles == pole).any(axis=1)
    corner = np.argmax(triangles[at_pole] == pole, axis=1)
    order = (corner[:, None] + np.arange(3)) % 3
    _, a, b = np.take_along_axis(triangles[at_pole], order, axis=1).T
    around, number = np.unique(np.stack([a, b]), return_inverse=True)
    lat = np.full(len(around), sign * (90.0 - BESIDE_POLE))
    nodes = np.repeat(places.nodes[pole : pole + 1], len(around), axis=0)
    weights = np.repeat(places.weights[pole : pole + 1], len(around), axis=0)
    beside = places.append(places.lon[around], lat, nodes, weights)
    to_a, to_b = beside[number.reshape(2, -1)]
    parts = np.stack([to_a, a, b], axis=-1), np.stack([to_a, b, to_b], axis=-1)
    owner = members[at_pole]
    triangles = np.concatenate([triangles[~at_pole], *parts])
    return triangles, np.concatenate([members[~at_pole], owner, owner])
