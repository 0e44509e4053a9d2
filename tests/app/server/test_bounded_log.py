"""Nobody can fill the log."""

from __future__ import annotations

import io
import logging
from collections.abc import Iterator

import pytest

pytest.importorskip("aiohttp")


from flowtex.app.server.site import (
    MESSAGE_LENGTH,
    MOST_RECORDS,
    WINDOW_S,
    RepeatFilter,
)


@pytest.fixture
def log() -> Iterator[tuple[logging.Logger, io.StringIO, list[float]]]:
    """A logger, what it has written, and the time."""
    logger, written, now = logging.getLogger("bounded"), io.StringIO(), [0.0]
    handler = logging.StreamHandler(written)
    handler.addFilter(RepeatFilter(lambda: now[0]))
    logger.addHandler(handler)
    logger.propagate = False
    yield logger, written, now
    logger.removeHandler(handler)


Log = tuple[logging.Logger, io.StringIO, list[float]]


def test_what_repeats_is_written_a_few_times_a_minute(log: Log) -> None:
    logger, written, now = log

    def fail(times: int) -> None:
        for number in range(times):
            logger.error("fault %d", number)

    fail(1000)
    assert written.getvalue().count("fault") == MOST_RECORDS
    logger.error("another")
    now[0] += WINDOW_S
    fail(1000)
    assert written.getvalue().count("fault") == 2 * MOST_RECORDS


def test_what_is_long_is_cut(log: Log) -> None:
    logger, written, _ = log
    try:
        raise ValueError("c" * 10**6)
    except ValueError:
        logger.exception("a" * 10**6 + "%s", "b" * 10**6)
    assert len(written.getvalue()) < 2 * MESSAGE_LENGTH + 20
    assert "Traceback" in written.getvalue()
