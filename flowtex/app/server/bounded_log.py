"""A log of limited size: a fault is written a few times a minute, and at a length."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from aiohttp import web
from aiohttp.http_exceptions import HttpProcessingError

#: Records of one place in the code that are written in a window, and its seconds.
MOST_RECORDS, WINDOW_S = 5, 60.0
#: Characters of a message, and of a traceback with it.
MESSAGE_LENGTH, TRACEBACK_LENGTH = 2_000, 8_000
#: Errors caused by clients, whose tracebacks are not logged.
OTHERS_FAULTS = HttpProcessingError, web.RequestPayloadError


class RepeatFilter(logging.Filter):
    """Drops repeated records, and shortens long ones; ``clock`` is in seconds."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        super().__init__()
        self._clock = clock
        self._formatter = logging.Formatter()
        #: For each place in the code: when its window began, and its records since.
        self._windows: dict[object, tuple[float, int]] = {}

    def filter(self, record: logging.LogRecord) -> bool:
        """Return whether a record is written; cut it, and keep tracebacks of defects only."""
        kind = record.exc_info[0] if record.exc_info else None
        place, now = (record.pathname, record.lineno, kind), self._clock()
        began, count = self._windows.get(place, (now, 0))
        dropped = 0
        if now - began >= WINDOW_S:
            dropped, began, count = max(0, count - MOST_RECORDS), now, 0
        self._windows[place] = began, count + 1
        if count >= MOST_RECORDS:
            return False
        message = _cut(record.getMessage(), MESSAGE_LENGTH)
        record.msg = f"{message} ({dropped:,} more were dropped)" if dropped else message
        record.args = ()
        if kind and issubclass(kind, OTHERS_FAULTS):
            record.exc_info = record.exc_text = None
        if record.exc_info:
            text = self._formatter.formatException(record.exc_info)
            record.exc_text = _cut(text, TRACEBACK_LENGTH)
        return True


def _cut(text: str, most: int) -> str:
    """Return a text without its middle where it is long."""
    return text if len(text) <= most else f"{text[: most // 2]} … {text[-most // 2 :]}"


@contextmanager
def bounded_log() -> Iterator[None]:
    """Filter the log of this process, including that of libraries."""
    handlers = logging.getLogger().handlers or [logging.lastResort or logging.NullHandler()]
    repeats = RepeatFilter()
    for handler in handlers:
        handler.addFilter(repeats)
    try:
        yield
    finally:
        for handler in handlers:
            handler.removeFilter(repeats)
