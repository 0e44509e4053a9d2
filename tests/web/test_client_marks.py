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
from flowtex.rendering.webgl import ClientData, Colours
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


def test_a_page_has_the_marks_that_it_was_exported_with(
    browser: Browser, tmp_path: Path, quick_export: None
) -> None:
    flowtex.export(gyre(), path := tmp_path / "page.html", samples=5, critical_points=3)
    with opened_page(browser, 640, 400) as page:
        page.goto(path.as_uri())
        page.wait_for_selector(COMPLETE)
        rows = page.locator("[data-setting]")
        names = rows.evaluate_all("(a) => a.map((e) => e.dataset.setting)")
        assert "critical_points" in names and "separatrices" not in names
        assert page.locator(".kinds span").count() == 1
