"""How long tracing takes, by part, beside one pass of line integral convolution.

Run ``python benchmarks/trace.py [columns ...]``. Times are the best of several runs, in seconds,
and compare with one 25-tap pass of rlic over the same number of nodes in the same run.
``python benchmarks/trace.py --triangles`` compares slices on triangles that are composed with those
that are integrated: processor time, and how far apart they lie, in cells.
"""

from __future__ import annotations

import importlib
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import rlic

from flowtex import FlowField, TraceSlices, examples, trace
from flowtex.textures.texture_set import TextureSet
from flowtex.trace.store import SliceStore

RUNS = 3
#: Nodes of the surfaces of triangles.
TRIANGLE_SURFACE_NODES = 20_000
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


def apart(composed: TraceSlices, exact: TraceSlices, m: int, cell: Any) -> Any:
    """Distances in cells at a lag, of paths that continue by both."""
    off = np.linalg.norm(composed.displacement - exact.displacement, axis=-1)[0, m, 0] / cell
    both = np.minimum(composed.reach, exact.reach)[0, 0] > exact.lags[m]
    return off[both]


def compare(names: list[str]) -> None:
    """Print the table of surfaces of triangles."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
    from surfaces import TRIANGLES

    heads = ("triangles", "integrated", "composed", "ratio")
    say(f"{'':18}" + "".join(f"{head:>12}" for head in heads) + "   lag: median, 99 %, in cells")
    for name in names or TRIANGLES:
        field = FlowField.from_pyvista(TRIANGLES[name](TRIANGLE_SURFACE_NODES))
        found: dict[bool, tuple[float, TraceSlices]] = {}
        for compose in (True, False):
            SliceStore(field, compose=True).at(0)
            started = time.process_time()
            slices = SliceStore(field, compose=compose).at(0)
            found[compose] = time.process_time() - started, slices
        (fast, composed), (slow, exact) = found[True], found[False]
        line = f"{name:18}{len(field.triangles):12,}{slow:12.2f}{fast:12.2f}{slow / fast:12.1f}   "
        for m in range(len(exact.lags)):
            off = apart(composed, exact, m, field.surface.cell_size[0])
            if len(off) and off.max() > 0:
                ends = np.quantile(off, [0.5, 0.99])
                line += f"{exact.lags[m]:g}: {ends[0]:.3f}, {ends[1]:.2f};  "
        say(line)


def say(line: str) -> None:
    """Write a line at once."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def main(columns: list[int]) -> None:
    """Print the table."""
    heads = ("metric", "vorticity", "integrate", "compose", "trace", "layers", "rlic")
    heads = (*heads, "trace / rlic", "MB")
    say(f"{'':22}{'nodes':>12}" + "".join(f"{head:>13}" for head in heads))
    for name, make in fields(columns).items():
        field = make()
        started = time.perf_counter()
        _ = field.surface.cell_size, field.index_velocity
        metric = time.perf_counter() - started
        vorticity = best(lambda field=field: field.at_step(0).derive("vorticity"))
        whole, composed = composing(field)
        textures = TextureSet.build(SliceStore(field, slices=trace(field)))
        layers, taps = best(textures.layers), convolution(field)
        size = trace(field).nbytes / 1e6
        rows, count = field.shape
        numbers = (metric, vorticity, whole - composed, composed, whole, layers, taps)
        numbers = (*numbers, whole / taps, size)
        say(f"{name:22}{count:>6} x{rows:>4}" + "".join(f"{n:13.3f}" for n in numbers))


if __name__ == "__main__":
    if sys.argv[1:2] == ["--triangles"]:
        compare(sys.argv[2:])
        sys.exit()
    main([int(word) for word in sys.argv[1:]] or [250, 500])
