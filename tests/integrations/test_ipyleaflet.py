"""A map of ipyleaflet that follows the flow, as the docs say: `make integrations`."""

from __future__ import annotations

import base64
import io
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

PAGE = Path(__file__).resolve().parents[2] / "docs" / "howto" / "webmaps.md"
#: South-western and north-eastern corners of maps, as (latitude, longitude).
VIEWS = [((30.0, -80.0), (45.0, -55.0)), ((36.0, -76.0), (42.0, -68.0))]


@pytest.mark.parametrize("corners", VIEWS)
def test_a_picture_lies_where_the_data_are(opengl: Any, corners: Any) -> None:
    pytest.importorskip("ipyleaflet", reason="make integrations")
    import matplotlib.pyplot as plt

    plt.switch_backend("agg")
    block = next(
        b for b in re.findall(r"```py\n(.*?)```", PAGE.read_text(), re.DOTALL) if "ipyleaflet" in b
    )
    page: dict[str, Any] = {}
    exec(compile(block, PAGE.name, "exec"), page)
    web_map, overlay = page["web_map"], page["overlay"]
    web_map.set_trait("bounds", corners)
    assert tuple(map(tuple, overlay.bounds)) == corners and overlay in web_map.layers
    data = base64.b64decode(overlay.url.removeprefix("data:image/png;base64,"))
    alpha = np.asarray(Image.open(io.BytesIO(data)))[..., 3]
    # Where web maps have the nodes, by the formula of their projection.
    (south, west), (north, east) = corners
    currents = page["currents"]
    lon, lat = np.meshgrid(currents.longitude.values, currents.latitude.values)

    def up(degrees: Any) -> Any:
        return np.log(np.tan(np.pi / 4 + np.radians(degrees) / 2))

    rows, columns = alpha.shape
    x = columns * (lon - west) / (east - west)
    y = rows * (up(north) - up(lat)) / (up(north) - up(south))
    seen = (x > 1) & (x < columns - 1) & (y > 1) & (y < rows - 1)
    sea = np.isfinite(currents.uo.values)
    neighbours = np.stack([np.roll(sea, (j, i), (0, 1)) for j in (-1, 0, 1) for i in (-1, 0, 1)])
    inner = neighbours.all(axis=0), ~neighbours.any(axis=0)  # of the sea, and of the land
    for where, expected in zip(inner, (255, 0), strict=True):
        found = alpha[y[where & seen].astype(int), x[where & seen].astype(int)]
        assert len(found) > 100 and (found == expected).all()
