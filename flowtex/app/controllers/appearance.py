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
from flowtex.app.streaming.element import PAINTERS
from flowtex.app.streaming.viewport import BACKGROUNDS as THEMES
from flowtex.errors import FieldError
from flowtex.plotting.offscreen.annotations import time_text
from flowtex.scene.options import Appearance as Look
from flowtex.settings import SettingsError, named_values

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
#: Stops of the slider of another time between two steps of the field.
STOPS_PER_STEP = 8


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
    """How the flow is drawn, and in a second pane with ``beside`` that of another file."""

    def __init__(self, context: Context, beside: FileBeside) -> None:
        super().__init__(context)
        self.beside = beside
        #: What was chosen last of what the page may choose: a page may send anything.
        self.theme, self.background, self.compared = "dark", BACKGROUNDS[0], "nothing"
        self._laying: asyncio.Task[None] | None = None
        self.state.set(
            theme=self.theme,
            background=self.background,
            compare=self.compared,
            time_beside=0.0,
            moment_beside="",
            image_file=None,
            painter="",
        )
        self.show_field()
        on = self.state.on
        on("theme", "background")(self.take_background)
        on("compare")(self.take_comparison)
        on("time_beside")(self.take_time_beside)
        on("image_file")(self.take_image)
        on("painter")(self.take_painter)
        context.field_changed.connect(self.show_field)
        self.area.element.painter_changed.connect(
            lambda: self.state.set(painter=self.area.element.painter)
        )
        self.take_background()

    def show_field(self) -> None:
        """Let the page show what may stand beside the flow that is shown."""
        times, comparisons = self.viewport.field.times, self._comparisons()
        first, last = float(times[0]), float(times[-1])
        tick = (last - first) / max((len(times) - 1) * STOPS_PER_STEP, 1)
        self.state.set(comparisons=comparisons, first=first, last=last, tick=tick)
        if self.compared not in comparisons:
            self.end_comparison()

    def take_painter(self) -> None:
        """Let draw whom the page asks for; the camera stays the same."""
        painter, element = self.state.get("painter"), self.area.element
        if painter != element.painter and name_among(painter, PAINTERS):
            element.draw_by(painter)
        else:
            self.state.set(painter=element.painter)

    def _change(self, **changes: Any) -> None:
        """Change the appearance, or report why that is not possible."""
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
        self.area.changed()

    def take_comparison(self) -> None:
        """Show a second pane, or one again."""
        choice = self.state.get("compare")
        if not name_among(choice, self._comparisons()):
            self.state.set(compare=self.compared)
        elif choice != self.compared:
            try:
                self.area.compare(comparison(choice, self._first_time) or None)
            except Exception:
                self.state.set(compare=self.compared)
                raise
            self.compared = choice
            self.beside.end()
            if choice == ANOTHER_FILE:
                self.beside.begin()
            self._show_time_beside()

    def take_time_beside(self) -> None:
        """Show another time in the second pane."""
        time = number(self.state.get("time_beside"))
        if self.compared == ANOTHER_TIME and time not in (None, self.viewport.time_beside):
            self.viewport.time_beside = time
            self.area.changed()
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
        self._laying = start_task(
            self._lay(*picture), "an image could not be applied to the surface"
        )

    async def _lay(self, content: bytes, name: str) -> None:
        try:
            self.viewport.lay_image(await asyncio.to_thread(decode_picture, content, name))
        except SettingsError as error:
            self.context.complain(error)
            return
        self.settings.update(noise="image", strength=1.0)
        self.area.changed()

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
        names = {"split": "compare", "theme": "theme", "background": "background"}
        self.state.set(**{ours: saved[name] for name, ours in names.items() if name in saved})
        look = {name: saved[name] for name in LOOK if name in saved}
        if not name_among(look.get("cmap"), CMAPS):
            look.pop("cmap", None)
        if name_among(name := saved.get("colour"), (PLAIN, *self.area.scene.scalar_names)):
            look = {"clim": None, **look, "scalars": False if name == PLAIN else name}
        self._change(**look)
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
