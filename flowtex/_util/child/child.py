"""A separate process as its parent sees it: requests with a time limit."""

from __future__ import annotations

import itertools
import json
import os
import select
import signal
import socket
import subprocess
import sys
import threading
import time
import weakref
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from queue import Empty, SimpleQueue
from typing import IO, Any

from flowtex._util.array_types import AnyArray
from flowtex._util.child.fork_server import STATUS_BYTES, fork_server
from flowtex._util.child.worker import command, read_message, spawned, write_message
from flowtex._util.forks import ProcessLock, renew_after_fork
from flowtex._util.memory import available_bytes
from flowtex._util.progress import Stopped, check

#: Whether children are forked; elsewhere libraries do not bear that.
FORKS = sys.platform == "linux"

if FORKS:
    import fcntl

CHECK_INTERVAL_S = 0.05  #: Seconds between two checks whether the caller still wants an answer.
STATUS_WAIT_S = 5.0  #: Longest wait in seconds for the status of a child that has closed its pipe.
MEMORY_SHARE = 0.6  #: Share of the available memory that a child may take.
ENDED = "ended"  #: How a child ended whose status is unknown, as when the fork server has died.
PIPE_BYTES = 1 << 20  #: Bytes that may wait in the pipe of answers.
INHERITED = "belongs to the process before a fork"  #: How a child ended, for a forked process.


class ChildError(Exception):
    """A child gives no answer.

    ``kind`` and ``trace`` are class and place of the error that it raised; empty where the text
    says all, such as ``"crashed (SIGSEGV)"``.
    """

    def __init__(self, text: str, kind: str = "", trace: str = "") -> None:
        super().__init__(text)
        self.kind = kind
        self.trace = trace


_Received = tuple[dict[str, Any], list[AnyArray]]  #: The header of an answer, and its arrays.


@dataclass(frozen=True)
class _Process:
    """A running child: its pipes, and functions that return its exit status and end it.

    ``ends`` are the numbers of the pipes' ends in this process.
    """

    requests: IO[bytes]
    answers: IO[bytes]
    status: Callable[[], int | None]
    end: Callable[[], None]
    ends: tuple[int, ...]

    def close(self) -> None:
        self.end()
        with suppress(OSError):
            self.requests.close()

    def let_go(self) -> None:
        """Close the pipes in a forked process, so that they end with the process before it.

        Objects of files keep their numbers, which would otherwise be those of later files.
        """
        device = os.open(os.devnull, os.O_RDWR)
        for end in self.ends:
            os.dup2(device, end, inheritable=False)
        os.close(device)


class Child:
    """A process that answers requests, one after another.

    Its methods may be called from any thread. It ends with this object, and with this process,
    however that ends. ``entry`` is the ``"module:name"`` of a function without arguments that
    returns the handler of requests, which takes a value of JSON and returns one with a list of
    arrays. A forked child has the modules ``preload`` at once. ``memory`` is its limit in bytes, by
    default a share of the available memory; macOS and Windows have no such limit. A child that
    ``prints`` has the standard error of this process.
    """

    def __init__(
        self,
        entry: str,
        *,
        preload: tuple[str, ...] = (),
        memory: int | None = None,
        forks: bool = FORKS,
        prints: bool = False,
    ) -> None:
        #: Bytes that it may take.
        if memory is None:
            self.memory = int(MEMORY_SHARE * available_bytes())
        else:
            self.memory = memory
        if forks:
            self._process = _forked(entry, self.memory, preload, prints)
        else:
            self._process = _spawned(entry, self.memory, preload, prints)
        self._answers: SimpleQueue[_Received] = SimpleQueue()
        self._asking = ProcessLock()
        self._writing = ProcessLock()
        self._numbers = itertools.count(1)
        #: Numbers of requests without an answer, and of those among them that were cancelled; and
        #: the time at which the current one has taken too long.
        self._waiting: set[int] = set()
        self._stale: set[int] = set()
        self._deadline = 0.0
        self._death = ""
        self.close = weakref.finalize(self, self._process.close)
        renew_after_fork(self)
        threading.Thread(
            target=_listen,
            args=(self._process, self.memory, self._answers, self._waiting, self._stale),
            name="flowtex child",
            daemon=True,
        ).start()

    def renew(self) -> None:
        """Let the child go, in a forked process: it answers the process before."""
        if self.close.detach() is not None:
            self._process.let_go()
        self._death = self._death or INHERITED

    @property
    def alive(self) -> bool:
        """Whether it takes requests; one that has died since the last request counts as alive."""
        return not self._death and self.close.alive

    def request(self, value: Any, *, timeout: float) -> tuple[Any, list[AnyArray]]:
        """Return the answer to a request: a value of JSON, and arrays.

        Ends the child and raises a ChildError if it does not answer within ``timeout`` seconds. If
        the work is cancelled, the child stops this request and continues.
        """
        while not self._asking.acquire(timeout=CHECK_INTERVAL_S):
            check()
        try:
            return self._request(value, timeout)
        finally:
            self._asking.release()

    def _request(self, value: Any, timeout: float) -> tuple[Any, list[AnyArray]]:
        """Return the value and the arrays of the answer to a request."""
        if self._death or not self.close.alive:
            raise ChildError(self._death or "was ended")
        number = next(self._numbers)
        if not self._stale:
            self._deadline = time.monotonic() + timeout
        self._waiting.add(number)
        self._send({"number": number, "value": value})
        while True:
            try:
                check()
            except Stopped:
                self._stale.add(number)
                self._send({"cancel": number})
                raise
            try:
                header, arrays = self._answers.get(timeout=CHECK_INTERVAL_S)
            except Empty:
                if time.monotonic() > self._deadline:
                    self._die(f"did not end within {timeout:.0f} s")
                continue
            if "death" in header:
                self._die(header["death"])
            if header["number"] == number:
                return _value(header, self.memory), arrays
            # The answer to an earlier request that was cancelled: this one begins.
            self._stale.discard(header["number"])
            self._deadline = time.monotonic() + timeout

    def _send(self, message: dict[str, Any]) -> None:
        # The answers report why a child has died.
        with self._writing, suppress(OSError, ValueError):
            write_message(self._process.requests, message)

    def _die(self, how: str) -> None:
        self._death = how
        self.close()
        raise ChildError(how)


