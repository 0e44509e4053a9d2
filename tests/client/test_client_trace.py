"""The client traces what NumPy traces, from the velocity that an exported page has."""

from __future__ import annotations

import base64
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from drawn_views import drawn_by_webgl
from flows import gyre, lines, swinging, torus, uncertain
from matrix import ROOT, SHARE, SIZE, View, difference, straight
from pages import COMPLETE, opened_page
from webgl_page import ClientPage, packed, state

from flowtex import FlowField, examples
from flowtex._util.array_types import Floats
from flowtex.host.export import contents_of, export, page_pieces
from flowtex.host.view import web_views
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu.render import render
from flowtex.rendering.uniforms import ViewState
from flowtex.rendering.webgl.client_data import ClientData, Colours
from flowtex.scene.options import Options
from flowtex.settings import Settings
from flowtex.textures.texture_set import UNCERTAIN_LAYER, TextureSet
from flowtex.textures.tiles.pyramid import TileKey
from flowtex.trace.store import SliceStore

if TYPE_CHECKING:
    from playwright.sync_api import Browser

#: Keeps the layers that slice textures have when their mip levels are made, or that are sent there.
KEPT = """
window.kept = [];
const GL = WebGL2RenderingContext.prototype;
const { generateMipmap, texStorage3D, texSubImage3D } = GL;
const sizes = new WeakMap();
const bound = (gl) => gl.getParameter(gl.TEXTURE_BINDING_2D_ARRAY);
const keep = (layer, width, height, data) => {
  const bytes = new Uint8Array(data.buffer);
  let letters = "";
  for (let n = 0; n < bytes.length; n += 8192)
    letters += String.fromCharCode(...bytes.subarray(n, n + 8192));
  window.kept.push([layer, width, height, data.BYTES_PER_ELEMENT, btoa(letters)]);
};
GL.texStorage3D = function (...given) {
  sizes.set(bound(this), given.slice(3));
  return texStorage3D.apply(this, given);
};
GL.generateMipmap = function (target) {
  const texture = bound(this);
  const [width, height, layers] = sizes.get(texture);
  const frame = this.createFramebuffer();
  this.bindFramebuffer(this.FRAMEBUFFER, frame);
  for (let n = 0; n < layers; n += 1) {
    this.framebufferTextureLayer(this.FRAMEBUFFER, this.COLOR_ATTACHMENT0, texture, 0, n);
    const data = new Float32Array(4 * width * height);
    this.readPixels(0, 0, width, height, this.RGBA, this.FLOAT, data);
    keep(n, width, height, data);
  }
  this.deleteFramebuffer(frame);
  return generateMipmap.call(this, target);
};
GL.texSubImage3D = function (...given) {
  const [, level, , , layer, width, height, , , , data] = given;
  if (level === 0) keep(layer, width, height, data.slice());
  return texSubImage3D.apply(this, given);
};
"""
#: As on phones that draw into floats of half precision alone.
HIDDEN = """
const { getExtension } = WebGL2RenderingContext.prototype;
WebGL2RenderingContext.prototype.getExtension = function (name) {
  return name === "EXT_color_buffer_float" ? null : getExtension.call(this, name);
};
"""


def waves() -> FlowField:
    """A gyre on a surface that is bent in space, its cells of all sizes."""
    s, t = np.meshgrid(np.linspace(0, 1, 70) ** 1.5, np.linspace(0, 1, 40))
    x, y = 2 * s + 0.1 * np.sin(7 * t), t + 0.05 * np.sin(9 * s)
    z = 0.2 * np.sin(3 * x) * y
    u, v = -np.sin(np.pi * x) * np.cos(np.pi * y), np.cos(np.pi * x) * np.sin(np.pi * y)
    slope = 0.6 * np.cos(3 * x) * y * u + 0.2 * np.sin(3 * x) * v
    return FlowField.from_arrays(np.stack([x, y, z], -1), np.stack([u, v, slope], -1))


def globe(*axis: float, uneven: float = 0.0, columns: int = 61) -> FlowField:
    """A globe that turns around an axis."""
    rows = columns // 2 + 1
    angle, latitude = np.meshgrid(np.linspace(0, 2 * np.pi, columns), np.linspace(90, -90, rows))
    a, b = angle + uneven * np.sin(angle), np.radians(latitude)
    points = np.stack([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)], -1)
    return FlowField.from_arrays(points, np.cross(axis, points))


@cache
def winds() -> FlowField:
    """Jets and waves all over the Earth."""
    return web_views(examples.weather(), Options.split(level=250, globe=True))[0].field


