"""A widget has the traits and the arrays of a new one, after any changes in any order."""

from __future__ import annotations

import warnings
from collections.abc import Callable
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
from state_flows import FLOWS, LARGEST_WHOLE, LOOK, SETTING, TIMES, make_small
from strategies import property_test
from waiting import PATIENCE_S

from flowtex.errors import FieldError, Notice
from flowtex.field.options import option_names
from flowtex.host.view import first_parts
from flowtex.scene.options import Appearance
from flowtex.settings import TABLE, SettingsError

pytest.importorskip("anywidget")

import traitlets

from flowtex.host.flow_widget import FlowWidget

#: Traits that differ between two widgets that show the same.
OWN = {"_key", "_anywidget_id", "layout", "comm", "keys", "log", "tabbable", "tooltip"}
SENT = ("generation", "surface")  #: Parts of a header that say what has been sent.
NAMES = st.sampled_from(sorted(FLOWS))
REFUSALS = (FieldError, SettingsError, traitlets.TraitError)


class Told(FlowWidget):
    """A widget that keeps the arrays that its client would have."""

    def send(self, content: Any, buffers: Any = None) -> None:
        """Keep arrays by name, and errors."""
        told = self.__dict__.setdefault("_told", {})
        assert content["kind"] != "error", content
        generation = content.get("generation")
        if generation is not None and generation != self.__dict__.get("_generation"):
            # The client drops the parts of single times with the scene that they belong to.
            self.__dict__["_generation"] = generation
            for name in [name for name in told if "/" in name]:
                del told[name]
        for info, data in zip(content.get("parts", ()), buffers or (), strict=True):
            told[info["name"]] = np.frombuffer(data, info["dtype"]).reshape(info["shape"])


def traits_of(widget: FlowWidget) -> dict[str, Any]:
    """Values of the traits that are shared with a browser."""
    values: dict[str, Any] = {n: getattr(widget, n) for n in widget.traits(sync=True)}
    header = {n: value for n, value in values["_header"].items() if n not in SENT}
    values["_header"] = header
    return {name: value for name, value in values.items() if name not in OWN}


def settle(widget: FlowWidget) -> None:
    """Wait until the first arrays have been sent, and the whole of a large flow is there."""
    (feed,) = widget._feeds
    feed._sending.result(PATIENCE_S)
    assert feed.settled.wait(PATIENCE_S)


def differing(one: dict[str, Any], other: dict[str, Any]) -> dict[str, Any]:
    """Return the values of two dictionaries that differ, by name."""
    names = one.keys() | other.keys()
    return {n: (one.get(n), other.get(n)) for n in names if one.get(n) != other.get(n)}


def build_at_once(work: Callable[[], None], name: str) -> None:
    """Do what a thread would do, unless it waits for a client."""
    if name == "flowtex-build":
        work()


class AnyWidget(RuleBasedStateMachine):
    """A widget, and changes from Python and from a browser."""

    def __init__(self) -> None:
        super().__init__()
        self.has_image = False

    @initialize(name=NAMES)
    def begin(self, name: str) -> None:
        self.name = name
        self.widget = Told(FLOWS[name]())
        self.widget._handle_custom_msg({"kind": "ready"}, [])
        settle(self.widget)

    def change(self, change: Callable[[], None]) -> None:
        """Make a change; one that is refused leaves the state as it is."""
        before = traits_of(self.widget)
        try:
            change()
        except REFUSALS:
            assert traits_of(self.widget) == before

    @rule(change=SETTING)
    def set_trait(self, change: tuple[str, Any]) -> None:
        self.change(lambda: setattr(self.widget, *change))

    @rule(changes=st.lists(SETTING, max_size=3))
    def set_in_browser(self, changes: list[tuple[str, Any]]) -> None:
        self.widget.set_state(dict(changes))

    @rule(change=LOOK)
    def set_look(self, change: tuple[str, Any]) -> None:
        self.change(lambda: setattr(self.widget, *change))

    @rule(changes=st.lists(LOOK, max_size=2))
    def choose_in_browser(self, changes: list[tuple[str, Any]]) -> None:
        message = {"kind": "appearance", "changes": dict(changes)}
        self.widget._handle_custom_msg(message, [])

    @rule(time=st.sampled_from([*TIMES, 0.2, 0.7]))
    def set_time(self, time: float) -> None:
        self.change(lambda: setattr(self.widget, "time", time))

    @rule(scale=st.sampled_from([0.5, 1.0]), clock=st.sampled_from([0.0, 2.0]))
    def set_view(self, scale: float, clock: float) -> None:
        self.widget.camera = {"parallel_scale": scale}
        self.widget.clock = clock

    @rule(name=NAMES)
    def set_field(self, name: str) -> None:
        def show() -> None:
            self.widget.field = FLOWS[name]()
            self.name = name

        self.change(show)

    def new_widget(self) -> FlowWidget:
        """Return a new widget in the same state."""
        widget, look = self.widget, self.widget.scene.appearance
        options = {name: getattr(look, name) for name in option_names(Appearance)}
        settings = {name: getattr(widget, name) for name in TABLE}
        new = FlowWidget(FLOWS[self.name](), **options, **settings, camera=dict(widget.camera))
        new.time, new.clock = widget.time, widget.clock
        settle(new)
        return new

    def teardown(self) -> None:
        with closing(self.widget) as widget, closing(self.new_widget()) as new:
            traits, expected = traits_of(widget), traits_of(new)
            assert differing(traits.pop("_header"), expected.pop("_header")) == {}
            assert differing(traits, expected) == {}
            told = vars(widget)["_told"]
            for name, part in first_parts(new._feeds[0].source.scene, new.time).items():
                if name in told or "/" not in name:
                    np.testing.assert_array_equal(told[name].ravel(), part.ravel(), name)
        count_case("state machine")


@pytest.mark.hypothesis
def test_any_order_of_changes_gives_what_a_new_widget_has(monkeypatch: pytest.MonkeyPatch) -> None:
    make_small(monkeypatch.setattr)
    for name in ("COARSE_STEADY", "COARSE_VARYING"):
        monkeypatch.setattr(f"flowtex.host.feed.{name}", LARGEST_WHOLE // 2)
    monkeypatch.setattr("flowtex.host.feed.start", build_at_once)
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore", Notice)
        run_state_machine_as_test(AnyWidget, settings=property_test(6, fuzz=100, steps=12))
