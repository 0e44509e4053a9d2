"""What runs in children that tests start: it answers, crashes, hangs, or takes too much."""

from __future__ import annotations

import ctypes
import json
import os
import struct
import threading
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util.child.worker import Answer
from flowtex._util.progress import check


class Handler:
    """What runs in the children of these tests."""

    def __init__(self) -> None:
        self._count = 0

    def __call__(self, value: Any) -> Answer:
        self._count += 1
        answer: Answer = getattr(self, value["do"])(**{k: v for k, v in value.items() if k != "do"})
        return answer

    def sum(self, one: int, other: int) -> Answer:
        return {"sum": one + other, "pid": os.getpid(), "count": self._count}, []

    def arrays(self, count: int) -> Answer:
        return None, [np.arange(count) * 0.5, np.eye(3, dtype=bool)[:, ::2], np.empty((0, 2))]

    def crash(self) -> Answer:
        ctypes.string_at(0)
        return None, []

    def exit(self) -> Answer:
        os._exit(3)

    def hang(self) -> Answer:
        threading.Event().wait()
        return None, []

    def wait(self, path: str) -> Answer:
        """Touch a file, and wait to be cancelled."""
        Path(path).touch()
        while True:
            check()

    def allocate(self, size: int) -> Answer:
        return len(np.ones(size, np.uint8)), []

    def fail(self) -> Answer:
        return {}["missing\x1b[31m"], []

    def lie(self, size: int) -> Answer:
        header = json.dumps({"value": {"number": 1}, "arrays": [["<f8", [size]]]}).encode()
        for pipe in range(3, 64):  # whichever is that of the answers
            try:
                os.write(pipe, struct.pack(">I", len(header)) + header)
            except OSError:
                continue
        return None, []
