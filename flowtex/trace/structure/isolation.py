"""Isolation of closed lines: a limit cycle is isolated, other closed lines have neighbours.

Over a turn, the distance of a line beside a closed one grows by a factor: the exponential of the
divergence of the velocity, integrated over the time of the turn. Lines approach or leave where it
is not 1. In a flow without divergence it is 1; there, lines nearly close by errors of
interpolation. So the integral must exceed its error by interpolation.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.field import FlowField
from flowtex.field.derived.gradient import node_gradient
from flowtex.field.locate import surface_point

#: Error of the divergence, in the change of the velocity's gradient over a cell: in a cell the
#: interpolated gradient is that of its middle, half a cell away.
ERROR_CELLS = 0.5


class Isolation:
    """Test of closed lines of a steady field."""

    def __init__(self, field: FlowField) -> None:
        self._field = field

    @cached_property
    def _nodal(self) -> Floats:
        """Divergence, its error, and the velocity at the nodes, (J, I, 5)."""
        surface, velocity = self._field.surface, self._field.velocity[0]
        gradient = node_gradient(surface, None)
        first = gradient.of_vectors(velocity)
        second = gradient.derivative(first.reshape(4, *surface.shape))
        error = ERROR_CELLS * surface.cell_size * np.sqrt((second**2).sum(axis=(0, 1)))
        return np.concatenate([np.stack([first[0, 0] + first[1, 1], error], -1), velocity], -1)

    def holds(self, turn: Floats) -> bool:
        """Return whether a closed line, indices (N, 2) as (i, j), is isolated."""
        surface = self._field.surface
        places = surface.at(np.concatenate([turn, turn[:1]]))
        rates = np.array([surface_point(surface, at[::-1]).interpolate(self._nodal) for at in turn])
        lengths = np.linalg.norm(np.diff(places, axis=0), axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            times = 0.5 * (lengths + np.roll(lengths, 1)) / np.linalg.norm(rates[:, 2:], axis=1)
            growth, error = times @ rates[:, :2]
        return bool(abs(growth) > error)
