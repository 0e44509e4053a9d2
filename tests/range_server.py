"""A folder behind a plain HTTP server with ranges and CORS, which may answer wrongly for a test."""

from __future__ import annotations

import re
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

Answer = int | bytes | None


@dataclass
class RangeServer:
    """What is served, where, and what was requested.

    ``fault`` is called with the path of each request, such as ``"0/traces/c/0/0/1/0/0/0/0"``: a
    status is answered in place of the file, bytes are its contents, and ``None`` leaves it as it
    is. Answers of which ``cut`` is true end in their middle.
    """

    folder: Path
    address: str
    fault: Callable[[str], Answer] = lambda path: None
    cut: Callable[[str], bool] = lambda path: False
    #: Method, path and range of each request, and bytes that were sent for all of them.
    asked: list[tuple[str, str, str]] = field(default_factory=list)
    sent: int = 0
    #: Requests whose client went away before all was sent.
    broken_off: list[str] = field(default_factory=list)

    def reset(self, folder: Path) -> None:
        """Begin again with a folder, at the same address."""
        vars(self).update(vars(RangeServer(folder, self.address)))

    @property
    def paths(self) -> list[str]:
        """Return the paths that were requested."""
        return [path for _, path, _ in self.asked]


@contextmanager
def range_server(folder: Path) -> Iterator[RangeServer]:
    """Serve a folder, at a free port of this machine."""
    httpd = ThreadingHTTPServer(("127.0.0.1", 0), _Handler)
    httpd.daemon_threads = True
    server = RangeServer(folder, f"http://127.0.0.1:{httpd.server_port}/")
    httpd.range_server = server  # type: ignore[attr-defined]
    thread = threading.Thread(target=httpd.serve_forever, args=(0.02,), daemon=True)
    thread.start()
    try:
        yield server
    finally:
        httpd.shutdown()
        httpd.server_close()
        thread.join()


class _Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def log_message(self, *_: object) -> None:
        """Say nothing."""

    def do_OPTIONS(self) -> None:
        self._answer(204, b"")

    def do_HEAD(self) -> None:
        self._send()

    def do_PROPFIND(self) -> None:
        server: RangeServer = self.server.range_server  # type: ignore[attr-defined]
        server.asked.append((self.command, self.path, ""))
        self._answer(501, b"")  # it lists no files

    def do_GET(self) -> None:
        self._send()

    def _send(self) -> None:
        server: RangeServer = self.server.range_server  # type: ignore[attr-defined]
        path = self.path.split("?")[0].lstrip("/")
        span = self.headers.get("Range", "")
        server.asked.append((self.command, path, span))
        fault = server.fault(path)
        file = server.folder / path
        if isinstance(fault, int) or (fault is None and not file.is_file()):
            self._answer(fault or 404, b"")
            return
        data = file.read_bytes() if fault is None else fault
        asked = re.fullmatch(r"bytes=(\d*)-(\d*)", span)
        if asked is None:
            self._answer(200, data)
            return
        first, last = asked.groups()
        start = int(first) if first else max(len(data) - int(last), 0)
        end = min(int(last) + 1, len(data)) if first and last else len(data)
        self._answer(206, data[start:end], f"bytes {start}-{end - 1}/{len(data)}")

    def _answer(self, status: int, data: bytes, part: str = "") -> None:
        server: RangeServer = self.server.range_server  # type: ignore[attr-defined]
        try:
            self.send_response(status)
            self.send_header("Access-Control-Allow-Origin", "*")
            self.send_header("Access-Control-Allow-Headers", "Range")
            self.send_header("Accept-Ranges", "bytes")
            if part:
                self.send_header("Content-Range", part)
            if self.path.endswith((".html", "/")):
                self.send_header("Content-Type", "text/html; charset=utf-8")
            if kind := {".mjs": "javascript", ".js": "javascript", ".css": "css"}.get(
                Path(self.path.split("?")[0]).suffix
            ):
                self.send_header("Content-Type", f"text/{kind}; charset=utf-8")
            self.send_header("Content-Length", str(len(data)))
            self.end_headers()
            if self.command != "HEAD":
                self.close_connection = server.cut(self.path.lstrip("/"))
                self.wfile.write(data[: len(data) // (2 if self.close_connection else 1)])
                server.sent += len(data)
        except OSError:
            server.broken_off.append(self.path)
            self.close_connection = True
