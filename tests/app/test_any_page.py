"""A page shows what a new one shows, after any messages in any order."""

from __future__ import annotations

import asyncio
import warnings
from contextlib import closing
from functools import partial
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
from state_flows import FLOWS, LOOK, SETTING, TIMES, make_small, volume
from strategies import property_test
from waiting import PATIENCE_S, until, wait_until

from flowtex.errors import Notice
from flowtex.host.view import CHOSEN

pytest.importorskip("trame_rca")

from flowtex.app import Library
from flowtex.app.streaming.stream import ViewPainter
from flowtex.sources.open_source import MeshSource

#: Flows that a page may open, and a mesh of which it shows planes.
SHOWN = {**FLOWS, "volume": volume}
NAMES = st.sampled_from(sorted(SHOWN))
#: A comparison is one of those that the page offers for the flow.
COMPARISON = st.one_of(st.just(0), st.integers(0, 40))
SIZES = [(96, 64), (60, 60)]
ROUNDING = 2  #: Greatest difference of a pixel, by rounding in another order of operations.
#: Values in the header of a scene that belong to one page.
OWN = ("generation", "place")


def source_of(name: str) -> MeshSource:
    return MeshSource(SHOWN[name]())


class AnyPage(RuleBasedStateMachine):
    """A page, and messages from a browser."""

    @initialize(name=NAMES, painter=st.sampled_from(["server", "browser"]), waits=st.booleans())
    def begin(self, name: str, painter: str, *, waits: bool) -> None:
        self.size = SIZES[0]
        self.clock = 0.0
        self.painter = painter
        self.first_name = name
        self.links: list[str] = []
        self.loop = asyncio.new_event_loop()
        self.app = self.page(name)
        if not waits:
            self.app.viewport.load_in_background(lambda: None)
        #: What the browser was handed.
        self.told = self.handed(self.app)
        self.app.server.js_call = self.take

    def page(self, name: str, **options: Any) -> Any:
        """Return a page that opens a flow first."""
        openers = {each: partial(source_of, each) for each in [name, *SHOWN]}
        app = small_page(Library(openers), 9, *self.size, show_scalar_bar=False, **options)
        app.server.state.ready()  # so that it listens
        return app

    def handed(self, app: Any) -> dict[str, Any]:
        """Return what a browser is handed when it opens a page."""
        return dict(app.area.begin(self.painter))

    def take(self, ref: str, method: str, changes: dict[str, Any]) -> None:
        """Take changes as the browser does."""
        assert (ref, method) == (self.app.area.ref, "take")
        self.told |= changes

    def tell(self, change: Any) -> None:
        """Send a message to the page, and wait until it has been handled."""
        app = self.app

        async def told() -> None:
            change()
            with app.server.state:  # which calls listeners, as after a message
                pass
            openings = (app.data, app.beside)
            await until(lambda: not any(each.is_opening for each in openings))
            await until(lambda: not app.area.player.is_reading)
            await asyncio.sleep(0)

        self.loop.run_until_complete(asyncio.wait_for(told(), PATIENCE_S))
        app.viewport.draw(*app.viewport.pane_size)

    @rule(changes=st.lists(SETTING, min_size=1, max_size=3))
    def set_settings(self, changes: list[tuple[str, Any]]) -> None:
        for name, value in changes:
            self.tell(lambda change=[name, value]: self.app.area.take_setting(change))

    @rule(changes=st.lists(LOOK, min_size=1, max_size=3))
    def set_look(self, changes: list[tuple[str, Any]]) -> None:
        for name, value in changes:
            if name != "show_scalar_bar":  # which the page draws itself
                self.tell(lambda change={name: value}: self.app.area.take_colours(change))

    @rule(time=st.sampled_from([*TIMES, *TIMES, 0.2, 0.7]))
    def set_time(self, time: float) -> None:
        self.tell(lambda: self.app.area.take_time(time))

    @rule(clock=st.sampled_from([0.0, 0.5]))
    def set_clock(self, clock: float) -> None:
        self.clock = clock
        self.tell(lambda: self.app.area.take_clock(clock))

    @rule(scale=st.sampled_from([0.3, 1.0]), x=st.sampled_from([0.0, 0.4]))
    def set_camera(self, scale: float, x: float) -> None:
        camera = {"focal_point": [x, 0, 0], "position": [x, 0, 5], "parallel_scale": scale}
        self.tell(lambda: self.app.area.take_camera(camera))

    @rule()
    def reset_camera(self) -> None:
        self.tell(self.app.area.reset_camera)

    @rule(size=st.sampled_from(SIZES))
    def resize(self, size: tuple[int, int]) -> None:
        self.size = size
        stream = self.app.stream
        self.tell(lambda: stream.update_size("test", {"w": size[0], "h": size[1], "p": 1}))

    @rule(number=COMPARISON)
    def compare(self, number: int) -> None:
        labels = self.app.state.get("comparisons")
        self.tell(lambda: self.app.state.set(compare=labels[number % len(labels)]))

    @rule(name=NAMES)
    def open(self, name: str) -> None:
        self.tell(lambda: self.app.state.set(file=name))

    @rule(axis=st.sampled_from("ijk"), share=st.sampled_from([0.0, 0.5, 1.0]))
    def move_plane(self, axis: str, share: float) -> None:
        state = self.app.state
        if axis in state.get("axes"):
            self.tell(lambda: state.set(axis=axis))
            self.tell(lambda: state.set(index=round(share * state.get("planes"))))

    @rule()
    def remember_link(self) -> None:
        self.links.append(self.link())

    @rule(data=st.data())
    def take_link(self, data: Any) -> None:
        if self.links:
            link = data.draw(st.sampled_from(self.links))
            self.tell(lambda: self.app.sharing.take_link(link))

    def link(self) -> str:
        """Return the page's link to what it shows."""
        self.app.sharing.show_state()
        return str(self.app.state.get("link"))

    @rule(theme=st.sampled_from(["dark", "light"]))
    def set_theme(self, theme: str) -> None:
        self.tell(lambda: self.app.state.set(theme=theme))

    def new_page(self) -> Any:
        """Return a new page in the same state."""
        app = self.app
        scene = app.area.scene
        look = {name: getattr(scene.appearance, name) for name in (*CHOSEN, "visible")}
        choice = {name: value for name, value in vars(app.data.choice).items() if value}
        new = self.page(app.data.name, **choice, **look)
        new.area.settings.update(**dict(app.area.settings))
        new.area.take_time(scene.time)
        return new

    def complete(self, new: Any) -> None:
        """Send a new page the rest of the state."""
        app, self.app = self.app, new
        for name in ("theme", "compare"):
            value = app.state.get(name)
            self.tell(lambda change={name: value}: self.app.state.set(**change))
        new.area.take_clock(self.clock)
        new.area.take_camera(app.viewport.camera.to_dict())
        self.app = app

    def picture(self, app: Any) -> Any:
        """Return the picture that the server sends at last, with all tiles."""
        painter = ViewPainter(app.viewport)

        def is_complete() -> bool:
            painter.quick()
            return not app.viewport.busy

        wait_until(is_complete)
        draft = painter.quick()
        *_, full = painter.full(draft)
        return np.asarray(full, dtype=int)

    def teardown(self) -> None:
        if not hasattr(self, "app"):  # the first step failed
            return
        with closing(self.loop), closing(self.app) as app, closing(self.new_page()) as new:
            self.complete(new)
            np.testing.assert_allclose(self.picture(app), self.picture(new), atol=ROUNDING)
            self.check_told(self.handed(new))
            self.check_link()
        count_case("state machine")

    def check_link(self) -> None:
        """Compare the page with a new one that opens its link."""
        link, app = self.link(), self.app
        picture, told = self.picture(app), self.told
        self.app = self.page(self.first_name)
        with closing(self.app) as new:
            self.told = self.handed(new)
            new.server.js_call = self.take
            self.tell(lambda: new.sharing.take_link(link))
            np.testing.assert_allclose(picture, self.picture(new), atol=ROUNDING)
        self.app, self.told = app, told

    def check_told(self, expected: dict[str, Any]) -> None:
        """Compare what the browser was told with what a new one is handed."""
        for name in ("settings", "time", "timeBeside", "clock", "playing"):
            assert self.told[name] == expected[name], name
        for one, other in zip(self.told["scenes"], expected["scenes"], strict=True):
            header, wanted = dict(one["header"]), dict(other["header"])
            # A scene is handed over when it changes; later cameras and times are told apart.
            for name in (*OWN, "camera", "time", "clock", "settings"):
                header.pop(name, None)
                wanted.pop(name, None)
            assert header == wanted


@pytest.mark.hypothesis
def test_any_order_of_messages_shows_what_a_new_page_does(
    opengl: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    make_small(monkeypatch.setattr)
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore", Notice)
        run_state_machine_as_test(AnyPage, settings=property_test(4, fuzz=25, steps=10))
