"""Paths of many particles on a surface of triangles, one step of each within one triangle a round.

A step follows the Taylor polynomial of second order of the particle's shares of the corners, whose
third-order term limits its length; it ends at an edge at the latest. The same polynomial gives the
positions at the lags, and the length of path as far as lags are lengths.

Where the velocities of two triangles point at each other across their edge, a particle slides along
it. A path that leaves the surface, enters a triangle without data or stops is ended there. That lag
is its reach, and beyond it the path goes straight on in space.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.trace.integrate import MOST_STEPS, Columns
from flowtex.trace.triangles.motion import (
    AFTER,
    AWAY,
    BEHIND,
    NEXT,
    Derivatives,
    Motion,
    TriangleMesh,
    dot,
)

#: Most steps per row of a square with as many nodes: a few paths that turn in one place must not
#: delay all others.
STEPS_PER_ROW = 30
LEAST_STEPS = 3_000  #: Least limit of the number of steps.
#: Rounds in one triangle, or from one to the next without a move, after which a path is ended: it
#: spirals, or crosses a triangle so flat that it is practically stuck. No more triangles meet in a
#: node.
MOST_STANDING = 300
#: Barycentric coordinate that is zero, up to rounding.
SHARE_ROUNDING = 1e-12
#: Relative rate of a barycentric coordinate that is zero, up to rounding.
EDGE_ROUNDING = 1e-9
#: Share of a lag by which rounding may miss it.
LAG_ROUNDING = 1e-12
#: Twice what acceleration may move a particle in one step, in sizes of its triangle.
MOST_TURN = 0.2
#: Rounds of Newton's method for the place in a step where a path has some length.
NEWTON_ROUNDS = 3


@dataclass(frozen=True)
class TrianglePaths:
    """Where N particles are at M lags."""

    #: Triangles (M, N), and the shares of their second and third corners, (M, 2, N); those of the
    #: end where a path has ended.
    triangle: Indices
    shares: Floats
    further: Floats  #: Lag since the end, (M, N), 0 for a path that has not ended.
    ahead: Floats  #: Velocity at the end, (3, N), by which a path goes straight on.
    reach: Floats  #: Lag at which each path ended, (N,), infinite where it continues.

    def positions(self, mesh: TriangleMesh, points: Floats, lag: int) -> Floats:
        """Return positions in space at one lag, (N, 3), by the nodes (N, 3) of the surface."""
        corners = points[mesh.corners[self.triangle[lag]]]
        one, two = self.shares[lag]
        result = corners[:, 0] * (1 - one - two)[:, None]
        result += corners[:, 1] * one[:, None]
        result += corners[:, 2] * two[:, None]
        result += (self.ahead * self.further[lag]).T
        return np.asarray(result)


def integrate(
    motion: Motion,
    points: Floats,
    triangle: Indices,
    shares: Floats,
    lags: Floats,
    *,
    tolerance: float,
    last: Floats | None = None,
    most_steps: int | None = None,
    ended: Bools | None = None,
) -> TrianglePaths:
    """Follow particles from shares (2, N) of the corners of triangles (N,), at nodes (N, 3).

    Lags (M, N) are positive and increasing for each particle. The tolerance is the error allowed in
    one step, in sizes of its triangle. Particles that hardly move until the ``last`` lag (N,) are
    at rest; by default that is the last of ``lags``. Paths are ended after ``most_steps``, which by
    default grow with the number of nodes. Some have ``ended`` at once, (N,).
    """
    if last is None:
        last = lags[-1]
    run = _Run(motion, points, triangle, shares, lags, last, tolerance)
    # Values too large or too small to represent end a path.
    with np.errstate(all="ignore"):
        if ended is not None:
            run.end(ended)
        usual = STEPS_PER_ROW * int(np.sqrt(len(points)))
        for _ in range(most_steps or min(max(usual, LEAST_STEPS), MOST_STEPS)):
            if not len(run.state.which):
                break
            run.advance()
        run.end(np.ones(len(run.state.which), dtype=bool))
    return TrianglePaths(run.triangle, run.shares, run.further, run.ahead, run.reach)


def begin(motion: Motion, nodes: Indices) -> tuple[Indices, Bools]:
    """Return corners to start at, as three times the triangle plus the corner, and which end, (N,).

    It is the one around each node (N,), which has at least one, into whose triangle the velocity
    points most. Where it leads out of a face at a sharp edge, and not along that, the path begins
    in another one, if the velocity there leads into that, and else it ends at once.
    """
    mesh = motion.mesh
    inwards = np.empty(mesh.corners.shape)
    sizes = np.empty(mesh.corners.shape)
    speeds = np.empty(mesh.corners.shape)
    alongs = np.empty(mesh.corners.shape)
    slip = np.maximum(mesh.slip.reshape(-1, 3), 0.0).T
    with np.errstate(all="ignore"):
        for corner in range(3):
            rate = motion.at_corner(corner)
            inward = _three(rate) * mesh.heights.T
            speed = np.sqrt(dot(mesh.metric.T, rate, rate))
            speeds[:, corner] = speed
            beside = [corner - 2, corner - 1]
            inwards[:, corner] = np.nan_to_num(inward[beside].min(axis=0))
            alongs[:, corner] = np.nan_to_num((inward + slip * speed)[beside].min(axis=0))
            sizes[:, corner] = np.nan_to_num(np.abs(inward).sum(axis=0))
    least = EDGE_ROUNDING * sizes
    result = _most_inward(mesh, inwards, mesh.first[nodes], mesh.last[nodes])
    first = mesh.place_first[nodes]
    last = mesh.place_last[nodes]
    leaves = inwards.take(result) < -least.take(result)
    out = np.flatnonzero(leaves & (last - first > mesh.last[nodes] - mesh.first[nodes]))
    ended = np.zeros(len(nodes), dtype=bool)
    if len(out):
        other = _most_inward(mesh, inwards, first[out], last[out])
        leads = inwards.take(other) > least.take(other)
        own = _most_inward(mesh, alongs, mesh.first[nodes[out]], mesh.last[nodes[out]])
        along = alongs.take(own) >= -least.take(own)
        along &= ~leads | (inwards.take(other) > AWAY * speeds.take(other))
        result[out] = np.where(along, own, np.where(leads, other, result[out]))
        ended[out[~along & ~leads]] = True
    return result, ended


def _most_inward(mesh: TriangleMesh, inwards: Floats, first: Indices, last: Indices) -> Indices:
    """Return the corners, from ``first`` to ``last`` (N,), with the most inward velocity."""
    count = last - first
    begins = np.cumsum(count) - count
    owner = np.repeat(np.arange(len(first)), count)
    at = mesh.around[np.arange(len(owner)) + (first - begins)[owner]]
    inward = inwards.take(at)
    best = np.flatnonzero(inward == np.maximum.reduceat(inward, begins)[owner])[::-1]
    result = np.empty(len(first), dtype=np.intp)
    result[owner[best]] = at[best]
    return result


def _three(two: Floats) -> Floats:
    """Return changes of all three shares, (3, N), by those of the second and third."""
    result = np.empty((3, two.shape[1]))
    result[1:] = two
    np.negative(np.add(two[0], two[1], out=result[0]), out=result[0])
    return result


@dataclass
class _Particles(Columns):
    """Particles still under way; the last axis is theirs."""

    which: Indices
    triangle: Indices
    #: Corner opposite to the edge by which they entered their triangle, -1 for none.
    edge: Indices
    next: Indices  #: Index of the next lag to record.
    standing: Indices
    shares: Floats
    lag: Floats
    due: Floats  #: The next lag to record.
    last: Floats


class _Run:
    """State of one call of :func:`integrate`."""

    def __init__(
        self,
        motion: Motion,
        points: Floats,
        triangle: Indices,
        shares: Floats,
        lags: Floats,
        last: Floats,
        tolerance: float,
    ) -> None:
        self.motion = motion
        self.mesh = motion.mesh
        self.points = points
        #: Six times the error allowed, squared, as it is compared with third derivatives.
        self.error = (6 * tolerance) ** 2
        count = len(triangle)
        #: The lags and one that is never reached, for particles that have passed all.
        self.lags = np.concatenate([lags, np.full((1, count), np.inf)])
        self.triangle = np.zeros(lags.shape, dtype=np.intp)
        self.shares = np.zeros((len(lags), 2, count))
        self.further = np.zeros(lags.shape)
        self.ahead = np.zeros((3, count))
        self.reach = np.full(count, np.inf)
        self.state = _Particles(
            which=np.arange(count),
            triangle=triangle,
            edge=np.full(count, -1, dtype=np.intp),
            next=np.zeros(count, dtype=np.intp),
            standing=np.zeros(count, dtype=np.intp),
            shares=shares,
            lag=np.zeros(count),
            due=self.lags[0].copy(),
            last=last.copy(),
        )

    def advance(self) -> None:
        """Make one step of every particle."""
        state = self.state
        now = self.motion.at(state.triangle, state.shares, state.lag, state.last)
        self._keep_to_edges(now)
        square = dot(now.metric, now.first, now.first)
        at = _three(state.shares)
        rate = _three(now.first)
        bent = _three(0.5 * now.second)
        at[0] += 1
        h, edge = _exit(np.maximum(at, 0.0), rate, bent)
        lag, h = self._limited(now, square, h, edge)
        shares = state.shares + h * (now.first + (0.5 * h) * now.second)
        resting = square <= now.rest
        ended = resting | ~np.isfinite(shares[0] + shares[1] + lag)
        if ended.any():
            # They stay where they are.
            h[ended], edge[ended], lag[ended] = 0.0, -1, state.lag[ended]
            shares[:, ended] = state.shares[:, ended]
            now.first[:, resting] = 0.0
        self._record(now, h, lag)
        # Three steps in a triangle count as much as a turn about a node of a hundred triangles.
        state.standing += np.where(edge < 0, 3, 1)
        state.standing[(edge >= 0) & (h * h * square > SHARE_ROUNDING**2)] = 0
        if now.until is not None:
            state.standing[lag == now.until] = 0
        ended |= state.standing > MOST_STANDING
        state.lag = lag
        state.shares = shares
        crossing = np.flatnonzero((edge >= 0) & ~ended)
        ended[self._cross(now, h, crossing, edge)] = True
        if ended.any():
            now.first += h * now.second
            self._end(np.flatnonzero(ended), now)
        left = ~ended & (state.next < len(self.lags) - 1)
        if not left.all():
            self.state = state.pick(left)

    def end(self, ended: Bools) -> None:
        """End some of the paths under way, (N,), where they are."""
        state = self.state
        if ended.any():
            now = self.motion.at(state.triangle, state.shares, state.lag, state.last)
            self._end(np.flatnonzero(ended), now)
            self.state = state.pick(~ended)

    def _limited(
        self, now: Derivatives, square: Floats, h: Floats, edge: Indices
    ) -> tuple[Floats, Floats]:
        """Return lags (N,) after short enough steps, and these; ``edge`` is -1 before it."""
        error = dot(now.metric, now.third, now.third)
        bend = turn = dot(now.metric, now.bend, now.bend)
        if now.bend is not now.second:
            turn = dot(now.metric, now.second, now.second)
        # Third derivatives are zero where a time-varying flow begins.
        over = (error * (h * h) ** 3 > self.error) | (bend * (h * h) > square)
        far = np.flatnonzero(over | (turn * (h * h) ** 2 > MOST_TURN**2))
        if len(far):
            short = np.fmin(
                np.cbrt(np.sqrt(self.error / error[far])), np.sqrt(square[far] / bend[far])
            )
            short = np.fmin(short, np.sqrt(MOST_TURN / np.sqrt(turn[far])))
            edge[far] = np.where(short < h[far], -1, edge[far])
            h[far] = np.minimum(short, h[far])
        lag = self.state.lag
        if self.motion.by_length:
            return lag + now.size * (h / 6) * _sum_of_speeds(*_speeds(now, h)), h
        after = lag + now.pace * h
        if now.until is not None:
            cut = after > now.until
            h = np.where(cut, (now.until - lag) / now.pace, h)
            edge[cut] = -1
            # Assigned, not added, so that rounding leaves no particle before that moment.
            after = np.where(cut, now.until, after)
        return after, h

    def _keep_to_edges(self, now: Derivatives) -> None:
        """Keep particles from going back over the edge by which they entered."""
        state = self.state
        few = EDGE_ROUNDING * (np.abs(now.first[0]) + np.abs(now.first[1]))
        rate = _three(now.first)[state.edge, np.arange(len(few))]
        at = np.flatnonzero((rate <= few) & (state.edge >= 0))
        share = all_shares(state.shares[:, at])[state.edge[at], np.arange(len(at))]
        at = at[share <= SHARE_ROUNDING]
        if not len(at):
            return
        back = ~_inward(now, at, state.edge[at])
        side = 3 * state.triangle[at] + state.edge[at]
        code = self.mesh.across[side]
        border = back & (code < 0)
        out = -rate[at] * self.mesh.heights[state.triangle[at], state.edge[at]]
        speed = np.sqrt(dot(now.metric[:, at], now.first[:, at], now.first[:, at]))
        along = back & (out <= self.mesh.slip[side] * speed)
        slides = along & border
        inner = np.flatnonzero(back & (code >= 0))
        if len(inner):
            over = at[inner]
            triangle, edge, shares = self._behind(over, state.edge[over], code[inner])
            behind = self.motion.at(triangle, shares, state.lag[over], state.last[over])
            leads = _inward(behind, np.arange(len(over)), edge)
            leads &= ~(along[inner] & self._parts(behind, triangle, edge))
            slides[inner[~leads]] = True
            go = over[leads]
            now.put(go, behind.pick(leads))
            state.triangle[go], state.edge[go] = triangle[leads], edge[leads]
            state.shares[:, go] = shares[:, leads]
        slide = at[slides]
        # A rate this small across an edge is rounding.
        rate = _three(now.first[:, at])[state.edge[at], np.arange(len(at))]
        along = at[slides | (~border & (rate <= EDGE_ROUNDING * np.abs(now.first[:, at]).sum(0)))]
        now.first[:, along] = _along(now.first[:, along], now.metric[:, along], state.edge[along])
        now.second[:, slide] = _along(now.second[:, slide], now.metric[:, slide], state.edge[slide])

    def _behind(self, at: Indices, edge: Indices, code: Indices) -> tuple[Indices, Indices, Floats]:
        """Return triangles (n,) behind the edges of particles, their edges, and shares (2, n)."""
        shares = all_shares(self.state.shares[:, at])
        count = np.arange(len(at))
        one = np.maximum(shares[(edge + 1) % 3, count], 0.0)
        two = np.maximum(shares[(edge + 2) % 3, count], 0.0)
        share = one / (one + two)
        layout = code & 7
        beyond = NEXT[:, layout] * share + AFTER[:, layout] * (1 - share)
        return code >> 3, BEHIND[layout], beyond

    def _cross(self, now: Derivatives, h: Floats, at: Indices, edge: Indices) -> Indices:
        """Move particles over their edges, and return those at a border that they leave."""
        state = self.state
        edge = edge[at]
        side = 3 * state.triangle[at] + edge
        code = self.mesh.across[side]
        slip = self.mesh.slip[side]
        slides = np.zeros(len(at), dtype=bool)
        few = np.flatnonzero(slip >= 0)
        if len(few):
            slides[few] = self._slides(now, h, at[few], edge[few], code[few])
        over = (code >= 0) & ~slides
        crossing = at[over]
        self._place(crossing, *self._behind(crossing, edge[over], code[over]))
        return np.asarray(at[(code < 0) & ~slides])

    def _slides(
        self, now: Derivatives, h: Floats, at: Indices, edge: Indices, code: Indices
    ) -> Bools:
        """Return which particles slide along the edges that they meet, and note these edges."""
        state = self.state
        rate = now.first[:, at] + h[at] * now.second[:, at]
        speed = np.sqrt(dot(now.metric[:, at], rate, rate))
        away = -_three(rate)[edge, np.arange(len(at))]
        away *= self.mesh.heights[state.triangle[at], edge]
        slides = away <= self.mesh.slip[3 * state.triangle[at] + edge] * speed
        sharp = np.flatnonzero(slides & (code >= 0))
        if len(sharp):
            over = at[sharp]
            triangle, behind_edge, shares = self._behind(over, edge[sharp], code[sharp])
            behind = self.motion.at(triangle, shares, state.lag[over], state.last[over])
            slides[sharp] = self._parts(behind, triangle, behind_edge)
        state.edge[at[slides]] = edge[slides]
        return np.asarray(slides)

    def _parts(self, now: Derivatives, triangle: Indices, edge: Indices) -> Bools:
        """Return whether velocities behind edges do not continue the velocities along the edges."""
        count = np.arange(len(triangle))
        away = _three(now.first)[edge, count] * self.mesh.heights[triangle, edge]
        speed = np.sqrt(dot(now.metric, now.first, now.first))
        return np.asarray((away <= 0) | (away > AWAY * speed))

    def _place(self, at: Indices, triangle: Indices, edge: Indices, shares: Floats) -> None:
        state = self.state
        state.triangle[at], state.edge[at], state.shares[:, at] = triangle, edge, shares

    def _record(self, now: Derivatives, h: Floats, lag: Floats) -> None:
        """Write the positions of particles at the lags that their steps pass."""
        state = self.state
        due = np.flatnonzero(state.due <= lag * (1 + LAG_ROUNDING))
        speeds = None
        while len(due):
            step = h[due]
            first = now.first[:, due]
            second = now.second[:, due]
            if self.motion.by_length:
                if speeds is None:
                    speeds = _speeds(now, h)
                length = (state.due[due] - state.lag[due]) / now.size[due]
                t = step * _fraction(length / step, *(speed[due] for speed in speeds))
            else:
                t = np.minimum((state.due[due] - state.lag[due]) / now.pace[due], step)
            number = state.next[due]
            which = state.which[due]
            self.triangle[number, which] = state.triangle[due]
            self.shares[number, :, which] = (
                state.shares[:, due] + t * (first + (0.5 * t) * second)
            ).T
            state.next[due] += 1
            state.due[due] = self.lags[number + 1, which]
            due = due[state.due[due] <= lag[due] * (1 + LAG_ROUNDING)]

    def _end(self, at: Indices, now: Derivatives) -> None:
        """End some paths at their positions, and continue them straight for the other lags."""
        state = self.state
        which = state.which[at]
        rate = now.first[:, at]
        if self.motion.by_length:
            rate = rate / (now.size[at] * np.sqrt(dot(now.metric[:, at], rate, rate)))
        else:
            rate = rate / now.pace[at]
        corners = self.points[self.mesh.corners[state.triangle[at]]]
        sides = corners[:, 1:] - corners[:, :1]
        ahead = np.einsum("sn,nsc->cn", rate, sides)
        self.ahead[:, which] = np.nan_to_num(ahead, posinf=0.0, neginf=0.0)
        self.reach[which] = state.lag[at]
        for m in range(int(state.next[at].min()), len(self.triangle)):
            later = at[state.next[at] <= m]
            paths = state.which[later]
            self.triangle[m, paths] = state.triangle[later]
            self.shares[m][:, paths] = state.shares[:, later]
            self.further[m, paths] = self.lags[m, paths] - state.lag[later]


def all_shares(two: Floats) -> Floats:
    """Return all three shares, (3, N), by the second and third."""
    return np.stack([1 - two[0] - two[1], two[0], two[1]])


def _exit(at: Floats, rate: Floats, bent: Floats) -> tuple[Floats, Indices]:
    """Return the time when the first of three quadratics becomes negative, and which one, (N,).

    They are at + rate t + bent t^2, (3, N), and begin positive. The time is infinite, and the
    number -1, where none does.
    """
    falls = rate < 0
    square = rate * rate - 4 * at * bent
    root = np.sqrt(np.maximum(square, 0.0))
    # Of the two forms of a root, the one without cancellation.
    t = np.where(falls, 2 * at, rate + root)
    t /= np.where(falls, root - rate, -2 * bent)
    t[np.where(falls, square < 0, bent >= 0)] = np.inf
    edge = (t[1] < t[0]).astype(np.intp)
    first = np.minimum(t[0], t[1])
    edge[t[2] < first] = 2
    first = np.minimum(first, t[2])
    edge[~np.isfinite(first)] = -1
    return first, edge


def _speeds(now: Derivatives, h: Floats) -> tuple[Floats, Floats, Floats]:
    """Return speeds at the beginning, in the middle and at the end of steps, (N,)."""
    # By the square of the speed, which is a quadratic.
    square = dot(now.metric, now.first, now.first)
    slope = dot(now.metric, now.first, now.second) * h
    bend = dot(now.metric, now.second, now.second) * (h * h)
    middle = square + slope + 0.25 * bend
    end = square + 2 * slope + bend
    return np.sqrt(square), np.sqrt(np.maximum(middle, 0.0)), np.sqrt(np.maximum(end, 0.0))


def _fraction(mean: Floats, begin: Floats, middle: Floats, end: Floats) -> Floats:
    """Return the fraction of a step, 0 to 1, where its length is ``mean`` times its time."""
    one = 4 * middle - 3 * begin - end
    two = 2 * (begin + end) - 4 * middle
    fraction = 6 * mean / _sum_of_speeds(begin, middle, end)
    for _ in range(NEWTON_ROUNDS):
        length = fraction * (begin + fraction * (one / 2 + fraction * (two / 3)))
        speed = begin + fraction * (one + fraction * two)
        # NaN counts as zero.
        fraction = np.fmin(np.fmax(fraction - (length - mean) / speed, 0.0), 1.0)
    return np.asarray(fraction)


def _sum_of_speeds(begin: Floats, middle: Floats, end: Floats) -> Floats:
    """Return six times the mean speed of a step, by Simpson's rule."""
    return begin + 4 * middle + end


def _inward(now: Derivatives, at: Indices, edge: Indices) -> Bools:
    """Return whether particles at edges move into their triangles, or along the edge."""
    count = np.arange(len(at))
    rate = _three(now.first[:, at])[edge, count]
    bent = _three(now.second[:, at])[edge, count]
    few = EDGE_ROUNDING * np.abs(now.first[:, at]).sum(axis=0)
    return np.asarray((rate > few) | ((rate >= -few) & (bent >= 0)))


def _along(change: Floats, metric: Floats, edge: Indices) -> Floats:
    """Return the part of changes (2, N) of shares along the edges opposite to corners (N,)."""
    e, f, g = metric
    first = edge == 1
    second = edge == 2
    one = np.where(first, g, np.where(second, -f, f - g))
    two = np.where(first, -f, np.where(second, e, f - e))
    wide = np.where(first, g, np.where(second, e, e + g - 2 * f))
    away = np.where(first, change[0], np.where(second, change[1], -change[0] - change[1])) / wide
    result = np.stack([change[0] - one * away, change[1] - two * away])
    # Without rounding, which would lead off the edge.
    result[0] = np.where(first, 0.0, result[0])
    result[1] = np.where(second, 0.0, np.where(first, result[1], -result[0]))
    return result
