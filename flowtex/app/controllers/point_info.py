"""Points of the surface: a tip under the pointer, and the path through a point that was clicked.

:class:`PointText` and :class:`PathCard` turn numbers into words and lists that can be sent as JSON;
:class:`PointInfo` shows them. A path is computed in a thread: with new textures it takes as long as
a renderer takes to load them. A new click cancels the one before.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.app.controllers.context import Context, Controller
from flowtex.app.server.page import start_task
from flowtex.app.server.validation import number
from flowtex.app.streaming.navigation import Place
from flowtex.app.streaming.stream import Figures
from flowtex.app.streaming.viewport import Viewport
from flowtex.earth import place_text
from flowtex.field import FlowField
from flowtex.plotting.handle import FlowHandle
from flowtex.probe import PointValues, Probe, locate, probe, values_at

Lines = list[tuple[str, str]]

#: Seconds between two tips.
HOVER_INTERVAL_S = 0.06
#: Digits of a position at zoom 1, and at most.
DIGITS, MOST_DIGITS = 4, 14
#: Decimals of longitude and latitude at zoom 1.
PLACE_DECIMALS = 2
#: How many times as long as the part with samples the path is that is shown.
PATH_LENGTH = 4.0
#: Samples on a side as which fewer count, so that there is something to see.
FEWEST_SAMPLES = 10
#: Units longer than this are left out.
UNIT_LENGTH = 12
#: How far from the middle of the view a line is drawn, in halves of the view.
LINE_REACH = 2.0
#: Distance from a curved surface, and from a flat one, that counts as on it, in cells.
CURVED_TOLERANCE, FLAT_TOLERANCE = 0.1, 1e-6


def number_text(x: float, digits: int = DIGITS) -> str:
    """Write a number in a few digits, as the browser's client writes it."""
    if not np.isfinite(x):
        return "–"
    x += 0.0  # zero has no sign
    if digits <= DIGITS + 1 and x != 0 and not 1e-3 <= abs(x) < 1e5:
        mantissa, exponent = f"{x:.2e}".split("e")
        return f"{mantissa}e{int(exponent)}"
    return np.format_float_positional(float(f"{x:.{digits}g}"), trim="-")


def suffix(unit: str) -> str:
    """Write a unit behind a number, where it is short enough."""
    return f" {unit}" if 0 < len(unit) <= UNIT_LENGTH else ""


def with_unit(x: float, unit: str) -> str:
    """Write a number with its unit."""
    return number_text(x) + suffix(unit)


class PointText:
    """What the page says about the point under the pointer of a viewport, in one of its panes."""

    def __init__(self, viewport: Viewport, pane: int = 0) -> None:
        self._viewport, self._pane = viewport, pane

    def __call__(self, x: float, y: float) -> Lines | None:
        """Return words and numbers for a place of the view; ``None`` beside the surface."""
        index = self.index(x, y)
        if index is None:
            return None
        point = values_at(self._field, index, self._handle.time)
        return self.lines(point)

    def lines(self, point: PointValues) -> Lines:
        """Return words and numbers of a point of the surface."""
        field, unit = self._field, point.speed_unit
        return [
            *self._place(point),
            (point.speed_label, with_unit(point.speed, unit)),
            *(
                (name, with_unit(value, field.unit_of(name)))
                for name, value in point.scalars.items()
            ),
        ]

    def _place(self, point: PointValues) -> Lines:
        """Return place and velocity, on the Earth where the field has a projection."""
        field, unit = self._field, point.speed_unit
        if point.lonlat is not None and np.isfinite(point.lonlat).all():
            decimals = max(self._digits - DIGITS, 0) + PLACE_DECIMALS
            return [
                ("place", place_text(*point.lonlat, decimals)),
                ("eastward", with_unit(point.eastward, unit)),
                ("northward", with_unit(point.northward, unit)),
            ]
        position = self._vector(point.position, field.surface.extent, self._digits)
        velocity = self._vector(point.velocity, 0.0, DIGITS, whole=field.leaves_surface)
        return [
            ("position", position + suffix(point.length_unit)),
            ("velocity", velocity + suffix(unit)),
        ]

    def index(self, x: float, y: float) -> tuple[float, float] | None:
        """Place on the surface (j, i) at a place of the view; ``None`` beside it."""
        point, field = self._viewport.surface_point(x, y, self._pane), self._field
        # A flat surface is met exactly: its border is where it is drawn.
        flat = self._handle.scene.whole.surface.frame is not None
        tolerance = FLAT_TOLERANCE if flat else CURVED_TOLERANCE
        return None if point is None else locate(field, point, tolerance=tolerance)

    @property
    def _handle(self) -> FlowHandle:
        return self._viewport.panes[self._pane].handle

    @property
    def _field(self) -> FlowField:
        return self._handle.field

    @property
    def _digits(self) -> int:
        zoom = max(self._viewport.zoom, 1.0)
        return int(min(np.ceil(DIGITS + np.log10(zoom)), MOST_DIGITS))

    def _vector(self, vector: Floats, size: float, digits: int, *, whole: bool = False) -> str:
        """Write a vector; what lies in a surface across z has no third component."""
        surface = self._field.surface
        across = surface.frame is not None and not np.abs(surface.frame[:, 2]).any()
        smallest = 1e-9 * max(float(np.abs(vector).max()), size)
        count = 2 if across and not whole else 3
        components = [0.0 if abs(v) < smallest else float(v) for v in vector[:count]]
        return f"({', '.join(number_text(v, digits) for v in components)})"


