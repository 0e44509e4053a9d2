"""Make the shipped files of the examples again: ``python -m flowtex.examples.build``.

The vortices take about half a minute, the cylinder five. A folder may be named; by default the
files replace those of the package.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from flowtex.examples import _cylinder, _cylinder_run, _store, _vortex

__all__ = ["main"]


def main(arguments: Sequence[str] | None = None) -> None:
    """Compute the shipped files.

    Parameters
    ----------
    arguments : sequence of str, optional
        Names of the examples, all by default, and ``--folder FOLDER``. By default those of the
        command line.
    """
    parser = argparse.ArgumentParser(prog="python -m flowtex.examples.build", description=__doc__)
    parser.add_argument("examples", nargs="*", help=f"of {', '.join(BUILDERS)}; all by default")
    parser.add_argument("--folder", type=Path, default=_store.DATA, help="where to write")
    options = parser.parse_args(arguments)
    for name in options.examples:
        if name not in BUILDERS:
            parser.error(f"there is no example {name!r} to build; expected {', '.join(BUILDERS)}")
    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, TimeRemainingColumn(), console=Console(stderr=True)) as progress:
        for name in options.examples or BUILDERS:
            BUILDERS[name](progress, options.folder)
    for path in sorted(options.folder.glob("*.npz")):
        Console().print(f"{path.name}: {path.stat().st_size / 1e6:.2f} MB")


def _vortex_files(progress: Progress, folder: Path) -> None:
    total = _vortex.BEFORE + _vortex.BETWEEN * (_vortex.KEPT - 1)
    task = progress.add_task("vortex", total=total)
    _vortex.write(*_vortex.run(lambda count: progress.advance(task, count)), folder)


def _cylinder_files(progress: Progress, folder: Path) -> None:
    # About twice the period of 6.1 follows the stages whose length is set beforehand.
    task = progress.add_task("cylinder", total=sum(_cylinder_run.DURATIONS) + 12.2)
    shedding = _cylinder_run.run(lambda time: progress.advance(task, time))
    _cylinder.write(shedding, folder)
    progress.update(task, completed=progress.tasks[task].total)
    progress.console.print(
        f"cylinder: Strouhal number {shedding.strouhal:.4f}, "
        f"mean drag {shedding.forces[1:, 0].mean():.4f}"
    )


BUILDERS: dict[str, Callable[[Progress, Path], None]] = {
    "vortex": _vortex_files,
    "cylinder": _cylinder_files,
}

if __name__ == "__main__":
    main()
