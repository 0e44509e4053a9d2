"""When pictures are sent, and when not."""

from __future__ import annotations

import asyncio
from functools import partial
from typing import Any, Literal

import pytest
from waiting import until

pytest.importorskip("trame_rca")


from flowtex.app import FlowApp
from flowtex.app.streaming.stream import FrameStream

pytestmark = pytest.mark.usefixtures("opengl")


class Streamer:
    """Stands for trame-rca's and a page: keeps what is sent, and acknowledges each at once."""

    def __init__(self, stream: FrameStream) -> None:
        self.sent: list[dict[str, Any]] = []
        self.stream = stream
        self.acknowledges = True
        stream.clock.restart()
        stream.set_streamer(self)

    def acknowledge(self) -> None:
        """Acknowledge all pictures."""
        self.stream.on_interaction("page", {"number": self.sent[-1]["number"], "seconds": 0})

    def has(self, count: int) -> bool:
        return len(self.sent) >= count

    def push_content(self, name: str, meta: dict[str, Any], content: bytes) -> None:
        assert content[:2] == b"\xff\xd8"
        self.sent.append({"name": name, "bytes": len(content), **meta})
        if self.acknowledges:
            self.acknowledge()


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
    stream, streamer = flat.stream, Streamer(flat.stream)
    flat.area.reset_camera()

    async def watch() -> None:
        stream._wake = wake = Wake()
        task = asyncio.create_task(stream.run())
        for count in (1, 2, 3):
            # Many requests at once are one picture.
            stream.changed()
            stream.changed()
            await until(partial(streamer.has, count))
        await until(lambda: any(sent["sharp"] for sent in streamer.sent))
        assert [sent["sharp"] for sent in streamer.sent].count(True) == 1
        assert streamer.sent[-1]["bytes"] > streamer.sent[0]["bytes"]
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


def test_pictures_that_a_new_page_missed_are_not_waited_for(flat: FlowApp) -> None:
    stream = flat.stream
    size = dict(zip("wh", flat.viewport.size, strict=True))
    stream.clock.restart()
    for _ in range(2):
        stream.clock.sent(moving=True)
    stream.update_size("page", size)
    assert stream.clock.on_way == 2
    stream.reset()
    stream.update_size("page", size)
    assert stream.clock.on_way == 0
