"""Make the shipped files of the examples again: ``python tools/example_data/build.py``.

The vortices take about half a minute, the cylinder five, the others a second. A folder may be
named; by default the files replace those of the package.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from pathlib import Path

import cylinder_run
import delta_wing_run
import ocean_run
import vortex_run
import weather_run
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from flowtex.examples._shipped import DATA


def main(arguments: Sequence[str] | None = None) -> None:
    """Compute the shipped files.

    Parameters
    ----------
    arguments : sequence of str, optional
        Names of the examples, all by default, and ``--folder FOLDER``. By default those of the
        command line.
    """
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("examples", nargs="*", help=f"of {', '.join(BUILDERS)}; all by default")
    parser.add_argument("--folder", type=Path, help="where to write")
    options = parser.parse_args(arguments)
    for name in options.examples:
        if name not in BUILDERS:
            parser.error(f"there is no example {name!r} to build; expected {', '.join(BUILDERS)}")
    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, TimeRemainingColumn(), console=Console(stderr=True)) as progress:
        for name in options.examples or BUILDERS:
            BUILDERS[name](progress, options.folder)
    for path in sorted((options.folder or DATA).glob("*.*")):
        Console().print(f"{path.name}: {path.stat().st_size / 1e6:.2f} MB")


def _build_vortex(progress: Progress, folder: Path | None) -> None:
    total = vortex_run.STEPS_BEFORE + vortex_run.STEPS_BETWEEN * (vortex_run.INSTANTS - 1)
    task = progress.add_task("vortex", total=total)
    vortex_run.write(*vortex_run.run(lambda count: progress.advance(task, count)), folder)


def _build_cylinder(progress: Progress, folder: Path | None) -> None:
    # About twice the period of 6.1 follows the stages whose length is set beforehand.
    task = progress.add_task("cylinder", total=sum(cylinder_run.DURATIONS) + 12.2)
    shedding = cylinder_run.run(lambda time: progress.advance(task, time))
    cylinder_run.write(shedding, folder)
    progress.update(task, completed=progress.tasks[task].total)
    progress.console.print(
        f"cylinder: Strouhal number {shedding.strouhal:.4f}, "
        f"mean drag {shedding.forces[1:, 0].mean():.4f}"
    )


def _builder(name: str, write: Callable[[Path | None], None]) -> Callable[..., None]:
    """Return the builder of an example that takes a moment."""

    def build(progress: Progress, folder: Path | None) -> None:
        for _ in progress.track([folder], description=name):
            write(folder)

    return build


BUILDERS: dict[str, Callable[[Progress, Path | None], None]] = {
    "vortex": _build_vortex,
    "cylinder": _build_cylinder,
    "delta_wing": _builder("delta_wing", delta_wing_run.write),
    "ocean": _builder("ocean", ocean_run.write),
    "weather": _builder("weather", weather_run.write),
}

if __name__ == "__main__":
    main()
