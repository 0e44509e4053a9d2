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
            help="Store to write: a new or empty folder, or a URL such as s3://b/a.zarr.",
        ),
    ] = "",
    verify: Annotated[
        bool,
        Parameter(
            negative=(),
            help=(
                "Read the whole store FILE and list missing or corrupt objects; exit with 1 if "
                "there are any."
            ),
        ),
    ] = False,
    fresh: Annotated[
        bool,
        Parameter(
            negative=(), help="Remove the existing pyramid from the store, and build a new one."
        ),
    ] = False,
    lines: Annotated[
        Literal["auto", "pathlines", "streamlines"],
        Parameter(help="Lines along which a time-varying flow is drawn."),
    ] = "auto",
    scheduler: Annotated[
        str | None,
        Parameter(
            help="Dask scheduler, such as tcp://host:8786; threads of this process by default."
        ),
    ] = None,
    memory: Annotated[
        str | None,
        Parameter(help="Memory limit of the threads, such as 4GB; one thread per core by default."),
    ] = None,
    flow: Annotated[FieldFlags | None, FLAT] = None,
) -> int:
    """Build the pyramid of a file in a store; intact parts of an earlier build are kept."""
    from flowtex.pyramid import build
    from flowtex.pyramid.source import source_of

    if not files:
        msg = "no file is given; name one"
        raise UsageError(msg)
    if verify:
        return _verify(files)
    if not output:
        msg = "--output is missing; expected the folder or the URL of a store, such as -o flow.zarr"
        raise UsageError(msg)
    start = time.perf_counter()
    with waiting(f"Reading {files[0].name}"), notices():
        place: Any = files[0] if len(files) == 1 else files
        source = source_of(place, **arguments(flow))
    with writing(output):
        built = build(source, output, lines=lines, scheduler=scheduler, memory=memory, fresh=fresh)
    kept = f", {built.kept:,} kept" if built.kept else ""
    rows, columns = source.shape
    say(
        (str(output), "bold"),
        f"  {columns} × {rows} nodes, {built.depth + 1} levels  ",
        (f"{built.made:,} shards built{kept}, {time.perf_counter() - start:.1f} s", "dim"),
    )
    return 0


def _verify(files: Sequence[Path]) -> int:
    """List the missing and corrupt parts of a store; the exit code is 1 if there are any."""
    from flowtex.pyramid import is_store, verify
    from flowtex.pyramid.places import DamageError

    if len(files) != 1 or not is_store(files[0]):
        msg = f"{' '.join(map(str, files))} is missing or not a pyramid; --verify expects one store"
        raise UsageError(msg)
    try:
        faults = verify(files[0])
    except DamageError as error:  # in the description of the store
        faults = [str(error)]
    for fault in faults:
        complain(DamageError(fault))
    if not faults:
        say((str(files[0]), "bold"), "  is whole")
    return 1 if faults else 0
