"""Waiting for what is to come, with one limit for all: it ends a test that waits in vain."""

from __future__ import annotations

import asyncio
import subprocess
import time
import urllib.request
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import pytest

#: Seconds that a slow and busy machine may take for anything. Nothing passes by being quicker.
PATIENCE_S = 180.0
#: The same for applications of others, which load for minutes beside other programs.
HOST_PATIENCE_S = 1200.0
INTERVAL_S = 0.005


def wait_until(
    holds: Callable[[], Any], seen: Callable[[], object] = lambda: "", limit: float | None = None
) -> Any:
    """Wait until a condition holds, and return its value; ``seen()`` is what a failure prints.

    The limit is that of all tests, or another number of seconds.
    """
    if limit is None:
        limit = PATIENCE_S
    end = time.monotonic() + limit
    while (start := time.monotonic()) < end:
        if found := holds():
            return found
        # What is costly to ask leaves as much time to what it waits for.
        time.sleep(max(INTERVAL_S, time.monotonic() - start))
    pytest.fail(f"waited {limit:g} s in vain; {seen()}")


def wait_until_served(
    address: str,
    process: subprocess.Popen[Any],
    log: Callable[[], str] = lambda: "",
    limit: float | None = None,
) -> None:
    """Wait until a server answers: some print their address before they listen."""

    def answers() -> bool:
        assert process.poll() is None, f"the server of {address} ended:\n{log()}"
        with suppress(OSError), urllib.request.urlopen(address, timeout=PATIENCE_S):
            return True
        return False

    wait_until(answers, log, limit)


async def until(holds: Callable[..., Any]) -> None:
    """Do the same in an event loop, which continues meanwhile."""
    async with asyncio.timeout(PATIENCE_S):
        while not holds():
            await asyncio.sleep(INTERVAL_S)
