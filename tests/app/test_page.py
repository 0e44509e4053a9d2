"""The page used as a person uses it: files, planes, colours, reading, panes, saving, sharing."""

from __future__ import annotations

import base64
import re
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal
from urllib.parse import urlsplit

import numpy as np
import pytest
import pyvista as pv
from pages import focused, new_context, operated, painted
from PIL import Image
from served import Served, start
from waiting import wait_until
from watching import Watch, browser_draws, count, difference, zoom_of

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator, Page

pytest.importorskip("trame_rca")

pytestmark = [pytest.mark.browser, pytest.mark.usefixtures("opengl")]

SIZE = {"width": 960, "height": 480}
#: Part of the picture that nothing lies on, as left, top, right, bottom.
WATCH = Watch((240, 130, 600, 336), "RGB")
#: The first view of the page.
VIEW = "document.querySelector('.flowtex-views').first"
ROOT = Path(__file__).parents[2]
AXE = ROOT / "client" / "node_modules" / "axe-core" / "axe.min.js"
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
def served(folder: Path) -> Iterator[Served]:
    started = start("show", str(folder), "--samples", "5")
    yield started
    if started.process.returncode is None:
        started.end(signal.SIGINT)


@pytest.fixture(scope="module")
def page(browser: Browser, served: Served) -> Iterator[Page]:
    context = new_context(browser, viewport=SIZE)
    browser_draws(context)
    opened = context.new_page()
    wrong: list[str] = []
    opened.on("pageerror", lambda error: wrong.append(str(error)))
    context.first_address = served.address  # type: ignore[attr-defined]
    opened.goto(served.address)
    settled(opened, 0)
    yield opened
    context.close()
    assert not wrong


def settled(page: Page, before: int) -> Any:
    """Wait for the next full picture, with the pointer away: a hint would lie on it."""
    page.mouse.move(5, 400)
    return WATCH.settled(page, before)


def group(page: Page, name: str) -> None:
    """Unfold a group of the panel."""
    if not page.locator(".flowtex-panel").is_visible():
        page.get_by_role("button", name="Compare, save, share").click()
    button = page.locator(".flowtex-more", has_text=name)
    if button.get_attribute("aria-expanded") != "true":
        button.click()


def choose(page: Page, where: Locator, what: str) -> None:
    """Choose from a menu."""
    where.locator(".v-field").click()
    page.locator(".v-overlay--active .v-list-item", has_text=what).first.click()


def fold(page: Page) -> None:
    """Fold the panel, and the view's own settings."""
    page.keyboard.press("Escape")
    page.locator(".flowtex-panel").wait_for(state="hidden")


def controls(page: Page) -> None:
    """Unfold the settings of the view."""
    if not page.locator(".settings").first.is_visible():
        page.locator("button[data-name=settings]").first.click()


def open_file(page: Page, name: str) -> None:
    page.get_by_label("Open another file").click()
    page.locator(".v-overlay--active .v-list-item", has_text=name).click()


def test_a_folder_offers_its_files_and_nothing_beside_them(page: Page) -> None:
    page.get_by_label("Open another file").click()
    items = page.locator(".v-overlay--active .v-list-item")
    items.first.wait_for()  # a menu that is still opening has no text
    names = items.all_inner_texts()
    titles = [name.partition("\n")[0] for name in names]
    assert titles == ["block.vts", "series.pvd", "torn.vts", "hull.stl"]
    assert "put them into hull.npy" in names[3]
    assert items.nth(3).get_attribute("aria-disabled") == "true"
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
    # While the other array is being opened.
    page.locator(".flowtex-planes").get_by_role("button", name="i", exact=True).click()
    page.locator(".flowtex-planes", has_text="i = 10").wait_for()
    page.locator(".flowtex-about", has_text="16 × 6").wait_for()
    settled(page, before)
    assert "water" in page.inner_text(".flowtex-planes")


