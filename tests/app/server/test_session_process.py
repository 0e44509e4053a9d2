from __future__ import annotations

import gzip
import io
import os
import signal
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

pytest.importorskip("trame_rca")

from hosted_sessions import Place, place_of
from served import Link
from waiting import until

from flowtex._util.child.child import FORKS
from flowtex.app.server.security import new_secret
from flowtex.app.server.sessions.process import process_opener
from flowtex.errors import FieldError

pytestmark = pytest.mark.skipif(not FORKS, reason="sessions are processes on Linux alone")


@asynccontextmanager
async def place(said: list[str] | None = None, **request: str) -> AsyncIterator[Place]:
    secret = new_secret()
    words = {"secret": secret, **request}
    note = ([] if said is None else said).append
    open_session = process_opener("hosted_sessions:host", ("hosted_sessions",), words, note)
    async with place_of(open_session, secret) as here:
        yield here


def lives(pid: int) -> bool:
    return Path(f"/proc/{pid}").exists()


async def test_each_page_has_a_process_of_its_own_that_ends_with_the_server() -> None:
    said: list[str] = []
    async with place(said) as here:
        (one, link), (_, other) = await here.enter_and_link(), await here.enter_and_link()
        pids = {each.get("pid") for each in (link, other)}
        assert len(pids) == 2 and os.getpid() not in pids and all(map(lives, pids))
        await link.set(value=7)
        await link.close()
        again, link = await here.enter_and_link(one)
        assert (again, link.get("value"), other.get("value")) == (one, 7, 1)
        # A second connection to a session ends the first.
        newer = await Link.open(here.http, here.bare, one, here.secret)
        await until(lambda: link.socket.closed)
        assert newer.get("value") == 7
        assert said == ["plain", "plain"]
    # They remove what they have left first.
    await until(lambda: not any(map(lives, pids)))


async def test_a_crash_ends_one_page() -> None:
    async with place() as here:
        (one, link), (other, second) = await here.enter_and_link(), await here.enter_and_link()
        os.kill(link.get("pid"), signal.SIGSEGV)
        await until(lambda: link.socket.closed)
        await until(lambda: here.site.sessions.get(one) is None)
        await second.set(value=3)
        again, link = await here.enter_and_link(one)
        assert again not in (one, other) and link.get("value") == 1
        await second.close()
        _, second = await here.enter_and_link(other)
        assert second.get("value") == 3


async def test_sessions_outlive_what_they_were_forked_from() -> None:
    async with place() as here:
        one, link = await here.enter_and_link()
        parent = link.get("pid")
        for _ in range(2):  # a guard is between the session and that process
            parent = int(Path(f"/proc/{parent}/stat").read_text(encoding="utf-8").split()[3])
        os.kill(parent, signal.SIGKILL)
        other, second = await here.enter_and_link()
        await link.set(value=5)
        assert other != one and second.get("value") == 1
        pids = [each.get("pid") for each in (link, second)]
    await until(lambda: not any(map(lives, pids)))


async def test_files_are_handed_on() -> None:
    async with place() as here:
        _, link = await here.enter_and_link()
        _, other = await here.enter_and_link()
        address = here.bare + link.get("file")
        async with here.http.get(address) as answer:
            assert (answer.status, await answer.text()) == (200, "words")
            assert answer.headers["Content-Disposition"].endswith("filename*=UTF-8''%C3%A4.txt")
            assert answer.headers["Cache-Control"] == "no-store"
            assert "frame-ancestors" in answer.headers["Content-Security-Policy"]
        async with here.http.get(address.replace("a%20b", "b")) as answer:
            assert answer.status == 404
        sends = here.bare + link.get("sends")
        async with here.http.post(f"{sends}?name=a", data=b"1234") as answer:
            assert answer.status == 200
        await link.until(lambda: link.get("value") == 4)
        assert other.get("value") == 1
        packed = {"Content-Encoding": "gzip"}
        async with here.http.post(sends, data=gzip.compress(b"1"), headers=packed) as answer:
            assert answer.status == 415 and "send the file as it is" in await answer.text()
        large = io.BytesIO(bytes(3_000_000))
        async with here.http.post(f"{sends}?name=%C3%A4", data=large) as answer:
            assert (answer.status, await answer.text()) == (400, "ä is too large")


async def test_what_cannot_be_opened_is_told() -> None:
    with pytest.raises(FieldError, match=r"^the mesh is wrong$"):
        async with place(fault="the mesh is wrong"):
            pass


async def test_no_other_user_can_connect_to_the_process_of_a_page() -> None:
    async with place() as here:
        _, link = await here.enter_and_link()
        opened = Path(f"/proc/{link.get('pid')}/fd")
        targets = [str(file.readlink()) for file in opened.iterdir()]
        inodes = {name[8:-1] for name in targets if name.startswith("socket:[")}
        lines = [line.split() for line in Path("/proc/net/unix").read_text().splitlines()]
        bound = [line[7] for line in lines if line[6] in inodes and len(line) > 7]
        assert bound and not any(name.startswith("@") for name in bound)
        (folder,) = [name for name in targets if name.endswith(".tmp")]
        assert Path(folder, "page").is_socket() and Path(folder).stat().st_mode & 0o777 == 0o700
