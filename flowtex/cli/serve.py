"""``flowtex pyramid`` and ``flowtex serve``: a file as a pyramid in a store, and its page."""

from __future__ import annotations

import asyncio
import os
import re
import stat
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any, Literal

from cyclopts import Parameter

from flowtex._util.progress import waiting
from flowtex._util.terminal import usual_interrupts
from flowtex.cli.console import (
    announcer,
    complain,
    describe,
    drawing,
    report,
    require_app,
    say,
    writing,
)
from flowtex.cli.options import (
    FILE,
    FLAT,
    PAGE,
    PICTURE,
    AddressFlags,
    FieldFlags,
    LookFlags,
    SettingFlags,
    UsageError,
    arguments,
)

#: Environment variable with the secret word of ``flowtex serve``.
TOKEN_VARIABLE = "FLOWTEX_TOKEN"
#: Most characters of a file with the secret word.
MOST_TOKEN = 1000


def serve(
    store: Annotated[
        Path, Parameter(help="A folder, or a URL: s3:// and other object storage, or https://.")
    ],
    /,
    *,
    address: Annotated[AddressFlags | None, FLAT] = None,
    token: Annotated[
        str | None,
        Parameter(
            group=PAGE,
            help=(
                "Secret word in the address, without which nothing is shown. The default is the "
                "environment variable FLOWTEX_TOKEN, or a random word. Other users of this "
                "machine can read the option in the list of processes."
            ),
        ),
    ] = None,
    token_file: Annotated[
        Path | None,
        Parameter(group=PAGE, help="File with the secret word, which other users cannot read."),
    ] = None,
    title: Annotated[
        str | None, Parameter(group=PICTURE, help="Title of the page; the flow's name by default.")
    ] = None,
    look: Annotated[LookFlags | None, FLAT] = None,
    settings: Annotated[SettingFlags | None, FLAT] = None,
) -> int:
    """Serve a page that streams a pyramid.

    Raises
    ------
    UsageError
        When the store does not exist or is no pyramid.
    ServeError
        When the port cannot be used.
    """
    options = drawing(look, settings)
    server = address or AddressFlags()
    require_app()
    given = _secret_word(token, token_file)
    from flowtex.pyramid import is_store, open_store

    if not is_store(store):
        raise UsageError(
            f"{store} is missing or not a pyramid; build one with `flowtex pyramid FILE -o {store}`"
        )
    from flowtex.app.server.security import LimitedServer, known_hosts, new_secret
    from flowtex.app.server.site import serve_until_ended
    from flowtex.app.server.store_site import ServedStore, store_application
    from flowtex.host.export import opened_views, page_text
    from flowtex.rendering.diagnostics import has_display

    with waiting(f"Reading {store.name}") as end_waiting:
        served = ServedStore(store)
        field = open_store(store)
        word = given or new_secret()
        link = f"store/{served.run}/"
        with opened_views(field, **options) as (views, shown):
            page = page_text(views, store=link, title=title, **shown)
        hosts = known_hosts(server.host, server.allow_host)
        limited = LimitedServer(
            store_application(served, page, word, hosts), handler_cancellation=True
        )
        serving = serve_until_ended(
            lambda: limited.start((server.host, server.port)),
            limited.stop,
            (server.host, server.port, f"{word}/"),
            announce=announcer(describe(field), server.host, end_waiting),
            open_browser=server.open_browser and has_display(),
        )
        with suppress(KeyboardInterrupt, asyncio.CancelledError), usual_interrupts():
            asyncio.run(serving)
    return 0


def _secret_word(token: str | None, file: Path | None) -> str | None:
    """Return the checked secret word of the option, the file or the environment, or ``None``."""
    word = os.environ.get(TOKEN_VARIABLE)
    readable = ""
    source = f"{TOKEN_VARIABLE} contains another text"
    if token is not None:
        word = token
        source = f"--token is {token!r}"
        readable = "--token in the list of processes; use --token-file or FLOWTEX_TOKEN"
    elif file is not None:
        try:
            with file.open(encoding="utf-8", errors="replace") as opened:
                word = opened.read(MOST_TOKEN).strip()
                source = f"{file} contains another text"
                mode = os.fstat(opened.fileno()).st_mode
                if mode & (stat.S_IRWXG | stat.S_IRWXO) and os.name == "posix":
                    readable = f"{file}; protect it with `chmod 600 {file}`"
        except OSError as error:
            reason = error.strerror or error
            raise UsageError(f"--token-file is {file}, which cannot be read ({reason})") from error
    if word is None:
        return None
    if not re.fullmatch(r"[A-Za-z0-9_-]{16,}", word):
        raise UsageError(
            f"{source}; expected 16 or more letters, digits, '-' and '_' that nobody can guess; "
            "omit it to get a random one"
        )
    if readable:
        warning = f"other users of this machine can read or change {readable}"
        complain(UserWarning(warning), "yellow")
    return word


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
    """Build the pyramid of a file in a store; intact parts of an earlier build are kept.

    Raises
    ------
    UsageError
        When a file or ``--output`` is missing, or the store cannot be written.
    """
    from flowtex.pyramid import build
    from flowtex.pyramid.source import source_of

    if not files:
        raise UsageError("no file is given; name one")
    if verify:
        return _verify(files)
    if not output:
        raise UsageError(
            "--output is missing; expected the folder or the URL of a store, such as -o flow.zarr"
        )
    start = time.perf_counter()
    with waiting(f"Reading {files[0].name}"):
        if len(files) == 1:
            place: Any = files[0]
        else:
            place = files
        source = source_of(place, **arguments(flow))
    with writing(output):
        built = build(source, output, lines=lines, scheduler=scheduler, memory=memory, fresh=fresh)
    if built.kept:
        kept = f", {built.kept:,} kept"
    else:
        kept = ""
    rows, columns = source.shape
    seconds = time.perf_counter() - start
    text = f"{columns} × {rows} nodes, {built.depth + 1} levels"
    report(output, text, f"{built.made:,} shards built{kept}, {seconds:.1f} s")
    return 0


def _verify(files: Sequence[Path]) -> int:
    """Write the faults of a store; return the exit code."""
    from flowtex.pyramid import is_store, verify
    from flowtex.pyramid.places import DamageError

    if len(files) != 1 or not is_store(files[0]):
        raise UsageError(
            f"{' '.join(map(str, files))} is missing or not a pyramid; --verify expects one store"
        )
    try:
        faults = verify(files[0])
    except DamageError as error:  # in the description of the store
        faults = [str(error)]
    for fault in faults:
        complain(DamageError(fault))
    if faults:
        return 1
    say((str(files[0]), "bold"), "  is whole")
    return 0
