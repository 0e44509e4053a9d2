"""Files read in processes of their own, which they may crash, and what each has."""

from __future__ import annotations

import hashlib
import json
import os
import signal
import subprocess
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NoReturn

__all__ = ["CRASHED", "read_all"]

#: What is said of a file whose reader ended its process.
CRASHED = "crashed"
#: Bytes of addresses that a process may take, and seconds for all of its files.
MEMORY_BYTES, TIMEOUT_S = 8 << 30, 600
#: Seconds of processor time for a file.
PROCESSOR_S = 20.0


def read_all(paths: Sequence[Path]) -> list[str]:
    """Return of each file a digest of its flow, the error with its class, or :data:`CRASHED`."""
    names = "\n".join(map(str, paths)).encode()
    command = [sys.executable, __file__]
    done = subprocess.run(
        command, input=names, stdout=subprocess.PIPE, check=True, timeout=TIMEOUT_S
    )
    return [json.loads(line) for line in done.stdout.splitlines() if line[:1] == b'"']


def _main() -> None:
    """Read the files that standard input names; where one crashes, another process goes on."""
    import pyvista
    import xarray

    import flowtex.field.remote.reader

    del pyvista, xarray, flowtex
    paths = sys.stdin.read().splitlines()
    while paths:
        counted, told = os.pipe()
        if (process := os.fork()) == 0:
            os.close(counted)
            _read(paths, told)
        os.close(told)
        with os.fdopen(counted, "rb") as pipe:
            done = len(pipe.read())
        os.waitpid(process, 0)
        if done < len(paths):
            sys.stdout.write(f"\n{json.dumps(CRASHED)}\n")
            sys.stdout.flush()
            done += 1
        paths = paths[done:]


def _read(paths: Sequence[str], told: int) -> NoReturn:
    import resource

    import numpy as np

    from flowtex import FlowField
    from flowtex.field.datasets.files import is_dataset_file

    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    warnings.simplefilter("ignore")
    for path in paths:
        # A reader that goes round for ever is ended.
        signal.setitimer(signal.ITIMER_VIRTUAL, PROCESSOR_S)
        globe: dict[str, Any] = {"globe": True} if is_dataset_file(Path(path)) else {}
        try:
            field = FlowField.from_file(path, **globe)
            data = field.points.tobytes() + np.asarray(field.velocity).tobytes()
            result = hashlib.sha256(data).hexdigest()
        except Exception as error:
            result = f"{type(error).__name__}: {error}"
        # A reader may have left a line unended.
        sys.stdout.write(f"\n{json.dumps(result)}\n")
        sys.stdout.flush()
        os.write(told, b".")
    os._exit(0)


if __name__ == "__main__":
    _main()
