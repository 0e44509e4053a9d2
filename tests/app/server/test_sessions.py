from __future__ import annotations

import asyncio
import gc
import threading
import weakref
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager
from itertools import product
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import aiohttp
import pytest

pytest.importorskip("trame_rca")

from hosted_sessions import Place, Plain, place_of
from served import Link
from small_pages import small
from trame.app.core import AVAILABLE_SERVERS
from waiting import PATIENCE_S, until

from flowtex.app import FlowApp, serve
from flowtex.app.server.files import Routes
from flowtex.app.server.security import new_secret
from flowtex.app.server.sessions import registry as sessions
from flowtex.app.server.sessions.local import LocalSession, opener
from flowtex.app.server.sessions.registry import usual_limit
from flowtex.errors import FieldError


@asynccontextmanager
async def place(
    make: Callable[[Any], Any] = Plain, *, limit: int = 4, idle: float = 10.0
) -> AsyncIterator[Place]:
    secret = new_secret()
    async with place_of(opener(make, secret), secret, limit=limit, idle=idle) as here:
        yield here


def app_of(here: Place, token: str) -> Any:
    found = here.site.sessions.get(token)
    assert isinstance(found, LocalSession)
    return found.app


@pytest.fixture(autouse=True)
def _no_server_is_left() -> Iterator[None]:
    before = set(AVAILABLE_SERVERS)
    yield
    assert set(AVAILABLE_SERVERS) == before


async def test_each_page_has_a_state_of_its_own_and_comes_back_to_it() -> None:
    async with place() as here:
        one, other = await here.token(), await here.token()
        assert one != other
        link, second = await here.link(one), await here.link(other)
        await link.set(value=7)
        assert app_of(here, one).server.state.flow0_value == 7
        assert app_of(here, other).server.state.flow0_value == 1
        assert app_of(here, one).stream.watched() is True
        await link.close()
        await until(lambda: not app_of(here, one).stream.watched())
        assert await here.token(one) == one
        link = await here.link(one)
        assert link.get("value") == 7
        # A second connection to a session ends the first.
        newer = await here.link(one)
        await until(lambda: link.socket.closed)
        assert await newer.call("trame.state.get")
        for each in (link, newer, second):
            await each.close()


async def test_a_copied_tab_gets_a_session_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    async with place() as here:
        token = await here.token()
        link = await here.link(token)
        monkeypatch.setattr(sessions, "RECONNECT_WAIT_S", 0.0)
        assert await here.token(token) != token
        # A page that is loaded again asks before the end of its old connection is known.
        monkeypatch.setattr(sessions, "RECONNECT_WAIT_S", PATIENCE_S)
        asking = asyncio.create_task(here.token(token))
        await link.close()
        assert await asking == token


async def test_the_page_that_is_one_too_many_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    async with place(limit=2) as here:
        # Many who come at once are no more than the limit.
        answers = await asyncio.gather(*(here.enter() for _ in range(6)))
        one, other = (said["session"] for status, said in answers if status == 200)
        assert len(list(here.site.sessions)) == 2
        link = await here.link(one)
        status, said = await here.enter()
        assert status == 503 and "limit is 2 pages at a time" in said["words"]
        # Who has been away for a while makes room; who is there does not.
        monkeypatch.setattr(sessions, "REPLACE_AFTER_S", 0.0)
        gone = app_of(here, other)
        assert await here.token() not in (one, other)
        assert gone.closed and not app_of(here, one).closed
        await link.close()


async def test_an_idle_session_ends_and_one_in_use_does_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    now = [0.0]
    monkeypatch.setattr(sessions, "time", SimpleNamespace(monotonic=lambda: now[0]))

    async with place(idle=0.004) as here:
        used, idle = await here.token(), await here.token()
        link = await here.link(used)
        app = app_of(here, idle)
        # A page that loads slowly finds its session.
        now[0] = sessions.LOADING_S
        session = here.site.sessions.get(idle)
        assert session is not None and not session.is_idle(0.24)
        await (await here.link(idle)).close()
        await until(lambda: not session.connected)
        assert not session.is_idle(0.24)
        now[0] += 0.25
        await until(lambda: app.closed)
        assert here.site.sessions.get(idle) is None and not app_of(here, used).closed
        await until(lambda: app.server.name not in AVAILABLE_SERVERS)
        with pytest.raises(aiohttp.WSServerHandshakeError):
            await here.link(idle)
        assert await here.token(idle) != idle
        await link.close()


async def test_what_cannot_be_made_is_told_and_leaves_nothing() -> None:
    def broken(server: Any) -> Any:
        if len(made) == 1:
            made.append(server)
            msg = "the file is gone"
            raise FieldError(msg)
        made.append(server)
        return Plain(server)

    made: list[Any] = []

    async with place(broken) as here:
        await here.token()
        status, said = await here.enter()
        assert status == 500 and "the file is gone" in said["words"]
        assert made[1].name not in AVAILABLE_SERVERS
        await here.token()


