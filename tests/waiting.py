"""Waiting for what is to come, with one limit for all: it ends a test that waits in vain."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from typing import Any

#: Seconds that a slow and busy machine may take for anything. Nothing passes by being quicker.
PATIENCE_S = 180.0
INTERVAL_S = 0.005


def wait_until(holds: Callable[[], Any], seen: Callable[[], object] = lambda: "") -> Any:
    """Wait until a condition holds, and return its value; ``seen()`` is what a failure prints."""
    end = time.monotonic() + PATIENCE_S
    while not (found := holds()):
        assert time.monotonic() < end, f"waited {PATIENCE_S:g} s in vain; {seen()}"
        time.sleep(INTERVAL_S)
    return found


async def until(holds: Callable[..., Any]) -> None:
    """Do the same in an event loop, which continues meanwhile."""
    async with asyncio.timeout(PATIENCE_S):
        while not holds():
            await asyncio.sleep(INTERVAL_S)
