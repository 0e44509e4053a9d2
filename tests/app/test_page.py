"""The page used as a person uses it: files, planes, colours, reading, panes, saving, sharing."""

from __future__ import annotations

import base64
import io
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import pyvista as pv
from pages import new_context, painted
from PIL import Image
from served import start
from waiting import wait_until
from watching import Watch, count, difference

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator, Page

pytest.importorskip("trame_rca")

pytestmark = [pytest.mark.browser, pytest.mark.usefixtures("opengl")]

SIZE = {"width": 1000, "height": 600}
#: Part of the picture that nothing lies on, as left, top, right, bottom.
WATCH = Watch((300, 120, 680, 420), "RGB")
ADDRESS = re.compile(r"http://\S+").search


def block(turn: float) -> pv.StructuredGrid:
    """A block of 20 x 16 x 6 nodes; its vortex grows stronger with k."""
    x, y, z = np.meshgrid(
        np.linspace(-2, 2, 20), np.linspace(-1.5, 1.5, 16), np.linspace(0, 1, 6), indexing="ij"
    )
    mesh = pv.StructuredGrid(x, y, z)
    px, py, pz = mesh.points.T
    spin = turn * (0.3 + pz)
    mesh["wind"] = np.stack([1 - spin * py, spin * px, 0 * px], axis=-1)
    mesh["water"] = np.stack([0 * px, 1 + 0 * px, 0 * px], axis=-1)
    mesh["height"] = pz.copy()
    return mesh


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a block, a time series, a broken file, and a secret beside it."""
    outside = tmp_path_factory.mktemp("data")
    inside = outside / "runs"
    inside.mkdir()
    block(1.0).save(inside / "block.vts")
    for n in range(3):
        plane = block(float(n)).extract_subset((0, 19, 0, 15, 2, 2))
        plane.save(outside / f"step{n}.vts")
    lines = [f'<DataSet timestep="{n}" part="0" file="../step{n}.vts"/>' for n in range(3)]
    head = '<?xml version="1.0"?><VTKFile type="Collection" version="0.1"><Collection>'
    (inside / "series.pvd").write_text(head + "".join(lines) + "</Collection></VTKFile>")
    (inside / "torn.vts").write_text("<VTKFile")
    pv.Sphere().save(inside / "hull.stl")
    block(1.0).save(outside / "private.vts")
    (inside / "link.vts").symlink_to(outside / "private.vts")
    return inside


@pytest.fixture(scope="module")
def page(browser: Browser, folder: Path) -> Iterator[Page]:
    served = start("show", str(folder), "--samples", "9")
    context = new_context(browser, viewport=SIZE)
    opened = context.new_page()
    wrong: list[str] = []
    opened.on("pageerror", lambda error: wrong.append(str(error)))
    context.first_address = served.address  # type: ignore[attr-defined]
    opened.goto(served.address)
    settled(opened, 0)
    yield opened
    context.close()
    said = served.end(signal.SIGINT)
    assert not wrong
    assert "Traceback" not in said


def settled(page: Page, before: int) -> Any:
    """Wait for the next full picture, with the pointer away: a tip or a hint would lie on it."""
    page.mouse.move(5, 500)
    return WATCH.settled(page, before)


def group(page: Page, name: str) -> None:
    """Unfold a group of the panel."""
    button = page.locator(".flowtex-more", has_text=name)
    if button.get_attribute("aria-expanded") != "true":
        button.click()


def choose(page: Page, where: Locator, what: str) -> None:
    """Choose from a menu."""
    where.locator(".v-field").click()
    page.locator(".v-overlay--active .v-list-item", has_text=what).first.click()


def open_file(page: Page, name: str) -> None:
    page.get_by_label("Open another file").click()
    page.locator(".v-overlay--active .v-list-item", has_text=name).click()


def test_a_folder_offers_its_files_and_nothing_beside_them(page: Page) -> None:
    page.get_by_label("Open another file").click()
    items = page.locator(".v-overlay--active .v-list-item")
    items.first.wait_for()  # a menu that is still opening has no text
    names = items.all_inner_texts()
    assert names[:3] == ["block.vts", "series.pvd", "torn.vts"]
    assert len(names) == 4 and names[3].startswith("hull.stl") and "no vectors" in names[3]
    page.keyboard.press("Escape")
    page.wait_for_selector(".v-overlay--active", state="hidden")


def test_planes_and_arrays_can_be_chosen(page: Page) -> None:
    assert "k = 3" in page.inner_text(".flowtex-planes")
    middle, before = WATCH.shot(page), count(page)
    slider = page.get_by_role("slider", name="Plane")
    slider.focus()
    page.keyboard.press("End")
    last = settled(page, before)
    assert "k = 5" in page.inner_text(".flowtex-planes")
    assert difference(last, middle) > 3
    before = count(page)
    choose(page, page.locator(".flowtex-planes .flowtex-row"), "water")
    assert difference(settled(page, before), last) > 3
    before = count(page)
    page.locator(".flowtex-planes").get_by_role("button", name="i", exact=True).click()
    settled(page, before)
    assert "i = 10" in page.inner_text(".flowtex-planes")
    assert "16 × 6" in page.inner_text(".flowtex-about")


@pytest.mark.parametrize("width", [1000, 700, 380])
def test_the_play_button_stays_when_the_figures_grow(page: Page, width: int) -> None:
    page.set_viewport_size({"width": width, "height": 600})
    figures, play = page.locator(".flowtex-figures"), page.get_by_role("button", name="Play")
    places = []
    for text in (
        "9 ms",
        "12 fps · 1234 ms · limited by compression · 1600 × 1000 · zoom 1000000",
    ):
        figures.evaluate("(element, text) => void (element.textContent = text)", text)
        places.append(play.bounding_box())
        foot, whole = figures.bounding_box(), play.locator("..").bounding_box()
        assert foot is not None and whole is not None
        assert foot["x"] >= whole["x"] + whole["width"] or foot["y"] >= whole["y"] + whole["height"]
    page.set_viewport_size(SIZE)  # type: ignore[arg-type]
    assert places[0] == places[1] is not None


def test_what_has_the_focus_has_a_ring(page: Page) -> None:
    rings = """() => [...document.querySelectorAll(".flowtex *")].filter((element) =>
      getComputedStyle(element).outline.startsWith("rgb(79, 209, 197) solid 2px")).length"""
    page.get_by_role("button", name="Play").focus()
    for _ in range(16):
        page.keyboard.press("Tab")
        focused = page.evaluate("() => !!document.activeElement.closest('.flowtex')")
        assert page.evaluate(rings) == focused
    page.evaluate("() => document.activeElement.blur()")


def test_a_broken_file_is_told_and_the_view_stands(page: Page) -> None:
    page.evaluate("document.activeElement.blur()")
    before = count(page)
    page.keyboard.press("0")
    still = settled(page, before)
    open_file(page, "torn.vts")
    page.get_by_text(re.compile("torn.vts.*cut short")).wait_for()
    assert "block" in page.inner_text(".flowtex-title").lower()
    page.get_by_text(re.compile("torn.vts.*cut short")).wait_for(state="hidden")
    WATCH.comes_to(page, still)


def test_a_file_is_sent_and_shown(page: Page, folder: Path, tmp_path: Path) -> None:
    chosen = page.get_by_label("A file of yours")
    chosen.set_input_files(folder / "series.pvd")
    page.get_by_text(re.compile("series.pvd: expected one file")).wait_for()
    page.get_by_role("button", name="Close").click()
    mine = tmp_path / "mine.vts"
    block(3.0).save(mine)
    before = count(page)
    page.evaluate(
        """text => {
          const sent = new DataTransfer();
          sent.items.add(new File([Uint8Array.from(atob(text), c => c.charCodeAt(0))], "mine.vts"));
          for (const name of ["dragover", "drop"]) {
            const event = new DragEvent(name, { dataTransfer: sent, bubbles: true });
            document.body.dispatchEvent(event);
          }
        }""",
        base64.b64encode(mine.read_bytes()).decode(),
    )
    page.locator(".flowtex-name", has_text="mine").wait_for()
    settled(page, before)
    page.get_by_label("Open another file").click()
    page.locator(".v-overlay--active .v-list-item", has_text="mine.vts").wait_for()
    page.keyboard.press("Escape")
    page.wait_for_selector(".v-overlay--active", state="hidden")


def test_a_hint_goes_with_the_pointer_and_with_a_click(page: Page) -> None:
    hint = page.get_by_role("tooltip")
    theme = page.get_by_role("button", name="Light or dark")
    theme.hover()
    hint.get_by_text("Light or dark").wait_for()
    page.mouse.move(5, 500)
    hint.wait_for(state="hidden")
    theme.hover()
    hint.get_by_text("Light or dark").wait_for()
    before = count(page)
    theme.click()
    # Of two timers of a page the one that begins later, and is as long, ends later.
    page.evaluate("() => new Promise((f) => setTimeout(f, 400))")
    assert not hint.is_visible()
    theme.click()
    settled(page, before)
    page.keyboard.press("Tab")
    hint.wait_for()
    page.evaluate("document.activeElement.blur()")
    hint.wait_for(state="hidden")


def test_what_makes_no_difference_says_where_it_would(page: Page) -> None:
    group(page, "Noise")
    row = page.locator("[data-setting=tiles]")
    assert float(row.evaluate("row => getComputedStyle(row).opacity")) < 1
    assert "Only where Noise is not procedural" in str(row.get_attribute("data-hint"))
    group(page, "View")


def test_the_whole_surface_lies_beside_the_panel(page: Page) -> None:
    page.evaluate("document.activeElement.blur()")
    before = count(page)
    page.keyboard.press("0")
    settled(page, before)
    with Image.open(io.BytesIO(page.screenshot())) as picture:
        seen = np.asarray(picture.convert("RGB"), dtype=int)
    ground = np.array([0x12, 0x16, 0x1C])
    drawn = np.abs(seen - ground).max(axis=2) > 60
    panel = page.locator(".flowtex-panel").bounding_box()
    assert panel is not None
    left = int(panel["x"])
    assert drawn[150:400, left - 6 : left - 1].mean() < 0.05
    assert drawn[150:400, left // 4 : left // 2].mean() > 0.5


@pytest.mark.parametrize("height", [500, 844])
def test_the_panel_of_a_narrow_page_ends_above_the_player(page: Page, height: int) -> None:
    page.set_viewport_size({"width": 390, "height": height})
    # The page folds the panel away when it hears of its size, before it draws the second frame.
    page.wait_for_function("() => innerWidth === 390")
    page.evaluate("() => new Promise((f) => requestAnimationFrame(() => requestAnimationFrame(f)))")
    if not page.locator(".flowtex-panel").is_visible():
        page.get_by_label("Controls", exact=True).click()
    group(page, "Texture")
    panel, player = (
        page.locator(name).bounding_box() for name in (".flowtex-panel", ".flowtex-player")
    )
    assert panel is not None and player is not None
    assert panel["y"] + panel["height"] <= player["y"]
    page.set_viewport_size(SIZE)  # type: ignore[arg-type]


def test_a_series_plays_and_steps(page: Page) -> None:
    before = count(page)
    open_file(page, "series.pvd")
    page.locator(".flowtex-about", has_text="3 times").wait_for()
    late = settled(page, before)
    before = count(page)
    page.get_by_label("A step back").click()
    assert difference(settled(page, before), late) > 3
    assert "t = 1.00" in page.inner_text(".flowtex-moment")
    page.get_by_label("Play").click()
    page.wait_for_function(
        "() => !document.querySelector('.flowtex-moment').innerText.includes('1.00')"
    )
    before = count(page)
    page.get_by_label("Pause").click()
    settled(page, before)


def test_colours_and_their_range(page: Page) -> None:
    before, speed = count(page), WATCH.shot(page)
    choose(page, page.locator("[data-setting=colour]"), "height")
    assert difference(settled(page, before), speed) > 3
    before = count(page)
    choose(page, page.locator("[data-setting=colour]"), "speed")
    settled(page, before)
    group(page, "Colours")
    before = count(page)
    choose(page, page.locator("[data-setting=cmap]"), "magma")
    magma = settled(page, before)
    assert difference(magma, speed) > 5
    before = count(page)
    page.get_by_label("Highest value").fill("100")
    page.get_by_label("Highest value").press("Enter")
    assert settled(page, before).mean() < 0.7 * magma.mean()
    assert "100" in page.inner_text(".flowtex-bar")
    before = count(page)
    page.locator("button.flowtex-link").get_by_text("auto", exact=True).click()
    assert difference(settled(page, before), magma) < 1


def test_every_control_says_what_it_does(page: Page) -> None:
    from flowtex.settings import TABLE

    page.locator("[data-setting=lod] .flowtex-label").hover()
    page.get_by_text(TABLE["lod"].text).wait_for()


def test_the_pointer_reads_the_flow_and_a_click_shows_the_path(page: Page) -> None:
    page.mouse.move(440, 300)
    page.mouse.move(450, 305)
    tip = page.locator(".flowtex-tip")
    tip.wait_for()
    assert "velocity" in tip.inner_text() and "height" in tip.inner_text()
    page.mouse.down()
    page.mouse.up()
    page.locator(".flowtex-card").wait_for()
    text = page.inner_text(".flowtex-card")
    told = re.search(r"samples\s+(\d+)", text)
    assert told and page.locator(".flowtex-bars > i").count() == int(told[1]) >= 9
    assert "level of detail" in text and "grain" in text
    point = page.locator(".flowtex-path .point")
    x, y = float(point.get_attribute("cx") or 0), float(point.get_attribute("cy") or 0)
    assert abs(x - 450) < 1 and abs(y - 305) < 1
    before = count(page)
    page.mouse.move(500, 400)
    page.mouse.down()
    page.mouse.move(540, 420, steps=4)
    page.mouse.up()
    settled(page, before)
    assert abs(float(point.get_attribute("cx") or 0) - 490) < 1.5
    page.locator(".flowtex-card").get_by_text("Close").click()
    page.locator(".flowtex-card").wait_for(state="hidden")


def test_keys_move_the_view_and_change_the_page(page: Page) -> None:
    page.evaluate("document.activeElement.blur()")  # a menu would take the key
    before = count(page)
    page.keyboard.press("0")
    whole = settled(page, before)
    before = count(page)
    page.keyboard.press("+")
    closer = settled(page, before)
    assert difference(closer, whole) > 3 and "zoom 1.3" in page.inner_text(".flowtex-figures")
    before = count(page)
    page.keyboard.press("ArrowLeft")
    assert difference(settled(page, before), closer) > 3
    before = count(page)
    page.keyboard.press("t")
    page.locator(".flowtex-light").wait_for()
    settled(page, before)
    page.keyboard.press("?")
    page.locator(".flowtex-help").wait_for()
    page.keyboard.press("Escape")
    page.locator(".flowtex-help").wait_for(state="hidden")
    before = count(page)
    page.keyboard.press("t")
    settled(page, before)


def test_two_fingers_zoom(page: Page) -> None:
    page.evaluate("document.activeElement.blur()")
    before = count(page)
    page.keyboard.press("0")
    whole = settled(page, before)
    touch = page.context.new_cdp_session(page)

    def fingers(kind: str, apart: int) -> None:
        points = [{"x": 490 - apart, "y": 300, "id": 0}, {"x": 490 + apart, "y": 300, "id": 1}]
        found = [] if kind == "touchEnd" else points
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": found})

    before = count(page)
    fingers("touchStart", 40)
    for apart in range(45, 105, 5):
        fingers("touchMove", apart)
        painted(page)
    fingers("touchEnd", 100)
    assert difference(settled(page, before), whole) > 3
    found = re.search(r"zoom ([\d.]+)", page.inner_text(".flowtex-figures"))
    assert found and 1.5 < float(found[1]) < 3
    assert not page.locator(".flowtex-card").is_visible()


def test_two_panes_move_together(page: Page) -> None:
    page.evaluate("document.activeElement.blur()")  # a menu would take the key
    before = count(page)
    page.keyboard.press("0")
    settled(page, before)
    group(page, "View")
    before = count(page)
    choose(page, page.locator("[data-setting=compare]"), "Show level: on")
    both = settled(page, before)
    middle = SIZE["width"] // 2 - WATCH.left
    left, right = both[:, : middle - 4], both[:, middle + 4 :]
    assert difference(left.mean(axis=(0, 1)), right.mean(axis=(0, 1))) > 10
    before = count(page)
    page.mouse.move(320, 300)
    page.mouse.wheel(0, -500)
    moved = settled(page, before)
    assert difference(moved[:, : middle - 4], left) > 3
    assert difference(moved[:, middle + 4 :], right) > 3
    before = count(page)
    choose(page, page.locator("[data-setting=compare]"), "nothing")
    settled(page, before)


def test_two_files_stand_beside_each_other(page: Page) -> None:
    if "series" not in page.inner_text(".flowtex-title"):
        before = count(page)
        open_file(page, "series.pvd")
        settled(page, before)
    group(page, "View")
    before = count(page)
    choose(page, page.locator("[data-setting=compare]"), "Another file")
    # The next file of the folder is a broken one.
    page.get_by_text(re.compile(r"torn\.vts: ")).wait_for()
    page.locator(".flowtex-complaint").get_by_role("button", name="Close").click()
    assert not page.locator(".flowtex-panes").is_visible()
    one = settled(page, before)
    before = count(page)
    choose(page, page.locator("[data-setting=file_beside]"), "block.vts")
    page.locator(".flowtex-chip", has_text="block.vts").wait_for()
    both = settled(page, before)
    assert page.locator(".flowtex-chip").first.inner_text().startswith("series.pvd · t = ")
    middle = SIZE["width"] // 2 - WATCH.left
    assert difference(both[:, : middle - 4].mean(axis=(0, 1)), one.mean(axis=(0, 1))) < 40
    before = count(page)
    page.mouse.move(650, 300)
    page.mouse.wheel(0, -500)
    moved = settled(page, before)
    for half in (slice(0, middle - 4), slice(middle + 4, None)):
        assert difference(moved[:, half], both[:, half]) > 3
    before = count(page)
    choose(page, page.locator("[data-setting=compare]"), "nothing")
    settled(page, before)
    assert page.locator("[data-setting=file_beside]").count() == 0


def test_the_browser_draws_the_same_from_the_same_camera(page: Page) -> None:
    page.evaluate("document.activeElement.blur()")  # a menu would take the key
    before = count(page)
    page.keyboard.press("0")
    page.keyboard.press("+")
    here = settled(page, before)
    group(page, "View")
    before = count(page)
    page.get_by_role("button", name="browser", exact=True).click()
    there = settled(page, before)
    assert page.locator(".flowtex-client canvas").count() >= 1
    # Either has its own look at the edge of a pixel; another camera differs by far more.
    assert difference(there, here) < 12
    before = count(page)
    page.mouse.move(450, 300)
    page.mouse.down()
    page.mouse.move(500, 320, steps=4)
    page.mouse.up()
    moved = settled(page, before)
    assert difference(moved, there) > 2 * difference(there, here)
    before = count(page)
    page.get_by_role("button", name="server", exact=True).click()
    back = settled(page, before)
    assert difference(back, moved) < 12


def test_a_picture_is_saved_at_any_size(page: Page, tmp_path: Path) -> None:
    group(page, "Save")
    page.get_by_label("Width in pixels").fill("1200")
    page.get_by_label("Height in pixels").fill("300")
    page.get_by_label("Height in pixels").press("Enter")
    page.get_by_text("Make it").click()
    link = page.get_by_text(re.compile(r"Save .*\.png"))
    link.wait_for()
    with page.expect_download() as download:
        link.click()
    download.value.save_as(tmp_path / "a.png")
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.size == (1200, 300)
        pixels = np.asarray(picture.convert("L"), dtype=float)
    assert np.abs(np.diff(pixels, axis=0))[100:200, 500:700].mean() > 3


def test_a_movie_is_saved_and_can_be_cancelled(page: Page, tmp_path: Path) -> None:
    av = pytest.importorskip("av")
    group(page, "Save")
    page.get_by_role("button", name="MP4", exact=True).click()
    for name, value in (
        ("Width in pixels", "160"),
        ("Height in pixels", "100"),
        ("Seconds", "30"),
        ("Pictures in a second", "20"),
    ):
        page.get_by_label(name, exact=True).fill(value)
        page.get_by_label(name, exact=True).press("Enter")
    page.get_by_text("Make it").click()
    page.locator(".flowtex-panel").get_by_text("Cancel").click()
    page.get_by_text("Make it").wait_for()
    page.get_by_label("Seconds", exact=True).fill("1")
    page.get_by_label("Seconds", exact=True).press("Enter")
    page.get_by_text("Make it").click()
    link = page.get_by_text(re.compile(r"Save .*\.mp4"))
    link.wait_for()
    with page.expect_download() as download:
        link.click()
    download.value.save_as(tmp_path / "a.mp4")
    with av.open(str(tmp_path / "a.mp4")) as movie:
        frames = [frame.to_ndarray(format="rgb24") for frame in movie.decode(video=0)]
    assert len(frames) == 20 and frames[0].shape == (100, 160, 3)
    assert difference(frames[0].astype(float), frames[10].astype(float)) > 2


def test_a_link_and_lines_of_python_tell_the_state(page: Page, folder: Path) -> None:
    page.evaluate("document.activeElement.blur()")  # a menu would take the key
    before = count(page)
    page.keyboard.press("0")
    settled(page, before)
    group(page, "Share")
    page.get_by_text("Describe what is shown").click()
    page.locator(".flowtex-text").nth(1).wait_for()
    link, python = page.locator(".flowtex-text").all_inner_texts()
    assert "file=series.pvd" in link and "cmap=magma" in link
    assert "series.pvd" in python and "pl.flowtex.add" in python
    seen = WATCH.shot(page)
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.get_by_label("Copy the link").click()
    copied = page.evaluate("navigator.clipboard.readText()")
    assert copied == link.strip()
    assert copied.startswith(page.context.first_address)  # type: ignore[attr-defined]
    other = page.context.new_page()
    other.set_viewport_size(SIZE)  # type: ignore[arg-type]
    other.goto(copied)
    other.get_by_text("3 times").wait_for()
    settled(other, count(other) - 1)
    other.wait_for_function("() => document.querySelector('[data-picture=sharp]')")
    WATCH.comes_to(other, seen)
    other.close()


OWN = """import flowtex
mesh = flowtex.examples.double_gyre()
BLOCK
server.controller.on_server_ready.add(
    lambda **_: print(f"http://127.0.0.1:{server.port}/", flush=True))
server.start(host="127.0.0.1", port=0, open_browser=False, show_connection_info=False)
"""


def test_the_view_alone_serves_in_an_application_of_ones_own(page: Page) -> None:
    """The lines of docs/app.md, as they stand there."""
    text = (Path(__file__).parents[2] / "docs" / "app.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"```py\n(from flowtex.app import FlowArea\n.*?)```", text, re.DOTALL)
    assert block.endswith("server.start()\n")
    script = OWN.replace("BLOCK", block.removesuffix("server.start()\n"))
    process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
    page.set_viewport_size({"width": 400, "height": 300})
    try:
        address = next(found.group() for line in process.stdout or () if (found := ADDRESS(line)))
        page.goto(address)
        page.locator("img").wait_for()
        pictures: list[Any] = []

        def moves() -> bool:
            """Whether it plays: no two pictures are the same."""
            shown = Watch((20, 20, 380, 280)).shot(page)
            if np.abs(np.diff(shown, axis=0)).mean() > 5:
                pictures.append(shown)
            return len(pictures) > 1 and difference(pictures[0], pictures[-1]) > 2

        wait_until(moves)
    finally:
        process.kill()
        process.communicate()
