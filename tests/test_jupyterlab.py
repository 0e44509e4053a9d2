"""Widget and application in a real JupyterLab, driven by Chromium.

They share its server, which takes seconds to start.
"""

from __future__ import annotations

import base64
import io
import json
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from lab import Lab, LabServer
from numpy.typing import NDArray
from pages import COMPLETE, acted, opened_page
from PIL import Image
from waiting import PATIENCE_S, wait_until

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytest.importorskip("anywidget")

pytestmark = [pytest.mark.slow, pytest.mark.browser]

SHOW = """import flowtex
w = flowtex.show(flowtex.examples.double_gyre(), samples=9, size=(300, 200), bar=False)
w"""
PLOTTER = """import flowtex, pyvista as pv
pl = pv.Plotter(window_size=(300, 200))
pl.flowtex.add(flowtex.examples.double_gyre(), samples=9)
pl.add_mesh(pv.Sphere(0.1), name="ball")
pl.camera.parallel_scale = 0.25
w = pl.show(jupyter_backend="flowtex", return_viewer=True)
w"""
#: Threads of widgets; those that answer all browsers stay for the next one.
THREADS = (
    "[t.name for t in __import__('threading').enumerate() "
    "if 'flowtex' in t.name and 'flowtex-tile' not in t.name]"
)


#: Whether all views of the page have their full picture, and the kernel has it as well.
DRAWN = f"""(count) => {{
  const views = [...document.querySelectorAll(".flowtex")];
  return views.length === count && views.every((view) => view.matches('{COMPLETE}'));
}}"""
SENT = """() => [...document.querySelectorAll(".flowtex")].every(
  ({ dataset }) => dataset.sharp === "true" && dataset.still === dataset.frames)"""
CAMERA = "__import__('json').dumps(w.camera)"


@pytest.fixture(scope="module")
def opened(browser: Browser, jupyter: LabServer) -> Iterator[Lab]:
    """Yield a notebook for several tests: a kernel takes seconds to start."""
    with opened_page(browser, 700, 700) as page:
        yield Lab(page, jupyter)


@pytest.fixture
def notebook(opened: Lab) -> Lab:
    """Return the notebook without a cell."""
    opened.clear()
    opened.page.wait_for_function("() => !document.querySelector('.flowtex')")
    return opened


def picture(page: Page, nth: int = 0) -> NDArray[np.uint8]:
    """Return what a canvas shows."""
    shot = page.locator(".flowtex canvas").nth(nth).screenshot()
    with Image.open(io.BytesIO(shot)) as opened:
        return np.asarray(opened.convert("RGB"))


def variation(pixels: NDArray[np.uint8]) -> float:
    """Mean difference of neighbours: the texture, and hardly the colours."""
    return float(np.abs(np.diff(pixels.astype(float).mean(axis=-1), axis=0)).mean())


def dragged(lab: Lab, nth: int, x: int, by: int) -> None:
    """Drag a view to the right from a place in it; Python has the camera then."""
    page, canvas = lab.page, lab.page.locator(".flowtex canvas").nth(nth)
    canvas.scroll_into_view_if_needed()
    box = canvas.bounding_box()
    assert box is not None
    was = json.loads(lab.said(CAMERA))
    page.mouse.move(box["x"] + x, box["y"] + box["height"] / 2)
    page.mouse.down()
    page.mouse.move(box["x"] + x + by, box["y"] + box["height"] / 2, steps=4)
    page.mouse.up()
    now: dict[str, Any] = {}

    def has_moved() -> bool:
        now.update(json.loads(lab.said(CAMERA)))
        moved = now["focal_point"][0] - was["focal_point"][0]
        # The height of the flow is twice the parallel scale.
        share = -by / box["height"]
        return bool(moved == pytest.approx(share * 2 * was["parallel_scale"], rel=0.05))

    wait_until(has_moved, lambda: (was, now))
    assert now["parallel_scale"] == pytest.approx(was["parallel_scale"])


