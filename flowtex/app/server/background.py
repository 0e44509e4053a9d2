"""Tasks that nobody waits for: their errors are seen all the same."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Coroutine
from typing import Any

__all__ = ["begin"]

_log = logging.getLogger(__name__)


def begin(work: Coroutine[Any, Any, None], failed: str) -> asyncio.Task[None]:
    """Begin a task in the event loop that runs.

    Parameters
    ----------
    work
        What is done.
    failed
        What the log says where it ends in an error.
    """
    task = asyncio.get_running_loop().create_task(work)

    def tell(ended: asyncio.Task[None]) -> None:
        if not ended.cancelled() and (error := ended.exception()) is not None:
            _log.error(failed, exc_info=error)

    task.add_done_callback(tell)
    return task