def bowl() -> FlowField:
    """A stream over the middle of an elliptic bowl, with a hole beside it."""
    angle, radius = np.meshgrid(np.linspace(0, 2 * np.pi, 73), np.linspace(0, 1, 31))
    x, y = 2 * radius * np.cos(angle), radius * np.sin(angle)
    points = np.stack([x, y, 0.2 * (x**2 + y**2)], axis=-1)
    velocity = np.stack([np.ones_like(x), 0.3 * x, 0.4 * (x + 0.3 * x * y)], axis=-1)
    valid = np.hypot(x - 0.7, y - 0.1) > 0.15
    return FlowField.from_arrays(points, velocity, valid=valid)


FIELDS: dict[str, tuple[Callable[[], FlowField], str]] = {
    "across": (lambda: globe(1, 0, 0), "arclength"),
    "uneven": (lambda: globe(1, 0.5, 0, uneven=0.3), "time"),
    "winds": (winds, "arclength"),
    "bowl": (bowl, "time"),
    "bent": (waves, "time"),
    "torus": (torus, "time"),
    "ring": (examples.airfoil_field, "arclength"),
    "uncertain": (lambda: uncertain(waves()), "arclength"),
}


def uneven() -> FlowField:
    """A vortex that wanders over a ring, at uneven times."""
    a, r = np.meshgrid(np.linspace(0, 2 * np.pi, 60), np.linspace(1, 2, 30))
    x, y = r * np.cos(a), r * np.sin(a)
    times = np.array([0.0, 0.1, 0.5, 0.7])
    steps = [np.stack([-y + np.sin(5 * t), x - t], axis=-1) for t in times]
    return FlowField.from_arrays(np.stack([x, y], axis=-1), np.stack(steps), times=times)


def tilting() -> FlowField:
    """A globe that turns around an axis that tilts, so that the stream over its poles does."""
    points = globe(0, 0, 1).points
    times = np.linspace(0, 0.6, 7)
    axes = np.stack([np.cos(4 * times), np.sin(4 * times), 0.2 + 0 * times], axis=-1)
    return FlowField.from_arrays(points, np.cross(axes[:, None, None], points), times=times)


VARYING: dict[str, Callable[[], FlowField]] = {
    "uneven": uneven,
    "tilting": tilting,
    "uncertain": lambda: uncertain(uneven()),
}


def texels(browser: Browser, path: Path, *scripts: str) -> Floats:
    """Return the layers that the client has made of the time that it shows, (layers, H, W, 4)."""
    with opened_page(browser, width=160, height=120) as page:
        for script in (KEPT, *scripts):
            page.add_init_script(script)
        page.goto(path.as_uri())
        page.wait_for_selector(COMPLETE)
        kept = page.evaluate("window.kept")
    found: dict[int, Floats] = {}
    for layer, width, height, size, letters in kept:
        numbers = np.frombuffer(base64.b64decode(letters), f"<f{size}").reshape(height, width, 4)
        found[layer] = numbers.astype(float)  # that of the last step
    return np.stack([found[n] for n in range(len(found))])


def wanted_texels(field: FlowField, step: int = 0, **options: Any) -> tuple[TextureSet, Floats]:
    """Return what NumPy makes of the same."""
    textures = web_views(field, Options.split(samples=9, **options))[0].scene.textures
    layers = textures.layers(step).astype("<f2").astype(float)
    if textures.geometry.planar:
        layers[..., 2] = 0
    return textures, layers


def agree(textures: TextureSet, found: Floats, wanted: Floats, few: float = 0.03) -> None:
    """Judge slices by those of NumPy; ``few`` paths may part from theirs."""
    assert found.shape == wanted.shape
    # Each node once: those at borders fill all that is beyond.
    rows, columns = (
        slice(p.before, p.before + p.nodes) for p in (textures.grid.rows, textures.grid.columns)
    )
    found, wanted = found[:, rows, columns], wanted[:, rows, columns]
    # What is not traced has the error of half precision, but where a ring closes in a corner.
    for layer in (0, len(wanted) - 1) if textures.in_cells else (0,):
        off = np.abs(found[layer] - wanted[layer]) > 3e-3 * (1 + np.abs(wanted[layer]))
        assert off.mean() < 1e-3
    lags = textures.lags
    if textures.geometry.field.uncertainty:
        for layer in (UNCERTAIN_LAYER, len(lags) + UNCERTAIN_LAYER):
            assert np.abs(found[layer, ..., 3] - wanted[layer, ..., 3]).max() < 3e-3
    for side in range(2):
        first = 1 + side * len(lags)
        # NumPy ends paths that are as long as any picture asks for.
        most, short = 32 * lags[0], 4 * lags[0]
        reach, expected = (np.minimum(some[first, ..., 3], most) for some in (found, wanted))
        assert np.mean(np.abs(reach - expected) < 0.1 * (short + expected)) > 0.9
        for m, lag in enumerate(lags[:5]):
            goes_on = np.minimum(reach, expected) > 1.5 * lag
            off = np.linalg.norm((found - wanted)[first + m, ..., :3], axis=-1)[goes_on]
            # The client looks paths up between nodes without second differences.
            assert np.median(off) < 5e-3 and np.mean(off < 0.05) > 1 - few, (side, lag)


