"""Hands on the browser client: fingers, the wheel on a page that scrolls, two views, and files."""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from flows import gyre
from matrix import SIZE, WHOLE
from PIL import Image
from webgl_page import ClientPage, packed, state

from flowtex.rendering.camera import Camera
from flowtex.rendering.webgl.client_data import ClientData, Colours
from flowtex.scene.scene import Scene
from flowtex.settings import Settings

if TYPE_CHECKING:
    from playwright.sync_api import CDPSession

pytestmark = pytest.mark.browser


def scene(camera: Camera = WHOLE, *, beside: Mapping[str, Any] | None = None) -> Any:
    settings = Settings(samples=7)
    textures = Scene(gyre(), settings).textures
    whole = ClientData(textures, Colours(plain=(0.6, 0.6, 0.6)))
    header = whole.header(settings, camera=state(camera))
    if beside is None:
        return packed(whole, header)
    header["differs"] = list(beside)
    other = {**header, "settings": {**header["settings"], **beside}, "own": dict(beside)}
    return [packed(whole, header), packed(whole, other)]


def number(client: ClientPage, expression: str) -> Any:
    return client.page.evaluate(f"() => {expression}")


def middle(client: ClientPage, nth: int = 0) -> tuple[float, float]:
    found = client.page.locator(".flowtex .picture").nth(nth).bounding_box()
    assert found is not None
    return found["x"] + found["width"] / 2, found["y"] + found["height"] / 2


# --- fingers ----------------------------------------------------------------------------------


@contextmanager
def fingers(client: ClientPage) -> Iterator[CDPSession]:
    session = client.page.context.new_cdp_session(client.page)
    session.send("Emulation.setTouchEmulationEnabled", {"enabled": True, "maxTouchPoints": 2})
    yield session
    session.send("Emulation.setTouchEmulationEnabled", {"enabled": False})
    session.detach()


def touch(session: CDPSession, kind: str, *at: tuple[float, float]) -> None:
    points = [{"x": x, "y": y, "id": n} for n, (x, y) in enumerate(at)]
    session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})


def test_one_finger_drags_and_two_zoom(client: ClientPage) -> None:
    client.mount(scene(), SIZE, controls=False, smooth=False)
    client.sharp()
    x, y = middle(client)
    start = number(client, "viewers[0].cameraState")
    a_pixel = 2 * WHOLE.parallel_scale / SIZE[1] if WHOLE.parallel_scale else 0.0
    with fingers(client) as session:
        touch(session, "touchStart", (x, y))
        for n in range(1, 6):
            touch(session, "touchMove", (x + 6 * n, y + 2 * n))
        touch(session, "touchEnd")
        client.page.wait_for_function("() => !viewers[0].pointers.down.size")
        dragged = number(client, "viewers[0].cameraState")
        moved = np.subtract(start["focal_point"], dragged["focal_point"])
        np.testing.assert_allclose(moved, [30 * a_pixel, -10 * a_pixel, 0], atol=a_pixel)
        # A point that both fingers hold stays between them.
        touch(session, "touchStart", (x - 20, y), (x + 20, y))
        for n in range(1, 6):
            touch(session, "touchMove", (x - 20 - 4 * n, y), (x + 20 + 4 * n, y))
        touch(session, "touchEnd")
    zoom = number(client, "viewers[0].camera.zoom")
    np.testing.assert_allclose(zoom, 2.0, rtol=0.03)
    now = number(client, "viewers[0].camera.state.focal_point")
    np.testing.assert_allclose(now, dragged["focal_point"], atol=2 * a_pixel)
    client.sharp()


# --- the wheel --------------------------------------------------------------------------------


@pytest.fixture
def scrolled(client: ClientPage) -> Iterator[ClientPage]:
    """A guarded view on a page that is higher than its window."""
    client.mount(scene(), SIZE, controls=False, smooth=False, guarded=True)
    client.sharp()
    number(client, "(document.body.style.height = '3000px', null)")
    yield client
    number(client, "(document.body.style.height = '', scrollTo(0, 0))")


