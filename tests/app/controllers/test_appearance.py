"""Settings, colours and background that a page chooses."""

from __future__ import annotations

import numpy as np
import pytest

import flowtex

pytest.importorskip("trame_rca")

from earth_fields import winds
from small_pages import difference, picture, small, small_page

from flowtex.app import FlowApp

pytestmark = pytest.mark.usefixtures("opengl")


def test_a_change_of_the_state_reaches_the_settings(flat: FlowApp) -> None:
    flat.state.set(set_contrast=2, set_lod=False)
    flat.controllers.appearance.take_settings()
    assert (
        flat.viewport.handle.settings.contrast == 2 and flat.viewport.handle.settings.lod is False
    )
    flat.state.set(set_contrast=1.0, set_lod=True)
    flat.controllers.appearance.take_settings()


def test_a_wrong_value_is_told_and_taken_back(flat: FlowApp) -> None:
    flat.state.set(set_samples=1000)
    flat.controllers.appearance.take_settings()
    assert "samples is 1000; expected" in flat.state.get("problem")
    assert flat.state.get("set_samples") == flat.viewport.handle.settings.samples == 9
    flat.state.set(problem="")


def test_colours_and_their_bar_change(flat: FlowApp) -> None:
    speed = picture(flat)
    flat.state.set(colour="height")
    flat.controllers.appearance.take_colour()
    assert flat.state.get("bar")["name"] == "height" and flat.state.get("bar")["high"] == "3"
    assert difference(picture(flat), speed) > 3
    flat.state.set(colour="none")
    flat.controllers.appearance.take_colour()
    grey = picture(flat)
    assert np.ptp(grey[80, 120]) == 0 and flat.state.get("bar")["name"] == ""
    flat.state.set(colour="speed")
    flat.controllers.appearance.take_colour()
    assert difference(picture(flat), speed) == 0


def test_a_legend_tells_a_residue_as_zero(flat: FlowApp) -> None:
    flat.area.clim = (1.94e-7, 10.3)
    bar = flat.state.get("bar")
    assert (bar["low"], bar["high"]) == ("0", "10.3") and flat.state.get("low") == 0
    flat.area.clim = None


def test_two_arrays_and_two_times_stand_beside_each_other(series: FlowApp, flat: FlowApp) -> None:
    flat.state.set(compare="Colour by: height")
    flat.controllers.appearance.take_comparison()
    first, second = (pane.handle.scene for pane in flat.viewport.panes)
    assert (first.scalar_name, second.scalar_name) == ("speed", "height")
    flat.area.clim, flat.area.cmap = (0.0, 1.0), "magma"
    assert second.appearance.cmap == "magma" and second.scalar_limits == (0.0, 3.0)
    assert flat.state.get("bar")["high"] == "1" and flat.state.get("bar_beside")["high"] == "3"
    flat.area.clim, flat.area.cmap = None, "viridis"
    flat.controllers.appearance.end_comparison()
    assert flat.state.get("bar_beside") is None

    appearance, viewport = series.controllers.appearance, series.viewport
    now = viewport.handle.time
    series.state.set(compare="Another time")
    appearance.take_comparison()
    assert [pane.handle.time for pane in viewport.panes] == [now, 0.0]
    series.state.set(time_beside=1.5)
    appearance.take_time_beside()
    viewport.set_time(2.0)
    assert [pane.handle.time for pane in viewport.panes] == [2.0, 1.5]
    assert appearance.describe()["time_beside"] == 1.5
    series.state.set(time_beside="late")
    appearance.take_time_beside()
    assert series.state.get("time_beside") == 1.5
    appearance.end_comparison()
    viewport.set_time(now)


def test_a_range_of_another_plane_does_not_stay(series: FlowApp) -> None:
    slow = small(steps=4)
    faster = flowtex.FlowField.from_arrays(slow.points, 3 * slow.velocity, times=slow.times)
    series.area.show(faster, keep_range=True)
    # The page comes to know the range of the plane before only now.
    series.controllers.appearance.take_range()
    assert series.area.clim is None
    series.controllers.appearance.show_field()
    assert series.state.get("high") == pytest.approx(3 * 1.7, rel=0.01)
    series.state.set(high=4.0)
    series.controllers.appearance.take_range()
    assert series.area.clim == (series.state.get("low"), 4.0)


