"""Flows on which renderers are tried: flat and curved, with holes, seams and time."""

from __future__ import annotations

from functools import cache

import numpy as np
from triangle_meshes import cube, polygon, random_plane, soup, sphere, tube

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.field.earth.projection import Projection
from flowtex.field.uncertainty import with_uncertainty


@cache
def gyre(columns: int = 61, rows: int = 31) -> FlowField:
    """Two vortices on a bent grid, its nodes at numbers that single precision holds exactly."""
    s, t = np.meshgrid(np.linspace(0, 1, columns), np.linspace(0, 1, rows))
    x = 2 * (s + 0.06 * np.sin(2 * np.pi * s)) + 0.12 * np.sin(np.pi * t)
    points = np.rint(np.stack([x, t**1.3], axis=-1) * 1024) / 1024
    a, b = np.pi * points[..., 0], np.pi * points[..., 1]
    velocity = np.stack([-np.sin(a) * np.cos(b), np.cos(a) * np.sin(b)], axis=-1)
    return FlowField.from_arrays(points, velocity)


@cache
def fountain() -> FlowField:
    """Flow out of a point at (0.3125, 0.25) around which it turns, on a bent grid."""
    y, x = np.mgrid[-1:1:32j, -1:1:32j]
    points = np.rint(np.stack([x + 0.1 * np.sin(3 * y), y], axis=-1) * 1024) / 1024
    x, y = points[..., 0] - 0.3125, points[..., 1] - 0.25
    velocity = np.stack([x - y, x + y], axis=-1)
    return FlowField.from_arrays(points, velocity)


@cache
def scattered_fountain() -> FlowField:
    """Flow out of (0.3125, 0.25) on triangles."""
    points, triangles = random_plane(np.random.default_rng(5), 700)
    points = np.rint((2 * points - [1, 1, 0]) * 1024) / 1024
    x, y, _ = (points - [0.3125, 0.25, 0]).T
    return FlowField.from_triangles(points, triangles, np.stack([x, y, 0 * x], axis=-1))


@cache
def dense_gyre() -> FlowField:
    """The same with many cells in a pixel."""
    return gyre(201, 101)


@cache
def holed() -> FlowField:
    """A stream past a hole, where paths end."""
    y, x = np.mgrid[-1:1:41j, -1:1:41j]
    inside = np.hypot(x, y) < 0.4
    velocity = np.where(inside[..., None], np.nan, np.stack([1 + 0 * x, 0.3 * x], axis=-1))
    return FlowField.from_arrays(np.stack([x, y], axis=-1), velocity)


@cache
def torus() -> FlowField:
    """A closed surface, over which flow goes around and across."""
    a, b = np.meshgrid(np.linspace(0, 2 * np.pi, 49), np.linspace(0, 2 * np.pi, 25))
    radius = 1 + 0.4 * np.cos(b)
    points = np.stack([radius * np.cos(a), radius * np.sin(a), 0.4 * np.sin(b)], axis=-1)
    around = np.stack([-np.sin(a), np.cos(a), 0 * a], axis=-1)
    over = np.stack([-np.sin(b) * np.cos(a), -np.sin(b) * np.sin(a), np.cos(b)], axis=-1)
    velocity = (1 + 0.5 * np.sin(b))[..., None] * around + 0.6 * np.cos(2 * a)[..., None] * over
    return FlowField.from_arrays(points, velocity)


@cache
def swinging() -> FlowField:
    """A vortex that wanders, at three times."""
    y, x = np.mgrid[-1:1:31j, -1:1:31j]
    steps = [np.stack([-(y - 0.2 * t), x - 0.1 * t * t], axis=-1) for t in (0.0, 1.0, 2.0)]
    return FlowField.from_arrays(np.stack([x, y], axis=-1), np.stack(steps), times=[0.0, 0.4, 0.8])


@cache
def lines() -> FlowField:
    """Lines around a point that all point to the right: they turn over where x is 0."""
    y, x = np.mgrid[-1:1:32j, -1:1:32j]
    way = np.stack([-y, x], axis=-1) * np.where(y > 0, -1, 1)[..., None]
    return FlowField.from_arrays(np.stack([x, y], axis=-1), way, sign_free=True)


def uncertain(field: FlowField) -> FlowField:
    """Return a flow whose direction is not known at the right."""
    x = field.points[..., 0]
    return with_uncertainty(field, 1.2 * (x - x.min()) / np.ptp(x))


@cache
def scattered_gyre() -> FlowField:
    """Two vortices on triangles that face either way, around nodes at exact places."""
    points, triangles = random_plane(np.random.default_rng(5), 700)
    points, triangles = soup(np.random.default_rng(6), (points, triangles))
    points = np.rint(points * [2048, 1024, 0]) / 1024
    a, b = np.pi * points[:, 0], np.pi * points[:, 1]
    velocity = np.stack([-np.sin(a) * np.cos(b), np.cos(a) * np.sin(b)], axis=-1)
    return FlowField.from_triangles(points, triangles, velocity, scalars={"x": points[:, 0]})


