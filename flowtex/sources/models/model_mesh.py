"""A mesh of polygons in the file of a model, cut into triangles, and scattered points as a mesh."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Floats, Indices
from flowtex.errors import FieldError
from flowtex.field import units
from flowtex.field.earth.projection import EARTH_RADIUS, GLOBE, Projection
from flowtex.field.triangles.triangle_nodes import nodal_means, triangle_normals
from flowtex.remedies import Remedy
from flowtex.sources.datasets.axes import FACES, NODES
from flowtex.sources.models.scattered import edge_length, join_points
from flowtex.sources.reader_errors import values_in

if TYPE_CHECKING:
    import xarray as xr

#: The kind of a mesh whose faces are triangles between neighbours.
POINTS = "points"
#: Decimals of degrees to which bounds of neighbours agree.
SAME_DEGREES = 5
#: Share of the extent of a plane up to which they agree there.
SAME_SHARE = 1e-7
LONGITUDES = re.compile(r"lon|lambda", re.IGNORECASE)
#: Names of longitudes that ICON gives in radians, of cells, edges and vertices.
OF_ICON = re.compile(r"[cev]lon(_vertices)?$")
#: Longitude below which all values of such a model are in radians.
MOST_RADIANS = 6.5
RADIANS = re.compile(r"^rad(ian)?s?$", re.IGNORECASE)


@dataclass(frozen=True, eq=False)
class Mesh:
    """A mesh of polygons; its numbers are read when they are requested."""

    kind: str  #: Name of the convention.
    #: Coordinates of the nodes, or of the corners of each face where ``corners`` is missing.
    x: xr.DataArray
    y: xr.DataArray
    corners: xr.DataArray | None = None  #: Nodes of each face.
    counts: xr.DataArray | None = None  #: Number of corners of each face, where these differ.
    first: int = 0  #: Index of the first node.
    #: Longest edge between scattered points, as :func:`edge_length` reads it.
    max_edge: float | str | None = None

    @property
    def dims(self) -> tuple[str, str]:
        """Names of the dimensions of nodes and of faces in the files."""
        if self.kind == POINTS:
            return str(self.x.dims[0]), ""
        if self.corners is None:
            return "", str(self.x.dims[0])
        return _dim(self.x, NODES), _dim(self.corners, FACES)

    @property
    def coordinates(self) -> str:
        """Names of the coordinates that give positions."""
        names = dict.fromkeys((str(self.x.name), str(self.y.name)))
        return " and ".join(names)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of its variables."""
        parts = (self.x, self.y, self.corners, self.counts)
        return tuple(str(part.name) for part in parts if part is not None)

    @property
    def is_earth(self) -> bool:
        """Whether the coordinates are longitude and latitude, and not those of a plane."""
        unit = str(self.x.attrs.get("units", ""))
        name = str(self.x.name)
        if units.is_angle(unit):
            return True
        if units.measures(unit, units.LENGTHS):
            return False
        description = str(self.x.attrs.get("standard_name", "")) or name
        if "projection" in description:
            return False
        if self.kind == "SCHISM" and not unit:
            # Newer files have no attributes.
            x, y = (np.abs(c) for c in self._raw)
            return bool(np.nanmax(x) <= 360 and np.nanmax(y) <= 90)
        return bool(LONGITUDES.search(description)) or name == "nodes"

    @property
    def unit(self) -> str:
        """Unit of positions in a plane; empty where unknown."""
        unit = str(self.x.attrs.get("units", ""))
        if units.measures(unit, units.LENGTHS):
            return units.symbol(unit)
        return ""

    @property
    def greatest_edge(self) -> float | None:
        """The longest edge in the unit of the positions, or in metres on the Earth."""
        if self.max_edge is None:
            return None
        if self.is_earth:
            return edge_length(self.max_edge, "m", default="km")
        return edge_length(self.max_edge, self.unit, default=self.unit)

    @property
    def other_edge(self) -> Remedy:
        """The argument that limits edges, with the longest one of now, rounded up."""
        edges = self.positions[self.faces] - self.positions[np.roll(self.faces, 1, axis=1)]
        length = float(np.linalg.norm(edges, axis=-1).max())
        unit = self.unit
        if self.is_earth:
            # Arcs are longer than their chords.
            half = min(length / 2 / EARTH_RADIUS, 1.0)
            length = 2 * EARTH_RADIUS * np.arcsin(half) / 1000
            unit = "km"
        step = 10.0 ** (np.floor(np.log10(length)) - 1)
        value: float | str = float(f"{np.ceil(length / step) * step:.6g}")
        if unit:
            value = f"{value:g} {unit}"
        return Remedy("max_edge", value, "for shorter or longer edges,")

    @cached_property
    def _raw(self) -> tuple[Floats, Floats]:
        parts = []
        for n, c in enumerate((self.x, self.y)):
            values = np.asarray(values_in(c), dtype=float)
            if c.ndim == 2 and self.corners is not None:  # both in one variable
                if values.shape[0] == 2:
                    values = values[n]
                else:
                    values = values[:, n]
            parts.append(values)
        return parts[0], parts[1]

    @cached_property
    def _joined(self) -> tuple[Floats, Floats, Indices]:
        """Coordinates of the nodes, (N,), and their numbers at faces, (F, K), -1 for none."""
        a, b = self._raw
        if self.is_earth:
            unit = str(self.x.attrs.get("units", ""))
            in_radians = self.kind in ("MPAS", "ICON", "FESOM") or OF_ICON.match(str(self.x.name))
            radians = RADIANS.match(unit) or (
                not unit and in_radians and np.nanmax(np.abs(a)) < MOST_RADIANS
            )
            if radians:
                a = np.degrees(a)
                b = np.degrees(b)
        else:
            b = b * (units.factor(str(self.y.attrs.get("units", "")), self.unit) or 1.0)
        if self.kind == POINTS:
            positions = _positions(a, b, self.is_earth)
            most = self.greatest_edge
            return a, b, join_points(positions, on_sphere=self.is_earth, max_edge=most)
        if self.corners is None:
            return _from_bounds(a, b, is_earth=self.is_earth)
        return a, b, _numbers(self, self.corners, len(a))

    @property
    def a(self) -> Floats:
        """Longitudes of the nodes in degrees, or x in metres, (N,)."""
        return self._joined[0]

    @property
    def b(self) -> Floats:
        """Latitudes of the nodes in degrees, or y in metres, (N,)."""
        return self._joined[1]

    @property
    def faces(self) -> Indices:
        """Numbers of the nodes of each face, (F, K), -1 where it has fewer corners than others."""
        return self._joined[2]

    @cached_property
    def positions(self) -> Floats:
        """Positions of the nodes, (N, 3): on the globe, or in the plane."""
        return _positions(self.a, self.b, self.is_earth)

    @cached_property
    def middles(self) -> tuple[Floats, Floats]:
        """Coordinates of the middles of the faces, (F,) each, as those of the nodes."""
        present = (self.faces >= 0)[..., None]
        with np.errstate(invalid="ignore"):
            p = (self.positions[self.faces] * present).sum(axis=1) / present.sum(axis=1)
        if self.is_earth:
            return Projection(GLOBE).lonlat(p)
        return (p[:, 0], p[:, 1])

    @cached_property
    def triangles(self) -> tuple[Indices, Indices]:
        """Triangles, (M, 3), and the number of the face that each is a part of, (M,)."""
        faces = self.faces.copy()
        if faces.shape[1] > 3:
            # The shorter diagonal of a quadrilateral makes the better triangles.
            p = self.positions
            four = (faces >= 0).sum(axis=1) == 4
            a = p[faces[four, 0]]
            b = p[faces[four, 1]]
            c = p[faces[four, 2]]
            d = p[faces[four, 3]]
            with np.errstate(invalid="ignore"):
                turn = np.linalg.norm(d - b, axis=1) < np.linalg.norm(c - a, axis=1)
            turned = np.flatnonzero(four)[turn]
            faces[turned, :4] = np.roll(faces[turned, :4], -1, axis=1)
        fans = []
        numbers = []
        for k in range(1, faces.shape[1] - 1):
            whole = (faces[:, [0, k, k + 1]] >= 0).all(axis=1)
            fans.append(faces[whole][:, [0, k, k + 1]])
            numbers.append(np.flatnonzero(whole))
        return np.concatenate(fans), np.concatenate(numbers)

    @cached_property
    def areas(self) -> Floats:
        """Areas of the faces, (F,)."""
        triangles, numbers = self.triangles
        doubled = np.nan_to_num(np.linalg.norm(triangle_normals(self.positions, triangles), axis=1))
        return np.asarray(np.bincount(numbers, doubled / 2, len(self.faces)))

    def at_nodes(self, values: Floats, dim: str) -> Floats:
        """Return values (N, ...) at the nodes; those in faces become means by area."""
        if dim == NODES:
            return values
        (step,) = nodal_means(values[None], self.faces, self.areas, len(self.a))
        return np.asarray(step)

    def vectors_at_nodes(self, u: Floats, v: Floats, dim: str) -> tuple[Floats, Floats]:
        """Return components (N,); those in faces are averaged in space, where directions agree."""
        if dim == NODES:
            return u, v
        if not self.is_earth:
            x, y = self.at_nodes(np.stack([u, v], axis=-1), dim).T
            return x, y
        globe = Projection(GLOBE)
        means = self.at_nodes(globe.vectors(*self.middles, u, v), dim)
        return globe.components(self.a, self.b, means)

    @property
    def words(self) -> str:
        """Words for the mesh and its size."""
        if self.kind == POINTS:
            text = f"{len(self.a):,} points joined by {len(self.faces):,} triangles"
            if self.max_edge is None:
                return text
            unit = self.unit
            if self.is_earth:
                unit = "km"
            length = self.max_edge
            if not isinstance(length, str):
                length = f"{length:g} {unit}".strip()
            return f"{text} with edges of up to {length}"
        kinds = {3: "triangles", 4: "quadrilaterals"}
        edges = np.unique((self.faces >= 0).sum(axis=1))
        if len(edges) == 1:
            name = kinds.get(int(edges[0]), "polygons")
        else:
            name = "polygons"
        return f"{self.kind}, {len(self.a):,} nodes, {len(self.faces):,} {name}"


