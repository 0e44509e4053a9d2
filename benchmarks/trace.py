"""How long tracing takes, by part, beside one pass of line integral convolution.

Run ``python benchmarks/trace.py [columns ...]``. Times are the best of several runs, in seconds,
and compare with one 25-tap pass of rlic over the same number of nodes in the same run.
``python benchmarks/trace.py --compiled`` compares NumPy with compiled loops, in processor time.
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
from flowtex._util import compiled
from flowtex.textures import TextureSet
from flowtex.trace import SliceStore
from flowtex.trace.lags import choose_lags

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


def gyre(rows: int, columns: int, steps: int) -> FlowField:
    """Return the double gyre on stretched cells."""
    y, x = np.meshgrid(
        np.linspace(0, 1, rows) ** 1.2, 2 * np.linspace(0, 1, columns) ** 1.2, indexing="ij"
    )
    v = []
    for time_ in np.arange(steps):
        a = 0.25 * np.sin(0.2 * np.pi * time_)
        f, slope = a * x * x + (1 - 2 * a) * x, 2 * a * x + 1 - 2 * a
        u = -np.sin(np.pi * f) * np.cos(np.pi * y)
        v.append(0.1 * np.pi * np.stack([u, np.cos(np.pi * f) * np.sin(np.pi * y) * slope], -1))
    return FlowField.from_arrays(np.stack([x, y], axis=-1), np.stack(v) if steps > 1 else v[0])


def window(steps: int) -> SliceStore:
    """Return a window of 330 x 330 nodes, followed for 32 cells."""
    field = gyre(330, 330, steps)
    nodes = np.zeros(field.shape, bool)
    nodes[32:-32, 32:-32] = True
    longest = 32 * float(np.median(field.surface.cell_size))
    return SliceStore(field, compose=False, longest=longest, nodes=nodes)


def load() -> None:
    """Compile, or load what has been compiled before."""
    started = time.process_time(), time.perf_counter()
    compiled._load()
    spent = np.subtract((time.process_time(), time.perf_counter()), started)
    if compiled.kernels() is None:
        sys.exit("numba is missing or fails")
    say("compiled, or loaded, in {:.1f} s of processor, {:.1f} s by the clock".format(*spent))


def compare() -> None:
    """Print the table of compiled loops."""
    varying, steady = gyre(500, 500, 5), gyre(500, 1000, 1)
    lags = choose_lags(varying, "time")
    textures = TextureSet.build(SliceStore(steady), Settings())
    windows = [window(1), window(5)]
    cases: dict[str, Callable[[], Any]] = {
        "500 x 500, one of 5 steps": lambda: trace(
            varying, lags=lags, steps=[4], compose=False, progress=False
        ),
        "500 x 500, all 5 steps": lambda: trace(varying, progress=False),
        "1000 x 500, steady": lambda: trace(steady, progress=False),
        "1000 x 500, its layers": textures.layers,
        "window, steady": lambda: windows[0]._trace(0),
        "window, one of 5 steps": lambda: windows[1]._trace(4),
    }
    compiled._begun.acquire()
    spent: dict[str, list[float]] = {}
    for ready in (False, True):
        if ready:
            load()
        for name, work in cases.items():
            work()
            times = [(time.process_time(), time.perf_counter())]
            for _ in range(RUNS):
                work()
                times.append((time.process_time(), time.perf_counter()))
            spent.setdefault(name, []).extend(np.diff(times, axis=0).min(axis=0))
    say(f"{'':28}{'NumPy':>12}{'by clock':>12}{'compiled':>12}{'by clock':>12}{'ratio':>8}")
    for name, (slow, slow_wall, fast, wall) in spent.items():
        numbers = "".join(f"{n:12.2f}" for n in (slow, slow_wall, fast, wall))
        say(f"{name:28}{numbers}{slow / fast:8.1f}")


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
    if "--compiled" in sys.argv:
        compare()
        sys.exit()
    main([int(word) for word in sys.argv[1:]] or [250, 500])
