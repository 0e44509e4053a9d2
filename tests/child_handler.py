"""What runs in children that tests start: it answers, crashes, hangs, or takes too much."""

from __future__ import annotations

import ctypes
import json
import os
import struct
import threading
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util.child.worker import Answer
from flowtex._util.progress import check
from flowtex._util.whole_file import TemporaryFolder
from flowtex.errors import notify
from flowtex.sources.remote import Reader


def is_gone(pid: int | str) -> bool:
    """Whether a process has ended."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


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

    def store(self) -> Answer:
        """Have a temporary folder until this process ends, and return its path."""
        self._folder = TemporaryFolder()
        (self._folder.new_folder() / "file").write_text("x")
        return str(self._folder.path), []

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
        words: dict[str, int] = {}
        return words["missing\x1b[31m"], []

    def lie(self, size: int) -> Answer:
        header = json.dumps({"value": {"number": 1}, "arrays": [["<f8", [size]]]}).encode()
        for pipe in range(3, 64):  # whichever is that of the answers
            try:
                os.write(pipe, struct.pack(">I", len(header)) + header)
            except OSError:
                continue
        return None, []


class TrickyReader(Reader):
    """A reader of files that does what it is told."""

    def do_trick(self, level: str) -> Answer:
        """Return the number of this process, change the file, or end badly."""
        if level == "crash":
            ctypes.string_at(0)
        elif level == "hang":
            threading.Event().wait()
        elif level == "fail":
            msg = "\x1b[31mwords"
            raise KeyError(msg)
        elif level == "warn":
            notify("something was chosen")
            warnings.warn("odd", stacklevel=1)
        return str(os.getpid()), []

    def do_step(self, steps: int, number: int) -> Answer:
        """Read a step, but for the third."""
        return self.do_trick("crash") if number == 2 else super().do_step(steps, number)


class ChangingReader(Reader):
    """A reader whose file has changed once it is read, as often as is said in it."""

    def do_open(self, paths: list[str]) -> Answer:
        """Open a file, and add to it."""
        answer = super().do_open(paths)
        state = Path(paths[0]).with_suffix(".count")
        left = int(state.read_text())
        if left:
            state.write_text(str(left - 1))
            Path(paths[0]).write_text(Path(paths[0]).read_text() + "\n")
        return answer


class GreedyReader(Reader):
    """A reader that needs more memory than there is."""

    def do_open(self, paths: list[str]) -> Answer:
        """Take a lot."""
        np.ones(10**13, np.uint8)
        return super().do_open(paths)
