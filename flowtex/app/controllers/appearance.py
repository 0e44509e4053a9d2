"""Appearance of the flow: settings, colours, background, and a second pane."""

from __future__ import annotations

from typing import Any

from flowtex._util.colours import CMAPS
from flowtex.app.controllers.context import Context, Controller, State
from flowtex.app.controllers.data import FileBeside
from flowtex.app.server.page import name_among, number
from flowtex.app.streaming.element import PAINTERS
from flowtex.app.streaming.viewport import BACKGROUNDS as THEMES
from flowtex.errors import FieldError
from flowtex.field.dates import time_text
from flowtex.scene.options import EARTH_LINES, SPEED, is_drawn
from flowtex.scene.options import Appearance as Look
from flowtex.settings import named_values

#: The choice of no colours.
PLAIN = "none"
#: Fields of the appearance that the page has under their names.
LOOK = ("cmap", "clim", "log_scale", "opacity", *EARTH_LINES)
#: Backgrounds.
BACKGROUNDS = ("theme", "black", "white", "gray")
#: Differences of a second pane, by label.
COMPARISONS: dict[str, dict[str, Any]] = {
    "nothing": {},
}
for _changes in (
    {"lod": False},
    {"kernel": "box"},
    {"two_sided": False},
    {"fixed_grain": True},
    {"samples": 10},
    {"show_level": True},
    {"lines": "pathlines"},
    {"lines": "streamlines"},
):
    COMPARISONS[named_values(_changes)] = _changes
ANOTHER_TIME = "Another time"  #: Label of a second pane at another time.
TIME = "Time: "  #: Word before the time of the second pane, in links.
STOPS_PER_STEP = 8  #: Stops of the slider of that time between two time steps.
#: Label of a second pane with another file, before its name.
FILE = "File: "
#: Label of a second pane with another scalar, before its name.
COLOUR_BY = "Colour by: "


def comparison(name: str) -> dict[str, Any]:
    """Return the differences of a second pane by its label, at another time with the time.

    There are none for another file, which is opened first.
    """
    if name.startswith(TIME):
        return {"time": float(name.removeprefix(TIME))}
    if name.startswith(COLOUR_BY):
        return {"scalars": name.removeprefix(COLOUR_BY)}
    if name.startswith(FILE):
        return {}
    return COMPARISONS[name]


def look_shown(look: Look) -> dict[str, Any]:
    """Return the appearance of a surface as the page shows it, with all values explicit."""
    shown = {name: getattr(look, name) for name in LOOK}
    for name in EARTH_LINES:
        shown[name] = is_drawn(shown[name])
    shown["cmap"] = look.cmap
    if not isinstance(look.cmap, str):  # a colour map without a name is shown as the first one
        shown["cmap"] = CMAPS[0]
    return shown


