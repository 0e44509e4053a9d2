"""A formula on an exported page: drawn from itself at any zoom, with its parameters as sliders."""

from __future__ import annotations

import base64
import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from page_reader import Reader
from pages import COMPLETE, acted, opened_page
from PIL import Image

import flowtex
from flowtex import quality
from flowtex.scene.scene import Scene
from flowtex.trace.slices import typical_speed

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

ENDS: dict[str, Any] = {"x": (-6, 6), "y": (-3, 3), "b": (0.2, 0, 1)}
LOOK: dict[str, Any] = {"samples": 9, "clim": (0, 5), "zoom": 3.0, "focus": (2.9, 0.3)}


@pytest.fixture(autouse=True)
def _small_preview(quick_export: None) -> None:
    """Pages whose preview takes no time."""


def pendulum(**options: Any) -> flowtex.FlowField:
    return flowtex.formula("y", "-sin(x) - b*y", **{**ENDS, **options})


def on_grid(resolution: int, b: float) -> flowtex.FlowField:
    """The same flow of a function, which a page knows at its nodes alone."""
    return flowtex.formula(
        lambda y: y,
        lambda x, y, b: -np.sin(x) - b * y,
        **{**ENDS, "b": (b, 0, 1), "resolution": resolution},
    )


def opened(page: Page, path: Path) -> None:
    page.goto(path.as_uri())
    page.wait_for_selector(COMPLETE)


def picture(page: Page) -> Any:
    """The picture alone, as numbers."""
    read = "document.querySelector('flowtex-view').first.canvas.toDataURL().split(',')[1]"
    with Image.open(io.BytesIO(base64.b64decode(page.evaluate(read)))) as image:
        return np.asarray(image, float)


def rms(one: Any, other: Any) -> float:
    return float(np.sqrt(np.mean((one - other) ** 2)))


def test_a_page_has_the_formula_and_no_velocities(tmp_path: Path) -> None:
    path = flowtex.export(pendulum(), tmp_path / "page.html", samples=5).path
    read = Reader(path.read_text(encoding="utf-8"))
    assert not {name.split("/")[0] for name in read.names()} & {"flow", "scalars", "slices"}
    header = read.header()
    assert header["formula"]["trees"][1][0] == "+" and header["settings"]["formula.b"] == 0.2
    grid = flowtex.export(on_grid(257, 0.2), tmp_path / "grid.html", samples=5)
    assert path.stat().st_size < grid.nbytes


@pytest.mark.slow
def test_the_formula_draws_what_a_fine_grid_of_it_does_and_follows_its_slider(
    browser: Browser, tmp_path: Path
) -> None:
    formula = flowtex.export(pendulum(resolution=65), tmp_path / "page.html", **LOOK).path
    pictures = {}
    with opened_page(browser, 320, 240) as page:
        for b in (0.2, 0.8):
            grid = flowtex.export(on_grid(257, b), tmp_path / f"{b}.html", **LOOK).path
            opened(page, grid)
            pictures[b] = picture(page)
        opened(page, formula)
        assert rms(picture(page), pictures[0.2]) < 2
        slider = page.locator('[data-setting="formula.b"] input')
        with acted(page):
            slider.fill("0.8")
        assert rms(picture(page), pictures[0.8]) < 2 < rms(*pictures.values())


def test_a_formula_is_sharp_at_a_zoom_of_100_000(browser: Browser, tmp_path: Path) -> None:
    look: dict[str, Any] = {"zoom": 1e5, "focus": (0, 0), "scalars": False}
    path = flowtex.export(pendulum(), tmp_path / "page.html", **look).path
    with opened_page(browser, 320, 240) as page:
        opened(page, path)
        drawn = picture(page)[..., :3]
    y, x = np.mgrid[1 : -1 : drawn.shape[0] * 1j, -1 : 1 : drawn.shape[1] * 1j]
    x *= drawn.shape[1] / drawn.shape[0]
    found = quality.alignment(drawn, y, -x - 0.2 * y, np.hypot(x, y) > 0.25)
    assert found.angle < 3 and found.coherence > 0.93


DRAWN = """() => {
  const viewer = document.querySelector("flowtex-view").first;
  return viewer.card.drawn.path.path;
}"""


