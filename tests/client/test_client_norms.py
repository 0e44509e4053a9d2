"""Norms of matplotlib in a browser: colours, legends, and what a person chooses then."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from matplotlib.colors import Normalize
from normed import HEIGHT, HIGH, LOW, NORMS, PLAIN, differences, ramp
from webgl_page import ClientPage, packed

from flowtex.host.view import WebView
from flowtex.rendering.camera import Camera
from flowtex.scene.scene import Scene

pytestmark = pytest.mark.browser

SIZE = (400, 200)
MIDDLE = (0.5, HEIGHT / 2)
CAMERA = Camera((*MIDDLE, 1), (*MIDDLE, 0), (0, 1, 0), parallel=True, parallel_scale=HEIGHT / 2)
TICKS = """(n) => [...viewers[n].root.shadowRoot.querySelectorAll('.ticks span')]
  .map((tick) => [tick.textContent, tick.style.left])"""


def mounted(client: ClientPage, **options: Any) -> int:
    view = WebView(Scene.of(ramp(), samples=5, **PLAIN, **options), background="white")
    data = view.page_data()
    header = data.header(view.scene.settings, camera=CAMERA.to_dict())
    return client.mount(packed(data, header | {"axes": "none"}), SIZE, density=1)


def row_of(client: ClientPage, viewer: int) -> tuple[Any, Any]:
    """Return pixels along the middle of the surface, and their x."""
    picture = client.picture(viewer)
    height, width = picture.shape[:2]
    x = 0.5 + (np.arange(width) + 0.5 - width / 2) / height * HEIGHT
    seen = (x > 0.01) & (x < 0.99)
    return picture[height // 2, seen], x[seen]


@pytest.mark.parametrize("name", NORMS)
def test_a_browser_has_the_colours_of_a_norm(client: ClientPage, name: str) -> None:
    norm = NORMS[name]()
    viewer = mounted(client, norm=norm, show_scalar_bar=False)
    assert differences(*row_of(client, viewer), norm).max() < 2


def test_the_legend_of_a_norm_has_its_values_at_its_places(client: ClientPage) -> None:
    viewer = mounted(client, norm=NORMS["boundaries"]())
    client.sharp(viewer)
    texts, places = zip(*client.page.evaluate(TICKS, viewer), strict=True)
    assert texts == ("-20", "-10", "0", "5", "7", "60", "80")
    shares = [float(place.removesuffix("%")) / 100 for place in places]
    np.testing.assert_allclose(shares, np.linspace(0, 1, 7), atol=2e-3)


def test_another_map_keeps_a_norm_and_another_range_ends_it(client: ClientPage) -> None:
    viewer = mounted(client, norm=(norm := NORMS["power"]()))
    client.sharp(viewer)
    choose = "([n, choice]) => viewers[n].chooseColours(choice)"
    client.page.evaluate(choose, [viewer, {"cmap": "magma"}])
    assert np.median(differences(*row_of(client, viewer), norm, "magma")) < 3
    client.page.evaluate(choose, [viewer, {"clim": [LOW, HIGH]}])
    even = Normalize(LOW, HIGH)
    assert np.median(differences(*row_of(client, viewer), even, "magma")) < 3
    client.page.evaluate(choose, [viewer, {"cmap": "gray"}])
    assert differences(*row_of(client, viewer), even, "gray").max() < 3


def test_colours_are_few_reversed_and_beyond_the_range(client: ClientPage) -> None:
    options: dict[str, Any] = {"clim": (0, 50), "n_colors": 5, "flip_scalars": True}
    viewer = mounted(client, below_color="red", above_color="blue", **options)
    row, x = row_of(client, viewer)
    values = LOW + (HIGH - LOW) * x
    table = Scene.of(ramp(), **PLAIN, **options).colour_scale.table[:, :3].astype(int)
    wanted = table[(np.clip(values / 50, 0, 0.999) * 5).astype(int)]
    wanted = np.where((values < 0)[:, None], (255, 0, 0), wanted)
    wanted = np.where((values > 50)[:, None], (0, 0, 255), wanted)
    assert (np.abs(row.astype(int) - wanted).max(axis=-1) > 1).mean() < 0.03
