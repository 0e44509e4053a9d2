"""FlowField to TraceSlices: short lags are integrated, long ones composed where they can be.

Particles are followed in blocks small enough to stay in a processor's cache, several blocks at a
time in threads: NumPy releases the interpreter's lock inside its loops.
"""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.arguments import brief, check_field, checked_array, checked_flag, checked_number
from flowtex._util.array_types import Bools, Floats, Floats32, Indices
from flowtex._util.progress import pool, track
from flowtex.errors import FieldError, notify
from flowtex.field import FlowField
from flowtex.field.derived.gradient import node_gradient, true_positions
from flowtex.field.derived.kinds import FOLLOWED
from flowtex.field.interpolation import nearest_known
from flowtex.field.steps import LazySteps, Steps
from flowtex.trace.compose import Map, SideSlices, compose, landings
from flowtex.trace.integrate import MOST_CELLS, Inside, Paths, integrate
from flowtex.trace.sampler import Sampler
from flowtex.trace.slices import SliceOrigin, TraceSlices, choose_lags, lag_unit
from flowtex.trace.triangles.triangle_slices import triangle_paths, triangle_slices

A = TypeVar("A")
B = TypeVar("B")
LEAST_LAG = 1e-30  #: Least lag for computations in single precision.
MOST_LAG = 1e30  #: Greatest lag for computations in single precision.
#: Error allowed in one step, in cells.
TOLERANCE = 1e-3
ROUNDED_SPEED = 1e-9  #: Speed that counts as rounding, as a share of the greatest speed.
LEAST_STRETCH = 10 * TOLERANCE  #: Least stretching that exceeds the error of paths.
#: First step of a particle in a steady flow, as a share of the horizon.
FIRST_STEP = 0.2
#: Particles followed together. Threads wait for each other between the operations on a block: on
#: 16 cores blocks a quarter as large take 1.5 times as long.
BLOCK = 65536
MOST_THREADS = 8  #: Most threads.
#: Length in cells up to which the paths of a steady field are integrated, not composed.
DIRECT_CELLS = 1.0
FORWARD = 1.0  #: Direction in which particles move.
BACKWARD = -1.0  #: Direction from which particles came.