def _value(header: dict[str, Any], memory: int) -> Any:
    """Return the value of an answer, or raise the error that it describes."""
    kind = header.get("error")
    text = str(header.get("text", ""))
    if kind is None:
        return header.get("value")
    if kind == "Stopped":
        raise Stopped
    if kind == "MemoryError":
        raise ChildError(f"needs more than {memory / 1e9:.1f} GB of memory")
    lines = str(header.get("trace", "")).split("\n")
    trace = "\n".join("".join(filter(str.isprintable, line)) for line in lines)
    raise ChildError(text, str(kind), trace)


def _listen(
    process: _Process,
    most_bytes: int,
    answers: SimpleQueue[_Received],
    waiting: set[int],
    stale: set[int],
) -> None:
    """Put answers into a queue until the child ends, and at last how it ended."""
    ending = ""
    try:
        with process.answers:
            while (message := read_message(process.answers, most_bytes)) is not None:
                header, arrays = message
                if isinstance(header, dict):
                    number = header.get("number")
                else:
                    number = None
                if number not in waiting:
                    raise ValueError(f"an answer to request {number!r}, which was not sent")
                waiting.discard(number)
                if number in stale:
                    arrays = []
                answers.put((header, arrays))
    except (ValueError, OSError, MemoryError) as error:
        ending = f"sent a malformed answer: {error}"
        process.end()
    answers.put(({"death": ending or _ending(process.status())}, []))


def _ending(status: int | None) -> str:
    """Return how a process ended, from its exit status, as the end of a sentence."""
    if status is None:
        return ENDED
    if status >= 0:
        return f"ended (status {status})"
    try:
        return f"crashed ({signal.Signals(-status).name})"
    except ValueError:
        return f"crashed (signal {-status})"


def _forked(entry: str, memory: int, preload: tuple[str, ...], prints: bool) -> _Process:  # noqa: FBT001
    """Start a process by a fork of the server, which has imported ``preload``."""
    requests = os.pipe()
    answers = os.pipe()
    status = os.pipe()
    pipes = requests[0], answers[1], status[1]
    with suppress(OSError):  # fewer switches between the processes, where this size is allowed
        fcntl.fcntl(answers[1], fcntl.F_SETPIPE_SZ, PIPE_BYTES)
    text = json.dumps({"entry": entry, "memory": memory, "prints": prints}).encode()
    server = fork_server(preload)
    try:
        try:
            socket.send_fds(server.control, [text], pipes)
        except OSError:
            socket.send_fds(fork_server(preload, dead=server).control, [text], pipes)
    finally:
        for pipe in pipes:
            os.close(pipe)
    status_end = os.fdopen(status[0], "rb", buffering=0)

    def exit_status() -> int | None:
        with suppress(OSError, ValueError):
            if select.select([status_end], [], [], STATUS_WAIT_S)[0]:
                code = status_end.read(STATUS_BYTES)
                if code:
                    return int.from_bytes(code, "big", signed=True)
                return None
        return None

    # The guard ends a child whose pipe is closed.
    ends = (requests[1], answers[0], status[0])
    return _Process(
        os.fdopen(requests[1], "wb"),
        os.fdopen(answers[0], "rb"),
        exit_status,
        status_end.close,
        ends,
    )


def _spawned(entry: str, memory: int, _preload: tuple[str, ...], prints: bool) -> _Process:  # noqa: FBT001
    """Start a process with a new interpreter, where processes cannot be forked."""
    process = subprocess.Popen(
        command(spawned, entry=entry, memory=memory, prints=prints),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=None if prints else subprocess.DEVNULL,
        start_new_session=True,
    )
    requests = process.stdin
    answers = process.stdout
    if requests is None or answers is None:
        raise OSError("a process has no pipes")

    def end() -> None:
        process.kill()
        process.wait()

    ends = (requests.fileno(), answers.fileno())
    return _Process(requests, answers, process.wait, end, ends)
