"""Loops that numba compiles: the integrator, look-ups in slices, positions on a surface.

One particle after the other by the same scheme and rules as in NumPy, so that both give the same
up to rounding. Paths over poles, those in fields without a sign, and on triangles those in flows
that vary are left to the other. Importing
this module compiles it, or loads it from numba's cache; :mod:`flowtex._util.compiled` does.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import boolean, float32, float64, int64, njit, types, uint64, void

from flowtex._util.array_types import Bytes, Floats, Floats32, Indices

__all__ = ["blend", "cubic", "follow", "follow_triangles"]

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


_THREE = types.UniTuple(float64, 3)
_FOUR = types.UniTuple(float64, 4)
#: The table of a steady motion (M, 14), what is across edges (3 M,), and heights (M, 3).
_MESH = types.Tuple((float64[:, ::1], int64[::1], float64[:, ::1]))


@njit(_FOUR(float64[:, ::1], int64, float64, float64, float64), **_INNER)
def _law(
    table: Floats, at: int, one: float, two: float, way: float
) -> tuple[float, float, float, float]:
    """First and second derivatives of the second and third share in a triangle."""
    t = table[at]
    d1 = way * (t[0] + t[2] * one + t[4] * two)
    d2 = way * (t[1] + t[3] * one + t[5] * two)
    return d1, d2, way * (t[2] * d1 + t[4] * d2), way * (t[3] * d1 + t[5] * d2)


@njit(float64(float64, float64, int64), **_INNER)
def _of(one: float, two: float, k: int) -> float:
    """Change of the share of corner k."""
    return one if k == 1 else (two if k == 2 else -(one + two))


@njit(float64(float64[:, ::1], int64, float64, float64, float64, float64), **_INNER)
def _dot(table: Floats, at: int, a: float, b: float, c: float, d: float) -> float:
    """Product of two changes of shares."""
    t = table[at]
    return float(t[6] * (a * c) + t[7] * (a * d + b * c) + t[8] * (b * d))


@njit(float64(float64, float64, float64), **_INNER)
def _root(at: float, rate: float, bent: float) -> float:
    """When at + rate t + bent t^2 gets below zero, as :mod:`flowtex.trace.triangles` has it."""
    square = rate * rate - 4 * max(at, 0.0) * bent
    if rate < 0:
        return float(2 * max(at, 0.0) / (np.sqrt(square) - rate)) if square >= 0 else np.inf
    return float((rate + np.sqrt(square)) / (-2 * bent)) if bent < 0 else np.inf


@njit(_PAIR(float64[:, ::1], int64, int64, float64, float64), **_INNER)
def _on_edge(table: Floats, at: int, k: int, a: float, b: float) -> tuple[float, float]:
    """Return what of a change of shares is along the edge opposite to corner k."""
    e, f, g = table[at, 6], table[at, 7], table[at, 8]
    if k == 1:
        return 0.0, b + f * (a / g)
    if k == 2:
        return a + f * (b / e), 0.0
    result = a + (f - g) * (a + b) / (e + g - 2 * f)
    return result, -result


@njit(types.Tuple((int64, int64, float64, float64))(int64, int64, float64, float64), **_INNER)
def _beyond(code: int, edge: int, one: float, two: float) -> tuple[int, int, float, float]:
    """Triangle across an edge, the edge there, and second and third share."""
    zero = 1 - one - two
    a = max(one if edge == 0 else (two if edge == 1 else zero), 0.0)
    b = max(two if edge == 0 else (zero if edge == 1 else one), 0.0)
    share = a / (a + b)
    way = code & 7
    m = way // 2
    n = (m + 1 + way % 2) % 3
    first = share if m == 1 else (1 - share if n == 1 else 0.0)
    second = share if m == 2 else (1 - share if n == 2 else 0.0)
    return code >> 3, 3 - m - n, first, second


@njit(_THREE(float64, float64, float64, float64), **_INNER)
def _speeds(square: float, slope: float, bend: float, h: float) -> tuple[float, float, float]:
    """Speeds at the beginning, in the middle and at the end of a step."""
    middle = square + slope * h + 0.25 * bend * h * h
    end = square + 2 * slope * h + bend * h * h
    return np.sqrt(square), np.sqrt(max(middle, 0.0)), np.sqrt(max(end, 0.0))


@njit(float64(float64, float64, float64, float64, int64), **_INNER)
def _fraction(mean: float, begin: float, middle: float, end: float, rounds: int) -> float:
    """Fraction of a step after which the length is ``mean`` times that of its time."""
    one, two = 4 * middle - 3 * begin - end, 2 * (begin + end) - 4 * middle
    x = 6 * mean / (begin + 4 * middle + end)
    for _ in range(rounds):
        length = x * (begin + x * (one / 2 + x * (two / 3)))
        x -= (length - mean) / (begin + x * (one + x * two))
        # Written so that NaN becomes zero.
        x = min(x if x > 0.0 else 0.0, 1.0)
    return x


@njit(
    types.Tuple((int64, int64, float64, float64, _FOUR))(
        _MESH, _PAIR, float64, int64, int64, float64, float64, _FOUR
    ),
    **_INNER,
)
def _kept(
    mesh: Any, few: Any, way: float, at: int, edge: int, one: float, two: float, law: Any
) -> tuple[int, int, float, float, Any]:
    """Lead on a particle that would go back over the edge by which it came."""
    table, across, heights = mesh
    rounding, border = few
    d1, d2, a1, a2 = law
    rate, small = _of(d1, d2, edge), rounding * (abs(d1) + abs(d2))
    slide, snap = False, True
    if not (rate >= -small and _of(a1, a2, edge) >= 0):
        code = across[3 * at + edge]
        if code < 0:
            speed = np.sqrt(_dot(table, at, d1, d2, d1, d2))
            slide = snap = -rate * heights[at, edge] <= border * speed
        else:
            there, side, first, second = _beyond(code, edge, one, two)
            other = _law(table, there, first, second, way)
            rate, small = _of(other[0], other[1], side), rounding * (abs(other[0]) + abs(other[1]))
            if rate > small or (rate >= -small and _of(other[2], other[3], side) >= 0):
                at, edge, one, two = there, side, first, second
                d1, d2, a1, a2 = other
                snap = rate <= small
            else:
                slide = True
    if snap or slide:
        d1, d2 = _on_edge(table, at, edge, d1, d2)
    if slide:
        a1, a2 = _on_edge(table, at, edge, a1, a2)
    return at, edge, one, two, (d1, d2, a1, a2)


@njit(
    void(
        _MESH,
        float64[:, ::1],
        int64[:, ::1],
        types.UniTuple(float64, 8),
        types.UniTuple(int64, 3),
        boolean,
        float64,
        int64[::1],
        float64[::1],
        float64[::1],
        float32[:, :, ::1],
        float32[::1],
    ),
    **_OPTIONS,
)
def follow_triangles(
    mesh: Any,
    points: Floats,
    corners: Indices,
    rules: tuple[float, ...],
    most: tuple[int, int, int],
    by_length: bool,  # noqa: FBT001
    way: float,
    starts: Indices,
    lags: Floats,
    units: Floats,
    moved: Floats32,
    reach: Floats32,
) -> None:
    """Follow particles from corners (n,), numbers of triangles times three plus that of the corner.

    Displacements are written to ``moved`` (M, n, 3), and reaches, in units, to (n,). ``rules`` are
    a tolerance and those of :data:`flowtex.trace.triangles.RULES`, and ``most`` counts steps, those
    without a move, and rounds of Newton's method.
    """
    table, across, heights = mesh
    tolerance, rest_share, on_edge, rounding, border, turn, missed, farthest = rules
    most_steps, most_standing, newton = most
    allowed = 6 * tolerance
    count = len(lags)
    for n in range(len(starts)):
        at, corner = starts[n] // 3, starts[n] % 3
        node, unit = corners[at, corner], units[n]
        one, two = 1.0 * (corner == 1), 1.0 * (corner == 2)
        edge, lag, m, standing, end = -1, 0.0, 0, 0, np.inf
        u = v = 0.0
        for tries in range(most_steps + 1):
            law = _law(table, at, one, two, way)
            if tries == most_steps:
                u, v, end = law[0], law[1], lag
                break
            if edge >= 0 and _of(law[0], law[1], edge) <= rounding * (abs(law[0]) + abs(law[1])):
                share = 1 - one - two if edge == 0 else (one if edge == 1 else two)
                if share <= on_edge:
                    at, edge, one, two, law = _kept(
                        mesh, (rounding, border), way, at, edge, one, two, law
                    )
            d1, d2, a1, a2 = law
            size, pace = table[at, 9], table[at, 10]
            square = _dot(table, at, d1, d2, d1, d2)
            if by_length:
                rest = table[at, 11] + table[at, 12] * one + table[at, 13] * two
                rest *= rest_share
            else:
                rest = rest_share * pace / (lags[-1] * unit)
            if square <= rest * rest:
                end = lag
                break
            side, h = 0, _root(1 - one - two, -(d1 + d2), -0.5 * (a1 + a2))
            t = _root(one, d1, 0.5 * a1)
            if t < h:
                side, h = 1, t
            t = _root(two, d2, 0.5 * a2)
            if t < h:
                side, h = 2, t
            j1 = way * (table[at, 2] * a1 + table[at, 4] * a2)
            j2 = way * (table[at, 3] * a1 + table[at, 5] * a2)
            error = np.sqrt(_dot(table, at, j1, j2, j1, j2))
            bend = _dot(table, at, a1, a2, a1, a2)
            t = np.inf
            if error * h * h * h > allowed:
                t = np.cbrt(allowed / error)
            if bend * h * h > square:
                t = min(t, np.sqrt(square / bend))
            if np.sqrt(bend) * h * h > turn:
                t = min(t, np.sqrt(turn / np.sqrt(bend)))
            if t < h:
                side, h = -1, t
            slope = _dot(table, at, d1, d2, a1, a2)
            speeds = _speeds(square, slope, bend, h)
            if by_length:
                after = lag + size * (h / 6) * (speeds[0] + 4 * speeds[1] + speeds[2])
            else:
                after = lag + pace * h
            x, y = one + h * (d1 + 0.5 * h * a1), two + h * (d2 + 0.5 * h * a2)
            if not np.isfinite(x + y + after):
                u, v, end = d1, d2, lag
                break
            while m < count and lags[m] * unit <= after * (1 + missed):
                if by_length:
                    mean = (lags[m] * unit - lag) / size / h
                    t = h * _fraction(mean, speeds[0], speeds[1], speeds[2], newton)
                else:
                    t = min((lags[m] * unit - lag) / pace, h)
                b, c = one + t * (d1 + 0.5 * t * a1), two + t * (d2 + 0.5 * t * a2)
                for k in range(3):
                    p = points[corners[at, 0], k]
                    p += b * (points[corners[at, 1], k] - p) + c * (points[corners[at, 2], k] - p)
                    moved[m, n, k] = _limited(p - points[node, k], farthest)
                m += 1
            if m == count:
                break
            standing = 0 if side >= 0 and h * h * square > on_edge * on_edge else standing + 1
            one, two, lag = x, y, after
            u, v = d1 + h * a1, d2 + h * a2
            if standing > most_standing:
                end = lag
                break
            if side >= 0:
                code = across[3 * at + side]
                if code >= 0:
                    at, edge, one, two = _beyond(code, side, one, two)
                else:
                    speed = np.sqrt(_dot(table, at, u, v, u, v))
                    if -_of(u, v, side) * heights[at, side] > border * speed:
                        end = lag
                        break
                    edge = side
            u = v = 0.0
        if m < count:
            speed = np.sqrt(_dot(table, at, u, v, u, v))
            scale = table[at, 9] * speed if by_length else table[at, 10]
            for k in range(3):
                p = points[corners[at, 0], k]
                first, second = points[corners[at, 1], k] - p, points[corners[at, 2], k] - p
                ahead = (u * first + v * second) / scale
                ahead = ahead if np.isfinite(ahead) else 0.0
                here = p + one * first + two * second - points[node, k]
                for later in range(m, count):
                    further = lags[later] * unit - lag
                    moved[later, n, k] = _limited(here + further * ahead, farthest)
        reach[n] = end / unit
