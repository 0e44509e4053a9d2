"""The widget in a real JupyterLab, driven by Chromium."""

from __future__ import annotations

import io
import json
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from lab import Lab, lab
from numpy.typing import NDArray
from PIL import Image

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytest.importorskip("jupyterlab")
pytest.importorskip("anywidget")

pytestmark = [pytest.mark.slow, pytest.mark.browser]

SHARP = '.flowtex[data-sharp="true"]'
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
THREADS = "[t.name for t in __import__('threading').enumerate() if 'flowtex' in t.name]"


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Yield the address of a JupyterLab with empty notebooks."""
    names = ("test.ipynb", "pyvista.ipynb", "thirty.ipynb", "two.ipynb")
    with lab(tmp_path_factory.mktemp("lab"), names) as address:
        yield address


def picture(page: Page) -> NDArray[np.uint8]:
    """Return what the canvas shows."""
    shot = page.locator(".flowtex canvas").first.screenshot()
    with Image.open(io.BytesIO(shot)) as opened:
        return np.asarray(opened.convert("RGB"))


def variation(pixels: NDArray[np.uint8]) -> float:
    """Mean difference of neighbours: the texture, and hardly the colours."""
    return float(np.abs(np.diff(pixels.astype(float).mean(axis=-1), axis=0)).mean())


def sharp(page: Page) -> None:
    """Wait for the picture; the client begins a new one in the frame after a change."""
    page.wait_for_timeout(400)
    page.locator(SHARP).first.wait_for()
    page.wait_for_function("() => !document.querySelector('.flowtex[data-sharp=\"false\"]')")


def test_a_cell_shows_a_flow_that_both_sides_can_change(page: Page, server: str) -> None:
    page.set_default_timeout(60_000)
    page.set_viewport_size({"width": 900, "height": 1200})
    lab = Lab(page, server)
    lab.run(SHOW)
    sharp(page)
    assert page.locator(".flowtex").count() == 1  # and not once more as the value of the cell
    before = variation(picture(page))
    assert before > 5

    # Python to the browser.
    assert lab.said("setattr(w, 'contrast', 0.0)") == "None"
    sharp(page)
    assert variation(picture(page)) < 0.4 * before

    # The browser to Python.
    was = json.loads(lab.said("__import__('json').dumps(w.camera)"))
    canvas = page.locator(".flowtex canvas").first
    canvas.scroll_into_view_if_needed()
    box = canvas.bounding_box()
    assert box is not None
    x, y = box["x"] + 150, box["y"] + 100
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 60, y, steps=5)
    page.wait_for_timeout(300)  # at rest when it is let go of
    page.mouse.up()
    page.wait_for_timeout(500)
    now = json.loads(lab.said("__import__('json').dumps(w.camera)"))
    moved = now["focal_point"][0] - was["focal_point"][0]
    # Sixty of the two hundred pixels that are twice the parallel scale.
    assert moved == pytest.approx(-60 / 200 * 2 * was["parallel_scale"], rel=0.05)
    assert now["parallel_scale"] == pytest.approx(was["parallel_scale"])

    # The frame that the browser sent back is the picture of a saved notebook.
    assert lab.said("w._frame[6:10]") == "b'JFIF'"

    # New textures are made in the kernel and sent.
    assert lab.said("w.set_trait('contrast', 1.0), w.set_trait('noise', 'checkerboard')")
    sharp(page)
    page.wait_for_function("() => document.querySelector('.flowtex').dataset.sharp === 'true'")

    assert lab.said("w.close()") == "None"
    page.wait_for_function("() => !document.querySelector('.flowtex')")
    # What was being made when it was closed is made to its end.
    for _ in range(50):
        threads = lab.said(THREADS)
        if threads == "[]":
            break
    assert threads == "[]"


def test_pyvista_shows_a_plotter_when_it_is_asked_to(page: Page, server: str) -> None:
    page.set_default_timeout(60_000)
    page.set_viewport_size({"width": 900, "height": 1200})
    lab = Lab(page, server, "pyvista.ipynb")
    lab.run(PLOTTER)
    sharp(page)
    assert variation(picture(page)) > 3
    # The widget fills the plotter's window, and looks from the plotter's camera.
    box = page.locator(".flowtex").first.bounding_box()
    assert box is not None
    assert (box["width"], box["height"]) == (300, 200)
    assert lab.said("w.camera['parallel_scale']") == "0.25"
    page.get_by_text("leaves out: 'ball'").first.wait_for()


THIRTY = """import flowtex
mesh = flowtex.examples.double_gyre_field(shape=(30, 60))
ws = [flowtex.show(mesh, samples=5, size=(90, 60), bar=False) for n in range(30)]"""
#: What all widgets of the page hold together; of a page without a widget nothing is left.
HELD = """() => {
  const gl = globalThis[Symbol.for("flowtex.gl/3")];
  return { objects: gl.objects, users: gl.users.size, arrays: gl.stock.size,
    common: gl.common.size, waiting: gl.waiting.size };
}"""
COUNT = """() => {
  window.contexts = 0;
  const get = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, ...given) {
    if (kind === "webgl2") window.contexts += 1;
    return get.call(this, kind, ...given);
  };
  window.listening = 0;
  for (const target of [document, window]) {
    const add = target.addEventListener.bind(target);
    target.addEventListener = (kind, call, options) => {
      const { signal } = options ?? {};
      if (signal) window.listening += 1;
      signal?.addEventListener("abort", () => (window.listening -= 1));
      add(kind, call, options);
    };
  }
}"""


def test_thirty_widgets_draw_share_and_leave_nothing(page: Page, server: str) -> None:
    page.set_default_timeout(60_000)
    page.set_viewport_size({"width": 700, "height": 2900})
    lab = Lab(page, server, "thirty.ipynb")
    page.evaluate(COUNT)
    lab.run(THIRTY)
    drawn = f"() => document.querySelectorAll('{SHARP}').length"
    page.wait_for_function(f"() => ({drawn})() === 30")
    assert page.evaluate("window.contexts") == 1
    assert variation(picture(page)) > 3
    # Textures and buffers lie there once; each view adds what binds them to a program.
    held = page.evaluate(HELD)
    assert held["users"] == 30
    assert held["arrays"] < 10
    assert held["common"] < 10
    assert held["objects"] < 60
    assert page.evaluate("window.listening") >= 60

    assert lab.said("[w.close() for w in ws][0]") == "None"
    page.wait_for_function("() => !document.querySelector('.flowtex')")
    left = {"objects": 0, "users": 0, "arrays": 0, "common": 0, "waiting": 0}
    assert page.evaluate(HELD) == left
    assert page.evaluate("window.listening") == 0


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


def test_a_saved_notebook_shows_pictures_where_no_kernel_runs(page: Page, tmp_path: Path) -> None:
    """Whether or not JupyterLab is set to save the state of widgets."""
    page.set_default_timeout(60_000)
    page.set_viewport_size({"width": 900, "height": 1600})
    folders = [tmp_path / "first", tmp_path / "later"]
    for folder in folders:
        folder.mkdir()
    plugin = folders[0] / "settings" / "@jupyter-widgets" / "jupyterlab-manager"
    plugin.mkdir(parents=True)
    (plugin / "plugin.jupyterlab-settings").write_text(json.dumps({"saveState": True}))
    with lab(folders[0]) as address:
        shown = Lab(page, address)
        shown.run(SHOW)
        shown.run(BOXES)
        shown.run(PLOTTER)
        page.wait_for_function(f"() => document.querySelectorAll('{SHARP}').length === 4")
        # In a row views of no width share the room.
        widths = page.evaluate("[...document.querySelectorAll('.flowtex')].map(v => v.clientWidth)")
        assert widths[1] == widths[2] > 300
        # The still that is saved is the last picture.
        was = shown.said("len(w._frame), hash(w._frame)")
        assert shown.said("setattr(w, 'contrast', 0.2)") == "None"
        page.wait_for_timeout(2500)
        assert shown.said("len(w._frame), hash(w._frame)") != was
        pictures, words, views = page.evaluate(SEEN)
        assert not any(width for width, _ in pictures)
        assert (words, views) == ("", 4)
        page.evaluate("() => jupyterapp.commands.execute('docmanager:save')")
        page.wait_for_timeout(500)
        saved = (folders[0] / "test.ipynb").read_text()
    bare = json.loads(saved)
    assert bare["metadata"].pop("widgets")
    with lab(folders[1], ()) as address:
        for name, text in (("test.ipynb", saved), ("bare.ipynb", json.dumps(bare))):
            (folders[1] / name).write_text(text)
            Lab(page, address, name)
            page.wait_for_timeout(2000)
            pictures, words, views = page.evaluate(SEEN)
            assert pictures[0] == pictures[3] == [300, 200]
            assert pictures[1][0] == pytest.approx(pictures[2][0], abs=1)
            assert pictures[1][0] > 300
            assert (words, views) == ("", 0)


def test_a_converted_notebook_shows_pictures(page: Page, tmp_path: Path) -> None:
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    exporters = pytest.importorskip("nbconvert.exporters")
    # A busy machine takes its time for the pictures.
    patience = (
        "from flowtex.widget import display\ndisplay.MAX_WAIT_S = display._wait_budget._left = 60"
    )
    cells = [nbformat.v4.new_code_cell(text) for text in (patience, SHOW, BOXES)]
    notebook = nbformat.v4.new_notebook(cells=cells)
    nbclient.NotebookClient(notebook, kernel_name="python3").execute()
    for template in ("lab", "classic"):
        with warnings.catch_warnings():
            warnings.simplefilter("error", UserWarning)
            text, _ = exporters.HTMLExporter(template_name=template).from_notebook_node(notebook)
        (tmp_path / "page.html").write_text(text)
        page.goto(f"file://{tmp_path}/page.html")
        pictures, words, _ = page.evaluate(SEEN)
        assert len(pictures) == 3
        assert all(width > 100 and height > 60 for width, height in pictures)
        assert words == ""


TWO = """import flowtex, pathlib, time
w = flowtex.show(flowtex.examples.double_gyre(), samples=5, size=(500, 200), bar=False,
                 beside={"lod": False})