def test_a_cell_shows_a_flow_that_both_sides_can_change(notebook: Lab) -> None:
    lab, page = notebook, notebook.page
    page.set_viewport_size({"width": 700, "height": 700})
    lab.run(SHOW)
    page.wait_for_function(DRAWN, arg=1)  # and not once more as the value of the cell
    before = variation(picture(page))
    assert before > 5

    # Python to the browser.
    with acted(page):
        assert lab.said("setattr(w, 'contrast', 0.0)") == "None"
    assert variation(picture(page)) < 0.4 * before

    # The browser to Python.
    dragged(lab, 0, 150, 60)

    # The frame that the browser sent back is the picture of a saved notebook.
    assert lab.said("w._frame[6:10]") == "b'JFIF'"

    assert lab.said("w.close()") == "None"
    page.wait_for_function("() => !document.querySelector('.flowtex')")
    # What was being made when it was closed is made to its end.
    wait_until(lambda: lab.said(THREADS) == "[]", lambda: lab.said(THREADS))


CHANGE_THEME = """async (theme) => {
  await jupyterapp.commands.execute("apputils:change-theme", { theme });
}"""
#: Colours of the first view and of its texts, and of the notebook around it.
COLOURS = """() => {
  const view = document.querySelector(".flowtex");
  const around = getComputedStyle(document.querySelector(".jp-Notebook")).backgroundColor;
  return [getComputedStyle(view).backgroundColor, getComputedStyle(view).color, around];
}"""


def test_a_view_has_the_ground_of_the_notebook_in_any_theme(notebook: Lab) -> None:
    """A cell makes a view before it is in the page, and texts have the colours of the theme."""
    lab, page = notebook, notebook.page
    try:
        for theme in ("JupyterLab Dark", "JupyterLab Light"):
            page.evaluate(CHANGE_THEME, theme)
            if theme == "JupyterLab Dark":
                lab.run(SHOW)
            page.wait_for_function(DRAWN, arg=1)
            dark = theme == "JupyterLab Dark"
            page.wait_for_function(
                "(dark) => document.querySelector('.flowtex').matches('.flowtex-dark') === dark",
                arg=dark,
            )
            ground, ink, around = page.evaluate(COLOURS)
            assert ground == around != ink
    finally:
        page.evaluate(CHANGE_THEME, "JupyterLab Light")


CHANGING = """import flowtex, ipywidgets
def gyre(turn):
    field = flowtex.examples.double_gyre_field(shape=(40, 60))
    points = field.points * [1 + turn, 1, 1] + [turn, 0, 0]
    return flowtex.FlowField.from_arrays(points, field.velocity[0] * [1, 1 - 2 * turn, 1])
w = flowtex.show(gyre(0), samples=9, size=(300, 200), cmap="magma")
slider = ipywidgets.FloatSlider(max=1, step=0.5)
slider.observe(lambda change: setattr(w, "field", gyre(change["new"])), "value")
slider"""
VIEWER = "document.querySelector('.flowtex-views').first"


