"""The compiled integrator, used where it is ready, and never waited for.

numba is optional, and takes seconds to compile, or half a second to load what it has compiled
before. Both happen in a thread beside the first large work; until then, and where it fails, paths
are followed by NumPy. In a forked process the thread is gone, so that what was not ready stays so.
"""

from __future__ import annotations

import threading
from collections.abc import Callable

import numpy as np

from flowtex._util.array_types import Floats, Floats32, Indices
from flowtex.trace.integrate import MOST, RULES
from flowtex.trace.sampler import Sampler

__all__ = ["follow", "prepare"]

#: Paths for which compiling is worth its time.
LARGE_PATHS = 100_000

_kernels: list[Callable[..., None]] = []
_begun = threading.Lock()


def prepare(paths: int) -> threading.Thread | None:
    """Begin to compile, once a process, when there are many paths to follow."""
    if paths < LARGE_PATHS or not _begun.acquire(blocking=False):
        return None
    thread = threading.Thread(target=_load, name="flowtex-compile", daemon=True)
    thread.start()
    return thread


def _load() -> None:
    try:
        from flowtex.trace.kernels import follow as kernel
    except Exception:  # whatever numba or LLVM lack here, NumPy does the same
        return
    _kernels.append(kernel)


def follow(
    sampler: Sampler,
    nodes: Indices,
    lags: Floats,
    unit: Floats,
    direction: float,
    tolerance: float,
    moved: Floats32,
    reach: Floats32,
) -> bool:
    """Follow particles from nodes (N,), and tell whether that was possible.

    Arguments are those of :func:`flowtex.trace.integrate.integrate`; displacements are written to
    ``moved`` (2, M, J * I), reaches to (J * I,).
    """
    if not _kernels or not sampler.plain:
        return False
    grid = sampler.grid
    _kernels[0](
        (grid.rows, grid.columns, *grid.periodic),
        grid.room,
        (sampler.nodal, sampler.times, sampler.destination, direction, sampler.floor),
        (tolerance, *RULES),
        MOST,
        nodes,
        np.array(lags),
        unit,
        sampler.rest(unit, float(lags[-1])),
        sampler.longest,
        moved,
        reach,
    )
    return True
