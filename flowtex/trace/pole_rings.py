"""Nodes beside poles, of which some are followed and the others interpolated.

All nodes of a pole lie at one point, and those of the lines beside it much closer together than a
cell is long. Their paths are interpolated along each line, in the plane of the pole.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Complexes, Floats, Floats32, Indices
from flowtex.field.grids.poles import Pole, Poles
from flowtex.trace.sampler import CLOSE_CELLS, Charts

#: Distance in cells between nodes of a line whose paths are followed.
SPACING = 0.25
#: Fewest of them on a line beside a pole.
LEAST_NODES = 12


@dataclass(frozen=True, eq=False)
class _Ring:
    """Nodes of a line around a pole."""

    chart: int  #: Number of the pole, from 1.
    nodes: Indices  #: Numbers of all of them among those of the grid, (n + 1,).
    position: Floats  #: Their positions as (i, j), (2, n + 1).
    chosen: Indices  #: Which of them are followed, (k,), the first of them 0.
    along: Floats  #: Distances of all from the first one along the line in cells, (n + 1,).


@dataclass(frozen=True, eq=False)
class PoleRings:
    """Lines of nodes close to the poles of a surface."""

    charts: Charts
    rings: list[_Ring]
    followed: Bools  #: Nodes whose paths are followed, (J * I,).

    @classmethod
    def of(cls, poles: Poles, shape: tuple[int, int]) -> Self:
        """Choose the nodes of a grid of J x I nodes that are followed."""
        charts = Charts(poles)
        numbers = np.arange(shape[0] * shape[1]).reshape(shape)
        followed = np.ones(numbers.size, dtype=bool)
        rings = []
        for chart, pole in enumerate(poles, 1):
            # Cells beyond the last of the close lines are next to one of these nodes.
            for depth in range(min(CLOSE_CELLS, charts.near) + 1):
                ring = _ring(pole, chart, depth, numbers)
                if len(ring.chosen) < pole.cells:
                    rings.append(ring)
                    followed[ring.nodes] = False
                    followed[ring.nodes[ring.chosen]] = True
        return cls(charts, rings, followed)

    def fill(self, moved: Complexes, reach: Floats32) -> None:
        """Write displacements and reach (J * I,) of the nodes that are not followed in place."""
        for ring in self.rings:
            known = ring.nodes[ring.chosen]
            own = ring.position[:, ring.chosen]
            there = own + np.stack([moved[known].real, moved[known].imag])
            at = np.full(len(known), ring.chart)
            place = self.charts.enter(there, at)
            knots = np.append(ring.along[ring.chosen], ring.along[-1])
            values = np.concatenate([place, place[:, :1]], axis=1)
            between = _periodic(knots, values, ring.along)
            everywhere = np.full(len(ring.nodes), ring.chart)
            index = self.charts.index(between, everywhere, ring.position)
            others = np.setdiff1d(np.arange(len(ring.nodes)), ring.chosen)
            away = index[:, others] - ring.position[:, others]
            moved[ring.nodes[others]] = away[0] + 1j * away[1]
            near = np.searchsorted(ring.chosen, others, side="right") - 1
            reach[ring.nodes[others]] = reach[known[near]]


def _ring(pole: Pole, chart: int, depth: int, numbers: Indices) -> _Ring:
    """Return the nodes of a line some cells away from a pole."""
    line = pole.line + pole.inward * depth
    nodes = pole.lines(numbers)[line]
    position = np.empty((2, len(nodes)))
    position[1 - pole.component] = np.arange(len(nodes))
    position[pole.component] = line
    if depth == 0:
        return _Ring(chart, nodes, position, np.zeros(1, np.intp), np.linspace(0, 1, len(nodes)))
    place = pole.place(position)
    gaps = np.hypot(*np.diff(place, axis=1))
    along = np.concatenate([[0.0], np.cumsum(gaps)])
    spacing = min(SPACING, along[-1] / LEAST_NODES)
    spans = np.floor(along[:-1] / spacing)
    chosen = np.flatnonzero(np.diff(spans, prepend=-1))
    return _Ring(chart, nodes, position, chosen, along)


def _periodic(knots: Floats, values: AnyArray, at: Floats) -> Floats:
    """Return values (2, n) between those at knots (k + 1,), by cubics; the last knot is the first.

    Slopes at the knots are those of the parabola through three of them.
    """
    gaps = np.diff(knots)
    rises = np.diff(values, axis=1) / gaps
    before = np.roll(gaps, 1)
    slopes = (np.roll(rises, 1, axis=1) * gaps + rises * before) / (gaps + before)
    slopes = np.concatenate([slopes, slopes[:, :1]], axis=1)
    number = np.clip(np.searchsorted(knots, at, side="right") - 1, 0, len(gaps) - 1)
    gap = gaps[number]
    s = (at - knots[number]) / gap
    r = 1 - s
    low = values[:, number]
    high = values[:, number + 1]
    bent_low = slopes[:, number] * gap
    bent_high = slopes[:, number + 1] * gap
    return np.asarray(
        r * r * (low + s * (2 * low + bent_low)) + s * s * (high + r * (2 * high - bent_high))
    )