def test_axe_finds_nothing(page: Page) -> None:
    """In light and dark, with all unfolded; that phones cannot zoom in is trame's own."""
    if not AXE.exists():
        pytest.skip("npm has not fetched the client's tools: sh tools/client.sh .venv/bin")
    page.evaluate(AXE.read_text("utf-8"))
    rules = "{ rules: { 'meta-viewport': { enabled: false } } }"

    def faults() -> list[Any]:
        found = page.evaluate(f"axe.run(document, {rules})")["violations"]
        return [(fault["id"], [node["target"] for node in fault["nodes"]]) for fault in found]

    page.add_style_tag(content="* { transition: none !important; animation: none !important }")
    for _ in range(2):
        controls(page)
        assert faults() == []
        page.locator("button[data-name=settings]").first.click()
        before = count(page)
        page.get_by_role("button", name="Light or dark").click()
        settled(page, before)
    page.get_by_role("button", name="Compare, save, share").click()
    page.locator(".flowtex-panel").wait_for()
    assert faults() == []
    fold(page)


def test_a_file_is_sent_and_shown(page: Page, folder: Path, tmp_path: Path) -> None:
    chosen = page.get_by_label("Open file", exact=True)
    chosen.set_input_files(folder / "series.pvd")
    page.get_by_text(re.compile("series.pvd: this format cannot be uploaded")).wait_for()
    page.get_by_role("button", name="Close").click()
    mine = tmp_path / "mine.vts"
    block(3.0).translate((50.0, 0.0, 0.0)).save(mine)  # elsewhere
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
    assert np.ptp(settled(page, before)) > 100
    assert page.evaluate(f"{VIEW}.camera.state.focal_point[0]") == pytest.approx(50)
    page.get_by_label("Open another file").click()
    page.locator(".v-overlay--active .v-list-item", has_text="mine.vts").wait_for()
    page.keyboard.press("Escape")
    page.wait_for_selector(".v-overlay--active", state="hidden")


def test_a_series_plays_and_steps(page: Page) -> None:
    before = count(page)
    open_file(page, "series.pvd")
    page.locator(".flowtex-about", has_text="3 times").wait_for()
    early = settled(page, before)
    assert page.inner_text(".time") == "0"  # it begins at its first step
    before = count(page)
    page.get_by_label("Step forward").click()
    assert difference(settled(page, before), early) > 3
    assert page.inner_text(".time") == "1"
    page.locator("button[data-name=play]").click()
    page.wait_for_function("() => document.querySelector('.flowtex-views').first.player.time > 1.1")
    before = count(page)
    page.locator("button[data-name=play]").click()
    settled(page, before)


def test_the_pointer_reads_the_flow_and_a_click_shows_the_path(page: Page) -> None:
    page.mouse.move(340, 240)
    page.mouse.move(350, 245)
    page.wait_for_function(
        "() => document.querySelector('.flowtex').shadowRoot"
        ".querySelector('.readout').textContent.includes('speed')"
    )
    page.mouse.down()
    page.mouse.up()
    card = page.locator(".card")
    card.wait_for()
    text = card.inner_text()
    assert all(word in text for word in ("velocity", "height"))

    def middle() -> float:
        box = page.locator(".path .point").bounding_box()
        assert box is not None
        return box["x"] + box["width"] / 2

    assert abs(middle() - 350) < 1.5
    before = count(page)
    page.mouse.move(500, 320)
    page.mouse.down()
    page.mouse.move(540, 340, steps=4)
    page.mouse.up()
    settled(page, before)
    assert abs(middle() - 390) < 2
    card.get_by_text("Close").click()
    card.wait_for(state="hidden")


def test_keys_move_the_view_and_change_the_page(page: Page) -> None:
    page.evaluate("document.activeElement.blur()")  # a menu would take the key
    before = count(page)
    page.keyboard.press("0")
    whole, before = settled(page, before), count(page)
    page.keyboard.press("+")
    assert difference(settled(page, before), whole) > 3 and zoom_of(page) > 1.2
    toggled: tuple[Literal["visible", "detached"], ...] = ("visible", "detached")
    for shown in toggled:
        before = count(page)
        page.keyboard.press("t")
        page.locator(".flowtex-light").wait_for(state=shown)
        settled(page, before)
    page.keyboard.press("?")
    page.locator(".flowtex-help").wait_for()
    assert page.locator(".help").is_hidden()  # the view's own, in other hosts
    page.keyboard.press("Escape")
    page.locator(".flowtex-help").wait_for(state="hidden")


