"""Where the camera stands: the keyboard, views to choose from, the scale bar, and the figures."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from typing import Any

from flowtex.app.controllers.part import Part
from flowtex.app.server.untrusted import name_among
from flowtex.app.streaming.aim import within_reach
from flowtex.app.streaming.canvas import checked_camera
from flowtex.app.streaming.stream import Figures
from flowtex.first_look import first_look

__all__ = ["KEYS", "VIEWS", "Moves"]

#: Directions from which a surface can be looked at, and what is up then.
VIEWS: dict[str, tuple[tuple[float, float, float], tuple[float, float, float]]] = {
    "from +x": ((1, 0, 0), (0, 0, 1)),
    "from -x": ((-1, 0, 0), (0, 0, 1)),
    "from +y": ((0, 1, 0), (0, 0, 1)),
    "from -y": ((0, -1, 0), (0, 0, 1)),
    "from +z": ((0, 0, 1), (0, 1, 0)),
    "from -z": ((0, 0, -1), (0, 1, 0)),
}
#: What the keyboard does, as the page's help tells it.
KEYS = {
    "arrows": "pan",
    "+ and -": "zoom",
    "space": "play or pause",
    ", and .": "a step back or on",
    "0": "the whole surface",
    "d": "level of detail on or off",
    "t": "light or dark",
    "f": "full screen",
    "Esc": "close what is open",
}
#: Share of the view that an arrow pans, and factor by which a key zooms.
PAN, ZOOM = 0.2, 1.3
#: Seconds between two changes of the figures at the foot of the page.
FIGURES_EVERY = 0.5
#: Shares of the view's width that a scale bar may have.
SHORTEST_BAR, LONGEST_BAR = 0.05, 0.125
LIMITS = {
    "drawing": "limited by drawing",
    "encoding": "limited by compression",
    "network": "limited by the network",
    "nothing": "",
}


class Moves(Part):
    """Where the camera stands.

    Parameters
    ----------
    app
        The application.

    Attributes
    ----------
    moving
        Whether the last picture was one in motion.
    """

    def __init__(self, app: Any) -> None:
        super().__init__(app)
        self.moving = False
        self._told, self._sharp = 0.0, 0

    def values(self) -> dict[str, Any]:
        """Return what the page begins with."""
        return {"picture": "waiting", "sharp": 0, "figures": "", "scale": self._scale()}

    def watch(self) -> None:
        """Listen to the stream."""
        self.area.reports.append(self.report)

    def refresh(self) -> None:
        """Follow another flow that is shown."""
        self.state.set(scale=self._scale(), views=self.views)

    @property
    def views(self) -> list[str]:
        """Directions that make sense: all of them for a surface that is not flat."""
        return [] if self.scene.flat else list(VIEWS)

    def look_from(self, name: Any) -> None:
        """Look at the whole of a curved surface from a side."""
        if not name_among(name, VIEWS):
            return
        toward, up = VIEWS[name]
        self.scene.home()
        aspect = self.scene.navigator.aspect
        self.scene.canvas.place(first_look(self.scene.field, aspect, toward=toward, up=up))
        self.scene.navigator.settle()
        self.area.stream.moved()

    def command(self, name: Any) -> None:
        """Do what a key asks for."""
        if not isinstance(name, str):
            return
        navigator = self.scene.navigator
        pans = {"left": (-1, 0), "right": (1, 0), "up": (0, 1), "down": (0, -1)}
        if name in pans:
            navigator.pan(PAN * pans[name][0], PAN * pans[name][1])
        elif name in ("closer", "farther"):
            navigator.zoom_by(ZOOM if name == "closer" else 1 / ZOOM)
        elif name == "whole":
            self.scene.home()
        elif name == "detail":
            self.area.settings.lod = not self.area.settings.lod
            self.state.set(set_lod=self.area.settings.lod)
        elif name in ("next", "previous"):
            self.app.clockwork.step(1 if name == "next" else -1)
        self.area.stream.moved()

    def report(self, figures: Figures) -> None:
        """Tell the page how the stream is doing, a few times in a second."""
        now = time.perf_counter()
        turned = figures.sharp or not self.moving
        self.moving = not figures.sharp
        if not turned and now - self._told < FIGURES_EVERY:
            return
        self._told = now
        width, height = figures.size
        words = [
            "" if figures.sharp or figures.rate < 2 else f"{figures.rate} fps",
            f"{1000 * figures.seconds:.0f} ms",
            "" if figures.sharp else LIMITS[figures.limit],
            f"{width} × {height}",
            self._zoom(),
        ]
        self.state.send(
            picture="sharp" if figures.sharp else "moving",
            sharp=self._counted(figures.sharp),
            figures=" · ".join(word for word in words if word),
            scale=self._scale(),
        )

    def show_sharp(self, figures: str) -> None:
        """Let the page tell that the full picture is there, and what it took."""
        self.moving = False
        self.state.send(picture="sharp", sharp=self._counted(True), figures=figures)

    def _counted(self, sharp: bool) -> int:  # noqa: FBT001 one more, or not
        self._sharp += int(sharp)
        return self._sharp

    def show_scale(self) -> None:
        """Let the page show the scale bar as it is."""
        self.state.send(scale=self._scale())

    def describe(self) -> dict[str, Any]:
        """Return what a link needs to know."""
        return {"camera": self.scene.canvas.camera()}

    def restore(self, said: Mapping[str, Any]) -> None:
        """Take over what a link says."""
        if said.get("camera"):
            self.take_camera(said["camera"])
            self.area.stream.moved()

    def take_camera(self, camera: Any) -> bool:
        """Take a camera that somebody sent; tells whether it is one that sees something."""
        try:
            made = checked_camera(camera, self.scene.canvas.camera())
        except ValueError:
            return False
        good = within_reach(made, self.scene.field.surface)
        if good:
            self.scene.look(made)
        return good

    def _zoom(self) -> str:
        zoom = self.scene.navigator.zoom
        return f"zoom {zoom:.3g}" if zoom < 1000 else f"zoom {zoom:,.0f}"

    def _scale(self) -> dict[str, Any]:
        """Length of a scale bar: its text, and its share of the view's width in percent."""
        navigator = self.scene.navigator
        across = 2 * navigator.height * navigator.aspect * len(self.scene.panes)
        length = round_length(LONGEST_BAR * across)
        unit = self.scene.field.length_unit
        return {
            "text": f"{length:.12g} {singular(unit) if length == 1 else unit}".strip(),
            "width": round(100 * length / across, 3) if across > 0 else 0,
        }


def singular(unit: str) -> str:
    """Return the name of one unit where it is a whole word in the plural, such as metres."""
    plural = len(unit) > 4 and unit.endswith("s") and not unit.endswith(("ss", "ches"))
    return unit[:-1] if plural else unit


def round_length(most: float) -> float:
    """Return the greatest of 1, 2, 5, 10, 20, ... that is not above a length."""
    if not (most > 0 and math.isfinite(most)):
        return 0.0
    power = 10.0 ** math.floor(math.log10(most))
    return max(step * power for step in (1, 2, 5) if step * power <= most * (1 + 1e-12))
