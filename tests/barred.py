"""A platform like Python in a browser: without VTK, PyVista, threads and processes.

Zarr is not there either, as it reads in a thread of its own.

``FLOWTEX_BARRED=1 pytest`` runs the tests there. A test that needs one of these itself, or by
a room of the package whose business it is, is skipped; where any other room asks for it, it fails.
"""

from __future__ import annotations

import errno
import multiprocessing.process
import os
import re
import subprocess
import sys
import threading
import traceback
from pathlib import Path
from typing import Any, NoReturn

import waiting

OWN = Path(__file__)
TESTS = OWN.parent
PACKAGE = TESTS.parent / "flowtex"
WANTED = bool(os.environ.get("FLOWTEX_BARRED"))
VTK = ("vtk", "vtkmodules", "pyvista")
NAMES = (*VTK, "zarr")
#: Modules that import VTK or PyVista when they load, and all that use what is barred.
LOAD_VTK = ("rendering.vtk", "plotting", "app")
ROOMS = (
    *(*LOAD_VTK, "cli", "examples", "host.show", "pyramid", "rendering.diagnostics", "sources"),
    "trace.structure",
)
HELPERS = ("", "_util.child", "errors")  #: What asks for them for these rooms.


def module_name(path: Path) -> str:
    """Return ``rendering.vtk.actor`` for ``flowtex/rendering/vtk/actor.py``, "" for the package."""
    parts = path.relative_to(PACKAGE).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def is_in(name: str, rooms: tuple[str, ...]) -> bool:
    """Return whether a module is one of the rooms, or inside one."""
    return any(name == room or name.startswith(f"{room}.") for room in rooms)


class BarredThreadError(RuntimeError):
    """As Pyodide raises it."""


class BarredProcessError(OSError):
    """As Pyodide raises it."""


def _no_thread(*_: Any, **__: Any) -> NoReturn:
    msg = "can't start new thread"
    raise BarredThreadError(msg)


def _no_end(*_: Any, **__: Any) -> NoReturn:
    msg = "nothing ends this, as there are no threads; mark the test with threads if it needs them"
    raise RuntimeError(msg)


def _no_process(*_: Any, **__: Any) -> NoReturn:
    raise BarredProcessError(errno.ENOTSUP, "emscripten does not support processes.")


def bar() -> None:
    """Refuse all of these from now on."""
    for name in NAMES:
        sys.modules[name] = None  # type: ignore[assignment]
    replaced: Any = [threading.Thread, multiprocessing.process.BaseProcess]
    for kind, refusal in zip(replaced, (_no_thread, _no_process), strict=True):
        kind.start = refusal
    os.environ["DASK_SCHEDULER"] = "sync"  # as Dask chooses there
    waiting.PATIENCE_S = 5.0  # what is not done at once is never done
    waited: Any = threading.Condition
    waited.wait = _no_end
    process: Any = subprocess.Popen
    process.__init__ = os.fork = _no_process


def needs_them(file: Path) -> bool:
    """Whether a file of tests loads one of these with itself."""
    names = "|".join((*NAMES, "plain_pyvista"))
    text = file.read_text(encoding="utf-8")
    return re.search(rf"^(import|from) ({names})\b", text, re.MULTILINE) is not None


def asker_of(error: BaseException | None) -> str:
    """Return which file that may do so has asked for what is barred; empty for another error."""
    frames: list[traceback.FrameSummary] = []
    while error is not None:
        frames += traceback.extract_tb(error.__traceback__)
        name = (getattr(error, "name", None) or "").split(".")[0]
        missing = isinstance(error, ModuleNotFoundError) and name in NAMES
        if missing or isinstance(error, BarredThreadError | BarredProcessError):
            files = (Path(frame.filename) for frame in reversed(frames))
            asking = next((file for file in files if _asks(file)), OWN)
            allowed = PACKAGE not in asking.parents or is_in(module_name(asking), ROOMS)
            return asking.name if allowed else ""
        error = error.__cause__ or error.__context__
    return ""


def _asks(file: Path) -> bool:
    """Whether a file is one of the package or of the tests, and no helper."""
    if PACKAGE in file.parents:
        return not is_in(module_name(file), HELPERS)
    return TESTS in file.parents and file != OWN
