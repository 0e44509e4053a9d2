"""A progress bar for work that turns out to last longer than a second.

The bar is drawn by rich, in a terminal or a notebook, and only once the first second has passed,
so short work stays silent. Where rich is missing or nothing can be drawn there is no bar.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from typing import TypeVar

__all__ = ["track"]

T = TypeVar("T")

#: Seconds of silence before a bar appears.
PATIENCE = 1.0


def track(items: Iterable[T], total: int, text: str, *, show: bool = True) -> Iterator[T]:
    """Give the items one by one, with a progress bar once they have taken a second."""
    started = time.monotonic()
    bar = None
    try:
        for done, item in enumerate(items):
            if show and bar is None and time.monotonic() - started > PATIENCE:
                bar = _Bar(text, total)
            if bar is not None:
                bar.move(done)
            yield item
    finally:
        if bar is not None:
            bar.close(total)


class _Bar:
    """A rich progress bar, or nothing where rich is not installed."""

    def __init__(self, text: str, total: int) -> None:
        try:
            from rich.console import Console
            from rich.progress import Progress
        except ImportError:
            self._progress = None
            return
        self._progress = Progress(console=Console(stderr=True), transient=True)
        self._task = self._progress.add_task(text, total=total)
        self._progress.start()

    def move(self, done: int) -> None:
        if self._progress is not None:
            self._progress.update(self._task, completed=done)

    def close(self, total: int) -> None:
        if self._progress is not None:
            self._progress.update(self._task, completed=total)
            self._progress.stop()
            self._progress = None
