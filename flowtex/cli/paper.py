"""``flowtex paper``: the tables and figures of the paper, computed and written as a page."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from flowtex.cli.console import say
from flowtex.cli.options import UsageError

__all__ = ["paper"]


def paper(
    *,
    output: Annotated[
        Path,
        Parameter(
            name=["--output", "-o"],
            help="Folder for index.html, numbers.json and the pictures; made if need be.",
        ),
    ],
    quick: Annotated[
        bool, Parameter(negative="", help="The reduced form, in less than a minute.")
    ] = False,
    seed: Annotated[int, Parameter(help="Number that every random choice follows from.")] = 0,
    data: Annotated[
        Path | None,
        Parameter(
            help="Folder of postxyz.bin and postq.bin, the paper's post; by default the one that "
            "FLOWTEX_DATA names, or else they are downloaded."
        ),
    ] = None,
    only: Annotated[
        tuple[str, ...],
        Parameter(negative="", help="Sections to compute, such as figure3; all by default."),
    ] = (),
) -> int:
    """Compute every table and figure of the paper, and check its statements."""
    if seed < 0:
        msg = f"--seed is {seed}; expected 0 or more"
        raise UsageError(msg)
    if output.exists() and not output.is_dir():
        msg = f"{output} is a file; expected a folder to write to"
        raise UsageError(msg)
    from paper import SectionError, reproduce

    started = time.perf_counter()
    try:
        report = reproduce(output, quick=quick, seed=seed, data=data, only=only)
    except SectionError as error:
        msg = f"--only: {error}"
        raise UsageError(msg) from error
    except OSError as error:
        msg = f"{output}: cannot be written ({error.strerror or error})"
        raise UsageError(msg) from error
    for claim in report.claims:
        if not claim.holds:
            say(f"[yellow]does not hold[/]  {claim.text}")
    holding = sum(claim.holds for claim in report.claims)
    say(
        f"[bold]{output / 'index.html'}[/]  {holding} of {len(report.claims)} statements hold  "
        f"[dim]{time.perf_counter() - started:.0f} s[/]"
    )
    return 0
