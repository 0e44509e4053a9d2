"""A field on triangles with fewer nodes: all in one bin become one, with the means of their data.

Bins are cubes whose side is about twice the edges where they lie, and twice as long at each
next level, so that a mesh of very different cells loses three nodes of four everywhere. Nodes on
borders and sharp edges are binned apart from the others, which keeps outlines, and so are nodes of
two sides of a thin sheet, and of parts that are not connected. Triangles remain where their corners
lie in three bins. A bin at a sharp edge becomes a node for each face, all at one place, unless so
many faces meet there that they are smaller than the bin: then it becomes one node.
"""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, overload

import numpy as np

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex._util.arrays import bounds, dot, first_places, norm, numbered, row_blocks
from flowtex._util.forks import ProcessLock
from flowtex._util.progress import finish
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.scalars import Scalars
from flowtex.field.steps import Steps, map_steps
from flowtex.field.triangles.triangle_nodes import (
    connected_items,
    connected_nodes,
    incidence,
    known_means,
    once,
    sums_at,
    touching,
    triangle_normals,
    uneven_nodes,
)
from flowtex.field.triangles.triangle_surface import TriangleSurface

#: Side of the first bins in edges there.
FIRST_EDGES = 2.0
#: Passes in which the edge of a node, or its noisy position, takes the value of its surroundings.
SMOOTHING = 3
#: Length of the sum of normals around a node, over that in a plane, below which it is in noise.
EVEN_SHARE = 0.9
#: Least share of such nodes on a noisy surface; others have them along edges.
ROUGH_SHARE = 0.1
#: Greatest cosine of the angle between the normals of two sides of a sheet.
OPPOSITE = -0.5
#: Rounds of the search for inverted triangles.
UNTANGLING = 4
#: Most bins along the surface's extent; three of their numbers fit into 64 bits.
MOST_BINS = 2**18
#: Most faces in a bin that stay apart: three meet in the corner of a box. Where there are more, the
#: edges between them are too close for the next level, as in noise.
MOST_FACES = 3
#: Least nodes of a sheet in a bin that is not a corner of another, as a share of the nodes of that.
SHEET_SHARE = 0.3
#: Number of the face of nodes in which several faces were merged.
MERGED = 0
#: Most nodes of the next level, as a share of the nodes of a level that is not the last.
MOST_LEFT = 0.7

#: Levels that are made at once: the finest and the last two.
FIRST_LEVELS = 3