def test_a_slider_changes_the_data_and_the_view_stays(notebook: Lab) -> None:
    lab, page = notebook, notebook.page
    lab.run(CHANGING)
    page.wait_for_function(DRAWN, arg=1)
    dragged(lab, 0, 150, 60)
    lab.said("setattr(w, 'samples', 15)")
    page.wait_for_function(DRAWN, arg=1)
    before = variation(picture(page))
    camera = page.evaluate(f"{VIEWER}.camera.state")
    handle = page.locator(".noUi-handle")
    with acted(page):
        handle.focus()
        page.keyboard.press("ArrowRight")
        page.keyboard.press("ArrowRight")
        page.wait_for_function(f"() => {VIEWER}.header.geometry.center[0] > 2")
    assert page.evaluate(f"{VIEWER}.camera.state") == camera
    assert page.evaluate(f"{VIEWER}.settings.samples") == 15
    assert variation(picture(page)) > before / 4  # half of it is in view
    # A flow with land that is elsewhere is shown whole, and the first one without its land again.
    with acted(page):
        assert lab.said("setattr(w, 'field', flowtex.examples.ocean())") == "None"
        page.wait_for_function(f"() => {VIEWER}.header.geometry.extent > 1e6")
    assert variation(picture(page)) > 5
    assert lab.said("w.camera['parallel_scale'] > 1e5") == "True"
    for _ in range(2):  # also when everything has been sent before
        with acted(page):
            assert lab.said("setattr(w, 'field', gyre(0))") == "None"
            page.wait_for_function(f"() => {VIEWER}.header.geometry.extent < 3")
        assert not page.evaluate(f"{VIEWER}.parts.has('cells') || {VIEWER}.parts.has('land')")
    refused = "try: w.field = 'nothing'\nexcept Exception as error: said = type(error).__name__"
    assert lab.said(f"(exec({refused!r}), w.field.shape)[1]") == "(40, 60)"


BOXES = """import flowtex
from ipywidgets import HBox, VBox, Button
mesh = flowtex.examples.double_gyre()
w = flowtex.FlowWidget(mesh, samples=9, size=(0, 150))
other = flowtex.FlowWidget(mesh, samples=9, size=(0, 200))
VBox([HBox([w, other]), Button()])"""
#: Pictures that are seen, by what they show, and whether anything speaks of what is missing.
SEEN = """() => [
  [...document.querySelectorAll(".flowtex-still img")]
    .map((image) => image.getBoundingClientRect()).map((box) => [box.width, box.height]),
  document.body.innerText.match(/model not found|Loading widget|waiting for data/)?.[0] ?? "",
  [...document.querySelectorAll(".flowtex")].filter((view) => view.offsetHeight).length]"""


#: Whether the stills are there, and JupyterLab has made up its mind about the widgets.
LOADED = """() => {
  const stills = [...document.querySelectorAll(".flowtex-still img")];
  return stills.length === 4 && stills.every((still) => still.complete && still.offsetWidth)
    && !document.body.innerText.includes("Loading widget");
}"""


MARKED = """flowtex.FlowWidget(
    mesh, samples=9, size=(500, 300), arrows=True, critical_points=8)"""


def test_a_converted_notebook_shows_pictures(page: Page, tmp_path: Path) -> None:
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    exporters = pytest.importorskip("nbconvert.exporters")
    # A busy machine takes its time for the pictures.
    patience = f"from flowtex.host import cell\ncell.MAX_WAIT_S = {PATIENCE_S}"
    cells = [nbformat.v4.new_code_cell(text) for text in (patience, BOXES, MARKED, PLOTTER)]
    notebook = nbformat.v4.new_notebook(cells=cells)
    nbclient.NotebookClient(notebook, kernel_name="python3").execute()
    with warnings.catch_warnings():
        warnings.simplefilter("error", UserWarning)
        text, _ = exporters.HTMLExporter(template_name="lab").from_notebook_node(notebook)
    (tmp_path / "page.html").write_text(text)
    page.goto(f"file://{tmp_path}/page.html")
    pictures, words, _ = page.evaluate(SEEN)
    assert len(pictures) == 4
    assert min(min(size) for size in pictures) > 50
    assert pictures[2:] == [[500, 300], [300, 200]]
    assert words == ""
    stills = []
    for cell in cells[2:]:
        data = base64.b64decode(cell.outputs[-1].data["image/png"])
        with Image.open(io.BytesIO(data)) as image:
            stills.append(np.asarray(image.convert("RGB")).astype(int))
    assert [still.shape for still in stills] == [(300, 500, 3), (200, 300, 3)]
    marked, plotter = stills
    saddles = np.abs(marked - (0xFF, 0xD2, 0x1F)).max(axis=-1) < 12
    assert saddles[:220].any() and saddles[250:].any()  # on the flow, and with their name
    assert (marked[40:200, :50].max(axis=-1) < 120).any()  # numbers of the axis
    assert (np.ptp(marked[-40:, -130:], axis=-1) > 60).any()  # the colour bar
    assert np.ptp(plotter, axis=-1).max() > 60


