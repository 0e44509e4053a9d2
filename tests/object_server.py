"""A folder served as object storage serves it, with ranges, and with the faults that one has."""

from __future__ import annotations

import re
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any, NamedTuple

__all__ = ["ObjectServer", "Request", "object_server"]


class Request(NamedTuple):
    """What was asked for."""

    method: str
    path: str
    range: str


class ObjectServer(ThreadingHTTPServer):
    """Serves a folder; ``fault`` gives for each path what goes wrong.

    That is a status such as 403, ``"cut"`` for half an answer, ``"silent"`` for none, seconds that
    an answer takes, or nothing.
    """

    daemon_threads = True

    def __init__(self, folder: Path) -> None:
        super().__init__(("127.0.0.1", 0), _Handler)
        self.folder = folder
        self.requests: list[Request] = []
        self.fault: Callable[[str], int | float | str | None] = lambda path: None
        self.ended = threading.Event()

    @property
    def address(self) -> str:
        return f"http://127.0.0.1:{self.server_port}"

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Say nothing of clients that have gone."""


class _Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    server: ObjectServer

    def log_message(self, *words: Any) -> None:
        """Say nothing."""

    def do_GET(self) -> None:
        path, asked = self.path.lstrip("/"), self.headers.get("Range", "")
        self.server.requests.append(Request(self.command, path, asked))
        fault = self.server.fault(path)
        if fault == "silent":
            self.server.ended.wait(30)
            self.close_connection = True
            return
        if isinstance(fault, float):
            time.sleep(fault)
        if isinstance(fault, int):
            self._answer(fault, b"<Secret>hidden</Secret>")
            return
        file = self.server.folder / path
        if not file.is_file():
            self._answer(404, b"")
            return
        body, kind = file.read_bytes(), 200
        if found := re.fullmatch(r"bytes=(\d*)-(\d*)", asked):
            first, last = found.groups()
            start = int(first) if first else max(len(body) - int(last), 0)
            end = min(int(last) + 1, len(body)) if first and last else len(body)
            if start >= len(body):
                self._answer(416, b"")
                return
            self.send_response(206)
            self.send_header("Content-Range", f"bytes {start}-{end - 1}/{len(body)}")
            body, kind = body[start:end], 0
        self._answer(kind, body, cut=fault == "cut")

    do_HEAD = do_GET

    def _answer(self, status: int, body: bytes, *, cut: bool = False) -> None:
        if status:
            self.send_response(status)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(body[: len(body) // 2] if cut else body)
        self.close_connection = cut


@contextmanager
def object_server(folder: Path) -> Iterator[ObjectServer]:
    """Serve a folder meanwhile."""
    server = ObjectServer(folder)
    thread = threading.Thread(target=server.serve_forever, args=(0.05,))
    thread.start()
    try:
        yield server
    finally:
        server.ended.set()
        server.shutdown()
        server.server_close()
        thread.join()
