"""Children: what they answer, and what becomes of those that crash, hang or take too much."""

from __future__ import annotations

import io
import os
import signal
import struct
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from child_handler import is_gone
from waiting import PATIENCE_S, wait_until

from flowtex._util.child.child import FORKS, Child, ChildError
from flowtex._util.child.worker import read_message, write_message
from flowtex._util.progress import Stopped, stoppable

ENTRY = "child_handler:Handler"
MB = 1_000_000


@pytest.fixture(params=[True, False] if FORKS else [False], ids=lambda forks: f"forks={forks}")
def start(request: pytest.FixtureRequest) -> Iterator[Callable[..., Child]]:
    children: list[Child] = []

    def started(**options: Any) -> Child:
        children.append(Child(ENTRY, forks=request.param, **options))
        return children[-1]

    yield started
    for child in children:
        child.close()


@pytest.fixture(params=[FORKS])
def child(request: pytest.FixtureRequest) -> Iterator[Child]:
    child = Child(ENTRY, memory=600 * MB)
    yield child
    child.close()


def ask(child: Child, do: str, *, timeout: float = PATIENCE_S, **values: Any) -> Any:
    return child.request({"do": do, **values}, timeout=timeout)


def died(child: Child, do: str, **values: Any) -> str:
    with pytest.raises(ChildError) as caught:
        ask(child, do, **values)
    return str(caught.value)


def test_a_child_answers_in_a_process_of_its_own(start: Callable[..., Child]) -> None:
    child = start()
    first, arrays = ask(child, "sum", one=2, other=3)
    assert first["sum"] == 5 and first["pid"] != os.getpid() and arrays == []
    again, _ = ask(child, "sum", one=2, other=3)
    assert (again["pid"], again["count"]) == (first["pid"], 2)
    _, (half, some, none) = ask(child, "arrays", count=100_000)
    np.testing.assert_array_equal(half, np.arange(100_000) * 0.5)
    np.testing.assert_array_equal(some, np.eye(3, dtype=bool)[:, ::2])
    assert none.shape == (0, 2) and child.alive


def test_the_end_of_a_child_is_told(start: Callable[..., Child]) -> None:
    assert died(start(), "exit") == "ended (status 3)"
    crashed = start()
    assert died(crashed, "crash") == "crashed (SIGSEGV)"
    assert not crashed.alive
    assert died(crashed, "sum", one=1, other=1) == "crashed (SIGSEGV)"
    hung = start()
    pid = ask(hung, "sum", one=1, other=1)[0]["pid"]
    assert died(hung, "hang", timeout=0.2) == "did not end within 0 s"
    wait_until(lambda: is_gone(pid))


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux has a limit of a process's data")
def test_a_child_has_the_memory_that_it_may_have(start: Callable[..., Child]) -> None:
    child = start(memory=300 * MB)
    assert ask(child, "allocate", size=100 * MB)[0] == 100 * MB
    assert died(child, "allocate", size=1000 * MB) == "needs more than 0.3 GB of memory"
    assert ask(child, "allocate", size=100 * MB)[0] == 100 * MB


def test_an_error_says_what_is_wrong(child: Child) -> None:
    with pytest.raises(ChildError, match="missing") as caught:
        ask(child, "fail")
    assert caught.value.kind == "KeyError"
    assert "in fail" in caught.value.trace and "\x1b" not in caught.value.trace
    assert ask(child, "sum", one=1, other=1)[0]["sum"] == 2


def test_what_is_cancelled_ends_and_the_child_lives_on(child: Child, tmp_path: Path) -> None:
    pid = ask(child, "sum", one=1, other=1)[0]["pid"]
    started = tmp_path / "started"
    with pytest.raises(Stopped), stoppable(started.exists):
        ask(child, "wait", path=str(started))
    again, _ = ask(child, "sum", one=1, other=1)
    assert (again["pid"], again["count"]) == (pid, 3)


def test_what_was_cancelled_and_hangs_is_ended(child: Child) -> None:
    pid = ask(child, "sum", one=1, other=1)[0]["pid"]
    cancelled = threading.Event()
    cancelled.set()
    for _ in range(3):
        with pytest.raises(Stopped), stoppable(cancelled.is_set):
            ask(child, "hang", timeout=0.2)
    assert died(child, "sum", one=1, other=1).startswith("did not end within")
    wait_until(lambda: is_gone(pid))