@cache
def scattered_holed() -> FlowField:
    """A stream on triangles past a hole."""
    points, triangles = random_plane(np.random.default_rng(5), 1500)
    points = 2 * points - [1, 1, 0]
    inside = np.hypot(*points[:, :2].T) < 0.4
    velocity = np.stack([1 + 0 * points[:, 0], 0.3 * points[:, 0]], axis=-1)
    return FlowField.from_triangles(
        points, triangles, np.where(inside[:, None], np.nan, velocity), valid=~inside
    )


@cache
def scattered_swinging() -> FlowField:
    """A vortex on triangles that wanders, at three times."""
    points, triangles = random_plane(np.random.default_rng(5), 900)
    x, y, _ = (2 * points - 1).T
    steps = [np.stack([-(y - 0.2 * t), x - 0.1 * t * t], axis=-1) for t in (0.0, 1.0, 2.0)]
    return FlowField.from_triangles(
        2 * points - [1, 1, 0], triangles, np.stack(steps), times=[0.0, 0.4, 0.8]
    )


@cache
def rippled() -> FlowField:
    """Vortices on a sphere of triangles."""
    points, triangles = sphere(4)
    x, y, z = points.T
    slope = np.stack([(4 * x**3 - 12 * x * y * y) * z, (4 * y**3 - 12 * x * x * y) * z], axis=-1)
    axial = x**4 - 6 * x * x * y * y + y**4 - 0.35
    velocity = np.cross(points, np.column_stack([slope, axial]))
    return FlowField.from_triangles(points, triangles, velocity)


@cache
def folded(w: float = 0.0) -> FlowField:
    """A stream over a right angle between two planes, on triangles that are long across it.

    It goes up by ``w``.
    """
    s, y = np.meshgrid(np.linspace(-1, 1, 5), np.linspace(-1, 1, 101))
    points = np.stack([np.minimum(s, 0), y, -np.maximum(s, 0)], axis=-1).reshape(-1, 3)
    node = np.arange(s.size).reshape(s.shape)[:-1, :-1].ravel()
    corners = node, node + 1, node + s.shape[1] + 1, node + s.shape[1]
    halves = [[corners[k] for k in some] for some in ((0, 1, 2), (0, 2, 3))]
    triangles = np.concatenate(halves, axis=1).T
    return FlowField.from_triangles(points, triangles, np.tile([1.0, 0.6, w], (s.size, 1)))


def across(noise: float = 0.0) -> FlowField:
    """A uniform flow through a cube, so that two of its faces have no flow along them but noise."""
    points, triangles = cube(4)
    random = np.random.default_rng(3).normal(0, 1, points.shape)
    return FlowField.from_triangles(points, triangles, np.array([1.0, 0.0, 0.0]) + noise * random)


def screw() -> FlowField:
    """A flow along a closed cylinder that turns about it, on triangles that are long and thin."""
    points, triangles = tube(polygon(40, 4), np.linspace(-1, 1, 4), closed=True)
    velocity = np.column_stack([np.ones(len(points)), -points[:, 2], points[:, 1]])
    return FlowField.from_triangles(points, triangles, velocity)


def fan() -> FlowField:
    """A vortex beside the middle of a disc, on triangles that are long and thin."""
    corners = polygon(40, 1)
    points = np.concatenate([corners[:1] + share * (corners - corners[0]) for share in (0.5, 1)])
    inner = np.arange(1, 39)
    faces = [np.stack([0 * inner, inner, inner + 1], axis=-1)]
    faces += [np.stack([inner, inner + 40, inner + 41], axis=-1)]
    faces += [np.stack([inner, inner + 41, inner + 1], axis=-1)]
    velocity = np.column_stack([0.1 - points[:, 1], points[:, 0]])
    return FlowField.from_triangles(points, np.concatenate(faces), velocity)


def arched() -> FlowField:
    """A uniform flow with noise against a half cylinder, whose middle it crosses."""
    turn, height = np.meshgrid(np.linspace(-np.pi / 2, np.pi / 2, 61), np.linspace(-1, 1, 31))
    points = np.stack([np.cos(turn), np.sin(turn), height], axis=-1)
    random = np.random.default_rng(3).normal(0, 1, points.shape)
    return FlowField.from_arrays(points, np.array([1.0, 0.0, 0.0]) + 0.01 * random)


def ring() -> FlowField:
    """Curved, closed around, on a cone."""
    turn, height = np.meshgrid(np.linspace(0, 2 * np.pi, 81), np.linspace(0, 1, 40))
    radius = 1 + 0.4 * height
    points = np.stack([radius * np.cos(turn), radius * np.sin(turn), height], axis=-1)
    around = np.stack([-np.sin(turn), np.cos(turn), 0.3 * np.sin(5 * turn)], axis=-1)
    return FlowField.from_arrays(points, around)


def half_known(name: str, lon: Floats, lat: Floats, known_from: float) -> FlowField:
    """Return an eastward flow on a map, without data to the west of a longitude."""
    projection = Projection(name)
    lon, lat = np.meshgrid(lon, lat)
    east = np.where(lon < known_from, np.nan, 1.0)
    return FlowField.from_arrays(
        projection.positions(lon, lat),
        projection.vectors(lon, lat, east, 0 * lon),
        projection=projection,
    )
