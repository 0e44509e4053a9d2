"""The application behind the page: a scene, its stream, and what the controls do."""

from __future__ import annotations

import asyncio
import itertools
import logging
import time
from pathlib import Path
from typing import Any

from trame.app import get_server

from flowtex.app.layout import build_page
from flowtex.app.scene import Scene
from flowtex.app.stream import Figures, FrameStream
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.settings import TABLE, SettingsError

__all__ = ["FlowApp"]

#: Pictures in a second while playing, at most.
RATE = 20.0
#: Seconds for one run through the times of a field: so many for each step, within limits.
STEP_SECONDS, SHORTEST, LONGEST = 0.25, 5.0, 30.0
#: Stops of the time slider between two steps of the field.
STOPS = 8
#: Seconds between two changes of the figures at the foot of the page.
FIGURES_EVERY = 0.5
#: A unit of time with more letters than this is left out beside the slider.
LONGEST_UNIT = 8
PLAIN_COLOUR = "none"

_count = itertools.count(1)
_log = logging.getLogger(__name__)


class FlowApp:
    """One flow on a page.

    Parameters
    ----------
    field
        The flow, or a mesh that makes one.
    server
        A trame server; one of its own by default.
    **options
        Arguments and settings of ``plotter.flowtex.add``, and ``zoom`` and ``focus`` as for
        :func:`flowtex.render`.

    Attributes
    ----------
    server
        The trame server.
    layout
        The page, as trame's layout.
    scene
        What is drawn.
    stream
        The pictures that go to the page.

    Raises
    ------
    FieldError, SettingsError
        When the mesh or a setting does not fit.
    """

    def __init__(self, field: FlowField | Any, *, server: Any = None, **options: Any) -> None:
        number = next(_count)
        self._prefix = f"flow{number}_"
        self.server = server or get_server(f"flowtex-{number}")
        self.server.client_type = "vue3"
        self.state = self.server.state
        self._tasks: list[asyncio.Task[None]] = []
        self._told = 0.0
        self._setup_scene(field, options)
        self._setup_state()
        self._build_ui()
        self._watch()

    def key(self, name: str) -> str:
        """Return the state's name of one of this application's own."""
        return f"{self._prefix}{name}"

    def get(self, name: str) -> Any:
        """Return a value of the state."""
        return self.state[self.key(name)]

    def set(self, **values: Any) -> None:
        """Change values of the state."""
        for name, value in values.items():
            self.state[self.key(name)] = value

    def _setup_scene(self, field: Any, options: dict[str, Any]) -> None:
        from flowtex.plotter import FIELD_ARGUMENTS, as_field

        self.field = as_field(field, **{k: options.pop(k, None) for k in FIELD_ARGUMENTS})
        self.scene = Scene(self.field, **options)
        self.stream = FrameStream(self.key("view"), self.scene, self._report)

    def _setup_state(self) -> None:
        settings = self.scene.handle.settings
        times = self.field.times
        first, last = float(times[0]), float(times[-1])
        self.state.trame__title = f"{self.field.name or 'flow'} - flowtex"
        self.state.trame__favicon = None
        self.set(
            theme="dark",
            panel=None,
            more=False,
            playing=False,
            picture="waiting",
            sharp=0,
            figures="",
            problem="",
            name=self.field.name.replace("_", " ") or "flow",
            about=_about(self.field),
            colour=self.scene.colour or PLAIN_COLOUR,
            colours=[*self.scene.colours, PLAIN_COLOUR],
            bar=self._bar(),
            first=first,
            last=last,
            tick=(last - first) / max((len(times) - 1) * STOPS, 1),
            time=self.scene.handle.time,
            moment=self._moment(),
            **{f"set_{name}": value for name, value in settings},
            set_noise_choices=self._noises(),
        )
        self.scene.set_background("dark")

    def _build_ui(self) -> None:
        self.server.enable_module(
            {
                "serve": {"__flowtex": str(Path(__file__).with_name("static"))},
                "styles": ["__flowtex/flowtex.css"],
            }
        )
        self.layout = build_page(
            self.server,
            self.key,
            self.stream.area_name,
            self.reset_camera,
            clock=not self.field.steady,
        )

    def _watch(self) -> None:
        change = self.state.change
        change(*(self.key(f"set_{name}") for name in TABLE))(self._on_settings)
        change(self.key("colour"))(self._on_colour)
        change(self.key("theme"))(self._on_theme)
        change(self.key("time"))(self._on_time)
        change(self.key("playing"))(self._on_playing)
        self.server.controller.on_server_ready.add(self._on_ready)

    def _noises(self) -> list[str]:
        """Kinds of noise to choose from; an image only where one was given."""
        there = self.scene.handle.view.image is not None
        return [kind for kind in TABLE["noise"].choices if there or kind != "image"]

    def reset_camera(self) -> None:
        """Show the whole surface again."""
        self.scene.home()
        self.stream.moved()

    def close(self) -> None:
        """End the tasks and free the graphics card."""
        for task in self._tasks:
            task.cancel()
        self._tasks.clear()
        self.scene.close()

    def _on_ready(self, **_: Any) -> None:
        self.server.controller.rc_area_register(self.stream)
        self._tasks += [
            asyncio.create_task(self.stream.run()),
            asyncio.create_task(self._play()),
        ]
        for task in self._tasks:
            task.add_done_callback(_tell_failure)

    def _on_settings(self, **_: Any) -> None:
        settings = self.scene.handle.settings
        for name, present in settings:
            wanted = self.get(f"set_{name}")
            if wanted == present:
                continue
            try:
                settings.update(**{name: wanted})
            except (SettingsError, FieldError) as error:
                self.set(problem=str(error), **{f"set_{name}": present})
                continue
            # A whole number comes back from the page as it was sent, not as the type it has here.
            self.set(**{f"set_{name}": getattr(settings, name)})
            self.stream.changed()

    def _on_colour(self, **_: Any) -> None:
        wanted = self.get("colour")
        name = "" if wanted == PLAIN_COLOUR else wanted
        if name == self.scene.colour:
            return
        self.scene.colour_by(name)
        self.set(bar=self._bar())
        self.stream.changed()

    def _on_theme(self, **_: Any) -> None:
        self.scene.set_background(self.get("theme"))
        self.stream.changed()

    def _on_time(self, **_: Any) -> None:
        first, last = float(self.field.times[0]), float(self.field.times[-1])
        wanted = min(max(float(self.get("time")), first), last)
        if wanted == self.scene.handle.time:
            return
        self.scene.set_time(wanted)
        self.set(moment=self._moment())
        self.stream.changed()

    def _on_playing(self, **_: Any) -> None:
        self.stream.playing = bool(self.get("playing"))
        if self.stream.playing and self.field.steady and self.get("set_motion") == "off":
            self.set(set_motion="speed")
        self.stream.moved()

    async def _play(self) -> None:
        """Let time go by while playing, no faster than pictures are drawn."""
        before = time.perf_counter()
        while True:
            now = time.perf_counter()
            passed, before = now - before, now
            if self.stream.playing and self.stream.watched():
                with self.state:
                    self._advance(min(passed, 0.5))
                await self.stream.next_picture()
            await asyncio.sleep(max(1 / RATE - (time.perf_counter() - now), 0.005))

    def _advance(self, seconds: float) -> None:
        """Go on by so many seconds of the person's own time."""
        if self.field.steady:
            self.scene.handle.clock += seconds
            self.stream.changed()
            return
        times = self.field.times
        first, span = float(times[0]), float(times[-1] - times[0])
        whole = min(max(STEP_SECONDS * (len(times) - 1), SHORTEST), LONGEST)
        # After the last time comes the first: a period goes round, anything else begins again.
        late = (self.scene.handle.time - first + span * seconds / whole) % span
        self.set(time=first + late)
        self._on_time()

    def _report(self, figures: Figures) -> None:
        """Tell the page how the stream is doing, a few times in a second."""
        now = time.perf_counter()
        turned = figures.sharp or self.get("picture") != "moving"
        if not turned and now - self._told < FIGURES_EVERY:
            return
        self._told = now
        width, height = figures.size
        milliseconds = f"{1000 * figures.seconds:.0f} ms"
        rate = "" if figures.sharp else f"{figures.rate} fps · "
        with self.state:
            self.set(
                picture="sharp" if figures.sharp else "moving",
                sharp=self.get("sharp") + int(figures.sharp),
                figures=f"{rate}{milliseconds} · {width} × {height} · {self._zoom()}",
            )

    def _zoom(self) -> str:
        zoom = self.scene.navigator.zoom
        return f"zoom {zoom:.3g}" if zoom < 1000 else f"zoom {zoom:,.0f}"

    def _moment(self) -> str:
        unit = self.field.time_unit
        shown = f" {unit}" if 0 < len(unit) <= LONGEST_UNIT else ""
        return f"t = {self.scene.handle.time:.2f}{shown}"

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


def _about(field: FlowField) -> str:
    """Say in a few words what a field is."""
    rows, columns = field.shape
    words = [f"{columns} × {rows} nodes"]
    words.append("steady" if field.steady else f"{len(field.times)} times")
    closed = [axis for axis, is_closed in zip("ji", field.periodic, strict=True) if is_closed]
    if closed:
        words.append(f"periodic along {' and '.join(sorted(closed))}")
    return " · ".join(words)


def _tell_failure(task: asyncio.Task[None]) -> None:
    """Let an error in a task of ours be seen: nobody waits for these tasks."""
    if not task.cancelled() and (error := task.exception()) is not None:
        _log.error("the page has stopped drawing", exc_info=error)
