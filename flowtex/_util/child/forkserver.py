"""A process that has loaded libraries, and is forked into children: they start within milliseconds.

It has one thread, unlike the process that asks for children. It holds one end of a pipe for each
child: it writes the status of one that has ended, and kills one that does not end soon after its
pipe was closed. So no child outlives the process that requested it, in whatever way that ends.
"""

from __future__ import annotations

import ctypes
import gc
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
from contextlib import suppress
from importlib import import_module
from typing import Any, NoReturn

from flowtex._util.child.worker import command, serve, settle

#: Whether children are forked; elsewhere libraries do not bear that.
FORKS = sys.platform == "linux"

#: Bytes of a request.
REQUEST_BYTES = 65_536
#: Length of a status, and of the signal that ends a process with its parent.
STATUS_BYTES, PR_SET_PDEATHSIG = 4, 1
#: Seconds that a child has to end by itself.
ENDING_S = 1.0

_servers: dict[tuple[str, ...], ForkServer] = {}
_lock = threading.Lock()


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
    """Return the server that has loaded these modules, started if necessary."""
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
