"""The browser client: its hands, its numbers, what it leaves behind; matrix.py has the pictures."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from flows import gyre, swinging, torus
from matrix import ASIDE, SIZE, TILTED, WHOLE, straight
from numpy.typing import NDArray
from pages import opened_page
from webgl_page import ClientPage, packed, state

from flowtex import FlowField
from flowtex._util.colours import ColourScale
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu.render import render
from flowtex.rendering.webgl.client_data import ClientData, Colours
from flowtex.settings import Settings
from flowtex.textures.texture_set import TextureSet
from flowtex.trace.store import SliceStore

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser

Pixels = NDArray[np.uint8]

#: The processor draws: few samples, and no more smoothing than the NumPy renderer has.
QUICK: dict[str, Any] = {"samples": 11}
PLAIN: dict[str, Any] = {"controls": False, "smooth": False}


# --- scenes -----------------------------------------------------------------------------------


@cache
def coarse_gyre() -> FlowField:
    """The same place, with fewer nodes."""
    points = gyre().points[:, np.rint(np.linspace(0, 60, 41)).astype(int)]
    a, b = np.pi * points[..., 0], np.pi * points[..., 1]
    velocity = np.stack([-np.sin(a) * np.cos(b), np.cos(a) * np.sin(b)], axis=-1)
    return FlowField.from_arrays(points[..., :2], velocity)


@cache
def store(field: Callable[[], FlowField]) -> SliceStore:
    return SliceStore(field())


def made(field: Callable[[], FlowField], settings: Settings) -> TextureSet:
    return TextureSet.build(store(field))


def scene(
    field: Callable[[], FlowField] = gyre,
    camera: Camera | None = WHOLE,
    *,
    colours: Colours | None = None,
    steps: tuple[int, ...] = (0,),
    time: float | None = None,
    **options: Any,
) -> Any:
    """A scene as JSON."""
    settings = Settings(**{**QUICK, **options})
    plain = colours or Colours(plain=(0.6, 0.6, 0.6), background=(1.0, 0.0, 0.0))
    whole = ClientData(made(field, settings), plain)
    look = {} if camera is None else state(camera)
    header = whole.header(settings, camera=look, time=time)
    return packed(whole, header | {"camera": look or None}, steps)


# --- pictures ---------------------------------------------------------------------------------


def test_smooth_outlines_leave_the_inside_alone(client: ClientPage) -> None:
    views = [scene(gyre, TILTED), scene(gyre, TILTED)]
    rough, smooth = (
        client.picture(client.mount(v, SIZE, **PLAIN | {"smooth": s}))
        for v, s in zip(views, (False, True), strict=True)
    )
    off = np.abs(rough.astype(float) - smooth).max(axis=-1)
    ground = (rough == [255, 0, 0]).all(axis=-1)
    near = ground != np.roll(ground, 1, 0)
    for shift, axis in ((-1, 0), (1, 1), (-1, 1)):
        near |= ground != np.roll(ground, shift, axis)
    assert (off[near] > 40).mean() > 0.1
    assert off[~near & ground].max() == 0
    assert (off[~near & ~ground] > 16).mean() < 0.01


def table() -> Pixels:
    ramp = np.arange(256, dtype=np.uint8)
    return np.stack([ramp, ramp[::-1], np.full_like(ramp, 40), np.full_like(ramp, 255)], axis=-1)


def test_scalars_are_interpolated_before_they_are_mapped(client: ClientPage) -> None:
    x = gyre().points[..., 0].copy()
    x[3, 40] = np.nan
    painted = Colours("x", "m", x[None], ColourScale(table(), 0.5, 1.5), background=(1.0, 0.0, 0.0))
    theirs = client.picture(client.mount(scene(colours=painted, strength=0.0), SIZE, **PLAIN))
    settings = Settings(strength=0.0)
    picture = render(made(gyre, settings), settings, WHOLE, SIZE)
    hole = np.abs(picture.position[..., :2] - gyre().points[3, 40, :2]).max(axis=-1) < 0.12
    seen = picture.covered & ~hole
    share = np.clip(picture.position[seen][:, 0] - 0.5, 0, 1)
    expected = table()[np.minimum((share * 256).astype(int), 255), :3]
    off = np.abs(theirs[seen].astype(int) - expected).max(axis=-1)
    # A place may be half a pixel off where triangles are large, and its colour by an entry.
    assert (off > 0).mean() < 0.08
    assert off.max() <= 1 or (off > 1).sum() <= 3
    assert (theirs[picture.covered & hole] == 169).all(axis=-1).any()


def test_a_lit_surface_is_darker_aside(client: ClientPage) -> None:
    painted = Colours(plain=(0.6, 0.6, 0.6), background=(1.0, 0.0, 0.0), lighting=True)
    theirs = client.picture(
        client.mount(scene(torus, ASIDE, colours=painted, strength=0.0), SIZE, **PLAIN)
    )
    settings = Settings(strength=0.0)
    picture = render(made(torus, settings), settings, ASIDE, SIZE)
    seen = picture.covered & (theirs != [255, 0, 0]).any(axis=-1)
    p = picture.position[seen]
    flat = np.hypot(p[:, 0], p[:, 1])
    normal = np.stack([*((1 - 1 / flat) * p[:, :2].T), p[:, 2]], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    light = np.minimum(0.15 + np.abs(normal @ -ASIDE.axes[2]), 1.0)
    off = theirs[seen][:, 0] - 0.6 * 255 * light
    assert np.std(light) > 0.1
    # The facets of the torus hold its normals only nearly.
    assert np.abs(off).mean() < 2.5


# --- the hand ---------------------------------------------------------------------------------


def box(client: ClientPage, viewer: int = 0) -> tuple[float, float]:
    found = client.page.evaluate(
        "(n) => { const b = viewers[n].canvas.getBoundingClientRect(); return [b.left, b.top]; }",
        viewer,
    )
    return found[0], found[1]


def number(client: ClientPage, expression: str) -> Any:
    return client.page.evaluate(f"() => {expression}")


def test_a_drag_carries_the_picture_along(client: ClientPage) -> None:
    client.mount(scene(gyre, straight(8)), SIZE, hear=["onCamera"], **PLAIN)
    before = client.picture().astype(float)
    left, top = box(client)
    mouse = client.page.mouse
    mouse.move(left + 60, top + 60)
    mouse.down()
    mouse.move(left + 80, top + 70, steps=3)
    mouse.move(left + 92, top + 47, steps=3)
    mouse.up()
    after = client.picture().astype(float)
    off = after[:-13, 32:] - before[13:, :-32]
    assert np.sqrt(np.mean(off**2)) < 2.5
    assert np.std(before) > 20
    assert number(client, "events.filter(([name]) => name === 'onCamera').length") >= 2


def test_the_wheel_zooms_to_the_pointer(client: ClientPage) -> None:
    client.mount(scene(torus, ASIDE), SIZE, **PLAIN)
    client.sharp()
    left, top = box(client)
    # Left of the middle, where the torus is too.
    x, y = 40, 66
    place = f"viewers[0].point({2 * x / SIZE[0] - 1}, {1 - 2 * y / SIZE[1]})"
    client.page.wait_for_function("() => viewers[0].canPick")
    before = number(client, place)
    client.page.mouse.move(left + x, top + y)
    client.page.mouse.wheel(0, -300)
    client.page.wait_for_function("() => viewers[0].camera.zoom > 1.9")
    client.sharp()
    height = 2 * number(client, "viewers[0].camera.height")
    after = number(client, place)
    np.testing.assert_allclose(after["position"], before["position"], atol=1e-4 * height)


def test_a_click_tells_the_point(client: ClientPage) -> None:
    values = gyre().points[..., 0] + 2 * gyre().points[..., 1]
    painted = Colours("sum", "", values[None], ColourScale(table(), 0.0, 4.0))
    client.mount(scene(colours=painted), SIZE, hear=["onPoint"], **PLAIN)
    client.sharp()
    client.page.wait_for_function("() => viewers[0].canPick")
    left, top = box(client)
    client.page.mouse.click(left + 100, top + 50)
    ((name, point),) = number(client, "events")
    assert name == "onPoint"
    x, y = 1.0 + 10 * 0.015, 0.5 + 10 * 0.015
    np.testing.assert_allclose(point["position"], [x, y, 0], atol=1e-6)
    # Within half a pixel, as what is drawn.
    np.testing.assert_allclose(point["values"]["sum"], x + 2 * y, atol=0.015)
    i, j = point["index"]
    near = gyre().points[round(j), round(i)]
    assert np.abs(near[:2] - [x, y]).max() < 0.04
    client.page.mouse.click(left + 2, top + 2)  # outside the surface
    assert len(number(client, "events")) == 1


def test_the_bar_and_the_settings(client: ClientPage) -> None:
    values = Colours("speed", "m/s", gyre().speed, ColourScale(table()))
    client.mount(scene(colours=values), (460, 300), hear=["onSetting"], smooth=False)
    client.sharp()
    page = client.page
    page.locator("[data-name=settings]").click()
    rows = page.locator("[data-setting]").evaluate_all("(all) => all.map((r) => r.dataset.setting)")
    assert {"samples", "kernel", "contrast", "motion", "seed", "resolution"} <= set(rows)
    # What would need the host, has no effect here, or lies in the bar.
    absent = {"noise", "parameter", "tiles", "lod", "critical_points"}
    assert not absent & set(rows)
    assert page.locator(".kinds span").count() == 0
    page.locator("[data-setting=contrast] input").fill("2")
    page.locator("[data-setting=kernel] select").select_option("box")
    page.locator("[data-name=levels]").click()
    assert page.locator(".legend").is_hidden()  # the colours say something else now
    page.locator("[data-name=lod]").click()
    told = [value for name, value in number(client, "events") if name == "onSetting"]
    assert told == ["contrast", "kernel", "show_level", "lod"]
    chosen = number(client, "viewers[0].settings")
    assert [chosen[name] for name in told] == [2, "box", True, False]
    page.locator("[data-name=levels]").click()
    page.locator("[data-name=settings]").click()
    client.sharp()
    page.locator(".picture").hover()
    page.wait_for_function("() => viewers[0].root.shadowRoot.querySelector('.readout').textContent")
    read = page.locator(".readout").inner_text()
    assert read.startswith("(1, 0.5)")
    assert "speed" in read
    assert "m/s" in read
    assert page.locator(".legend").inner_text().split() == ["speed", "(m/s)", "0", "0.5", "1.0"]
    # Nothing comes from outside.
    assert [url for url in client.asked if not url.startswith("blob:")] == []


TICKS = """(kind) => {
    const { stage, camera, root } = viewers[0];
    const along = kind === "below" ? 0 : 1;
    const size = along ? stage.clientHeight : stage.clientWidth;
    return [...root.shadowRoot.querySelectorAll(`.axes .${kind}:not(.name)`)].map((text) => {
        const value = Number(text.textContent.replace("−", "-"));
        const place = camera.project(along ? [1, value, 0] : [value, 0.5, 0])[along];
        const at = Number(text.getAttribute(along ? "y" : "x"));
        return [at, (along ? 1 - place : 1 + place) / 2 * size];
    });
}"""


def test_axes_tell_coordinates_or_a_length_beside_the_picture(client: ClientPage) -> None:
    client.mount(scene(), (600, 400), smooth=False)
    client.sharp()
    page = client.page
    outside = (".head", ".legend", ".bar")
    picture = page.locator(".picture").bounding_box()
    assert picture is not None
    for name in outside:
        place = page.locator(name).bounding_box()
        assert place is None or (
            place["y"] + place["height"] <= picture["y"]
            or place["y"] >= picture["y"] + picture["height"]
        )
    for zoom in (1, 30):
        number(client, f"(viewers[0].camera.zoomBy({zoom}), viewers[0].change())")
        for kind in ("below", "aside"):
            ticks = np.asarray(page.evaluate(TICKS, kind))
            assert len(ticks) >= 2
            np.testing.assert_allclose(ticks[:, 0], ticks[:, 1], atol=0.6)
    number(client, "(viewers[0].camera.rotate(0.4, 0.2), viewers[0].change())")
    assert page.evaluate(TICKS, "below") == page.evaluate(TICKS, "aside") == []
    page.locator("[data-name=settings]").click()
    page.get_by_label("Axes").select_option("scale")
    words = page.locator(".axes .beside").text_content()
    assert words
    length = float(words.split()[0])
    lines = "(all) => Math.max(...all.map((line) => Number(line.getAttribute('x2'))))"
    pixels = page.locator(".axes line").evaluate_all(lines)
    height = number(client, "viewers[0].stage.clientHeight / viewers[0].camera.height / 2")
    np.testing.assert_allclose(pixels, length * height, atol=0.1)
    page.get_by_label("Axes").select_option("none")
    assert page.locator(".axes > *").count() == 0


@pytest.mark.parametrize("size", [(300, 160), (200, 170), (700, 200), (300, 279)])
def test_flow_has_most_of_the_height_of_a_small_view(
    client: ClientPage, size: tuple[int, int]
) -> None:
    values = Colours("speed", "m/s", gyre().speed, ColourScale(table()))
    client.mount(scene(colours=values), size, smooth=False)
    client.sharp()
    picture = client.page.locator(".picture").bounding_box()
    assert picture is not None and picture["height"] > 0.6 * size[1]
    for name in (".legend", ".bar"):
        place = client.page.locator(name).bounding_box()
        assert place is not None
        is_above = place["y"] + place["height"] <= picture["y"]
        assert is_above or place["y"] >= picture["y"] + picture["height"]
    ends = "(all) => all.map((each) => each.getBoundingClientRect()).map((r) => [r.left, r.right])"
    ticks = client.page.locator(".legend .ticks span").evaluate_all(ends)
    gaps = [right[0] - left[1] for left, right in pairwise(ticks)]
    assert gaps and min(gaps) > 0


def test_finer_pixels_show_the_same_grains(browser: Browser, client: ClientPage) -> None:
    client.mount(scene(gyre, straight(4)), SIZE, **PLAIN)
    coarse = client.picture().astype(float)
    with opened_page(browser, device_scale_factor=2) as page:
        other = ClientPage(page)
        other.mount(scene(gyre, straight(4)), SIZE, **PLAIN)
        fine = other.picture().astype(float)
    assert fine.shape == (2 * SIZE[1], 2 * SIZE[0], 3)
    means = fine.reshape(SIZE[1], 2, SIZE[0], 2, 3).mean(axis=(1, 3))
    assert np.corrcoef(means.ravel(), coarse.ravel())[0, 1] > 0.97


# --- time -------------------------------------------------------------------------------------


#: Whether the time that is played was the same in two frames.
STANDS_STILL = """() => {
  const { time } = viewers[0].player;
  const stands = window.timeBefore === time && time > 0.39;
  window.timeBefore = time;
  return stands;
}"""


def test_playing_goes_through_the_times_and_asks_for_what_is_missing(client: ClientPage) -> None:
    packed_scene = scene(swinging, straight(1, (0, 0)), steps=(0, 1, 2), time=0.0)
    late = {k: packed_scene["parts"].pop(k) for k in list(packed_scene["parts"]) if k[-2:] == "/2"}
    client.mount(packed_scene, SIZE, hear=["onTime"], gives=True, smooth=False)
    client.sharp()
    assert number(client, "events") == []
    number(client, "viewers[0].setTime(0.39)")
    number(client, "viewers[0].play()")
    client.page.wait_for_function("() => events.some(([name]) => name === 'load')")
    client.page.wait_for_function(STANDS_STILL)
    needed = {tuple(e) for e in number(client, "events.filter(([name]) => name === 'load')")}
    assert needed == {("load", 2)}
    assert number(client, "viewers[0].player.time") < 0.4 + 1e-9
    client.page.evaluate(
        "(parts) => unpack(parts).forEach((part) => viewers[0].setPart(part))", late
    )
    client.page.wait_for_function("() => viewers[0].player.time > 0.42")
    number(client, "viewers[0].setTime(0.79)")
    client.page.wait_for_function("() => viewers[0].player.time < 0.2")  # it begins again
    number(client, "viewers[0].pause()")
    client.sharp()


# --- what goes wrong, and what is left -----------------------------------------------------------


def test_a_lost_context_comes_back_with_the_same_picture(client: ClientPage) -> None:
    client.mount(scene(), SIZE, **PLAIN)
    before = client.picture()
    number(client, "window.ext = viewers[0].graphics.gl.getExtension('WEBGL_lose_context')")
    number(client, "ext.loseContext()")
    client.page.wait_for_function("() => viewers[0].graphics.isLost && !viewers[0].sharp")
    number(client, "ext.restoreContext()")
    client.page.wait_for_function("() => !viewers[0].graphics.isLost")
    np.testing.assert_array_equal(client.picture(), before)


def test_context_lost_while_paths_are_traced_comes_back(client: ClientPage) -> None:
    settings = Settings(samples=5)
    data = ClientData(TextureSet.build(SliceStore(gyre())), traces=True)
    assert data.traced
    given = packed(data, data.header(settings))
    client.mount(given, SIZE, **PLAIN)
    before = client.picture()
    lose = """() => {
      const { gl } = viewers[0].graphics;
      const draw = gl.drawArrays;
      let passes = 0;
      window.ext = gl.getExtension("WEBGL_lose_context");
      gl.drawArrays = (...given) => {
        draw.apply(gl, given);
        if (viewers[0].graphics.tracings.size && ++passes === 3) ext.loseContext();
      };
    }"""
    client.page.evaluate(lose)
    second = client.mount(given, SIZE, **PLAIN)
    client.page.wait_for_function("() => viewers[0].graphics.isLost")
    assert not number(client, f"viewers[{second}].sharp")
    number(client, "ext.restoreContext()")
    client.page.wait_for_function("() => !viewers[0].graphics.isLost")
    np.testing.assert_array_equal(client.picture(second), before)
    number(client, "delete viewers[0].graphics.gl.drawArrays")


def test_nothing_is_drawn_out_of_sight_or_at_rest(client: ClientPage) -> None:
    client.mount(scene(), SIZE, **PLAIN)
    client.sharp()
    client.page.wait_for_function("() => viewers[0].graphics.waiting.size === 0")
    frames = number(client, "viewers[0].stats().frames")
    client.page.evaluate("() => { document.querySelector('.view').style.marginTop = '5000px' }")
    client.page.wait_for_function("() => !viewers[0].isVisible")
    number(client, "viewers[0].setSettings({ grain: 3 })")
    # Another view, whose turn comes later, is drawn meanwhile.
    client.sharp(client.mount(scene(), (90, 60), **PLAIN))
    assert number(client, "viewers[0].stats().frames") == frames
    client.page.evaluate("() => { document.querySelector('.view').style.marginTop = '0' }")
    client.sharp()
    assert number(client, "viewers[0].stats().frames") == frames + 1


@pytest.mark.parametrize("fault", ["does not compile", "format 99"])
def test_what_cannot_be_drawn_is_told(client: ClientPage, fault: str) -> None:
    header = (given := scene())["header"]
    if fault == "format 99":
        header["format"] = 99
    else:
        header["shaders"]["fragment"] += "\nnonsense"
    client.mount(given, SIZE, **PLAIN)
    client.page.wait_for_function("() => viewers[0].root.dataset.failed")
    said = number(client, "viewers[0].root.shadowRoot.querySelector('.note').textContent")
    assert fault in said and ("nonsense" in said) == (fault != "format 99")


TAKE = """(given) => { viewers[0].setHeader(given.header);
  for (const part of unpack(given.parts)) viewers[0].setPart(part); }"""


def test_a_whole_scene_takes_the_place_of_a_coarse_one(client: ClientPage) -> None:
    first = scene(gyre, straight(8))
    client.mount(first, SIZE, **PLAIN)
    client.sharp()
    number(client, "viewers[0].camera.zoomBy(2, 0.5, 0.5)")
    number(client, "viewers[0].reportCamera()")
    client.sharp()
    before = number(client, "viewers[0].cameraState")
    other = scene(coarse_gyre, straight(1))
    other["header"]["generation"] = 1
    client.page.evaluate(TAKE, other)
    client.sharp()
    assert number(client, "viewers[0].cameraState") == before
    assert number(client, "viewers[0].parts.get('position').shape") == [31, 41, 3]


# --- in a notebook ------------------------------------------------------------------------------

MODEL = """([scene, size]) => {
  const { settings, camera, time, clock, ...header } = scene.header;
  const values = { _header: header, _shaders: [header.shaders], ...settings, camera, time, clock,
    playing: false, point: null, size, bar: true };
  const handlers = new Map();
  const log = (window.log = []);
  const fire = (name, ...given) => (handlers.get(name) ?? []).slice().forEach((f) => f(...given));
  window.model = {
    handlers, fire,
    get: (name) => values[name],
    set: (name, value) => { values[name] = value; log.push(["set", name, value]);
      fire(`change:${name}`); },
    save_changes: () => log.push(["save"]),
    on: (name, f) => handlers.set(name, [...(handlers.get(name) ?? []), f]),
    off: (name, f) => handlers.set(name, handlers.get(name).filter((g) => g !== f)),
    send: (content, callbacks, buffers) => log.push(["send", content, buffers?.length ?? 0]),
  };
  const el = document.createElement("div");
  document.body.append(el);
  window.left = client.default.render({ model, el });
  window.host = el.querySelector(".flowtex");
  const parts = Object.values(scene.parts);
  // In a message the bytes of several parts may begin anywhere.
  const views = parts.map((part) => {
    const all = bytes(part), shifted = new Uint8Array(all.length + 3);
    shifted.set(all, 3);
    return new DataView(shifted.buffer, 3);
  });
  fire("msg:custom", { kind: "parts", parts }, views);
}"""


#: Notes for how many milliseconds things are put off.
WAITS = """() => {
  const later = window.setTimeout;
  window.waits = [];
  window.setTimeout = (call, delay) => { waits.push(delay); return later(call, delay); };
}"""


def test_a_widget_shows_its_model_and_tells_it_what_a_person_does(client: ClientPage) -> None:
    page = client.page
    page.evaluate(MODEL, [scene(gyre, straight(2)), [200, 240]])
    page.wait_for_function("() => host.dataset.sharp === 'true'")
    assert number(client, "[host.clientWidth, host.clientHeight]") == [200, 240]
    assert number(client, "log[0]") == ["send", {"kind": "ready"}, 0]
    page.wait_for_function("() => log.some((m) => m[0] === 'send' && m[1].kind === 'frame')")
    assert number(client, "log.filter((m) => m[0] === 'set').length") == 0
    # From the kernel to the picture.
    assert number(client, "(model.set('contrast', 2.5), host.dataset.sharp)") == "false"
    page.wait_for_function("() => host.dataset.sharp === 'true'")
    # From the hand to the kernel.
    number(client, "log.length = 0")
    page.evaluate(WAITS)
    page.locator("[data-name=lod]").click()
    assert number(client, "log[0]") == ["set", "lod", False]
    box_ = page.locator(".flowtex .picture").bounding_box()
    assert box_ is not None
    page.mouse.move(box_["x"] + 60, box_["y"] + 40)
    page.mouse.down()
    page.mouse.move(box_["x"] + 80, box_["y"] + 50, steps=12)
    page.mouse.up()
    # Twenty of the pixels that are twice the parallel scale.
    share = 20 / box_["height"]
    moved = f"Math.abs(model.get('camera').focal_point[0] - 0.63 + {share} * 0.9)"
    page.wait_for_function(f"() => {moved} < 1e-6")
    # The next one waits after each that is sent: there is not one for each move.
    told, waits = number(client, "[log.filter((m) => m[1] === 'camera').length, waits]")
    assert told == waits.count(100)
    for playing, word in ((True, "Pause"), (False, "Play")):
        page.evaluate("(playing) => model.set('playing', playing)", playing)
        label = page.locator("[data-name=play]").get_attribute("aria-label") or ""
        assert label.startswith(word)
    page.wait_for_function("() => host.dataset.sharp === 'true'")
    page.evaluate("() => model.fire('msg:custom', { kind: 'error', text: 'no disk' }, [])")
    assert page.locator(".flowtex .note", has_text="no disk").is_visible()
    # And nothing stays behind.
    number(client, "left()")
    assert number(client, "[...model.handlers.values()].flat().length") == 0
    assert not number(client, "host.isConnected")
