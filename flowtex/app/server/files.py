"""Files that one session serves over HTTP: downloads, and parts for the browser's client.

A file's address is ``flowtex/<token>/<name>``, below the page. The token cannot be guessed and
belongs to one session, so the address alone gives access. Content is looked up at each request.
Downloads are in a temporary folder that only its owner can read; the oldest one is removed for
another, and all when the page closes.
"""

from __future__ import annotations

import asyncio
import inspect
import mimetypes
import re
import shutil
from collections.abc import AsyncIterable, Awaitable, Callable
from functools import partial
from pathlib import Path
from typing import Any
from urllib.parse import quote

from aiohttp import web

from flowtex._util.whole_file import TemporaryFolder
from flowtex.app.server.security import new_secret
from flowtex.errors import FieldError
from flowtex.sources.remote import prepare_readers

#: Most downloads of a page; the oldest one is removed for another.
MOST_DOWNLOADS = 4
#: Bytes of an upload that are written at once.
CHUNK_BYTES = 1 << 18
#: Most bytes of a file's name: file systems allow 255, and an incomplete file has a longer name.
NAME_BYTES = 180
#: Most bytes of the ending of a name.
ENDING_BYTES = 20
#: Names of devices on Windows, whatever their endings are.
DEVICE = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)\s*(\.|$)", re.IGNORECASE)
#: Content of a file: its bytes or its path; its media type; and the name under which it is saved,
#: or ``None`` for files that the page uses itself.
Content = tuple[bytes | Path, str, str | None]
#: Returns the content of a file by the rest of its name; a LookupError or a ValueError without one.
Give = Callable[[str], Content | Awaitable[Content]]
#: Receives a file: its name, which may be any text, and its bytes.
Take = Callable[[str, AsyncIterable[bytes]], Awaitable[None]]
#: Answers a request for a file, or an upload, by its name.
Respond = Callable[[str, web.Request], Awaitable[web.StreamResponse]]
EXPIRED = "This download has expired. Save the picture or the movie again on the page."
#: Key of a session's routes in trame's context, which only the server sees.
KEY = "flowtex_routes"
#: Endings of files that are accepted.
UPLOAD_SUFFIXES = (
    *(".vts", ".vtr", ".vti", ".vtk", ".vtu", ".vtp"),
    *(".nc", ".grib", ".grb", ".json"),
)
#: Most bytes of an upload.
UPLOAD_BYTES = 200_000_000
#: Most uploads of a page.
MOST_UPLOADS = 8


class Routes:
    """Files that one session serves, below a ``token`` that cannot be guessed."""

    def __init__(self) -> None:
        self.token = new_secret()
        self._content: dict[str, Give] = {}
        self._takers: dict[str, Take] = {}

    @classmethod
    def of(cls, server: Any) -> Routes:
        """Return the routes of a trame server, served by :func:`flowtex.app.serve` or by trame."""
        if not server.context.has(KEY):
            server.context[KEY] = cls()
            server.controller.on_server_bind.add(server.context[KEY].bind)
        routes: Routes = server.context[KEY]
        return routes

    def bind(self, web_server: Any) -> None:
        """Add the route where trame has a web server of its own."""
        application = getattr(web_server, "app", None)
        if application is not None:
            add_route(application, {self.token: self.respond}.get)

    async def respond(self, name: str, request: web.Request) -> web.StreamResponse:
        """Answer a request for a file, or an upload."""
        if request.method == "POST":
            return await self.receive(name, request)
        return await self.answer(name)

    def give(self, stem: str, content: Give) -> str:
        """Serve files, whose names begin with a stem and a full stop; return its address.

        ``content`` is called at each request.
        """
        self._content[stem] = content
        return self._address(stem)

    def take(self, name: str, taker: Take) -> str:
        """Receive files at the address returned, with ``?name=``; a taker's FieldError is shown."""
        self._takers[name] = taker
        return self._address(name)

    def _address(self, name: str) -> str:
        return f"flowtex/{self.token}/{quote(name)}"

    def withdraw(self, stem: str) -> None:
        """Stop serving the files of a stem."""
        self._content.pop(stem, None)

    def close(self) -> None:
        """Stop serving and receiving files."""
        self._content.clear()
        self._takers.clear()

    async def receive(self, name: str, request: web.Request) -> web.StreamResponse:
        """Receive an uploaded file, and return the response to the browser.

        Raises
        ------
        HTTPNotFound
            When uploads are not accepted under the name.
        """
        if (taker := self._takers.get(name)) is None:
            raise web.HTTPNotFound
        try:
            await taker(request.query.get("name", ""), request.content.iter_chunked(CHUNK_BYTES))
        except FieldError as error:
            # The rest of the body is not read.
            return web.Response(status=400, text=str(error), headers={"Connection": "close"})
        return web.Response(text="")

    async def answer(self, name: str) -> web.StreamResponse:
        """Return the response with a file, or with content that is made for the request.

        Raises
        ------
        HTTPNotFound
            When nothing exists under the name.
        """
        stem, _, rest = name.partition(".")
        try:
            content = self._content[stem](rest)
            if inspect.isawaitable(content):
                body, kind, saved_as = await content
            else:
                body, kind, saved_as = content
        except (LookupError, ValueError, FileNotFoundError):
            raise web.HTTPNotFound from None
        headers = {
            "Content-Type": kind,
            "Cache-Control": "no-store",
            "X-Content-Type-Options": "nosniff",
        }
        if saved_as is not None:
            # Names in other alphabets travel in the second form, RFC 6266.
            plain = saved_as.encode("ascii", "replace").decode().translate({34: "_", 92: "_"})
            headers["Content-Disposition"] = (
                f"attachment; filename=\"{plain}\"; filename*=UTF-8''{quote(saved_as, safe='')}"
            )
        if isinstance(body, Path):
            return web.FileResponse(body, headers=headers)
        return web.Response(body=body, headers=headers)


