"""Pages that need no server: what is in them, and what a browser makes of them."""

from __future__ import annotations

import io
import json
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

import numpy as np
import pytest
from numpy.typing import NDArray
from page_reader import Reader
from pages import COMPLETE, acted, opened_page
from PIL import Image

import flowtex
from flowtex import examples
from flowtex.examples.analytic import gyre_nodes as nodes_of
from flowtex.host.export import export
from flowtex.host.still import preview_png
from flowtex.host.view import web_views
from flowtex.rendering.camera import Camera
from flowtex.scene.options import Options

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page, Route

WICKED = "</script ><!--<script \"'&<b>"


def gyre(times: int = 1, nodes: int = 24) -> flowtex.FlowField:
    at = nodes_of((nodes, nodes))
    series = np.stack([examples.double_gyre_velocity(at, float(t)) for t in range(times)])
    heights = np.stack([at[..., 1] * t for t in range(times)])
    return flowtex.FlowField.from_arrays(at, series, name=WICKED, scalars={WICKED: heights})


@pytest.fixture(autouse=True)
def _small_preview(monkeypatch: pytest.MonkeyPatch) -> None:
    """The processor draws it."""
    monkeypatch.setattr("flowtex.host.export.PREVIEW", (24, 16))


def test_a_page_holds_the_scene_and_nothing_from_outside(tmp_path: Path) -> None:
    made = export(gyre(4), tmp_path / "page.html", scalars=WICKED)
    read = Reader(made.path.read_text(encoding="utf-8"))
    assert read.title == WICKED
    assert read.tags.count("script") == 2 + len(read.parts())  # nothing has ended one early
    assert [a for a in read.addresses if not a.startswith("data:")] == []
    assert read.policy.startswith("default-src 'none'; script-src 'sha256-")
    assert "http" not in read.policy
    assert read.tags.count("noscript") == 1
    view = web_views(gyre(4), Options.split(scalars=WICKED))[0]
    scene = replace(view.page_data(), traces=True)
    header = read.header()
    header["camera"], expected = None, {**scene.header(view.scene.settings), "camera": None}
    assert header == json.loads(json.dumps(expected))
    parts = read.parts()
    wanted = {**scene.surface(), **{k: v for s in range(4) for k, v in scene.step(s).items()}}
    assert set(parts) == set(wanted)
    for name, array in wanted.items():
        assert parts[name].dtype == array.dtype
        np.testing.assert_array_equal(parts[name], array)
    assert made.nbytes == made.path.stat().st_size and made.steps == 4


def test_fewer_steps_make_a_smaller_page(tmp_path: Path) -> None:
    whole = export(gyre(3), tmp_path / "whole.html")
    some = export(gyre(3), tmp_path / "some.html", steps=2)
    assert (whole.steps, some.steps) == (3, 2)
    assert some.nbytes < whole.nbytes
    assert Reader(some.path.read_text()).header()["slices"]["times"] == [0.0, 2.0]
    with pytest.raises(ValueError, match=r"^steps is 0; expected 1 to 3"):
        export(gyre(3), tmp_path / "none.html", steps=0)


@pytest.fixture
def offline(browser: Browser, quick_export: None) -> Iterator[tuple[Page, list[str], list[str]]]:
    """Yield a page without a network, the addresses that it asks for, and what it complains of."""
    asked: list[str] = []
    said: list[str] = []
    with opened_page(browser, offline=True) as page:
        page.on("request", lambda request: asked.append(request.url))
        page.on("pageerror", lambda error: said.append(str(error)))
        page.on("console", lambda line: said.append(line.text) if line.type == "error" else None)
        yield page, asked, said


def pixels(page: Page) -> NDArray[Any]:
    with Image.open(io.BytesIO(page.locator("canvas").first.screenshot())) as picture:
        return np.asarray(picture.convert("RGB"), dtype=float)


