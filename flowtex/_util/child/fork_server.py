"""The process from which children are forked.

It has loaded libraries and has one thread, unlike the process that asks for children. A guard
between them holds one end of a pipe: it writes the status of a child that has ended, and kills one
that does not end soon after the pipe was closed.
"""

from __future__ import annotations

import gc
import json
import os
import select
import signal
import socket
import subprocess
import weakref
from contextlib import suppress
from importlib import import_module
from typing import Any, NoReturn

from flowtex._util.child.worker import command, confine, serve
from flowtex._util.forks import ProcessLock, call_at_fork

REQUEST_BYTES = 65_536  #: Bytes of a request.
STATUS_BYTES = 4  #: Bytes of a status.
ENDING_S = 1.0  #: Seconds before a child that does not end is killed.
_servers: dict[tuple[str, ...], ForkServer] = {}
_lock = ProcessLock()


class ForkServer:
    """The process with modules loaded that is forked, and the socket for requests to it."""

    def __init__(self, preload: tuple[str, ...]) -> None:
        self.control, other = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        # A separate session: Ctrl-C in the terminal is for the process that asks.
        process = subprocess.Popen(
            command(main, control=other.fileno(), preload=preload),
            pass_fds=[other.fileno()],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            start_new_session=True,
            # Threads of a library for linear algebra do not live on in what is forked.
            env={"OPENBLAS_NUM_THREADS": "1", **os.environ},
        )
        other.close()
        self.close = weakref.finalize(self, _close, self.control, process, os.getpid())


def _close(control: socket.socket, process: subprocess.Popen[bytes], owner: int) -> None:
    control.close()
    if os.getpid() == owner:  # and not a fork of it
        process.kill()
        process.wait()


def _forget_servers() -> None:
    """Have a forked process start its own servers: these end with the process before."""
    for server in _servers.values():
        server.control.close()
    _servers.clear()


call_at_fork(after=_forget_servers)


def fork_server(preload: tuple[str, ...], dead: ForkServer | None = None) -> ForkServer:
    """Return the server that has loaded these modules, a new one if it is ``dead``.

    Called early, it loads them in the background for children that will be started.
    """
    with _lock:
        server = _servers.get(preload)
        if server is None or server is dead:
            server = _servers[preload] = ForkServer(preload)
        return server


def main(control: int, preload: list[str]) -> NoReturn:
    """Load modules, or call ``"module:function"``, and fork children until the socket is closed."""
    for entry in preload:
        module, _, function = entry.partition(":")
        with suppress(Exception):
            loaded = import_module(module)
            if function:
                getattr(loaded, function)()
    # Collections do not touch, and so copy, what children share.
    gc.collect()
    gc.freeze()
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for guards
    requests = socket.socket(fileno=control)
    while True:
        text, pipes, _, _ = socket.recv_fds(requests, REQUEST_BYTES, 3)
        if not text:
            os._exit(0)
        if os.fork() == 0:
            try:
                requests.close()
                _guard(json.loads(text), *pipes)
            finally:
                os._exit(1)
        for pipe in pipes:
            os.close(pipe)


def _guard(start: dict[str, Any], reads: int, writes: int, status: int) -> None:
    """Fork a child, end it soon after the other end of the pipe of its status, and write that."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    ended, alive = os.pipe()
    if (pid := os.fork()) == 0:
        os.close(ended)
        os.close(status)
        confine(start["memory"], prints=start["prints"])
        serve(start["entry"], os.fdopen(reads, "rb"), os.fdopen(writes, "wb"))
    for pipe in (reads, writes, alive):
        os.close(pipe)
    poll = select.poll()
    for pipe in (ended, status):
        poll.register(pipe, 0)  # reports when the other end is closed
    if (ended, select.POLLHUP) not in poll.poll():
        # Its other pipes are closed too, so it removes its temporary folders, and ends.
        poll.unregister(status)
        if not poll.poll(1000 * ENDING_S):
            os.kill(pid, signal.SIGKILL)
    code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
    os.write(status, code.to_bytes(STATUS_BYTES, "big", signed=True))