def add_route(application: web.Application, find: Callable[[str], Respond | None]) -> None:
    """Serve files below ``/flowtex``; ``find`` returns what answers below a token.

    Raises
    ------
    HTTPNotFound
        By the handler of a request, when ``find`` returns ``None`` for its token.
    HTTPUnsupportedMediaType
        By the handler, when an upload is compressed.
    """

    async def respond(request: web.Request) -> web.StreamResponse:
        answer = find(request.match_info["token"])
        if answer is None:
            raise web.HTTPNotFound
        if encoding := request.headers.get("Content-Encoding"):
            raise web.HTTPUnsupportedMediaType(
                text=f"The upload has the encoding {encoding[:40]!r}; send the file as it is.\n"
            )
        return await answer(request.match_info["name"], request)

    application.router.add_get("/flowtex/{token}/{name}", respond)
    application.router.add_post("/flowtex/{token}/{name}", respond)


class Downloads:
    """The files that one application offers to save, the latest ones."""

    def __init__(self, routes: Routes) -> None:
        self._folder = TemporaryFolder()
        self.folder = self._folder.path
        self._routes = routes
        self._paths: list[Path] = []

    def reserve(self, name: str) -> Path:
        """Return the path of a new file of this name, in its own folder."""
        return self._folder.new_folder() / plain_name(name)

    def add(self, path: Path) -> str:
        """Serve a file from :meth:`reserve`; return its address, relative to the page."""
        self._paths.append(path)
        if len(self._paths) > MOST_DOWNLOADS:
            shutil.rmtree(self._paths.pop(0).parent, ignore_errors=True)
        return self._routes.give(new_secret(), partial(self._content, path))

    def close(self) -> None:
        """Remove all files; nothing can be added any more."""
        self._folder.close()

    def _content(self, path: Path, _rest: str) -> Content:
        if not path.is_file():
            raise web.HTTPGone(text=EXPIRED, headers={"Cache-Control": "no-store"})
        return path, mimetypes.guess_type(path.name)[0] or "application/octet-stream", path.name


def plain_name(name: str) -> str:
    """Return a name that leads to no other folder and is valid on every system."""
    letters = []
    for letter in name:
        if not (letter.isalnum() or letter in " ._-"):
            letter = "_"
        letters.append(letter)
    plain = "".join(letters).strip(" .")
    if DEVICE.match(plain):
        plain = f"_{plain}"
    stem, _, ending = plain.rpartition(".")
    if not stem:
        return _cut(plain, NAME_BYTES) or "flow"
    stem = _cut(stem, NAME_BYTES)
    ending = _cut(ending, ENDING_BYTES)
    if ending:
        return f"{stem}.{ending}"
    return stem or "flow"


def _cut(text: str, most: int) -> str:
    return text.encode()[:most].decode(errors="ignore")


class Uploads:
    """The uploads of one page, in a folder that is removed with it; ``arrived`` is called for each.

    Only formats of a single file are accepted: others could open any file that the server can read.
    The name is used for display and for its ending; the path is chosen here.
    """

    def __init__(self, routes: Routes, arrived: Callable[[str, Path], None]) -> None:
        self._arrived = arrived
        self._folder = TemporaryFolder()
        self.folder = self._folder.path
        self.address = routes.take("upload", self.receive)

    async def receive(self, name: str, content: AsyncIterable[bytes]) -> None:
        """Write an uploaded file to the folder of the page, and report its path.

        Parameters
        ----------
        name
            Name that the browser gives; only its last part is used.
        content
            The file in pieces.

        Raises
        ------
        FieldError
            When the suffix is not one of a readable file, the page has too many uploads, the file
            is too large, or the disk refuses it.
        """
        name = plain_name(name.replace("\\", "/").rsplit("/", 1)[-1])
        if Path(name).suffix.lower() not in UPLOAD_SUFFIXES:
            endings = ", ".join(UPLOAD_SUFFIXES)
            raise FieldError(f"{name}: this format cannot be uploaded; expected one of {endings}")
        if len(list(self.folder.glob("*"))) >= MOST_UPLOADS:
            raise FieldError(
                f"{name}: {MOST_UPLOADS} files have been uploaded already; reload the page to "
                "upload more"
            )
        prepare_readers()
        try:
            path = await self._write(name, content)
        except OSError as error:
            raise FieldError(
                f"{name}: cannot be stored on the server ({error.strerror or error})"
            ) from error
        self._arrived(name, path)

    async def _write(self, name: str, content: AsyncIterable[bytes]) -> Path:
        path = self._folder.new_folder() / name
        size = 0
        try:
            with path.open("wb") as file:
                async for part in content:
                    size += len(part)
                    if size > UPLOAD_BYTES:
                        raise FieldError(
                            f"{name}: the file is too large; expected {UPLOAD_BYTES / 1e6:g} MB "
                            "at most"
                        )
                    await asyncio.to_thread(file.write, part)
        except BaseException:
            shutil.rmtree(path.parent, ignore_errors=True)
            raise
        return path

    def close(self) -> None:
        """Remove all files."""
        self._folder.close()
