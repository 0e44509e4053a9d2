"""When pictures are sent, and when not."""

from __future__ import annotations

import asyncio
from functools import partial
from types import SimpleNamespace
from typing import Any, Literal

import numpy as np
import pytest
from waiting import until

pytest.importorskip("trame_rca")


from flowtex.app import FlowApp

pytestmark = pytest.mark.usefixtures("opengl")


class Streamer:
    """Stands for trame-rca's, and keeps what is sent."""

    def __init__(self) -> None:
        self.sent: list[dict[str, Any]] = []
        self.coreServer = SimpleNamespace(network_monitor=SimpleNamespace(pending=0))

    def has(self, count: int) -> bool:
        return len(self.sent) >= count

    def push_content(self, name: str, meta: dict[str, Any], content: bytes) -> None:
        assert content[:2] == b"\xff\xd8"
        self.sent.append({"name": name, **meta})


class Wake(asyncio.Event):
    """An event that tells whether somebody waits for it."""

    waiting = False

    async def wait(self) -> Literal[True]:
        self.waiting = True
        try:
            return await super().wait()
        finally:
            self.waiting = False


def test_pictures_come_until_rest_and_then_no_more(flat: FlowApp) -> None:
    stream, streamer = flat.stream, Streamer()
    flat.area.reset_camera()

    async def watch() -> None:
        stream._wake = wake = Wake()
        stream.set_streamer(streamer)
        task = asyncio.create_task(stream.run())
        for count in (1, 2, 3):
            # Many requests at once are one picture.
            stream.moved()
            stream.moved()
            await until(partial(streamer.has, count))
        await until(lambda: any(sent["sharp"] for sent in streamer.sent))
        assert [sent["sharp"] for sent in streamer.sent].count(True) == 1
        assert streamer.sent[-1]["quality"] > streamer.sent[0]["quality"]
        assert (streamer.sent[-1]["w"], streamer.sent[-1]["h"]) == (240, 160)
        # At rest it waits for a request, and there is none.
        await until(lambda: wake.waiting)
        count = len(streamer.sent)
        asked: list[bool] = []

        def nobody() -> bool:
            asked.append(True)
            return False

        stream.watched = nobody
        stream.changed()
        await until(lambda: len(asked) == 2 and wake.waiting)
        assert len(streamer.sent) == count
        # Who comes back meanwhile is sent one.
        away = iter([False])
        stream.watched = lambda: next(away, True)
        stream.changed()
        await until(partial(streamer.has, count + 1))
        task.cancel()

    asyncio.run(watch())


def test_parts_of_a_picture_that_takes_long_are_sent_until_something_changes(
    flat: FlowApp, monkeypatch: pytest.MonkeyPatch
) -> None:
    stream, streamer, part = flat.stream, Streamer(), np.zeros((2, 3, 3), np.uint8)
    monkeypatch.setattr("flowtex.app.streaming.stream.PARTIAL_INTERVAL_S", -1.0)
    monkeypatch.setattr(stream.painter, "full", lambda: iter([part, part]))
    stream.painter.forget()

    async def draw() -> None:
        stream._wake = asyncio.Event()
        stream.set_streamer(streamer)
        await stream._full()
        assert [sent["sharp"] for sent in streamer.sent] == [False, False, True]
        stream._wake.set()
        await stream._full()
        assert len(streamer.sent) == 3

    asyncio.run(draw())
