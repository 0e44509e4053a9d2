"""A plotter shows what a new one shows, after any changes in any order."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable
from contextlib import ExitStack, closing
from functools import partial
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from case_counts import count_case
from hypothesis import strategies as st
from hypothesis.stateful import (
    RuleBasedStateMachine,
    initialize,
    precondition,
    rule,
    run_state_machine_as_test,
)
from scipy.ndimage import binary_erosion
from state_flows import APPEARANCE, FLOWS, LOOK, SETTING, TIMES, make_small
from strategies import property_test

import flowtex
from flowtex.errors import FieldError, Notice
from flowtex.plotting import component  # noqa: F401  which PyVista finds by its entry point
from flowtex.scene.options import Appearance
from flowtex.scene.scene import Scene
from flowtex.settings import Settings, SettingsError
from flowtex.textures.images import as_picture, load_image

SIZES = [(80, 60), (60, 64), (96, 48)]
GROUND = (255, 0, 255)  #: Background, a colour that no flow has here.
MOST_FLOWS = 2
APART = 2.3  #: Distance between two flows.
#: Greatest difference of a pixel: that of rounding in another order of operations.
ROUNDING = 2
BLACK = 12  #: Greatest value of a channel of a black pixel.
MORE_BLACK = 0.02  #: Share of pixels that may be black in one of two pictures alone.
LEAST_CONTRAST = 0.7  #: Contrast of a picture, as a share of that of another one.
BORDER = 2  #: Pixels along outlines, which are smooth in one picture alone.
FEW_PIXELS = 100
IMAGE = np.indices((8, 8)).sum(axis=0) % 2 * 1.0

pick = st.sampled_from
WHICH = st.integers(0, MOST_FLOWS - 1)


class Watch:
    """What is said and raised while a case runs, also in callbacks of VTK, which only prints it.

    What libraries compute with numbers that do not matter is ignored.
    """

    ALLOWED = "The surface is outside"

    def __init__(self) -> None:
        self._exits = ExitStack()
        self.said = self._exits.enter_context(warnings.catch_warnings(record=True))
        self._exits.enter_context(np.errstate(all="ignore"))
        warnings.simplefilter("always")
        self.raised: list[BaseException] = []
        self._hook = sys.excepthook
        sys.excepthook = lambda kind, error, trace: self.raised.append(error)

    def close(self) -> None:
        """Raise what was raised in a callback, or warned of."""
        sys.excepthook = self._hook
        self._exits.close()
        for error in self.raised:
            raise error
        texts = [str(each.message) for each in self.said if not isinstance(each.message, Notice)]
        assert [text for text in texts if not text.startswith(self.ALLOWED)] == []


def opened(size: tuple[int, int]) -> Any:
    plotter: Any = pv.Plotter(off_screen=True, window_size=list(size))
    plotter.disable_anti_aliasing()
    plotter.set_background(GROUND)
    return plotter


def shot(plotter: Any) -> Any:
    plotter.renderer.reset_camera_clipping_range()
    plotter.render()
    return np.asarray(plotter.screenshot(return_img=True), dtype=int)


def copy_camera(plotter: Any, to: Any) -> None:
    # VTK's camera keeps more than its attributes say: it may have been turned over a pole.
    to.camera.DeepCopy(plotter.camera)


def refusal(make: Callable[[], Any]) -> type[Exception] | None:
    """Return the error that a function raises because its arguments do not fit."""
    try:
        make()
    except (FieldError, SettingsError) as error:
        return type(error)
    return None


class Shown:
    """A flow on a plotter, and what was chosen for it."""

    def __init__(self, plotter: Any, name: str, place: float, *, first: bool) -> None:
        self.name, self.place = name, place
        self.look = Appearance.of(show_scalar_bar=False)
        self.settings = Settings()
        self.image: Any = None
        self.handle = plotter.flowtex.add(FLOWS[name](), show_scalar_bar=False, reset_camera=first)
        self.handle.actor.position = (place, 0, 0)

    def try_to(self, change: Callable[[], None], **wanted: Any) -> bool:
        """Make a change, which a scene raises an error for if a new one does; return whether."""
        state: dict[str, Any] = {"name": self.name, "look": self.look, "settings": self.settings}
        state |= wanted
        new = refusal(lambda: self.scene(**state))
        assert refusal(change) == new
        if new is None:
            vars(self).update(state)
        return new is None

    def scene(self, name: str, look: Appearance, settings: Settings) -> Scene:
        """Return a new scene."""
        image = None if self.image is None else as_picture(load_image(self.image))
        return Scene(FLOWS[name](), settings, look, image=image)

    @property
    def arguments(self) -> dict[str, Any]:
        """Arguments that show the same in a new picture."""
        look = {name: getattr(self.look, name) for name in APPEARANCE}
        if self.settings.noise == "image":
            look["image"] = self.image
        return {**dict(self.settings), **look}


class AnyOrder(RuleBasedStateMachine):
    """Flows on one plotter, and changes of them."""

    def __init__(self) -> None:
        super().__init__()
        self.watch = Watch()
        self.plotter = opened(SIZES[0])
        self.shown: list[Shown] = []
        self.is_rendered = False

    @initialize(name=pick(sorted(FLOWS)), is_rendered=st.booleans())
    def begin(self, name: str, *, is_rendered: bool) -> None:
        self.is_rendered = is_rendered
        self.add(name)

    def add(self, name: str) -> None:
        place = APART * any(each.place == 0 for each in self.shown)
        self.shown.append(Shown(self.plotter, name, place, first=not self.shown))

    @precondition(lambda self: len(self.shown) < MOST_FLOWS)
    @rule(name=pick(sorted(FLOWS)))
    def add_flow(self, name: str) -> None:
        self.add(name)

    def any_shown(self, which: int) -> Shown:
        return self.shown[which % len(self.shown)]

    @precondition(lambda self: self.shown)
    @rule(which=WHICH, time=pick([*TIMES, *TIMES, 0.2, 0.7, 0.9]))
    def set_time(self, which: int, time: float) -> None:
        self.any_shown(which).handle.time = time

    @precondition(lambda self: self.shown)
    @rule(which=WHICH, changes=st.lists(SETTING, min_size=1, max_size=3))
    def set_settings(self, which: int, changes: list[tuple[str, Any]]) -> None:
        shown = self.any_shown(which)
        for name, value in changes:
            settings = shown.settings.copy()
            settings.update(**{name: value})
            shown.try_to(partial(setattr, shown.handle.settings, name, value), settings=settings)

    @precondition(lambda self: self.shown)
    @rule(which=WHICH, changes=st.lists(LOOK, min_size=1, max_size=3))
    def set_look(self, which: int, changes: list[tuple[str, Any]]) -> None:
        shown = self.any_shown(which)
        for name, value in changes:
            look = shown.look.changed(**{name: value})
            shown.try_to(partial(setattr, shown.handle, name, value), look=look)

    @precondition(lambda self: self.shown)
    @rule(which=WHICH)
    def set_image(self, which: int) -> None:
        shown = self.any_shown(which)
        before, shown.image = shown.image, IMAGE
        settings = shown.settings.copy()
        settings.noise = "image"
        if not shown.try_to(partial(shown.handle.set_image, IMAGE), settings=settings):
            shown.image = before

    @precondition(lambda self: self.shown)
    @rule(which=WHICH, name=pick(sorted(FLOWS)))
    def set_surface(self, which: int, name: str) -> None:
        shown = self.any_shown(which)
        shown.try_to(partial(shown.handle.set_surface, FLOWS[name]()), name=name)

    @precondition(lambda self: self.shown)
    @rule(which=WHICH, clock=pick([0.0, 0.3, 5.0]))
    def set_clock(self, which: int, clock: float) -> None:
        self.any_shown(which).handle.clock = clock

    @precondition(lambda self: self.shown)
    @rule(which=WHICH, density=pick([1.0, 2.0]))
    def set_density(self, which: int, density: float) -> None:
        self.any_shown(which).handle.density = density

    @precondition(lambda self: self.shown)
    @rule(which=WHICH, edges=st.booleans())
    def set_edges(self, which: int, edges: bool) -> None:
        self.any_shown(which).handle.actor.prop.show_edges = edges
        self.plotter.render()

    @precondition(lambda self: self.shown)
    @rule(which=WHICH, how=pick(["handle", "handle", "actor", "actor", "clear"]))
    def remove(self, which: int, how: str) -> None:
        shown = self.any_shown(which)
        if how == "handle":
            shown.handle.remove()
        elif how == "actor":
            self.plotter.remove_actor(shown.handle.actor)
        else:
            self.plotter.flowtex.clear()
        self.shown = [each for each in self.shown if not each.handle.closed]

    @precondition(lambda self: self.shown)
    @rule(move=pick(["xy", "closer", "farther", "turn", "tilt", "parallel", "perspective", "pan"]))
    def move_camera(self, move: str) -> None:
        camera = self.plotter.camera
        if move == "xy":
            self.plotter.view_xy()
        elif move == "closer":
            camera.zoom(3.0)
        elif move == "farther":
            camera.zoom(0.4)
        elif move == "turn":
            camera.azimuth += 40
        elif move == "tilt":
            camera.elevation += 20
        elif move == "pan":
            for name in ("position", "focal_point"):
                setattr(camera, name, np.add(getattr(camera, name), [0.3, 0.0, 0.0]))
        else:
            camera.parallel_projection = move == "parallel"
        self.plotter.render()

    @rule(size=pick(SIZES))
    def resize(self, size: tuple[int, int]) -> None:
        self.plotter.window_size = list(size)
        self.plotter.render()

    def new_plotter(self) -> Any:
        """Return a new plotter in the same state."""
        plotter = opened(tuple(self.plotter.window_size))
        for each in self.shown:
            handle, shown = plotter.flowtex.add(FLOWS[each.name](), **each.arguments), each.handle
            handle.actor.position = (each.place, 0, 0)
            handle.actor.prop.show_edges = shown.actor.prop.show_edges
            handle.time, handle.clock, handle.density = shown.time, shown.clock, shown.density
        copy_camera(self.plotter, plotter)
        return plotter

    def teardown(self) -> None:
        with closing(self.watch), closing(self.plotter):
            picture = shot(self.plotter)
            with closing(self.new_plotter()) as new:
                expected = shot(new)
            np.testing.assert_allclose(picture, expected, atol=ROUNDING)
            if self.is_rendered and len(self.shown) == 1:
                self.check_inside(picture)
        count_case("state machine")

    def check_inside(self, picture: Any) -> None:
        """Compare black pixels, those of the background and the contrast with ``render``."""
        (shown,) = self.shown
        handle = shown.handle
        if shown.place or handle.density != 1 or handle.actor.prop.show_edges:
            return
        expected = np.asarray(
            flowtex.render(
                FLOWS[shown.name](),
                size=tuple(self.plotter.window_size),
                camera=self.plotter.camera,
                background=GROUND,
                time=handle.time,
                clock=handle.clock,
                **{**shown.arguments, "show_scalar_bar": False},
            ),
            dtype=int,
        )
        inside = binary_erosion((expected != GROUND).any(axis=-1), iterations=BORDER)
        pixels, others = picture[inside], expected[inside]
        if shown.look.show_scalar_bar is not False or len(pixels) < FEW_PIXELS:
            return
        assert (pixels != GROUND).any(axis=-1).all()
        black, other_black = ((each.max(axis=-1) < BLACK).mean() for each in (pixels, others))
        assert black <= other_black + MORE_BLACK
        assert pixels.std() >= LEAST_CONTRAST * others.std()


@pytest.mark.hypothesis
def test_any_order_of_changes_shows_what_a_new_plotter_does(
    opengl: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    make_small(monkeypatch.setattr)
    run_state_machine_as_test(AnyOrder, settings=property_test(6, fuzz=150, steps=12))
