"""How far the paths of each level of a pyramid are off: ``python benchmarks/levels.py``.

A level is traced in velocities that are averaged over what it leaves out. Its positions at a lag of
so many of its own cells are held against paths that are integrated in the finest data and then
averaged over what a texel of the level covers. Fields are random, smooth (waves of 64 cells and
more) and rough (down to 4 cells, with the spectrum of turbulence), steady and varying in time.
Printed are the median and the 95th percentile of the distance, in texels of the level.
"""

from __future__ import annotations

import argparse

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

import flowtex
from flowtex.textures.tiles.grid_pyramid import GridPyramid
from flowtex.trace.trace import paths, trace

Floats = NDArray[np.float64]

#: Points of a level at which paths are compared, cells of it at either side of which none is.
POINTS, MARGIN = 400, 24
STEPS = 5
#: Offsets in half texels, and weights, of the mean over a texel and its neighbours' halves.
OFFSETS, WEIGHTS = (-1.0, 0.0, 1.0), (0.25, 0.5, 0.25)


def random_flow(size: int, shortest: float, steps: int, seed: int = 0) -> flowtex.FlowField:
    """Make a random flow on ``size`` x ``size`` unit cells, with waves of ``shortest`` cells up.

    It is free of divergence; its typical speed is a cell in a unit of time. One that varies turns
    over in its whole time, in which a particle goes 32 cells.
    """
    rng = np.random.default_rng(seed)
    k = np.hypot(*np.meshgrid(np.fft.fftfreq(size), np.fft.fftfreq(size)))
    with np.errstate(divide="ignore"):
        amplitude = np.where((k > 0) & (k < 1 / shortest), np.maximum(k, 1 / 256) ** (-7 / 3), 0.0)
    phase = rng.uniform(0, 2 * np.pi, k.shape)
    turning = rng.uniform(-1, 1, k.shape)
    velocity = []
    for time in np.linspace(0, 1, steps):
        psi = np.fft.ifft2(amplitude * np.exp(1j * (phase + np.pi * turning * time))).real
        gradient_j, gradient_i = np.gradient(psi)
        velocity.append(np.stack([gradient_j, -gradient_i], axis=-1))
    together = np.stack(velocity)
    together /= np.sqrt(np.mean(together**2) * 2)
    y, x = np.mgrid[0:size, 0:size].astype(float)
    times = None if steps == 1 else np.linspace(0, 32, steps)
    return flowtex.FlowField.from_arrays(np.stack([x, y], -1), together, times=times, periodic="")


def error(field: flowtex.FlowField, level: int, cells: float) -> Floats:
    """Distances, in texels of the level, at a lag of so many of its cells, (N,)."""
    pyramid, size = GridPyramid(field), 2**level
    coarse = pyramid.at_level(level)
    lag = cells * size
    by_time = {"parameter": "time"}
    slices = trace(coarse, lags=[lag / 2, lag], two_sided=False, progress=False, **by_time)
    rng = np.random.default_rng(level)
    columns = coarse.shape[1]
    margin = min(MARGIN, columns // 4)
    at = rng.integers(margin, columns - margin, (POINTS, 2))
    mean = np.zeros((POINTS, 2))
    for a, share in zip(OFFSETS, WEIGHTS, strict=True):
        for b, part in zip(OFFSETS, WEIGHTS, strict=True):
            start = at * size + 0.5 * size * np.array([a, b])
            moved = paths(field, start, [lag], step=-1, **by_time).positions[0] - start
            mean += share * part * moved
    mine = slices.displacement[-1, -1][at[:, 1], at[:, 0]]
    ends = slices.reach[-1][at[:, 1], at[:, 0]]
    return np.linalg.norm(mine - mean / size, axis=-1)[np.isinf(ends)]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, default=512, help="nodes along a side")
    parser.add_argument("--lag", type=float, default=16.0, help="lag in cells of the level")
    chosen = parser.parse_args()
    table = Table(title=f"distance in texels, median / 95th percentile, {chosen.lag:g} cells on")
    for name in ("flow", *(f"level {n}" for n in range(1, 5))):
        table.add_column(name)
    for text, shortest in (("smooth", 64), ("rough", 4)):
        for kind, steps in (("steady", 1), ("varying", STEPS)):
            field = random_flow(chosen.size, shortest, steps)
            row = []
            for level in range(1, 5):
                off = error(field, level, chosen.lag)
                low, high = np.percentile(off, (50, 95))
                row.append(f"{low:.2f} / {high:.2f}")
            table.add_row(f"{text}, {kind}", *row)
    Console().print(table)


if __name__ == "__main__":
    main()