@dataclass(frozen=True, eq=False)
class Clusters:
    """Nodes of a level, each of which represents some nodes of the field."""

    whole: FlowField  #: The field that has all nodes.
    field: FlowField  #: The field at this level.
    triangles: Indices  #: Its triangles that are drawn, which face alike, (M, 3).
    cells: Indices  #: Numbers of these among the triangles of :attr:`field`, (M,).
    number: Indices  #: Node of this level for each node of the whole field, or -1, (N,).
    #: Sides of the bins of the next level, a power of two times the first, (n,).
    sides: Floats
    #: First node at the place of each, (n,): at sharp edges each face has its own.
    places: Indices
    face: Indices  #: The part without sharp edges that each node belongs to, (n,), or MERGED.
    edge: Indices  #: The face, sharp edge or corner that each node lies on, (n,), or MERGED.
    border: Bools  #: Nodes on the border of the drawn triangles, (n,).
    normals: Floats  #: Normals, (n, 3).
    binned: Floats  #: Positions by which nodes are binned, (n, 3): without noise.

    @classmethod
    def of(cls, field: FlowField) -> Clusters:
        """Return the finest level, in which each node represents itself.

        Raises
        ------
        FieldError
            When the field has no triangles.
        """
        surface = field.surface
        if not isinstance(surface, TriangleSurface):
            raise FieldError(
                "this field has no triangles; expected one of FlowField.from_triangles"
            )
        triangles = surface.triangles
        border = _border_nodes(surface)
        crosses = surface.crosses
        if surface.flipped.any():
            triangles = triangles.copy()
            triangles[surface.flipped] = triangles[surface.flipped, ::-1]
        if not surface.cells.all():
            triangles = triangles[surface.cells]
            crosses = crosses[surface.cells]
        places = surface.places
        joined = triangles
        if surface.has_faces:
            joined = places[triangles]
        around = incidence(joined, field.shape[1])
        areas = norm(crosses)
        share = np.bincount(joined.ravel(), minlength=field.shape[1])
        sides = _sides(around, share, areas, surface.extent)
        binned, normals = _without_noise(around, share, field.points[0], crosses, areas)
        face = _faces(surface)
        if surface.has_faces:
            sides, normals, binned = (values[places] for values in (sides, normals, binned))
        number = np.arange(field.shape[1])
        cells = surface.drawn
        edge = _edges(face, places)
        on_nodes = sides, places, face, edge, border, normals, binned
        return cls(field, field, triangles, cells, number, *on_nodes)

    @cached_property
    def part(self) -> Indices:
        """Connected part of each node, (n,), numbered in the order of their extents."""
        part = connected_nodes(self._joined, len(self.places))
        return _by_extent(part[self.places], self.field.points[0], self.triangles)

    @property
    def _joined(self) -> Indices:
        """Nodes at the corners of triangles, (M, 3), the same ones for all faces."""
        if self.face.any():
            return np.asarray(self.places.take(self.triangles))
        return self.triangles

    def coarser(self, steps: int = 1, boxes: Indices | None = None) -> Clusters:
        """Return a coarser level, without triangles if all are smaller than the bins.

        It is the next one, or one farther by ``steps``, without those between. Its :meth:`boxes`
        may be known.
        """
        if boxes is None:
            boxes = self.boxes(steps)
        faces, edges, bins = self._binned(steps, boxes)
        cluster, corners, cells, bins = self._faced(bins, faces)
        count = len(bins)
        _, first, at = np.unique(bins, return_index=True, return_inverse=True)
        places = first[at]
        number = np.where(self.number >= 0, cluster[self.number], -1)
        kept = np.flatnonzero(cluster >= 0)
        # One of the nodes that each represents: those of a bin are alike.
        member = np.empty(count, dtype=np.intp)
        member[cluster[kept]] = kept
        border = self.border[member]
        normals = sums_at(places[cluster[kept]], self.normals[kept], count)[places]
        field = _averaged(self.whole, number, places, corners)
        at_edge = np.bincount(places)[places] > 1
        is_ahead = _untangled(field.points[0], corners, normals, border | at_edge)
        corners = corners[is_ahead]
        cells = self.cells[cells[is_ahead]]
        # A cell has the value of one of those in its place: means may be of none, such as a mark.
        flat = {name: self.field.scalars[name][:, :, cells] for name in field.on_cells}
        scalars = Scalars({**field.scalars, **flat})
        field = replace(field, triangles=corners, scalars=scalars)
        level = Clusters(
            whole=self.whole,
            field=field,
            triangles=corners,
            cells=np.arange(len(corners)),
            number=number,
            sides=2.0**steps * self.sides[member],
            places=places,
            face=faces[member],
            edge=edges[member],
            border=border,
            normals=normals,
            binned=field.points[0],
        )
        level.__dict__["part"] = self.part[member]
        return level

    def _binned(self, steps: int, boxes: Indices) -> tuple[Indices, Indices, Indices]:
        """Return face, edge, and bin of each node, (n,) each, for a coarser level."""
        faces, edges = self._separate(boxes)
        bins = self._bins(boxes, edges)
        if steps == 1:
            bins = self._compact(bins, edges)
        return faces, edges, bins

    def _separate(self, boxes: Indices) -> tuple[Indices, Indices]:
        """Return face and edge of each node, (n,), MERGED where a bin has too many faces."""
        if not self.face.any():
            return self.face, self.edge
        count = int(self.face.max()) + 1
        within = np.unique(boxes * count + self.face) // count
        is_crowded = (np.bincount(within) > MOST_FACES)[boxes]
        # All nodes at a place have the same bin.
        face = np.where(is_crowded, MERGED, self.face)
        edge = np.where(is_crowded, MERGED, self.edge)
        return face, edge

    def _faced(self, bins: Indices, face: Indices) -> tuple[Indices, Indices, Indices, Indices]:
        """Return the nodes of the next level, with one for each face of a bin.

        These are the node for each one here, (n,), or -1; corners of triangles (m, 3) and their
        numbers here, (m,); and the bin of each node of the next level.
        """
        together = bins[self.places]
        corners, cells = once(together[self.triangles])
        count = int(face.max(initial=0)) + 1
        kinds, cluster = numbered(together * count + face)
        nodes = self.triangles[cells]
        # Which corner of the triangle became which one of the merged triangle.
        at = np.argmax(together[nodes][:, None] == corners[:, :, None], axis=2)
        corners = cluster[np.take_along_axis(nodes, at, axis=1)]
        used = np.zeros(len(kinds), dtype=bool)
        used[corners] = True
        fresh = np.where(used, np.cumsum(used) - 1, -1)
        return fresh[cluster], fresh[corners], cells, kinds[used] // count

    def boxes(self, steps: int, nodes: Indices | slice = slice(None)) -> Indices:
        """Return the box of space of some nodes, (n,), numbered from 0, for a coarser level."""
        sides = 2.0 ** (steps - 1) * self.sides[nodes]
        lowest = bounds(self.binned)[0]
        key = np.zeros(len(sides), dtype=np.int64)
        if sides.min() < sides.max():
            key = np.rint(np.log2(sides / sides.min())).astype(np.int64)
        for axis in range(3):
            at = ((self.binned[nodes, axis] - lowest[axis]) / sides).astype(np.int64)
            key *= int(at.max()) + 1
            key += at
        return numbered(key)[1]

    def _bins(self, boxes: Indices, edge: Indices) -> Indices:
        """Return the bin of each node, (n,), all of whose nodes face alike."""
        # Nodes that are not drawn are binned apart, and left out of the next level.
        drawn = np.zeros(len(self.places), dtype=bool)
        drawn[self.triangles] = True
        key = 4 * boxes + 2 * drawn + self.border
        if edge.any():
            key = numbered(key)[1] * (int(edge.max()) + 1) + edge
        cluster = numbered(key)[1]
        away = dot(self.normals, self.normals[first_places(cluster)][cluster]) < 0
        away &= _are_opposite(cluster, away, self.normals)[cluster]
        cluster = numbered(2 * cluster + away)[1]
        return numbered(self._sheets(cluster, edge))[1]

    def _sheets(self, cluster: Indices, edge: Indices) -> Indices:
        """Return the sheet of each node, (n,): nodes of a cluster that are connected within it.

        Small ones are corners that a bin cuts off: they belong to a sheet beside them, or else to
        the largest of their cluster in the same connected part.
        """
        corners = self._joined
        sheet, at = _connected_within(cluster, corners)
        within = cluster[first_places(sheet)]
        if "part" not in self.__dict__:
            # Sheets are far fewer than nodes.
            part = _connected_sheets(at, len(within))[sheet][self.places]
            self.__dict__["part"] = _by_extent(part, self.field.points[0], self.triangles)
        parts = self.part[first_places(sheet)]
        within = numbered(within * (int(parts.max()) + 1) + parts)[1]
        size = np.bincount(sheet)
        order = np.argsort(size, kind="stable")
        largest = np.zeros(int(within.max()) + 1, dtype=np.intp)
        largest[within[order]] = order  # the last value written stays
        small = size < SHEET_SHARE * size[largest[within]]
        target = np.where(small, largest[within], np.arange(len(size)))
        sides = _unlike_sides(small, at, corners)
        node, beside = np.where(small[sheet[sides[0]]], sides, sides[::-1])
        joins = (self.border[node] == self.border[beside]) & (edge[node] == edge[beside])
        target[sheet[node[joins]]] = sheet[beside[joins]]
        return target[sheet]

    def _compact(self, cluster: Indices, edge: Indices) -> Indices:
        """Return clusters (n,) in which each node belongs to the nearest one beside it."""
        points = self.binned
        count = int(cluster.max()) + 1
        center = sums_at(cluster, points, count) / np.bincount(cluster)[:, None]
        normal = sums_at(cluster, self.normals, count)

        def gaps(node: Indices, number: Indices) -> Floats:
            # Column by column, which is several times as fast.
            along = zip(points.T, center.T, strict=True)
            return np.asarray(sum((c[node] - middle[number]) ** 2 for c, middle in along))

        parts = []
        first, second, third = cluster[self.triangles.T]
        triangles = self.triangles[(first != second) | (first != third)]
        for k in range(3):
            node = triangles[:, k - 1]
            beside = triangles[:, k]
            candidate = cluster[beside]
            alike = self.border[node] == self.border[beside]
            alike &= edge[node] == edge[beside]
            other = np.flatnonzero((cluster[node] != candidate) & alike)
            node = node[other]
            candidate = candidate[other]
            gap = gaps(node, candidate)
            nearer = np.flatnonzero(gap < gaps(node, cluster[node]))
            node = node[nearer]
            candidate = candidate[nearer]
            gap = gap[nearer]
            facing = np.einsum("nc,nc->n", self.normals[node], normal[candidate]) > 0
            parts.append((node[facing], candidate[facing], gap[facing]))
        node, candidate, gap = (np.concatenate(part) for part in zip(*parts, strict=True))
        order = np.argsort(-gap)  # the last value written to a node stays
        result = cluster.copy()
        result[node[order]] = candidate[order]
        return result


