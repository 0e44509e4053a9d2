"""What a node takes in a store: ``python benchmarks/stores.py``.

A pyramid of eddies of many sizes is built in this process, on a straight and on a crooked grid:
processor time and bytes of a node, and what the bytes are for. ``--size`` chooses another grid.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

import flowtex

#: Eddies that are added up.
EDDIES = 24


def eddies(columns: int, rows: int, *, crooked: bool) -> flowtex.FlowField:
    """Return a flow of eddies in a stream."""
    x, y = np.meshgrid(np.linspace(0, 8, columns), np.linspace(0, 8 * rows / columns, rows))
    rng = np.random.default_rng(0)
    velocity = np.stack([np.full_like(x, 0.3), np.zeros_like(x)], axis=-1)
    for k in range(EDDIES):
        wave = rng.normal(size=2) * 3 * (1 + k / 4)
        size = 1 / (1 + k / 4) / np.hypot(*wave)
        phase = np.sin(wave[0] * x + wave[1] * y + rng.uniform(0, 2 * np.pi))
        velocity += size * phase[..., None] * [wave[1], -wave[0]]
    if crooked:
        x, y = x + 0.1 * np.sin(2 * y), y + 0.15 * np.sin(1.5 * x)
    return flowtex.FlowField.from_arrays(np.stack([x, y], axis=-1), velocity)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", default="1024x512", help="columns x rows")
    columns, rows = map(int, parser.parse_args().size.split("x"))
    kinds = ("flow", "values", "surface", "velocity", "points", "valid")
    table = Table("grid", "µs", "bytes", *kinds)
    for crooked in (False, True):
        field = eddies(columns, rows, crooked=crooked)
        with tempfile.TemporaryDirectory() as folder:
            start = time.process_time()
            flowtex.pyramid.build(field, f"{folder}/flow.zarr", progress=False)
            seconds = time.process_time() - start
            sizes = Counter[str]()
            for path in Path(folder).rglob("c/**/*"):
                if path.is_file():
                    parts = path.relative_to(folder).parts
                    sizes[parts[parts.index("c") - 1]] += path.stat().st_size
        each = [f"{sizes[kind] / columns / rows:.2f}" for kind in kinds]
        words = (f"{1e6 * seconds / columns / rows:.1f}", f"{sizes.total() / columns / rows:.1f}")
        table.add_row("crooked" if crooked else "straight", *words, *each)
    Console().print(table)


if __name__ == "__main__":
    main()
