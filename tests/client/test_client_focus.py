"""Names of controls, the focus, and the keys of an exported page, without a mouse."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from pages import COMPLETE, focused, opened_page, operated

import flowtex

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def exported(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Address of a page of a formula with parameters, whose controls are all there."""
    file: Path = tmp_path_factory.mktemp("page") / "flow.html"
    field = flowtex.formula("y", "-sin(x) - b*y", x=(-4, 4), y=(-3, 3), b=0.2)
    flowtex.export(field, file, samples=9)
    return file.as_uri()


NARROW = (340, 420)
WIDE = (900, 600)


@pytest.fixture
def page(exported: str, browser: Browser, request: Any) -> Iterator[Page]:
    width, height = getattr(request, "param", NARROW)
    with opened_page(browser, width, height) as page:
        page.goto(exported)
        page.wait_for_selector(COMPLETE)
        yield page


@pytest.mark.parametrize("page", [NARROW, WIDE], indirect=True)
def test_each_control_has_a_name(page: Page) -> None:
    page.keyboard.press("?")
    page.locator(".help").wait_for()
    page.get_by_role("button", name="Settings").click()
    page.locator(".settings").wait_for()
    found = operated(page)
    assert [role for role, name in found if not name] == []
    assert {"slider", "button", "switch", "combobox", "spinbutton"} <= set(dict(found))
    assert ("slider", "Opacity") in found
    assert ("slider", "b") in found


@pytest.mark.parametrize("name", ["Opacity", "viridis", "Lowest value", "Colour by"])
def test_escape_in_the_settings_gives_the_focus_back(page: Page, name: str) -> None:
    page.get_by_role("button", name="Settings").click()
    page.get_by_label(name, exact=True).first.focus()
    page.keyboard.press("Escape")
    page.locator(".settings").wait_for(state="hidden")
    assert focused(page) == "Settings"


def test_the_focus_stays_when_controls_change(page: Page) -> None:
    page.get_by_role("button", name="Settings").click()
    swatch = page.locator(".swatches button[aria-pressed=false]").first
    name = swatch.get_attribute("title")
    swatch.press("Enter")
    page.locator(f".swatches button[title={name}][aria-pressed=true]").wait_for()
    assert focused(page) == name
    page.get_by_role("button", name="Hide the bar").press("Enter")
    assert focused(page) == "Show the bar (h)"
    page.keyboard.press("Enter")
    assert focused(page) == "Hide the bar (h)"


def test_keys_are_explained_and_the_focus_comes_back(page: Page) -> None:
    page.locator(".flowtex").focus()
    page.keyboard.press("?")
    dialog = page.get_by_role("dialog", name="Keys and the mouse")
    dialog.wait_for()
    assert focused(page) == "Close"
    page.keyboard.press("Escape")
    dialog.wait_for(state="hidden")
    assert str(focused(page)).startswith("Flow texture")
    page.get_by_role("button", name="Settings").click()
    opener = page.get_by_role("button", name="Keys and the mouse (?)")
    opener.press("Enter")
    dialog.wait_for()
    page.get_by_role("button", name="Close").press("Enter")
    dialog.wait_for(state="hidden")
    assert focused(page) == "Keys and the mouse (?)"


def test_the_keys_that_are_listed_do_something(page: Page) -> None:
    state = "() => JSON.stringify(document.querySelector('flowtex-view').first.cameraState)"
    before = page.evaluate(state)
    for key in ("ArrowLeft", "+", "-"):
        page.keyboard.press(key)
        assert page.evaluate(state) != before
    page.keyboard.press("h")
    page.get_by_role("button", name="Show the bar").wait_for()
    page.keyboard.press("h")
    lod = page.get_by_role("button", name="Level of detail")
    pressed = lod.get_attribute("aria-pressed")
    page.keyboard.press("d")
    assert lod.get_attribute("aria-pressed") != pressed
    page.keyboard.press(" ")
    page.get_by_role("button", name="Pause").wait_for()
    page.keyboard.press("0")
    zoom = "() => document.querySelector('flowtex-view').first.camera.zoom"
    assert page.evaluate(zoom) == pytest.approx(1.0)


def test_keys_work_at_a_slider(page: Page) -> None:
    page.get_by_role("button", name="Settings").click()
    page.get_by_role("slider", name="Opacity").focus()
    page.keyboard.press("?")
    page.locator(".help").wait_for()
