"""Server of a pyramid: a page, ``/<token>/``, and the objects of its store that it streams.

These are at ``/<token>/store/<run>/<name>``. All addresses in the page are relative, so that it
works behind any proxy. Names are those of a pyramid's arrays and numbers of their chunks, and
nothing else is served. Objects of another run, which a browser may still have, have other
addresses.
"""

from __future__ import annotations

import asyncio
import os
import re
import secrets
from collections.abc import Container
from pathlib import Path

import numpy as np
from aiohttp import web

from flowtex.app.server.security import LOCAL, guard, is_same
from flowtex.errors import import_extra
from flowtex.pyramid.layout import described
from flowtex.pyramid.levels import Levels
from flowtex.pyramid.places import (
    DOCUMENT,
    ReadFault,
    fault_words,
    is_refused,
    is_remote,
    objects_at,
    place_text,
)

#: Seconds for which a browser may keep an object.
KEPT_S = 3600
WRONG = "This page opens only with the complete address that flowtex printed."
#: Objects of the store that are read at once.
MOST_READS = 32
#: Numbers of objects as Zarr writes them.
_NUMBER = re.compile(r"0|[1-9][0-9]{0,8}")


class ServedStore:
    """The objects of a pyramid by their names."""

    def __init__(self, place: str | Path) -> None:
        if is_remote(place):
            self._folder = None
        else:
            self._folder = Path(place_text(place))
        levels = Levels(place)
        self.run = secrets.token_hex(4)  #: A word that is unique to this run.
        self._origin = objects_at(levels.place)
        self._reads = asyncio.Semaphore(MOST_READS)
        zarr = import_extra("zarr", "store")
        group = described(levels.about)
        #: How many objects each array has along its axes.
        self._counts: dict[str, tuple[int, ...]] = {}
        documents = {DOCUMENT}
        for name, node in group.members(max_depth=None):
            documents.add(f"{name}/{DOCUMENT}")
            if isinstance(node, zarr.Array):
                counts = np.ceil(np.divide(node.shape, node.shards or node.chunks))
                self._counts[name] = tuple(map(int, counts))
        self._metadata = frozenset(documents)

    def _is_outside(self, path: Path) -> bool:
        return not Path(os.path.realpath(path)).is_relative_to(self._folder or "")

    def _is_chunk(self, array: str, words: list[str]) -> bool:
        """Return whether words are the numbers of an object of an array, along its axes."""
        counts = self._counts.get(array, ())
        if len(words) != len(counts):
            return False
        for word, count in zip(words, counts, strict=True):
            if not _NUMBER.fullmatch(word) or int(word) >= count:
                return False
        return True

    async def get(self, name: str) -> bytes:
        """Return an object of the store.

        Raises
        ------
        LookupError
            When the store has no object of this name.
        ReadFault
            When reading fails, as without a connection; the text has no secrets.
        """
        array, _, rest = name.partition("/c/")
        words = rest.split("/")
        if not (self._is_chunk(array, words) or name in self._metadata):
            raise LookupError(name)
        if self._folder and self._is_outside(self._folder / name):
            raise LookupError(name)
        obstore = import_extra("obstore", "store")
        async with self._reads:
            try:
                result = await obstore.get_async(self._origin, name)
                return bytes(await result.bytes_async())
            except Exception as error:
                if isinstance(error, FileNotFoundError) or is_refused(error):
                    raise LookupError(name) from None
                raise ReadFault(f"{name} {fault_words(error)}") from None


def store_application(
    served: ServedStore, page: str, token: str, hosts: Container[str] = LOCAL
) -> web.Application:
    """Return a web application of a page and its store, below a token.

    Parameters
    ----------
    served
        The store.
    page
        HTML of the page.
    token
        First part of each path, without which nothing is sent.
    hosts
        Names of hosts under which browsers may ask for the page.

    Raises
    ------
    HTTPForbidden
        By a handler, when the path has another token.
    HTTPNotFound
        By a handler, when the store lacks the requested object.
    HTTPFound
        By a handler, which sends the browser to the address with a slash at its end.
    """
    application = web.Application(client_max_size=0)
    guard(application, hosts=hosts)

    def check(request: web.Request) -> None:
        if not is_same(request.match_info.get("token", ""), token):
            raise web.HTTPForbidden(text=WRONG)

    async def page_handler(request: web.Request) -> web.Response:
        check(request)
        headers = {"Cache-Control": "no-store"}
        return web.Response(text=page, content_type="text/html", headers=headers)

    async def store_handler(request: web.Request) -> web.Response:
        check(request)
        name = request.match_info["name"]
        try:
            body = await served.get(name)
        except LookupError:
            raise web.HTTPNotFound(text="This object does not exist.") from None
        headers = {
            "Content-Type": "application/octet-stream",
            "Cache-Control": f"private, max-age={KEPT_S}",
        }
        if name.endswith(DOCUMENT):
            headers = {"Content-Type": "application/json", "Cache-Control": "no-store"}
        return web.Response(body=body, headers=headers)

    async def to_page(request: web.Request) -> web.Response:
        check(request)
        address = f"{token}/"  # relative: a proxy may have added a prefix
        raise web.HTTPFound(address)

    router = application.router
    router.add_get(f"/{{token}}/store/{served.run}/{{name:.+}}", store_handler)
    router.add_get("/{token}/", page_handler)
    router.add_get("/", page_handler)  # refused without the token
    router.add_get("/{token}", to_page)
    return application
