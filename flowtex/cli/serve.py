"""``flowtex serve``: a page that streams a pyramid."""

from __future__ import annotations

import asyncio
import re
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from flowtex._util.progress import waiting
from flowtex.cli.checks import drawing, require_app
from flowtex.cli.console import announcer, describe
from flowtex.cli.options import (
    FLAT,
    PAGE,
    PICTURE,
    AddressFlags,
    LookFlags,
    SettingFlags,
    UsageError,
)

if TYPE_CHECKING:
    from flowtex.field import FlowField


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
            help="Secret word in the address, without which nothing is shown; random by default.",
        ),
    ] = None,
    title: Annotated[
        str | None, Parameter(group=PICTURE, help="Title of the page; the flow's name by default.")
    ] = None,
    look: Annotated[LookFlags | None, FLAT] = None,
    settings: Annotated[SettingFlags | None, FLAT] = None,
) -> int:
    """Serve a page that streams a pyramid."""
    options, server = drawing(look, settings), address or AddressFlags()
    require_app()
    if token is not None and not re.fullmatch(r"[A-Za-z0-9_-]{16,}", token):
        msg = (
            f"--token is {token!r}; expected 16 or more letters, digits, '-' and '_' that nobody "
            "can guess; omit --token to get a random one"
        )
        raise UsageError(msg)
    from flowtex.pyramid import is_store, open_store

    if not is_store(store):
        msg = (
            f"{store} is missing or not a pyramid; build one with `flowtex pyramid FILE -o {store}`"
        )
        raise UsageError(msg)
    from flowtex.app.server.security import known_hosts, new_secret
    from flowtex.app.server.served_store import ServedStore
    from flowtex.app.server.store_site import run_store
    from flowtex.rendering.diagnostics import has_display

    with waiting(f"Reading {store.name}") as end_waiting:
        field = open_store(store)
        served = ServedStore(store)
        page = _page(field, title, options, f"store/{served.run}/")
        serving = run_store(
            served,
            page,
            (server.host, server.port),
            token=token or new_secret(),
            hosts=known_hosts(server.host, server.allow_host),
            announce=announcer(describe(field), server.host, end_waiting),
            open_browser=server.open_browser and has_display(),
        )
        with suppress(KeyboardInterrupt, asyncio.CancelledError):
            asyncio.run(serving)
    return 0


def _page(field: FlowField, title: str | None, options: dict[str, object], store: str) -> str:
    """Return the page, which finds the store at an address."""
    from flowtex.scene.options import Options
    from flowtex.web.export import page_text
    from flowtex.web.view import web_views

    arguments = Options.split(**options)
    views = web_views(field, arguments)
    try:
        camera = arguments.view.first_camera(views[0].field.surface).to_dict()
        return page_text(views, store=store, camera=camera, title=title, axes=arguments.view.axes)
    finally:
        for view in views:
            view.close()