class PathCard:
    """A probe as the page shows it: a path over the picture, and a card beside it.

    ``about`` are the lines on the point itself, which come first; a flow without a sign is not
    ``directed``.
    """

    def __init__(self, probe: Probe, about: Lines | None = None, *, directed: bool = True) -> None:
        self.probe, self._about, self._directed = probe, about or [], directed

    def over(self, viewport: Viewport, shown: Sequence[int] | None = None) -> dict[str, Any]:
        """Return what lies over the picture as the camera now stands, in all panes or in some.

        ``path`` and ``sampled`` are stretches of places [x, y] of the whole path and of the part
        with samples, downstream where it is ``directed``; ``samples`` are dicts of ``x``, ``y``,
        ``weight`` and ``grey``; ``point`` is [x, y] or ``None``. Places go from -1 to 1, right
        and up.
        """
        probe = self.probe
        # Far beyond the samples the slices are too coarse to look at, and no picture needs them.
        reach = float(np.fmax(np.abs(probe.lags).max(), FEWEST_SAMPLES * abs(probe.step)))
        near = np.abs(probe.path_lags) <= PATH_LENGTH * reach
        camera, aspect = viewport.camera, viewport.aspect
        path, path_lags = camera.project(probe.path[near], aspect), probe.path_lags[near]
        inside = (path_lags <= probe.lags[0]) & (path_lags >= probe.lags[-1])
        places = camera.project(probe.points, aspect)
        lags = np.concatenate([path_lags[inside], probe.lags])
        _, order = np.unique(-lags, return_index=True)
        sampled = np.concatenate([path[inside], places])[order]
        point = camera.project(probe.field_values.position, aspect)
        return {
            "path": clip_line(path),
            "sampled": clip_line(sampled),
            "samples": [
                {"x": float(x), "y": float(y), "weight": bar["weight"], "grey": bar["grey"]}
                for (x, y), bar in zip(places, self.bars(), strict=True)
                if np.isfinite([x, y]).all() and max(abs(x), abs(y)) <= LINE_REACH
            ],
            "point": point.tolist() if np.isfinite(point).all() else None,
            "directed": self._directed,
            "panes": len(viewport.panes),
            "shown": list(range(len(viewport.panes)) if shown is None else shown),
            "aspect": aspect,
        }

    def bars(self) -> list[dict[str, Any]]:
        """Return the samples, from the farthest behind to the farthest ahead.

        ``weight`` is 1 for the greatest; ``grey`` is the noise that is met, as a colour
        ``#rrggbb``; ``slices`` are the two trace slices around the sample, and ``share`` is how
        far it is from the first to the second.
        """
        probe = self.probe
        heaviest = float(probe.weights.max())
        return [
            {
                "lag": float(lag),
                "weight": float(weight) / heaviest,
                "grey": colour,
                "slices": [int(m) for m in slices],
                "share": float(share),
            }
            for lag, weight, colour, slices, share in zip(
                probe.lags, probe.weights, self._colours(), probe.slices, probe.shares, strict=True
            )
        ]

    def _colours(self) -> list[str]:
        """Colours of the samples: greys, or those of a picture over white."""
        probe = self.probe
        rgb = np.repeat(probe.greys[:, None], 3, axis=1)
        if probe.noise.ndim == 2:
            rgb = probe.noise[:, :3] + 1.0 - probe.noise[:, 3:]
        whole = np.rint(255 * np.clip(rgb, 0, 1)).astype(int)
        return [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in whole.tolist()]

    def lines(self) -> Lines:
        """Return the card's lines, as words and numbers."""
        probe = self.probe
        length = probe.field_values.length_unit
        unit = length if probe.parameter == "arclength" else probe.field_values.time_unit
        pixels = f"{number_text(probe.grain / probe.pixel, 3)} pixels"
        lines = [
            *self._about,
            ("samples", self._samples()),
            ("level of detail", f"{probe.level:.2f}"),
            ("grain", f"{with_unit(probe.grain, length)}, {pixels}"),
            ("step", with_unit(probe.step, unit)),
            ("behind", with_unit(max(0.0, float(probe.lags[0])), unit)),
            ("ahead", with_unit(max(0.0, -float(probe.lags[-1])), unit)),
        ]
        if not isinstance(probe.value, float):
            return lines
        mean = float(probe.weights @ probe.noise)
        return [
            *lines,
            ("value", f"{mean:+.2f} × {probe.gain:.2f} = {probe.value:+.2f}"),
        ]

    def _samples(self) -> str:
        """How many samples there are, and why not as many as the setting says."""
        probe, count = self.probe, len(self.probe.lags)
        reasons = []
        if probe.asked > probe.setting + 1:
            reasons.append(f"{probe.setting} are set, in motion it takes twice as many")
        elif probe.asked > probe.setting:
            reasons.append(f"{probe.setting} are set, and the point itself is one more")
        if count < probe.asked:
            reasons.append("the path ends")
        number = f"{count} of {probe.asked}" if count < probe.asked else f"{count}"
        return f"{number}: {'; '.join(reasons)}" if reasons else number


