"""A session in a separate process: its proxy in the server, and its host in the process.

The process is forked from one that has loaded the libraries, and listens on a socket in a folder
that only its owner can enter. The server in front keeps addresses, secrets and limits, and passes
on messages and files. A crash ends one page; its memory is limited, and the system shares the cores
among processes.
"""

from __future__ import annotations

import asyncio
import math
import os
import socket as sockets
import threading
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from typing import Any, NoReturn

import aiohttp
from aiohttp import WSCloseCode, WSMsgType, web
from yarl import URL

from flowtex._util.child.child import ENDED, Child, ChildError
from flowtex._util.progress import Stopped, check, stoppable
from flowtex._util.whole_file import TemporaryFolder
from flowtex.app.server.files import CHUNK_BYTES
from flowtex.app.server.sessions.registry import OpenSession, Session
from flowtex.errors import FieldError

#: Seconds in which a session opens.
OPENING_S = 600.0
#: Seconds in which it ends.
ENDING_S = 30.0
#: Seconds between two checks whether a session is to end.
CHECK_S = 0.05
#: Headers of a request, and of an answer, that are passed on.
REQUEST_HEADERS = ("Content-Type", "Content-Length", "Range", "If-Range")
ANSWER_HEADERS = (
    *("Content-Type", "Content-Length", "Content-Range", "Content-Disposition"),
    *("Accept-Ranges", "Cache-Control", "ETag", "Last-Modified", "Connection"),
)


def process_opener(
    entry: str, preload: tuple[str, ...], request: dict[str, Any], opened: Callable[[Any], None]
) -> OpenSession:
    """Return a function that opens sessions in separate processes, as for ``Child``.

    Parameters
    ----------
    entry
        Name of the function that makes a :class:`HostedSession` in the process.
    preload
        Modules that the process imports before it is needed.
    request
        What the session is asked to open.
    opened
        Called with the messages of the session when it is open.

    Raises
    ------
    FieldError
        By the returned function, when the flow cannot be shown or the process ends.
    RuntimeError
        By the returned function, after any other error in the process; its text has the traceback.
    """

    async def open_session(*, again: bool = True) -> Session:
        child = Child(entry, preload=preload, prints=True)
        try:
            about, _ = await asyncio.to_thread(child.request, {"open": request}, timeout=OPENING_S)
        except ChildError as error:
            child.close()
            if again and str(error) == ENDED:  # the process to fork from has died
                return await open_session(again=False)
            if error.kind and error.kind != "FieldError":
                raise RuntimeError(f"{error.kind}: {error}\n{error.trace}") from error
            if error.kind:
                raise FieldError(str(error)) from error
            raise FieldError(f"the process of the page {error}") from error
        opened(about["said"])
        return ProcessSession(child, about)

    return open_session


