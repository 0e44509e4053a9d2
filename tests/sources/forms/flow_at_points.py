"""Comparison of ``field.at`` with the flow of a form."""

from __future__ import annotations

from typing import Any

import numpy as np
from known_flow import Truth, ratio

from flowtex import FlowField

#: Nodes of each form at which values are asked for.
MOST_NODES = 5
#: Share of these outside of all drawn cells, as at a border or beside gaps.
MOST_OUTSIDE = 0.6
#: Error of interpolated values, as a share of the greatest speed.
NEAR = 5e-3


def check_at(field: FlowField, truth: Truth) -> None:
    """Compare ``field.at`` at nodes and the last time with the truth."""
    if truth.absent is not None:
        return
    step = len(truth.times) - 1
    time = None
    if len(field.times) > 1:
        time = field.times[step]
    scale = float(np.broadcast_to(truth.scale, len(truth.times))[step])
    flow = np.stack(truth.flow(*truth.places.T, truth.times[step]), axis=-1) * scale
    most = max(10 * truth.tolerance, NEAR) * np.linalg.norm(flow, axis=1).max()
    chosen = np.random.default_rng(0).permutation(len(flow))[:MOST_NODES]
    outside = 0
    for place, expected in zip(truth.places[chosen], flow[chosen], strict=True):
        found = values_at(field, truth, place, time)
        if found is None:
            outside += 1
        else:
            assert np.abs(found - expected).max() <= most, (place, found, expected)
    assert outside <= MOST_OUTSIDE * len(chosen), f"{outside} of {len(chosen)} nodes have no values"


def values_at(field: FlowField, truth: Truth, place: Any, time: Any) -> Any:
    """Return both components in the unit of the truth at a place; ``None`` outside the data."""
    if truth.on_earth:
        found = field.at(float(place[0]), float(place[1]), time=time)
    else:
        position = np.array(field.points.reshape(-1, 3)[0], dtype=float)
        position[list(truth.axes)] = place / ratio(field.length_unit, truth.unit)
        x, y, z = map(float, position)
        found = field.at(x, y, z, time=time)
    if found is None:
        return None
    unit = ratio(found.speed_unit, truth.speed_unit)
    if truth.on_earth:
        return np.array([found.eastward, found.northward]) * unit
    return found.velocity[list(truth.axes)] * unit
