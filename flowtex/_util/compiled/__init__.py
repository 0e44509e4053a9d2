"""Compiled loops, used where they are ready, and never waited for.

numba is optional, and takes seconds to compile, or half a second to load what it has compiled
before. Both happen in a thread once there has been much work, for they slow what runs beside them;
until then, and where it fails, NumPy does the same. In a forked process the thread is gone, so that
what was not ready stays so.
"""

from __future__ import annotations

import threading
from typing import Any

__all__ = ["kernels", "prepare"]

#: Paths that a process has followed when compiling is worth its time.
LARGE_WORK = 400_000

_loaded: list[Any] = []
_paths = [0]
_begun = threading.Lock()


def prepare(size: int) -> threading.Thread | None:
    """Begin to compile, once a process, when so many paths make its work large."""
    _paths[0] += size
    if _paths[0] < LARGE_WORK or not _begun.acquire(blocking=False):
        return None
    thread = threading.Thread(target=_load, name="flowtex-compile", daemon=True)
    thread.start()
    return thread


def _load() -> None:
    try:
        from flowtex._util.compiled import loops as module
    except Exception:  # whatever numba or LLVM lack here, NumPy does the same
        return
    _loaded.append(module)


def kernels() -> Any:
    """Return :mod:`flowtex._util.compiled.loops` once it is compiled, before that ``None``."""
    return _loaded[0] if _loaded else None
