"""Settings, colours and background that a page chooses."""

from __future__ import annotations

import pytest

pytest.importorskip("trame_rca")


from flowtex.app import FlowApp
from flowtex.field.dates import time_text

pytestmark = pytest.mark.usefixtures("opengl")


def test_two_arrays_and_two_times_stand_beside_each_other(series: FlowApp, flat: FlowApp) -> None:
    flat.state.set(compare="Colour by: height")
    flat.appearance.take_comparison()
    first, second = (pane.scene for pane in flat.viewport.panes)
    assert (first.scalar_name, second.scalar_name) == ("speed", "height")
    flat.area.clim, flat.area.cmap = (0.0, 1.0), "magma"
    assert second.appearance.cmap == "magma" and second.scalar_limits == (0.0, 3.0)
    flat.area.clim, flat.area.cmap = None, "viridis"
    flat.state.set(compare="nothing")
    flat.appearance.take_comparison()
    appearance, viewport = series.appearance, series.viewport
    now = viewport.handle.time
    series.state.set(compare="Another time")
    appearance.take_comparison()
    assert [pane.time for pane in viewport.panes] == [now, 0.0]
    series.state.set(time_beside=1.5)
    appearance.take_time_beside()
    viewport.set_time(2.0)
    assert [pane.time for pane in viewport.panes] == [2.0, 1.5]
    assert series.state.get("moment_beside") == time_text(viewport.field, 1.5)
    saved = appearance.describe()
    assert saved["split"] == "Time: 1.5"
    for wrong in ("late", None, float("nan")):
        series.state.set(time_beside=wrong)
        appearance.take_time_beside()
        assert series.state.get("time_beside") == 1.5
    series.state.set(compare="nothing")
    appearance.take_comparison()
    appearance.restore(saved)
    assert [pane.time for pane in viewport.panes] == [2.0, 1.5]
    series.state.set(compare="nothing")
    appearance.take_comparison()
    viewport.set_time(now)


def test_lines_of_another_kind_stand_beside_those_of_a_flow_that_varies(
    series: FlowApp, flat: FlowApp
) -> None:
    assert not [name for name in flat.state.get("comparisons") if "streamlines" in name]
    series.area.settings.lines = "pathlines"
    (choice,) = [name for name in series.state.get("comparisons") if "streamlines" in name]
    series.state.set(compare=choice)
    series.appearance.take_comparison()
    assert [pane.scene.lines for pane in series.viewport.panes] == ["pathlines", "streamlines"]
    series.state.set(compare="nothing")
    series.appearance.take_comparison()


def test_a_saved_look_comes_back_as_a_whole(flat: FlowApp) -> None:
    area, appearance = flat.area, flat.appearance
    before = area.scene.appearance
    look = {"colour": "height", "cmap": "magma", "clim": (0.5, 2.0)}
    appearance.restore({**look, "log_scale": True, "opacity": 0.25})
    assert (area.scalars, area.cmap, area.clim) == ("height", "magma", (0.5, 2.0))
    assert area.log_scale and area.opacity == 0.25
    saved = appearance.describe()
    assert saved["log_scale"] is True and saved["opacity"] == 0.25 and saved["clim"] == (0.5, 2.0)
    appearance.restore({"colour": "no such", "cmap": "os_system", "opacity": 1.0})
    assert (area.scalars, area.cmap, area.opacity) == ("speed", "viridis", 1.0)
    assert area.clim is None and not area.log_scale
    area.scene.appearance = before


@pytest.mark.parametrize("name", ["vorticity", "velocity_x"])
def test_a_derived_scalar_that_was_not_shown_before_comes_back(flat: FlowApp, name: str) -> None:
    area, appearance = flat.area, flat.appearance
    before = area.scene.appearance
    assert name not in area.scene.scalar_names
    split = f"Colour by: {name}"
    appearance.restore({"colour": name, "split": split})
    assert area.scalars == name
    assert appearance.compared == split
    flat.state.set(compare="nothing")
    appearance.take_comparison()
    area.scene.appearance = before
