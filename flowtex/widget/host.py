"""What a widget's threads need to reach the page in hosts that serve several people.

Solara and Shiny know by the context of a call which session it is for, and Shiny sends nothing
before its next flush.
"""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Callable
from contextlib import suppress
from contextvars import copy_context
from typing import Any


class Host:
    """The session in which it was made, as that of calls from any thread."""

    def __init__(self) -> None:
        self._context = copy_context()
        self._loop: asyncio.AbstractEventLoop | None = None
        with suppress(RuntimeError):
            self._loop = asyncio.get_running_loop()

    def call(self, function: Callable[..., Any], *arguments: Any) -> None:
        """Call a function in the session, and have sent what it sends."""
        # A context cannot be entered twice at one time.
        self._context.copy().run(function, *arguments)
        reactive = sys.modules.get("shiny.reactive")
        if reactive is None or self._loop is None or self._loop.is_closed():
            return

        async def flush() -> None:
            async with reactive.lock():
                await reactive.flush()

        asyncio.run_coroutine_threadsafe(flush(), self._loop)
