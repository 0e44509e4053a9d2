"""A program that serves pages, and a connection to it that speaks as trame's client does."""

from __future__ import annotations

import asyncio
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any
from urllib.parse import parse_qs, urlsplit

import aiohttp
import msgpack
import pytest
from waiting import PATIENCE_S
from wslink.chunking import UnChunker, generate_chunks

CHUNK = 4_000_000  #: Bytes of one chunk of a message.


@contextmanager
def signals_of_a_terminal() -> Iterator[None]:
    """Have signals do what they do by default, here and in processes that are started.

    Where the suite runs in the background of a shell, or by ``nohup``, some are ignored.
    """
    numbers = [getattr(signal, name) for name in ("SIGINT", "SIGHUP") if hasattr(signal, name)]
    before = {number: signal.getsignal(number) for number in numbers}
    try:
        for number in numbers:
            by_default = signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL
            signal.signal(number, by_default)
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@dataclass
class Served:
    """A program that serves, and the address that it announced."""

    process: subprocess.Popen[str]
    address: str

    @property
    def place(self) -> tuple[str, int]:
        parts = urlsplit(self.address)
        return str(parts.hostname), int(parts.port or 0)

    @property
    def bare(self) -> str:
        return self.address.split("?")[0]

    @property
    def secret(self) -> str:
        return parse_qs(urlsplit(self.address).query)["secret"][0]

    def end(self, number: int, seconds: float = PATIENCE_S) -> str:
        """Send a signal, wait for the end, and return the rest of what was said."""
        if self.process.poll() is None:
            self.process.send_signal(number)
        return self.process.communicate(timeout=seconds)[0]


def start(*words: str) -> Served:
    """Start ``flowtex`` with a page, and wait for its address."""
    with signals_of_a_terminal():
        process = subprocess.Popen(
            [sys.executable, "-m", "flowtex", *words, "--no-browser", "--port", "0"],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env={**os.environ, "COLUMNS": "60"},
        )
    assert process.stdout is not None
    said = ""
    for line in process.stdout:
        said += line
        if found := re.search(r"http://\S+", line):
            return Served(process, found.group())
    pytest.fail(f"the server ended without printing an address:\n{said}")


async def enter(
    http: aiohttp.ClientSession, bare: str, secret: str, session: str | None = None
) -> tuple[int, dict[str, str]]:
    """Ask at the door, and return the status and what was said."""
    asked = {"secret": secret, "session": session}
    async with http.post(f"{bare}flowtex/session", json=asked) as answer:
        return answer.status, await answer.json()


class Link:
    """A connection to one session."""

    def __init__(self, socket: aiohttp.ClientWebSocketResponse) -> None:
        self.socket = socket
        self.state: dict[str, Any] = {}
        self.pictures, self.sharp = 0, False
        self._count = 0
        self._answers: dict[str, asyncio.Future[Any]] = {}
        self._news = asyncio.Event()
        self._task = asyncio.create_task(self._listen())

    @classmethod
    async def open(cls, http: aiohttp.ClientSession, bare: str, token: str, secret: str) -> Link:
        """Connect, and read the state."""
        socket = await http.ws_connect(f"{bare}page/{token}/ws", max_msg_size=0)
        link = cls(socket)
        await link.call("wslink.hello", {"secret": secret}, kind="system")
        link.state |= (await link.call("trame.state.get"))["state"]
        return link

    async def close(self) -> None:
        """End the connection."""
        await self.socket.close()
        await self._task

    async def call(self, method: str, *args: Any, kind: str = "rpc") -> Any:
        """Call a method of the server and return what it answers."""
        name = f"{kind}:c:{self._count + 1}"
        self._answers[name] = asyncio.get_running_loop().create_future()
        await self._send(method, args, kind)
        return await asyncio.wait_for(self._answers[name], PATIENCE_S)

    async def _send(self, method: str, args: Any, kind: str = "rpc") -> None:
        self._count += 1
        name = f"{kind}:c:{self._count}"
        message = {"wslink": "1.0", "id": name, "method": method, "args": args, "kwargs": {}}
        for chunk in generate_chunks(msgpack.packb(message), CHUNK):
            await self.socket.send_bytes(chunk)

    def key(self, name: str) -> str:
        """Name in the state of one of the application's own."""
        found = [key for key in self.state if re.fullmatch(rf"flow\d+_{name}", key)]
        assert len(found) == 1, (name, found)
        return found[0]

    def get(self, name: str) -> Any:
        """Value of the state."""
        return self.state[self.key(name)]

    async def set(self, **values: Any) -> None:
        """Change values of the state."""
        changes = [{"key": self.key(name), "value": value} for name, value in values.items()]
        await self.call("trame.state.update", changes)

    async def until(self, holds: Any) -> None:
        """Wait until a condition on this connection holds."""
        async with asyncio.timeout(PATIENCE_S):
            while not holds():
                self._news.clear()
                await self._news.wait()

    async def _listen(self) -> None:
        pieces = UnChunker()
        pieces.set_max_message_size(2**32)
        async for message in self.socket:
            whole = pieces.process_chunk(message.data)
            if whole is not None:
                self._take(whole)
                await self._acknowledge(whole)
                self._news.set()

    async def _acknowledge(self, message: dict[str, Any]) -> None:
        if "trame.rca.topic.stream" in message["id"] and not self.socket.closed:
            frame = message["result"]
            shown = {"number": frame["meta"]["number"], "seconds": 0.0}
            await self._send("trame.rca.event", [frame["name"], "link", shown])

    def _take(self, message: dict[str, Any]) -> None:
        name = message["id"]
        waiting = self._answers.pop(name, None)
        if waiting is not None and not waiting.done():
            if "error" in message:
                assert set(message["error"]) == {"code", "message"}, "more than a page needs"
                waiting.set_exception(RuntimeError(message["error"]["message"]))
            else:
                waiting.set_result(message["result"])
        elif "trame.state.topic" in name:
            self.state |= message["result"]
        elif "trame.rca.topic.stream" in name:
            self.pictures += 1
            self.sharp = message["result"]["meta"]["sharp"]