@pytest.mark.usefixtures("quick_export")
@pytest.mark.parametrize("name", FIELDS)
def test_slices_are_those_of_numpy(browser: Browser, tmp_path: Path, name: str) -> None:
    make, parameter = FIELDS[name]
    field = make()
    export(field, tmp_path / "page.html", samples=9, parameter=parameter)
    found = texels(browser, tmp_path / "page.html")
    textures, wanted = wanted_texels(field, parameter=parameter)
    agree(textures, found, wanted)


@pytest.mark.usefixtures("quick_export")
@pytest.mark.parametrize("name", VARYING)
def test_pathlines_are_those_of_numpy(browser: Browser, tmp_path: Path, name: str) -> None:
    field = VARYING[name]()
    export(field, tmp_path / "page.html", samples=9, lines="pathlines")
    found = texels(browser, tmp_path / "page.html")
    # The series begins between its first two steps.
    textures, wanted = wanted_texels(field, 1, lines="pathlines")
    agree(textures, found, wanted)


@pytest.mark.parametrize("lines", ["pathlines", "streamlines"])
def test_another_moment_is_traced_from_what_is_there(client: ClientPage, lines: str) -> None:
    settings, camera = Settings(samples=11), straight(1, (0, 0))
    textures = TextureSet.build(SliceStore(swinging(), lines=lines))
    plain = Colours(plain=(0.6, 0.6, 0.6), background=(1.0, 0.0, 0.0))
    data = ClientData(textures, plain, traces=True)
    header = data.header(settings, camera=state(camera), time=0.8)
    hidden = {"gives": True, "controls": False, "smooth": False}
    client.mount(packed(data, header, (0, 1, 2)), SIZE, **hidden)
    client.sharp()
    for time, steps, between in ((0.55, (1, 2), 0.375), (0.1, (0, 1), 0.25)):
        client.page.evaluate("(time) => viewers[0].setTime(time)", time)
        judge = render(
            textures,
            settings,
            camera,
            SIZE,
            view=ViewState(between=between, time=time, still=True),
            steps=steps,
        )
        root, share, _ = difference(
            client.picture(), judge.rgb((0.6, 0.6, 0.6), background=(1, 0, 0))
        )
        # Slices that are traced in single precision differ a little from those that are sent.
        assert root < 2 * ROOT
        assert share < 2 * SHARE
    assert client.page.evaluate("events") == []


