"""Where the client's pixels lie on the surface: drawn once for a view, and without a crack."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from webgl_page import ClientPage, packed, state

from flowtex import FlowField
from flowtex.rendering.camera import Camera
from flowtex.rendering.webgl.client_data import ClientData
from flowtex.settings import Settings
from flowtex.textures.texture_set import TextureSet
from flowtex.trace.store import SliceStore

pytestmark = pytest.mark.browser

#: Of many views: pixels whose surroundings show one place of the surface, and those of them that do
#: not if nodes are left out; and whether blocks differ in the nodes that they leave out.
CRACKS = """(size) => {
  const { painter, camera } = viewers[0];
  const { places } = painter;
  const { layers } = places;
  const [width, height] = size;
  const gl = places.graphics.context;
  const { scene } = layers[0];
  const most = scene.doublings.map((_, block) => (7 * block) % 5);
  const drawn = (doublings) => {
    scene.doublings.set(doublings);
    scene.version += 1;
    const { anchor } = viewers[0].view(painter.shown, 1);
    places.draw({ layers, camera, anchor, width, height });
    const bits = new Uint32Array(4 * width * height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, places.target.frames[0]);
    gl.readPixels(0, 0, width, height, gl.RGBA_INTEGER, gl.UNSIGNED_INT, bits);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return [bits, new Float32Array(bits.buffer)];
  };
  const found = { inside: 0, cracks: 0, mixed: 0 };
  for (let n = 0; n < 80; n += 1) {
    camera.rotate(0.03, n % 2 ? 0.05 : -0.04);
    const [there, place] = drawn(most);
    found.mixed += Number(new Set(places.seen[0].levels).size > 1);
    const [all, exact] = drawn(most.map(() => 0));
    const far = (a, i, b, k) => Math.hypot(a[i] - b[k], a[i + 1] - b[k + 1]) > 0.04;
    for (let y = 1; y < height - 1; y += 1) {
      for (let x = 1; x < width - 1; x += 1) {
        const i = 4 * (y * width + x);
        const around = [-1, 0, 1].flatMap((j) => [-4, 0, 4].map((k) => i + k + 4 * j * width));
        if (around.some((k) => !all[k + 3] || far(exact, k, exact, i))) continue;
        found.inside += 1;
        found.cracks += Number(!there[i + 3] || far(place, i, exact, i));
      }
    }
  }
  return found;
}"""


def fine_torus() -> FlowField:
    a, b = np.meshgrid(np.linspace(0, 2 * np.pi, 200), np.linspace(0, 2 * np.pi, 130))
    around = np.stack([np.cos(a), np.sin(a), 0 * a], axis=-1)
    points = (2 + np.cos(b))[..., None] * around
    points[..., 2] = np.sin(b)
    return FlowField.from_arrays(points, np.gradient(points, axis=1))


def bent_sheet() -> FlowField:
    """A rough sheet whose cells are of very different sizes."""
    y, x = (n**3 for n in np.mgrid[0:1:140j, 0:1:150j])
    height = 0.1 * np.sin(9 * x) * np.cos(8 * y)
    height += np.random.default_rng(1).normal(size=x.shape) * 2e-3
    return FlowField.from_arrays(
        np.stack([x, y, height], axis=-1), np.stack([1 + 0 * x, x, 0 * x], axis=-1)
    )


def mounted(client: ClientPage, field: Any, camera: Camera, size: tuple[int, int]) -> None:
    settings = Settings(samples=5)
    data = ClientData(TextureSet.build(SliceStore(field)))
    header = data.header(settings, camera=state(camera))
    client.mount(packed(data, header), size, controls=False, smooth=False)
    client.sharp()


@pytest.mark.parametrize("make", [fine_torus, bent_sheet])
def test_no_crack_opens_where_nodes_are_left_out(client: ClientPage, make: Any) -> None:
    field = make()
    fit = Camera.fit(field.surface, 1.4)
    focus, way = np.array(fit.focal_point), np.array([0.6, -0.5, 0.45]) * fit.distance
    mounted(client, field, Camera(tuple(focus + way), tuple(focus), (0, 0, 1)), (80, 60))
    found = client.page.evaluate(CRACKS, [80, 60])
    assert found["mixed"] > 20 and found["inside"] > 2_000
    assert found["cracks"] == 0
