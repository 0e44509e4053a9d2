"""``flowtex pyramid``: a file as a pyramid in a store, from which any part of it is drawn."""

from __future__ import annotations

import time
from typing import Annotated, Literal

from cyclopts import Parameter

from flowtex.cli.console import say
from flowtex.cli.load import load_field
from flowtex.cli.options import FILE, FLAT, FieldFlags

__all__ = ["pyramid"]


def pyramid(
    *files: FILE,
    output: Annotated[
        str,
        Parameter(
            name=["--output", "-o"],
            help="Store to write: a folder, or a URL such as s3://b/a.zarr.",
        ),
    ],
    levels: Annotated[
        Literal["coarse", "all"],
        Parameter(help="Which tiles are traced: coarse leaves the finest until they are seen."),
    ] = "coarse",
    lines: Annotated[
        Literal["auto", "pathlines", "streamlines"],
        Parameter(help="What the texture is drawn along, in a flow that varies."),
    ] = "auto",
    scheduler: Annotated[
        str | None, Parameter(help="Dask scheduler, as tcp://host:8786; else threads work here.")
    ] = None,
    flow: Annotated[FieldFlags | None, FLAT] = None,
) -> int:
    """Build the pyramid of a file in a store; what is there already is not made again."""
    from flowtex.pyramid import build

    start = time.perf_counter()
    field = load_field(files, flow)
    built = build(field, output, levels=levels, lines=lines, scheduler=scheduler)
    kept = f", {built.kept:,} were there" if built.kept else ""
    say(
        f"[bold]{output}[/]  {field.short_size}, {built.depth + 1} levels  "
        f"[dim]{built.made:,} shards made{kept}, {time.perf_counter() - start:.1f} s[/]"
    )
    return 0
