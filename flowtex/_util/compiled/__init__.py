"""Compiled loops, used where they are ready.

numba is optional, and takes seconds to compile, or half a second to load what it has compiled
before. What was compiled before is loaded when there is some work, and waited for. Otherwise it is
compiled in a thread once there has been much work, for that slows what runs beside it; until then,
and where it fails, NumPy does the same. In a forked process the thread is gone, so that what was
not ready stays so.
"""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

__all__ = ["kernels", "prepare"]

#: Paths that a process has followed when compiling is worth its time, and when loading is.
LARGE_WORK, SOME_WORK = 400_000, 40_000
#: Seconds that loading is waited for: a part may have to be compiled all the same.
LONGEST_WAIT_S = 2.0

_loaded: list[Any] = []
_paths = [0]
_begun = threading.Lock()


def prepare(size: int) -> threading.Thread | None:
    """Begin to load or to compile, once a process, when so many paths make its work large."""
    _paths[0] += size
    known = _paths[0] >= SOME_WORK and _is_compiled()
    if (not known and _paths[0] < LARGE_WORK) or not _begun.acquire(blocking=False):
        return None
    thread = threading.Thread(target=_load, name="flowtex-compile", daemon=True)
    thread.start()
    if known:
        thread.join(LONGEST_WAIT_S)
    return thread


def _is_compiled() -> bool:
    """Whether loops were compiled after they were written."""
    source = Path(__file__).with_name("loops.py")
    kept = source.parent.glob("__pycache__/loops.*.nbi")
    return any(path.stat().st_mtime > source.stat().st_mtime for path in kept)


def _load() -> None:
    try:
        from flowtex._util.compiled import loops as module
    except Exception:  # whatever numba or LLVM lack here, NumPy does the same
        return
    _loaded.append(module)


def kernels() -> Any:
    """Return :mod:`flowtex._util.compiled.loops` once it is compiled, before that ``None``."""
    return _loaded[0] if _loaded else None
