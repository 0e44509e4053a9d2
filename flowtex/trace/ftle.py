"""The finite-time Lyapunov exponent, from the trace slices, which are a flow map.

Shadden, Lekien and Marsden 2005, Definition and properties of Lagrangian coherent structures from
finite-time Lyapunov exponents in two-dimensional aperiodic flows.
"""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.field import FlowField
from flowtex.field.derived import FOLLOWED
from flowtex.field.derived.gradient import node_gradient, true_positions
from flowtex.field.steps import LazySteps, Steps
from flowtex.trace.trace import trace


def lyapunov_exponent(field: FlowField, horizon: float) -> Steps:
    """Return the exponent at each node and step, (T, J, I), per unit of time.

    It is NaN where a particle leaves the domain within the horizon. Steps of a field that varies
    are computed when they are read.
    """
    gradient = node_gradient(field.surface, field.projection)

    def at_step(step: int) -> Floats:
        moved = _moved(field, step, horizon)
        change = gradient.derivative(np.moveaxis(moved, -1, 0)) + gradient.directions
        (a, b), (_, d) = (
            [np.einsum("c...,c...->...", one, two) for two in change] for one in change
        )
        largest = (a + d) / 2 + np.hypot((a - d) / 2, b)
        with np.errstate(divide="ignore", invalid="ignore"):
            return gradient.with_poles(np.log(largest) / (2 * abs(horizon)))

    if field.steady:
        return at_step(0)[None]
    return LazySteps(len(field.times), at_step)


FOLLOWED["ftle"] = lyapunov_exponent


def _moved(field: FlowField, step: int, horizon: float) -> Floats:
    """Return displacements of the particles at the nodes, (J, I, 3), on the true surface."""
    times = field.times - field.times[step]
    span, forward = (min(horizon, 0.0), max(horizon, 0.0)), horizon > 0
    first = max(int(np.searchsorted(times, span[0], side="right")) - 1, 0)
    last = min(int(np.searchsorted(times, span[1])), len(times) - 1)
    part = field.at_steps(range(first, last + 1))
    slices = trace(
        part, lags=[1.0], unit=abs(horizon), parameter="time", steps=[step - first],
        two_sided=forward, compose=False,
    )  # fmt: skip
    moved, reach = (
        (slices.forward, slices.forward_reach) if forward else (slices.displacement, slices.reach)
    )
    assert moved is not None
    assert reach is not None
    # Particles at rest have not left.
    moved, ended = moved[0, 0].astype(float), (reach[0] < 1) & (field.speed[step] > 0)
    if not slices.in_space:
        moved = field.surface.at(slices.nodes + moved) - field.points
    before, after = (
        true_positions(p, field.projection) for p in (field.points, field.points + moved)
    )
    result = after - before
    result[ended | ~field.valid] = np.nan
    return np.asarray(result)