def clip_line(places: Floats, reach: float = LINE_REACH) -> list[list[list[float]]]:
    """Cut a line in the view to what can be visible.

    Parameters
    ----------
    places
        Places in the view, (N, 2), NaN where there is none.
    reach
        How far from the middle a line is drawn, in halves of the view.
    """
    a, b = places[:-1], places[1:]
    defined = np.asarray(np.isfinite(a).all(axis=-1) & np.isfinite(b).all(axis=-1))
    a, b = np.where(defined[:, None], a, 2 * reach), np.where(defined[:, None], b, 2 * reach)
    step = b - a
    moving = np.abs(step) > 1e-300
    ends = np.stack([(side - a) / np.where(moving, step, 1.0) for side in (-reach, reach)])
    aside = np.where(np.abs(a) <= reach, -np.inf, np.inf)
    enter: Floats = np.max(np.where(moving, ends.min(axis=0), aside), axis=-1)
    leave: Floats = np.min(np.where(moving, ends.max(axis=0), np.inf), axis=-1)
    first: Floats = np.clip(enter, 0, 1)
    last: Floats = np.clip(leave, 0, 1)
    visible = defined & (enter <= 1) & (leave >= 0) & (first < last)
    result: list[list[list[float]]] = []
    for k in np.flatnonzero(visible).tolist():
        if not (result and first[k] == 0 and k > 0 and visible[k - 1] and last[k - 1] == 1):
            result.append([(a[k] + first[k] * step[k]).tolist()])
        result[-1].append((a[k] + last[k] * step[k]).tolist())
    return result


