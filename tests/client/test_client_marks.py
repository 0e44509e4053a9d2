"""Critical points and separatrices in the browser: as VTK draws them, and who has them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from flows import gyre, scattered_gyre, swinging
from matrix import COLOUR, GROUND, SIZE, TILTED, straight
from pages import COMPLETE, acted, opened_page
from scipy.spatial import ConvexHull
from webgl_page import ClientPage, packed, state

import flowtex
from flowtex import FlowField
from flowtex.rendering.camera import Camera
from flowtex.rendering.webgl.client_data import ClientData, Colours
from flowtex.rendering.webgl.marks import Marks
from flowtex.scene.scene import Scene
from flowtex.settings import Settings

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser


def sphere() -> FlowField:
    p = np.random.default_rng(1).normal(size=(3, 700))
    p /= np.linalg.norm(p, axis=0)
    x, y, z = p
    velocity = np.stack([np.sin(3 * y) + z, np.cos(2 * z) * x, np.sin(4 * x)])
    velocity -= (velocity * p).sum(axis=0) * p
    return FlowField.from_triangles(p.T, ConvexHull(p.T).simplices, velocity.T)


VIEWS: dict[str, tuple[Callable[[], FlowField], Camera | None, float | None]] = {
    "plane": (gyre, straight(1), None),
    "aslant": (gyre, TILTED, None),
    "near": (gyre, straight(3), None),
    "nearest step": (swinging, straight(1, (0, 0)), 0.7),
    "triangles": (scattered_gyre, straight(1), None),
    "sphere": (sphere, None, None),
}
OPTIONS: dict[str, Any] = {"samples": 5, "strength": 0.0, "critical_points": 40, "separatrices": 10}


@pytest.mark.parametrize("name", VIEWS)
def test_marks_are_those_of_vtk(client: ClientPage, name: str) -> None:
    make, camera, time = VIEWS[name]
    scene = Scene(make(), Settings(**OPTIONS))
    camera = camera or Camera.fit(scene.field.surface, SIZE[0] / SIZE[1])
    marks = Marks(scene.structure, carried=True)
    data = ClientData(scene.textures, Colours(plain=COLOUR, background=GROUND), marks=marks)
    header = data.header(scene.settings, camera=state(camera), time=time)
    steps = tuple(range(scene.textures.store.steps))
    view = client.mount(packed(data, header, steps), SIZE, controls=False, smooth=False)
    theirs = client.picture(view)
    look = {"scalars": False, "color": COLOUR, "background": GROUND, "lighting": False}
    common: dict[str, Any] = {**look, "camera": camera, "time": time, "size": SIZE}
    ours = flowtex.render(make(), **common, **OPTIONS)
    without = flowtex.render(make(), **common, samples=5, strength=0.0)
    marked = (np.abs(ours.astype(int) - without) > 60).any(axis=-1)
    assert marked.mean() > 0.0015
    off = np.abs(theirs.astype(int) - ours).max(axis=-1)
    # Outlines of the surface are smoothed in one of them; vertices lie at other shares of a pixel.
    assert (off > 60).sum() < 0.1 * marked.sum()


def test_fixed_points_of_a_formula_follow_its_parameters(
    browser: Browser, tmp_path: Path, quick_export: None
) -> None:
    ends: dict[str, Any] = {"x": (-6, 6), "y": (-3, 3), "b": (0.2, 0, 1)}
    field = flowtex.formula("y", "-sin(x) - b*y", **ends)
    path = tmp_path / "pendulum.html"
    flowtex.export(field, path, samples=5, critical_points=True, separatrices=True)
    with opened_page(browser, 640, 400) as page:
        page.goto(path.as_uri())
        page.wait_for_selector(COMPLETE)
        kinds, lines = page.locator(".kinds span"), ["from saddle", "to saddle"]
        assert kinds.all_inner_texts() == ["saddle", "spiral sink", *lines]
        slider = page.locator('[data-setting="formula.b"] input')
        with acted(page):
            slider.evaluate("(e) => { e.value = 0; e.dispatchEvent(new Event('input')); }")
        assert kinds.all_inner_texts() == ["saddle", "centre", *lines]
        place = page.evaluate("""() => {
          const { camera, canvas } = document.querySelector("flowtex-view").first;
          const { left, top, width, height } = canvas.getBoundingClientRect();
          const [x, y] = camera.project([0, 0, 0]);
          return [left + (x + 1) / 2 * width, top + (1 - y) / 2 * height];
        }""")
        page.mouse.move(place[0] + 40, place[1])
        page.mouse.move(*place)
        page.locator(".readout b", has_text="centre").wait_for()
        page.mouse.click(*place)
        page.locator(".card dt", has_text="critical point").wait_for()
        assert "centre" in page.locator(".card dd").all_inner_texts()


#: Kinds, and x where the first component of a saddle-node is zero, by its parameter.
SADDLE_NODE: dict[float, tuple[list[str], list[float]]] = {
    -1.0: (["saddle", "sink"], [-1.0, 1.0]),
    -0.25: (["saddle", "sink"], [-0.5, 0.5]),
    0.0: (["degenerate"], [0.0]),
    0.5: ([], []),
    -2.0: (["saddle", "sink"], [-(2**0.5), 2**0.5]),
}
MARKED = """() => {
  const { first } = document.querySelector("flowtex-view");
  const { center } = first.header.geometry;
  const rowsOf = (name) => {
    const { data = [] } = first.parts.get(name) ?? {};
    const row = (n) => [0, 1, 3].map((k) => data[4 * n + k] + (center[k] ?? 0));
    return Array.from({ length: data.length / 4 }, (_, n) => row(n));
  };
  return [rowsOf("critical/0"), rowsOf("nullclines/0").filter((row) => !row[2])];
}"""
#: Colours of the canvas around a place of the mesh, 5 x 5 pixels.
AROUND = """([x, y]) => {
  const { camera, canvas } = document.querySelector("flowtex-view").first;
  const copy = document.createElement("canvas");
  [copy.width, copy.height] = [canvas.width, canvas.height];
  const pen = copy.getContext("2d");
  pen.drawImage(canvas, 0, 0);
  const [u, v] = camera.project([x, y, 0]);
  const at = [((u + 1) / 2) * canvas.width - 2, ((1 - v) / 2) * canvas.height - 2];
  return [...pen.getImageData(...at.map(Math.round), 5, 5).data];
}"""


def test_marks_on_a_page_are_right_at_five_positions_of_a_slider(
    browser: Browser, tmp_path: Path, quick_export: None
) -> None:
    field = flowtex.formula("saddle_node")
    look: dict[str, Any] = {
        "critical_points": True,
        "nullclines": True,
        "scalars": False,
        "samples": 3,
    }
    path = flowtex.export(field, tmp_path / "page.html", **look).path
    with opened_page(browser, 480, 320) as page:
        page.goto(path.as_uri())
        page.wait_for_selector(COMPLETE)
        slider = page.locator('[data-setting="formula.r"] input')
        for r, (kinds, places) in SADDLE_NODE.items():
            if r != -1:  # where it begins
                with acted(page):
                    slider.fill(str(r))
            lines = ["u = 0", "v = 0"]
            assert page.locator(".kinds span").all_inner_texts() == [*kinds, *lines], r
            points, zeros = page.evaluate(MARKED)
            assert sorted(x for x, *_ in points) == pytest.approx(places, abs=1e-6)
            found = sorted({round(x, 6) for x, *_ in zeros})
            assert found == pytest.approx(places, abs=1e-5), r
            for x in places:  # a line through it, off the point
                seen = np.array(page.evaluate(AROUND, [x, 0.7])).reshape(-1, 4)[:, :3]
                assert (seen[:, 0] - seen[:, 2]).max() > 120, r  # orange on grey


def test_nullclines_on_a_page_are_as_fine_as_its_view(
    browser: Browser, tmp_path: Path, quick_export: None
) -> None:
    field = flowtex.formula("x^2 + y^2 - 1", "y - x", x=(-2, 2), y=(-2, 2))
    look: dict[str, Any] = {"nullclines": True, "samples": 3, "zoom": 300, "focus": (0.6, 0.8)}
    path = flowtex.export(field, tmp_path / "page.html", **look).path
    with opened_page(browser, 320, 240) as page:
        page.goto(path.as_uri())
        page.wait_for_selector(COMPLETE)
        rows = np.array(page.evaluate(MARKED)[1])[:, :2]
    one, other = rows[::2], rows[1::2]
    near = np.hypot(*(one - (0.6, 0.8)).T) < 4 / 300
    assert near.sum() > 50
    # Middles of chords, whose error is that of a pixel at most: 4 / 300 / 240.
    middles = (one + other)[near] / 2
    assert np.abs(np.hypot(*middles.T) - 1).max() < 1e-6