def trace(
    field: FlowField,
    *,
    lags: Sequence[float] | ArrayLike | None = None,
    unit: ArrayLike | None = None,
    parameter: str = "arclength",
    two_sided: bool = True,
    tolerance: float = TOLERANCE,
    steps: Sequence[int] | None = None,
    compose: bool | None = None,
    nodes: ArrayLike | None = None,
    longest: float = np.inf,
    progress: bool = True,
) -> TraceSlices:
    """Follow the path through every node, and return its positions at several lags.

    Paper section 3.1: from every node a particle is followed backward from the destination time
    Td, and its positions at the release times Td - lag make the trace slices. A steady field is
    followed along its streamlines, a time-varying one along pathlines, with velocities
    interpolated linearly in time and held constant before the first step and after the last.

    Parameters
    ----------
    field
        The flow.
    lags
        Lags of the slices, (M,), positive and increasing, in multiples of ``unit``. By default
        they double from a quarter of a cell to a quarter of the surface.
    unit
        One unit of lag at each node, (J, I), or one number. By default the local cell size for
        paths by arc length, otherwise one unit of time.
    parameter
        ``"arclength"`` or ``"time"``; a time-varying field is always followed by time.
    two_sided
        Whether paths are followed forward too. In a sign-free field they always are.
    tolerance
        Error allowed in one step of the integration, in cells.
    steps
        Destination times to trace, as indices into ``field.times``; all by default.
    compose
        Whether long lags are composed from short ones (see ``flowtex/trace/compose.py``) instead of
        being integrated. By default they are if the lags are chosen automatically. A time-varying
        field must have equal time steps, all of which are traced; otherwise, and in a sign-free
        field, all lags are integrated. Composition on triangles requires a steady field, lags that
        double, and one unit for all nodes.
    nodes
        Nodes to trace, (J, I), all by default. If paths are integrated, only these nodes are
        followed, and the others are treated as blanked; on triangles their displacements and reach
        are zero. Composition also needs the nodes around them, whose paths end where no requested
        path needs them.
    longest
        Required length of a path by arc length, in the mesh's units. Where cells are large the last
        lags lead farther; composed paths end at the first lag of this length, and stay constant
        from there.
    progress
        Whether to show a progress bar when the work takes longer than a second.

    Returns
    -------
    TraceSlices

    Raises
    ------
    FieldError
        When the lags are not positive and increasing, or too large for single precision,
        ``parameter`` is unknown, the unit or the tolerance is not positive, ``nodes`` does not have
        the field's shape, a sign-free field is followed to one side only or composed, or a time
        step does not exist.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.double_gyre_field(shape=(21, 41))
    >>> slices = flowtex.trace(field, lags=[1.0, 2.0, 4.0])
    >>> slices.displacement.shape  # (T, M, J, I, 2)
    (1, 3, 21, 41, 2)
    """
    check_field(field, FlowField)
    parameter = _parameter(field, parameter)
    _check_flags(field, two_sided=two_sided, compose=compose, progress=progress)
    if lags is None:
        lag_values = choose_lags(field, parameter)
    else:
        lag_values = _checked_lags(lags)
    units = _checked_units(field, parameter, unit)
    _check_size(lag_values)
    expected = "a positive number of cells, such as 1e-3"
    tolerance = checked_number("tolerance", tolerance, np.nextafter(0, 1), expected=expected)
    step_numbers = _step_numbers(field, steps)
    if compose is None:
        compose = lags is None
    if field.triangles is not None:
        options: dict[str, Any] = {"two_sided": two_sided, "compose": compose}
        options |= {"tolerance": tolerance, "progress": progress}
        chosen = _chosen_nodes(field, nodes)
        with _threads() as run:
            parts = step_numbers, parameter, lag_values, units, chosen
            slices = triangle_slices(field, *parts, run=run, **options)
        return replace(slices, origin=SliceOrigin.of(field, step_numbers, tolerance))
    samplers = _samplers(field, step_numbers, parameter)
    landing = None
    if compose and (field.steady or step_numbers == list(range(len(field.times)))):
        landing = landings(field, lag_values, units)
    followed = field.valid
    if landing is None:
        followed = _chosen_nodes(field, nodes)
    expected = "a positive length in the mesh's units"
    longest = checked_number("longest", longest, np.nextafter(0, 1), np.inf, expected=expected)
    most = np.full(field.shape, np.inf)
    if parameter == "arclength":
        most = _longest_paths(field, nodes, longest, lag_values[-1] * units)
    tracing = _Tracing(field, samplers, lag_values, units, followed, tolerance, progress, most)
    slices = tracing.slices(step_numbers, parameter, landing, two_sided=two_sided)
    return replace(slices, origin=SliceOrigin.of(field, step_numbers, tolerance))


def paths(
    field: FlowField,
    start: ArrayLike,
    lags: ArrayLike,
    *,
    step: int = 0,
    parameter: str = "arclength",
    forward: bool = False,
    tolerance: float = TOLERANCE,
    within: Callable[[Floats], Bools] | None = None,
) -> Paths:
    """Follow particles from chosen positions in index space.

    They start at (N, 2) as (i, j), or at places of a ``TriangleSurface``, at destination time
    ``step``, and are followed to lags (M,) in units of length or time. ``within`` returns whether
    paths are followed at positions (2, N); elsewhere they are interrupted. On triangles all paths
    are followed, and stay where they end. Other parameters and errors as for :func:`trace`.
    """
    parameter = _parameter(field, parameter)
    begin = np.array(start, dtype=float).reshape(-1, 2)
    lag_values = _checked_lags(lags)
    number = field.step_number(step)
    options = {"direction": BACKWARD, "tolerance": tolerance}
    if forward:
        options["direction"] = FORWARD
    if field.triangles is not None:
        return triangle_paths(field, begin, lag_values, step=number, parameter=parameter, **options)
    sampler = _samplers(field, [number], parameter)[0]
    # A particle is at rest if it hardly moves in a unit; so the unit is a cell, not 1.
    unit = float(lag_unit(field, parameter)[field.valid].max(initial=0.0)) or 1.0
    units = np.full(len(begin), unit)
    inside = None
    if within is not None:
        inside = partial(_at_positions, within)
    result = integrate(sampler, begin, lag_values / unit, units, within=inside, **options)
    return replace(result, reach=result.reach * unit)


def _at_positions(within: Callable[[Floats], Bools], position: Floats, which: Indices) -> Bools:
    """Return whether paths are followed at positions (2, n), whichever they are."""
    del which
    return within(position)