@pytest.mark.browser
def test_a_page_is_drawn_and_played_from_a_file_without_a_network(
    offline: tuple[Page, list[str], list[str]], tmp_path: Path
) -> None:
    page, asked, said = offline
    export(gyre(3), tmp_path / "page.html", samples=9, title=WICKED)
    address = (tmp_path / "page.html").as_uri()
    page.goto(address)
    page.locator(COMPLETE).wait_for()
    page.wait_for_function("() => !document.getElementById('preview')")
    assert page.title() == page.locator(".flowtex .title").inner_text() == WICKED
    assert [a for a in asked if a != address and not a.startswith(("data:", "blob:"))] == []
    start = pixels(page)
    middle = tuple(slice(n // 3, 2 * n // 3) for n in start.shape[:2])
    assert np.abs(np.diff(start.mean(axis=-1), axis=0))[middle].mean() > 3
    play, readout = page.locator(".flowtex [data-name=play]"), page.locator(".flowtex .time")
    play.click()
    readout.wait_for()
    shown = readout.inner_text()
    for _ in range(2):
        differs = "([element, text]) => element.innerText !== text"
        page.wait_for_function(differs, arg=[readout.element_handle(), shown])
        shown = readout.inner_text()
    with acted(page):
        play.click()
    inside = np.abs(pixels(page) - start)[middle]
    assert inside.mean() > 1
    # Keys are the page's from the beginning.
    for label in ("Pause (space)", "Play (space)"):
        page.keyboard.press("Space")
        page.locator(f'.flowtex [aria-label="{label}"]').wait_for()
    assert said == []
    # Nothing else can be fetched or run.
    page.evaluate("""() => {
      const script = document.createElement("script");
      script.textContent = "window.ran = true";
      document.body.append(script);
      fetch("https://example.org/").catch(() => { window.refused = true; });
    }""")
    page.wait_for_function("() => window.refused")
    assert page.evaluate("() => window.ran") is None
    assert sum("Content Security Policy" in line for line in said) >= 2


#: A page that shows the flow of a module twice: by itself, and as hosts of anywidget's modules do.
HOST = """<!doctype html><title>Host</title><div id="plain"></div><div id="hosted"></div>
<script type="module">
import flow, { mount } from "./flow.mjs";
mount(document.getElementById("plain"), { samples: 5 }, 200);
const el = document.getElementById("hosted").attachShadow({ mode: "open" });
const values = { samples: 7, height: 160 };
window.end = flow.render({ el, model: { get: (name) => values[name] } });
</script>"""


@pytest.mark.browser
def test_a_module_shows_its_flow_in_any_page(page: Page, tmp_path: Path) -> None:
    module = tmp_path / "flow.mjs"
    export(gyre(2), module, samples=9, title=WICKED)
    asked: list[str] = []
    files = {"/": HOST, "/flow.mjs": module.read_text("utf-8")}

    def answer(route: Route) -> None:
        path = urlsplit(route.request.url).path
        asked.append(path)
        kind = "text/html" if path == "/" else "text/javascript"
        route.fulfill(body=files[path], content_type=kind)

    page.route("http://site.test/**", answer)
    page.goto("http://site.test/")
    for place, height, samples in (("#plain", 200, "5"), ("#hosted", 160, "7")):
        view = page.locator(f"{place} .flowtex-views")
        view.locator(COMPLETE).wait_for()
        box = view.bounding_box()
        assert box is not None
        assert box["height"] == height
        view.locator("[data-name=settings]").click()
        assert view.locator("[data-setting=samples] output").inner_text() == samples
    page.evaluate("() => end()")
    assert page.locator(".flowtex-views").count() == 1
    assert asked == ["/", "/flow.mjs"]


@pytest.mark.browser
def test_a_page_has_its_own_ground_in_light_and_dark(page: Page, tmp_path: Path) -> None:
    export(gyre(), tmp_path / "page.html", samples=5, axes="scale")
    page.goto((tmp_path / "page.html").as_uri())
    root = page.locator(COMPLETE)
    root.wait_for()
    corners = [pixels(page)[0, 0].tolist()]
    assert root.get_attribute("data-axes") == "scale"
    with acted(page):
        page.emulate_media(color_scheme="dark")
    corners.append(pixels(page)[0, 0].tolist())
    ground = page.evaluate("() => getComputedStyle(document.body).backgroundColor")
    assert corners == [[255] * 3, [18] * 3]
    assert ground == "rgb(18, 18, 18)"
    export(gyre(), tmp_path / "page.html", samples=5, background="navy")
    page.goto((tmp_path / "page.html").as_uri())
    root.wait_for()
    assert pixels(page)[0, 0].tolist() == [0, 0, 128]


@pytest.mark.browser
def test_a_page_says_that_it_loads_until_there_is_a_picture_to_move(
    offline: tuple[Page, list[str], list[str]], tmp_path: Path
) -> None:
    page, _, said = offline
    export(gyre(), tmp_path / "page.html", samples=9)
    page.add_init_script(
        "const read = Response.prototype.arrayBuffer, held = [];"
        "window.release = () => held.splice(0).forEach((go) => go());"
        "Response.prototype.arrayBuffer = async function () {"
        " await new Promise((go) => held.push(go)); return read.call(this); };"
    )
    page.goto((tmp_path / "page.html").as_uri())
    loading = page.locator("#loading")
    page.wait_for_function("() => /of \\d/.test(document.getElementById('loading').innerText)")
    first = re.fullmatch(r"Loading, 0 of (\d+) parts", loading.inner_text())
    assert first and loading.get_attribute("role") == "status"
    assert page.locator("#preview").count() == 1
    page.evaluate("() => window.release()")
    page.get_by_text(f"Loading, 1 of {first[1]} parts").wait_for()
    page.evaluate("() => { window.again = setInterval(window.release, 1); }")
    page.locator('.flowtex[data-drawn="true"]').wait_for()
    page.wait_for_function("() => !document.getElementById('preview')")
    assert loading.count() == 0
    assert said == []


@pytest.mark.browser
def test_a_page_without_webgl_says_so_and_keeps_its_picture(
    offline: tuple[Page, list[str], list[str]], tmp_path: Path
) -> None:
    page, _, _ = offline
    export(gyre(), tmp_path / "page.html", samples=9)
    page.add_init_script(
        "HTMLCanvasElement.prototype.getContext = new Proxy("
        "HTMLCanvasElement.prototype.getContext, { apply: (get, canvas, given) =>"
        " String(given[0]).startsWith('webgl') ? null : Reflect.apply(get, canvas, given) });"
        "delete window.OffscreenCanvas;"
    )
    page.goto((tmp_path / "page.html").as_uri())
    page.get_by_text("because it has no WebGL2").wait_for()
    assert page.locator("#preview").count() == 1


def test_the_first_picture_of_a_globe_has_the_coasts_of_its_near_side() -> None:
    winds = examples.weather().isel(latitude=slice(None, None, 3), longitude=slice(None, None, 3))

    def dark(*focus: float) -> NDArray[np.bool_]:
        pictures = []
        for coastlines in (True, False):
            lines = {"coastlines": coastlines, "graticule": False}
            view = web_views(winds, Options.split(level=250, globe=True, scalars=False, **lines))[0]
            a, b = np.radians(focus)
            way = np.array([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)])
            camera = Camera(tuple(20e6 * way), tuple(6.3e6 * way), (0, 0, 1))
            data = preview_png(view, (160, 120), camera=camera.to_dict())
            with Image.open(io.BytesIO(data)) as image:
                pictures.append(np.asarray(image.convert("L")).astype(int))
        return pictures[0] < pictures[1] - 30

    europe, pacific = dark(15, 45), dark(-130, 0)
    assert 0.02 < europe.mean() < 0.3
    assert pacific.mean() < 0.5 * europe.mean()