class Levels(Sequence[Clusters]):
    """A field and its coarser levels; the last has at most ``nodes`` nodes, if possible.

    The last two are made at once from the whole field, and the others when they are needed.
    """

    def __init__(self, field: FlowField, nodes: int) -> None:
        self._lock = ProcessLock()
        self._made: dict[int, Clusters] = {}
        finish(self._make(field, nodes), FIRST_LEVELS, "Simplifying")

    def _make(self, field: FlowField, nodes: int) -> Generator[None, None, None]:
        """Make the finest level, and the last two; yield before each of them."""
        yield
        finest = self._made[0] = Clusters.of(field)
        last, boxes = _last_from(finest, nodes)
        while last > 0:
            yield
            self._made[last] = finest.coarser(last, boxes)
            boxes = None
            if 0 < self.nodes(last) < MOST_LEFT**last * self.nodes(0):
                break
            del self._made[last]
            last -= 1
        self._last = last
        while self.nodes(self._last) > nodes:
            yield
            coarser = self._made[self._last].coarser()
            if not 0 < coarser.field.shape[1] < MOST_LEFT * self.nodes(self._last):
                break
            self._last += 1
            self._made[self._last] = coarser

    def __len__(self) -> int:
        return self._last + 1

    @overload
    def __getitem__(self, at: int) -> Clusters: ...

    @overload
    def __getitem__(self, at: slice) -> list[Clusters]: ...

    def __getitem__(self, at: int | slice) -> Clusters | list[Clusters]:
        numbers = range(len(self))[at]
        if isinstance(numbers, range):
            return [self[number] for number in numbers]
        with self._lock:
            if numbers not in self._made:
                self._made[numbers] = self._made[0].coarser(numbers)
            return self._made[numbers]

    def nodes(self, level: int) -> int:
        """Return the number of nodes of a level, about it where it is not yet made."""
        if level in self._made:
            return self._made[level].field.shape[1]
        # By equal factors from the finest level to the next coarser one.
        coarse = min(made for made in self._made if made > level)
        factor = float(self.nodes(coarse) / self.nodes(0)) ** (1 / coarse)
        return int(self.nodes(0) * factor**level)


