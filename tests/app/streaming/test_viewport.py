"""What a view shows, one flow or two side by side."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

pytest.importorskip("trame_rca")

from flowtex import FlowField
from flowtex.app.streaming.viewport import Viewport
from flowtex.settings import SettingsError

pytestmark = pytest.mark.usefixtures("opengl")

GRID = np.stack(np.meshgrid(np.linspace(0, 2, 9), np.linspace(0, 1, 5)), axis=-1)


def on_grid(**options: Any) -> FlowField:
    return FlowField.from_arrays(GRID, np.ones_like(GRID), **options)


def on_triangles() -> FlowField:
    points = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    return FlowField.from_triangles(points, [[0, 1, 2], [1, 3, 2]], np.ones_like(points))


def state(view: Viewport) -> tuple[Any, ...]:
    scenes = [pane.scene for pane in view.panes]
    drawn = sorted(view.plotter.renderer.actors)
    return view.panes[:], scenes, dict(view.differences), view.camera, view.clock, drawn


@pytest.mark.parametrize("act", ["show", "compare", "time"])
def test_a_flow_that_is_refused_leaves_the_comparison(act: str) -> None:
    view = Viewport(on_grid(), image=np.ones((2, 2)), samples=5)  # which triangles do not have
    view.compare({"contrast": 0.0})
    view.clock = 0.5
    before = state(view)
    with pytest.raises((SettingsError, TypeError)):
        if act == "show":
            view.show(on_triangles())
        else:
            view.compare({"field": on_triangles()} if act == "compare" else {"time": "noon"})
    assert state(view) == before
    view.settings.samples = 7  # the second one follows still
    assert [pane.settings.samples for pane in view.panes] == [7, 7]
    view.show(on_grid(name="another"), keep_view=True)
    assert [pane.field.name for pane in view.panes] == ["another"] * 2
    assert [pane.clock for pane in view.panes] == [0.5] * 2
    assert view.panes[1].settings.contrast == 0.0
    view.settings.samples = 5
    assert view.panes[1].settings.samples == 5
    view.compare(None)
    assert len(view.panes) == 1
    view.close()
