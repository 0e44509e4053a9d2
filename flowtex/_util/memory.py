"""The memory that this process may still take, also in a container, and its release."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from flowtex.errors import FieldError

UNKNOWN_BYTES = 4_000_000_000  #: Memory that is assumed if the system does not report it.
#: Share of the memory for data: a reader and later computations take several times as much.
MEMORY_SHARE = 0.5
#: Bytes that always fit: to ask for the available memory takes longer than to read them.
SMALL = 100_000


def available_bytes(root: Path = Path("/")) -> int:
    """Return the least of the free memory and what control groups and ``RLIMIT_AS`` leave."""
    limits = [*_physical(root), *_groups(root), *_address_space(root)]
    return max(min(limits, default=UNKNOWN_BYTES), 0)


def check_memory(nbytes: int, what: str) -> None:
    """Check that data fit into memory.

    Parameters
    ----------
    nbytes
        Their size in bytes.
    what
        What declares the size, for the error.

    Raises
    ------
    FieldError
        When they need more than a share of the available memory.
    """
    if nbytes < SMALL:
        return
    budget = int(available_bytes() * MEMORY_SHARE)
    if nbytes > budget:
        raise FieldError(
            f"{what} declares {size_text(nbytes)}, but {size_text(budget)} of memory are "
            "available for data; write a part or a coarser version to a separate file"
        )


def size_text(nbytes: int) -> str:
    """Return a number of bytes as text, such as ``"1.5 GB"``."""
    size = float(min(nbytes, 10**30))
    units = ["bytes", "kB", "MB", "GB", "TB", "PB"]
    while size >= 1000 and len(units) > 1:
        size = size / 1000
        units = units[1:]
    if size < 1000:
        return f"{size:.3g} {units[0]}"
    return f"{size:.0f} {units[0]}"


def give_back() -> None:
    """Return freed memory to the system, which glibc keeps in a heap for each thread."""
    with suppress(OSError, AttributeError):  # of another C library
        ctypes.CDLL("libc.so.6").malloc_trim(0)


def _physical(root: Path) -> Iterator[int]:
    free = _table(root / "proc/meminfo").get("MemAvailable:")
    if free is not None:
        yield free * 1024
        return
    with suppress(AttributeError, ValueError, OSError):
        # macOS does not report the free memory, and Windows not even the physical one.
        yield os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")


def _groups(root: Path) -> Iterator[int]:
    """Yield the rests that the limits of this process's control groups and their parents leave."""
    for line in _text(root / "proc/self/cgroup").splitlines():
        _, controllers, path = line.split(":", 2)
        if not controllers:
            top = root / "sys/fs/cgroup"
            limit = "memory.max"
            used = "memory.current"
        elif "memory" in controllers.split(","):
            top = root / "sys/fs/cgroup/memory"
            limit = "memory.limit_in_bytes"
            used = "memory.usage_in_bytes"
        else:
            continue
        group = top / path.strip("/")
        for folder in (group, *group.parents):
            most = _text(folder / limit)
            now = _text(folder / used)
            if most.isdecimal() and now.isdecimal():
                # The cache of files is given back when memory is short.
                pages = _table(folder / "memory.stat")
                cache = pages.get("active_file", 0) + pages.get("inactive_file", 0)
                yield int(most) - int(now) + min(cache, int(now))
            if folder == top:
                break


def _address_space(root: Path) -> Iterator[int]:
    try:
        import resource
    except ModuleNotFoundError:  # Windows
        return
    most = resource.getrlimit(resource.RLIMIT_AS)[0]
    if most != resource.RLIM_INFINITY:
        pages = _text(root / "proc/self/statm").split() or ["0"]
        yield most - int(pages[0]) * resource.getpagesize()


def _table(path: Path) -> dict[str, int]:
    """Return the numbers by name in a file with a name and a number on each line."""
    found = {}
    for line in _text(path).splitlines():
        row = line.split()
        if len(row) > 1 and row[1].isdecimal():
            found[row[0]] = int(row[1])
    return found


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8").strip()
    except OSError:
        return ""