TWO = """import flowtex, pathlib, time
flow = flowtex.formula("y", "-sin(x) - b*y", b=(0.2, 0, 1), resolution=65)
w = flowtex.show(flow, samples=5, size=(500, 200), beside={"lod": False})
while not pathlib.Path("FILE").exists():
    time.sleep(0.1)"""


def test_two_views_of_a_formula_are_drawn_while_the_cell_still_runs(
    notebook: Lab, tmp_path: Path
) -> None:
    lab, page = notebook, notebook.page
    page.set_viewport_size({"width": 900, "height": 900})
    lab.run(TWO.replace("FILE", (tmp_path / "go").as_posix()))
    page.wait_for_function(DRAWN, arg=2)
    (tmp_path / "go").touch()
    assert page.locator(".flowtex .title").all_inner_texts() == [
        "Level of detail: on",
        "Level of detail: off",
    ]
    # A drag in one is the camera of both, and of Python.
    dragged(lab, 1, 100, 40)
    # A parameter of the formula needs no kernel.
    before = picture(page)
    with acted(page):
        page.locator('[data-setting="formula.b"] input').first.fill("0.9")
    assert np.abs(picture(page).astype(float) - before).mean() > 5
    page.wait_for_function("() => !document.querySelector('[data-failed]')")
    assert lab.said("w.close()") == "None"
    page.wait_for_function("() => !document.querySelector('.flowtex')")


def test_a_saved_notebook_shows_pictures_where_no_kernel_runs(
    notebook: Lab, jupyter: LabServer
) -> None:
    """Whether or not JupyterLab is set to save the state of widgets; it leaves the notebook."""
    shown, page = notebook, notebook.page
    page.set_viewport_size({"width": 1100, "height": 1300})
    shown.run(SHOW)
    shown.run(BOXES)
    shown.run(PLOTTER)
    page.wait_for_function(DRAWN, arg=4)
    # In a row views of no width share the room.
    widths = page.evaluate("[...document.querySelectorAll('.flowtex')].map(v => v.clientWidth)")
    assert widths[1] == widths[2] > 300
    # PyVista's widget fills the plotter's window, and looks from the plotter's camera.
    assert variation(picture(page, 3)) > 3
    box = page.locator(".flowtex").nth(3).bounding_box()
    assert box is not None
    assert (box["width"], box["height"]) == (300, 200)
    assert shown.said("w.camera['parallel_scale']") == "0.25"
    assert page.get_by_text("does not show: 'ball'").count() == 0  # it is drawn
    # The still that is saved is the last picture.
    page.wait_for_function(SENT)
    was = shown.said("len(w._frame), hash(w._frame)")
    with acted(page, 3):
        assert shown.said("setattr(w, 'contrast', 0.2)") == "None"
    page.wait_for_function(SENT)
    assert shown.said("len(w._frame), hash(w._frame)") != was
    size = "__import__('PIL.Image').Image.open(__import__('io').BytesIO(w._still)).size"
    assert shown.said(size) == "(300, 200)"
    pictures, words, views = page.evaluate(SEEN)
    assert not any(width for width, _ in pictures)
    assert (words, views) == ("", 4)
    saved = shown.saved()
    bare = json.loads(saved)
    assert bare["metadata"].pop("widgets")
    for text in (saved, json.dumps(bare)):
        Lab(page, jupyter, text)
        page.wait_for_function(LOADED)
        pictures, words, views = page.evaluate(SEEN)
        assert pictures[0] == pictures[3] == [300, 200]
        assert pictures[1][0] == pytest.approx(pictures[2][0], abs=1)
        assert pictures[1][0] > 300
        assert (words, views) == ("", 0)
