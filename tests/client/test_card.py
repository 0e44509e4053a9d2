"""What benchmarks/card.py draws by OpenGL is the picture of the client in the browser."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from flows import gyre
from matrix import GROUND, ROOT, SHARE, SIZE, difference, straight
from webgl_page import ClientPage, packed, state, tile_maker

from flowtex.host.view import web_views
from flowtex.scene.options import Options

pytest.importorskip("moderngl")

from benchmarks import card

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def context() -> Iterator[Any]:
    """Context of OpenGL without a window."""
    opened = card.opened_card()
    yield opened
    opened.release()


@pytest.mark.parametrize(("nodes", "zoom"), [((61, 31), 40.0), ((121, 61), 3.0)])
def test_the_picture_is_that_of_the_client(
    client: ClientPage,
    context: Any,
    small_tiles: None,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    nodes: tuple[int, int],
    zoom: float,
) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.pyramid.ROOT_NODES", 2000)
    view = web_views(gyre(*nodes), Options.split(background=GROUND, samples=11))[0]
    camera, whole = straight(zoom), replace(view.data(), traces=True)
    if whole.pyramid is not None:
        client.tile = tile_maker(whole)
    header = whole.header(view.scene.settings, camera=state(camera))
    viewer = client.mount(packed(whole, header), SIZE, controls=False, smooth=False)
    client.complete(viewer)

    path = tmp_path / "drawing.npz"
    card.drawing_of(view, camera, SIZE).write(path)
    drawing = card.Drawing.read(path)
    assert (len(drawing.about["layers"]) > 1) == (nodes != (61, 31))
    ours = card.Picture(context, drawing).pixels()
    root, share, only_one = difference(client.pixels(viewer), ours)
    assert root < ROOT
    assert share <= SHARE
    assert only_one == 0
