"""Words on the camera's controls."""

from __future__ import annotations

import pytest

pytest.importorskip("trame_rca")

from flowtex.app import FlowApp
from flowtex.offscreen.annotations import length_text, round_length


@pytest.mark.parametrize(
    ("unit", "one"),
    [("diameters", "diameter"), ("body lengths", "body length"), ("ms", "ms"), ("metre", "metre")],
)
def test_one_is_said_in_the_singular(unit: str, one: str) -> None:
    assert length_text(1.0, unit) == f"1 {one}"
    assert length_text(20.0, unit) == f"20 {unit}"


def test_thousands_of_metres_are_kilometres() -> None:
    assert length_text(500.0, "m") == "500 m"
    assert length_text(1000.0, "m") == "1 km"
    assert length_text(2e6, "m") == "2000 km"
    assert length_text(2000.0, "mm") == "2000 mm"


@pytest.mark.parametrize(
    ("greatest", "length"),
    [(7.3, 5), (0.019, 0.01), (20, 20), (999, 500), (0, 0), (float("inf"), 0)],
)
def test_a_scale_bar_has_a_round_length(greatest: float, length: float) -> None:
    assert round_length(greatest) == pytest.approx(length)


@pytest.mark.usefixtures("opengl")
def test_panels_move_a_surface_that_nobody_has_moved(flat: FlowApp) -> None:
    camera, viewport = flat.controllers.camera, flat.viewport
    viewport.home()
    whole = viewport.camera
    for junk in (None, 3, [None], [[0, 0, 1]], [[0, 0, 2, 1]], ["abcd"], {"a": 1}):
        camera.take_covers(junk)
        assert viewport.camera == whole and viewport.covers == ()
    camera.take_covers([[0.7, 0, 1, 1]])
    assert viewport.camera != whole and viewport.at_home
    copy = viewport.copy()  # a picture that is saved has no panels
    assert copy.camera == whole
    copy.close()
    viewport.pan(0.1, 0.0)
    moved = viewport.camera
    camera.take_covers([])
    assert viewport.camera == moved
    viewport.home()
    assert viewport.camera == whole
