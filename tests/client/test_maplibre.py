"""A flow as a layer of a MapLibre map, whose style asks for nothing from the network."""

from __future__ import annotations

import gzip
import io
import re
import shutil
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from numpy.typing import NDArray
from pages import opened_page, painted
from PIL import Image
from range_server import RangeServer, range_server
from scipy.ndimage import binary_erosion, map_coordinates

import flowtex
from flowtex.field.earth.projection import EARTH_RADIUS
from flowtex.host.export import MAPLIBRE_DIGESTS
from flowtex.host.view import asset
from flowtex.pyramid import build

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytest.importorskip("zarr")
xr = pytest.importorskip("xarray")

pytestmark = [pytest.mark.browser, pytest.mark.usefixtures("small_tiles")]

ROOT = Path(__file__).parents[2]
MAPLIBRE = ROOT / "client" / "node_modules" / "maplibre-gl" / "dist"
MOST_BYTES = 64_000  #: Bytes that a page may load beside MapLibre.
WIDTH, HEIGHT = 300, 200
GRID = 8  #: Pixels between those whose places are asked for.
GROUND = (255, 0, 255)
STYLE: dict[str, Any] = {
    "version": 8,
    "sources": {},
    "layers": [{"id": "g", "type": "background", "paint": {"background-color": "#ff00ff"}}],
}
HOME = {"center": [-20.0, 40.0], "zoom": 3.0, "bearing": 0, "pitch": 0}
COMPLETE = "() => window.flow?.isComplete && !map.isMoving()"

Pixels = NDArray[np.float64]


def currents(steps: int = 1) -> Any:
    """Eddies around an island, on longitudes and latitudes."""
    lon, lat = np.linspace(-60, 20, 161), np.linspace(10, 65, 111)
    x, y = np.meshgrid(lon, lat)
    u = np.stack([0.3 + np.cos(y / 5 + t) for t in range(steps)])
    v = np.stack([np.sin(x / 4 + t) for t in range(steps)])
    for each in (u, v):
        each[:, np.hypot((x + 10) / 8, (y - 40) / 6) < 1] = np.nan
    dims = ("time", "lat", "lon")
    data = {
        "u": (dims, u, {"standard_name": "eastward_sea_water_velocity", "units": "m/s"}),
        "v": (dims, v, {"standard_name": "northward_sea_water_velocity", "units": "m/s"}),
    }
    coords = {
        "time": np.arange(steps) * np.timedelta64(1, "D") + np.datetime64("2026-01-01", "ns"),
        "lat": ("lat", lat, {"units": "degrees_north"}),
        "lon": ("lon", lon, {"units": "degrees_east"}),
    }
    return xr.Dataset(data, coords)


def around() -> Any:
    """Winds around the Earth."""
    lon, lat = np.arange(-180, 180, 3.0), np.arange(-84, 85, 3.0)
    x, y = np.meshgrid(np.radians(lon), np.radians(lat))
    unit = {"units": "m/s"}
    data = {
        "u": (("lat", "lon"), 2 + np.cos(5 * y), unit),
        "v": (("lat", "lon"), np.sin(4 * x), unit),
    }
    coords = {
        "lat": ("lat", lat, {"units": "degrees_north"}),
        "lon": ("lon", lon, {"units": "degrees_east"}),
    }
    return xr.Dataset(data, coords)