def _last_from(finest: Clusters, nodes: int) -> tuple[int, Indices | None]:
    """Return the least steps to a level of which the next has at most about this many nodes.

    The second value has its boxes, ``None`` for the finest level.
    """
    count = finest.field.shape[1]
    steps = 0
    boxes = None
    while count > nodes:
        # Every step leaves at least about a quarter.
        steps = max(steps + 1, int(np.ceil(np.log2(count / nodes) / 2)))
        some: Indices | slice = slice(None)
        if steps > 1:
            boxes = finest.boxes(steps - 1)
            # Boxes of the next level contain whole ones, and these are far fewer than nodes.
            some = first_places(boxes)
        left = int(finest.boxes(steps, some).max()) + 1
        if left >= MOST_LEFT * count:
            break
        count = left
    return max(steps - 1, 0), boxes


def _are_opposite(bins: Indices, away: Bools, normals: Floats) -> Bools:
    """Return in which bins nodes (n,) that face ``away`` and the others are two sides of a sheet.

    In noise both face about the same way, in their means.
    """
    count = int(bins.max(initial=-1)) + 1
    mixed = np.zeros(count, dtype=bool)
    mixed[bins[away]] = True
    near = np.flatnonzero(mixed[bins])
    sums = sums_at(2 * bins[near] + away[near], normals[near], 2 * count).reshape(count, 2, 3)
    first, second = sums.swapaxes(0, 1)
    return np.asarray(dot(first, second) < OPPOSITE * norm(first) * norm(second))


