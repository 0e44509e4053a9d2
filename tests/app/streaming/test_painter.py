"""Pictures as good as the time allows: drafts and tiles."""

from __future__ import annotations

import pytest

pytest.importorskip("trame_rca")

from small_pages import difference, picture

from flowtex.app import FlowApp

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
    painter.forget()
    quick = painter.quick()
    assert flat.area.settings.samples == 21  # of which a draft has fewer
    flat.area.settings.samples = 9
    assert not painter.complete and quick.shape[0] * quick.shape[1] < 2_100
    *_, full = painter.full()
    assert painter.complete and difference(full, picture(flat)) < 0.5
    monkeypatch.setattr(painter, "slow", False)
    assert difference(painter.quick(), full) < 0.5 and painter.complete
