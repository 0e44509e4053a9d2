"""A page shows what a new one shows, after any messages in any order."""

from __future__ import annotations

import warnings
from contextlib import closing
from typing import Any

import numpy as np
import pytest
from case_counts import count_case
from hypothesis import strategies as st
from hypothesis.stateful import (
    RuleBasedStateMachine,
    initialize,
    rule,
    run_state_machine_as_test,
)
from small_pages import small_page
from state_flows import FLOWS, LOOK, SETTING, TIMES
from strategies import property_test

from flowtex.errors import Notice
from flowtex.host.view import CHOSEN
from flowtex.textures.tiles.structure import STRUCTURE

pytest.importorskip("trame_rca")

#: Flows that are drawn whole: a page does not wait for tiles.
NAMES = st.sampled_from(["series", "lazy series", "triangle series", "steady"])
SIZES = [(96, 64), (60, 60)]
ROUNDING = 2  #: Greatest difference of a pixel, by rounding in another order of operations.


class AnyPage(RuleBasedStateMachine):
    """A page, and messages from a browser."""

    @initialize(name=NAMES)
    def begin(self, name: str) -> None:
        self.name, self.size, self.clock = name, SIZES[0], 0.0
        self.app = small_page(FLOWS[name](), show_scalar_bar=False)

    def draw(self, app: Any) -> Any:
        return np.asarray(app.viewport.draw(*self.size), dtype=int)

    @rule(changes=st.lists(SETTING, min_size=1, max_size=3))
    def set_settings(self, changes: list[tuple[str, Any]]) -> None:
        for name, value in changes:
            if name not in STRUCTURE:  # which is found in the background
                self.app.area.take_setting([name, value])
                self.draw(self.app)

    @rule(changes=st.lists(LOOK, min_size=1, max_size=3))
    def set_look(self, changes: list[tuple[str, Any]]) -> None:
        for name, value in changes:
            if name != "show_scalar_bar":  # which the page draws itself
                self.app.area.take_colours({name: value})
                self.draw(self.app)

    @rule(time=st.sampled_from([*TIMES, *TIMES, 0.2, 0.7]))
    def set_time(self, time: float) -> None:
        self.app.area.take_time(time)
        self.draw(self.app)

    @rule(clock=st.sampled_from([0.0, 0.5]))
    def set_clock(self, clock: float) -> None:
        self.clock = clock
        self.app.area.take_clock(clock)
        self.draw(self.app)

    @rule(scale=st.sampled_from([0.3, 1.0]), x=st.sampled_from([0.0, 0.4]))
    def set_camera(self, scale: float, x: float) -> None:
        camera = {"focal_point": [x, 0, 0], "position": [x, 0, 5], "parallel_scale": scale}
        self.app.area.take_camera(camera)
        self.draw(self.app)

    @rule(size=st.sampled_from(SIZES))
    def resize(self, size: tuple[int, int]) -> None:
        self.size = size
        self.app.stream.update_size("test", {"w": size[0], "h": size[1], "p": 1})

    def new_page(self) -> Any:
        """Return a new page in the same state."""
        area = self.app.area
        look = {name: getattr(area.scene.appearance, name) for name in (*CHOSEN, "visible")}
        settings = dict(area.settings)
        samples = settings.pop("samples")
        flow, (width, height) = FLOWS[self.name](), self.size
        new = small_page(flow, samples, width, height, show_scalar_bar=False, **settings, **look)
        new.area.take_time(area.scene.time)
        new.area.take_clock(self.clock)
        new.area.take_camera(self.app.viewport.camera.to_dict())
        return new

    def teardown(self) -> None:
        with closing(self.app) as app, closing(self.new_page()) as new:
            np.testing.assert_allclose(self.draw(app), self.draw(new), atol=ROUNDING)
        count_case("state machine")


@pytest.mark.hypothesis
def test_any_order_of_messages_shows_what_a_new_page_does(opengl: Any) -> None:
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore", Notice)
        run_state_machine_as_test(AnyPage, settings=property_test(4, fuzz=25, steps=10))