def _without_noise(
    around: Any, share: Indices, points: Floats, crosses: Floats, areas: Floats
) -> tuple[Floats, Floats]:
    """Return positions and normals (N, 3); where many triangles are turned, means around.

    Noise may be higher than bins, which would cut through it.
    """
    normals = np.asarray(around.T @ crosses)
    total = around.T @ areas
    is_rough = norm(normals) < EVEN_SHARE * total
    if np.count_nonzero(is_rough) < ROUGH_SHARE * np.count_nonzero(total):
        return points, normals
    share = np.maximum(share, 1)
    values = np.hstack([points, normals])
    for _ in range(SMOOTHING):
        means = (around.T @ (around @ values)) / (3 * share[:, None])
        values = np.where(is_rough[:, None], means, values)
    return values[:, :3], values[:, 3:]


def _border_nodes(surface: TriangleSurface) -> Bools:
    """Return which nodes are ends of a side without a drawn triangle beyond it, (N,)."""
    if surface.faces_alike:
        uneven = surface.uneven
        if not surface.cells.all():
            uneven = uneven_nodes(surface.joined[surface.cells], surface.shape[1])
        if surface.has_faces:
            uneven = uneven[surface.places]
        return uneven
    triangles = surface.triangles
    beside = surface.neighbours
    open_sides = (beside < 0) | ~surface.cells[beside]
    open_sides[~surface.cells] = False
    border = np.zeros(surface.shape[1], dtype=bool)
    for k in range(3):
        for offset in (1, 2):
            border[triangles[open_sides[:, k], (k + offset) % 3]] = True
    return border


def _connected_within(cluster: Indices, corners: Indices) -> tuple[Indices, Indices]:
    """Return numbers of connected nodes of the same cluster, (n,), and those of corners (M, 3)."""
    # The first sides connect nearly all.
    first = np.empty(len(corners), dtype=bool)
    for block in row_blocks(len(corners), 1):
        within = cluster.take(corners[block, ::2])
        first[block] = within[:, 0] == within[:, 1]
    linked = np.flatnonzero(first)
    sheet = connected_items(corners[linked, 0], corners[linked, 2], len(cluster))
    at = np.empty(corners.shape, dtype=sheet.dtype)
    pairs = [np.empty((2, 0), dtype=sheet.dtype)]
    for block in row_blocks(len(corners), 1):
        within = cluster.take(corners[block])
        sheets = sheet.take(corners[block])
        at[block] = sheets
        for k in (1, 2):
            is_linked = within[:, k] == within[:, k - 1]
            others = np.flatnonzero(is_linked & (sheets[:, k] != sheets[:, k - 1]))
            pairs.append(np.stack([sheets[others, k], sheets[others, k - 1]]))
    begins, ends = np.concatenate(pairs, axis=1)
    if not len(begins):
        return sheet, at
    merged = connected_items(begins, ends, int(sheet.max()) + 1)
    for block in row_blocks(len(corners), 1):
        at[block] = merged.take(at[block])
    return merged[sheet], at


def _unlike_sides(marked: Bools, at: Indices, corners: Indices) -> Indices:
    """Return ends (2, n) of sides of triangles (M, 3), between marked sheets and others.

    ``at`` has the sheets of the corners, (M, 3).
    """
    apart = np.empty((3, len(corners)), dtype=bool)
    for block in row_blocks(len(corners), 1):
        is_marked = marked.take(at[block])
        for k in range(3):
            apart[k, block] = is_marked[:, k] != is_marked[:, k - 1]
    pairs = []
    for k in range(3):
        sides = np.flatnonzero(apart[k])
        pairs.append(np.stack([corners[sides, k], corners[sides, k - 1]]))
    return np.concatenate(pairs, axis=1)


def _connected_sheets(corners: Indices, count: int) -> Indices:
    """Return the number of the connected part of each sheet, (count,), at corners (M, 3)."""
    first, second, third = corners.T
    across = np.flatnonzero((first != second) | (first != third))
    return connected_nodes(corners[across], count)


def _by_extent(part: Indices, points: Floats, triangles: Indices) -> Indices:
    """Return the number of the part of each node, (N,), the smallest part first.

    Nodes that are not drawn belong to the part of the first triangle.
    """
    if not part.any():
        return part
    is_used = np.zeros(len(points), dtype=bool)
    is_used[triangles] = True
    part = np.where(is_used, part, part[triangles[0, 0]])
    kinds, part = numbered(part)
    if len(kinds) == 1:
        return part
    order = np.argsort(part_extents(points, part))
    ranks: Indices = np.argsort(order)
    return ranks[part]


