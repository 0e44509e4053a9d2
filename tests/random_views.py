"""Random views for property tests: surfaces of all kinds, smooth flows, settings and cameras."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import pyvista as pv
from hypothesis import strategies as st
from matrix import View
from strategies import Strategy
from triangle_meshes import cube, random_plane, sphere

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.rendering.camera import Camera

Mesh = tuple[Floats, Any]  #: Nodes (J, I, 3) or (N, 3), and triangles (M, 3) or ``None``.


def _grid(kind: str) -> Mesh:
    """Return a structured surface about two wide around the origin."""
    u, v = np.meshgrid(np.linspace(0, 1, 25), np.linspace(0, 1, 17))
    turn, tilt = 2 * np.pi * u, np.pi * v
    match kind:
        case "sphere":
            parts = [np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)]
        case "torus":
            ring = 1 + 0.4 * np.cos(2 * tilt)
            parts = [ring * np.cos(turn), ring * np.sin(turn), 0.4 * np.sin(2 * tilt)]
        case "wave":
            parts = [2 * u - 1, 2 * v - 1, 0.3 * np.sin(turn)]
        case "fold":
            parts = [np.maximum(2 * u - 1, 0), 2 * v - 1, np.minimum(2 * u - 1, 0)]
        case _:
            parts = [2 * u - 1, 2 * v - 1, 0 * u]
    return np.stack(parts, axis=-1), None


def _body(make: Callable[[], Any]) -> Mesh:
    mesh = make().triangulate().clean()
    return np.asarray(mesh.points, float), mesh.regular_faces.astype(int)


def _scattered() -> Mesh:
    points, triangles = random_plane(np.random.default_rng(7), 200)
    return 2 * points - [1, 1, 0], triangles


SURFACES: dict[str, Callable[[], Mesh]] = {
    "plane": lambda: _grid("plane"),
    "holes": lambda: _grid("plane"),
    "wave": lambda: _grid("wave"),
    "fold": lambda: _grid("fold"),
    "torus": lambda: _grid("torus"),
    "sphere with poles": lambda: _grid("sphere"),
    "triangles": _scattered,
    "triangles with holes": _scattered,
    "triangulated sphere": lambda: sphere(2),
    "cube": lambda: cube(5),
    "cylinder": lambda: _body(
        lambda: pv.Cylinder(resolution=20, height=2).triangulate().subdivide(1)
    ),
    "octahedron": lambda: _body(lambda: pv.Octahedron().subdivide(3)),
}
FLAT = ("plane", "triangles")


@cache
def mesh_of(kind: str) -> Mesh:
    """Return a surface by its kind, made once."""
    return SURFACES[kind]()


@dataclass(frozen=True, eq=False)
class Flow:
    """A velocity that is linear in space, and between its steps in time."""

    means: Floats  #: Velocity at the origin, (T, 3).
    gradients: Floats  #: Change of the velocity by position, (T, 3, 3).

    def at(self, points: Floats, time: float) -> Floats:
        """Return the velocity at points (..., 3) and a time from 0."""
        steps = np.arange(len(self.means))
        mean = [np.interp(time, steps, part) for part in self.means.T]
        flat = self.gradients.reshape(len(steps), 9)
        gradient = np.reshape([np.interp(time, steps, part) for part in flat.T], (3, 3))
        return np.asarray(mean + points @ gradient.T)

    def field(self, kind: str) -> FlowField:
        """Return the field on a surface of a kind."""
        points, triangles = mesh_of(kind)
        velocity = np.stack([self.at(points, step) for step in range(len(self.means))])
        if "holes" in kind:
            inside = np.linalg.norm(points - [0.3, 0.2, 0.0], axis=-1) < 0.35
            velocity[:, inside] = np.nan
        if triangles is None:
            return FlowField.from_arrays(points, velocity)
        return FlowField.from_triangles(points, triangles, velocity)


@st.composite
def flows(draw: Any, *, most_steps: int = 3) -> Flow:
    """A flow with or without time, calm or with critical points."""
    rng = np.random.default_rng(draw(st.integers(0, 2**20)))
    steps = draw(st.sampled_from([1, 1, most_steps]))
    mean = rng.normal(size=3)
    mean /= np.linalg.norm(mean)
    means = mean + draw(st.sampled_from([0.0, 0.3])) * rng.normal(size=(steps, 3))
    return Flow(means, draw(st.sampled_from([0.0, 0.2, 1.0])) * rng.normal(size=(steps, 3, 3)))


@st.composite
def cameras(draw: Any, kind: str) -> Camera:
    """A camera that sees a node of a surface from outside of it."""
    points = mesh_of(kind)[0].reshape(-1, 3)
    rng = np.random.default_rng(draw(st.integers(0, 2**20)))
    node = points[rng.integers(len(points))] + 1e-3 * rng.normal(size=3)
    outward = node + 0.3 * rng.normal(size=3)
    if np.ptp(points[:, 2]) < 1e-9:
        outward = np.array([0.0, 0.0, 1.0]) + 0.4 * rng.normal(size=3) * [1, 1, 0]
    outward /= np.linalg.norm(outward)
    far = 10.0 ** draw(st.floats(-1.5, 0.5))
    up = np.cross(outward, np.roll(outward, 1) + np.array([0.1, 0.2, 0.3]))
    if draw(st.booleans()):
        position = node + 6 * outward
        return Camera(tuple(position), tuple(node), tuple(up), parallel=True, parallel_scale=far)
    return Camera(tuple(node + 4 * far * outward), tuple(node), tuple(up))


SETTINGS: dict[str, Strategy] = {
    "lines": st.sampled_from(["pathlines", "streamlines"]),
    "kernel": st.sampled_from(["hann", "box", "ramp"]),
    "two_sided": st.booleans(),
    "texture": st.sampled_from(["dense", "streaklets"]),
    "motion": st.sampled_from(["off", "speed"]),
    "samples": st.integers(5, 25),
    "grain": st.floats(0.8, 4.0),
    "spacing": st.floats(0.7, 1.3),
    "fade": st.floats(0.0, 1.0),
    "seed": st.integers(0, 99),
    "show_level": st.booleans(),
}


@st.composite
def views(draw: Any) -> tuple[str, View]:
    """A view with the kind of its surface."""
    kind = draw(st.sampled_from(sorted(SURFACES)))
    flow = draw(flows())
    settings = draw(st.fixed_dictionaries({}, optional=SETTINGS))
    time = None
    if len(flow.means) > 1:
        time = draw(st.sampled_from([0.0, 1.0, 2.0]) | st.floats(0.0, len(flow.means) - 1.0))
    field = flow.field(kind)
    camera, clock = draw(cameras(kind)), draw(st.floats(0.0, 9.0))
    return kind, View(lambda: field, camera, settings, time, clock)
