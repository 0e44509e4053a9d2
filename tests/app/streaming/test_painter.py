"""Pictures as good as the time allows: drafts, tiles, and moved pictures."""

from __future__ import annotations

from typing import Any

import pytest

pytest.importorskip("trame_rca")

from small_pages import difference, panned, picture

from flowtex.app import FlowApp
from flowtex.app.streaming.painter import COARSEST_DRAFT, Cost
from flowtex.app.streaming.reprojection import Snapshot, coverage, reproject

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


@pytest.mark.parametrize("by", [(30, 20), (-41, -20), (0, 12), (-12, 0)])
def test_after_a_drag_only_what_came_into_view_is_drawn(
    flat: FlowApp, by: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    painter = flat.stream.painter.painters[0]
    flat.area.reset_camera()
    painter.forget()
    painter.cost.learn(5.0, 240 * 160, 9)
    painter.quick(0.01)
    for _ in painter.full():
        pass
    panned(flat.viewport, -2 * by[0] / 240, 2 * by[1] / 160)
    drawn = []
    draw = type(painter.pane).draw

    def counted(pane: Any, width: int, height: int, part: Any = None) -> Any:
        drawn.append(width * height)
        return draw(pane, width, height, part)

    monkeypatch.setattr(type(painter.pane), "draw", counted)
    painter.quick(0.01)
    drawn.clear()
    *_, full = painter.full()
    exposed = 240 * 160 - (240 - abs(by[0])) * (160 - abs(by[1]))
    assert painter.complete and sum(drawn) == exposed
    assert difference(full, picture(flat)) < 0.5
    painter.cost = Cost()
    flat.area.reset_camera()


def test_a_moved_picture_is_the_one_that_would_be_drawn(flat: FlowApp) -> None:
    flat.area.reset_camera()
    scene = flat.viewport
    view = scene.panes[0].plane_view()
    assert view is not None
    shot = Snapshot(scene.draw(240, 160), view)
    panned(scene, 0.2, -0.1)
    moved = scene.panes[0].plane_view()
    assert moved is not None
    share, stretch = coverage(shot, moved)
    assert 0.5 < share < 1 and stretch == pytest.approx(1)
    shifted = reproject(shot, moved, (240, 160), Snapshot(shot.pixels * 0, moved))
    drawn = scene.draw(240, 160)
    assert difference(shifted[20:140, 40:190], drawn[20:140, 40:190]) < 1.5
    scene.camera = scene.camera.zoom_by(2.0, 0, 0, aspect=1.5, whole=scene.whole)
    closer = scene.panes[0].plane_view()
    assert closer is not None and coverage(shot, closer)[1] == pytest.approx(2)
    flat.area.reset_camera()


def test_the_cost_of_a_picture_is_learnt() -> None:
    cost = Cost()
    for _ in range(20):
        cost.learn(0.006 + 1e-8 * 10**6 * (41 + 8), 10**6, 41)
    assert cost.seconds(10**6, 41) == pytest.approx(0.496, rel=0.02)
    assert cost.choose(10**6, 41, 1.0).scale == 1.0
    draft = cost.choose(10**6, 41, 0.05)
    assert draft.samples == 9 and 0.3 < draft.scale < 0.6
    assert cost.seconds(10**6 * draft.scale**2, 9) == pytest.approx(0.05, rel=0.05)
