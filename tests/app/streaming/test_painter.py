"""Pictures as good as the time allows: drafts and tiles."""

from __future__ import annotations

import pytest

pytest.importorskip("trame_rca")

from small_pages import difference, picture

from flowtex.app import FlowApp
from flowtex.app.streaming.painter import COARSEST_DRAFT, Cost

pytestmark = pytest.mark.usefixtures("opengl")


@pytest.mark.parametrize("kind", ["flat", "bent"])
def test_tiles_are_the_same_picture(kind: str, request: pytest.FixtureRequest) -> None:
    app: FlowApp = request.getfixturevalue(kind)
    whole = picture(app)
    tile = app.viewport.draw(80, 60, (100, 40, 80, 60)).astype(int)
    # Curved surfaces show a row of pixels of another level where 2 x 2 blocks fall otherwise.
    assert difference(tile, whole[40:100, 100:180]) < 1.0
    assert difference(tile, whole[42:102, 100:180]) > 3.0


def test_a_full_picture_is_the_whole_one(flat: FlowApp) -> None:
    painter = flat.stream.painter.painters[0]
    flat.area.settings.samples = 21
    painter.forget()
    painter.cost.learn(5.0, 240 * 160, 9)
    quick = painter.quick(0.01)
    assert flat.area.settings.samples == 21  # of which a draft has fewer
    flat.area.settings.samples = 9
    assert not painter.complete and quick.shape[1] <= 240 * COARSEST_DRAFT + 1
    *_, full = painter.full()
    assert painter.complete and difference(full, picture(flat)) < 0.5
    painter.cost = Cost()


def test_the_cost_of_a_picture_is_learnt() -> None:
    cost = Cost()
    for _ in range(20):
        cost.learn(0.006 + 1e-8 * 10**6 * (41 + 8), 10**6, 41)
    assert cost.seconds(10**6, 41) == pytest.approx(0.496, rel=0.02)
    assert cost.choose(10**6, 41, 1.0).scale == 1.0
    draft = cost.choose(10**6, 41, 0.05)
    assert draft.samples == 9 and 0.3 < draft.scale < 0.6
    assert cost.seconds(10**6 * draft.scale**2, 9) == pytest.approx(0.05, rel=0.05)