class PointInfo(Controller):
    """Shows the tip under the pointer, and the path through a point."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._pane = 0  # of the path
        self._at: tuple[float, float] | None = None
        self._card: PathCard | None = None
        self._hovered_at = 0.0
        self._timer: asyncio.TimerHandle | None = None
        self._requests = 0
        self._worker = ThreadPoolExecutor(1, thread_name_prefix="flowtex reading")
        self._task: asyncio.Task[None] | None = None
        self.state.set(tip=None, card=None, over=None)
        self.stream.pointer.hovered.connect(self.hover)
        self.stream.pointer.clicked.connect(self.click)
        context.frame_drawn.connect(self.follow)
        context.camera_changed.connect(self.follow_camera)
        context.field_changed.connect(self._reset)
        context.beside_changed.connect(lambda: self._reset() if self._pane else None)

    def _reset(self) -> None:
        self.leave()
        self.close_card()

    @property
    def busy(self) -> bool:
        """Whether a path is being read."""
        return self._task is not None and not self._task.done()

    def hover(self, place: Place | None) -> None:
        """Tell what is under the pointer, a few times in a second."""
        self._stop_timer()
        if place is None:
            self.leave()
            return
        wait = self._hovered_at + HOVER_INTERVAL_S - time.monotonic()
        if wait <= 0:
            self._show_tip(place)
        else:
            loop = asyncio.get_running_loop()
            self._timer = loop.call_later(wait, self._show_tip, place)

    def _stop_timer(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    @property
    def _pane_below(self) -> int:
        """Number of the pane under the pointer."""
        return min(self.stream.pointer.pane, len(self.viewport.panes) - 1)

    def _show_tip(self, place: Place) -> None:
        self._hovered_at = time.monotonic()
        lines = PointText(self.viewport, self._pane_below)(*place)
        x = (self._pane_below + (place[0] + 1) / 2) / len(self.viewport.panes)
        tip = {"lines": lines, "x": 100 * x, "y": 50 - 50 * place[1]}
        self.state.send(tip=tip if lines else None)

    def leave(self) -> None:
        """Tell nothing."""
        self._stop_timer()
        if self.state.get("tip") is not None:
            self.state.send(tip=None)

    def click(self, place: Place | None) -> None:
        """Show the path through what was clicked; beside the surface, none."""
        # Two panes of one flow show its path in both, as the first one draws it.
        self._pane = self._pane_below if self._differ else 0
        text = PointText(self.viewport, self._pane_below)
        self.show_path(None if place is None else text.index(*place))

    @property
    def _differ(self) -> bool:
        """Whether the panes show two flows."""
        return "field" in self.viewport.differences

    def take_place(self, place: Any) -> None:
        """Tell what is under the pointer of the browser's client, (x, y) from -1 to 1."""
        numbers = [number(v, -1, 1) for v in place] if _is_pair(place) else [None, None]
        x, y = numbers
        self.hover(None if x is None or y is None else (x, y))

    def take_point(self, point: Any) -> None:
        """Show the path through a point that the browser's client tells.

        It is told as (i, j), and on a surface of triangles as (x, y, z).
        """
        field = self.viewport.field
        if field.triangles is not None:
            place = [number(x) for x in point] if isinstance(point, list) else []
            known = [x for x in place if x is not None]
            if len(known) == len(place) == 3:
                self.show_path(locate(field, known, tolerance=np.inf))
        elif _is_pair(point):
            last_j, last_i = field.surface.last_index
            i, j = number(point[0], 0, last_i), number(point[1], 0, last_j)
            if i is not None and j is not None:
                self.show_path((j, i))

    def show_path(self, at: tuple[float, float] | None) -> None:
        """Show the path through a point (j, i) of the surface."""
        self._at = at
        self._requests += 1
        if at is None:
            self.close_card()
            return
        try:
            asyncio.get_running_loop()
        except RuntimeError:  # a script, which waits
            self._show(self._reader(at)())
            return
        if not self.busy:
            self._task = start_task(self._read(), "a path could not be read")

    async def _read(self) -> None:
        """Read the path through what was asked for last, until nothing else is asked for."""
        request, loop = -1, asyncio.get_running_loop()
        while self._at is not None and request != self._requests:
            request = self._requests
            path = await loop.run_in_executor(self._worker, self._reader(self._at))
            if request == self._requests:
                self._show(path)

    def _reader(self, at: tuple[float, float]) -> Callable[[], Probe | None]:
        """Return what reads the path through a point as things are now, if it is in view."""
        scene, clock = self.viewport.panes[self._pane].handle.scene.copy(), self.viewport.clock
        camera, size = self.viewport.camera, self.viewport.pane_size

        def read() -> Probe | None:
            try:
                return probe(scene, at, pixel=camera, size=size, clock=clock)
            except ValueError:
                return None

        return read

    def _show(self, path: Probe | None) -> None:
        if path is None:
            self.close_card()
            return
        about = PointText(self.viewport, self._pane).lines(path.field_values)
        field = self.viewport.panes[self._pane].handle.field
        self._card = PathCard(path, about, directed=not field.sign_free)
        lines = [list(line) for line in self._card.lines()]
        card = {"lines": lines, "bars": self._card.bars()}
        self.state.send(card=card, over=self._over(self._card))

    def _over(self, card: PathCard) -> dict[str, Any]:
        """Return the path over the picture, in the panes whose flow it is of."""
        return card.over(self.viewport, [self._pane] if self._differ else None)

    def close_card(self) -> None:
        """Show no path."""
        self._at = self._card = None
        self._requests += 1
        if self.state.get("card") is not None:
            self.state.send(card=None, over=None)

    def follow(self, figures: Figures) -> None:
        """Keep the path where it belongs as the camera moves, and its samples as they are drawn."""
        if self._card is None:
            return
        if figures.sharp:
            self.show_path(self._at)
        else:
            self.follow_camera()

    def follow_camera(self) -> None:
        """Keep the path where it belongs as the camera moves."""
        if self._card is not None:
            self.state.send(over=self._over(self._card))

    def close(self) -> None:
        """End what goes on."""
        self._at = self._card = None
        self._stop_timer()
        if self._task is not None:
            self._task.cancel()
        self._worker.shutdown(wait=False, cancel_futures=True)


def _is_pair(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and len(value) == 2