def _faces(surface: TriangleSurface) -> Indices:
    """Return the part without sharp edges of each node, (N,), from 1 if there are several."""
    count = surface.shape[1]
    if not surface.has_faces:
        return np.zeros(count, dtype=np.intp)
    return connected_nodes(surface.triangles, count) + 1


def _edges(face: Indices, places: Indices) -> Indices:
    """Return numbers from 1, (n,), the same for nodes that lie in or between the same faces."""
    if not face.any():
        return face
    least = face.copy()
    most = face.copy()
    np.minimum.at(least, places, face)
    np.maximum.at(most, places, face)
    count = np.bincount(places, minlength=len(face))[places]
    shared = np.flatnonzero(count > 1)
    at = places[shared]
    kinds = np.stack([least[at], most[at], count[shared]], axis=-1)
    result = face.copy()
    between = np.unique(kinds, axis=0, return_inverse=True)[1].ravel()
    result[shared] = between + int(face.max()) + 1
    return result


def _averaged(field: FlowField, number: Indices, places: Indices, triangles: Indices) -> FlowField:
    """Return a field on other triangles, whose nodes have the means of the nodes of a number.

    All nodes (n,) at the ``places`` of others, (n,), have one position.
    """
    kept = np.flatnonzero(number >= 0)
    count = int(number.max(initial=-1)) + 1
    summed = partial(sums_at, number[kept], count=count, of=kept)
    placed = partial(sums_at, places[number[kept]], count=count, of=kept)

    def means(steps: Steps) -> Steps:
        return map_steps(steps, lambda step: known_means(step[0], summed)[None])

    scalars: Scalars[Steps] = Scalars()
    for name, steps in field.scalars.items():
        if name in field.on_cells:
            scalars[name] = steps
        else:
            scalars[name] = means(steps)
    return replace(
        field,
        points=known_means(field.points[0], placed)[None, places],
        velocity=means(field.velocity),
        valid=np.ones((1, count), dtype=bool),
        scalars=scalars,
        triangles=triangles,
    )


def _sides(around: Any, share: Indices, areas: Floats, extent: float) -> Floats:
    """Return the sides of the first bins, (N,), in proportion to edges; needles are not counted.

    ``share`` (N,) is the number of triangles around a node.
    """
    size = np.sqrt(areas)
    for _ in range(SMOOTHING):
        nodal = np.divide(around.T @ size, share, out=np.zeros(len(share)), where=share > 0)
        size = (around @ nodal) / 3
    # Nodes of cells of about one size must not fall on both sides of a power of two.
    least = extent / MOST_BINS / FIRST_EDGES
    typical = max(float(np.median(nodal[share > 0])), least)
    steps = np.rint(np.log2(np.maximum(nodal, least) / typical))
    return np.asarray(FIRST_EDGES * typical * 2.0**steps)


def _untangled(points: Floats, triangles: Indices, normals: Floats, border: Bools) -> Bools:
    """Move nodes of inverted triangles to the middle of their neighbours; return the others."""
    turned = _turned(points, triangles, normals)
    for _ in range(UNTANGLING):
        moved = np.zeros(len(points), dtype=bool)
        moved[triangles[turned]] = True
        moved &= ~border
        if not moved.any():
            break
        changed = np.flatnonzero(touching(triangles, moved))
        near = triangles[changed]
        around = incidence(near, len(points))
        # Of each triangle, the sum of the other two corners.
        total = around.T @ (around @ points) - around.sum(axis=0)[:, None] * points
        count = 2 * around.sum(axis=0)
        points[moved] = total[moved] / count[moved, None]
        turned[changed] = _turned(points, near, normals)
    return ~turned


def _turned(points: Floats, triangles: Indices, normals: Floats) -> Bools:
    """Return which triangles (M,) face away from the normals of their corners."""
    normal = incidence(triangles, len(normals)) @ normals
    return np.asarray(dot(triangle_normals(points, triangles), normal) <= 0)


def part_extents(points: Floats, part: Indices) -> Floats:
    """Return the longest side of each part of points (N, 3), numbered from 0."""
    order = np.argsort(part, kind="stable")
    first = np.flatnonzero(np.diff(part[order], prepend=-1))
    ordered = points[order]
    sides = np.maximum.reduceat(ordered, first) - np.minimum.reduceat(ordered, first)
    return np.asarray(sides.max(axis=1))
