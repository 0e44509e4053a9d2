from __future__ import annotations

import gzip
import io
import os
import signal
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import aiohttp
import pytest

pytest.importorskip("trame_rca")

from served import Link, enter
from waiting import until

from flowtex._util.child import FORKS
from flowtex.app.server.security import new_secret
from flowtex.app.server.sessions.process import process_opener
from flowtex.app.server.sessions.registry import Sessions
from flowtex.app.server.site import Site
from flowtex.errors import FieldError

pytestmark = pytest.mark.skipif(not FORKS, reason="sessions are processes on Linux alone")


class Place:
    def __init__(self, site: Site, secret: str, http: aiohttp.ClientSession) -> None:
        self.site, self.secret, self.http = site, secret, http
        self.bare = f"http://127.0.0.1:{site.port}/"
        self.said: list[str] = []

    async def link(self, token: str | None = None) -> tuple[str, Link]:
        status, said = await enter(self.http, self.bare, self.secret, token)
        assert status == 200, said
        return said["session"], await Link.open(self.http, self.bare, said["session"], self.secret)


@asynccontextmanager
async def place(**request: str) -> AsyncIterator[Place]:
    secret, said = new_secret(), list[str]()
    open_session = process_opener(
        "hosted_sessions:host", ("hosted_sessions",), {"secret": secret, **request}, said.append
    )
    site = Site(Sessions(open_session, limit=4, idle=10.0), secret)
    await site.listen()
    async with aiohttp.ClientSession() as http:
        here = Place(site, secret, http)
        here.said = said
        try:
            yield here
        finally:
            await site.stop()


def lives(pid: int) -> bool:
    return Path(f"/proc/{pid}").exists()


async def test_each_page_has_a_process_of_its_own_that_ends_with_the_server() -> None:
    async with place() as here:
        (one, link), (_, other) = await here.link(), await here.link()
        pids = {each.get("pid") for each in (link, other)}
        assert len(pids) == 2 and os.getpid() not in pids and all(map(lives, pids))
        await link.set(value=7)
        await link.close()
        again, link = await here.link(one)
        assert (again, link.get("value"), other.get("value")) == (one, 7, 1)
        # A second connection to a session ends the first.
        newer = await Link.open(here.http, here.bare, one, here.secret)
        await until(lambda: link.socket.closed)
        assert newer.get("value") == 7
        assert here.said == ["plain", "plain"]
    # They remove what they have left first.
    await until(lambda: not any(map(lives, pids)))


async def test_a_crash_ends_one_page() -> None:
    async with place() as here:
        (one, link), (other, second) = await here.link(), await here.link()
        os.kill(link.get("pid"), signal.SIGSEGV)
        await until(lambda: link.socket.closed)
        await until(lambda: here.site.sessions.get(one) is None)
        await second.set(value=3)
        again, link = await here.link(one)
        assert again not in (one, other) and link.get("value") == 1
        await second.close()
        _, second = await here.link(other)
        assert second.get("value") == 3


async def test_sessions_outlive_what_they_were_forked_from() -> None:
    async with place() as here:
        one, link = await here.link()
        forked = Path(f"/proc/{link.get('pid')}/stat").read_text(encoding="utf-8")
        os.kill(int(forked.split()[3]), signal.SIGKILL)
        other, second = await here.link()
        await link.set(value=5)
        assert other != one and second.get("value") == 1
        pids = [each.get("pid") for each in (link, second)]
    await until(lambda: not any(map(lives, pids)))


async def test_files_are_handed_on() -> None:
    async with place() as here:
        _, link = await here.link()
        _, other = await here.link()
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
        _, link = await here.link()
        opened = Path(f"/proc/{link.get('pid')}/fd")
        targets = [str(file.readlink()) for file in opened.iterdir()]
        inodes = {name[8:-1] for name in targets if name.startswith("socket:[")}
        lines = [line.split() for line in Path("/proc/net/unix").read_text().splitlines()]
        bound = [line[7] for line in lines if line[6] in inodes and len(line) > 7]
        assert bound and not any(name.startswith("@") for name in bound)
        (folder,) = [name for name in targets if name.endswith(".tmp")]
        assert Path(folder, "page").is_socket() and Path(folder).stat().st_mode & 0o777 == 0o700
