"""How the flow is drawn: settings, colours, what is behind, and a second pane."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flowtex.app.controllers.part import Part
from flowtex.app.server.untrusted import name_among, number
from flowtex.app.server.uploads import decoded
from flowtex.app.streaming.scene import BACKGROUNDS as THEMES
from flowtex.errors import FieldError
from flowtex.settings import TABLE, SettingsError

__all__ = ["BACKGROUNDS", "CMAPS", "COMPARISONS", "PLAIN", "Look"]

#: The choice of no colours.
PLAIN = "none"
#: Colour maps to choose from: even steps of lightness first, those that diverge after them.
CMAPS = (
    "viridis",
    "cividis",
    "magma",
    "inferno",
    "plasma",
    "gray",
    "Blues_r",
    "YlGnBu_r",
    "turbo",
    "coolwarm",
    "RdBu_r",
    "twilight",
)
#: What lies behind the surface.
BACKGROUNDS = ("theme", "black", "white", "gray")
#: What a second pane shows, by what it is called.
COMPARISONS: dict[str, dict[str, Any]] = {
    "nothing": {},
    "level of detail off": {"lod": False},
    "the paper's noise": {"noise": "texture"},
    "the paper's kernel": {"kernel": "box", "two_sided": False, "samples": 12},
    "grain fixed on the surface": {"fixed_grain": True},
    "10 samples": {"samples": 10},
    "levels in colour": {"show_level": True},
}
#: Greatest value at an end of the colour map: the distance of two is a number, too.
WIDEST = 1e300


class Look(Part):
    """How the flow is drawn.

    Parameters
    ----------
    app
        The application.

    Attributes
    ----------
    theme, background, compared
        What was chosen last of what the page may choose: a page may say anything.
    """

    def __init__(self, app: Any) -> None:
        super().__init__(app)
        self.theme, self.background, self.compared = "dark", BACKGROUNDS[0], "nothing"

    def values(self) -> dict[str, Any]:
        """Return what the page begins with."""
        return {
            "theme": self.theme,
            "background": self.background,
            "compare": self.compared,
            "comparisons": list(COMPARISONS),
            "colour": self.scene.colour or PLAIN,
            "colours": [*self.scene.colours, PLAIN],
            "cmap": self._cmap(),
            "low": self._span()[0],
            "high": self._span()[1],
            "bar": self._bar(),
            "image_file": None,
            "set_noise_choices": self._noises(),
            **{f"set_{name}": value for name, value in self.area.settings},
        }

    def watch(self) -> None:
        """Listen to the page."""
        on = self.state.on
        on(*(f"set_{name}" for name in TABLE))(self.take_settings)
        on("colour", "cmap")(self.take_colour)
        on("low", "high")(self.take_range)
        on("theme", "background")(self.take_background)
        on("compare")(self.take_comparison)
        on("image_file")(self.take_image)
        self.take_background()

    def refresh(self) -> None:
        """Follow another flow that is shown."""
        self.state.set(colours=[*self.scene.colours, PLAIN], colour=self.scene.colour or PLAIN)
        self.show_settings()
        self._show_range()

    def take_settings(self) -> None:
        """Set what the page asks for, and tell it what is not possible."""
        settings = self.area.settings
        for name, present in settings:
            wanted = self.state.get(f"set_{name}")
            if wanted == present:
                continue
            try:
                settings.update(**{name: wanted})
            except (SettingsError, FieldError) as error:
                self.app.complain(error)
                self.state.set(**{f"set_{name}": present})
                continue
            # A whole number comes back from the page as it was sent, not as the type it has here.
            self.state.set(**{f"set_{name}": getattr(settings, name)})

    def take_setting(self, pair: Any) -> None:
        """Set what the browser's client has set by itself."""
        if isinstance(pair, list) and len(pair) == 2 and name_among(pair[0], TABLE):
            self.state.set(**{f"set_{pair[0]}": pair[1]})
            self.take_settings()

    def show_settings(self) -> None:
        """Let the page show the settings as they are."""
        self.state.set(**{f"set_{name}": value for name, value in self.area.settings})

    def take_colour(self) -> None:
        """Colour by what the page asks for."""
        wanted, cmap = self.state.get("colour"), self.state.get("cmap")
        known = name_among(wanted, (PLAIN, *self.scene.colours))
        if not known or not name_among(cmap, (*CMAPS, self._cmap())):
            self.state.set(colour=self.scene.colour or PLAIN, cmap=self._cmap())
            return
        name = "" if wanted == PLAIN else wanted
        if (name, cmap) != (self.scene.colour, self._cmap()):
            self.scene.colour_by(name, cmap=None if cmap == self._cmap() else cmap)
            self._show_range()
            self.area.stream.changed()

    def take_range(self) -> None:
        """Let the colours go from and to what the page asks for."""
        low, high = (number(self.state.get(end), -WIDEST, WIDEST) for end in ("low", "high"))
        if (low, high) == self._span():
            return
        if low is None or high is None or not low < high:
            told = f"{self.state.get('low')!r} to {self.state.get('high')!r}"
            self.app.complain(f"the colours go from {told}; expected a lower number first")
        if low is None or high is None or not low < high or not self.scene.colour:
            self._show_range()
            return
        self.scene.colour_by(self.scene.colour, clim=(low, high))
        self._show_range()
        self.area.stream.changed()

    def forget_range(self) -> None:
        """Let the colours go from the least to the greatest value again."""
        self.scene.forget_range()
        self._show_range()
        self.area.stream.changed()

    def take_background(self) -> None:
        """Take the colour behind the surface that the page asks for."""
        theme, wanted = self.state.get("theme"), self.state.get("background")
        self.theme = theme if name_among(theme, THEMES) else self.theme
        self.background = wanted if name_among(wanted, BACKGROUNDS) else self.background
        self.state.set(theme=self.theme, background=self.background)
        themed = self.background == BACKGROUNDS[0]
        self.scene.set_background(self.theme if themed else self.background)
        self.area.stream.changed()

    def take_comparison(self) -> None:
        """Show a second pane, or one again."""
        wanted = self.state.get("compare")
        if not name_among(wanted, COMPARISONS):
            self.state.set(compare=self.compared)
        elif wanted != self.compared:
            self.compared = wanted
            if wanted != "nothing":  # the browser's client draws one view
                self.app.browser.leave()
            self.area.compare(COMPARISONS[wanted] or None)

    def take_image(self) -> None:
        """Lay a picture of the person's own on the surface."""
        sent = self.state.get("image_file")
        if sent is None:
            return
        self.state.set(image_file=None)
        sent = sent[0] if isinstance(sent, list) and sent else sent
        if not sent:  # a choice that was taken back
            return
        try:
            self.scene.lay_image(decoded(sent))
        except SettingsError as error:
            self.app.complain(error)
            return
        self.area.settings.update(noise="image", strength=1.0)
        self.state.set(set_noise_choices=self._noises())
        self.show_settings()

    def describe(self) -> dict[str, Any]:
        """Return what a link needs to know."""
        return {
            "settings": dict(self.area.settings),
            "colour": self.scene.colour or PLAIN,
            "cmap": self._cmap(),
            "clim": self.scene.chosen_range,
            "theme": self.theme,
            "background": self.background,
            "split": self.compared,
        }

    def restore(self, said: Mapping[str, Any]) -> None:
        """Take over what a link says."""
        settings = {k: v for k, v in said.get("settings", {}).items() if v != "image"}
        self.area.settings.update(**settings)
        self.show_settings()
        names = {"colour": "colour", "cmap": "cmap", "theme": "theme", "split": "compare"}
        names["background"] = "background"
        self.state.set(**{ours: said[name] for name, ours in names.items() if name in said})
        self.take_colour()
        if said.get("clim"):
            low, high = said["clim"]
            self.state.set(low=low, high=high)
            self.take_range()
        self.take_background()
        self.take_comparison()

    def _cmap(self) -> str:
        """Name of the colour map; the first one for a map that has no name here."""
        return self.scene.cmap if isinstance(self.scene.cmap, str) else CMAPS[0]

    def _noises(self) -> list[str]:
        """Kinds of noise to choose from; an image only where there is one."""
        there = self.scene.handle.scene.image is not None
        return [kind for kind in TABLE["noise"].choices if there or kind != "image"]

    def _span(self) -> tuple[float, float]:
        """Return the ends of the range as the page shows them, with four digits."""
        low, high = self.scene.colour_range
        return float(f"{low:.4g}"), float(f"{high:.4g}")

    def _show_range(self) -> None:
        low, high = self._span()
        self.state.set(bar=self._bar(), low=low, high=high)

    def _bar(self) -> dict[str, Any]:
        if not self.scene.colour:
            return {"name": "", "low": "", "high": "", "stops": []}
        low, high = self.scene.colour_range
        return {
            "name": self.scene.colour,
            "low": f"{low:.3g}",
            "high": f"{high:.3g}",
            "stops": self.scene.colour_stops(),
        }