def _step_numbers(field: FlowField, steps: Any) -> list[int]:
    """Return destination times as indices from 0."""
    if steps is None:
        return list(range(len(field.times)))
    numbers = []
    if np.iterable(steps):
        numbers = list(map(field.step_number, steps))
    if not numbers or len(set(numbers)) < len(numbers):
        raise FieldError(
            f"steps is {brief(steps)}; expected numbers of time steps, each once, such as [0]"
        )
    return numbers


def _check_flags(
    field: FlowField, *, two_sided: bool, compose: bool | None, progress: bool
) -> None:
    """Check arguments that are true or false, alone and for the field."""
    checked_flag("two_sided", two_sided)
    checked_flag("progress", progress)
    if compose is not None:
        checked_flag("compose", compose)
    if field.sign_free:
        _check_sign_free(two_sided=two_sided, compose=compose)


def _check_sign_free(*, two_sided: bool, compose: bool | None) -> None:
    """Check the options of paths in a sign-free field."""
    if not two_sided:
        raise FieldError(
            "two_sided is False; expected True, because a sign-free field has two equal sides"
        )
    if compose:
        raise FieldError(
            "compose is True; expected False or None, because paths of a sign-free field cannot "
            "be composed between nodes of opposite sign"
        )


def _check_size(lags: Floats) -> None:
    """Check that increasing lags fit into single precision."""
    if not LEAST_LAG <= lags[0] <= lags[-1] <= MOST_LAG:
        raise FieldError(
            f"lags range from {lags[0]:g} to {lags[-1]:g}; expected {LEAST_LAG:g} to "
            f"{MOST_LAG:g}, because of single precision: choose a unit of their size"
        )


def _checked_units(field: FlowField, parameter: str, unit: ArrayLike | None) -> Floats:
    """Return one unit of lag at each node, (J, I), by default the unit of the field."""
    units = lag_unit(field, parameter)
    if unit is not None:
        expected = f"a number, or one for each node, of shape {field.shape}"
        units = checked_array("unit", unit, expected=expected)
        if units.shape not in ((), field.shape):
            raise FieldError(f"unit has shape {units.shape}; expected {expected}")
        units = np.array(np.broadcast_to(units, field.shape))
    if not (np.isfinite(units).all() and (units > 0).all()):
        raise FieldError(
            f"unit has values from {units.min():g} to {units.max():g}; expected positive numbers"
        )
    return units


def _longest_paths(
    field: FlowField, nodes: ArrayLike | None, longest: float, last: Floats
) -> Floats:
    """Return the required length of the path through each node, (J, I), at most the last lag.

    It decreases with the distance from the requested nodes.
    """
    most = np.full(field.shape, longest)
    if nodes is None or field.surface.poles is not None:
        return most
    outside = _distance(_checked_nodes(field, nodes))
    return np.asarray((1 - outside) * np.minimum(most, last))


def _chosen_nodes(field: FlowField, nodes: ArrayLike | None) -> Bools:
    """Return the valid nodes among some nodes, by default among all, (J, I)."""
    if nodes is None:
        return field.valid
    return field.valid & _checked_nodes(field, nodes)


def _samplers(field: FlowField, steps: list[int], parameter: str) -> list[Sampler]:
    sampler = Sampler(field, by_length=parameter == "arclength")
    return list(map(sampler.since, field.times[steps].tolist()))


@contextmanager
def _threads() -> Iterator[Map]:
    """Yield a function that maps over blocks in threads, and over a single block in this one."""
    with pool(min(os.cpu_count() or 1, MOST_THREADS), "flowtex-trace") as threads:

        def run(work: Callable[[A], B], blocks: Iterable[A], /) -> Iterable[B]:
            blocks = list(blocks)
            if len(blocks) == 1:
                return map(work, blocks)
            return threads.map(work, blocks)

        yield run


def _parameter(field: FlowField, parameter: object) -> str:
    """Return what lags measure; a time-varying field is always followed by time."""
    if not isinstance(parameter, str) or parameter not in ("arclength", "time"):
        raise FieldError(f'parameter is {brief(parameter)}; expected "arclength" or "time"')
    if field.steady:
        return parameter
    return "time"