LOOK: dict[str, Any] = {"samples": 13, "cmap": "viridis"}


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory, small_tiles: None) -> Iterator[RangeServer]:
    """Return a server of a store, scenes, and the page of the documentation."""
    if not MAPLIBRE.is_dir():
        pytest.skip(f"{MAPLIBRE} is missing: run sh tools/client.sh .venv/bin ready")
    folder = tmp_path_factory.mktemp("map")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 3000)
        build(currents().isel(time=0), folder / "flow.zarr", projection="mercator", progress=False)
    flowtex.export(str(folder / "flow.zarr"), folder / "flow.json", store="./flow.zarr", **LOOK)
    series = currents(3).isel(lat=slice(None, None, 4), lon=slice(None, None, 4))
    flowtex.export(series, folder / "series.json", projection="mercator", samples=9)
    flowtex.export(series.isel(time=0), folder / "flat.json", samples=9)
    flowtex.export(around(), folder / "around.json", projection="mercator", **LOOK)
    text = (ROOT / "docs" / "howto" / "webmaps.md").read_text(encoding="utf-8")
    (page,) = re.findall(r"^```html\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    page = page.replace("https://unpkg.com/maplibre-gl@6.17.0/dist/", "./maplibre/")
    page = page.replace('"https://demotiles.maplibre.org/style.json"', "window.mapStyle")
    page = page.replace("map.addLayer(flow)", "map.addLayer((window.flow = flow))")
    page += "<style>.maplibregl-control-container { display: none }</style>"
    page = page.replace("const map = ", "const map = window.map = ")
    (folder / "page.html").write_text(page.replace("winds.json", "flow.json"), encoding="utf-8")
    shutil.copy(asset("maplibre.js"), folder)
    (folder / "maplibre").symlink_to(MAPLIBRE)
    with range_server(folder) as started:
        yield started


@dataclass
class Shown:
    """A map in a browser, and what it complained of."""

    page: Page
    address: str
    scene: str = "flow.json"
    projection: str = "mercator"
    errors: list[str] = field(default_factory=list)

    def load(self) -> None:
        """Open the page."""
        self.scene = "flow.json"
        self.page.goto(self.address)
        self.page.wait_for_function("() => window.map?.jumpTo")
        self.page.evaluate(
            "() => { window.told = []; map.on('error', (e) => told.push(e.error.message)); }"
        )

    def go(self, **look: Any) -> None:
        """Look at something else, and wait for its full picture."""
        self.page.evaluate("(look) => map.jumpTo(look)", look)
        self.wait()

    def wait(self) -> None:
        self.page.wait_for_function(COMPLETE)
        painted(self.page)

    def pixels(self) -> Pixels:
        with Image.open(io.BytesIO(self.page.screenshot())) as image:
            return np.asarray(image.convert("RGB")).astype(float)

    def replace(self, scene: str) -> None:
        """Show another scene."""
        self.scene = scene
        self.page.evaluate(
            "(scene) => { map.removeLayer('flow'); "
            "map.addLayer(window.flow = new flow.constructor({ id: 'flow', scene })); }",
            scene,
        )

    def project(self, projection: str) -> None:
        """Show a map or a globe."""
        self.projection = projection
        self.page.evaluate("(type) => map.setProjection({ type })", projection)
        painted(self.page)

    def hold(self, held: bool = True) -> None:
        """Have no more pictures of the flow drawn, or have them drawn again."""
        self.page.evaluate(
            "(held) => { const { view } = flow.pictures[0]; view.frame = held ? () => {} : "
            "Object.getPrototypeOf(view).frame; view.request(); }",
            held,
        )

    def lng_lats(self) -> NDArray[np.float64]:
        """Return longitude and latitude of every eighth pixel, (rows, columns, 2)."""
        script = (
            "([rows, columns]) => rows.map((y) => columns.map((x) => "
            "{ const { lng, lat } = map.unproject([x + 0.5, y + 0.5]); return [lng, lat]; }))"
        )
        places = [list(range(0, size + GRID, GRID)) for size in (HEIGHT, WIDTH)]
        return np.array(self.page.evaluate(script, places))

    def places(self, lng_lats: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return row and column of all pixels of those, (2, H, W), where they are seen now."""
        script = (
            "(rows) => rows.map((row) => row.map((lngLat) => "
            "{ const { x, y } = map.project(lngLat); return [y - 0.5, x - 0.5]; }))"
        )
        found = np.array(self.page.evaluate(script, lng_lats.tolist()))
        grid = np.mgrid[0:HEIGHT, 0:WIDTH] / GRID
        return np.stack([map_coordinates(found[..., k], grid, order=1) for k in range(2)])


@pytest.fixture(scope="module")
def opened(browser: Browser, server: RangeServer) -> Iterator[Shown]:
    """The page of the documentation, for all tests: to load MapLibre takes a second."""
    with opened_page(browser, WIDTH, HEIGHT) as page:
        opened = Shown(page, f"{server.address}page.html")
        page.on("pageerror", lambda error: opened.errors.append(str(error)))
        page.add_init_script(f"window.mapStyle = {STYLE!r}")
        opened.load()
        yield opened
    assert opened.errors == []


@pytest.fixture
def shown(opened: Shown) -> Iterator[Shown]:
    """The page with a map that complains of nothing; its flow may be that of an earlier test."""
    if opened.projection != "mercator":
        opened.project("mercator")
    yield opened
    assert opened.page.evaluate("() => told") == []


@pytest.fixture
def currents_shown(shown: Shown) -> Shown:
    """The map of the documentation, complete."""
    if shown.scene != "flow.json":
        shown.replace("flow.json")
    shown.go(**HOME)
    return shown


def moved(before: Pixels, places: NDArray[np.float64]) -> Pixels:
    """Return a picture whose pixels are from places of another; NaN beside it."""
    channels = [map_coordinates(before[..., k], places, order=1, cval=np.nan) for k in range(3)]
    return np.stack(channels, axis=-1)


def correlation(one: Pixels, other: Pixels) -> float:
    """Return the correlation of brightness where both show the flow, which must be a large part."""
    seen = np.isfinite(one + other).all(axis=-1)
    for picture in (one, other):
        seen &= np.abs(picture - GROUND).sum(axis=-1) > 60
    assert seen.mean() > 0.15
    return float(np.corrcoef(one[seen].mean(axis=-1), other[seen].mean(axis=-1))[0, 1])


VIEWS: dict[str, dict[str, Any]] = {
    "pan": {"center": [-24.2, 42.1], "zoom": 3},
    "zoom": {"center": [-18.0, 41.0], "zoom": 3.6},
    "turn": {"center": [-20.0, 40.0], "zoom": 3.2, "bearing": 35, "pitch": 40},
}


@pytest.mark.parametrize("projection", ["mercator", "globe"])
def test_the_layer_sticks_to_the_map(currents_shown: Shown, projection: str) -> None:
    shown = currents_shown
    shown.project(projection)
    shown.go(**HOME)
    before = shown.pixels()
    shown.hold()
    for look in VIEWS.values():
        shown.page.evaluate("(look) => map.jumpTo(look)", look)
        painted(shown.page)
        after, lng_lats = shown.pixels(), shown.lng_lats()
        shown.page.evaluate("(look) => map.jumpTo(look)", HOME)
        painted(shown.page)
        expected = moved(before, shown.places(lng_lats))
        assert correlation(expected, after) > 0.95
    shown.hold(False)
    # A new picture goes on where the last one was.
    shown.go(**VIEWS["pan"])
    after, lng_lats = shown.pixels(), shown.lng_lats()
    shown.go(**HOME)
    assert correlation(moved(before, shown.places(lng_lats)), after) > 0.95


def test_the_layer_agrees_with_flowtexs_own_view(
    currents_shown: Shown, server: RangeServer
) -> None:
    shown = currents_shown
    for center, zoom in (([-24.2, 42.1], 3.0), ([-21.3, 44.0], 6.5)):
        shown.go(center=center, zoom=zoom)
        lng, lat = np.radians(center)
        # MapLibre's world has 512 pixels at zoom 0; the map of the field begins at its own middle.
        pixel = 2 * np.pi * EARTH_RADIUS / (512 * 2**zoom)
        middle = np.radians(-20.0)
        x, y = EARTH_RADIUS * (lng - middle), EARTH_RADIUS * np.arctanh(np.sin(lat))
        camera = {
            "position": (x, y, 1e7),
            "focal_point": (x, y, 0.0),
            "up": (0.0, 1.0, 0.0),
            "parallel": True,
            "parallel_scale": 0.5 * HEIGHT * pixel,
        }
        own = flowtex.render(
            str(server.folder / "flow.zarr"),
            size=(WIDTH, HEIGHT),
            camera=camera,
            background="#ff00ff",
            coastlines=False,
            show_scalar_bar=False,
            **LOOK,
        )
        assert correlation(own.astype(float), shown.pixels()) > 0.98


def test_what_is_shown_can_be_changed(currents_shown: Shown) -> None:
    shown = currents_shown
    shown.page.evaluate("() => { flow.opacity = 1; }")
    painted(shown.page)
    whole = shown.pixels()
    water = np.abs(whole - GROUND).sum(axis=-1) > 60
    shown.page.evaluate("() => { flow.opacity = 0.5; }")
    painted(shown.page)
    np.testing.assert_allclose(shown.pixels(), (whole + GROUND) / 2, atol=1.5)
    shown.page.evaluate("flow.opacity = 1; flow.setColours({ cmap: 'magma' })")
    shown.wait()
    assert np.abs(shown.pixels() - whole)[water].mean() > 20
    assert np.abs(shown.pixels() - whole)[~water].max() == 0
    shown.page.evaluate("flow.setColours({ cmap: 'viridis' }); flow.set({ strength: 0 })")
    shown.wait()
    grain = [np.abs(np.diff(each, axis=1)).mean() for each in (shown.pixels(), whole)]
    assert grain[0] < 0.5 * grain[1]
    shown.page.evaluate("() => flow.play()")
    shown.page.wait_for_function("() => flow.time > 0.1")
    shown.page.evaluate("() => flow.pause()")
    shown.wait()
    assert shown.page.evaluate("() => [flow.times, flow.time < 5]") == [[0], True]
    shown.scene = ""  # the next test begins anew


#: Answers a question, and counts the frames of the page until then.
ASK_AND_COUNT = """async ([lng, lat]) => {
    let frames = 0;
    let next = 0;
    const count = () => {
        frames += 1;
        next = requestAnimationFrame(count);
    };
    count();
    const answer = await flow.pointAt({ lng, lat });
    cancelAnimationFrame(next);
    return [answer, frames];
}"""
#: A picture of some tiles takes a few frames; patience ends after some hundred.
FEW_FRAMES = 100


def test_a_click_is_answered_by_the_data(currents_shown: Shown) -> None:
    shown = currents_shown
    shown.page.wait_for_function("() => flow.pointAt({ lng: -30, lat: 42 })")
    found, frames = shown.page.evaluate(ASK_AND_COUNT, [-30.2, 42.3])
    assert frames < FEW_FRAMES
    data = currents().isel(time=0).interp(lon=-30.2, lat=42.3)
    assert found["eastward"] == pytest.approx(float(data.u), abs=0.02)
    assert found["northward"] == pytest.approx(float(data.v), abs=0.02)
    assert found["values"]["speed"] == pytest.approx(float(np.hypot(data.u, data.v)), rel=0.02)
    away = np.hypot(*(np.array(found["path"]) - [-30.2, 42.3]).T)
    assert away.min() < 1e-3 and 0.1 < away.max() < 9
    on_land, _ = shown.page.evaluate(ASK_AND_COUNT, [-10, 40])
    assert on_land is None  # the island


@pytest.mark.parametrize("scene", ["flow.json", "around.json"])
def test_a_point_has_the_values_of_the_data_at_every_zoom(shown: Shown, scene: str) -> None:
    shown.replace(scene)
    data = around() if scene == "around.json" else currents().isel(time=0)
    places = [(-33.37, 38.81), (-30.2, 42.3)]
    for zoom in (1.5, 6.0):
        shown.go(center=[-32.0, 40.5], zoom=zoom)
        for lng, lat in places:
            found = shown.page.evaluate("([lng, lat]) => flow.pointAt({ lng, lat })", [lng, lat])
            expected = data.interp(lon=lng, lat=lat)
            parts = [float(expected.u), float(expected.v)]
            assert [found["eastward"], found["northward"]] == pytest.approx(parts, abs=2e-3)


def test_the_map_asks_for_the_tiles_that_it_shows(
    currents_shown: Shown, server: RangeServer
) -> None:
    shown = currents_shown
    shown.load()
    shown.wait()
    server.reset(server.folder)
    # The first view has shown the others; each tile is one object for the flow.
    shown.go(center=[12.0, 50.0], zoom=5)
    assert [path.split("/c/")[1] for path in server.paths if "0/flow/c/" in path] == ["0/1/2/0"]
    assert len(gzip.compress(asset("maplibre.js").read_bytes())) < MOST_BYTES


def test_a_series_goes_on_in_time(shown: Shown) -> None:
    shown.replace("series.json")
    shown.wait()
    first = shown.pixels()
    times = shown.page.evaluate("() => flow.times")
    assert np.diff(times) == pytest.approx(86_400)
    shown.page.evaluate("(time) => { flow.time = time; }", times[1])
    shown.wait()
    assert shown.page.evaluate("() => flow.time") == times[1]
    assert np.abs(shown.pixels() - first).mean() > 5
    shown.page.evaluate("() => { window.view = flow.pictures[0].view; map.removeLayer('flow'); }")
    painted(shown.page)
    assert (shown.pixels() == GROUND).all()
    assert shown.page.evaluate("() => view.graphics.objects") == 0


def test_a_layer_can_be_added_again(shown: Shown) -> None:
    shown.load()
    shown.go(**HOME)
    before = shown.pixels()
    shown.page.evaluate(
        "() => { const lost = map.painter.context.gl.getExtension('WEBGL_lose_context');"
        "map.once('webglcontextlost', () => setTimeout(() => lost.restoreContext()));"
        "lost.loseContext(); }"
    )
    shown.page.wait_for_function("() => map.style?._loaded && map.getLayer('flow')")
    shown.wait()
    assert correlation(before, shown.pixels()) > 0.999
    shown.page.evaluate("() => { map.setStyle(mapStyle, { diff: false }); }")
    painted(shown.page)
    shown.wait()
    assert correlation(before, shown.pixels()) > 0.999


@pytest.mark.parametrize(
    ("scene", "said"),
    [
        ("flat.json", 'the flow is on another map; export it with projection="mercator"'),
        ("none.json", "none.json cannot be read: the server answers 404"),
    ],
)
def test_what_cannot_be_shown_is_told_to_the_map(shown: Shown, scene: str, said: str) -> None:
    shown.replace(scene)
    shown.page.wait_for_function("() => told.length")
    assert said in shown.page.evaluate("() => told.splice(0).join()")


@pytest.mark.parametrize("projection", ["mercator", "globe"])
def test_data_around_the_earth_are_shown_across_their_ends(shown: Shown, projection: str) -> None:
    shown.replace("around.json")
    shown.project(projection)
    pictures = []
    for lng in (178.0, -178.0):
        shown.go(center=[lng, 10.0], zoom=3)
        picture = shown.pixels()
        assert (np.abs(picture - GROUND).sum(axis=-1) > 60).all()
        pictures.append(picture)
        # What moves to the east is the same on both sides.
        found = [
            shown.page.evaluate("([lng, lat]) => flow.pointAt({ lng, lat })", [lng + by, 12])
            for by in (-5, 5)
        ]
        expected = [np.sin(4 * np.radians(lng + by)) for by in (-5, 5)]
        assert [each["northward"] for each in found] == pytest.approx(expected, abs=0.05)
    # Both show the same part, 4 degrees apart.
    step = round(4 / 360 * 512 * 8)
    one, other = pictures[0][:, step:], pictures[1][:, :-step]
    if projection == "mercator":
        assert correlation(one, other) > 0.95


#: Views of the line, and the change there over that elsewhere: pixels of a whole globe are larger.
ACROSS: dict[str, tuple[str, dict[str, Any], float]] = {
    "map": ("mercator", {"center": [179.3, 10.0], "zoom": 3}, 1.3),
    "closer": ("mercator", {"center": [-179.8, 35.0], "zoom": 6}, 1.3),
    "deep": ("mercator", {"center": [180.0, 20.0], "zoom": 10}, 1.3),
    "copies": ("mercator", {"center": [-140.0, 0.0], "zoom": -1.3}, 1.3),
    "globe": ("globe", {"center": [179.3, 10.0], "zoom": 3}, 1.3),
    "whole globe": ("globe", {"center": [-170.0, 10.0], "zoom": 0.5}, 1.6),
}


@pytest.mark.parametrize("name", ACROSS)
def test_streaks_cross_the_ends_of_data_around_the_earth(shown: Shown, name: str) -> None:
    if shown.scene != "around.json":
        shown.replace("around.json")
    projection, look, most = ACROSS[name]
    shown.project(projection)
    shown.go(**look)
    picture = shown.pixels()
    rows = np.arange(HEIGHT // 2 - 30, HEIGHT // 2 + 30)
    script = """(rows) => rows.map((row) => {
      const { lng, lat } = map.unproject([map.getCanvas().clientWidth / 2, row + 0.5]);
      const turn = 360 * Math.round((map.getCenter().lng - 180) / 360);
      return map.project([180 + turn, lat]).x;
    })"""
    line = np.array(shown.page.evaluate(script, rows.tolist()))
    columns = np.round(line[:, None] + np.arange(-25, 26)).astype(int)
    around_line = picture[rows[:, None], columns]
    assert np.abs(around_line - GROUND).sum(axis=-1).min() > 60
    # From each column to the next the brightness changes no more at the line than elsewhere.
    steps = np.abs(np.diff(around_line.mean(axis=-1), axis=1)).mean(axis=0)
    assert steps[22:28].max() < most * np.delete(steps, range(22, 28)).max()


#: Views of a globe with its edge, or a corner near it: where data end at 84 degrees is not seen.
GLOBES: dict[str, dict[str, Any]] = {
    "whole": {"center": [0.0, 0.0], "zoom": 0},
    "edges": {"center": [180.0, 20.0], "zoom": 1.6},
    "corners": {"center": [0.0, 30.0], "zoom": 2.2},
    "horizon": {"center": [10.0, 0.0], "zoom": 4, "pitch": 60},
}


@pytest.mark.parametrize("name", GLOBES)
def test_the_flow_reaches_the_edge_of_a_globe(shown: Shown, name: str) -> None:
    if shown.scene != "around.json":
        shown.replace("around.json")
    shown.project("globe")
    shown.go(**({"bearing": 0, "pitch": 0} | GLOBES[name]))
    bare = np.abs(shown.pixels() - GROUND).sum(axis=-1) < 60
    # Pixels of the edge itself show some of the ground.
    assert not binary_erosion(bare, np.ones((2, 2), dtype=bool)).any()
    shown.go(bearing=0, pitch=0)


@pytest.mark.parametrize("bearing", [0, 30])
def test_each_copy_of_the_world_shows_the_flow(shown: Shown, bearing: int) -> None:
    if shown.scene != "around.json":
        shown.replace("around.json")
    shown.go(center=[-80.0, 0.0], zoom=-1.3, bearing=bearing)
    middle = shown.pixels()[85:115, 10:290]
    assert np.abs(middle - GROUND).sum(axis=-1).min() > 60
    shown.go(bearing=0)


def test_a_page_with_a_map_is_written_whole(
    browser: Browser, server: RangeServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("flowtex.host.export.MAPLIBRE", f"{server.address}maplibre")
    page, own = server.folder / "own.html", str(server.folder / "flow.zarr")
    made = flowtex.export(own, page, store="./flow.zarr", basemap=STYLE, title="<Eddies>", **LOOK)
    assert made.nbytes == page.stat().st_size
    with opened_page(browser, WIDTH, HEIGHT) as opened:
        opened.goto(f"{server.address}own.html")
        opened.wait_for_function(COMPLETE)
        assert opened.title() == "<Eddies>"
        west, south, east, north = np.ravel(opened.evaluate("() => map.getBounds().toArray()"))
        assert west < -60 and south < 10 and east > 20 and north > 65
        assert opened.evaluate("() => flow.bounds.flat()") == pytest.approx(
            [-60, 10, 20, 65], abs=0.2
        )
        opened.mouse.click(WIDTH / 2, HEIGHT / 2)
        opened.locator(".maplibregl-popup", has_text="speed").wait_for()
        assert opened.locator("#fault").is_hidden()
        # Nothing else can be run.
        refused = opened.evaluate("""() => new Promise((resolve) => {
          document.onsecuritypolicyviolation = (event) => resolve(event.effectiveDirective);
          const script = document.createElement("script");
          script.textContent = "window.ran = true";
          document.body.append(script);
          if (window.ran) resolve("ran");
        })""")
        assert refused.startswith("script-src") and opened.evaluate("() => window.ran") is None


@pytest.mark.parametrize("name", ["maplibre-gl.mjs", "maplibre-gl-worker.mjs"])
def test_page_refuses_another_maplibre(
    page: Page, server: RangeServer, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.setattr("flowtex.host.export.MAPLIBRE", f"{server.address}maplibre")
    monkeypatch.setitem(MAPLIBRE_DIGESTS, name, f"sha384-{'A' * 64}")
    own = server.folder / "other.html"
    flowtex.export(
        str(server.folder / "flow.zarr"), own, store="./flow.zarr", basemap=STYLE, **LOOK
    )
    page.goto(f"{server.address}other.html")
    page.locator("#fault", has_text="Failed to fetch").wait_for()
    assert page.evaluate("() => window.map instanceof HTMLElement")


@pytest.mark.parametrize(
    ("basemap", "name", "options", "said"),
    [
        ("style.json", "a.html", {}, "basemap is 'style.json'; expected the address of a style"),
        (STYLE, "a.json", {}, "path is 'a.json'; expected a page"),
        (STYLE, "a.html", {"projection": "robinson"}, "on the map 'robinson'; web maps are in"),
    ],
)
def test_what_is_no_web_map_is_refused(
    basemap: Any, name: str, options: dict[str, Any], said: str, tmp_path: Path
) -> None:
    winds = around().isel(lat=slice(None, None, 8), lon=slice(None, None, 8))
    chosen = {"projection": "mercator"} | options
    with pytest.raises(flowtex.FieldError, match=re.escape(said)):
        flowtex.export(winds, tmp_path / name, basemap=basemap, **chosen)
    assert not list(tmp_path.iterdir())
