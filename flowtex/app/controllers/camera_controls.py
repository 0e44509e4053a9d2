"""Controls of the camera: the keyboard, views to choose from, the scale bar, and the figures."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

from flowtex.app.controllers.context import Context, Controller
from flowtex.app.server.validation import name_among, number
from flowtex.app.streaming.free_part import Cover
from flowtex.app.streaming.stream import Figures
from flowtex.offscreen.annotations import length_text, map_scale, round_length
from flowtex.settings import TABLE

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
    "d": f"{TABLE['lod'].label.lower()} on or off",
    "t": "light or dark",
    "f": "full screen",
    "Esc": "close what is open",
}
#: Share of the view that an arrow pans, and factor by which a key zooms.
KEY_PAN, KEY_ZOOM = 0.2, 1.3
#: Directions of the arrows.
PANS = {"left": (-1, 0), "right": (1, 0), "up": (0, 1), "down": (0, -1)}
#: Seconds between two changes of the figures at the foot of the page.
FIGURES_INTERVAL_S = 0.5
#: Greatest share of the view's width that a scale bar may have.
SCALE_BAR_WIDTH = 0.125
#: Panels that a page may tell of, at most.
MOST_COVERS = 12
#: What the page says that limits the rate of pictures.
LIMITS = {
    "drawing": "limited by drawing",
    "encoding": "limited by compression",
    "network": "limited by the network",
    "nothing": "",
}


class CameraControls(Controller):
    """What moves the camera besides the mouse, and what the page tells about the view."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._moving = False
        self._figures_at, self._sharp_count = 0.0, 0
        self.state.set(
            picture="waiting", sharp=0, figures="", scale=self._scale(), views=self.views
        )
        context.frame_due.connect(lambda: self.state.send(picture="moving"))
        context.frame_drawn.connect(self.show_figures)
        context.frame_drawn_in_browser.connect(self.show_browser_figures)
        context.camera_changed.connect(lambda: self.state.send(scale=self._scale()))
        context.field_changed.connect(lambda: self.state.set(scale=self._scale(), views=self.views))

    @property
    def views(self) -> list[str]:
        """Directions that make sense: all of them for a surface that is not flat."""
        return [] if self.viewport.flat else list(VIEWS)

    def look_from(self, name: Any) -> None:
        """Look at the whole of a curved surface from a side."""
        if name_among(name, VIEWS):
            toward, up = VIEWS[name]
            self.viewport.home(toward=toward, up=up)
            self.stream.moved()

    def take_covers(self, covers: Any) -> None:
        """Fit the surface to what the page's panels leave free, while nobody has moved it."""
        edges = [_edges(cover) for cover in covers] if isinstance(covers, list) else []
        checked = tuple(cover for cover in edges[:MOST_COVERS] if cover is not None)
        if checked == self.viewport.covers:
            return
        at_home = self.viewport.at_home
        self.viewport.covers = checked
        if at_home:
            self.viewport.refit()
            self.stream.moved()

    def command(self, name: Any) -> None:
        """Do what a key asks for."""
        if not isinstance(name, str):
            return
        if name in PANS:
            x, y = PANS[name]
            self.viewport.pan(KEY_PAN * x, KEY_PAN * y)
        elif name in ("closer", "farther"):
            self.viewport.zoom_by(KEY_ZOOM if name == "closer" else 1 / KEY_ZOOM)
        elif name == "whole":
            self.viewport.home()
        elif name == "detail":
            self.settings.lod = not self.settings.lod
            self.state.set(set_lod=self.settings.lod)
        elif name in ("next", "previous"):
            self.context.step_requested.emit(1 if name == "next" else -1)
        self.stream.moved()

    def show_figures(self, figures: Figures) -> None:
        """Let the page show how the stream is doing, a few times in a second."""
        now = time.perf_counter()
        turned = figures.sharp or not self._moving
        self._moving = not figures.sharp
        if not turned and now - self._figures_at < FIGURES_INTERVAL_S:
            return
        self._figures_at = now
        width, height = figures.size
        words = [
            "" if figures.sharp or figures.rate < 2 else f"{figures.rate} fps",
            f"{1000 * figures.seconds:.0f} ms",
            "" if figures.sharp else LIMITS[figures.limit],
            f"{width} × {height}",
            self._zoom_text(),
        ]
        self._sharp_count += int(figures.sharp)
        self.state.send(
            picture="sharp" if figures.sharp else "moving",
            sharp=self._sharp_count,
            figures=" · ".join(word for word in words if word),
            scale=self._scale(),
        )

    def show_browser_figures(self, milliseconds: float) -> None:
        """Let the page say that the browser's full picture is there, and what it took."""
        self._moving = False
        self._sharp_count += 1
        figures = f"{milliseconds:.0f} ms in the browser"
        self.state.send(picture="sharp", sharp=self._sharp_count, figures=figures)

    def describe(self) -> dict[str, Any]:
        """Return the camera."""
        return {"camera": self.viewport.camera.to_dict()}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Look from a saved camera."""
        if saved.get("camera"):
            self.context.take_camera(saved["camera"])
            self.stream.moved()

    def _zoom_text(self) -> str:
        zoom = self.viewport.zoom
        return f"zoom {zoom:.3g}" if zoom < 1000 else f"zoom {zoom:,.0f}"

    def _scale(self) -> dict[str, Any]:
        """Length of a scale bar: its text, and its share of the view's width in percent."""
        viewport = self.viewport
        camera = viewport.camera
        across = 2 * camera.height * viewport.aspect * len(viewport.panes)
        across /= map_scale(viewport.field, camera.focal_point)
        length = round_length(SCALE_BAR_WIDTH * across)
        return {
            "text": length_text(length, viewport.field.length_unit),
            "width": round(100 * length / across, 3) if across > 0 else 0,
        }


def _edges(sent: Any) -> Cover | None:
    """Return the edges of a panel that a page has sent; ``None`` where they are none."""
    if not isinstance(sent, list) or len(sent) != 4:
        return None
    left, top, right, bottom = (number(edge, 0, 1) for edge in sent)
    if left is None or top is None or right is None or bottom is None:
        return None
    return left, top, right, bottom
