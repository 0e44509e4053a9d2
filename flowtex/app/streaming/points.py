"""Points of the surface for a page: their values, and the paths through them.

A path is read in a thread: with new textures it takes as long as a renderer takes to load them.
"""

from __future__ import annotations

import asyncio
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.app.server.page import mapping, number
from flowtex.app.streaming.viewport import Viewport
from flowtex.field import FlowField
from flowtex.field.locate import CURVED_TOLERANCE, FLAT_TOLERANCE
from flowtex.plotting.handle import FlowHandle
from flowtex.rendering.webgl.protocol import Header
from flowtex.scene.options import SPEED
from flowtex.scene.probe import PointValues, Probe, locate, probe, values_at

#: Length of the displayed path over that of the part with samples.
PATH_LENGTH = 4.0
#: Least number of samples on a side that determines this length, so that the path is visible.
FEWEST_SAMPLES = 10
#: Distance from a critical point, in pixels, that counts as on it.
MARK_REACH_PX = 9


class PointReader:
    """Reads points of a viewport for a page."""

    def __init__(self, viewport: Viewport) -> None:
        self._viewport = viewport
        self._worker = ThreadPoolExecutor(1, thread_name_prefix="flowtex reading")

    async def read(self, pane: object, at: object) -> Header | None:
        """Return the values at a point of a pane; ``None`` outside the surface.

        ``at`` has the ``place`` in the view, (x, y) from -1 to 1, the ``index`` (i, j) on a
        grid, or the ``position`` on triangles; with ``path`` the path as well, as the pane draws
        it, and the ``time`` that the page shows, which may be ahead of the one here.
        """
        panes = self._viewport.panes
        if type(pane) is not int or pane not in range(len(panes)):  # 0.0 is in a range as well
            return None
        shown = panes[pane]
        request = mapping(at)
        index = self._index(pane, request)
        if index is None:
            return None
        time = _time_of(shown.field, request.get("time"), shown.time)
        if not request.get("path"):
            point = values_of(values_at(shown.field, index, time), index)
            return {"point": point | self._mark(shown, point["position"])}
        scene = shown.scene.copy()
        clock = self._viewport.clock
        if time != scene.time:
            scene.time = time
        camera = self._viewport.camera
        size = self._viewport.pane_size

        def work() -> Probe | None:
            try:
                return probe(scene, index, pixel=camera, size=size, clock=clock)
            except ValueError:  # it is not in view
                return None

        probed = await asyncio.get_running_loop().run_in_executor(self._worker, work)
        if probed is None:
            return None
        read = path_of(probed, index, shown.field)
        read["point"] |= self._mark(shown, read["point"]["position"])
        return read

    def _mark(self, pane: FlowHandle, position: Sequence[float]) -> dict[str, str]:
        """Return the kind of a drawn critical point near a position, as ``mark``, or nothing."""
        scene = pane.scene
        if not (count := scene.settings.critical_points):
            return {}
        height = 2 * self._viewport.camera.height
        reach = MARK_REACH_PX * height / max(self._viewport.pane_size[1], 1)
        marks = []
        for point in scene.structure.points(scene.step)[:count]:
            marks.append((float(np.linalg.norm(point.position - position)), point.kind))
        distance, kind = min(marks, default=(np.inf, ""))
        if distance < reach:
            return {"mark": kind}
        return {}

    def _index(self, pane_number: int, request: Mapping[str, Any]) -> tuple[float, float] | None:
        """Return the point (j, i) of a request, or ``None`` outside the surface."""
        pane = self._viewport.panes[pane_number]
        field = pane.field
        place = _numbers(request.get("place"), 2)
        if place is not None:
            x = min(max(place[0], -1.0), 1.0)
            y = min(max(place[1], -1.0), 1.0)
            point = self._viewport.surface_point(x, y, pane_number)
            # Points on a flat surface are exact, so its border is as drawn.
            flat = pane.scene.whole.surface.frame is not None
            if flat:
                tolerance = FLAT_TOLERANCE
            else:
                tolerance = CURVED_TOLERANCE
            if point is None:
                return None
            return locate(field, point, tolerance=tolerance)
        if field.triangles is not None:
            position = _numbers(request.get("position"), 3)
            if position is None:
                return None
            return locate(field, position, tolerance=np.inf)
        index = _numbers(request.get("index"), 2)
        if index is None:
            return None
        last_j, last_i = field.surface.last_index
        i, j = index
        if 0 <= i <= last_i and 0 <= j <= last_j:
            return (j, i)
        return None

    def close(self) -> None:
        """Stop reading."""
        self._worker.shutdown(wait=False, cancel_futures=True)


