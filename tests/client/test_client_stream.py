"""A page that reads its tiles from a store behind a plain web server, whole or broken."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from numpy.typing import NDArray
from pages import COMPLETE, acted, opened_page
from PIL import Image
from range_server import Answer, RangeServer, range_server
from waiting import wait_until

from flowtex import FlowField
from flowtex.host.export import export
from flowtex.pyramid import build

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytest.importorskip("zarr")

pytestmark = [pytest.mark.browser, pytest.mark.usefixtures("quick_export", "small_tiles")]

ROOT_NODES = 1250
LOOK: dict[str, Any] = {"samples": 9, "cmap": "viridis"}
NEAR: dict[str, Any] = {"zoom": 5, "focus": (3.2, 1.4), **LOOK}
PICTURE = (
    "() => document.querySelector('.flowtex').shadowRoot.querySelector('canvas.picture')"
    ".toDataURL().split(',')[1]"
)


def flat() -> FlowField:
    """A stream past an island."""
    y, x = np.mgrid[0:73, 0:133].astype(float) / 25
    velocity = np.stack([np.cos(3 * y) + 0.3, np.sin(4 * x)], axis=-1)
    valid = np.hypot(x - 1.3, y - 1.2) > 0.5
    scalars = {"depth": x * y + 0.3 * np.sin(30 * x)}
    return FlowField.from_arrays(np.stack([x, y], -1), velocity, valid=valid, scalars=scalars)


def series() -> FlowField:
    """Four times, of which the last ones are alike, with a scalar that does not vary."""
    y, x = np.mgrid[0:50, 0:100].astype(float) / 25
    steps = [np.stack([np.cos(y + t), np.sin(x - t)], axis=-1) for t in (0.0, 0.3, 0.6, 0.9)]
    scalars = {"heat": np.stack([x + t for t in range(4)]), "depth": x * y}
    return FlowField.from_arrays(
        np.stack([x, y], -1), np.stack(steps), times=[0, 0.01, 0.02, 0.03], scalars=scalars
    )


def globe() -> FlowField:
    """Around both poles."""
    lon, lat = np.meshgrid(np.radians(np.linspace(0, 360, 91)), np.radians(np.arange(-90, 91.0, 4)))
    points = np.stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)], axis=-1)
    return FlowField.from_arrays(
        points, np.cross([0.3, 0.1, 1.0], points), valid=np.hypot(lon - 2, lat - 0.5) > 0.4
    )


FLOWS = {"flat": flat, "series": series, "globe": globe}


@pytest.fixture(scope="module")
def stores(tmp_path_factory: pytest.TempPathFactory, small_tiles: None) -> Path:
    """Return a folder with a store of each flow."""
    folder = tmp_path_factory.mktemp("stores")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", ROOT_NODES)
        for name, make in FLOWS.items():
            build(make(), folder / f"{name}.zarr", progress=False)
    return folder


@pytest.fixture(scope="module")
def one_server(stores: Path) -> Iterator[RangeServer]:
    with range_server(stores) as started:
        yield started


@pytest.fixture
def server(one_server: RangeServer, stores: Path) -> RangeServer:
    """Return the server of all tests, which knows nothing of those before."""
    one_server.reset(stores)
    return one_server


@dataclass
class Shown:
    """A page in a browser, and what it complained of."""

    page: Page
    errors: list[str] = field(default_factory=list)

    def open(self, address: str) -> None:
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on("console", lambda line: self._heard(line.type, line.text))
        self.page.goto(address)

    def _heard(self, kind: str, text: str) -> None:
        # Chromium tells of what a server did not give.
        if kind == "error" and "Failed to load resource" not in text:
            self.errors.append(text)

    def wait(self) -> None:
        """Wait for a full picture for which nothing is missing."""
        self.page.wait_for_selector(COMPLETE)

    def zoom(self, by: int) -> None:
        """Turn the wheel, and wait for the picture."""
        self.page.mouse.move(150, 100)
        with acted(self.page):
            self.page.mouse.wheel(0, by)

    def drag(self) -> None:
        """Go to the right."""
        mouse = self.page.mouse
        mouse.move(250, 100)
        mouse.down()
        mouse.move(20, 100, steps=4)
        mouse.up()

    def pixels(self) -> NDArray[np.int64]:
        data = base64.b64decode(self.page.evaluate(PICTURE))
        with Image.open(io.BytesIO(data)) as image:
            return np.asarray(image.convert("RGB")).astype(int)

    def told(self) -> str:
        """Wait for what the view has to say."""
        self.page.locator(".flowtex .told").wait_for()
        return self.page.locator(".flowtex .told").inner_text()

    def choose(self, label: str, value: str) -> None:
        """Choose a colour in the panel, and wait for the picture."""
        if self.page.locator(".settings").is_hidden():
            self.page.locator("[data-name=settings]").click()
        with acted(self.page):
            self.page.get_by_label(label).select_option(value)

    def seek(self, share: str) -> None:
        """Go to a part of the times, and wait for the picture."""
        with acted(self.page):
            self.page.locator(".flowtex input[aria-label=Time]").fill(share)


@pytest.fixture
def shown(browser: Browser) -> Iterator[Shown]:
    with opened_page(browser) as page:
        shown = Shown(page)
        yield shown
    assert shown.errors == []


def tiles_of(server: RangeServer, array: str = "flow") -> list[str]:
    """Tiles that were requested, each as its level, row and column, in order."""
    found = []
    for path in server.paths:
        words = path.split("/")
        if words[2:3] == [array] and words[3] == "c":
            at = words[4:6] if array == "surface" else words[5:7]
            found.append("/".join([words[1], *at]))
    return found


def linked(server: RangeServer, name: str, **options: Any) -> Path:
    """Return a page of a store as the server has it, which is made once."""
    path = server.folder / f"{name} {sorted(options.items())}.html".replace("/", "")
    if path.exists():
        return path
    store = f"{server.address}{name}.zarr"
    export(str(server.folder / f"{name}.zarr"), path, store=store, **options)
    return path


def held(browser: Browser, path: Path, share: str = "") -> NDArray[np.int64]:
    """Return the picture of another page, at a part of its times."""
    with opened_page(browser) as page:
        other = Shown(page)
        other.open(path.as_uri())
        other.wait()
        if share:
            other.seek(share)
        pixels = other.pixels()
    assert other.errors == []
    return pixels


VIEWS: list[tuple[str, dict[str, Any]]] = [
    ("flat", {"zoom": 6, "focus": (4.2, 1.4), "log_scale": True, "clim": (0.5, 1.6)}),
    ("globe", {"zoom": 30, "focus": (0.0, 0.0, 1.0), "scalars": False}),
]


@pytest.mark.parametrize(("name", "options"), VIEWS)
def test_pictures_are_those_of_a_page_that_holds_all(
    browser: Browser,
    shown: Shown,
    server: RangeServer,
    tmp_path: Path,
    name: str,
    options: dict[str, Any],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    shown.open(linked(server, name, **LOOK, **options).as_uri())
    shown.wait()
    monkeypatch.setattr("flowtex.host.export.TILE_BYTES", 10**9)
    export(str(server.folder / f"{name}.zarr"), tmp_path / "whole.html", **LOOK, **options)
    # Triangles may be chosen by a share more exactly, which moves a colour by less than is seen.
    streamed = shown.pixels()
    off = np.abs(streamed - held(browser, tmp_path / "whole.html")).max(axis=-1)
    assert (off > 3).mean() < 0.002
    assert streamed.std() > 10
    assert tiles_of(server)


def test_a_view_asks_for_no_more_than_it_shows(shown: Shown, server: RangeServer) -> None:
    shown.open(linked(server, "flat", **{**NEAR, "zoom": 16, "focus": (0.9, 0.9)}).as_uri())
    shown.wait()
    assert tiles_of(server) == tiles_of(server, "surface") == ["0/0/0"]
    # The speed is that of the flow, so a tile is two objects, each whole; a level has descriptions.
    assert tiles_of(server, "values") == []
    assert len(server.asked) == 1 + 2 + 2, server.asked
    assert {(method, span) for method, _, span in server.asked} == {("GET", "")}
    with acted(shown.page):
        for _ in range(5):
            shown.drag()
    assert set(tiles_of(server)) == {"0/0/0", "0/0/1"}
    assert len(server.asked) == 1 + 2 + 2 + 2


def test_other_colours_are_those_of_a_page_that_has_them(
    browser: Browser, shown: Shown, server: RangeServer
) -> None:
    """And ask for values alone."""
    name = "series"
    view = {**NEAR, "focus": (1.9, 0.7)}
    shown.open(linked(server, name, **view).as_uri())
    shown.wait()
    speed, traced = shown.pixels(), tiles_of(server)
    shown.choose("Colour by", "depth")
    depth = shown.pixels()
    assert np.abs(depth - speed).mean() > 5
    assert tiles_of(server) == traced
    shown.choose("Colour by", "none")
    asked = len(server.asked)
    shown.choose("Colour by", "speed")
    assert np.abs(shown.pixels() - speed).max() <= 3
    assert len(server.asked) - asked <= 2 * len(traced)
    path = linked(server, name, **{**view, "scalars": "depth"})
    off = np.abs(held(browser, path) - depth).max(axis=-1)
    assert (off > 3).mean() < 0.002


def test_time_steps_come_when_they_are_shown(
    browser: Browser, shown: Shown, server: RangeServer, tmp_path: Path
) -> None:
    shown.open(linked(server, "series", **LOOK).as_uri())
    shown.wait()
    assert not [path for path in server.paths if path.startswith("series.zarr/2/")]
    shown.seek("1")
    last = shown.pixels()
    root = [path for path in server.paths if path.startswith("series.zarr/2/flow/c/")]
    assert sorted(path.split("/")[4] for path in root) == ["2", "3"]
    export(str(server.folder / "series.zarr"), tmp_path / "whole.html", **LOOK)
    # A speed that follows from the rounded flow moves a colour by less than is seen. The texture
    # leaves a colour its chroma, so a step of the map is at most a quarter wider than in grey.
    off = np.abs(held(browser, tmp_path / "whole.html", "1") - last).max(axis=-1)
    assert (off > 4).mean() < 0.002


def broken(data: bytes) -> bytes:
    """Turn bits in the middle."""
    middle = len(data) // 2
    return data[:middle] + bytes([data[middle] ^ 64]) + data[middle + 1 :]


def test_a_broken_tile_leaves_the_coarser_one_and_is_told_once(
    shown: Shown, server: RangeServer
) -> None:
    """client/tests/store.test.ts has all that may be wrong."""
    bad: list[str] = []

    def answer(path: str) -> Answer:
        if not path.startswith("flat.zarr/0/surface/c/") or (bad and path != bad[0]):
            return None
        bad.append(path)
        return broken((server.folder / path).read_bytes())

    page = linked(server, "flat", **NEAR)
    server.fault = answer
    shown.open(page.as_uri())
    assert "are corrupt" in shown.told()
    shown.wait()
    coarse = shown.pixels()
    assert coarse.std() > 10
    shown.page.locator(".flowtex .told").click()
    shown.zoom(-30)
    assert shown.page.locator(".flowtex .told").is_hidden()
    assert tiles_of(server)


def test_tile_is_requested_again_after_a_failure(shown: Shown, server: RangeServer) -> None:
    page = linked(server, "flat", **NEAR)
    tried: list[str] = []

    def answer(path: str) -> Answer:
        if not path.startswith("flat.zarr/0/flow/c/"):
            return None
        tried.append(path)
        return 503 if path == tried[0] and tried.count(path) <= 4 else None

    server.fault = answer
    shown.page.clock.install()
    shown.open(page.as_uri())

    def wait(holds: Callable[[], object]) -> None:
        def is_late() -> object:
            shown.page.clock.fast_forward(1000)
            return holds()

        wait_until(is_late)

    told = shown.page.locator(".flowtex .told")
    wait(told.is_visible)
    assert "the store does not answer" in told.inner_text()
    wait(shown.page.locator(COMPLETE).is_visible)
    assert tried.count(tried[0]) == 5


def test_a_page_of_two_views_beside_its_store(
    shown: Shown, server: RangeServer, stores: Path
) -> None:
    beside: dict[str, Any] = {"store": "./flat.zarr", "beside": {"lod": False}}
    for name in ("page.html", "other.html"):
        export(str(stores / "flat.zarr"), stores / name, **beside, **NEAR)
    shown.page.set_viewport_size({"width": 600, "height": 200})
    shown.open(f"{server.address}page.html")
    shown.page.wait_for_function(f"() => document.querySelectorAll('{COMPLETE}').length === 2")
    assert tiles_of(server)
    assert not shown.page.locator(".flowtex .told:visible").count()
    refused = shown.page.evaluate("fetch('https://example.org/').then(() => false, () => true)")
    assert refused
    assert [line for line in shown.errors if "Content Security Policy" in line]
    shown.errors.clear()
    shown.page.goto((stores / "other.html").as_uri())
    told = shown.page.locator(".flowtex .told").first
    told.wait_for()
    assert "open it from a web server" in told.inner_text()