def test_tiles_around_a_pole_are_those_of_numpy(
    browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of the ring around it there are all lines where it is near, and a few elsewhere."""
    monkeypatch.setattr("flowtex.textures.tiles.grid_levels.ROOT_NODES", 2000)
    field = globe(1.0, 0.4, 0.3, columns=601)
    view = web_views(field, Options.split(samples=9))[0]
    assert view.scene.pyramid is not None
    textures = view.scene.pyramid.textures(TileKey(0, 0, 1))
    assert textures is not None and textures.grid.field.shape[1] < 601
    data = ClientData(textures, depth=view.scene.pyramid.depth, traces=True)
    path = tmp_path / "page.html"
    assert data.traced and len(data.surface()["rays"]) == 1
    monkeypatch.setattr(view, "page_data", lambda: data)
    path.write_text("".join(page_pieces(contents_of([view], picture=b""))), encoding="utf-8")
    agree(textures, texels(browser, path), textures.layers(0).astype("<f2").astype(float))


def test_image_over_a_pole_is_that_of_numpy(client: ClientPage) -> None:
    field, settings = FIELDS["winds"][0](), Settings(samples=11)
    top = field.points[..., 2].max()
    above = (0.1 * top, 0.05 * top, 3 * top), (0.02 * top, 0.01 * top, top), (0, 1, 0)
    textures = TextureSet.build(SliceStore(field))
    plain = Colours(plain=(0.6, 0.6, 0.6), background=(1.0, 0.0, 0.0))
    data = ClientData(textures, plain, traces=True)
    assert data.traced
    given = packed(data, data.header(settings), (0,))
    for height in (1.2, 0.05):
        camera = Camera(*above, parallel=True, parallel_scale=height * top)
        given["header"]["camera"] = state(camera)
        theirs = client.picture(client.mount(given, SIZE, controls=False, smooth=False))
        judge = render(textures, settings, camera, SIZE)
        root, share, edge = difference(theirs, judge.rgb((0.6, 0.6, 0.6), background=(1, 0, 0)))
        assert judge.covered.mean() > 0.3 and edge < 200
        assert root < 2 * ROOT
        assert share < 2 * SHARE
        client.clear()


@pytest.mark.usefixtures("quick_export")
def test_with_targets_of_half_precision_slices_are_the_same(
    browser: Browser, tmp_path: Path
) -> None:
    export(waves(), tmp_path / "page.html", samples=9)
    found = texels(browser, tmp_path / "page.html")
    other = texels(browser, tmp_path / "page.html", HIDDEN)
    # Graphics cards round to half precision by their own rules.
    np.testing.assert_allclose(other, found, rtol=2e-3, atol=2e-6)


def test_a_picture_in_half_precision_is_the_same(browser: Browser, client: ClientPage) -> None:
    view = View()
    shown = view.made()
    found = drawn_by_webgl(client, view, shown).astype(float)
    with opened_page(browser, 901, 700) as opened:
        opened.evaluate(f"() => {{ {HIDDEN} }}")
        other = drawn_by_webgl(ClientPage(opened), view, shown)
    assert found.std() > 10
    assert np.abs(other - found).max() <= 2


def test_what_a_client_cannot_trace_comes_as_slices() -> None:
    x = np.concatenate([np.linspace(0, 1e-6, 30), [1.0, 2.0]])
    points = np.stack(np.meshgrid(x, x), axis=-1)
    uneven_cells = FlowField.from_arrays(points, np.ones_like(points))
    paths = Options.split(lines="pathlines")
    for view in (
        *(web_views(field, Options.split())[0] for field in (lines(), uneven_cells)),
        web_views(swinging(), paths, steps=2)[0],  # paths lead through steps that are left out
    ):
        data = replace(view.page_data(), traces=True)
        assert not data.traced and "slices/0" in data.step(0) and "position" in data.surface()
    whole = web_views(swinging(), paths)[0].page_data()
    assert whole.traced and whole.moment(0.0) == (0, 1, 2)


@pytest.mark.filterwarnings("ignore:The velocity is zero")
@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e12])
@pytest.mark.parametrize("speed", [0.0, 1e-12, 1e12])
def test_velocities_of_any_size_are_handed_over(scale: float, speed: float) -> None:
    flow = gyre()
    field = FlowField.from_arrays(flow.points * scale, speed * flow.velocity[0])
    data = replace(web_views(field, Options.split())[0].page_data(), traces=True)
    assert data.traced
    for part in (*data.surface().values(), *data.step(0).values()):
        assert np.isfinite(part).all()
    rates = data.step(0)["flow/0"][..., :2].astype(float)
    expected = replace(web_views(flow, Options.split())[0].page_data(), traces=True).step(0)[
        "flow/0"
    ]
    np.testing.assert_allclose(rates, expected[..., :2] * (speed > 0), atol=2e-3)


def test_a_page_with_velocity_is_small(tmp_path: Path) -> None:
    columns, rows = 500, 250
    s, t = np.meshgrid(np.linspace(0, 1, columns), np.linspace(0, 1, rows))
    wave = 0.02 * np.sin(np.pi * s) * np.sin(np.pi * t)
    x, y = s + wave * np.sin(25 * t), t + wave * np.sin(25 * s)
    velocity = np.stack([-np.sin(3 * x) * np.cos(3 * y), np.cos(3 * x) * np.sin(3 * y)], axis=-1)
    field = FlowField.from_arrays(np.stack([x, y], axis=-1), velocity)
    made: Any = export(field, tmp_path / "page.html")
    assert made.nbytes < 1_600_000


def test_a_far_time_between_two_steps_is_shown(client: ClientPage) -> None:
    """While its slices are made, the picture is that of the time before, whose slices stay."""
    y, x = np.mgrid[-1:1:25j, -1.5:1.5:37j]
    times = np.linspace(0.0, 1.1, 12)
    steps = [np.stack([-y, x - 1.5 * t + 0.4], axis=-1) for t in times]
    field = FlowField.from_arrays(np.stack([x, y], axis=-1), np.stack(steps), times=times)
    view = web_views(field, Options.split(lines="pathlines", samples=15))[0]
    data = view.page_data()
    for first in (0.05, 0.85):
        header = data.header(view.scene.settings, time=first)
        viewer = client.mount(packed(data, header, tuple(range(12))), SIZE, smooth=False)
        client.sharp(viewer)
    client.page.evaluate("viewers[0].setTime(0.85)")
    client.page.wait_for_function(
        "() => viewers[0].sharp && viewers[0].root.dataset.lacking === '0'"
    )
    assert np.array_equal(client.pixels(0), client.pixels(1))