class ProcessSession(Session):
    """A session in another process."""

    def __init__(self, child: Child, about: dict[str, Any]) -> None:
        self._folder = os.open(about["folder"], os.O_RDONLY)
        self._http = aiohttp.ClientSession(
            "http://localhost",
            connector=aiohttp.UnixConnector(_socket_path(self._folder), limit=0),
            timeout=aiohttp.ClientTimeout(),
            skip_auto_headers=("Accept-Encoding",),  # bodies pass unchanged
            auto_decompress=False,
        )
        super().__init__(about["files"], about["token"])
        self.static = about["static"]
        self._child = child
        self._ending = False
        self._ended = asyncio.Event()
        loop = asyncio.get_running_loop()
        threading.Thread(target=self._run, args=(loop,), name="session", daemon=True).start()

    def _run(self, loop: asyncio.AbstractEventLoop) -> None:
        with suppress(Stopped), stoppable(lambda: self._ending):
            try:
                self._child.request({"run": True}, timeout=math.inf)
            except ChildError as error:
                with suppress(RuntimeError):  # the server has ended
                    loop.call_soon_threadsafe(self._fall, str(error))
        with suppress(ChildError):
            self._child.request({"end": True}, timeout=ENDING_S)
        with suppress(RuntimeError):
            loop.call_soon_threadsafe(self._ended.set)

    def _fall(self, how: str) -> None:
        if not self._ending:
            self.lost(f"its process {how}")
            self._closing = asyncio.ensure_future(self.end())

    async def respond(self, name: str, request: web.Request) -> web.StreamResponse:
        """Pass on a request for a file, or an upload."""
        del name
        body = None
        if request.body_exists:
            body = request.content
        async with self._http.request(
            request.method,
            URL(request.raw_path, encoded=True),
            headers=_some_of(request.headers, REQUEST_HEADERS),
            data=body,
        ) as answer:
            headers = _some_of(answer.headers, ANSWER_HEADERS)
            response = web.StreamResponse(status=answer.status, headers=headers)
            await response.prepare(request)
            async for chunk in answer.content.iter_chunked(CHUNK_BYTES):
                await response.write(chunk)
            await response.write_eof()
        return response

    async def carry(self, socket: web.WebSocketResponse) -> None:
        """Carry messages between a page and the process until one of them ends.

        Raises
        ------
        ValueError
            When the page sends text; messages are binary.
        """
        address = f"/page/{self.token}/ws"
        async with self._http.ws_connect(address, max_msg_size=0, autoclose=False) as connection:

            async def answer() -> None:
                with suppress(ConnectionError):
                    async for message in connection:
                        await socket.send_bytes(message.data)
                await socket.close(code=WSCloseCode.GOING_AWAY)

            answering = asyncio.ensure_future(answer())
            try:
                async for message in socket:
                    if message.type == WSMsgType.BINARY:
                        await connection.send_bytes(message.data)
                    elif message.type == WSMsgType.TEXT:
                        raise ValueError("received text; expected bytes")
            except ConnectionError:  # the process has ended the connection, or itself
                await answering
            finally:
                answering.cancel()

    async def end(self) -> None:
        """Close the connection, and end the process."""
        self._ending = True
        await self.disconnect()
        await self._http.close()
        os.close(self._folder)
        with suppress(TimeoutError):
            async with asyncio.timeout(ENDING_S):
                await self._ended.wait()
        self._child.close()


def _socket_path(folder: int) -> str:
    """Return the path of a page's socket in an open folder, whose own path may be too long."""
    return f"/proc/self/fd/{folder}/page"


class HostedSession:
    """A session in its own process; ``open_site`` returns a site for a request, and messages."""

    def __init__(self, open_site: Callable[[dict[str, Any]], tuple[Any, Any]]) -> None:
        self._open_site = open_site
        self._loop = asyncio.new_event_loop()
        asyncio.set_event_loop(self._loop)
        self._folder = TemporaryFolder()
        self._site: Any = None

    def __call__(self, request: dict[str, Any]) -> tuple[Any, tuple[()]]:
        """Answer a request."""
        if "open" in request:
            self._site, messages = self._open_site(request["open"])
            return {**self._loop.run_until_complete(self._open()), "said": messages}, ()
        if "run" in request:
            self._loop.run_until_complete(self._run())
        else:
            self._loop.run_until_complete(self._site.stop())
        return None, ()

    async def _open(self) -> dict[str, Any]:
        """Listen at a socket in the folder; return what the main process must know."""
        socket = sockets.socket(sockets.AF_UNIX, sockets.SOCK_STREAM)
        descriptor = os.open(self._folder.path, os.O_RDONLY)
        socket.bind(_socket_path(descriptor))
        os.close(descriptor)
        await self._site.listen(socket)
        (session,) = self._site.sessions
        return {
            "folder": str(self._folder.path),
            "token": session.token,
            "files": session.files,
            "static": session.static,
        }

    async def _run(self) -> NoReturn:
        while True:
            check()
            await asyncio.sleep(CHECK_S)


def _some_of(headers: Mapping[str, str], names: Iterable[str]) -> dict[str, str]:
    """Return those headers of a request or an answer that have one of some names."""
    found = {}
    for name in names:
        if name in headers:
            found[name] = headers[name]
    return found
