"""All paths of one call of :func:`flowtex.trace`: which are integrated, and which composed.

Particles are followed in blocks small enough to stay in a processor's cache, several blocks at a
time in threads: NumPy lets go of the interpreter inside its loops.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from flowtex._util.progress import track
from flowtex.field import FlowField
from flowtex.trace.compose import Within, compose
from flowtex.trace.integrate import integrate
from flowtex.trace.sampler import Sampler

__all__ = ["Found", "Work"]

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Indices = NDArray[np.intp]

#: Particles followed together.
BLOCK = 16384
#: Cells up to which the paths of a steady field are integrated; longer ones are composed.
DIRECT = 1.0


@dataclass(frozen=True, eq=False)
class Found:
    """Slices of one direction, (2, M + 1, T, J, I), reach, and what came near a pole (T, J, I)."""

    slices: NDArray[np.float32]
    reach: NDArray[np.float32]
    polar: NDArray[np.bool_]

    @property
    def displacement(self) -> NDArray[np.float32]:
        """The same numbers as (T, M, J, I, 2)."""
        return np.moveaxis(self.slices[:, 1:], (0, 2), (4, 0))


@dataclass(frozen=True, eq=False)
class Work:
    """Everything that the paths of one call share."""

    field: FlowField
    samplers: list[Sampler]
    lags: Floats
    unit: Floats
    tolerance: float
    progress: bool

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
        rate = np.stack([sampler.rate(start, still, 1.0) for sampler in self.samplers])
        rate = np.moveaxis(rate.reshape(-1, 2, *self.field.shape), 1, -1) * self.unit[..., None]
        rate[:, ~self.field.valid] = 0.0
        return rate

    def follow(self, sides: Sequence[float], landing: Indices | None) -> dict[float, Found]:
        """Follow all paths, by composition where there are landings."""
        known = len(self.lags) if landing is None else self._direct(landing)
        shape = (len(self.samplers), self.field.valid.size)
        found = {
            side: Found(
                np.empty((2, len(self.lags) + 1, *shape), np.float32),
                np.zeros(shape, np.float32),
                np.zeros(shape, bool),
            )
            for side in sides
        }
        with ThreadPoolExecutor(max_workers=min(os.cpu_count() or 1, 8)) as pool:
            self._integrate(found, known, pool)
            for side, paths in found.items():
                grid = self._as_grids(paths, side)
                if landing is not None and known < len(self.lags):
                    compose(
                        self.field,
                        self.lags,
                        self.unit,
                        grid.slices,
                        grid.reach,
                        known,
                        landing,
                        pool.map,
                        grid.polar,
                        partial(self._piece, side),
                    )
                found[side] = grid
        return found

    def _direct(self, landing: Indices) -> int:
        """How many lags to integrate: a cell, and up to the first time step."""
        if landing.any():
            return int(np.flatnonzero(landing)[0]) + 1
        pace = np.abs(self.rate[:, self.field.valid]).max(axis=-1)
        typical = float(np.median(pace[pace > 0])) if pace.any() else 1.0
        return max(int(np.searchsorted(self.lags * typical, DIRECT, side="right")), 1)

    def _integrate(self, found: dict[float, Found], known: int, pool: ThreadPoolExecutor) -> None:
        """Fill the first ``known`` slices."""
        at = np.flatnonzero(self.field.valid)
        start, unit = self.nodes.reshape(-1, 2)[at], self.unit.ravel()[at]

        def work(job: tuple[int, float, slice]) -> None:
            step, side, block = job
            result = integrate(
                self.samplers[step],
                start[block],
                self.lags[:known],
                unit[block],
                direction=side,
                tolerance=self.tolerance,
            )
            moved = np.moveaxis(result.positions - start[block], 2, 0)
            nodes: Indices | slice = at[block]
            if at[block][-1] - at[block][0] == len(at[block]) - 1:
                # Writing to a slice is several times as fast as to a list of nodes.
                nodes = slice(at[block][0], at[block][-1] + 1)
            found[side].slices[:, 1 : known + 1, step, nodes] = moved
            found[side].reach[step, nodes] = result.reach
            found[side].polar[step, nodes] = result.polar

        jobs = [
            (step, side, slice(first, first + BLOCK))
            for step in range(len(self.samplers))
            for side in found
            for first in range(0, len(at), BLOCK)
        ]
        for _ in track(pool.map(work, jobs), len(jobs), "Tracing", show=self.progress):
            pass

    def _piece(
        self, side: float, position: Singles, lag: Singles, step: Indices, within: Within | None
    ) -> tuple[Singles, Singles, Singles]:
        """Follow some paths, as :data:`flowtex.trace.compose.Integrate` says."""
        moved, gone, ends = np.empty_like(position), lag.copy(), np.empty_like(lag)
        for number in np.unique(step) if len(self.samplers) > 1 else [0]:
            some = step == number if len(self.samplers) > 1 else slice(None)
            start, unit = position[:, some].T.astype(float), lag[some].astype(float)
            found = integrate(
                self.samplers[number],
                start,
                np.ones(1),
                unit,
                direction=side,
                tolerance=self.tolerance,
                within=within,
            )
            moved[:, some] = (found.positions[0] - start).T
            gone[some] = np.where(found.left, found.reach, 1.0) * unit
            ends[some] = np.where(found.left, np.inf, found.reach) * unit
        return moved, gone, ends

    def _as_grids(self, paths: Found, side: float) -> Found:
        """Lay out by nodes, with the slope at lag zero; blanked nodes move as the nearest do."""
        grid = self.field.shape
        slices = paths.slices.reshape(*paths.slices.shape[:3], *grid)
        slices[:, 0] = side * np.moveaxis(self.rate, -1, 0)
        if not self.field.valid.all():
            rows, columns = ndimage.distance_transform_edt(
                ~self.field.valid, return_distances=False, return_indices=True
            )
            blank = ~self.field.valid
            slices[..., blank] = slices[..., rows[blank], columns[blank]]
        return Found(slices, paths.reach.reshape(-1, *grid), paths.polar.reshape(-1, *grid))
