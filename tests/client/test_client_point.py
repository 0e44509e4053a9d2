"""A click on the browser client: the path through the point, and the card of its numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from flows import gyre, lines, swinging, torus
from matrix import ASIDE, IMAGE, MIDDLE, SIZE, WHOLE
from webgl_page import ClientPage, packed, state

from flowtex import FlowField, formula
from flowtex.field.earth.projection import Projection
from flowtex.host.view import web_views
from flowtex.rendering.camera import Camera
from flowtex.rendering.webgl.client_data import ClientData, Colours
from flowtex.scene.options import Appearance, Options
from flowtex.scene.probe import locate, probe
from flowtex.scene.scene import Scene
from flowtex.settings import Settings

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = pytest.mark.browser

#: Flows, cameras and settings whose paths are compared with those of the NumPy renderer.
PATHS: dict[str, tuple[FlowField, Camera, dict[str, Any]]] = {
    "one side": (gyre(), WHOLE, {"two_sided": False, "samples": 12}),
    "fixed grain": (gyre(), WHOLE, {"lod": False}),
    "moving": (gyre(), WHOLE, {"motion": "speed"}),
    "image": (gyre(), WHOLE, {"noise": "image"}),
    "curved": (torus(), ASIDE, {}),
    "varying": (swinging(), MIDDLE, {}),
    "no sign": (lines(), MIDDLE, {}),
}
DRAWN = "() => { const { path, point } = viewers[0].card.drawn; return { ...path, point }; }"


def card(page: Page) -> dict[str, str]:
    """Words and numbers of the card."""
    words, numbers = (
        page.locator(f".card:visible {kind}").all_inner_texts() for kind in ("dt", "dd")
    )
    return dict(zip(words, numbers, strict=True))


@pytest.mark.parametrize("name", PATHS)
def test_the_path_is_that_of_the_renderer(client: ClientPage, name: str) -> None:
    field, camera, chosen = PATHS[name]
    scene = Scene(field, Settings(samples=21), Appearance.of(image=IMAGE))
    scene.settings.update(**chosen)
    data = ClientData(scene.textures, Colours(plain=(0.6, 0.6, 0.6)))
    header = data.header(scene.settings, camera=state(camera))
    client.mount(packed(data, header, tuple(range(data.steps))), SIZE, smooth=False)
    client.sharp()
    client.page.wait_for_function("() => viewers[0].canPick")
    point = client.page.evaluate("() => viewers[0].card.choose(0.2, -0.24)")
    drawn = client.page.evaluate(DRAWN)
    i, j = point["index"]
    # The view may stand back from the whole surface.
    seen = Camera.from_dict(client.page.evaluate("() => viewers[0].camera.state"), camera)
    judge = probe(scene, (j, i), pixel=seen, size=SIZE)
    np.testing.assert_allclose(drawn["point"], judge.field_values.position, atol=2e-3)
    length = float(np.linalg.norm(np.diff(judge.points, axis=0), axis=1).sum())
    assert length > 0
    # The sides are as long as the samples reach, to a part of the grain that is not followed.
    loose = 0.1 if name in ("image", "curved") else 0.06
    ends = np.array([drawn["sampled"][0], drawn["sampled"][-1]])
    if drawn["directed"]:
        np.testing.assert_allclose(ends, judge.points[[0, -1]], atol=loose * length)
    else:
        gap = np.linalg.norm(ends[:, None] - judge.points[[0, -1]], axis=-1).min(axis=1)
        assert gap.max() < loose * length
    # It goes through all samples.
    path = np.array(drawn["path"])
    gap = np.linalg.norm(judge.points[:, None] - path, axis=-1).min(axis=1)
    assert gap.max() < 0.1 * length
    speed = judge.field_values.speed
    assert np.linalg.norm(drawn["velocity"]) == pytest.approx(speed, rel=0.01)
    if drawn["directed"]:
        along = np.asarray(judge.field_values.velocity)
        np.testing.assert_allclose(drawn["velocity"], along, atol=0.03 * speed)
    assert drawn["directed"] == (name != "no sign")
    # The chart has the samples of the judge, unless they move or an image takes their place.
    samples = drawn.get("samples")
    assert (samples is None) == (name in ("moving", "image"))
    if samples is not None and drawn["directed"]:
        longest = np.abs(judge.lags).max()
        lags = [sample["lag"] for sample in samples]
        np.testing.assert_allclose(lags, judge.lags, atol=0.02 * longest)
        weights = [sample["weight"] for sample in samples]
        np.testing.assert_allclose(weights, judge.weights, atol=0.02 * max(weights))
        assert len(client.page.query_selector_all(".samples li")) == len(judge.lags)


def leaving(*, share: float = 0.6) -> FlowField:
    """A stream with a part that leaves the surface."""
    y, x = np.mgrid[-1:1:21j, -2:2:41j]
    velocity = np.stack([1 + 0 * x, 0.75 + 0 * x, share + 0 * x], axis=-1)
    return FlowField.from_arrays(
        np.stack([x, y, 0 * x], axis=-1),
        velocity,
        scalars={"warmth": 10 * x},
        length_unit="m",
        time_unit="s",
    )


def mount(client: ClientPage, field: FlowField, **options: Any) -> None:
    view = web_views(field, Options.split(samples=9))[0]
    data = view.page_data()
    plain = {"controls": False, "smooth": False}
    steps = tuple(range(len(field.times)))
    client.mount(
        packed(data, data.header(view.scene.settings), steps), (600, 300), **plain | options
    )
    client.sharp()


def test_a_click_shows_card_and_path_until_the_card_is_closed(client: ClientPage) -> None:
    mount(client, leaving(share=0.0), hear=["onPoint"])
    page = client.page
    page.mouse.click(300, 150)
    page.locator(".card").wait_for()
    got = card(page)
    assert list(got) == ["position", "velocity", "speed", "warmth"]
    assert got["position"].endswith(" m") and got["position"].count(",") == 1
    assert got["speed"] == "1.25 m/s"
    assert float(got["warmth"]) == pytest.approx(0, abs=0.2)
    ((_, point),) = page.evaluate("events")
    assert set(point["values"]) == {"speed", "warmth"}
    shapes = page.locator("svg.path > *").evaluate_all(
        "all => all.map((e) => e.getAttribute('class'))"
    )
    assert {"whole", "sampled", "casing", "arrow", "point"} <= set(shapes)
    # The head of the arrow is downstream of the point, up and to the right.
    tip = page.locator("svg.path .arrow").first.get_attribute("points") or ""
    x, y = map(float, tip.split()[0].split(","))
    assert x > 300 and y < 150

    # The path follows the camera and the settings.
    ring = page.locator("svg.path .point")
    assert float(ring.get_attribute("cx") or 0) == pytest.approx(300, abs=1)
    page.evaluate("() => { viewers[0].camera.pan(0.2, 0); viewers[0].reportCamera(); }")
    assert float(ring.get_attribute("cx") or 0) == pytest.approx(240, abs=1)
    client.sharp()
    count = """() => {
      const { sampled } = viewers[0].card.drawn.path;
      return sampled[sampled.length - 1][0] - sampled[0][0];
    }"""
    before = page.evaluate(count)
    page.evaluate("() => viewers[0].choose('samples', 17)")
    client.sharp()
    assert page.evaluate(count) == pytest.approx(2 * before, rel=0.01)

    # And there are several ways to close the card.
    page.keyboard.press("Escape")
    ways: list[Callable[[], None]] = [
        lambda: page.keyboard.press("Escape"),
        lambda: page.mouse.click(597, 3),
        lambda: page.locator(".card button").click(),
        lambda: page.mouse.dblclick(320, 160),
    ]
    for close in ways:
        page.mouse.click(300, 150)
        page.locator(".card").wait_for()
        close()
        page.locator(".card").wait_for(state="hidden")
        assert page.locator("svg.path > *").count() == 0
        page.evaluate("viewers[0].reset()")
        client.sharp()
    # A click is kept while the program that finds points is being compiled, and far in there are
    # as many digits as tell pixels apart.
    page.evaluate("""() => {
      let asked = 0;
      Object.defineProperty(viewers[0], "canPick", { get: () => asked++ > 2, configurable: true });
      viewers[0].camera.zoomBy(1e5, 0.1, 0.1);
      viewers[0].reportCamera();
    }""")
    page.mouse.click(330, 170)
    page.locator(".card").wait_for()
    assert len(card(page)["position"]) > 20
    page.evaluate("() => { delete viewers[0].canPick; }")


def test_the_card_follows_the_time_that_plays(client: ClientPage) -> None:
    y, x = np.mgrid[-1:1:21j, -2:2:41j]
    steps = np.array([1.0, 2.0, 4.0])[:, None, None, None] * np.ones((*x.shape, 2))
    mount(client, FlowField.from_arrays(np.stack([x, y], axis=-1), steps, times=[0.0, 5.0, 10.0]))
    client.page.mouse.click(300, 150)
    client.page.locator(".card").wait_for()
    shown = "viewers[0].card.element.innerText"
    first = client.page.evaluate(shown)
    client.page.evaluate("viewers[0].play()")
    client.page.wait_for_function(f"(first) => {shown} !== first", arg=first)
    assert client.page.evaluate("viewers[0].playing")
    client.page.evaluate("viewers[0].pause()")


def test_both_of_two_views_show_the_path(client: ClientPage) -> None:
    view = web_views(leaving(), Options.split(samples=9))[0]
    data = view.page_data()
    scene = packed(data, data.header(view.scene.settings))
    client.mount([scene, scene], (700, 300), smooth=False)
    for n in (0, 1):
        client.page.wait_for_function(f"() => viewers[0].together[{n}].sharp")
    client.page.mouse.click(175, 150)
    client.page.locator(".card:visible").wait_for()
    assert client.page.locator("svg.path .point").count() == 2
    assert client.page.locator(".card:visible").count() == 1
    client.page.keyboard.press("Escape")
    assert client.page.locator("svg.path .point").count() == 0
    client.page.evaluate("() => viewers[0].together.forEach((viewer) => viewer.dispose())")


@pytest.mark.parametrize("projection", ["globe", "mercator", "robinson"])
def test_the_card_has_the_values_of_the_data_on_every_map(
    client: ClientPage, projection: str
) -> None:
    lon, lat = np.meshgrid(np.arange(0, 61, 2.5), np.arange(20, 71, 2.5))
    drawn = Projection(projection, (30.0, 45.0))
    # As of datasets, the scalar is the speed on the Earth.
    u, v = 8 + np.sin(np.radians(3 * lon)), 4 * np.cos(np.radians(2 * lat))
    field = FlowField.from_arrays(
        drawn.positions(lon, lat),
        drawn.vectors(lon, lat, u, v),
        projection=drawn,
        length_unit="m",
        time_unit="s",
        scalars={} if projection == "globe" else {"speed": np.hypot(u, v)},
        units={"speed": "m/s"},
    )
    mount(client, field)
    client.page.wait_for_function("() => viewers[0].canPick")
    point = client.page.evaluate("() => viewers[0].card.choose(0.11, 0.07)")
    expected = field.at(*map(float, drawn.lonlat(np.array(point["position"]))))
    assert expected is not None
    got = card(client.page)
    assert list(got) == ["place", "eastward", "northward", "speed"]
    parts = [float(got[name].removesuffix(" m/s")) for name in list(got)[1:]]
    same = [expected.eastward, expected.northward, expected.speed]
    assert parts == pytest.approx(same, abs=1e-2)  # with three digits


def wandering() -> FlowField:
    """A vortex that moves to the right, at nine times."""
    y, x = np.mgrid[-1:1:25j, -1.5:1.5:37j]
    times = np.linspace(0.0, 0.8, 9)
    steps = [np.stack([-y, x - 1.5 * t + 0.4], axis=-1) for t in times]
    return FlowField.from_arrays(np.stack([x, y], axis=-1), np.stack(steps), times=times)


def test_each_of_two_views_shows_its_own_path(client: ClientPage) -> None:
    beside = {"lines": "streamlines"}
    views = web_views(wandering(), Options.split(lines="pathlines", samples=31, beside=beside))
    scenes = []
    for view in views:
        data = view.page_data()
        header = data.header(view.scene.settings, camera=state(MIDDLE), time=0.4)
        scenes.append(packed(data, header, tuple(range(9))))
        view.scene.time = 0.4
    client.mount(scenes, (2 * SIZE[0] + 2, SIZE[1]), smooth=False, controls=False)
    picks = "() => viewers[0].together.every((view) => view.sharp && view.canPick)"
    client.page.wait_for_function(picks)
    for clicked in (0, 1):
        client.page.evaluate(f"viewers[0].together[{clicked}].card.choose(0.3, -0.2)")
        ends = []
        for n, view in enumerate(views):
            drawn = client.page.evaluate(DRAWN.replace("viewers[0]", f"viewers[0].together[{n}]"))
            at = locate(view.field, drawn["point"])
            assert at is not None
            judge = probe(view.scene, at, pixel=MIDDLE, size=SIZE)
            length = float(np.linalg.norm(np.diff(judge.points, axis=0), axis=1).sum())
            ends.append(np.array([drawn["sampled"][0], drawn["sampled"][-1]]))
            np.testing.assert_allclose(ends[n], judge.points[[0, -1]], atol=0.06 * length)
        assert np.abs(ends[0] - ends[1]).max() > 0.2 * length
        assert client.page.locator(".card:visible").count() == 1
    client.page.evaluate("() => viewers[0].together.forEach((viewer) => viewer.dispose())")


def test_what_is_read_off_follows_the_time(client: ClientPage) -> None:
    y, x = np.mgrid[-1:1:21j, -2:2:41j]
    steps = np.array([1.0, 2.0, 4.0])[:, None, None, None] * np.ones((*x.shape, 2))
    field = FlowField.from_arrays(np.stack([x, y], axis=-1), steps, times=[0.0, 5.0, 10.0])
    mount(client, field, hear=["onPoint"], controls=True)
    page = client.page
    readout = "viewers[0].root.shadowRoot.querySelector('.readout').innerText"
    page.mouse.click(300, 130)
    page.locator(".card").wait_for()
    page.mouse.move(320, 140)
    for time, factor in ((5.0, 2.0), (7.5, 3.0), (10.0, 4.0), (0.0, 1.0)):
        speed = factor * 2**0.5
        at_once = f"(time) => {{ viewers[0].setTime(time); return {readout}; }}"
        assert "speed" not in page.evaluate(at_once, time), "nothing of the time before"
        client.sharp()
        page.wait_for_function(f"() => {readout}.includes('speed')")
        assert float(page.evaluate(readout).split()[-1]) == pytest.approx(speed, rel=1e-2)
        assert float(card(page)["speed"]) == pytest.approx(speed, rel=1e-2)
        _, point = page.evaluate("events")[-1]
        assert point["values"]["speed"] == pytest.approx(speed, rel=1e-2)


@pytest.mark.parametrize("projection", ["", "robinson"])
def test_the_card_has_the_speed_between_opposite_flows(client: ClientPage, projection: str) -> None:
    x, y = np.meshgrid(np.arange(0.0, 61, 5), np.arange(20.0, 71, 5))
    points, flow = np.stack([x, y], axis=-1), np.stack([3 + 0 * x, 4 + 0 * x], axis=-1)
    map_of: dict[str, Any] = {}
    if projection:
        drawn = Projection(projection, (30.0, 45.0))
        points, flow = drawn.positions(x, y), drawn.vectors(x, y, 3 + 0 * x, 4 + 0 * x)
        map_of = {"projection": drawn, "length_unit": "m", "time_unit": "s"}
    steps = np.stack([flow, -2 * flow])
    scalars = {"warmth": x, "speed": np.stack([5 + 0 * x, 10 + 0 * x])}
    field = FlowField.from_arrays(points, steps, times=[0, 1], scalars=scalars, **map_of)
    view = web_views(field, Options.split(samples=9, scalars="warmth"))[0]
    data = view.page_data()
    header = data.header(view.scene.settings, time=1 / 3)
    client.mount(packed(data, header, (0, 1)), SIZE, smooth=False, controls=False)
    client.sharp()
    client.page.wait_for_function("() => viewers[0].canPick")
    client.page.evaluate("() => viewers[0].card.choose(0.11, 0.07)")
    got = card(client.page)
    assert float(got["speed"].split()[0]) == pytest.approx(20 / 3, rel=0.01)
    drawn_velocity = client.page.evaluate(DRAWN)["velocity"]
    assert np.linalg.norm(drawn_velocity) < 0.02
    if projection:
        assert float(got["eastward"].split()[0]) == pytest.approx(0, abs=0.02)


def test_a_path_has_no_velocity_where_streaks_fade(client: ClientPage) -> None:
    y, x = np.mgrid[-1:1:21j, -2:2:41j]
    along = np.where(x < 0.5, 1e-4, 3.0)
    flow = np.stack([along, 0 * x, 4 + 0 * x], axis=-1)
    field = FlowField.from_arrays(np.stack([x, y, 0 * x], axis=-1), flow, scalars={"warmth": x})
    mount(client, field)
    client.page.wait_for_function("() => viewers[0].canPick")
    point = client.page.evaluate("() => viewers[0].card.choose(-0.3, 0.1)")
    assert point["position"][0] < 0.4
    assert float(card(client.page)["speed in the surface"]) == pytest.approx(0, abs=0.02)
    assert np.linalg.norm(client.page.evaluate(DRAWN)["velocity"]) < 0.02


def test_another_surface_closes_the_card(client: ClientPage) -> None:
    mount(client, leaving(share=0.0))
    client.page.mouse.click(300, 150)
    client.page.locator(".card").wait_for()
    field = leaving(share=0.0)
    higher = FlowField.from_arrays(field.points + np.array([0.0, 0.0, 0.01]), field.velocity[0])
    moved = web_views(higher, Options.split(samples=9))[0]
    data = moved.page_data()
    scene = packed(data, data.header(moved.scene.settings))
    client.page.evaluate(
        """({ header, parts }) => {
          viewers[0].setHeader(header);
          for (const part of unpack(parts)) viewers[0].setPart(part);
        }""",
        scene,
    )
    assert client.page.locator(".card:visible").count() == 0
    assert client.page.locator("svg.path > *").count() == 0


@pytest.mark.parametrize("zoom", [1.0, 300.0])
def test_the_index_on_a_formula_is_one_of_its_grid(client: ClientPage, zoom: float) -> None:
    field = formula("y", "-sin(x)", x=(-3, 3), y=(-2, 2), resolution=65)
    mount(client, field)
    client.page.evaluate(f"viewers[0].camera.zoomBy({zoom}, 0, 0); viewers[0].reportCamera()")
    client.complete()
    client.page.wait_for_function("() => viewers[0].canPick")
    point = client.page.evaluate("() => viewers[0].card.choose(0.25, -0.3)")
    i, j = point["index"]
    np.testing.assert_allclose(field.surface.at(np.array([i, j])), point["position"], atol=1e-4)