@pytest.mark.parametrize("name", ["Keys and the mouse", "Compare, save, share"])
def test_a_closed_panel_gives_the_focus_back(page: Page, name: str) -> None:
    page.get_by_role("button", name=name, exact=True).press("Enter")
    inside = page.locator(".flowtex-help, .flowtex-panel").locator("button:visible").first
    inside.focus()
    page.keyboard.press("Escape")
    inside.wait_for(state="hidden")
    painted(page)
    assert focused(page) == name


def test_each_control_has_a_name(page: Page) -> None:
    controls(page)
    for name in ("Keys and the mouse", "Compare, save, share"):
        page.get_by_role("button", name=name, exact=True).click()
    page.locator(".flowtex-help").wait_for()
    assert [role for role, name in operated(page) if not name] == []
    page.keyboard.press("Escape")
    page.locator(".flowtex-panel").wait_for(state="hidden")
    fold(page)


def test_the_page_explains_the_keys_of_all_views() -> None:
    def rows(file: Path, pattern: str) -> dict[str, str]:
        return dict(re.findall(pattern, file.read_text("utf-8")))

    shared = rows(ROOT / "client/src/help.ts", r'\["(.+?)", "(.+?)"\],')
    here = rows(ROOT / "flowtex/app/ui/page.html", r"<dt>(.+?)</dt><dd>(.+?)</dd>")
    assert here.pop("t") == "light or dark"
    assert {**here, "d": shared["d"]} == shared


def test_two_files_are_shown_side_by_side(page: Page) -> None:
    if "series" not in page.inner_text(".flowtex-title"):
        before = count(page)
        open_file(page, "series.pvd")
        settled(page, before)
    group(page, "View")
    choose(page, page.locator("[data-setting=compare]"), "File: torn.vts")
    page.get_by_text(re.compile(r"torn\.vts: ")).wait_for()
    page.locator(".flowtex-complaint").get_by_role("button", name="Close").click()
    choose(page, page.locator("[data-setting=compare]"), "File: block.vts")
    page.locator(".title", has_text="block.vts").wait_for()
    fold(page)
    both, before = settled(page, 0), count(page)
    page.mouse.move(300, 240)
    page.mouse.wheel(0, -500)
    moved = settled(page, before)
    middle = SIZE["width"] // 2 - WATCH.left
    for half in (slice(0, middle - 40), slice(middle + 70, None)):
        assert difference(moved[:, half], both[:, half]) > 3
    group(page, "View")
    choose(page, page.locator("[data-setting=compare]"), "nothing")
    page.wait_for_function("() => document.querySelectorAll('.flowtex').length === 1")
    settled(page, 0)
    fold(page)


def test_the_server_draws_the_same_from_the_same_camera(page: Page) -> None:
    page.evaluate("document.activeElement.blur()")  # a menu would take the key
    before = count(page)
    page.keyboard.press("0")
    page.keyboard.press("+")
    here = settled(page, before)
    group(page, "View")
    page.get_by_role("button", name="server", exact=True).click()
    page.wait_for_function("() => document.querySelector('.flowtex-views').options.streamed")
    fold(page)
    there = settled(page, 0)
    # Either has its own look at the edge of a pixel; another camera differs by far more.
    assert difference(there, here) < 12
    before = count(page)
    page.mouse.move(450, 240)
    page.mouse.down()
    page.mouse.move(500, 260, steps=4)
    page.mouse.up()
    moved = settled(page, before)
    assert difference(moved, there) > 2 * difference(there, here)
    group(page, "View")
    page.get_by_role("button", name="browser", exact=True).click()
    page.wait_for_function("() => !document.querySelector('.flowtex-views').options.streamed")
    fold(page)
    assert difference(settled(page, 0), moved) < 12


