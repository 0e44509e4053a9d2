"""Work in a separate process, which may die without taking anything along.

A :class:`Child` is such a process as its parent sees it: requests with a time limit, and an error
at once when it ends. It is forked, within milliseconds, from a process that has loaded libraries.
That has one thread, unlike the process that asks for children. It holds one end of a pipe for each
child: it writes the status of one that has ended, and kills one that does not end soon after its
pipe was closed. So no child outlives the process that requested it, in whatever way that ends.
"""

from __future__ import annotations

import ctypes
import gc
import itertools
import json
import math
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
from importlib import import_module
from queue import Empty, SimpleQueue
from typing import IO, Any, NoReturn

from flowtex._util.array_types import AnyArray
from flowtex._util.child.worker import (
    MessageError,
    command,
    read_message,
    serve,
    settle,
    spawned,
    write_message,
)
from flowtex._util.memory import available_bytes
from flowtex._util.progress import Stopped, check

#: Whether children are forked; elsewhere libraries do not bear that.
FORKS = sys.platform == "linux"

if FORKS:
    import fcntl

#: Seconds between two checks whether the caller still wants an answer.
CHECK_INTERVAL_S = 0.05
#: Longest wait in seconds for the status of a child that has closed its pipe.
STATUS_WAIT_S = 5.0
#: Share of the available memory that a child may take.
MEMORY_SHARE = 0.6
#: How a child ended whose status is unknown, as when the fork server has died.
ENDED = "ended"
#: Bytes that may wait in the pipe of answers.
PIPE_BYTES = 1 << 20
#: Bytes of a request.
REQUEST_BYTES = 65_536
#: Bytes of a status.
STATUS_BYTES = 4
#: Option of Linux's prctl that ends a process with its parent.
PR_SET_PDEATHSIG = 1
#: Seconds that a child has to end by itself.
ENDING_S = 1.0

_servers: dict[tuple[str, ...], ForkServer] = {}
_lock = threading.Lock()


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

    def close(self) -> None:
        self.end()
        with suppress(OSError):
            self.requests.close()


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
        self.close = weakref.finalize(self, self._process.close)
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
    kind, text = header.get("error"), str(header.get("text", ""))
    if kind is None:
        return header.get("value")
    if kind == "Stopped":
        raise Stopped
    if kind == "MemoryError":
        raise ChildError(f"needs more than {memory / 1e9:.1f} GB of memory")
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
                    raise MessageError(f"an answer to request {number!r}, which was not sent")
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


def _forked(entry: str, memory: int, preload: tuple[str, ...], lasting: bool) -> _Process:  # noqa: FBT001
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
    process = subprocess.Popen(
        command(spawned, entry=entry, memory=memory, lasting=lasting),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=None if lasting else subprocess.DEVNULL,
        start_new_session=True,
    )
    requests, answers = process.stdin, process.stdout
    if requests is None or answers is None:
        raise OSError("a process has no pipes")

    def end() -> None:
        process.kill()
        process.wait()

    return _Process(requests, answers, process.wait, end)


class ForkServer:
    """The process with modules loaded that is forked, as the process that uses it sees it."""

    def __init__(self, preload: tuple[str, ...]) -> None:
        self._control, other = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        # A separate session: Ctrl-C in the terminal is for the process that asks.
        self._process = subprocess.Popen(
            command(main, control=other.fileno(), preload=preload),
            pass_fds=[other.fileno()],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            start_new_session=True,
            # Threads of a library for linear algebra do not live on in what is forked.
            env={"OPENBLAS_NUM_THREADS": "1", **os.environ},
        )
        other.close()
        self._owner = os.getpid()
        #: Whether it has died, as a failed request has shown.
        self.lost = False
        self.close = weakref.finalize(self, _close, self._control, self._process, self._owner)

    @property
    def alive(self) -> bool:
        """Whether it runs, as far as is known; a fork of its owner may also use it."""
        owned = self._owner == os.getpid()
        return not self.lost and (not owned or self._process.poll() is None)

    def start(self, entry: str, memory: int, pipes: tuple[int, int, int], *, lasting: bool) -> None:
        """Fork a child with pipes for requests, answers and its status."""
        text = json.dumps({"entry": entry, "memory": memory, "lasting": lasting}).encode()
        try:
            socket.send_fds(self._control, [text], list(pipes))
        except OSError:
            self.lost = True
            raise


