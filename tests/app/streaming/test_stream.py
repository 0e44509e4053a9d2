"""When pictures are sent, and when not."""

from __future__ import annotations

import asyncio
from types import SimpleNamespace
from typing import Any

import pytest

pytest.importorskip("trame_rca")


from flowtex.app import FlowApp

pytestmark = pytest.mark.usefixtures("opengl")


class Streamer:
    """Stands for trame-rca's, and keeps what is sent."""

    def __init__(self) -> None:
        self.sent: list[dict[str, Any]] = []
        self.coreServer = SimpleNamespace(network_monitor=SimpleNamespace(pending=0))

    def push_content(self, name: str, meta: dict[str, Any], content: bytes) -> None:
        assert content[:2] == b"\xff\xd8"
        self.sent.append({"name": name, **meta})


def test_pictures_come_until_rest_and_then_no_more(flat: FlowApp) -> None:
    stream, streamer = flat.stream, Streamer()
    flat.area.reset_camera()

    async def watch() -> None:
        stream.set_streamer(streamer)
        sharp = flat.state.get("sharp")
        task = asyncio.create_task(stream.run())
        for _ in range(200):
            # Many requests at once are one picture.
            stream.moved()
            stream.moved()
            await asyncio.sleep(0.02)
            if len(streamer.sent) >= 3:
                break
        for _ in range(500):
            if flat.state.get("sharp") > sharp:
                break
            await asyncio.sleep(0.02)
        assert flat.state.get("sharp") == sharp + 1 and flat.state.get("picture") == "sharp"
        assert streamer.sent[-1]["quality"] > streamer.sent[0]["quality"]
        assert (streamer.sent[-1]["w"], streamer.sent[-1]["h"]) == (240, 160)
        count = len(streamer.sent)
        await asyncio.sleep(0.4)
        assert len(streamer.sent) == count
        stream.watched = lambda: False
        stream.changed()
        await asyncio.sleep(0.3)
        assert len(streamer.sent) == count
        task.cancel()

    asyncio.run(watch())
