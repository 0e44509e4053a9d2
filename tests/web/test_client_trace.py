"""The client traces what NumPy traces, from the velocity that an exported page has."""

from __future__ import annotations

import base64
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from flows import gyre, holed, swinging, torus
from pages import COMPLETE, opened_page

from flowtex import FlowField, examples
from flowtex._util.array_types import Floats
from flowtex.options import Options
from flowtex.rendering.webgl.velocity import can_trace
from flowtex.web.export import export
from flowtex.web.view import web_views

if TYPE_CHECKING:
    from playwright.sync_api import Browser

#: Keeps what is sent to slice textures: width, height, layer and the numbers.
KEPT = """
window.kept = [];
const send = WebGL2RenderingContext.prototype.texSubImage3D;
WebGL2RenderingContext.prototype.texSubImage3D = function (...given) {
  const [, level, , , layer, width, height, , format, , data] = given;
  if (level === 0 && format === this.RGBA && data instanceof Uint16Array) {
    const bytes = new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
    const letters = Array.from(bytes, (byte) => String.fromCharCode(byte)).join("");
    window.kept.push([layer, width, height, btoa(letters)]);
  }
  return send.apply(this, given);
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


FIELDS: dict[str, Callable[[], FlowField]] = {
    "plane": gyre,
    "bent": waves,
    "torus": torus,
    "hole": holed,
    "ring": lambda: examples.airfoil_field(),
}


def texels(browser: Browser, path: Path) -> Floats:
    """Return the layers that the client has made, (layers, H, W, 4)."""
    with opened_page(browser, width=160, height=120) as page:
        page.add_init_script(KEPT)
        page.goto(path.as_uri())
        page.wait_for_selector(COMPLETE)
        kept = page.evaluate("window.kept")
    found: dict[int, Floats] = {}
    for layer, width, height, letters in kept:
        numbers = np.frombuffer(base64.b64decode(letters), "<f2").reshape(height, width, 4)
        found.setdefault(layer, numbers.astype(float))
    return np.stack([found[n] for n in range(len(found))])


@pytest.mark.parametrize("name", FIELDS)
def test_slices_are_those_of_numpy(browser: Browser, tmp_path: Path, name: str) -> None:
    field = FIELDS[name]()
    export(field, tmp_path / "page.html", samples=9)
    found = texels(browser, tmp_path / "page.html")
    textures = web_views(field, Options.split(samples=9))[0].scene.textures
    wanted = textures.layers(0).astype("<f2").astype(float)
    if textures.geometry.planar:
        wanted[..., 2] = 0
    assert found.shape == wanted.shape
    # What is not traced has the error of half precision, but where a ring closes in a corner.
    for layer in (0, len(wanted) - 1):
        off = np.abs(found[layer] - wanted[layer]) > 3e-3 * (1 + np.abs(wanted[layer]))
        assert off.mean() < 1e-3
    lags = textures.lags
    for side in range(2):
        first = 1 + side * len(lags)
        # NumPy ends paths that are as long as any picture asks for.
        reach, expected = (np.minimum(some[first, ..., 3], 8.0) for some in (found, wanted))
        assert np.mean(np.abs(reach - expected) < 0.1 * (1 + expected)) > 0.9
        for m, lag in enumerate(lags[:5]):
            goes_on = np.minimum(reach, expected) > 1.5 * lag
            off = np.linalg.norm((found - wanted)[first + m, ..., :3], axis=-1)[goes_on]
            assert np.median(off) < 4e-3 and np.mean(off < 0.05) > 0.97, (side, lag)


def test_what_a_client_cannot_trace_comes_as_slices() -> None:
    assert can_trace(web_views(swinging(), Options.split(lines="streamlines"))[0].scene.textures)
    view = web_views(swinging(), Options.split(lines="pathlines"))[0]
    data = replace(view.page_data(), traces=True)
    assert not data.traced and "slices/0" in data.step(0) and "position" in data.surface()


def test_cells_of_very_different_sizes_come_as_slices() -> None:
    x = np.concatenate([np.linspace(0, 1e-6, 30), [1.0, 2.0]])
    points = np.stack(np.meshgrid(x, x), axis=-1)
    field = FlowField.from_arrays(points, np.ones_like(points))
    assert not can_trace(web_views(field, Options.split())[0].scene.textures)


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
    assert made.estimated == pytest.approx(made.nbytes, rel=0.5)