def _positions(a: Floats, b: Floats, is_earth: bool) -> Floats:  # noqa: FBT001
    """Return positions, (N, 3), on the globe or in the plane."""
    if is_earth:
        return Projection(GLOBE).positions(a, b)
    return np.stack([a, b, np.zeros_like(a)], axis=-1)


def _dim(array: xr.DataArray, ours: str) -> str:
    if ours in array.dims:
        return ours
    return str(max(array.dims, key=lambda d: array.sizes[d]))


def _numbers(mesh: Mesh, corners: xr.DataArray, count: int) -> Indices:
    """Return the numbers of the nodes of faces, (F, K), from 0; -1 if missing."""
    _, faces = mesh.dims
    values = values_in(corners.transpose(faces, ...))
    fill = corners.attrs.get("_FillValue", corners.encoding.get("_FillValue"))
    present: Bools = np.asarray(np.isfinite(values))
    if fill is not None and np.isfinite(fill):
        present &= values != fill
    if mesh.counts is not None:
        present &= np.arange(values.shape[1]) < np.asarray(mesh.counts.values)[:, None]
    values = np.where(present, values, -1).astype(np.int64)
    first = mesh.first
    if present.any():
        # The numbers themselves are more reliable than their attributes.
        least = values[present].min()
        greatest = values[present].max()
        if greatest == count and first == 0:
            first = 1
        if least == 0 and greatest < count and mesh.kind != "MPAS":
            first = 0
    values = values - first
    present &= (values >= 0) & (values < count)
    if not present.any():
        numbers = f"{first} to {first + count - 1}"
        raise FieldError(f"{corners.name!r} has no numbers of nodes; expected {numbers}")
    if mesh.kind == "MPAS" and values.shape[1] == 3:
        present &= present.all(axis=1, keepdims=True)  # at the border of a region
    return _corners_first(np.where(present, values, -1))


