"""Time on the page."""

from __future__ import annotations

import pytest

pytest.importorskip("trame_rca")

from small_pages import difference, picture

from flowtex.app import FlowApp

pytestmark = pytest.mark.usefixtures("opengl")


def test_time_and_colours_follow_the_slider(series: FlowApp) -> None:
    series.state.set(time=0.0)
    series.controllers.playback.take_time()
    early = picture(series)
    series.state.set(time=2.5)
    series.controllers.playback.take_time()
    assert series.viewport.handle.time == 2.5 and series.state.get("moment") == "t = 2.50"
    assert difference(picture(series), early) > 2
    series.state.set(time=99.0)
    series.controllers.playback.take_time()
    assert series.viewport.handle.time == 3.0


def test_playing_goes_round(series: FlowApp) -> None:
    series.state.set(time=2.9)
    series.controllers.playback.take_time()
    series.area.player.advance(0.5)
    assert 0 <= series.viewport.handle.time < 0.5


def test_playing_a_steady_flow_moves_its_clock(flat: FlowApp) -> None:
    flat.state.set(playing=True)
    flat.controllers.playback.take_playing()
    flat.controllers.appearance.take_settings()
    still = picture(flat)
    flat.area.player.advance(0.5)
    assert flat.viewport.handle.clock == 0.5 and flat.viewport.handle.settings.motion == "speed"
    assert difference(picture(flat), still) > 2
    flat.state.set(playing=False, set_motion="off")
    flat.controllers.playback.take_playing()
    flat.controllers.appearance.take_settings()
