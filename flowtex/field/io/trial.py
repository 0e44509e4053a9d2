"""Files are tried in a process of their own where a broken one would end this one.

VTK's readers of EnSight and Exodus, and the library of CGNS, crash, hang or leave the program on
some files that are cut off or damaged, as those of a solver that is still writing. A server would
go with all its pages.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import warnings
from functools import lru_cache
from pathlib import Path

from flowtex.errors import FieldError
from flowtex.field.io.meshes import times_of
from flowtex.field.io.reader_errors import errors_of_file
from flowtex.field.io.readers import open_reader

__all__ = ["main", "try_reading"]

#: Endings of files that are tried.
FRAGILE = {".case", ".cgns", ".e", ".ex2", ".exii", ".exo"}
#: A trial may last so long, and longer where there is much to read.
TRIAL_TIMEOUT_S, BYTES_PER_S = 20.0, 10e6
#: Exit status of a trial that says what is wrong.
TOLD = 3
_PROGRAM = (
    "import json, sys; sys.path[:] = json.loads(sys.argv[1]); "
    "from flowtex.field.io.trial import main; sys.exit(main(sys.argv[2]))"
)


def try_reading(file: Path) -> None:
    """Read a file in another process; raise a FieldError where that ends badly.

    Files are tried once, and only those of formats whose readers are known to crash.
    """
    if file.suffix.lower() not in FRAGILE or not sys.executable:
        return
    state = file.stat()
    if fault := _fault(file.resolve(), state.st_mtime_ns, state.st_size):
        raise FieldError(fault)


@lru_cache(maxsize=64)
def _fault(file: Path, _changed: int, _size: int) -> str:
    """Return what is wrong with a file, by its time of change; empty where nothing is."""
    # The data of EnSight are in other files beside it.
    content = sum(p.stat().st_size for p in file.parent.iterdir() if p.is_file())
    command = [sys.executable, "-I", "-c", _PROGRAM, json.dumps(sys.path), str(file)]
    timeout = TRIAL_TIMEOUT_S + content / BYTES_PER_S
    try:
        trial = subprocess.run(command, capture_output=True, timeout=timeout, check=False)
    except subprocess.TimeoutExpired:
        return f"the file is broken or incomplete: its reader did not end within {timeout:.0f} s"
    if trial.returncode == TOLD:
        return str(json.loads(trial.stdout.decode().splitlines()[-1]))
    if trial.returncode != 0:
        return f"the file is broken or incomplete: its reader crashes ({trial.returncode})"
    return ""


def main(path: str) -> int:
    """Read all times of a file, in a trial; print what is wrong as JSON, and return the status."""
    # What C libraries print is for nobody.
    devices = os.open(os.devnull, os.O_WRONLY)
    os.dup2(devices, 2)
    file = Path(path)
    try:
        with warnings.catch_warnings(), errors_of_file(file):
            warnings.simplefilter("ignore")
            reader = open_reader(file)
            for time in times_of(reader):
                reader.set_active_time_value(time)
                reader.read()
            reader.read()
    except FieldError as error:
        sys.stdout.write("\n" + json.dumps(str(error).removeprefix(f"{file}: ")) + "\n")
        return TOLD
    return 0
