"""The part of the view that the panels of a page leave free, and the surface in it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from flowtex import examples
from flowtex.app.streaming.free_part import covers_of_pane, free_part
from flowtex.camera import WHOLE_VIEW, Camera, ViewPart

PANEL = (0.8, 0.05, 1.0, 1.0)
FOOT = (0.3, 0.9, 0.7, 1.0)


def test_the_part_beside_a_panel_is_free() -> None:
    assert free_part([], 1.0) == WHOLE_VIEW
    left, bottom, right, top = free_part([PANEL, FOOT], 1.0)
    assert left == -1 and right == pytest.approx(0.6) and top == 1
    assert bottom == pytest.approx(-0.8)


def test_a_narrow_surface_stands_where_it_is_largest() -> None:
    tall = free_part([PANEL, FOOT], 0.2)
    assert tall[1] == -1 and tall[3] == 1


def test_a_panel_that_leaves_little_lies_on_the_surface() -> None:
    assert free_part([(0.02, 0.05, 0.98, 0.9)], 1.0) == WHOLE_VIEW
    panel = (0.02, 0.05, 0.98, 0.9)
    assert free_part([panel, FOOT], 1.0) == free_part([FOOT], 1.0)


def test_what_lies_on_one_pane_is_free_in_neither() -> None:
    assert free_part(covers_of_pane([PANEL], 2), 1.0)[2] == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("name", "aspect", "free"),
    [("cylinder", 0.46, (-1.0, -0.5, 0.4, 0.9)), ("delta_wing", 1.7, (-0.2, -1.0, 1.0, 1.0))],
)
def test_a_surface_is_fitted_to_the_free_part(name: str, aspect: float, free: ViewPart) -> None:
    surface: Any = getattr(examples, f"{name}_field")().surface
    places = Camera.fit(surface, aspect, free=free).project(surface.points[surface.valid], aspect)
    low, high = places.min(axis=0), places.max(axis=0)
    assert (low >= np.array(free[:2]) - 1e-9).all() and (high <= np.array(free[2:]) + 1e-9).all()
    size = np.subtract(free[2:], free[:2])
    assert ((high - low) / size).max() > 0.6
