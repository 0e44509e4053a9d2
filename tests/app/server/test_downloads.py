"""Files that a page may fetch."""

from __future__ import annotations

import asyncio
import os
import stat

import pytest

pytest.importorskip("trame_rca")

from aiohttp import web

from flowtex.app.server.files import Downloads, Routes


def added(files: Downloads, name: str = "a.gif") -> str:
    """Token of another download of 100 bytes."""
    path = files.reserve(name)
    path.write_bytes(b"x" * 100)
    return files.add(path).rsplit("/", 1)[-1]


def test_downloads_are_private_and_under_a_token() -> None:
    routes = Routes()
    files = Downloads(routes)
    path = files.reserve("../../my flow?.png")
    assert path.name == "_.._my flow_.png" and path.parent.parent == files.folder
    if os.name == "posix":
        assert stat.S_IMODE(files.folder.stat().st_mode) == 0o700
    one, other = added(files, 'a"b\r\n.png'), added(files, "b.mp4")
    assert one != other and len(one) >= 32
    answer = asyncio.run(routes.answer(one))
    assert "filename*=UTF-8''a_b__.png" in answer.headers["Content-Disposition"]
    assert answer.headers["Content-Disposition"].startswith("attachment;")
    assert answer.headers["Content-Type"] == "image/png"
    files.close()
    assert not files.folder.exists()
    files.close()
    with pytest.raises(web.HTTPGone, match="Gone") as gone:
        asyncio.run(routes.answer(one))
    assert gone.value.text is not None and "has expired" in gone.value.text


def test_oldest_download_is_removed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flowtex.app.server.files.MOST_DOWNLOADS", 2)
    routes = Routes()
    files = Downloads(routes)
    first, *others = (added(files) for _ in range(3))
    with pytest.raises(web.HTTPGone):
        asyncio.run(routes.answer(first))
    for other in others:
        assert asyncio.run(routes.answer(other)).status == 200
    assert len(list(files.folder.iterdir())) == 2
    files.close()
