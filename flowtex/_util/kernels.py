"""Loops that numba compiles: the integrator, look-ups in slices, positions on a surface.

One particle after the other by the same scheme and rules as in NumPy, so that both give the same
up to rounding. Paths over poles and those in fields without a sign are left to the other. Importing
this module compiles it, or loads it from numba's cache; :mod:`flowtex.trace.compiled` does.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import boolean, float32, float64, int64, njit, types, uint64, void

from flowtex._util.array_types import Bytes, Floats, Floats32, Indices

__all__ = ["blend", "cubic", "follow"]

#: Rows and columns, and which of the (j, i) axes close.
_SHAPE = types.Tuple((int64, int64, boolean, boolean))
#: Nodal data (T * J * I, 2 or 3), times, destination time, direction, and speed at rest.
_FLOW = types.Tuple((float64[:, ::1], float64[::1], float64, float64, float64))
_PAIR = types.UniTuple(float64, 2)


def _cached() -> bool:
    """Whether there is a folder for numba's cache."""
    try:
        njit(cache=True)(_cached)
    except RuntimeError:
        return False
    return True


_OPTIONS: dict[str, Any] = {"nogil": True, "cache": _cached(), "error_model": "numpy"}
_INNER: dict[str, Any] = {"forceinline": True, **_OPTIONS}


@njit(types.Tuple((int64, float64))(float64, int64, boolean), **_INNER)
def _cell(x: float, cells: int, closed: bool) -> tuple[int, float]:  # noqa: FBT001
    """Return the number of the cell along one axis, and the fraction inside it."""
    if closed:
        x -= cells * np.floor(x * (1.0 / cells))
    # Written so that NaN, too, does not lead out of the array.
    x = min(x if x > 0.0 else 0.0, float(cells))
    number = min(int(x), cells - 1)
    return number, x - number


@njit(float64(float64[:, ::1], int64, uint64, int64, float64, float64), **_INNER)
def _blend(data: Floats, c: int, at: Any, width: int, s: float, t: float) -> float:
    """Interpolate one component; unsigned indices spare numba a test of each."""
    right, up = uint64(1), uint64(width)
    low = data[at, c] + s * (data[at + right, c] - data[at, c])
    at += up
    high = data[at, c] + s * (data[at + right, c] - data[at, c])
    return float(low + t * (high - low))


@njit(_PAIR(_SHAPE, _FLOW, float64, float64, float64), **_INNER)
def _rate(shape: Any, flow: Any, i: float, j: float, lag: float) -> tuple[float, float]:
    """Rate at a position after a lag, as the samplers give it."""
    rows, width, closed_j, closed_i = shape
    data, times, destination, direction, floor = flow
    column, s = _cell(i, width - 1, closed_i)
    row, t = _cell(j, rows - 1, closed_j)
    at = uint64(row * width + column)
    step, last = 0, len(times) - 2
    time = destination + direction * lag
    while step < last and times[step + 1] < time:
        step += 1
    at += uint64(step * rows * width)
    u, v = _blend(data, 0, at, width, s, t), _blend(data, 1, at, width, s, t)
    if last >= 0:
        late = (time - times[step]) / (times[step + 1] - times[step])
        late = min(max(late, 0.0), 1.0)
        at += uint64(rows * width)
        u += late * (_blend(data, 0, at, width, s, t) - u)
        v += late * (_blend(data, 1, at, width, s, t) - v)
    elif data.shape[1] > 2:
        speed = _blend(data, 2, at, width, s, t)
        if speed <= floor:
            speed = np.inf
        u, v = u / speed, v / speed
    return direction * u, direction * v


@njit(float64(_SHAPE, types.uint8[::1], float64, float64, float64), **_INNER)
def _room(shape: Any, room: Bytes, i: float, j: float, edge: float) -> float:
    """Cells that a particle may move at once, none where it has left the domain."""
    rows, width, closed_j, closed_i = shape
    if not (closed_i or -edge <= i <= width - 1 + edge):
        return 0.0
    if not (closed_j or -edge <= j <= rows - 1 + edge):
        return 0.0
    row, column = _cell(j, rows - 1, closed_j)[0], _cell(i, width - 1, closed_i)[0]
    return float(room[row * width + column])


@njit(float64(float64, float64, float64, float64, float64, float64), **_INNER)
def _dense(s: float, h: float, y0: float, k0: float, y1: float, k1: float) -> float:
    """Position at a fraction of a step, by the cubic through both ends and slopes."""
    r = 1 - s
    return r * r * (y0 + s * (2 * y0 + h * k0)) + s * s * (y1 + r * (2 * y1 - h * k1))


@njit(float64(float64, float64), **_INNER)
def _limited(x: float, most: float) -> float:
    """Return a number within -most and most."""
    return min(max(x, -most), most)


