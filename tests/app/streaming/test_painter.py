"""Pictures as good as the time allows: drafts and tiles."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("trame_rca")

from small_pages import difference, picture

from flowtex.app import FlowApp
from flowtex.app.streaming.stream import LINE_GREY
from flowtex.app.streaming.viewport import GAP_PX

pytestmark = pytest.mark.usefixtures("opengl")


@pytest.mark.parametrize("kind", ["flat", "bent"])
def test_tiles_are_the_same_picture(kind: str, request: pytest.FixtureRequest) -> None:
    app: FlowApp = request.getfixturevalue(kind)
    whole = picture(app)
    tile = app.viewport.draw(80, 60, (100, 40, 80, 60)).astype(int)
    # Curved surfaces show a row of pixels of another level where 2 x 2 blocks fall otherwise.
    assert difference(tile, whole[40:100, 100:180]) < 1.0
    assert difference(tile, whole[42:102, 100:180]) > 3.0


def test_full_picture_replaces_draft(flat: FlowApp, monkeypatch: pytest.MonkeyPatch) -> None:
    module = "flowtex.app.streaming.stream"
    monkeypatch.setattr(f"{module}.DRAFT_PIXELS", 2_000)
    monkeypatch.setattr(f"{module}.TILE_PX", 64)
    painter = flat.stream.painter
    monkeypatch.setattr(painter, "slow", True)
    flat.area.settings.samples = 21
    quick = painter.quick()
    assert flat.area.settings.samples == 21  # of which a draft has fewer
    flat.area.settings.samples = 9
    assert not painter.complete and quick.shape[0] * quick.shape[1] < 2_100
    *_, full = painter.full(quick)
    assert difference(full, picture(flat)) < 0.5
    monkeypatch.setattr(painter, "slow", False)
    assert difference(painter.quick(), full) < 0.5 and painter.complete
    # A slow connection has smaller pictures from a graphics card as well.
    quarter = painter.quick(0.25)
    assert not painter.complete and quarter.shape == (80, 120, 3)
    (full,) = painter.full(quarter)
    assert difference(full, picture(flat)) < 0.5


def test_two_panes_have_line_between_them(flat: FlowApp, monkeypatch: pytest.MonkeyPatch) -> None:
    painter = flat.stream.painter
    monkeypatch.setattr(painter, "slow", False)
    flat.area.compare({"contrast": 0.0})
    try:
        width, height = flat.viewport.pane_size
        views = [flat.viewport.draw(width, height, pane=pane) for pane in flat.viewport.panes]
        line = np.full((height, GAP_PX, 3), LINE_GREY)
        expected = np.concatenate([views[0], line, views[1]], axis=1)
        assert difference(*views) > 3.0
        assert difference(painter.quick(), expected) < 0.5
        for share, slow in ((0.5, False), (1.0, True)):
            monkeypatch.setattr(painter, "slow", slow)
            *_, full = painter.full(painter.quick(share))
            assert difference(full, expected) < 0.5
    finally:
        flat.area.compare(None)
