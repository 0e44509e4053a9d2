"""How far particles are from where they should be, when slices or the field are made coarser."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.field import FlowField
from flowtex.field.interpolation import along_line, between_nodes
from flowtex.trace.slices import TraceSlices
from flowtex.trace.trace import paths, trace
from paper.blocks import block_means

#: Steps of time that a particle goes back.
STEPS = 10


@dataclass(frozen=True)
class Errors:
    """Mean distances from the accurate positions after 1 ... 10 time steps, (10,) each.

    Attributes
    ----------
    slices
        With slices made coarser as a mip level is, at their own entries.
    field
        With paths integrated again in the field made coarser, from the same starts.
    between
        With the coarser slices between their entries, linear as a texture is looked up.
    full
        With slices of the full resolution between their entries.
    travelled
        How far the particles went, as the crow flies.
    texels
        Error of the slices after the last step, in their own cells.
    grid
        Entries (J, I) of the coarser slices.
    """

    slices: Floats
    field: Floats
    between: Floats
    full: Floats
    travelled: Floats
    texels: float
    grid: tuple[int, int]

    @property
    def quotient(self) -> Floats:
        """Error of the slices over that of the field, after each step, (10,)."""
        return np.asarray(self.slices / self.field)

    @property
    def growth(self) -> dict[str, float]:
        """Error after the last step over that after the first."""
        return {
            "slices": float(self.slices[-1] / self.slices[0]),
            "field": float(self.field[-1] / self.field[0]),
        }

    @property
    def even(self) -> float:
        """Way after which the slices stop being the more accurate ones; infinite if they never do.

        In the field's units of length, linear between the steps.
        """
        over = np.flatnonzero(self.quotient > 1)
        if not len(over):
            return float("inf")
        at = int(over[0])
        if at == 0:
            return float(self.travelled[0])
        return float(
            np.interp(1.0, self.quotient[at - 1 : at + 1], self.travelled[at - 1 : at + 1])
        )


def step_slices(field: FlowField, step: int, tolerance: float) -> TraceSlices:
    """Trace the slices of one destination time at lags of 1 ... 10 time steps.

    `tolerance` is the error in cells that is allowed in one step of the integration.
    """
    return trace(
        field,
        lags=_lags(field),
        steps=[step],
        compose=False,
        tolerance=tolerance,
        progress=False,
    )


def position_errors(
    field: FlowField,
    slices: TraceSlices,
    factor: int,
    count: int,
    rng: np.random.Generator,
    tolerance: float,
) -> Errors:
    """Follow particles back, by slices and by fields of fewer nodes.

    Parameters
    ----------
    field
        A field that varies in time, with equal steps.
    slices
        Its slices, from :func:`step_slices`.
    factor
        How many nodes become one along each axis.
    count
        Number of particles.
    rng
        Which of them.
    tolerance
        Error in cells that is allowed in one step of the integration.

    Returns
    -------
    Errors
        In the field's unit of length.
    """
    step = int(np.argmin(np.abs(field.times - slices.times[0])))
    coarse = slices.mapped(lambda data, axis: block_means(data, factor, axis))
    at = field.surface.at
    entries = coarse.nodes.reshape(-1, 2)
    entries = entries[rng.permutation(len(entries))[:count]]
    start, true = _accurate(field, entries, step, tolerance)
    low, high = coarse.nodes[0, 0], coarse.nodes[-1, -1]
    anywhere, true_anywhere = _accurate(field, rng.uniform(low, high, (count, 2)), step, tolerance)
    lines = _lines(field, factor)
    result = paths(
        field.downsample(factor),
        _inverse(lines, start),
        _lags(field),
        step=step,
        tolerance=tolerance,
    )

    coarse_positions = _looked_up(coarse, start)
    cells = np.linalg.norm(coarse_positions[-1] - true[-1], axis=-1)

    def apart(one: Floats, other: Floats) -> Floats:
        distance: Floats = np.linalg.norm(at(one) - at(other), axis=-1)
        return np.asarray(distance.mean(axis=1))

    return Errors(
        slices=apart(coarse_positions, true),
        field=apart(np.stack([_forward(lines, p) for p in result.positions]), true),
        between=apart(_looked_up(coarse, anywhere), true_anywhere),
        full=apart(_looked_up(slices, anywhere), true_anywhere),
        travelled=apart(np.broadcast_to(start, true.shape), true),
        texels=float(cells.mean() / factor),
        grid=coarse.shape,
    )


def _lags(field: FlowField) -> Floats:
    return np.asarray(np.mean(np.diff(field.times)) * np.arange(1, STEPS + 1))


def _accurate(
    field: FlowField, start: Floats, step: int, tolerance: float
) -> tuple[Floats, Floats]:
    """Return starts whose paths do not end, (N, 2), and the true positions, (M, N, 2)."""
    result = paths(field, start, _lags(field), step=step, tolerance=tolerance)
    alive = result.reach >= _lags(field)[-1]
    return start[alive], result.positions[:, alive]


def _looked_up(slices: TraceSlices, start: Floats) -> Floats:
    """Positions (M, N, 2) from the displacements of the entries around, linear between them."""
    first, last = slices.nodes[0, 0], slices.nodes[-1, -1]
    spread = (last - first) / (np.array(slices.shape[::-1]) - 1)
    index = (start - first) / spread
    displacements = [
        [between_nodes(data[..., axis], index) for axis in range(2)]
        for data in slices.displacement[0]
    ]
    return np.asarray(start + np.moveaxis(np.array(displacements), 1, 2))


def _lines(field: FlowField, factor: int) -> tuple[Floats, Floats]:
    """Lines of nodes (I,) and (J,) that a coarser field keeps: every so many, and a closing one."""
    rows, columns = field.shape
    result = []
    for count, closed in ((columns, field.periodic[1]), (rows, field.periodic[0])):
        line = np.arange(0, count, factor)
        if closed and line[-1] != count - 1:
            line = np.append(line, count - 1)
        result.append(line.astype(float))
    return result[0], result[1]


def _forward(lines: tuple[Floats, Floats], index: Floats) -> Floats:
    """Take positions in the coarser index space to the finer one; periods go on."""
    parts = [along_line(line, index[..., a], periodic=True) for a, line in enumerate(lines)]
    return np.stack(parts, axis=-1)


def _inverse(lines: tuple[Floats, Floats], index: Floats) -> Floats:
    """Take positions inside the finer index space to the coarser one."""
    parts = [np.interp(index[..., a], line, np.arange(len(line))) for a, line in enumerate(lines)]
    return np.stack(parts, axis=-1)