@njit(
    void(
        _SHAPE,
        types.uint8[::1],
        _FLOW,
        types.UniTuple(float64, 7),
        types.UniTuple(int64, 2),
        int64[::1],
        float64[::1],
        float64[::1],
        float64[::1],
        _PAIR,
        float32[:, :, :],
        float32[:],
    ),
    **_OPTIONS,
)
def follow(
    shape: Any,
    room: Bytes,
    flow: Any,
    rules: tuple[float, ...],
    most: tuple[int, int],
    nodes: Indices,
    lags: Floats,
    units: Floats,
    rests: Floats,
    limit: tuple[float, float],
    moved: Floats32,
    reach: Floats32,
) -> None:
    """Follow particles from some nodes, (N,), with units of lag and rates at rest (N,) each.

    Displacements are written to ``moved`` (2, M, J * I), and reaches, in units, to (J * I,).
    ``limit`` has the longest step, and the lag up to which there is one. ``rules`` are a tolerance
    and those of :data:`flowtex.trace.integrate.RULES`, and ``most`` counts steps and bisections:
    numba's cache would not notice if they changed there.
    """
    tolerance, shrink, growth, safety, rounding, edge, farthest = rules
    most_steps, bisections = most
    longest, span = limit
    small = (safety / growth) ** 3
    width, count = shape[1], len(lags)
    for n in range(len(nodes)):
        node, unit = nodes[n], units[n]
        i0, j0 = float(node % width), float(node // width)
        i, j, lag, step, m, end = i0, j0, 0.0, lags[-1] * unit, 0, np.inf
        a, b = _rate(shape, flow, i, j, lag)
        free = _room(shape, room, i, j, edge)
        for tries in range(most_steps + 1):
            speed = max(abs(a), abs(b))
            if speed < rests[n] or tries == most_steps:
                if speed < rests[n]:
                    a = b = 0.0
                end = lag
                break
            h = min(step, max(free, 1.0) / max(speed, 1e-300))
            h = min(h, lags[-1] * unit - lag)
            if lag < span:
                h = min(h, longest)
            a2, b2 = _rate(shape, flow, i + 0.5 * h * a, j + 0.5 * h * b, lag + 0.5 * h)
            a3, b3 = _rate(shape, flow, i + 0.75 * h * a2, j + 0.75 * h * b2, lag + 0.75 * h)
            i1 = i + h * (2 / 9 * a + 1 / 3 * a2 + 4 / 9 * a3)
            j1 = j + h * (2 / 9 * b + 1 / 3 * b2 + 4 / 9 * b3)
            a4, b4 = _rate(shape, flow, i1, j1, lag + h)
            error = h * max(
                abs(-5 / 72 * a + 1 / 12 * a2 + 1 / 9 * a3 - 1 / 8 * a4),
                abs(-5 / 72 * b + 1 / 12 * b2 + 1 / 9 * b3 - 1 / 8 * b4),
            )
            size = max(error * (1 / tolerance), 1e-9)
            step = h * (growth if size < small else max(safety / np.cbrt(size), shrink))
            if not size <= 1:
                continue
            share, free = 1.0, _room(shape, room, i1, j1, edge)
            if free == 0:
                share, high = 0.0, 1.0
                for _ in range(bisections):
                    s = (share + high) / 2
                    x, y = _dense(s, h, i, a, i1, a4), _dense(s, h, j, b, j1, b4)
                    if _room(shape, room, x, y, edge) > 0:
                        share = s
                    else:
                        high = s
            while m < count:
                s = (lags[m] * unit - lag) / h
                if s > share + rounding:
                    break
                moved[0, m, node] = _limited(_dense(s, h, i, a, i1, a4) - i0, farthest)
                moved[1, m, node] = _limited(_dense(s, h, j, b, j1, b4) - j0, farthest)
                m += 1
            if free == 0:
                i, j = _dense(share, h, i, a, i1, a4), _dense(share, h, j, b, j1, b4)
                a, b = a + share * (a4 - a), b + share * (b4 - b)
                end = lag = lag + share * h
                break
            i, j, a, b, lag = i1, j1, a4, b4, lag + h
            if m == count:
                break
        for later in range(m, count):
            further = lags[later] * unit - lag
            moved[0, later, node] = _limited(i + further * a - i0, farthest)
            moved[1, later, node] = _limited(j + further * b - j0, farthest)
        reach[node] = end / unit


@njit(
    void(float32[:, :, :], int64, int64[::1], float32[:], float32[:], int64[:], float32[:, :, :]),
    **_OPTIONS,
)
def blend(
    slices: Floats32,
    width: int,
    at: Indices,
    s: Floats32,
    t: Floats32,
    m: Indices,
    result: Floats32,
) -> None:
    """Interpolate slices (2, M, N) between nodes, those of numbers m and m - 1: (2, 2, n).

    The lower corners (n,) count from the first node of all.
    """
    for c in range(2):
        for n in range(len(at)):
            for k in range(result.shape[1]):
                a, row = uint64(at[n]), slices[c, m[n] - k]
                b = a + uint64(width)
                low = row[a] + s[n] * (row[a + uint64(1)] - row[a])
                high = row[b] + s[n] * (row[b + uint64(1)] - row[b])
                result[c, k, n] = low + t[n] * (high - low)


@njit(types.UniTuple(float64, 4)(float64), **_INNER)
def _weights(t: float) -> tuple[float, float, float, float]:
    """Catmull-Rom weights of the four nodes around a fraction of a cell."""
    t2, t3 = t * t, t * t * t
    return (
        0.5 * (-t3 + 2 * t2 - t),
        0.5 * (3 * t3 - 5 * t2 + 2),
        0.5 * (-3 * t3 + 4 * t2 + t),
        0.5 * (t3 - t2),
    )


@njit(
    void(float64[:, ::1], int64, int64[::1], float64[::1], float64[::1], float64[:, ::1]),
    **_OPTIONS,
)
def cubic(nodes: Floats, width: int, corner: Indices, s: Floats, t: Floats, result: Floats) -> None:
    """Interpolate nodal data (C, J * I) by cubics, from the first of 16 nodes of each: (C, N)."""
    for n in range(len(corner)):
        along, across = _weights(s[n]), _weights(t[n])
        for c in range(len(nodes)):
            result[c, n] = 0.0
            for b in range(4):
                at = uint64(corner[n] + b * width)
                row = along[0] * nodes[c, at] + along[1] * nodes[c, at + uint64(1)]
                row += along[2] * nodes[c, at + uint64(2)] + along[3] * nodes[c, at + uint64(3)]
                result[c, n] += across[b] * row