def _from_bounds(a: Floats, b: Floats, *, is_earth: bool) -> tuple[Floats, Floats, Indices]:
    """Return one node for all corners of cells, (F, K) each, at one place."""
    present = np.isfinite(a) & np.isfinite(b)
    p = _positions(a[present], b[present], is_earth)
    if is_earth:
        unit = 10.0**-SAME_DEGREES * np.radians(EARTH_RADIUS)
    else:
        unit = SAME_SHARE * float(np.ptp(p, axis=0).max(initial=0.0)) or 1.0
    p = p - p.min(axis=0, initial=np.inf)
    places = np.round(p / unit).astype(np.int64)
    _, first, at = np.unique(places, axis=0, return_index=True, return_inverse=True)
    faces = np.full(a.shape, -1, dtype=np.intp)
    faces[present] = at.ravel()
    return a[present][first], b[present][first], _corners_first(faces)


def _corners_first(faces: AnyArray) -> Indices:
    """Return numbers of nodes with -1 after all others, also for repeated corners."""
    repeated = np.any(
        (faces[:, :, None] == faces[:, None, :]) & np.tri(faces.shape[1], k=-1, dtype=bool), axis=2
    )
    faces = np.where(repeated, -1, faces)
    order = np.argsort(faces < 0, axis=1, kind="stable")
    return np.asarray(np.take_along_axis(faces, order, axis=1), dtype=np.intp)
