"""Files that a page may fetch."""

from __future__ import annotations

import asyncio
import os
import stat
from pathlib import Path

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
    found = files.get(one)
    assert found is not None and found.read_bytes() == b"x" * 100
    answer = asyncio.run(routes.answer(one))
    assert "filename*=UTF-8''a_b__.png" in answer.headers["Content-Disposition"]
    assert answer.headers["Content-Disposition"].startswith("attachment;")
    assert answer.headers["Content-Type"] == "image/png"
    assert files.get("") is None and files.get(one[:-1]) is None and files.get("../x") is None
    with pytest.raises(ValueError, match="is outside"):
        files.add(Path("/etc/hostname"))
    files.close()
    assert files.get(one) is None and not files.folder.exists()
    files.close()
    with pytest.raises(web.HTTPGone, match="Gone") as gone:
        asyncio.run(routes.answer(one))
    assert gone.value.text is not None and "has expired" in gone.value.text


def test_downloads_go_when_they_are_old_or_too_many(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [0.0]
    files = Downloads(Routes(), lifetime=10.0, clock=lambda: now[0])
    tokens = []
    for n in range(3):
        now[0] = float(n)
        tokens.append(added(files))
    now[0] = 11.5
    assert [files.get(t) is not None for t in tokens] == [False, False, True]
    # What was requested just now stays for as long again.
    now[0] = 21.0
    assert files.get(tokens[2]) is not None and len(files) == 1
    monkeypatch.setattr("flowtex.app.server.files.DOWNLOAD_BYTES", 150)
    now[0] = 22.0
    last = added(files, "b.gif")
    assert files.get(tokens[2]) is None and files.get(last) is not None
    assert len(list(files.folder.iterdir())) == 1
    files.close()


def test_downloads_are_removed_with_their_owner() -> None:
    files = Downloads(Routes())
    folder = files.folder
    del files
    assert not folder.exists()
