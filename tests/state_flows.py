"""Small flows of all kinds, for tests that change what is shown in any order.

All of them lie around the origin and are about two units wide, so that a camera keeps them in view
when one takes the place of another.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from flows import torus
from hypothesis import strategies as st
from triangle_meshes import random_plane

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.field.steps import LazySteps

TIMES = np.array([0.0, 0.4, 1.0])  #: Steps of the series, which are not even.
LARGEST_WHOLE = 700  #: Most nodes of a flow that is not drawn in tiles.


def _vortex(x: Floats, y: Floats, time: float) -> Floats:
    """Velocity of a vortex that wanders, and turns faster with time, (..., 2)."""
    return (1 + time) * np.stack([-(y - 0.3 * time), x - 0.2 * time], axis=-1)


def _heights(x: Floats, y: Floats) -> Floats:
    """Values of both signs that move, (T, ...)."""
    return np.stack([np.sin(2 * x + time) - 0.3 * y for time in TIMES])


@cache
def series(columns: int = 15, rows: int = 13) -> FlowField:
    """A vortex that wanders over a bent grid, at three times."""
    y, x = np.mgrid[-1 : 1 : 1j * rows, -1 : 1 : 1j * columns]
    x = x + 0.1 * np.sin(3 * y)
    velocity = np.stack([_vortex(x, y, time) for time in TIMES])
    return FlowField.from_arrays(
        np.stack([x, y], axis=-1), velocity, times=TIMES, scalars={"height": _heights(x, y)}
    )


@cache
def lazy_series() -> FlowField:
    """The same flow, read step by step, without values."""
    field = series(17, 12)
    velocity = np.asarray(field.velocity)
    steps = LazySteps(len(TIMES), lambda step: velocity[step])
    return FlowField.from_arrays(field.points, steps, times=TIMES)


@cache
def large_series() -> FlowField:
    """The same flow on a grid that is drawn in tiles."""
    return series(61, 50)


def _on_triangles(nodes: int, seed: int) -> FlowField:
    points, triangles = random_plane(np.random.default_rng(seed), nodes)
    points = 2 * points - [1, 1, 0]
    x, y, _ = points.T
    velocity = np.stack([_vortex(x, y, time) for time in TIMES])
    return FlowField.from_triangles(
        points, triangles, velocity, times=TIMES, scalars={"height": _heights(x, y)}
    )


@cache
def triangle_series() -> FlowField:
    """The same flow on triangles."""
    return _on_triangles(120, 5)


@cache
def large_triangle_series() -> FlowField:
    """The same flow on triangles that are drawn in tiles."""
    return _on_triangles(1500, 6)


@cache
def steady() -> FlowField:
    """A vortex past a hole, with values of which some are missing."""
    y, x = np.mgrid[-1:1:14j, -1:1:16j]
    hole = np.hypot(x - 0.3, y) < 0.25
    height = np.where(x < -0.6, np.nan, x + 0.2)
    velocity = np.where(hole[..., None], np.nan, np.add(_vortex(x, y, 0.0), [0.2, 0.0]))
    return FlowField.from_arrays(np.stack([x, y], axis=-1), velocity, scalars={"height": height})


@cache
def volume() -> Any:
    """A mesh of three dimensions, of which planes are shown."""
    import pyvista as pv

    grid: Any = pv.ImageData(dimensions=(11, 9, 7), spacing=(0.2, 0.25, 0.3), origin=(-1, -1, -0.9))
    mesh = grid.cast_to_structured_grid()
    x, y, z = np.asarray(mesh.points).T
    mesh["wind"] = np.stack([-y + 0.3 * z, x, 0.2 * z], axis=-1)
    mesh["height"] = x * x + z
    return mesh


FLOWS: dict[str, Any] = {
    "series": series,
    "lazy series": lazy_series,
    "large series": large_series,
    "triangle series": triangle_series,
    "large triangle series": large_triangle_series,
    "steady": steady,
    "torus": torus,
}


pick = st.sampled_from
#: Values of settings that are cheap to draw.
SETTINGS: dict[str, st.SearchStrategy[Any]] = {
    "samples": pick([9, 25]),
    "texture": pick(["dense", "streaklets"]),
    "kernel": pick(["hann", "box"]),
    "two_sided": st.booleans(),
    "lod": st.booleans(),
    "grain": pick([1.5, 3.0]),
    "fixed_grain": st.booleans(),
    "resolution": pick([64, 1024]),
    "contrast": pick([0.5, 1.0]),
    "strength": pick([0.0, 0.5, 0.65]),
    "fade": pick([0.0, 0.05, 0.2]),
    "seed": pick([0, 7]),
    "motion": pick(["off", "uniform", "speed"]),
    "arrows": pick([0.0, 16.0]),
    "arrow_color": pick(["contrast", "scalars"]),
    "critical_points": pick([0, 10]),
    "separatrices": pick([0, 3]),
    "nullclines": st.booleans(),
    "show_level": st.booleans(),
    "lines": pick(["auto", "pathlines", "streamlines"]),
    "parameter": pick(["arclength", "time"]),
    "noise": pick(["procedural", "procedural", "texture", "image"]),
}
#: Values of the appearance.
APPEARANCE: dict[str, st.SearchStrategy[Any]] = {
    "scalars": pick(["speed", "height", "vorticity", False]),
    "cmap": pick([None, "magma", "coolwarm"]),
    "clim": pick([None, (0.1, 0.8), (-1.0, 1.0), "robust"]),
    "log_scale": st.booleans(),
    "norm": pick([None, "symlog"]),
    "n_colors": pick([None, 5]),
    "flip_scalars": st.booleans(),
    "color": pick(["#a0a0a0", "tomato"]),
    "opacity": pick([1.0, 1.0, 0.6]),
    "lighting": pick([None, True, False]),
    "visible": st.booleans(),
    "show_scalar_bar": pick([None, False, True]),
}


SETTING = st.one_of([st.tuples(st.just(name), values) for name, values in SETTINGS.items()])
LOOK = st.one_of([st.tuples(st.just(name), values) for name, values in APPEARANCE.items()])


def make_small(change: Any) -> None:
    """Draw flows of more than ``LARGEST_WHOLE`` nodes in small tiles."""
    from small_tiles import shrink

    shrink(change)
    for module in ("grid_levels", "triangle_pyramid"):
        change(f"flowtex.textures.tiles.{module}.ROOT_NODES", LARGEST_WHOLE)