while not pathlib.Path("FILE").exists():
    time.sleep(0.1)"""


def test_two_views_are_drawn_while_the_cell_still_runs(
    page: Page, server: str, tmp_path: Path
) -> None:
    page.set_default_timeout(60_000)
    page.set_viewport_size({"width": 900, "height": 900})
    lab = Lab(page, server, "two.ipynb")
    lab.run(TWO.replace("FILE", (tmp_path / "go").as_posix()))
    page.wait_for_function(f"() => document.querySelectorAll('{SHARP}').length === 2")
    (tmp_path / "go").touch()
    assert page.locator(".flowtex .title").all_inner_texts() == [
        "Level of detail: on",
        "Level of detail: off",
    ]
    # A drag in one is the camera of both, and of Python.
    box = page.locator(".flowtex").nth(1).bounding_box()
    assert box is not None
    was = json.loads(lab.said("__import__('json').dumps(w.camera)"))
    page.mouse.move(box["x"] + 100, box["y"] + 100)
    page.mouse.down()
    page.mouse.move(box["x"] + 140, box["y"] + 100, steps=4)
    page.mouse.up()
    sharp(page)
    now = json.loads(lab.said("__import__('json').dumps(w.camera)"))
    moved = now["focal_point"][0] - was["focal_point"][0]
    assert moved == pytest.approx(-40 / 200 * 2 * now["parallel_scale"], rel=0.05)
