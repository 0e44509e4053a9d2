"""How the flow is drawn: settings, colours, what is behind, and a second pane."""

from __future__ import annotations

import io
from collections.abc import Mapping
from typing import Any

from flowtex.app.part import Part
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
#: Bytes of an image that is sent, at most.
LARGEST_IMAGE = 8_000_000


class Look(Part):
    """How the flow is drawn."""

    def values(self) -> dict[str, Any]:
        """Return what the page begins with."""
        return {
            "theme": "dark",
            "background": BACKGROUNDS[0],
            "compare": "nothing",
            "comparisons": list(COMPARISONS),
            "colour": self.scene.colour or PLAIN,
            "colours": [*self.scene.colours, PLAIN],
            "cmap": self.scene.cmap if isinstance(self.scene.cmap, str) else CMAPS[0],
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
        if isinstance(pair, list) and len(pair) == 2 and pair[0] in TABLE:
            self.state.set(**{f"set_{pair[0]}": pair[1]})
            self.take_settings()

    def show_settings(self) -> None:
        """Let the page show the settings as they are."""
        self.state.set(**{f"set_{name}": value for name, value in self.area.settings})

    def take_colour(self) -> None:
        """Colour by what the page asks for."""
        wanted, cmap = self.state.get("colour"), self.state.get("cmap")
        name = "" if wanted == PLAIN else str(wanted)
        if name not in ("", *self.scene.colours) or cmap not in (*CMAPS, self.scene.cmap):
            self.state.set(colour=self.scene.colour or PLAIN, cmap=self.scene.cmap)
            return
        if (name, cmap) != (self.scene.colour, self.scene.cmap):
            self.scene.colour_by(name, cmap=cmap)
            self._show_range()
            self.area.stream.changed()

    def take_range(self) -> None:
        """Let the colours go from and to what the page asks for."""
        try:
            low, high = float(self.state.get("low")), float(self.state.get("high"))
        except (TypeError, ValueError):
            low = high = float("nan")
        if (low, high) == self._span():
            return
        if not low < high < float("inf") or low == float("-inf"):
            self.app.complain(
                f"the colours go from {low:g} to {high:g}; expected a lower number first"
            )
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
        wanted = self.state.get("background")
        themed = wanted not in BACKGROUNDS[1:]
        self.scene.set_background(self.state.get("theme") if themed else wanted)
        self.area.stream.changed()

    def take_comparison(self) -> None:
        """Show a second pane, or one again."""
        changes = COMPARISONS.get(self.state.get("compare"))
        if changes is None:
            self.state.set(compare="nothing")
        elif changes != self.scene.beside:
            self.area.compare(changes or None)

    def take_image(self) -> None:
        """Lay a picture of the person's own on the surface."""
        sent = self.state.get("image_file")
        sent = sent[0] if isinstance(sent, list) and sent else sent
        if not sent:
            return
        self.state.set(image_file=None)
        try:
            for pane in self.scene.panes:
                pane.handle.set_image(_decoded(sent))
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
            "cmap": self.state.get("cmap"),
            "clim": self.scene.chosen_range,
            "theme": self.state.get("theme"),
            "background": self.state.get("background"),
            "split": self.state.get("compare"),
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

    def _noises(self) -> list[str]:
        """Kinds of noise to choose from; an image only where there is one."""
        there = self.scene.handle.view.image is not None
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


def _decoded(sent: Any) -> Any:
    """Read a picture that a page has sent.

    Raises
    ------
    SettingsError
        When it is too large, or no picture.
    """
    from flowtex.image_files import read_image

    content = sent.get("content") if isinstance(sent, Mapping) else None
    if isinstance(content, list):
        content = b"".join(part for part in content if isinstance(part, bytes))
    name = str(sent.get("name", "the picture")) if isinstance(sent, Mapping) else "the picture"
    if not isinstance(content, bytes) or not content:
        msg = f"{name}: did not arrive; expected a PNG or a JPEG"
        raise SettingsError(msg)
    if len(content) > LARGEST_IMAGE:
        msg = f"{name}: has {len(content) / 1e6:.1f} MB; expected {LARGEST_IMAGE / 1e6:g} at most"
        raise SettingsError(msg)
    return read_image(io.BytesIO(content), name)
