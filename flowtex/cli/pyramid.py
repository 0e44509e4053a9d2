"""``flowtex pyramid``: a file as a pyramid in a store, from which any part of it is drawn."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

from cyclopts import Parameter

from flowtex._util.progress import waiting
from flowtex.cli.checks import writing
from flowtex.cli.console import complain, notices, say
from flowtex.cli.options import FILE, FLAT, FieldFlags, UsageError, arguments


def pyramid(
    *files: FILE,
    output: Annotated[
        str,
        Parameter(
            name=["--output", "-o"],
            help="Store to write: a new or an empty folder, or a URL such as s3://b/a.zarr.",
        ),
    ] = "",
    verify: Annotated[
        bool,
        Parameter(
            negative=(),
            help="Read all of FILE, a store, and say what is missing or corrupt; then exit with 1.",
        ),
    ] = False,
    fresh: Annotated[
        bool,
        Parameter(negative=(), help="Remove the pyramid that is in the store, and build it anew."),
    ] = False,
    lines: Annotated[
        Literal["auto", "pathlines", "streamlines"],
        Parameter(help="What the texture is drawn along, in a flow that varies."),
    ] = "auto",
    scheduler: Annotated[
        str | None, Parameter(help="Dask scheduler, as tcp://host:8786; else threads work here.")
    ] = None,
    memory: Annotated[
        str | None,
        Parameter(help="What threads may take of the memory, as 4GB; else one for each core."),
    ] = None,
    flow: Annotated[FieldFlags | None, FLAT] = None,
) -> int:
    """Build the pyramid of a file in a store; what is there and whole is not made again."""
    from flowtex.pyramid import build
    from flowtex.pyramid.source import source_of

    if not files:
        msg = "there is no file; name one"
        raise UsageError(msg)
    if verify:
        return _verify(files)
    if not output:
        msg = "--output is missing; expected the folder or the URL of a store, as -o flow.zarr"
        raise UsageError(msg)
    start = time.perf_counter()
    with waiting(f"Reading {files[0].name}"), notices():
        whole: Any = files[0] if len(files) == 1 else files
        source = source_of(whole, **arguments(flow))
    with writing(output):
        built = build(source, output, lines=lines, scheduler=scheduler, memory=memory, fresh=fresh)
    kept = f", {built.kept:,} were there" if built.kept else ""
    rows, columns = source.shape
    say(
        (str(output), "bold"),
        f"  {columns} × {rows} nodes, {built.depth + 1} levels  ",
        (f"{built.made:,} shards made{kept}, {time.perf_counter() - start:.1f} s", "dim"),
    )
    return 0


def _verify(files: Sequence[Path]) -> int:
    """Say what of a store is missing or corrupt; the exit code tells whether something is."""
    from flowtex.pyramid import is_store, verify
    from flowtex.pyramid.places import DamageError

    if len(files) != 1 or not is_store(files[0]):
        msg = f"{' '.join(map(str, files))} is no pyramid; --verify expects one store"
        raise UsageError(msg)
    try:
        faults = verify(files[0])
    except DamageError as error:  # of what the store tells of itself
        faults = [str(error)]
    for fault in faults:
        complain(DamageError(fault))
    if not faults:
        say((str(files[0]), "bold"), "  is whole")
    return 1 if faults else 0
