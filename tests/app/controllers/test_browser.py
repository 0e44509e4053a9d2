"""The page as others than its owner meet it: drawn by the server, for two users, and at its end."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from pages import new_context
from served import Served, start
from waiting import wait_until
from watching import Watch, count, difference, server_draws, zoom_of

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext, Page

pytest.importorskip("trame_rca")

pytestmark = [pytest.mark.browser, pytest.mark.usefixtures("opengl")]

#: A small view: a processor that draws needs seconds for a whole screen of texture.
SIZE = {"width": 480, "height": 360}
#: Part of the view that nothing lies on, as left, top, right, bottom.
WATCH = Watch((100, 130, 400, 280))


@pytest.fixture(scope="module")
def demo(opengl: object) -> Iterator[Served]:
    """A server that has room for two pages."""
    words = ("demo", "--example", "double_gyre", "--samples", "5", "--limit", "2")
    started = start(*words, "--idle", "0.05")
    yield started
    if started.process.returncode is None:
        started.end(signal.SIGINT)


@pytest.fixture(scope="module")
def users(browser: Browser) -> Iterator[list[BrowserContext]]:
    """Two people, of which the browser knows nothing in common."""
    both = [new_context(browser, viewport=SIZE) for _ in range(2)]
    server_draws(both[0])
    yield both
    for user in both:
        user.close()


@pytest.fixture(scope="module")
def opened(users: list[BrowserContext], demo: Served) -> Page:
    """The page of the demo, with what it complained of and asked for in ``page.heard``."""
    page = users[0].new_page()
    heard: dict[str, list[str]] = {"errors": [], "asked": []}
    page.on("console", lambda m: heard["errors"].append(m.text) if m.type == "error" else None)
    page.on("pageerror", lambda error: heard["errors"].append(str(error)))
    page.on("request", lambda request: heard["asked"].append(request.url))
    page.heard = heard  # type: ignore[attr-defined]
    page.goto(demo.address)
    WATCH.settled(page)
    return page


def fineness(pixels: Any) -> float:
    """Strength of what changes from one pixel to the next, wherever the flow goes."""
    return float(np.mean([np.abs(np.diff(pixels, axis=axis)).mean() for axis in (0, 1)]))


def home(page: Page) -> Any:
    before = count(page)
    page.locator("button[data-name=home]").click()
    return WATCH.settled(page, before)


def zoom(page: Page) -> Any:
    before = count(page)
    page.mouse.move(250, 200)
    for _ in range(12):
        page.mouse.wheel(0, -100)
    return WATCH.settled(page, before)


def test_the_flow_appears_zooms_and_is_dragged(opened: Page) -> None:
    whole = home(opened)
    assert fineness(whole) > 8
    text = opened.inner_text(".flowtex-page").lower()
    assert "double gyre" in text and "201 × 101 nodes" in text
    closer = zoom(opened)
    assert difference(whole, closer) > 8
    assert fineness(closer) > 0.4 * fineness(whole)
    assert 10 < zoom_of(opened) < 25
    before = count(opened)
    opened.mouse.move(120, 200)
    opened.mouse.down()
    opened.mouse.move(180, 230, steps=8)
    opened.mouse.up()
    moved = WATCH.settled(opened, before)
    assert difference(moved[30:, 60:], closer[:-30, :-60]) < 0.25 * difference(moved, closer)


def test_nothing_is_complained_of_and_nothing_comes_from_outside(
    opened: Page, demo: Served
) -> None:
    heard = opened.heard  # type: ignore[attr-defined]
    # trame's client first asks for a launcher, which there is none of.
    errors = [text for text in heard["errors"] if "405" not in text]
    assert not errors
    own = ("data:", "blob:", demo.bare)
    assert len(heard["asked"]) > 5
    assert not [url for url in heard["asked"] if not url.startswith(own)]


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.skipif(not Path("/proc").is_dir(), reason="reads /proc")
def test_the_secret_is_new_each_time_and_not_in_the_list_of_processes(demo: Served) -> None:
    assert len(demo.secret) >= 24 and demo.secret != "wslink-secret"
    command = Path(f"/proc/{demo.process.pid}/cmdline").read_text(encoding="utf-8")
    assert demo.secret not in command


def test_two_users_look_from_different_places_and_hear_of_the_end(
    opened: Page, users: list[BrowserContext], demo: Served
) -> None:
    home(opened)
    other = users[1].new_page()
    other.goto(demo.address)
    whole = WATCH.settled(other)
    closer = zoom(opened)
    assert difference(whole, closer) > 8
    assert difference(WATCH.shot(other), whole) == 0

    # A page that is loaded again is where it was, and its address does not tell the secret.
    opened.reload()
    assert difference(WATCH.settled(opened), closer) < 1
    assert "secret" not in opened.url and demo.secret not in opened.url

    # Both places are taken: a third page says so, and opens when one has become free.
    third = users[0].new_page()
    third.goto(demo.address)
    third.get_by_text("limit is 2 pages at a time").wait_for()
    other.close()
    again = third.get_by_role("button", name="Try again")

    def is_open() -> bool:
        if again.is_visible():
            again.click()
        return third.locator(".flowtex[data-sharp]").count() > 0

    wait_until(is_open, lambda: third.inner_text("body"))
    # Another tab of the first user, and yet not the first user's camera.
    assert difference(WATCH.settled(third), whole) < 1

    # A page whose session is over says so.
    said = demo.end(signal.SIGTERM)
    assert demo.process.returncode == 128 + signal.SIGTERM
    assert "ended by SIGTERM" in said and "Traceback" not in said
    third.get_by_text("lost its connection").wait_for()
    assert third.get_by_role("button", name="Open it again").is_visible()
