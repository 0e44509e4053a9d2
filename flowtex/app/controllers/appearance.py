"""How the flow is drawn: settings, colours, what is behind, and a second pane."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from flowtex._util.colours import CMAPS
from flowtex.app.controllers.context import Context, Controller
from flowtex.app.controllers.file_beside import FileBeside
from flowtex.app.server.page import start_task
from flowtex.app.server.validation import decode_picture, name_among, number, sent_picture
from flowtex.app.streaming.viewport import BACKGROUNDS as THEMES
from flowtex.errors import FieldError
from flowtex.offscreen.annotations import time_text
from flowtex.options import ROBUST
from flowtex.options import Appearance as Look
from flowtex.scene import Scene
from flowtex.settings import TABLE, SettingsError, named_values

#: The choice of no colours.
PLAIN = "none"
#: Lines of a map, where the field has a projection; and all of how a surface looks that the page
#: has under the name of the argument.
MAP_LINES = ("coastlines", "graticule")
LOOK = ("cmap", "clim", "log_scale", "opacity", *MAP_LINES)
#: What lies behind the surface.
BACKGROUNDS = ("theme", "black", "white", "gray")
#: What a second pane shows, by what it is called.
COMPARISONS: dict[str, dict[str, Any]] = {
    "nothing": {},
    **{
        named_values(changes): changes
        for changes in (
            {"lod": False},
            {"noise": "texture"},
            {"kernel": "box"},
            {"two_sided": False},
            {"fixed_grain": True},
            {"samples": 10},
            {"show_level": True},
        )
    },
}
#: The same for what is not a setting: another time, another file, and another scalar by its name.
ANOTHER_TIME, ANOTHER_FILE, COLOUR_BY = "Another time", "Another file", "Colour by: "
#: Greatest value at an end of the colour map: the distance of two is a number, too.
GREATEST_VALUE = 1e300


def comparison(name: str, time: float) -> dict[str, Any]:
    """Return what differs in a second pane of a name, at ``time`` for another time.

    It is nothing for another file, which has to be opened first.
    """
    if name == ANOTHER_TIME:
        return {"time": time}
    if name.startswith(COLOUR_BY):
        return {"scalars": name.removeprefix(COLOUR_BY)}
    if name == ANOTHER_FILE:
        return {}
    return COMPARISONS[name]


def look_shown(look: Look) -> dict[str, Any]:
    """Return how a surface looks as the page shows it, where nothing is left to choose later."""
    shown = {name: getattr(look, name) for name in LOOK}
    shown |= {name: shown[name] is not False for name in MAP_LINES}
    # A map that has no name here is shown as the first one.
    return {**shown, "cmap": look.cmap if isinstance(look.cmap, str) else CMAPS[0]}


class Appearance(Controller):
    """How the flow is drawn, and in a second pane with ``beside`` that of another file.

    Attributes
    ----------
    theme, background, compared
        What was chosen last of what the page may choose: a page may send anything.
    """

    def __init__(self, context: Context, beside: FileBeside) -> None:
        super().__init__(context)
        self.beside = beside
        self.theme, self.background, self.compared = "dark", BACKGROUNDS[0], "nothing"
        self._laying: asyncio.Task[None] | None = None
        self.state.set(
            theme=self.theme,
            background=self.background,
            compare=self.compared,
            time_beside=0.0,
            moment_beside="",
            bar_beside=None,
            image_file=None,
            set_noise_choices=self._noise_choices(),
        )
        self.show_field()
        on = self.state.on
        on(*(f"set_{name}" for name in TABLE))(self.take_settings)
        on("colour", "cmap", "log_scale", "opacity", *MAP_LINES)(self.take_colour)
        on("low", "high")(self.take_range)
        on("theme", "background")(self.take_background)
        on("compare")(self.take_comparison)
        on("time_beside")(self.take_time_beside)
        on("image_file")(self.take_image)
        context.field_changed.connect(self.show_field)
        context.area.appearance_changed.connect(self.show_colours)
        context.client_started.connect(self.end_comparison)
        context.beside_changed.connect(self.show_colours)
        self.take_background()

    def show_field(self) -> None:
        """Let the page show settings and colours of the flow that is shown."""
        scene, comparisons = self.area.scene, self._comparisons()
        names = [(name, scene.label_of(name)) for name in scene.scalar_names]
        choices = [{"value": name, "title": label} for name, label in (*names, (PLAIN, PLAIN))]
        self.state.set(colours=choices, comparisons=comparisons)
        if self.compared not in comparisons:
            self.end_comparison()
        self.show_settings()
        self.show_colours()

    def show_colours(self) -> None:
        """Let the page show the colours as they are."""
        area = self.area
        low, high = self._shown_span = self._span()
        self.state.set(
            colour=area.scalars or PLAIN,
            has_map=area.scene.field.projection is not None,
            **{n: v for n, v in look_shown(area.scene.appearance).items() if n != "clim"},
            bar=self._bar(self.area.scene),
            bar_beside=self._bar_beside(),
            low=low,
            high=high,
        )

    def take_settings(self) -> None:
        """Set what the page asks for, and tell it what is not possible."""
        settings = self.settings
        for name, present in settings:
            choice = self.state.get(f"set_{name}")
            if choice == present:
                continue
            try:
                settings.update(**{name: choice})
            except FieldError as error:
                self.context.complain(error)
                self.state.set(**{f"set_{name}": present})
                continue
            # A whole number comes back from the page as it was sent, not as the type it has here.
            self.state.set(**{f"set_{name}": getattr(settings, name)})
            if name in ("strength", "contrast", "noise"):
                self.state.set(bar=self._bar(self.area.scene), bar_beside=self._bar_beside())

    def take_setting(self, pair: Any) -> None:
        """Set what the browser's client has set by itself."""
        if isinstance(pair, list) and len(pair) == 2 and name_among(pair[0], TABLE):
            self.state.set(**{f"set_{pair[0]}": pair[1]})
            self.take_settings()

    def show_settings(self) -> None:
        """Let the page show the settings as they are."""
        self.state.set(**{f"set_{name}": value for name, value in self.settings})

    def take_colour(self) -> None:
        """Colour by what the page asks for, and draw lines of a map."""
        area, name = self.area, self.state.get("colour")
        shown = look_shown(area.scene.appearance)
        asked = {option: self.state.get(option) for option in shown}
        asked["opacity"] = number(asked["opacity"], 0, 1)
        changes = {
            option: value
            for option, value in asked.items()
            if value != shown[option] and isinstance(value, type(shown[option]))
        }
        if not name_among(changes.get("cmap"), CMAPS):
            changes.pop("cmap", None)
        if name_among(name, (PLAIN, *area.scene.scalar_names)) and name != (area.scalars or PLAIN):
            # A range is that of one scalar.
            changes |= {"scalars": False if name == PLAIN else name, "clim": None}
        if changes:
            self._change(**changes)
        self.show_colours()

    def take_range(self) -> None:
        """Let the colours go from and to what the page asks for."""
        low, high = (
            number(self.state.get(end), -GREATEST_VALUE, GREATEST_VALUE) for end in ("low", "high")
        )
        # It may be called for what Python set, when another plane is shown already.
        if (low, high) == self._shown_span:
            return
        if low is None or high is None or not low < high:
            span = f"{self.state.get('low')!r} to {self.state.get('high')!r}"
            self.context.complain(f"the colours go from {span}; expected a lower number first")
        elif self.area.scalars:
            self._change(clim=(low, high))
        self.show_colours()

    def choose_range(self, clim: Any = None) -> None:
        """Let the colours go from the least to the greatest value again, or leave some out."""
        self._change(clim=ROBUST if clim == ROBUST else None)

    def _change(self, **changes: Any) -> None:
        """Change the appearance, or tell why that cannot be."""
        try:
            self.area.scene.appearance = replace(self.area.scene.appearance, **changes)
        except FieldError as error:
            self.context.complain(error)

    def take_background(self) -> None:
        """Take the colour behind the surface that the page asks for."""
        theme, choice = self.state.get("theme"), self.state.get("background")
        self.theme = theme if name_among(theme, THEMES) else self.theme
        self.background = choice if name_among(choice, BACKGROUNDS) else self.background
        self.state.set(theme=self.theme, background=self.background)
        themed = self.background == BACKGROUNDS[0]
        self.viewport.set_background(self.theme if themed else self.background)
        self.stream.changed()

    def take_comparison(self) -> None:
        """Show a second pane, or one again."""
        choice = self.state.get("compare")
        if not name_among(choice, self._comparisons()):
            self.state.set(compare=self.compared)
        elif choice != self.compared:
            if choice != "nothing":
                self.context.comparison_started.emit()
            try:
                self.area.compare(comparison(choice, self._first_time) or None)
            except Exception:
                self.state.set(compare=self.compared)
                raise
            self.compared = choice
            self.beside.end()
            if choice == ANOTHER_FILE:
                self.beside.begin()
            self.state.set(bar_beside=self._bar_beside())
            self._show_time_beside()

    def take_time_beside(self) -> None:
        """Show another time in the second pane."""
        time = number(self.state.get("time_beside"))
        if self.compared == ANOTHER_TIME and time not in (None, self.viewport.time_beside):
            self.viewport.time_beside = time
            self.stream.changed()
        self._show_time_beside()

    def _show_time_beside(self) -> None:
        time = self.viewport.time_beside
        self.state.set(time_beside=time, moment_beside=time_text(self.viewport.field, time))

    def end_comparison(self) -> None:
        """Show one pane again."""
        self.state.set(compare="nothing")
        self.take_comparison()

    def take_image(self) -> None:
        """Lay a picture of the person's own on the surface."""
        upload = self.state.get("image_file")
        if upload is None:
            return
        self.state.set(image_file=None)
        upload = upload[0] if isinstance(upload, list) and upload else upload
        if not upload:  # a choice that was taken back
            return
        try:
            picture = sent_picture(upload)
        except SettingsError as error:
            self.context.complain(error)
            return
        self.close()  # the latest picture counts
        self._laying = start_task(self._lay(*picture), "a picture could not be laid on the surface")

    async def _lay(self, content: bytes, name: str) -> None:
        try:
            self.viewport.lay_image(await asyncio.to_thread(decode_picture, content, name))
        except SettingsError as error:
            self.context.complain(error)
            return
        self.settings.update(noise="image", strength=1.0)
        self.show_settings()
        self.state.send(set_noise_choices=self._noise_choices())

    def close(self) -> None:
        """Wait for no picture any more."""
        if self._laying is not None:
            self._laying.cancel()

    def describe(self) -> dict[str, Any]:
        """Return settings, colours, background and comparison."""
        return {
            "settings": dict(self.settings),
            "colour": self.area.scalars or PLAIN,
            **look_shown(self.area.scene.appearance),
            "clim": None if self.area.clim is None else self.area.scene.scalar_limits,
            "theme": self.theme,
            "background": self.background,
            "split": self.compared,
            "time_beside": self.viewport.time_beside if self.compared == ANOTHER_TIME else None,
        }

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Take over saved settings, colours, background and comparison."""
        settings = {k: v for k, v in saved.get("settings", {}).items() if v != "image"}
        self.settings.update(**settings)
        self.show_settings()
        names = {"split": "compare", "theme": "theme", "background": "background"}
        self.state.set(**{ours: saved[name] for name, ours in names.items() if name in saved})
        look = {name: saved[name] for name in LOOK if name in saved}
        if not name_among(look.get("cmap"), CMAPS):
            look.pop("cmap", None)
        if name_among(name := saved.get("colour"), (PLAIN, *self.area.scene.scalar_names)):
            look = {"clim": None, **look, "scalars": False if name == PLAIN else name}
        self._change(**look)
        self.show_colours()
        self.take_background()
        self.take_comparison()
        if saved.get("time_beside") is not None:
            self.state.set(time_beside=saved["time_beside"])
            self.take_time_beside()

    @property
    def _first_time(self) -> float:
        return float(self.viewport.field.times[0])

    def _comparisons(self) -> list[str]:
        """Return what a second pane can show of the present flow."""
        others = [] if self.viewport.field.steady else [ANOTHER_TIME]
        others += [ANOTHER_FILE] if self.beside.possible else []
        return [*COMPARISONS, *others, *(COLOUR_BY + name for name in self.area.scene.scalar_names)]

    def _bar_beside(self) -> dict[str, Any] | None:
        """Return the colour bar of a second pane that has one of its own."""
        first, *others = (pane.handle.scene for pane in self.viewport.panes)
        tells = [(s.scalar_name, s.scalar_name and s.legend_limits) for s in (first, *others)]
        return self._bar(others[0]) if len(set(tells)) > 1 else None

    def _noise_choices(self) -> list[str]:
        """Kinds of noise to choose from; an image only where there is one."""
        has_image = self.viewport.handle.scene.image is not None
        return [kind for kind in TABLE["noise"].choices if has_image or kind != "image"]

    def _span(self) -> tuple[float, float]:
        """Return the ends of the range as the page shows them, with four digits."""
        low, high = self.area.scene.legend_limits
        return float(f"{low:.4g}"), float(f"{high:.4g}")

    def _bar(self, scene: Scene) -> dict[str, Any]:
        name = scene.scalar_name
        if name is None:
            return {"name": "", "low": "", "high": "", "stops": []}
        low, high = scene.legend_limits
        return {
            "name": scene.title_of(name),
            "low": f"{low:.3g}",
            "high": f"{high:.3g}",
            "stops": self.viewport.colour_stops(scene),
        }
