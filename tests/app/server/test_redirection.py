"""The secret of a page on its way to the browser."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

pytest.importorskip("aiohttp")
pytest.importorskip("wslink")

from flowtex.app.server.site import serve_until_ended


async def test_the_secret_is_in_no_command_line(monkeypatch: pytest.MonkeyPatch) -> None:
    opened = asyncio.get_running_loop().create_future()
    monkeypatch.setattr(
        "webbrowser.open",
        lambda url: opened.get_loop().call_soon_threadsafe(opened.set_result, url),
    )

    async def listen() -> int:
        return 80

    async def stop() -> None:
        pass

    endpoint, said = ("127.0.0.1", 0, "?secret=word&a=b"), list[str]()
    serving = asyncio.create_task(
        serve_until_ended(listen, stop, endpoint, announce=said.append, open_browser=True)
    )
    address = await opened
    assert said == ["http://127.0.0.1:80/?secret=word&a=b"]
    assert address.startswith("file://") and "word" not in address
    file = Path(address.removeprefix("file://"))
    assert "url=http://127.0.0.1:80/?secret=word&amp;a=b" in file.read_text(encoding="utf-8")
    assert [path.stat().st_mode & 0o777 for path in (file, file.parent)] == [0o600, 0o700]
    serving.cancel()
    await serving
    assert not file.parent.exists()
