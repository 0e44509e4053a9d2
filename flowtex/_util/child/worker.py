"""The main loop of a child: a handler of requests, within a memory limit."""

from __future__ import annotations

import json
import math
import os
import re
import struct
import sys
import threading
import traceback
from collections.abc import Callable, Sequence
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from queue import SimpleQueue
from typing import IO, Any

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex._util.progress import stoppable
from flowtex._util.whole_file import remove_folders

Answer = tuple[Any, Sequence[AnyArray]]  #: A value of JSON, and arrays.
Handler = Callable[[Any], Answer]  #: Answers a request, which is a value of JSON.
_PROGRAM = (
    "import json, sys; from importlib import import_module; start = json.loads(sys.argv[1]); "
    "sys.path[:] = start['path']; module, function = start['entry']; "
    "getattr(import_module(module), function)(**start['arguments'])"
)
OOM_SCORE = "800"  #: Priority, 0 to 1000, with which the system ends the child if memory runs out.
#: Errors whose text is sufficient without a trace.
QUIET = ("Stopped", "MemoryError", "FieldError")
TEXT_LENGTH = 4_000  #: Greatest length of an error text.
_PREFIX = struct.Struct(">I")  #: Length of the header.
HEADER_BYTES = 16_000_000  #: Most bytes of a header.
_TYPE = re.compile(r"[<>|][biuf]\d{1,2}")  #: Types of arrays: numbers and truth values.
_served: list[str] = []  #: The entry that this process serves, if it is a child.


def is_child() -> bool:
    """Return whether this process is a child, which may end without harm."""
    return bool(_served)


def command(function: Callable[..., Any], **arguments: Any) -> list[str]:
    """Return the command of a process with the paths of this one that calls a function."""
    entry = function.__module__, function.__name__
    start = json.dumps({"path": sys.path, "entry": entry, "arguments": arguments})
    return [sys.executable, "-I", "-c", _PROGRAM, start]


def spawned(entry: str, memory: int, prints: bool) -> None:  # noqa: FBT001 by name alone
    """Answer the requests that come on the standard input, in a separate process."""
    reads = os.dup(0)
    writes = os.dup(1)
    confine(memory, prints=prints)
    serve(entry, os.fdopen(reads, "rb"), os.fdopen(writes, "wb"))


def confine(memory: int, *, prints: bool) -> None:
    """Limit this process to so many further bytes, and drop its output.

    Where memory runs out the system ends it before others, and no core is dumped. The standard
    streams are the null device from here on, except that of errors if it ``prints``.
    """
    device = os.open(os.devnull, os.O_RDWR)
    os.dup2(device, 0)
    os.dup2(device, 1)
    if not prints:  # output of C libraries is dropped
        os.dup2(device, 2)
    with suppress(OSError):
        Path("/proc/self/oom_score_adj").write_text(OOM_SCORE, encoding="utf-8")
    if sys.platform == "win32":
        return
    import resource

    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    used = 0
    with suppress(OSError):
        pages = Path("/proc/self/statm").read_text(encoding="utf-8").split()
        used = int(pages[5]) * resource.getpagesize()
    most = resource.getrlimit(resource.RLIMIT_DATA)[1]
    if most == resource.RLIM_INFINITY:
        limit = used + memory
    else:
        limit = min(used + memory, most)
    with suppress(ValueError, OSError):  # the system has no such limit
        resource.setrlimit(resource.RLIMIT_DATA, (limit, most))


def serve(entry: str, reads: IO[bytes], writes: IO[bytes]) -> None:
    """Answer requests until the other end is closed; ``entry`` names what returns the handler."""
    _served.append(entry)
    requests: SimpleQueue[tuple[int, Any]] = SimpleQueue()
    cancelled: set[int] = set()
    threading.Thread(target=_listen, args=(reads, requests, cancelled), daemon=True).start()
    handler: Handler | None = None
    while True:
        number, value = requests.get()
        arrays: Sequence[AnyArray] = ()
        try:
            with stoppable(lambda number=number: number in cancelled):  # type: ignore[misc]
                if handler is None:
                    module, _, name = entry.partition(":")
                    handler = getattr(import_module(module), name)()
                value, arrays = handler(value)
            answer: dict[str, Any] = {"number": number, "value": value}
        except Exception as error:
            answer = {"number": number, "error": _kind(error), "text": str(error)[:TEXT_LENGTH]}
            if answer["error"] not in QUIET:
                answer["trace"] = traceback.format_exc()
        cancelled.discard(number)
        try:
            write_message(writes, answer, arrays)
        except MemoryError:
            write_message(writes, {"number": number, "error": "MemoryError", "text": ""})