def test_threads_take_turns(child: Child) -> None:
    sums: list[int] = []

    def add(n: int) -> None:
        sums.append(ask(child, "sum", one=n, other=n)[0]["sum"])

    threads = [threading.Thread(target=add, args=(n,)) for n in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(sums) == [2 * n for n in range(8)]


@pytest.mark.parametrize("size", [10**15, 10**30])
def test_a_child_that_sends_what_it_cannot_have_is_ended(child: Child, size: int) -> None:
    assert died(child, "lie", size=size).startswith("sent a malformed answer: a message declares")
    assert not child.alive


def test_a_child_ends_with_its_object(start: Callable[..., Child]) -> None:
    child = start()
    pid = ask(child, "sum", one=1, other=1)[0]["pid"]
    child.close()
    wait_until(lambda: is_gone(pid))
    assert died(child, "sum", one=1, other=1) == "was ended"


PARENT = """
import sys, time
sys.path[:0] = sys.argv[1:3]
from flowtex._util.child.child import Child
child = Child("child_handler:Handler", forks=sys.argv[3] == "True")
print(child.request({"do": "sum", "one": 1, "other": 1}, timeout=100)[0]["pid"], flush=True)
print(child.request({"do": "store"}, timeout=100)[0], flush=True)
child.request({"do": "hang"}, timeout=1000)
"""


@pytest.mark.parametrize("forks", [True, False] if FORKS else [False])
def test_a_child_ends_with_its_parent_however_that_ends(forks: bool) -> None:
    folders = [str(Path(__file__).parents[n]) for n in (1, 2)]
    with subprocess.Popen(
        [sys.executable, "-c", PARENT, *folders, str(forks)], stdout=subprocess.PIPE
    ) as parent:
        assert parent.stdout is not None
        pid = int(parent.stdout.readline())
        folder = Path(parent.stdout.readline().decode().strip())
        assert not is_gone(pid) and folder.is_dir()
        parent.send_signal(signal.SIGKILL)
        wait_until(lambda: is_gone(pid))
    assert not folder.exists(), "its temporary folder goes with it"


def test_children_have_loaded_what_is_preloaded() -> None:
    child = Child(ENTRY, preload=("wave", "there_is_no_such_module"))
    try:
        assert ask(child, "sum", one=1, other=1)[0]["sum"] == 2
    finally:
        child.close()


# --- messages ---------------------------------------------------------------------------------


def message(header: bytes, rest: bytes = b"") -> io.BufferedReader:
    raw: Any = io.BytesIO(struct.pack(">I", len(header)) + header + rest)
    return raw  # type: ignore[no-any-return]


@pytest.mark.parametrize(
    ("header", "fault"),
    [
        (b"{", "malformed"),
        (b"[]", "malformed"),
        (b"\xff\xfe", "malformed"),
        (b"[" * 200_000, "malformed"),
        (b'{"value": 1}', "malformed"),
        (b'{"value": 1, "arrays": [["|O", [1]]]}', "malformed: the type '|O' of an array"),
        (b'{"value": 1, "arrays": [["<M8[s]", [1]]]}', "malformed: the type '<M8"),
        (b'{"value": 1, "arrays": [["<f8", [-1]]]}', r"malformed: the shape \[-1\] of an array"),
        (b'{"value": 1, "arrays": [["<f8", [true]]]}', "malformed: the shape"),
        (b'{"value": 1, "arrays": [["<f8", [1e3]]]}', "malformed: the shape"),
        (b'{"value": 1, "arrays": [["<f8", [99, 99]]]}', "declares 78,408 bytes of arrays"),
    ],
)
def test_what_is_no_message_is_refused(header: bytes, fault: str) -> None:
    with pytest.raises(ValueError, match=fault.replace("|", r"\|")):
        read_message(message(header), 1000)


def test_a_header_that_is_too_long_is_refused() -> None:
    with pytest.raises(ValueError, match="4,294,967,295 bytes"):
        read_message(io.BytesIO(b"\xff" * 100), 1000)
    with pytest.raises(ValueError, match="expected 16,000,000"):
        write_message(io.BytesIO(), "x" * 16_000_000)


def test_a_message_that_ends_early_is_none() -> None:
    stream = io.BytesIO()
    write_message(stream, {"a": [1, None]}, [np.arange(6.0).reshape(2, 3)])
    whole = stream.getvalue()
    value, (array,) = read_message(io.BytesIO(whole), 48) or (None, [])
    assert value == {"a": [1, None]} and array.tolist() == [[0, 1, 2], [3, 4, 5]]
    for length in (0, 3, 10, len(whole) - 1):
        assert read_message(io.BytesIO(whole[:length]), 48) is None