def _checked_lags(lags: ArrayLike) -> Floats:
    """Return lags as an array (M,)."""
    expected = "positive numbers in increasing order"
    lag_values = np.atleast_1d(checked_array("lags", lags, expected=expected))
    good = np.isfinite(lag_values) & (np.diff(lag_values, prepend=0.0) > 0)
    if lag_values.ndim != 1 or not lag_values.size or not good.all():
        raise FieldError(f"lags is {brief(lags)}; expected {expected}")
    return lag_values


def _checked_nodes(field: FlowField, nodes: ArrayLike) -> Bools:
    """Return a mask of nodes in the shape of the field."""
    chosen: Bools = checked_array("nodes", nodes, expected="a mask of the nodes") != 0
    if chosen.shape != field.shape:
        raise FieldError(f"nodes has shape {chosen.shape}; expected {field.shape} as the field has")
    return chosen


def _distance(chosen: Bools) -> Floats:
    """Return distances of nodes from the box of chosen ones, 1 for the farthest line, (J, I)."""
    distances = []
    for axis in (0, 1):
        lines = np.arange(chosen.shape[axis])
        at = np.flatnonzero(chosen.any(axis=1 - axis))
        if len(at):
            first = at[0]
            last = at[-1]
        else:
            first = 0
            last = len(lines) - 1
        beyond = np.maximum(np.maximum(first - lines, lines - last), 0)
        distances.append(beyond / max(beyond.max(), 1))
    return np.asarray(np.maximum(distances[0][:, None], distances[1][None, :]))


