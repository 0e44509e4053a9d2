"""Work in forked processes, which end with the test."""

from __future__ import annotations

import multiprocessing
import warnings
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Any

import pytest
from waiting import PATIENCE_S

HAS_FORKS = "fork" in multiprocessing.get_all_start_methods()
needs_forks = pytest.mark.skipif(not HAS_FORKS, reason="this system does not fork")


def forked(work: Callable[[], Any]) -> Any:
    """Return the result of work in a forked process, as text what it raises; fail if it hangs."""
    context: Any = multiprocessing.get_context("fork")
    ours, theirs = context.Pipe(duplex=False)
    process = context.Process(target=_answer, args=(work, theirs))
    with warnings.catch_warnings():
        # Python 3.12 and later warn of forks beside threads, which is what these tests are about.
        warnings.simplefilter("ignore", DeprecationWarning)
        process.start()
    theirs.close()
    try:
        assert ours.poll(PATIENCE_S), "the forked process hangs"
        result = ours.recv()
        process.join(PATIENCE_S)
        assert process.exitcode == 0, "the forked process does not end"
    finally:
        process.kill()
        process.join()
        process.close()
        ours.close()
    return result


def _answer(work: Callable[[], Any], theirs: Connection) -> None:
    try:
        theirs.send(work())
    except Exception as error:
        theirs.send(f"{type(error).__name__}: {error}")