def _kind(error: Exception) -> str:
    """Return the name of the class, or of its base class that the other end knows."""
    for kind in type(error).__mro__:
        if kind.__name__ in QUIET:
            return kind.__name__
    return type(error).__name__


def _listen(reads: IO[bytes], requests: SimpleQueue[tuple[int, Any]], cancelled: set[int]) -> None:
    """Take requests and cancellations until the other end is closed, then end the process."""
    try:
        while (message := read_message(reads, 0)) is not None:
            value = message[0]
            if "cancel" in value:
                cancelled.add(value["cancel"])
            else:
                requests.put((value["number"], value["value"]))
    finally:
        remove_folders()
        os._exit(0)


def write_message(stream: IO[bytes], value: Any, arrays: Sequence[AnyArray] = ()) -> None:
    """Write a header with a value of JSON, and arrays of numbers.

    Nothing is unpickled: a process that parses an untrusted file may be compromised.
    """
    contiguous = []
    infos = []
    for array in arrays:
        contiguous.append(np.ascontiguousarray(array))
        infos.append([array.dtype.str, np.shape(array)])
    header = json.dumps({"value": value, "arrays": infos}).encode()
    if len(header) > HEADER_BYTES:
        raise ValueError(
            f"the header of a message has {len(header):,} bytes; expected {HEADER_BYTES:,}"
        )
    stream.write(_PREFIX.pack(len(header)) + header)
    for array in contiguous:
        stream.write(array.reshape(-1).view(np.uint8).data)
    stream.flush()


def read_message(stream: IO[bytes], most_bytes: int) -> tuple[Any, list[AnyArray]] | None:
    """Return a value and arrays, of ``most_bytes`` at most; ``None`` at the end of the stream."""
    prefix = bytearray(_PREFIX.size)
    if not _fill(stream, memoryview(prefix)):
        return None
    (length,) = _PREFIX.unpack(prefix)
    if length > HEADER_BYTES:
        raise ValueError(
            f"the header of a message has {length:,} bytes; expected {HEADER_BYTES:,} at most"
        )
    header = bytearray(length)
    if not _fill(stream, memoryview(header)):
        return None
    try:
        message = json.loads(header)
        value = message["value"]
        infos = message["arrays"]
        types = []
        for kind, shape in infos:
            types.append((_type(kind), _shape(shape)))
    except (ValueError, TypeError, KeyError, RecursionError) as error:
        raise ValueError(f"the header of a message is malformed: {error}") from error
    size = sum(kind.itemsize * math.prod(shape) for kind, shape in types)
    if size > most_bytes:
        raise ValueError(
            f"a message declares {size:,} bytes of arrays; expected {most_bytes:,} at most"
        )
    arrays: list[AnyArray] = []
    for kind, shape in types:
        arrays.append(np.empty(shape, kind))
        if not _fill(stream, arrays[-1].reshape(-1).view(np.uint8).data):
            return None
    return value, arrays


def _type(text: Any) -> np.dtype[Any]:
    if not _TYPE.fullmatch(text):
        raise ValueError(f"the type {text!r} of an array")
    kind: np.dtype[Any] = np.dtype(text)
    return kind


def _shape(sizes: Any) -> tuple[int, ...]:
    for size in sizes:
        if type(size) is not int or size < 0:
            raise ValueError(f"the shape {sizes!r} of an array")
    return tuple(sizes)


def _fill(stream: IO[bytes], view: memoryview) -> bool:
    """Fill a buffer from a stream; return ``False`` where the stream ends before."""
    filled = 0
    while filled < len(view):
        count = stream.readinto(view[filled:])  # type: ignore[attr-defined]
        if not count:
            return False
        filled += count
    return True
