"""Trace slices on triangles, whose displacements are in space."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

import numpy as np

from flowtex._util.array_types import Bools, Floats
from flowtex._util.progress import track
from flowtex.field import FlowField
from flowtex.field.triangles.surface import TriangleSurface
from flowtex.trace.compose import Map
from flowtex.trace.integrate import MOST_CELLS, Paths
from flowtex.trace.lags import small_cell
from flowtex.trace.slices import TraceSlices
from flowtex.trace.triangles.compose import DIRECT_STEPS, Composition, direct_lags
from flowtex.trace.triangles.integrate import begin, integrate
from flowtex.trace.triangles.motion import (
    ChangingMotion,
    Motion,
    SteadyMotion,
    TriangleMesh,
    speed_floor,
)

#: Particles followed together.
BLOCK = 16384


def triangle_slices(
    field: FlowField,
    steps: list[int],
    parameter: str,
    lags: Floats,
    unit: Floats,
    chosen: Bools,
    *,
    two_sided: bool,
    tolerance: float,
    compose: bool,
    run: Map,
    progress: bool,
) -> TraceSlices:
    """Follow the paths through some nodes, ``chosen`` (1, N); others have reach and path 0.

    Composition needs the paths around them: all are followed then. Lags (M,) are in
    multiples of ``unit`` (1, N), and ``run`` maps a function over blocks.
    """
    mesh, points, direct = _mesh(field), field.points[0], len(lags)
    if compose and len(steps) == 1:
        direct = _direct_lags(field, parameter, lags, unit)
    followed = chosen if direct == len(lags) else field.valid
    at = np.flatnonzero(followed[0] & (np.diff(mesh.first) > 0))
    sides = (-1.0, 1.0) if two_sided else (-1.0,)
    displacement = np.zeros((len(sides), len(steps), len(lags), *field.points.shape), np.float32)
    reach = np.zeros((len(sides), len(steps), *field.shape), np.float32)
    motions = [_motions(field, steps, parameter, side) for side in sides]
    compositions: list[Composition] = []
    if direct < len(lags):
        compositions = [
            Composition(cast("SteadyMotion", motion[0]), points, lags * unit.flat[0], direct, moved)
            for motion, moved in zip(motions, displacement[:, 0, :, 0], strict=True)
        ]

    def work(job: tuple[int, int, slice]) -> None:
        side, step, block = job
        motion, nodes = motions[side][step], at[block]
        triangle, corner = np.divmod(begin(motion, nodes), 3)
        shares = np.stack([corner == 1, corner == 2]).astype(float)
        units = unit[0, nodes]
        due = lags[:direct, None] * units
        options: dict[str, Any] = {"tolerance": tolerance, "last": float(lags[-1]) * units}
        if compositions:
            options["most_steps"] = DIRECT_STEPS
        paths = integrate(motion, points, triangle, shares, due, **options)
        start = points[nodes]
        for m in range(direct):
            moved = paths.positions(mesh, points, m) - start
            displacement[side, step, m, 0, nodes] = np.clip(moved, -MOST_CELLS, MOST_CELLS)
        reach[side, step, 0, nodes] = paths.reach / units
        if compositions:
            compositions[side].begin(nodes, paths)

    blocks = [slice(first, first + BLOCK) for first in range(0, len(at), BLOCK)]
    jobs = [(a, b, c) for a in range(len(sides)) for b in range(len(steps)) for c in blocks]
    for _ in track(run(work, jobs), len(jobs), "Tracing", show=progress):
        pass
    for side, composition in enumerate(compositions):
        composition.complete(at, run)
        reach[side, 0, 0] = composition.reach / unit[0]
    return TraceSlices(
        lags=lags,
        unit=unit,
        displacement=displacement[0],
        forward=displacement[1] if two_sided else None,
        rate=_rates(field, steps, parameter) * unit[..., None],
        reach=reach[0],
        forward_reach=reach[1] if two_sided else None,
        nodes=field.points,
        times=field.times[steps],
        parameter=parameter,
    )


def _direct_lags(field: FlowField, parameter: str, lags: Floats, unit: Floats) -> int:
    """Return how many of the lags are integrated; the others are composed."""
    if not field.steady or field.sign_free or not np.all(unit == unit.flat[0]):
        return len(lags)
    speed = field.index_velocity.speed[0][field.valid]
    moving = speed[speed > 0]
    pace = float(np.median(moving)) if parameter == "time" and len(moving) else 1.0
    return direct_lags(lags, pace * float(unit.flat[0]) / small_cell(field))


def triangle_paths(
    field: FlowField,
    start: Floats,
    lags: Floats,
    *,
    step: int,
    parameter: str,
    direction: float,
    tolerance: float,
) -> Paths:
    """Return what :func:`flowtex.trace.paths` does; a path that has ended stays at its end."""
    surface, mesh = _surface(field), _mesh(field)
    motion = _motions(field, [step], parameter, direction)[0]
    triangle = np.clip(np.floor(start[:, 1]).astype(np.intp), 0, len(mesh.corners) - 1)
    second = np.clip(start[:, 1] - triangle, 0.0, 1.0)
    shares = np.stack([second, np.clip(start[:, 0], 0.0, 1.0 - second)])
    usable = surface.cells[triangle]
    due = np.broadcast_to(lags[:, None], (len(lags), int(usable.sum()))).copy()
    paths = integrate(
        motion, field.points[0], triangle[usable], shares[:, usable], due, tolerance=tolerance
    )
    positions, reach = np.repeat(start[None], len(lags), axis=0), np.zeros(len(start))
    two = np.moveaxis(paths.shares, 1, -1)
    weights = np.concatenate([1 - two.sum(axis=-1, keepdims=True), two], axis=-1)
    positions[:, usable] = surface.index_of(paths.triangle, weights)
    reach[usable] = paths.reach
    nothing = np.zeros(len(start), dtype=bool)
    return Paths(positions, reach, nothing, nothing)


def _mesh(field: FlowField) -> TriangleMesh:
    return TriangleMesh.of(_surface(field))


def _surface(field: FlowField) -> TriangleSurface:
    return cast("TriangleSurface", field.surface)


def _motions(
    field: FlowField, steps: Sequence[int], parameter: str, direction: float
) -> list[Motion]:
    """Return one motion for each destination time."""
    if field.steady:
        return [SteadyMotion(field, direction, by_length=parameter == "arclength")] * len(steps)
    components = np.ascontiguousarray(field.index_velocity.components).reshape(-1, 2)
    mesh, times = _mesh(field), field.times
    return [ChangingMotion(mesh, components, times, float(times[n]), direction) for n in steps]


def _rates(field: FlowField, steps: Sequence[int], parameter: str) -> Floats:
    """Return velocities at the nodes, (T, 1, N, 2), by arc length of unit length."""
    flow = field.index_velocity
    rate = np.asarray(flow.components[list(steps)])
    if parameter == "arclength":
        speed = flow.speed[0]
        floor = speed_floor(speed)
        rate = np.divide(
            rate, speed[..., None], out=np.zeros_like(rate), where=(speed > floor)[..., None]
        )
    return np.where(field.valid[..., None], rate, 0.0)
