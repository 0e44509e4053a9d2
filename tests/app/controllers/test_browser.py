from __future__ import annotations

import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from pages import new_context
from served import Served, start
from waiting import PATIENCE_S
from watching import Watch, count, difference, server_draws, zoom_of

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytest.importorskip("trame_rca")

pytestmark = [pytest.mark.browser, pytest.mark.usefixtures("opengl")]

#: A small view: a processor that draws needs seconds for a whole screen of texture.
SIZE = {"width": 860, "height": 420}
#: Part of the view that nothing lies on, as left, top, right, bottom.
WATCH = Watch((300, 130, 740, 340))


@pytest.fixture(scope="module")
def demo(opengl: object) -> Iterator[Served]:
    started = start("demo", "--example", "double_gyre", "--samples", "9")
    yield started
    if started.process.returncode is None:
        started.end(signal.SIGINT)


@pytest.fixture(scope="module")
def opened(browser: Browser, demo: Served) -> Iterator[Page]:
    """The page of the demo, with what it complained of and asked for in ``page.heard``."""
    context = new_context(browser, viewport=SIZE)
    page = context.new_page()
    server_draws(page)
    heard: dict[str, list[str]] = {"errors": [], "asked": []}
    page.on("console", lambda m: heard["errors"].append(m.text) if m.type == "error" else None)
    page.on("pageerror", lambda error: heard["errors"].append(str(error)))
    page.on("request", lambda request: heard["asked"].append(request.url))
    page.heard = heard  # type: ignore[attr-defined]
    page.goto(demo.address)
    WATCH.settled(page, 0)
    yield page
    context.close()


def fineness(pixels: Any) -> float:
    """Strength of what changes from one pixel to the next, wherever the flow goes."""
    return float(np.mean([np.abs(np.diff(pixels, axis=axis)).mean() for axis in (0, 1)]))


def home(page: Page) -> Any:
    before = count(page)
    page.locator("button[data-name=home]").click()
    return WATCH.settled(page, before)


def zoom(page: Page, notches: int) -> Any:
    before = count(page)
    page.mouse.move(430, 230)
    for _ in range(notches):
        page.mouse.wheel(0, -100)
    return WATCH.settled(page, before)


def test_the_flow_appears_zooms_and_is_dragged(opened: Page) -> None:
    whole = WATCH.shot(opened)
    assert fineness(whole) > 8
    text = opened.inner_text(".flowtex-page").lower()
    assert "double gyre" in text and "201 × 101 nodes" in text
    closer = zoom(opened, 12)
    assert difference(whole, closer) > 8
    assert fineness(closer) > 0.4 * fineness(whole)
    assert 10 < zoom_of(opened) < 25
    before = count(opened)
    opened.mouse.move(320, 200)
    opened.mouse.down()
    opened.mouse.move(380, 230, steps=8)
    opened.mouse.up()
    moved = WATCH.settled(opened, before)
    assert difference(moved[30:, 60:], closer[:-30, :-60]) < 0.25 * difference(moved, closer)


def test_play_changes_one_picture_after_the_other(opened: Page) -> None:
    home(opened)
    opened.evaluate(
        """() => {
          window.pictures = 0;
          const view = document.querySelector(".flowtex-views");
          const paint = view.paint.bind(view);
          view.paint = (...values) => { window.pictures += 1; paint(...values); };
        }"""
    )
    before, still = count(opened), WATCH.shot(opened)
    opened.locator("button[data-name=play]").click()
    opened.wait_for_function("() => window.pictures > 4")
    one = WATCH.shot(opened)
    seen = opened.evaluate("() => window.pictures")
    opened.wait_for_function("n => window.pictures > n + 3", arg=seen)
    other = WATCH.shot(opened)
    assert difference(one, still) > 2 and difference(one, other) > 2
    opened.locator("button[data-name=play]").click()
    WATCH.settled(opened, before)
    quiet = opened.evaluate("() => window.pictures")
    # The server answers what it is asked after that, and sends no picture.
    opened.mouse.move(400, 220)
    opened.mouse.move(410, 215)
    opened.wait_for_function(
        "() => document.querySelector('.flowtex').shadowRoot"
        ".querySelector('.readout').textContent.includes('speed')"
    )
    assert opened.evaluate("() => window.pictures") == quiet


def test_a_draft_that_follows_a_full_picture_is_not_sharp(opened: Page) -> None:
    home(opened)
    sharp = opened.evaluate(
        """async () => {
          const view = document.querySelector(".flowtex-views");
          const picture = await createImageBitmap(view.first.canvas);
          return [false, true].map((full) => {
            view.paint(picture, 0, full);
            return document.querySelector(".flowtex").dataset.sharp;
          });
        }"""
    )
    assert sharp == ["false", "true"]


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


def test_a_page_loaded_again_still_opens(opened: Page) -> None:
    assert "secret" not in opened.url
    opened.reload()
    WATCH.settled(opened, 0)


def test_without_the_right_secret_there_is_no_picture(page: Page, demo: Served) -> None:
    tried: list[object] = []
    page.on("websocket", lambda link: tried.append(link))
    for path in ("", "index.html", "?secret=wslink-secret"):
        page.goto(demo.bare + path)
        page.get_by_text("including the secret").wait_for()
        assert page.locator(".flowtex-page").count() == 0
    assert not tried


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.skipif(not Path("/proc").is_dir(), reason="reads /proc")
def test_the_secret_is_new_each_time_and_not_in_the_list_of_processes(demo: Served) -> None:
    secret = demo.address.split("secret=")[1]
    assert len(secret) >= 24 and secret != "wslink-secret"
    assert secret not in Path(f"/proc/{demo.process.pid}/cmdline").read_text(encoding="utf-8")


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_ctrl_c_ends_it_at_once_with_a_page_open(opened: Page, demo: Served) -> None:
    assert opened.locator('.flowtex[data-sharp="true"]').is_visible()
    demo.process.send_signal(signal.SIGINT)
    rest, _ = demo.process.communicate(timeout=PATIENCE_S)
    assert demo.process.returncode == 0
    lines = [line for line in rest.splitlines() if "Trigger nothing" not in line]
    assert "Traceback" not in rest and len(lines) <= 4
    with socket.socket() as link:
        assert link.connect_ex(demo.place) != 0


def test_a_port_in_use_is_told() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        command = [sys.executable, "-m", "flowtex.cli", "demo", "--no-browser", "--port", str(port)]
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=PATIENCE_S, check=False
        )
    assert done.returncode == 2
    assert f"cannot listen on 127.0.0.1:{port}" in done.stderr and "Traceback" not in done.stderr
