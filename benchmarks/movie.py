"""Processor time of the pictures of a movie: ``python benchmarks/movie.py``.

User and system time of all threads, so that other programs on the machine count little. With
software OpenGL that is the work of all cores. The camera stands still.
"""

from __future__ import annotations

import argparse
import os
import tempfile
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

import flowtex
from flowtex.plotting.offscreen.encoders import DEFAULT_QUALITY, MovieWriter
from flowtex.plotting.offscreen.movie import frames
from flowtex.rendering.diagnostics import require_opengl

EXAMPLES = ("double_gyre", "vortex", "cylinder", "airfoil", "delta_wing")


def processor_ms() -> float:
    """Processor time of this process so far."""
    spent = os.times()
    return 1000 * (spent.user + spent.system)


def picture_ms(
    field: flowtex.FlowField, count: int, size: tuple[int, int] = (640, 400), **options: Any
) -> tuple[float, list[Any]]:
    """Mean time of the pictures after the first one, and all pictures."""
    drawn = frames(field, size=size, seconds=count / 10, fps=10.0, **options)
    pictures = [next(drawn)]
    start = processor_ms()
    pictures += drawn
    return (processor_ms() - start) / (len(pictures) - 1), pictures


def main() -> None:
    """Measure the examples and print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=10)
    count = parser.parse_args().frames
    table = Table("640 x 400", "by speed, ms", "grey, ms", "encoding, ms")
    for name in EXAMPLES:
        field = getattr(flowtex.examples, f"{name}_field")()
        picture_ms(field, count, (64, 40))  # which traces the flow
        grey, _ = picture_ms(field, count, scalars=False)
        coloured, pictures = picture_ms(field, count)
        with tempfile.TemporaryDirectory() as folder:
            start = processor_ms()
            writer = MovieWriter(Path(folder) / "movie.mp4", (640, 400), 30.0, DEFAULT_QUALITY)
            for picture in pictures:
                writer.add(picture)
            writer.finish()
            encoding = (processor_ms() - start) / len(pictures)
        table.add_row(name, f"{coloured:.0f}", f"{grey:.0f}", f"{encoding:.0f}")
    Console().print(require_opengl().renderer, table)


if __name__ == "__main__":
    main()
