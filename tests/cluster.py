"""Object storage and a Dask cluster as their own processes, for tests and benchmarks.

Run as a program it is the object storage: ``python tests/cluster.py FOLDER``.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import struct
import subprocess
import sys
import threading
import time
import urllib.request
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from waiting import wait_until

ROOT = Path(__file__).resolve().parents[1]
BUCKET = "flows"
#: Objects that are larger than this lie in files, and not in the memory of the server.
IN_MEMORY_BYTES = 50_000
#: Whoever knows the URL may read, as browsers do; writing wants a signature.
POLICY = {
    "Version": "2012-10-17",
    "Statement": [
        {
            "Effect": "Allow",
            "Principal": "*",
            "Action": ["s3:GetObject", "s3:ListBucket"],
            "Resource": [f"arn:aws:s3:::{BUCKET}", f"arn:aws:s3:::{BUCKET}/*"],
        }
    ],
}


class Request(NamedTuple):
    """One request that object storage has answered, and the bytes of both bodies."""

    at: float
    method: str
    status: int
    received: int
    sent: int
    path: str


class ObjectStorage:
    """An S3 server with one bucket, whose objects lie in a folder.

    Parameters
    ----------
    folder
        its own folder.

    Attributes
    ----------
    url
        The bucket, for who reads it as web pages.
    environment
        What clients find in their environment.
    """

    def __init__(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self._log, told = folder / "requests.txt", folder / "port.txt"
        self._read = 0
        environment = {
            **os.environ,
            "TMPDIR": str(folder),
            "MOTO_S3_DEFAULT_KEY_BUFFER_SIZE": str(IN_MEMORY_BYTES),
        }
        with (folder / "log.txt").open("wb") as log:
            self.process = subprocess.Popen(
                [sys.executable, __file__, str(folder)], env=environment, stdout=log, stderr=log
            )
        _wait_until(lambda: told.exists() and bool(told.read_text()), self.process)
        endpoint = f"http://127.0.0.1:{told.read_text()}"
        self.url = f"{endpoint}/{BUCKET}"
        self.environment = {
            "AWS_ENDPOINT_URL": endpoint,
            "AWS_ALLOW_HTTP": "true",
            "AWS_ACCESS_KEY_ID": "nobody",
            "AWS_SECRET_ACCESS_KEY": "nothing",
            "AWS_REGION": "us-east-1",
            "AWS_VIRTUAL_HOSTED_STYLE_REQUEST": "false",
        }
        for query, body in (("", b""), ("?policy", json.dumps(POLICY).encode())):
            # Of a form the server would read nothing.
            kind = {"Content-Type": "application/json"}
            request = urllib.request.Request(self.url + query, body, kind, method="PUT")
            urllib.request.urlopen(request).close()

    def requests(self) -> list[Request]:
        """Return the requests since the last call."""
        with self._log.open(encoding="utf-8") as file:
            file.seek(self._read)
            # A line that is being written is left for the next call.
            lines = [line for line in file.read().splitlines(keepends=True) if line[-1] == "\n"]
        self._read += sum(len(line.encode()) for line in lines)
        return [_request_of(line) for line in lines]

    def close(self) -> None:
        """End the server; its objects are gone."""
        self.process.kill()
        self.process.wait()


class Cluster:
    """A scheduler and workers as their own processes, each in its own folder.

    Parameters
    ----------
    folder
        its own folder.
    environment
        What the processes find in their environment besides what is in that of this one.
    workers
        How many workers there are at first.
    memory
        Memory of a worker, as Dask has it.
    """

    def __init__(
        self, folder: Path, environment: dict[str, str], workers: int = 2, memory: str = "auto"
    ) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self._folder, self._memory = folder, memory
        path = os.pathsep.join([str(ROOT), str(ROOT / "tests")])
        # As a nanny sets it; these workers have none, so that the one that is killed stays so.
        trimmed = {"MALLOC_TRIM_THRESHOLD_": "65536"}
        self._environment = {**os.environ, **environment, **trimmed, "PYTHONPATH": path}
        told = folder / "scheduler.json"
        place = ("--host", "127.0.0.1", "--port", "0", "--scheduler-file", str(told))
        self.processes: list[subprocess.Popen[bytes]] = []
        self.scheduler = self._start("scheduler", *place)
        _wait_until(lambda: told.exists() and bool(told.read_text()), self.scheduler)
        self.address: str = json.loads(told.read_text())["address"]
        self.workers = [self.add_worker() for _ in range(workers)]

    def add_worker(self) -> subprocess.Popen[bytes]:
        """Start one more worker, with one thread."""
        limits = ("--nthreads", "1", "--no-nanny", "--memory-limit", self._memory)
        return self._start("worker", self.address, *limits)

    def close(self) -> None:
        """End all processes."""
        for process in self.processes[::-1]:
            process.kill()
            process.wait()

    def _start(self, kind: str, *words: str) -> subprocess.Popen[bytes]:
        here = self._folder / f"process{len(self.processes)}"
        here.mkdir()
        program = [sys.executable, "-m", f"distributed.cli.dask_{kind}", *words, "--no-dashboard"]
        with (here / "log.txt").open("wb") as log:
            process = subprocess.Popen(
                program, cwd=here, env=self._environment, stdout=log, stderr=log
            )
        self.processes.append(process)
        return process


def digests(place: str | Path, some: Iterable[str] | None = None) -> dict[str, str]:
    """Return a digest of each object of a store, but for the time that gzip writes into chunks.

    Of some of them alone, where these are given.
    """
    import zarr
    from zarr.buffer import default_buffer_prototype

    # The object storage, which is this module as well, needs nothing of the package.
    from flowtex.pyramid.places import store_at, sync

    store, kind = store_at(place), default_buffer_prototype()
    members = zarr.open_group(store, mode="r").members(max_depth=None)
    arrays = {name: array for name, array in members if isinstance(array, zarr.Array)}
    found = {}

    async def read() -> None:
        keys = [key async for key in store.list()] if some is None else some
        for key in keys:
            buffer = await store.get(key, kind)
            assert buffer is not None
            data = buffer.to_bytes()
            name, of_array, _ = key.partition("/c/")
            parts = _chunks(data, arrays[name]) if of_array else [data]
            # A chunk is packed by gzip, with the time in bytes 4 to 7, and followed by a check sum.
            if of_array:
                parts = [part[:4] + part[8:-4] for part in parts]
            found[key] = hashlib.blake2b(b"".join(parts), digest_size=16).hexdigest()

    sync(read())
    return found


def _chunks(data: bytes, array: Any) -> list[bytes]:
    """Return the packed chunks of an object."""
    if array.shards is None:
        return [data]
    count = math.prod(s // c for s, c in zip(array.shards, array.chunks, strict=True))
    # Where each chunk begins, and its size; the largest number stands for one that is not there.
    index = struct.iter_unpack("<QQ", data[-16 * count - 4 : -4])
    return [data[at : at + size] for at, size in index if at < len(data)]


def _wait_until(ready: Callable[[], bool], process: subprocess.Popen[bytes]) -> None:
    wait_until(lambda: ready() or process.poll() is not None, lambda: process.args)
    if not ready():
        msg = f"{process.args!r} did not become ready; see its log.txt"
        raise RuntimeError(msg)


def _request_of(line: str) -> Request:
    at, method, status, received, sent, path = line.rstrip("\n").split(" ", 5)
    return Request(float(at), method, int(status), int(received), int(sent), path)


class _Told:
    """A WSGI application that writes a line for every request of another one."""

    def __init__(self, inner: Any, log: Path) -> None:
        self._inner, self._lock = inner, threading.Lock()
        self._log = log.open("a", encoding="utf-8", buffering=1)

    def __call__(self, environ: dict[str, Any], start: Any) -> Iterator[bytes]:
        status: list[str] = []

        def started(line: str, *rest: Any) -> Any:
            status.append(line[:3])
            return start(line, *rest)

        body: Iterable[bytes] = self._inner(environ, started)
        sent = 0
        for part in body:
            sent += len(part)
            yield part
        words = (
            f"{time.time():.3f}",
            environ["REQUEST_METHOD"],
            status[0],
            environ.get("CONTENT_LENGTH") or "0",
            str(sent),
            environ["PATH_INFO"],
        )
        with self._lock:
            self._log.write(" ".join(words) + "\n")


def _serve(folder: Path) -> None:
    """Be an S3 server; its port is written into a file."""
    import resource

    from moto.moto_server.werkzeug_app import (
        DomainDispatcherApplication,
        MotoRequestHandler,
        create_backend_app,
    )
    from moto.s3.models import FakeMultipart
    from werkzeug.serving import make_server

    # Each object that lies in a file keeps it open.
    most = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))
    complete = FakeMultipart.complete

    def completed(upload: Any, body: Any) -> Any:
        """Join the parts, and keep none: they would take as many files and as much disk again."""
        whole = complete(upload, body)
        upload.dispose()
        upload.parts.clear()
        return whole

    FakeMultipart.complete = completed
    log = folder / "requests.txt"
    log.touch()
    app = _Told(DomainDispatcherApplication(create_backend_app), log)
    server = make_server("127.0.0.1", 0, app, threaded=True, request_handler=MotoRequestHandler)
    (folder / "port.txt").write_text(str(server.port), encoding="utf-8")
    server.serve_forever()


if __name__ == "__main__":
    _serve(Path(sys.argv[1]))