def test_a_page_is_scrolled_past_a_view_until_it_is_clicked(scrolled: ClientPage) -> None:
    page, mouse = scrolled.page, scrolled.page.mouse
    x, y = middle(scrolled)
    mouse.move(x, y)
    mouse.wheel(0, 20)
    page.wait_for_function("() => scrollY === 20")
    assert number(scrolled, "viewers[0].camera.zoom") == 1
    assert "to zoom with the wheel" in page.locator(".hint").inner_text()
    # With the key it zooms without a click, and the page stays.
    page.keyboard.down("Control")
    mouse.wheel(0, -20)
    page.wait_for_function("() => viewers[0].camera.zoom > 1.2")
    page.keyboard.up("Control")
    # From a click on the wheel is the view's.
    mouse.click(x, y)
    assert page.locator(".hint").is_hidden()
    mouse.wheel(0, -100)
    page.wait_for_function("() => viewers[0].camera.zoom > 1.5")
    assert number(scrolled, "scrollY") == 20
    # Until somebody scrolls elsewhere.
    mouse.move(x, 400)
    mouse.wheel(0, 20)
    page.wait_for_function("() => scrollY === 40")
    zoom = number(scrolled, "viewers[0].camera.zoom")
    mouse.move(x, y - 20)
    mouse.wheel(0, 20)
    page.wait_for_function("() => scrollY === 60")
    assert number(scrolled, "viewers[0].camera.zoom") == zoom
    scrolled.sharp()


# --- buttons ----------------------------------------------------------------------------------


def test_the_picture_fills_the_screen_and_comes_back(client: ClientPage) -> None:
    client.mount(scene(), (460, 300), smooth=False)
    client.sharp()
    page = client.page
    page.locator("[data-name=full]").click()
    page.wait_for_function("() => document.fullscreenElement === viewers[0].root")
    page.wait_for_function("() => viewers[0].canvas.width > innerWidth - 80 && viewers[0].sharp")
    assert number(client, "viewers[0].root.clientHeight === innerHeight")
    page.locator("[data-name=full]").click()
    page.wait_for_function("() => !document.fullscreenElement && viewers[0].canvas.width < 460")
    client.sharp()


# --- two views --------------------------------------------------------------------------------

PAIR = "viewers[0].together"


def test_two_views_move_as_one_and_tell_their_difference(
    client: ClientPage, tmp_path: Path
) -> None:
    client.mount(scene(beside={"strength": 0.0}), (600, 300), smooth=False)
    page = client.page
    both = f"() => {PAIR}.length === 2 && {PAIR}.every((viewer) => viewer.sharp)"
    page.wait_for_function(both)
    assert page.locator(".title").all_inner_texts() == ["Strength: 0.65", "Strength: 0"]
    assert page.locator(".bar:visible").count() == 1
    page.evaluate(
        """() => {
          const element = viewers[0].root.parentElement;
          for (const name of ["camera", "setting", "playing"])
            element.addEventListener(name, ({ detail }) => events.push([name, detail]));
        }"""
    )
    # A drag on the right one.
    x, y = middle(client, 1)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 40, y + 10, steps=4)
    page.mouse.up()
    cameras = number(client, f"{PAIR}.map((viewer) => viewer.cameraState)")
    assert cameras[0] == cameras[1]
    assert cameras[0]["focal_point"][0] < WHOLE.focal_point[0]
    # Both stream by one clock, and only what is not its own is taken over.
    page.keyboard.press(" ")
    page.wait_for_function(f"() => {PAIR}[1].player.clock > 0.05 && {PAIR}[0].playing")
    page.keyboard.press(" ")
    number(client, "(viewers[0].choose('contrast', 2), viewers[0].choose('strength', 0.5), 0)")
    told = dict(page.evaluate("events"))
    assert told == {"camera": cameras[0], "playing": False, "setting": ["strength", 0.5]}
    chosen = number(client, f"{PAIR}.map(({{ settings: s, clock }}) => [s.strength, s.contrast])")
    assert chosen == [[0.5, 2], [0, 2]]
    page.wait_for_function(both)
    with page.expect_download() as started:
        page.locator("[data-name=save]").first.click()
    saved = Image.open(io.BytesIO(Path(started.value.path()).read_bytes()))
    width, height = number(client, "[viewers[0].canvas.width, viewers[0].canvas.height]")
    assert saved.size == (2 * width, height)
    middle_ = (slice(height // 2 - 15, height // 2 + 15), slice(width // 3, width // 2))
    grey = np.asarray(saved.convert("L"), dtype=float)
    assert grey[middle_].std() > 10 > grey[:, width:][middle_].std()
    number(client, f"{PAIR}.forEach((viewer) => viewer.dispose())")
    left = number(client, "viewers[0].stats()")
    assert not any(left[n] for n in ("objects", "users", "listeners", "observers", "timers"))
    assert number(client, "viewers[0].graphics.stock.size") == 0