async def test_without_the_secret_there_is_no_session() -> None:
    async with place() as here:
        token = await here.token()
        secrets = ("", "wrong", "wslink-secret", "sécret")
        for secret, known in product(secrets, (None, token)):
            asked = {"secret": secret, "session": known}
            async with here.http.post(f"{here.bare}flowtex/session", json=asked) as answer:
                assert answer.status == 403
                assert "including the secret" in (await answer.json())["words"]
        assert len(list(here.site.sessions)) == 1
        for secret in secrets:
            with pytest.raises(RuntimeError, match="Authentication failed"):
                await Link.open(here.http, here.bare, token, secret)


async def test_what_is_no_request_is_refused_as_such(caplog: pytest.LogCaptureFixture) -> None:
    async with place() as here:
        for body in (
            *(b"", b"[", b"[]", b"{}", b"3", b"\xff\xfe", b"[" * 4000, b'{"a":' * 700),
            *(b'{"secret": null}', b'{"secret": 3}', b'{"secret": ["a"]}', b'{"secret": NaN}'),
            b'{"secret": "\\ud800"}',
            f'{{"secret": "{here.secret}", "session": 3}}'.encode(),
            f'{{"secret": "{here.secret}", "session": "\\udfff"}}'.encode(),
        ):
            async with here.http.post(f"{here.bare}flowtex/session", data=body) as answer:
                assert answer.status == 400, body
                assert "not valid" in (await answer.json())["words"]
        for path in (
            "page/%ED%A0%80/ws",
            "flowtex/%ED%A0%80/%FF",
            "page/%00/index.html",
            "%2e",
            "x" * 5000,
        ):
            async with here.http.get(f"{here.bare}{path}") as answer:
                assert answer.status in (200, 404)
        # Files of the page are served, and no others.
        for path, status in (
            ("vue.global.js", 200),
            ("..%2F..%2F__init__.py", 404),
            ("__init__.py", 404),
        ):
            async with here.http.get(here.bare + path) as answer:
                assert answer.status == status, path
        await here.token()
    assert not caplog.records


async def test_an_incomplete_request_at_the_door_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flowtex.app.server.site.HEAD_S", 0.01)
    async with place() as here:
        reader, writer = await asyncio.open_connection("127.0.0.1", here.site.port)
        head = "POST /flowtex/session HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\n"
        writer.write(head.encode())
        async with asyncio.timeout(PATIENCE_S):
            assert (await reader.readline()).startswith(b"HTTP/1.1 408")
        writer.close()


async def test_a_page_cannot_add_to_the_state_and_learns_of_no_traceback(
    caplog: pytest.LogCaptureFixture, capfd: pytest.CaptureFixture[str]
) -> None:
    async with place() as here:
        token = await here.token()
        link, server = await here.link(token), app_of(here, token).server
        changes = [{"key": key, "value": 9} for key in ("flow0_value", "new", "__class__")]
        await link.call("trame.state.update", changes)
        assert server.state.flow0_value == 9 and not server.state.has("new")
        for method in ("application.exit", "application.exit.later", "nothing"):
            with pytest.raises(RuntimeError, match="Unregistered method called"):
                await link.call(method, "x" * 100)
        server.controller.trigger("broken")(lambda: dict[str, int]()["secret"])
        with pytest.raises(RuntimeError, match="Exception raised"):
            await link.call("trame.trigger", "broken", [], {})
        assert await link.call("trame.state.get")
        # What is not packed though it says so is not a fault of the program.
        session, packed = f"{here.bare}flowtex/session", {"Content-Encoding": "gzip"}
        async with here.http.post(session, data=b"abcd", headers=packed) as answer:
            assert answer.status == 400
        await link.socket.send_str("{}")  # no page of ours does that, and it is over
        await until(lambda: link.socket.closed)
        await link.close()
    assert caplog.text.count("KeyError: 'secret'") == 1
    assert "No area" not in capfd.readouterr().out


async def test_other_sites_are_refused_and_proxies_are_known() -> None:
    async with place() as here:
        token = await here.token()
        asked = {"secret": here.secret}
        evil = {"Origin": "http://evil.example"}
        async with here.http.post(
            f"{here.bare}flowtex/session", json=asked, headers=evil
        ) as answer:
            assert answer.status == 403
        with pytest.raises(aiohttp.WSServerHandshakeError) as refused:
            await here.http.ws_connect(f"{here.bare}page/{token}/ws", headers=evil)
        assert refused.value.status == 403
        # A page of another site that would set the header is asked about it first.
        async with here.http.options(f"{here.bare}flowtex/session", headers=evil) as answer:
            assert answer.status == 403
        proxied = {"Origin": "https://hub.example", "X-Forwarded-Host": "hub.example"}
        async with here.http.ws_connect(f"{here.bare}page/{token}/ws", headers=proxied) as socket:
            assert not socket.closed
        async with here.http.get(here.bare) as answer:
            policy = answer.headers["Content-Security-Policy"]
            assert "default-src 'self'" in policy and "frame-ancestors 'self'" in policy
            assert answer.headers["Referrer-Policy"] == "no-referrer"