def test_themes_change_the_background(flat: FlowApp) -> None:
    dark = picture(flat)[0, 0]
    flat.state.set(theme="light")
    flat.controllers.appearance.take_background()
    assert picture(flat)[0, 0].min() > 200 > dark.max()
    flat.state.set(theme="dark")
    flat.controllers.appearance.take_background()


def test_what_is_changed_in_python_is_shown_on_the_page(flat: FlowApp) -> None:
    speed, area = picture(flat), flat.area
    area.scalars, area.cmap, area.opacity = "height", "magma", 0.5
    for name, value in (("colour", "height"), ("cmap", "magma"), ("opacity", 0.5)):
        assert flat.state.get(name) == value
    assert flat.state.get("bar")["name"] == "height"
    assert difference(picture(flat), speed) > 3
    with pytest.raises(AttributeError, match=r"^FlowArea has no attribute 'cmaps'; did you mean"):
        area.cmaps = "magma"
    flat.state.set(opacity=1.0, log_scale=True)
    flat.controllers.appearance.take_colour()
    assert area.opacity == 0.5 and "log_scale is for values above 0" in flat.state.get("problem")
    flat.state.set(problem="", log_scale=False)
    area.scalars, area.cmap, area.opacity, area.log_scale = "speed", "viridis", 1.0, False
    assert difference(picture(flat), speed) == 0


def test_a_saved_look_comes_back_as_a_whole(flat: FlowApp) -> None:
    area, appearance = flat.area, flat.controllers.appearance
    before = area.scene.appearance
    look = {"colour": "height", "cmap": "magma", "clim": (0.5, 2.0)}
    appearance.restore({**look, "log_scale": True, "opacity": 0.25})
    assert (area.scalars, area.cmap, area.clim) == ("height", "magma", (0.5, 2.0))
    assert area.log_scale and area.opacity == 0.25 and flat.state.get("log_scale") is True
    saved = appearance.describe()
    assert saved["log_scale"] is True and saved["opacity"] == 0.25 and saved["clim"] == (0.5, 2.0)
    appearance.restore({"colour": "no such", "cmap": "os_system", "opacity": 1.0})
    assert (area.scalars, area.cmap, area.opacity) == ("height", "magma", 1.0)
    area.scene.appearance = before


def test_the_bar_has_the_colours_of_the_picture(flat: FlowApp) -> None:
    stops = flat.state.get("bar")["stops"]
    flat.state.set(set_strength=0.0)
    flat.controllers.appearance.take_settings()
    plain = flat.state.get("bar")["stops"]
    assert plain[-1] == "#fde724" != stops[-1]
    flat.state.set(set_strength=0.8)
    flat.controllers.appearance.take_settings()
    assert flat.state.get("bar")["stops"] == stops


def test_a_second_pane_has_the_colours_of_the_first(flat: FlowApp) -> None:
    flat.viewport.compare({"lod": False})
    flat.area.cmap = "magma"
    assert flat.viewport.panes[1].handle.cmap == "magma"
    flat.viewport.compare(None)
    flat.area.cmap = "viridis"


def test_a_robust_range_and_back(flat: FlowApp) -> None:
    flat.controllers.appearance.choose_range("robust")
    assert flat.area.clim == "robust"
    flat.controllers.appearance.choose_range()
    assert flat.area.clim is None


def test_lines_of_a_map_are_switched_where_there_is_one(flat: FlowApp) -> None:
    assert flat.state.get("has_map") is False
    app = small_page(winds("platecarree"), 5, 240, 160)
    try:
        assert app.state.get("has_map") is True
        assert app.state.get("coastlines") is app.state.get("graticule") is True
        with_lines = picture(app)
        app.state.set(coastlines=False)
        app.controllers.appearance.take_colour()
        assert app.area.coastlines is False and app.area.graticule is not False
        without = picture(app)
        assert difference(with_lines, without) > 0.2
        saved = app.controllers.appearance.describe()
        assert (saved["coastlines"], saved["graticule"]) == (False, True)
        app.state.set(graticule=7)
        app.controllers.appearance.take_colour()
        assert app.state.get("graticule") is True
        app.controllers.appearance.restore({"coastlines": True})
        assert difference(picture(app), with_lines) == 0
    finally:
        app.close()
