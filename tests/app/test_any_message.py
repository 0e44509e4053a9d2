"""Whatever a page sends, the application goes on."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from flows import swinging
from hypothesis import given
from strategies import junk, links, property_test

pytest.importorskip("trame_rca")

from flowtex.app import FlowApp
from flowtex.settings import TABLE, Settings

pytestmark = pytest.mark.usefixtures("opengl")

EVENTS = ("MouseMove", "MouseWheel", "Pinch", "Pan", "LeftButtonPress", "LeftButtonRelease")


@pytest.fixture(scope="module")
def app() -> Iterator[FlowApp]:
    made = FlowApp(swinging(), samples=3)
    made.stream.update_size("test", {"w": 96, "h": 64, "p": 1})
    yield made
    made.close()


@property_test(40)
@given(junk(), junk(), links())
def test_whatever_a_page_sends_it_goes_on(app: FlowApp, one: Any, two: Any, link: str) -> None:
    controllers, send = app.controllers, app.stream.on_interaction
    names = [*(f"set_{name}" for name in TABLE), "colour", "cmap", "low", "high", "theme"]
    names += ["background", "time", "playing", "pace", "rendering", "image_file"]
    before = {name: app.state.get(name) for name in names}

    async def story() -> None:
        controllers.camera.command(one)
        controllers.camera.look_from(one)
        controllers.playback.step(two)
        controllers.appearance.take_setting(one)
        controllers.appearance.take_setting(["samples", two])
        controllers.browser.take_time(one)
        controllers.browser.take_sharp(two)
        controllers.appearance.take_setting([one, two])
        controllers.point_info.take_place([one, two])
        controllers.point_info.take_point([two, one])
        controllers.sharing.take_link(one)
        controllers.sharing.take_link(link)
        controllers.browser.take_camera(two)
        app.context.take_camera({"position": [one, two, 0], "parallel_scale": two})
        app.stream.update_size("test", {"w": one, "h": two, "p": one})
        for kind in (*EVENTS, one):
            places = {"x": one, "y": two, "translation": [two, one], "positions": {"0": one}}
            send("test", {"type": kind, "w": 96, "h": 64, "spinY": one, "factor": two, **places})
        app.state.set(**dict.fromkeys(names, one))
        for take in (
            controllers.appearance.take_settings,
            controllers.appearance.take_colour,
            controllers.appearance.take_range,
            controllers.appearance.take_background,
            controllers.appearance.take_image,
            controllers.playback.take_time,
            controllers.playback.take_playing,
            controllers.playback.take_pace,
            controllers.browser.take_renderer,
        ):
            take()

    asyncio.run(story())
    assert len(app.state.get("problem")) < 1000
    assert np.isfinite([*app.viewport.camera.position, *app.viewport.camera.focal_point]).all()
    controllers.point_info.leave()
    controllers.point_info.close_card()
    app.area.settings.update(**dict(Settings(samples=3)))
    app.state.set(**before)
    app.stream.update_size("test", {"w": 96, "h": 64, "p": 1})
    app.area.reset_camera()