def _time_of(field: FlowField, asked: object, present: float) -> float:
    """Return the time that is asked for, or the present one if the field has none such."""
    time = number(asked, *map(float, field.times[[0, -1]]))
    if time is None or field.steady:
        return present
    return time


def _numbers(value: object, count: int) -> list[float] | None:
    """Return a list of numbers that a page sends, ``None`` unless all are valid."""
    if not isinstance(value, (list, tuple)) or len(value) != count:
        return None
    numbers = []
    for item in value:
        checked = number(item)
        if checked is None:
            return None
        numbers.append(checked)
    return numbers


def values_of(point: PointValues, index: tuple[float, float]) -> Header:
    """Return a point for the client."""
    j, i = index
    values = {SPEED: point.speed, **point.scalars}
    if point.lonlat:
        on_earth = {"eastNorth": [point.eastward, point.northward]}
    else:
        on_earth = {}
    return {
        **on_earth,
        "position": point.position.tolist(),
        "index": [i, j],
        "values": {name: float(value) for name, value in values.items()},
    }


def path_of(found: Probe, index: tuple[float, float], field: FlowField) -> Header:
    """Return a point and the path through it for the client.

    ``path`` and ``sampled`` are points of the whole path and of the part with samples, downstream
    where the flow has a sign; ``samples`` are as in ``client/src/pointpath.ts``.
    """
    # Far beyond the samples the slices are too coarse to show, and no picture needs them.
    reach = float(np.fmax(np.abs(found.lags).max(), FEWEST_SAMPLES * abs(found.step)))
    near = np.abs(found.path_lags) <= PATH_LENGTH * reach
    path = found.path[near]
    path_lags = found.path_lags[near]
    inside = (path_lags <= found.lags[0]) & (path_lags >= found.lags[-1])
    lags = np.concatenate([path_lags[inside], found.lags])
    _, order = np.unique(-lags, return_index=True)
    return {
        "point": values_of(found.field_values, index),
        "path": {
            "path": path.tolist(),
            "sampled": np.concatenate([path[inside], found.points])[order].tolist(),
            "directed": not field.sign_free,
            "velocity": _in_surface(found, field).tolist(),
            "samples": samples_of(found),
        },
    }


def samples_of(found: Probe) -> list[dict[str, float | None]]:
    """Return the samples of a point for the client; an image has no noise."""
    samples = []
    for n, grey in enumerate(found.greys):
        noise = None
        if found.noise.ndim == 1:
            noise = float(found.noise[n])
        sample = {"lag": float(found.lags[n]), "weight": float(found.weights[n])}
        samples.append({**sample, "noise": noise, "grey": float(grey)})
    return samples


def _in_surface(found: Probe, field: FlowField) -> Floats:
    """Return the velocity along the surface, of the whole speed."""
    point = found.field_values
    n = int(np.abs(found.path_lags).argmin())
    ends = found.path[max(n - 1, 0)], found.path[min(n + 1, len(found.path) - 1)]
    along = ends[1] - ends[0]
    size = float(np.linalg.norm(along))
    if not (field.leaves_surface and np.isfinite(size) and size > 0):
        return point.velocity
    velocity: Floats = point.speed * along / size
    return velocity