class Appearance(Controller):
    """Appearance of the flow, and of the flow of another file ``beside`` it."""

    def __init__(self, context: Context, beside: FileBeside) -> None:
        super().__init__(context)
        self.beside = beside
        #: The last valid choices of the page, which may send anything.
        self.theme = "dark"
        self.background = BACKGROUNDS[0]
        self.compared = "nothing"
        self.state.set(
            theme=self.theme,
            background=self.background,
            compare=self.compared,
            time_beside=0.0,
            moment_beside="",
            painter="",
        )
        self.show_field()
        on = self.state.on
        on(self.take_background, "theme", "background")
        on(self.take_comparison, "compare")
        on(self.take_time_beside, "time_beside")
        on(self.take_painter, "painter")
        context.field_changed.connect(self.show_field)
        self.area.painter_changed.connect(lambda: self.state.set(painter=self.area.painter))
        self.take_background()
        self.first = self.describe()  #: What a new page shows.
        self._first_look = self.area.scene.appearance

    def show_field(self) -> None:
        """Show the possible comparisons with the flow on the page."""
        comparisons = self._comparisons()
        times = self.viewport.field.times
        stops = max((len(times) - 1) * STOPS_PER_STEP, 1)
        first = float(times[0])
        last = float(times[-1])
        slider = {"time_first": first, "time_last": last, "time_stop": (last - first) / stops}
        self.state.set(comparisons=comparisons, **slider)
        self._show_time_beside()
        if self.compared not in comparisons:
            self.state.set(compare="nothing")
            self.take_comparison()

    def take_painter(self) -> None:
        """Draw by the painter that the page requests; the camera stays the same."""
        painter = self.state.get("painter")
        element = self.area
        if painter != element.painter and name_among(painter, PAINTERS):
            element.call("paint", painter)  # the page begins again with it
        else:
            self.state.set(painter=element.painter)

    def take_background(self) -> None:
        """Set the background that the page requests."""
        theme = self.state.get("theme")
        choice = self.state.get("background")
        if name_among(theme, THEMES):
            self.theme = theme
        if name_among(choice, BACKGROUNDS):
            self.background = choice
        self.state.set(theme=self.theme, background=self.background)
        if self.background == BACKGROUNDS[0]:
            self.viewport.set_background(self.theme)
        else:
            self.viewport.set_background(self.background)
        self.area.changed()

    def take_comparison(self) -> None:
        """Show or remove the second pane, as the page requests.

        Raises
        ------
        Exception
            When the second pane cannot be drawn; the page then shows the choice before.
        """
        choice = self.state.get("compare")
        if not name_among(choice, self._comparisons()):
            self.state.set(compare=self.compared)
        elif choice != self.compared:
            try:
                self.area.compare(self._differences(choice) or None)
            except Exception:
                self.state.set(compare=self.compared)
                raise
            self.compared = choice
            self.beside.end()
            if choice.startswith(FILE):
                self.beside.open(choice.removeprefix(FILE))
            self._show_time_beside()

    def _differences(self, choice: str) -> dict[str, Any]:
        """Return the differences of a second pane; another time begins with the first one."""
        if choice == ANOTHER_TIME:
            return {"time": float(self.viewport.field.times[0])}
        return comparison(choice)

    def take_time_beside(self) -> None:
        """Show the time that the page requests in the second pane."""
        times = self.viewport.field.times
        time = number(self.state.get("time_beside"), float(times[0]), float(times[-1]))
        if self.compared == ANOTHER_TIME and time not in (None, self.viewport.time_beside):
            self.viewport.time_beside = time
            self.area.changed()
        self._show_time_beside()

    def _show_time_beside(self) -> None:
        time = self.viewport.time_beside
        self.state.set(time_beside=time, moment_beside=time_text(self.viewport.field, time))

    def describe(self) -> State:
        """Return settings, colours, background and comparison."""
        scene = self.area.scene
        split = self.compared
        if split == ANOTHER_TIME:
            split = f"{TIME}{self.viewport.time_beside!r}"
        if self.area.clim is None and scene.has_own_range:
            clim = None
        else:
            clim = scene.scalar_limits
        return {
            "settings": dict(self.settings),
            "colour": self.area.scalars or PLAIN,
            **look_shown(scene.appearance),
            "clim": clim,
            "theme": self.theme,
            "background": self.background,
            "split": split,
        }

    def restore(self, saved: State) -> None:
        """Restore saved settings, colours, background and comparison; the others are the first."""
        present = self.describe()["settings"]
        settings = {**self.first["settings"], **saved.get("settings", {})}
        changed = {}
        for k, v in settings.items():
            if v not in ("image", present[k]):
                changed[k] = v
        self.settings.update(**changed)
        whole = {**self.first, **saved}
        split = whole["split"]
        wanted = split.removeprefix(TIME)
        is_time = wanted != split
        if is_time:
            split = ANOTHER_TIME
        self.state.set(compare=split, theme=whole["theme"], background=whole["background"])
        try:
            self.area.scene.appearance = self._look_of(saved)
        except FieldError as error:
            self.context.complain(error)
        self.take_background()
        self.take_comparison()
        if is_time:
            self.state.set(time_beside=float(wanted))
            self.take_time_beside()

    def _look_of(self, saved: State) -> Look:
        """Return a saved appearance, completed by the first one as far as it fits the flow."""
        look = {name: saved[name] for name in LOOK if name in saved}
        if not name_among(look.get("cmap"), CMAPS):
            look.pop("cmap", None)
        first_name = self.first["colour"]
        name = saved.get("colour", first_name)
        if not self._can_colour_by(name):
            name = first_name
        if not self._can_colour_by(name):
            name = SPEED
        if name != first_name:
            look = {"clim": None, **look, "scalars": name}
            if name == PLAIN:
                look["scalars"] = False
        return self._first_look.changed(**look)

    def _can_colour_by(self, name: Any) -> bool:
        """Return whether the flow has a scalar of a name, also a derived one, or it is PLAIN."""
        if not isinstance(name, str):
            return False
        if name == PLAIN or name in self.area.scene.scalar_names:
            return True
        try:
            self.area.scene.scalar_steps(name)
        except FieldError:
            return False
        return True

    def _comparisons(self) -> list[str]:
        """Return the names of all comparisons that the page offers for the present flow."""
        names = []
        for name, changes in COMPARISONS.items():
            if "lines" not in changes or not self.viewport.field.steady:
                names.append(name)
        if not self.viewport.field.steady:
            names.append(ANOTHER_TIME)
        names += [COLOUR_BY + name for name in self.area.scene.scalar_names]
        data = self.beside.data
        for name in data.names:
            if name != data.name:
                names.append(FILE + name)
        return names
