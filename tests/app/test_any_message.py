"""Whatever a page sends, the application continues."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from flows import swinging
from hypothesis import given
from small_pages import small_page
from strategies import junk, links, property_test

pytest.importorskip("trame_rca")

from flowtex.app import FlowApp
from flowtex.settings import Settings

pytestmark = pytest.mark.usefixtures("opengl")

CHOICES = ("scalars", "cmap", "clim", "log_scale", "opacity", "coastlines", "graticule")


@pytest.fixture(scope="module")
def app() -> Iterator[FlowApp]:
    made = small_page(swinging())
    yield made
    made.close()


@property_test(40)
@given(junk(), junk(), links())
def test_whatever_a_page_sends_it_goes_on(app: FlowApp, one: Any, two: Any, link: str) -> None:
    element = app.area
    names = ("theme", "background", "compare", "painter")
    before = {name: app.state.get(name) for name in names}
    look = app.area.scene.appearance

    async def story() -> None:
        element.begin(one)
        app.viewpoint.look_from(one)
        for setting in (one, ["samples", two], [one, two]):
            element.take_setting(setting)
        element.take_colours(one)
        for choice in CHOICES:
            element.take_colours({choice: one})
            element.take_colours({choice: [one, two]})
        element.take_time(one)
        element.take_clock(two)
        element.take_playing(one)
        app.sharing.take_link(one)
        app.sharing.take_link(link)
        element.take_camera(two)
        element.take_camera({"position": [one, two, 0], "parallel_scale": two})
        for at in (one, {"place": [one, two]}, {"index": [two, one]}, {"position": [one, two, 0]}):
            await app.area.points.read(0, at)
            await app.area.points.read(one, at)
        app.stream.update_size("test", {"w": one, "h": two, "p": one})
        app.stream.on_interaction("test", one)
        app.state.set(**dict.fromkeys(names, one))
        for take in (
            app.appearance.take_background,
            app.appearance.take_comparison,
            app.appearance.take_painter,
        ):
            take()

    asyncio.run(story())
    assert len(app.state.get("problem")) < 1000
    assert np.isfinite([*app.viewport.camera.position, *app.viewport.camera.focal_point]).all()
    app.area.scene.appearance = look
    app.area.player.playing = False
    app.area.settings.update(**dict(Settings(samples=3)))
    app.state.set(**before)
    app.stream.update_size("test", {"w": 96, "h": 64, "p": 1})
    app.area.reset_camera()