def test_a_click_shows_the_trajectory_which_follows_the_slider(
    browser: Browser, tmp_path: Path
) -> None:
    path = flowtex.export(pendulum(resolution=65), tmp_path / "page.html", samples=9).path
    with opened_page(browser, 320, 240) as page:
        opened(page, path)
        box = page.evaluate("document.querySelector('flowtex-view').getBoundingClientRect()")
        page.mouse.click(box["x"] + 0.4 * box["width"], box["y"] + 0.4 * box["height"])
        page.wait_for_function("() => !!document.querySelector('flowtex-view').first.card.drawn")
        for b in (0.2, 0.0):
            page.evaluate(
                "(b) => document.querySelector('flowtex-view').first.setSettings({'formula.b': b})",
                b,
            )
            line = np.array(page.evaluate(DRAWN))[:, :2]  # at once
            energy = line[:, 1] ** 2 / 2 - np.cos(line[:, 0])
            lengths = np.linalg.norm(np.diff(line, axis=0), axis=1)
            assert lengths.sum() > 5
            # dE/ds = -b y^2 / speed along the line.
            x, y = (line[1:] + line[:-1]).T / 2
            lost = -b * y**2 / np.hypot(y, np.sin(x) + b * y) * lengths
            np.testing.assert_allclose(np.diff(energy)[1:-1], lost[1:-1], atol=2e-4)


SPEEDS = """async (b) => {
  const { first } = document.querySelector("flowtex-view");
  first.setSettings({ "formula.b": b });
  const { speed, scalars } = first.header;
  const { most } = scalars.choices[scalars.number];
  const ramp = first.root.shadowRoot.querySelector(".ramp");
  return [speed.typical, most, scalars.high, ramp.classList.contains("above")];
}"""


def test_typical_and_greatest_speed_and_the_colour_bar_follow_the_slider(
    browser: Browser, tmp_path: Path
) -> None:
    path = flowtex.export(pendulum(b=(0.2, -3, 3), resolution=65), tmp_path / "page.html", **LOOK)
    high = None
    with opened_page(browser, 320, 300) as page:
        opened(page, path.path)
        for b in (-3.0, -1.0, 0.0, 0.5, 2.5):
            typical, most, end, is_above = page.evaluate(SPEEDS, b)
            high = high or end
            field = pendulum(b=b, resolution=65)
            assert typical == pytest.approx(typical_speed(field), rel=5e-3)
            assert most == pytest.approx(np.max(field.speed), rel=1e-4)
            # The colours keep their range, and the bar says where values lie beyond it.
            assert end == high and is_above == (most > 1.001 * high)


LIMITS = """async (b) => {
  const { first } = document.querySelector("flowtex-view");
  first.setSettings({ "formula.b": b });
  const { low, high } = first.header.scalars;
  return [low, high];
}"""
#: What the picture of a widget is sent when the kernel colours it again.
AGAIN = """() => {
  const { first } = document.querySelector("flowtex-view");
  const { scalars, generation } = window.firstHeader;
  first.setHeader({ ...first.header, scalars: structuredClone(scalars), generation });
}"""


@pytest.mark.parametrize("cmap", ["viridis", "RdBu"])
def test_the_colours_follow_the_slider_unless_their_range_is_chosen(
    browser: Browser, tmp_path: Path, cmap: str
) -> None:
    field = pendulum(b=(0.2, -3, 3), resolution=65)
    path = flowtex.export(field, tmp_path / "page.html", samples=9, cmap=cmap)
    view = "document.querySelector('flowtex-view').first"
    with opened_page(browser, 320, 300) as page:
        opened(page, path.path)
        for b in (2.5, -3.0, 0.0, 0.2):
            expected = Scene.of(pendulum(b=b, resolution=65), cmap=cmap).scalar_limits
            assert page.evaluate(LIMITS, b) == pytest.approx(expected, rel=1e-6)
        with acted(page):
            page.evaluate(LIMITS, 2.5)
        moved = picture(page)
        other = tmp_path / "other.html"
        flowtex.export(pendulum(b=(2.5, -3, 3), resolution=65), other, samples=9, cmap=cmap)
        with opened_page(browser, 320, 300) as fresh:
            opened(fresh, other)
            assert rms(moved, picture(fresh)) < 2
        page.evaluate(f"{view}.chooseColours({{ clim: [0, 3] }})")
        assert page.evaluate(LIMITS, -1.0) == [0, 3]
        page.evaluate(f"{view}.chooseColours({{ clim: null }})")
        expected = Scene.of(pendulum(b=-1.0, resolution=65), cmap=cmap).scalar_limits
        assert page.evaluate(LIMITS, -1.0) == pytest.approx(expected, rel=1e-6)


def test_colours_sent_again_have_the_range_of_the_slider(browser: Browser, tmp_path: Path) -> None:
    """As a kernel sends them, which does not know where the slider is."""
    field = pendulum(b=(0.2, -3, 3), resolution=65)
    path = flowtex.export(field, tmp_path / "page.html", samples=9)
    view = "document.querySelector('flowtex-view').first"
    with opened_page(browser, 320, 300) as page:
        opened(page, path.path)
        page.evaluate(f"{view}.header.generation = 1")
        page.evaluate(f"window.firstHeader = structuredClone({view}.header)")
        expected = page.evaluate(LIMITS, 2.5)
        page.evaluate(AGAIN)
        assert page.evaluate(LIMITS, 2.5) == expected