async def test_files_are_handed_out_to_who_has_their_address(tmp_path: Path) -> None:
    film = tmp_path / "a.mp4"
    film.write_bytes(b"film")

    async def later(_: str) -> Any:
        return b"later", "text/plain", None

    async with place() as here:
        routes = [Routes.of(app_of(here, await here.token()).server) for _ in range(2)]
        address = routes[0].give("c d", lambda _: (b"png", "image/png", 'Düse "1".png'))
        async with here.http.get(here.bare + address + ".png") as answer:
            assert (answer.status, await answer.read()) == (200, b"png")
            said = answer.headers
            assert said["Content-Type"] == "image/png"
            assert said["Cache-Control"] == "no-store"
            assert said["X-Content-Type-Options"] == "nosniff"
            assert said["Content-Disposition"] == (
                "attachment; filename=\"D?se _1_.png\"; filename*=UTF-8''D%C3%BCse%20%221%22.png"
            )
        for give, body in ((later, b"later"), (lambda _: (film, "video/mp4", "a.mp4"), b"film")):
            async with here.http.get(here.bare + routes[0].give("next", give)) as answer:
                assert await answer.read() == body
                assert answer.headers["Cache-Control"] == "no-store"
        for wrong in (
            address.replace(routes[0].token, routes[1].token),
            address.replace("c%20d", "d"),
            f"flowtex/{routes[0].token}/..%2Fnext",
        ):
            async with here.http.get(here.bare + wrong) as answer:
                assert answer.status == 404
        await here.site.sessions.end(next(iter(here.site.sessions)).token)
        async with here.http.get(here.bare + address) as answer:
            assert answer.status == 404


@pytest.mark.usefixtures("opengl")
def test_sessions_that_end_leave_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sessions of real applications are opened and closed, one after the other."""
    field, count = small(), 2
    made: list[weakref.ref[Any]] = []
    # Memory goes back to the system when all of a session has been freed, and not before.
    alive: list[int] = []

    def give_back() -> None:
        alive.append(sum(ref() is not None for ref in made))

    monkeypatch.setattr(sessions, "give_back", give_back)
    monkeypatch.setattr(sessions, "REPLACE_AFTER_S", 0.0)

    def make(server: Any) -> FlowApp:
        app = FlowApp(field, server=server, samples=5)
        made.extend(weakref.ref(thing) for thing in (app, server, app.viewport, app.stream))
        return app

    async def story() -> None:
        async with place(make, limit=1) as here:
            for _ in range(count):
                token = await here.token()  # makes room by an end
                link = await here.link(token)
                view = app_of(here, token).stream.area_name
                await link.call("trame.rca.size", view, "test", {"w": 96, "h": 64, "p": 1})
                # A thread that still draws holds what it draws.
                await link.until(lambda link=link: link.sharp)
                await link.close()
                await until(lambda: not any(s.connected for s in here.site.sessions))
            await here.site.sessions.end(token)

    threads = set(threading.enumerate())
    asyncio.run(story())
    gc.collect()
    assert len(made) == 4 * count and alive == [0] * count
    assert [ref() for ref in made if ref() is not None] == []
    assert [thread for thread in threading.enumerate() if thread not in threads] == []


@pytest.mark.parametrize("idle", [False, True])
async def test_a_look_for_idle_sessions_holds_none(
    monkeypatch: pytest.MonkeyPatch, idle: bool
) -> None:
    looks: list[float] = []

    def is_idle(_: LocalSession, limit: float) -> bool:
        looks.append(limit)
        return idle

    alive: list[bool] = []
    async with place() as here:
        token = await here.token()
        session = weakref.ref(here.site.sessions.get(token))
        monkeypatch.setattr(LocalSession, "is_idle", is_idle)
        monkeypatch.setattr(sessions, "give_back", lambda: alive.append(session() is not None))
        looking = asyncio.create_task(here.site.sessions.sweep(every=0.01))
        await until(lambda: looks)
        if not idle:
            await here.site.sessions.end(token)
        await until(lambda: alive)
        assert alive == [False]
        looking.cancel()


def test_what_cannot_be_served_is_told() -> None:
    with pytest.raises(FieldError, match="samples cannot be used with a function"):
        serve(Plain, samples=3)
    assert usual_limit() >= 2


@pytest.mark.parametrize(("free", "pages"), [(0, 2), (1_000_000_000, 4)])
def test_pages_are_as_many_as_memory_has_room_for(
    monkeypatch: pytest.MonkeyPatch, free: int, pages: int
) -> None:
    monkeypatch.setattr("flowtex.app.server.sessions.registry.available_bytes", lambda: free)
    assert usual_limit() == pages
