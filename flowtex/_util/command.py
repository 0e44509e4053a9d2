"""The program ``flowtex`` around its command: Ctrl-C ends it quietly, with the code of the signal.

This is imported before all that is slow to load, so it imports only what Python has loaded.
"""

from __future__ import annotations

import atexit
import os
import signal
import sys
from contextlib import suppress
from typing import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    from types import FrameType

#: Name of the program, and of the module that runs as it.
PROGRAM = "flowtex"
#: Name of the file of Python's imports.
IMPORTS = "<frozen importlib._bootstrap>"
#: Exit codes of the signals that have asked the program to end.
_codes: list[int] = []


def is_command() -> bool:
    """Return whether this process runs the program, as a script or as ``python -m flowtex``."""
    words = sys.orig_argv
    for number, word in enumerate(words[1:], start=1):
        if words[number - 1] == "-m":
            return word == PROGRAM
    # pathlib is not loaded yet.
    for word in words[:2]:
        name = word.replace(os.sep, "/").rpartition("/")[2]
        if name in (PROGRAM, f"{PROGRAM}.exe"):
            return True
    return False


def note_end(code: int, frame: FrameType | None) -> None:
    """Note that a signal ends the program with a code, and end it at once during an import.

    An error would pass through libraries that are half loaded, of which some crash then.
    """
    _codes.append(code)
    if not is_command():
        return
    while frame is not None:
        if frame.f_code.co_filename == IMPORTS:
            atexit._run_exitfuncs()  # the last of them ends the process
        frame = frame.f_back


def _end(number: int, _: object) -> NoReturn:
    # Nothing is to be removed yet.
    os._exit(128 + number)


def _leave() -> None:
    """End with the code of a signal, after temporary folders were removed.

    VTK ends the program where the error of the signal passes through one of its callbacks. It
    would then crash in some runs, as Python removes what VTK is still drawing.
    """
    if not _codes:
        # The command is complete; Python would give Ctrl-C its default effect from here on.
        with suppress(ValueError):
            signal.signal(signal.SIGINT, signal.SIG_IGN)
        return
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError):  # the terminal may be gone
            stream.flush()
    os._exit(_codes[0])


def _prepare() -> None:
    atexit.register(_leave)  # runs after all that are registered later
    if signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        return
    with suppress(ValueError):  # in another thread than the main one
        signal.signal(signal.SIGINT, _end)


if is_command():
    _prepare()
