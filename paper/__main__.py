"""``python -m paper``: compute the tables and figures of the paper, and check its statements."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from paper import Report, SectionError, reproduce


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the experiments, print which statements do not hold, and return the exit code.

    Returns
    -------
    int
        0 when the page was written, whatever holds; 2 when an argument is wrong.
    """
    parser = _parser()
    options = parser.parse_args(arguments)
    if options.seed < 0:
        parser.error(f"--seed is {options.seed}; expected 0 or more")
    if options.output.exists() and not options.output.is_dir():
        parser.error(f"{options.output} is a file; expected a folder to write to")
    start = time.perf_counter()
    try:
        report = reproduce(
            options.output,
            quick=options.quick,
            seed=options.seed,
            data=options.data,
            only=tuple(options.only),
        )
    except SectionError as error:
        parser.error(f"--only: {error}")
    except OSError as error:
        parser.error(f"{options.output}: cannot be written ({error.strerror or error})")
    _print_summary(report, options.output / "index.html", time.perf_counter() - start)
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m paper",
        description="Compute every table and figure of the paper, and check its statements.",
    )
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        required=True,
        help="folder for index.html, numbers.json and the pictures; made if need be",
    )
    parser.add_argument(
        "--quick", action="store_true", help="the reduced form, in less than a minute"
    )
    parser.add_argument(
        "--seed", type=int, default=0, help="number that every random choice follows from"
    )
    parser.add_argument(
        "--data",
        type=Path,
        help="folder of postxyz.bin and postq.bin, the paper's post; by default the one that "
        "FLOWTEX_DATA names, or else they are downloaded",
    )
    parser.add_argument(
        "--only",
        action="append",
        default=[],
        metavar="SECTION",
        help="section to compute, such as figure3; several by repeating it; all by default",
    )
    return parser


def _print_summary(report: Report, page: Path, seconds: float) -> None:
    console = Console(highlight=False)
    for claim in report.claims:
        if not claim.holds:
            console.print(f"[yellow]does not hold[/]  {claim.text}", soft_wrap=True)
    count = sum(claim.holds for claim in report.claims)
    console.print(
        f"[bold]{page}[/]  {count} of {len(report.claims)} statements hold  "
        f"[dim]{seconds:.0f} s[/]",
        soft_wrap=True,
    )


if __name__ == "__main__":
    sys.exit(main())
