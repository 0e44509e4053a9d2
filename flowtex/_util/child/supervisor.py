"""A child as its parent sees it: requests with a time limit, and an error at once when it ends."""

from __future__ import annotations

import itertools
import os
import select
import signal
import subprocess
import threading
import time
import weakref
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from queue import Empty, SimpleQueue
from typing import IO, Any

from flowtex._util.array_types import AnyArray
from flowtex._util.child.forkserver import FORKS, STATUS_BYTES, fork_server
from flowtex._util.child.worker import MessageError, command, read_message, spawned, write_message
from flowtex._util.memory import available_bytes
from flowtex._util.progress import Stopped, check

if FORKS:
    import fcntl

#: Seconds between two checks whether an answer is still wanted, and for which the status of a
#: child that has closed its pipe is waited for.
CHECK_INTERVAL_S, STATUS_WAIT_S = 0.05, 5.0
#: Share of the available memory that a child may take.
MEMORY_SHARE = 0.6
#: How a child ended whose status is unknown, as when the fork server has died.
ENDED = "ended"
#: Bytes that may wait in the pipe of answers.
PIPE_BYTES = 1 << 20


class ChildError(Exception):
    """A child gives no answer.

    ``kind`` and ``trace`` are class and place of the error that it raised; empty where the text
    says all, such as ``"crashed (SIGSEGV)"``.
    """

    def __init__(self, text: str, kind: str = "", trace: str = "") -> None:
        super().__init__(text)
        self.kind, self.trace = kind, trace


#: The header of an answer, and its arrays.
_Received = tuple[dict[str, Any], list[AnyArray]]


@dataclass(frozen=True)
class _Process:
    """A running child: its pipes, and functions that return its exit status and end it."""

    requests: IO[bytes]
    answers: IO[bytes]
    status: Callable[[], int | None]
    end: Callable[[], None]


class Child:
    """A process that answers requests, one after another.

    Its methods may be called from any thread. It ends with this object, and with this process,
    however that ends. ``entry`` is the ``"module:name"`` of a function without arguments that
    returns the handler of requests, which takes a value of JSON and returns one with a list of
    arrays. A forked child has the modules ``preload`` at once. ``memory`` is its limit in bytes, by
    default a share of the available memory; macOS and Windows have no such limit. A ``lasting``
    child continues when the process that it was forked from dies, and has the standard error of
    this process.
    """

    def __init__(
        self,
        entry: str,
        *,
        preload: tuple[str, ...] = (),
        memory: int | None = None,
        forks: bool = FORKS,
        lasting: bool = False,
    ) -> None:
        #: Bytes that it may take.
        self.memory = int(MEMORY_SHARE * available_bytes()) if memory is None else memory
        start = _forked if forks else _spawned
        self._process = start(entry, self.memory, preload, lasting)
        self._answers: SimpleQueue[_Received] = SimpleQueue()
        self._asking, self._writing = threading.Lock(), threading.Lock()
        self._numbers = itertools.count(1)
        #: Numbers of requests without an answer, and of those among them that were cancelled; and
        #: the time at which the current one has taken too long.
        self._waiting: set[int] = set()
        self._stale: set[int] = set()
        self._deadline = 0.0
        self._death = ""
        self.close = weakref.finalize(self, _end, self._process)
        threading.Thread(
            target=_listen,
            args=(self._process, self.memory, self._answers, self._waiting, self._stale),
            name="flowtex child",
            daemon=True,
        ).start()

    @property
    def alive(self) -> bool:
        """Whether it takes requests; one that has died since the last request counts as alive."""
        return not self._death and self.close.alive

    def request(self, value: Any, *, timeout: float) -> tuple[Any, list[AnyArray]]:
        """Return the answer to a request: a value of JSON, and arrays.

        Raises a ChildError when there is none in ``timeout`` seconds, and ends the child. When the
        work was cancelled, the child stops this request, and continues.
        """
        while not self._asking.acquire(timeout=CHECK_INTERVAL_S):
            check()
        try:
            return self._request(value, timeout)
        finally:
            self._asking.release()

    def _request(self, value: Any, timeout: float) -> tuple[Any, list[AnyArray]]:
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


def prepare(preload: tuple[str, ...]) -> None:
    """Load modules in the background for children that will be started."""
    if FORKS:
        fork_server(preload)


def _value(header: dict[str, Any], memory: int) -> Any:
    kind, text = header.get("error"), str(header.get("text", ""))
    if kind is None:
        return header.get("value")
    if kind == "Stopped":
        raise Stopped
    if kind == "MemoryError":
        msg = f"needs more than {memory / 1e9:.1f} GB of memory"
        raise ChildError(msg)
    trace = "".join(c for c in str(header.get("trace", "")) if c.isprintable() or c == "\n")
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
                number = header.get("number") if isinstance(header, dict) else None
                if number not in waiting:
                    msg = f"an answer to request {number!r}, which was not sent"
                    raise MessageError(msg)
                waiting.discard(number)
                answers.put((header, [] if number in stale else arrays))
    except (MessageError, OSError, MemoryError) as error:
        ending = f"sent a malformed answer: {error}"
        process.end()
    answers.put(({"death": ending or _ending(process.status())}, []))


def _ending(status: int | None) -> str:
    if status is None or status >= 0:
        return ENDED if status is None else f"ended (status {status})"
    try:
        return f"crashed ({signal.Signals(-status).name})"
    except ValueError:
        return f"crashed (signal {-status})"


def _end(process: _Process) -> None:
    process.end()
    with suppress(OSError):
        process.requests.close()


def _forked(entry: str, memory: int, preload: tuple[str, ...], lasting: bool) -> _Process:  # noqa: FBT001
    """Let the fork server start a child."""
    requests, answers, status = os.pipe(), os.pipe(), os.pipe()
    pipes = requests[0], answers[1], status[1]
    with suppress(OSError):  # fewer switches between the processes, where this size is allowed
        fcntl.fcntl(answers[1], fcntl.F_SETPIPE_SZ, PIPE_BYTES)
    server = fork_server(preload)
    try:
        try:
            server.start(entry, memory, pipes, lasting=lasting)
        except OSError:  # it has died since
            server = fork_server(preload)
            server.start(entry, memory, pipes, lasting=lasting)
    finally:
        for pipe in pipes:
            os.close(pipe)
    status_end = os.fdopen(status[0], "rb", buffering=0)

    def exit_status() -> int | None:
        with suppress(OSError, ValueError):
            if select.select([status_end], [], [], STATUS_WAIT_S)[0]:
                if code := status_end.read(STATUS_BYTES):
                    return int.from_bytes(code, "big", signed=True)
                server.lost = True  # it has died, or is dying
        return None

    # The fork server ends a child whose pipe is closed.
    return _Process(
        os.fdopen(requests[1], "wb"), os.fdopen(answers[0], "rb"), exit_status, status_end.close
    )


def _spawned(entry: str, memory: int, _preload: tuple[str, ...], lasting: bool) -> _Process:  # noqa: FBT001
    """Start a child from nothing."""
    process = subprocess.Popen(
        command(spawned, entry=entry, memory=memory, lasting=lasting),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=None if lasting else subprocess.DEVNULL,
        start_new_session=True,
    )
    requests, answers = process.stdin, process.stdout
    if requests is None or answers is None:
        msg = "a process has no pipes"
        raise OSError(msg)

    def end() -> None:
        process.kill()
        process.wait()

    return _Process(requests, answers, process.wait, end)
