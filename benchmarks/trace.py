"""How long tracing takes, by part, beside one pass of line integral convolution.

Run ``python benchmarks/trace.py [columns ...]``. Times are the best of several runs, in seconds,
and compare with one 25-tap pass of rlic over the same number of nodes in the same run.
"""

from __future__ import annotations

import importlib
import sys
import time
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import rlic

from flowtex import FlowField, Settings, examples, trace
from flowtex.textures import TextureSet
from flowtex.trace import SliceStore

RUNS = 3
#: The module, which the function of the same name hides.
TRACE = importlib.import_module("flowtex.trace.trace")


def best(function: Callable[[], Any], runs: int = RUNS) -> float:
    """Shortest of several runs."""
    times = []
    for _ in range(runs):
        started = time.perf_counter()
        function()
        times.append(time.perf_counter() - started)
    return min(times)


def convolution(field: FlowField) -> float:
    """One pass of rlic with 25 taps."""
    u, v = (np.ascontiguousarray(field.velocity[0, ..., c]) for c in range(2))
    noise = np.random.default_rng(0).random(field.shape)
    kernel = np.hanning(27)[1:-1]
    return best(lambda: rlic.convolve(noise, u, v, kernel=kernel, iterations=1))


def composing(field: FlowField) -> tuple[float, float]:
    """Return the times of a whole trace, and of what of it is composing."""
    spent: list[float] = []
    original = TRACE.compose

    def timed(*arguments: Any, **options: Any) -> None:
        started = time.perf_counter()
        original(*arguments, **options)
        spent.append(time.perf_counter() - started)

    TRACE.compose = timed
    try:
        whole = []
        for _ in range(RUNS):
            spent.clear()
            started = time.perf_counter()
            trace(field, progress=False)
            whole.append((time.perf_counter() - started, sum(spent)))
    finally:
        TRACE.compose = original
    return min(whole)


def fields(columns: list[int]) -> dict[str, Callable[[], FlowField]]:
    """Return the fields, by the name that the table gives them."""
    makers: dict[str, Callable[[], FlowField]] = {}
    for n in columns:
        makers[f"double gyre {n}"] = partial(examples.double_gyre_field, shape=(n, n))
        makers[f"airfoil {n}"] = partial(examples.airfoil_field, (n, n + 1))
    makers["cylinder, 31 steps"] = examples.cylinder_field
    makers["vortex, 31 steps"] = examples.vortex_field
    return makers


def say(line: str) -> None:
    """Write a line at once."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def main(columns: list[int]) -> None:
    """Print the table."""
    heads = ("metric", "integrate", "compose", "trace", "layers", "rlic", "trace / rlic", "MB")
    say(f"{'':22}{'nodes':>12}" + "".join(f"{head:>13}" for head in heads))
    for name, make in fields(columns).items():
        field = make()
        started = time.perf_counter()
        _ = field.surface.cell_size, field.index_velocity
        metric = time.perf_counter() - started
        whole, composed = composing(field)
        textures = TextureSet.build(SliceStore(field, slices=trace(field)), Settings())
        layers, taps = best(textures.layers), convolution(field)
        size = trace(field).nbytes / 1e6
        rows, count = field.shape
        numbers = (metric, whole - composed, composed, whole, layers, taps, whole / taps, size)
        say(f"{name:22}{count:>6} x{rows:>4}" + "".join(f"{n:13.3f}" for n in numbers))


if __name__ == "__main__":
    main([int(word) for word in sys.argv[1:]] or [250, 500])
