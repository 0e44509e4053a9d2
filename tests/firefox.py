"""A Firefox on its own screen, driven by WebDriver BiDi."""

from __future__ import annotations

import asyncio
import base64
import io
import json
import os
import re
import shutil
import subprocess
from collections import deque
from collections.abc import Coroutine, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from threading import Thread
from typing import Any, TypeVar

import aiohttp
import numpy as np
import pytest
from PIL import Image
from waiting import PATIENCE_S, wait_until

from flowtex._util.array_types import Bytes

T = TypeVar("T")

PREFERENCES = 'user_pref("webgl.force-enabled", true);\n'
CALL = "async (words) => JSON.stringify(await (%s)(...JSON.parse(words)) ?? null)"
TEXT = "() => document.body.innerText"
SIZE = {"width": 500, "height": 350}


class Firefox:
    """The one page of a browser, with the methods of Playwright's that are needed."""

    def __init__(self, address: str) -> None:
        self._address, self._count = address, 0
        # Of its own thread, for Playwright has a loop in this one.
        self._thread = ThreadPoolExecutor(1)
        self._runner = asyncio.Runner()
        self._session = self._run(self._connect())
        self._call("session.new", capabilities={})
        self._page = self._call("browsingContext.getTree")["contexts"][0]["context"]
        self._call("browsingContext.setViewport", context=self._page, viewport=SIZE)

    async def _connect(self) -> aiohttp.ClientSession:
        session = aiohttp.ClientSession()
        self._socket = await session.ws_connect(f"{self._address}/session", max_msg_size=0)
        return session

    def _run(self, work: Coroutine[Any, Any, T]) -> T:
        return self._thread.submit(self._runner.run, work).result()

    def _call(self, method: str, **parameters: Any) -> Any:
        return self._run(self._ask(method, parameters))

    async def _ask(self, method: str, parameters: dict[str, Any]) -> Any:
        self._count += 1
        await self._socket.send_json({"id": self._count, "method": method, "params": parameters})
        while True:
            answer = await asyncio.wait_for(self._socket.receive_json(), PATIENCE_S)
            if answer.get("id") == self._count:
                assert answer["type"] == "success", answer
                return answer["result"]

    def goto(self, address: str) -> None:
        """Open a page."""
        self._call("browsingContext.navigate", context=self._page, url=address, wait="complete")

    def evaluate(self, function: str, *arguments: Any) -> Any:
        """Call a function of JavaScript there."""
        answer = self._call(
            "script.callFunction",
            functionDeclaration=CALL % function,
            arguments=[{"type": "string", "value": json.dumps(arguments)}],
            target={"context": self._page},
            awaitPromise=True,
        )
        assert answer["type"] == "success", answer["exceptionDetails"]["text"]
        return json.loads(answer["result"]["value"])

    def wait_for_function(self, function: str) -> None:
        """Wait until a function returns what is true."""
        call = f"async () => Boolean(await ({function})())"
        wait_until(lambda: self.evaluate(call), lambda: (function, self.evaluate(TEXT)))

    def screenshot(self) -> Bytes:
        """Return what the window shows, (H, W, 3)."""
        shots: list[str] = []

        def is_taken() -> bool:
            # A canvas that is drawn to meanwhile cannot be captured.
            with suppress(AssertionError):
                answer = self._call("browsingContext.captureScreenshot", context=self._page)
                shots.append(answer["data"])
            return bool(shots)

        wait_until(is_taken)
        with Image.open(io.BytesIO(base64.b64decode(shots[0]))) as opened:
            return np.asarray(opened.convert("RGB"))

    def close(self) -> None:
        """End the connection."""
        self._run(self._session.close())
        self._thread.submit(self._runner.close).result()
        self._thread.shutdown()


@contextmanager
def firefox(folder: Path) -> Iterator[Firefox]:
    """Yield a Firefox whose profile lies in a folder; skip where there is none.

    Without a screen Firefox has no WebGL on software OpenGL, so it gets one in memory.
    """
    program = shutil.which("firefox-esr") or shutil.which("firefox")
    screen = shutil.which("Xvfb")
    if program is None or screen is None:
        pytest.skip("no Firefox with a screen: apt-get install firefox-esr xvfb")
    (folder / "user.js").write_text(PREFERENCES)
    options = ["--no-remote", "--profile", str(folder), "--remote-debugging-port", "0"]
    with ExitStack() as stack:
        reading, writing = os.pipe()
        words = [screen, "-displayfd", str(writing), "-screen", "0", "1100x900x24"]
        quiet: dict[str, Any] = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        stack.enter_context(_started(subprocess.Popen(words, pass_fds=[writing], **quiet)))
        os.close(writing)
        with os.fdopen(reading) as told:
            display = f":{told.readline().strip()}"
        browser = subprocess.Popen(
            [program, *options],
            env={**os.environ, "DISPLAY": display, "LIBGL_ALWAYS_SOFTWARE": "1"},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )
        stack.enter_context(_started(browser))
        assert browser.stderr is not None
        found = (re.search(r"listening on (ws://\S+)", line) for line in browser.stderr)
        address = next((match[1] for match in found if match), None)
        if address is None:
            pytest.skip("Firefox does not start")
        # Firefox stops where nobody reads its warnings.
        Thread(target=deque, args=(browser.stderr, 0), daemon=True).start()
        page = Firefox(address)
        stack.callback(page.close)
        yield page


@contextmanager
def _started(process: subprocess.Popen[Any]) -> Iterator[None]:
    try:
        yield
    finally:
        process.terminate()
        process.communicate(timeout=PATIENCE_S)