def test_a_picture_is_saved_at_any_size(page: Page, tmp_path: Path) -> None:
    group(page, "Save")
    page.get_by_label("Width in pixels").fill("600")
    page.get_by_label("Height in pixels").fill("150")
    page.get_by_label("Height in pixels").press("Enter")
    page.get_by_role("button", name="Export", exact=True).click()
    link = page.get_by_text(re.compile(r"Save .*\.png"))
    link.wait_for()
    with page.expect_download() as download:
        link.click()
    download.value.save_as(tmp_path / "a.png")
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.size == (600, 150)
        pixels = np.asarray(picture.convert("L"), dtype=float)
    assert np.abs(np.diff(pixels, axis=0))[50:100, 250:350].mean() > 3


def test_a_link_and_lines_of_python_tell_the_state(page: Page, folder: Path) -> None:
    page.evaluate("document.activeElement.blur()")  # a menu would take the key
    before = count(page)
    page.keyboard.press("0")
    settled(page, before)
    group(page, "Share")
    page.get_by_text("Describe what is shown").click()
    page.locator(".flowtex-text").nth(1).wait_for()
    link, python = page.locator(".flowtex-text").all_inner_texts()
    assert "file=series.pvd" in link
    assert "series.pvd" in python and "flowtex.render" in python
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.get_by_label("Copy the link").click()
    copied = page.evaluate("navigator.clipboard.readText()")
    assert copied == link.strip()
    assert copied.startswith(page.context.first_address)  # type: ignore[attr-defined]
    fold(page)
    painted(page)
    seen = WATCH.shot(page)
    other = page.context.new_page()
    other.set_viewport_size(SIZE)  # type: ignore[arg-type]
    other.goto(copied)
    other.get_by_text("3 times").wait_for()
    settled(other, 0)
    WATCH.comes_to(other, seen)
    # In the same tab, after another flow and another view, as typed and as a whole address.
    hash_of = urlsplit(copied).fragment
    for show in (
        lambda: other.evaluate("(link) => { location.hash = link; }", hash_of),
        lambda: other.goto(copied),
    ):
        open_file(other, "block.vts")
        other.get_by_text("steady").wait_for()
        before = count(other)
        other.mouse.move(400, 200)
        other.mouse.wheel(0, -300)
        settled(other, before)
        assert difference(WATCH.shot(other), seen) > 8
        show()
        other.get_by_text("3 times").wait_for()
        WATCH.comes_to(other, seen)
        assert "#" not in other.url
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
    (block,) = re.findall(
        r"```python\n(import flowtex\nfrom flowtex.app import FlowArea\n.*?)```", text, re.DOTALL
    )
    assert block.endswith("server.start()\n")
    script = OWN.replace("BLOCK", block.removesuffix("server.start()\n"))
    process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
    page.set_viewport_size({"width": 300, "height": 240})
    try:
        address = next(found.group() for line in process.stdout or () if (found := ADDRESS(line)))
        page.goto(address)
        page.wait_for_selector('.flowtex[data-drawn="true"]')
        pictures: list[Any] = []

        def moves() -> bool:
            """Whether it plays: no two pictures are the same."""
            shown = Watch((60, 60, 260, 170)).shot(page)
            if np.abs(np.diff(shown, axis=0)).mean() > 5:
                pictures.append(shown)
            return len(pictures) > 1 and difference(pictures[0], pictures[-1]) > 2

        wait_until(moves)
    finally:
        process.kill()
        process.communicate()


def test_ctrl_c_ends_it_at_once_with_a_page_open(page: Page, served: Served) -> None:
    page.goto("about:blank")
    other = page.context.new_page()  # which complains of it
    other.goto(served.address)
    other.locator('.flowtex[data-sharp="true"]').wait_for()
    rest = served.end(signal.SIGINT)
    assert served.process.returncode == 0
    lines = [line for line in rest.splitlines() if "Trigger nothing" not in line]
    assert "Traceback" not in rest and len(lines) <= 4, rest
    with socket.socket() as link:
        assert link.connect_ex(served.place) != 0