@dataclass(frozen=True, eq=False)
class _Tracing:
    """The common data of the paths of one call."""

    field: FlowField
    samplers: list[Sampler]
    lags: Floats
    unit: Floats
    followed: Bools  #: nodes whose paths are followed, (J, I)
    tolerance: float
    progress: bool
    longest: Floats  #: required length of paths by arc length, (J, I)

    @cached_property
    def nodes(self) -> Floats:
        """Nodes in index space, (J, I, 2)."""
        rows, columns = self.field.shape
        return np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).astype(float)

    @cached_property
    def rate(self) -> Floats:
        """Rates at which paths leave the nodes, by unit of lag, (T, J, I, 2)."""
        start = np.ascontiguousarray(self.nodes.reshape(-1, 2).T)
        still = np.zeros(start.shape[1])
        rate = np.stack([sampler.rate(start, still, still + FORWARD) for sampler in self.samplers])
        rate = np.moveaxis(rate.reshape(-1, 2, *self.field.shape), 1, -1) * self.unit[..., None]
        rate[:, ~self.field.valid] = 0.0
        return rate

    def slices(
        self,
        step_numbers: list[int],
        parameter: str,
        landing: Indices | None,
        *,
        two_sided: bool,
    ) -> TraceSlices:
        """Return the slices at the destination times of the samplers."""
        forward = None
        forward_reach = None
        if two_sided:
            sides = self.follow((BACKWARD, FORWARD), landing)
            forward = sides[FORWARD].displacement
            forward_reach = sides[FORWARD].reach
        else:
            sides = self.follow((BACKWARD,), landing)
        return TraceSlices(
            lags=self.lags,
            unit=self.unit,
            displacement=sides[BACKWARD].displacement,
            forward=forward,
            rate=self.rate,
            reach=sides[BACKWARD].reach,
            forward_reach=forward_reach,
            nodes=self.nodes,
            times=self.field.times[step_numbers],
            parameter=parameter,
        )

    def follow(
        self, directions: Sequence[float], landing: Indices | None
    ) -> dict[float, SideSlices]:
        """Return the slices of all paths by direction.

        Parameters
        ----------
        directions
            ``FORWARD`` or ``BACKWARD``, or both.
        landing
            What :func:`landings` returns; from it the paths at long lags are composed of shorter
            ones. ``None`` to integrate all paths.
        """
        if landing is None:
            direct = len(self.lags)
        else:
            direct = self._direct_lags(landing)
        shape = (len(self.samplers), self.field.valid.size)
        sides = {}
        for direction in directions:
            sides[direction] = SideSlices(
                np.zeros((len(self.lags) + 1, *shape, 2), np.float32),
                np.zeros(shape, np.float32),
                np.zeros(shape, bool),
                np.zeros(shape, bool),
            )
        with _threads() as run:
            self._integrate(sides, direct, run)
            for direction, flat in sides.items():
                sides[direction] = self._as_grids(flat, direction)
            if landing is not None and direct < len(self.lags):
                way = direct, landing, run, self._piece, self.longest
                for together in self._together(sides):
                    compose(self.field, self.lags, self.unit, together, *way)
        return sides

    def _together(self, sides: dict[float, SideSlices]) -> list[dict[float, SideSlices]]:
        """Return the directions that are composed together: all where paths pass poles."""
        if self.field.surface.poles is not None:
            return [sides]
        alone = []
        for direction, side in sides.items():
            alone.append({direction: side})
        return alone

    def _direct_lags(self, landing: Indices) -> int:
        """Return the number of lags to integrate: up to a cell, and to the first time step."""
        if landing.any():
            return int(np.flatnonzero(landing)[0]) + 1
        pace = np.abs(self.rate[:, self.field.valid]).max(axis=-1)
        if pace.any():
            typical = float(np.median(pace[pace > 0]))
        else:
            typical = 1.0
        return max(int(np.searchsorted(self.lags * typical, DIRECT_CELLS, side="right")), 1)

    def _integrate(self, sides: dict[float, SideSlices], direct: int, run: Map) -> None:
        """Fill the first ``direct`` slices."""
        at = np.flatnonzero(self.followed)
        start = self.nodes.reshape(-1, 2)[at]
        unit = self.unit.ravel()[at]

        def work(job: tuple[int, float, slice]) -> None:
            step, direction, block = job
            side = sides[direction]
            nodes = at[block]
            slices = side.slices[1 : direct + 1, step]
            reach = side.reach[step]
            options: dict[str, Any] = {"direction": direction, "tolerance": self.tolerance}
            lags = self.lags[:direct]
            units = unit[block]
            result = integrate(self.samplers[step], start[block], lags, units, **options)
            moved = np.clip(result.positions - start[block], -MOST_CELLS, MOST_CELLS)
            target: Indices | slice = nodes
            if nodes[-1] - nodes[0] == len(nodes) - 1:
                # Writing to a slice is several times as fast as to a list of nodes.
                target = slice(nodes[0], nodes[-1] + 1)
            slices[:, target] = moved
            reach[target] = result.reach
            side.polar[step, target] = result.polar
            side.circling[step, target] = result.circling

        steps = range(len(self.samplers))
        blocks = [slice(first, first + BLOCK) for first in range(0, len(at), BLOCK)]
        jobs = list(itertools.product(steps, sides, blocks))
        for _ in track(run(work, jobs), len(jobs), "Tracing", show=self.progress):
            pass

    def _piece(
        self,
        position: Floats32,
        lag: Floats,
        step: Indices,
        direction: Floats,
        inside: Inside | None,
    ) -> tuple[Floats32, Floats, Floats, Bools]:
        """Follow some paths, an :data:`flowtex.trace.compose.Integrate`."""
        moved = np.empty_like(position)
        covered = lag.copy()
        ends = np.empty_like(lag)
        circling = np.zeros(len(lag), dtype=bool)
        numbers = [0]
        if len(self.samplers) > 1:
            numbers = np.unique(step).tolist()
        for number in numbers:
            if len(self.samplers) > 1:
                group = step == number
            else:
                group = slice(None)
            start = position[:, group].T.astype(float)
            unit = lag[group]
            sampler = self.samplers[number]
            options: dict[str, Any] = {"tolerance": self.tolerance}
            options["direction"] = direction[group]
            result = integrate(sampler, start, np.ones(1), unit, within=inside, **options)
            moved[:, group] = (result.positions[0] - start).T
            covered[group] = np.where(result.interrupted, result.reach, 1.0) * unit
            ends[group] = np.where(result.interrupted, np.inf, result.reach) * unit
            circling[group] = result.circling
        return moved, covered, ends, circling

    def _as_grids(self, flat: SideSlices, direction: float) -> SideSlices:
        """Lay out by nodes, with the slope at lag zero; blank nodes move as the nearest one."""
        grid = self.field.shape
        slices = flat.slices.reshape(*flat.slices.shape[:2], *grid, 2)
        slices[0] = direction * np.clip(self.rate, -MOST_CELLS, MOST_CELLS)
        blank = ~self.followed
        if blank.any() and self.followed.any():
            # In place: the slices are large, and few of them are blank.
            rows, columns = nearest_known(self.followed)
            slices[:, :, blank] = slices[:, :, rows[blank], columns[blank]]
        reach = flat.reach.reshape(-1, *grid)
        polar = flat.polar.reshape(-1, *grid)
        return SideSlices(slices, reach, polar, flat.circling.reshape(-1, *grid))