def _close(control: socket.socket, process: subprocess.Popen[bytes], owner: int) -> None:
    control.close()
    if os.getpid() == owner:
        process.kill()  # it may be loading libraries; its children end with it
        process.wait()


def fork_server(preload: tuple[str, ...]) -> ForkServer:
    """Return the server that has loaded these modules, started if necessary.

    Called early, it loads them in the background for children that will be started.
    """
    with _lock:
        server = _servers.get(preload)
        if server is None or not server.alive:
            server = _servers[preload] = ForkServer(preload)
        return server


def main(control: int, preload: list[str]) -> NoReturn:
    """Load modules, or call ``"module:function"``, and fork children until the socket is closed."""
    server = _Server(socket.socket(fileno=control))
    for entry in preload:
        module, _, function = entry.partition(":")
        with suppress(Exception):
            loaded = import_module(module)
            if function:
                getattr(loaded, function)()
        server.run(once=True)
    # Collections do not touch, and so copy, what children share.
    gc.collect()
    gc.freeze()
    while True:
        server.run()


class _Server:
    """The forking process itself."""

    def __init__(self, control: socket.socket) -> None:
        self._control = control
        self._wakes, wakes = os.pipe()
        os.set_blocking(wakes, False)
        signal.set_wakeup_fd(wakes)
        signal.signal(signal.SIGCHLD, lambda *_: None)
        #: Pipes of the children's status, by their numbers, and when those that end are killed.
        self._children: dict[int, int] = {}
        self._ending: dict[int, float] = {}

    def run(self, *, once: bool = False) -> None:
        """Wait for a request or the end of a child, or with ``once`` not at all, and handle it."""
        poll = select.poll()
        poll.register(self._control, select.POLLIN)
        poll.register(self._wakes, select.POLLIN)
        for pid, status in self._children.items():
            if pid not in self._ending:
                poll.register(status, 0)  # reports when the other end is closed
        soonest = min(self._ending.values(), default=math.inf) - time.monotonic()
        wait = None if soonest == math.inf else 1000 * max(soonest, 0.0)
        ready = dict(poll.poll(0 if once else wait))
        if self._wakes in ready:
            os.read(self._wakes, REQUEST_BYTES)
            self._reap()
        now = time.monotonic()
        for pid, status in self._children.items():
            if status in ready:
                # Its other pipe is closed too, so it removes its temporary folders, and ends.
                self._ending[pid] = now + ENDING_S
            elif now >= self._ending.get(pid, math.inf):
                os.kill(pid, signal.SIGKILL)
                self._ending[pid] = math.inf
        if self._control.fileno() in ready:
            self._answer()

    def _reap(self) -> None:
        for pid in list(self._children):
            done, status = os.waitpid(pid, os.WNOHANG)
            if done:
                pipe = self._children.pop(pid)
                self._ending.pop(pid, None)
                code = os.waitstatus_to_exitcode(status)
                with suppress(OSError):
                    os.write(pipe, code.to_bytes(STATUS_BYTES, "big", signed=True))
                os.close(pipe)

    def _answer(self) -> None:
        text, pipes, _, _ = socket.recv_fds(self._control, REQUEST_BYTES, 3)
        if not text:
            end = time.monotonic() + ENDING_S
            while self._children and time.monotonic() < end:
                self._reap()
                time.sleep(ENDING_S / 100)
            for pid in self._children:
                os.kill(pid, signal.SIGKILL)
            os._exit(0)
        reads, writes, status = pipes
        if (pid := os.fork()) == 0:
            self._become_child(json.loads(text), reads, writes, status)
        self._children[pid] = status
        os.close(reads)
        os.close(writes)

    def _become_child(
        self, start: dict[str, Any], reads: int, writes: int, status: int
    ) -> NoReturn:
        code = 1
        try:
            if not start["lasting"]:
                ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
            signal.set_wakeup_fd(-1)
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)
            self._control.close()
            for pipe in (self._wakes, status, *self._children.values()):
                os.close(pipe)
            settle(start["memory"], lasting=start["lasting"])
            serve(start["entry"], os.fdopen(reads, "rb"), os.fdopen(writes, "wb"))
            code = 0
        finally:
            os._exit(code)
