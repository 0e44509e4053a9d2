"""Threads where there are some, and the calling one where there are none."""

from __future__ import annotations

import io
import re
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

import flowtex
from flowtex._util import progress

PACKAGE = Path(flowtex.__file__).parent
#: Where threads are made otherwise: they serve or end processes, and keep stores.
OTHERS = ("app", "_util/progress.py", "_util/child")


@pytest.fixture
def _no_threads(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    def refuse(_: threading.Thread) -> None:
        msg = "can't start new thread"
        raise RuntimeError(msg)

    with monkeypatch.context() as patch:
        patch.setattr(threading.Thread, "start", refuse)
        progress._knows_threads.cache_clear()
        yield
    progress._knows_threads.cache_clear()


@pytest.mark.usefixtures("_no_threads")
def test_without_threads_the_caller_does_it_at_once() -> None:
    done: list[str] = []
    progress.start(lambda: done.append(threading.current_thread().name), "a thread")
    assert done == [threading.current_thread().name]
    with progress.pool(4, "threads") as pool:
        assert list(pool.map(abs, [-1, -2])) == [1, 2]
        wrong = pool.submit(int, "two")
        assert wrong.done()
        with pytest.raises(ValueError, match="two"):
            wrong.result()


def test_whatever_a_browser_runs_asks_here_for_threads() -> None:
    files = [path for path in PACKAGE.rglob("*.py")]
    made = {
        path.relative_to(PACKAGE).as_posix()
        for path in files
        if re.search(r"\b(Thread|ThreadPoolExecutor)\(", path.read_text(encoding="utf-8"))
    }
    assert {name for name in made if not name.startswith(OTHERS)} == set()


def test_a_bar_that_nobody_sees_is_not_made(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[bool] = []

    class Bar:
        def add_task(self, text: str, total: int) -> int:
            return len(text) + total

        def start(self) -> None:
            made.append(True)

        def update(self, task: int, completed: int) -> None:
            pass

        def stop(self) -> None:
            pass

    monkeypatch.setattr(progress, "_bar", Bar)
    monkeypatch.setattr(progress, "BAR_DELAY_S", -1.0)
    for name in ("FORCE_COLOR", "TTY_COMPATIBLE"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.delitem(sys.modules, "IPython", raising=False)
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    assert list(progress.track("ab", 2, "Reading")) == ["a", "b"]
    monkeypatch.setattr(sys, "stderr", None)
    assert list(progress.track("ab", 2, "Reading")) == ["a", "b"]
    assert made == []
    monkeypatch.setenv("FORCE_COLOR", "1")
    assert list(progress.track("ab", 2, "Reading")) == ["a", "b"]
    assert made == [True]