def lyapunov_exponent(field: FlowField, horizon: float) -> Steps:
    """Return the finite-time Lyapunov exponent at nodes and steps, (T, J, I), per unit of time.

    The trace slices are the flow map (Shadden, Lekien and Marsden 2005). It is NaN where a particle
    leaves the domain within the horizon, where particles gather closer than their paths are exact,
    and at steps from which the horizon leaves the series: a notice states how long it may be. Steps
    of a field that varies are computed when they are read.
    """
    room = np.full(1, np.inf)
    if not field.steady:
        room = np.abs(field.times[-1 if horizon > 0 else 0] - field.times)
    known = abs(horizon) <= room * (1 + 1e-9)
    if not known.all():
        first, last = field.times[[np.argmax(room), np.argmin(room)]]
        notify(
            f"FTLE is blank at {np.sum(~known)} of {len(known)} time steps, because horizon="
            f"{horizon:g} leads beyond the {'end' if horizon > 0 else 'start'} of the series; the "
            f"longest valid horizon is {last - first:g} at time {first:g}, and 0 at time {last:g}"
        )

    def at_step(step: int) -> Floats:
        if not known[step]:
            return np.full(field.shape, np.nan)
        moved, followed = _moved(field, step, horizon)
        gradient = node_gradient(field.surface, field.projection, followed)
        change = gradient.derivative(np.moveaxis(moved, -1, 0)) + gradient.directions
        a = np.einsum("c...,c...->...", change[0], change[0])
        b = np.einsum("c...,c...->...", change[0], change[1])
        d = np.einsum("c...,c...->...", change[1], change[1])
        largest = (a + d) / 2 + np.hypot((a - d) / 2, b)
        largest[largest < LEAST_STRETCH**2] = np.nan
        with np.errstate(divide="ignore", invalid="ignore"):
            return gradient.with_poles(np.log(largest) / (2 * abs(horizon)))

    if field.steady:
        return at_step(0)[None]
    return LazySteps(len(field.times), at_step)


FOLLOWED["ftle"] = lyapunov_exponent


def _moved(field: FlowField, step: int, horizon: float) -> tuple[Floats, Bools]:
    """Return displacements of the particles at the nodes, (J, I, 3), on the true surface.

    The second array marks the particles that are followed to the end, (J, I).
    """
    times = field.times - field.times[step]
    span = (min(horizon, 0.0), max(horizon, 0.0))
    forward = horizon > 0
    first = max(int(np.searchsorted(times, span[0], side="right")) - 1, 0)
    last = min(int(np.searchsorted(times, span[1])), len(times) - 1)
    part = field.at_steps(range(first, last + 1))
    valid = field.known_nodes(first, last)
    if (valid != field.valid).any():
        part = replace(part, valid=valid)
    if field.steady:
        # In a flow that may vary no particle rests, so that a path that ends has left the domain.
        # The first step is short: the estimated error of a long one may vanish by chance.
        velocity = np.repeat(part.velocity, 2, axis=0)
        times = FIRST_STEP * np.sort([0.0, horizon])
        part = replace(part, velocity=velocity, times=times)
        part.__dict__["surface"] = field.surface
        if forward:
            first = 0
        else:
            first = -1
    slices = trace(
        part, lags=[1.0], unit=abs(horizon), parameter="time", steps=[step - first],
        two_sided=forward, compose=False,
    )  # fmt: skip
    moved, reach = (
        (slices.forward, slices.forward_reach) if forward else (slices.displacement, slices.reach)
    )
    assert moved is not None
    assert reach is not None
    moved = moved[0, 0].astype(float)
    speed = np.nan_to_num(field.speed[step])
    # Rounding moves a particle at rest in a corner outward.
    moving = (speed > ROUNDED_SPEED * speed.max()) | ((reach[0] > 0) & (not field.steady))
    followed = valid & ~((reach[0] < 1) & moving)
    if not slices.in_space:
        moved = field.surface.at(slices.nodes + moved) - field.points
    before = true_positions(field.points, field.projection)
    after = true_positions(field.points + moved, field.projection)
    return np.where(followed[..., None], after - before, np.nan), followed
