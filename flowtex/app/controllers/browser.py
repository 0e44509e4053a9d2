"""Drawing in the browser instead of on the server, with the client of the notebook widget.

The page asks for files of parts: of the whole surface, and of tiles, at some times;
:mod:`flowtex.web.source` says what is in them. Camera, time and settings travel as state, both
ways.
"""

from __future__ import annotations

import asyncio
import logging
from typing import Any

from flowtex._util.colours import rgb
from flowtex._util.progress import Stopped
from flowtex.app.controllers.context import Context, Controller
from flowtex.app.server.files import Content, Give
from flowtex.app.server.validation import number
from flowtex.camera import Camera
from flowtex.rendering.webgl import ClientData
from flowtex.rendering.webgl.protocol import parts_file
from flowtex.settings import TABLE
from flowtex.tiles import TileKey
from flowtex.web.assets import asset
from flowtex.web.source import TileSource
from flowtex.web.view import colours_of

_log = logging.getLogger(__name__)

#: Where the picture is drawn.
RENDERERS = ("server", "browser")
#: What a page calls the whole surface in place of a tile.
WHOLE = "whole"


class BrowserRendering(Controller):
    """The same view, drawn by the browser."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._source: TileSource | None = None
        self._told: set[TileKey | None] = set()
        #: Numbers of the scene, and of the files in which it is handed over.
        self._generation = self._published = 0
        self._routes = context.routes
        self._appearance: tuple[Any, ...] = ()
        self._camera: Camera | None = None
        self._client = self._routes.give(
            "client.js", lambda: (asset("client.js"), "text/javascript", None)
        )
        self.state.set(
            rendering=RENDERERS[0],
            client_source=None,
            client_settings={},
            client_camera=None,
            client_time=0.0,
        )
        self.state.on("rendering")(self.take_renderer)
        self.stream.frame_skipped.connect(self.follow)
        context.field_changed.connect(self.refresh)
        context.comparison_started.connect(self.leave)

    @property
    def active(self) -> bool:
        """Whether the browser draws."""
        return self._source is not None

    def take_renderer(self) -> None:
        """Draw where the page asks for it; the camera stays the same."""
        renderer = self.state.get("rendering")
        if renderer not in RENDERERS:
            self.state.set(rendering=RENDERERS[int(self.active)])
        elif renderer == "browser" and not self.active:
            self.context.client_started.emit()
            self._begin()
        elif renderer == "server":
            self.leave()

    def leave(self) -> None:
        """Draw here again."""
        if self.active:
            self._end()
            self.state.set(rendering="server")

    def refresh(self) -> None:
        """Follow another flow that is shown."""
        if self.active and self._appearance != self._present_appearance():
            self._begin()

    def follow(self) -> None:
        """Tell the client what has changed on this side."""
        if not self.active:
            return
        if self._appearance != self._present_appearance():
            self._begin()
            return
        camera = self.viewport.camera
        if camera != self._camera:
            self._camera = camera
            self.state.set(client_camera=camera.to_dict())
            self.context.camera_changed.emit()
        time = self.viewport.handle.time
        self.state.send(client_settings=dict(self.settings), client_time=time)

    def take_camera(self, camera: Any) -> None:
        """Follow the camera of the browser."""
        if not self.active or not self.context.take_camera(camera):
            return  # not of our client's making
        self._camera = self.viewport.camera
        self.context.camera_changed.emit()

    def take_time(self, time: Any) -> None:
        """Follow the time of the browser while it plays."""
        times = self.viewport.field.times
        checked = number(time, float(times[0]), float(times[-1]))
        if self.active and checked is not None:
            self.viewport.set_time(checked)
            self.context.time_changed.emit()

    def take_sharp(self, milliseconds: Any) -> None:
        """Follow how long the browser's last full picture took."""
        checked = number(milliseconds, 0, 1e6)
        if self.active and checked is not None:
            self.context.frame_drawn_in_browser.emit(checked)

    def _present_appearance(self) -> tuple[Any, ...]:
        """Return all that the client cannot follow by itself."""
        settings = self.settings
        built = [getattr(settings, row.name) for row in TABLE.values() if row.affects != "uniform"]
        baked = () if settings.noise == "procedural" else (settings.seed, settings.tiles)
        return (
            *built,
            *baked,
            self.viewport.field,
            self.area.scene.appearance,
            self.viewport.background,
        )

    def _begin(self) -> None:
        """Hand a scene over in place of an earlier one, or that one in other colours."""
        self._withdraw()
        self._appearance = self._present_appearance()
        source, scene = self._source, self._data()
        if source is not None and source.scene.textures is scene.textures:
            source.scene = source.scene.recoloured(scene.colours)
        else:
            self._generation += 1
            self._close_source()
            source = self._source = TileSource(scene)
        self._camera = self.viewport.camera
        self.stream.paused = True
        header = source.scene.header(
            self.settings, camera=self._camera.to_dict(), time=self.viewport.handle.time
        )
        self._published += 1
        parts = self._routes.give_each(
            f"parts-{self._published}", lambda name: self._parts(source, name)
        )
        self.state.send(
            client_source={
                "client": self._client,
                "header": {**header, "generation": self._generation},
                "parts": parts,
            },
            client_settings=dict(self.settings),
            client_camera=self._camera.to_dict(),
            client_time=self.viewport.handle.time,
            picture="moving",
            figures="drawn by the browser",
        )

    def _end(self) -> None:
        self._withdraw()
        self._close_source()
        self.stream.paused = False
        self.state.set(client_source=None)
        self.stream.changed()

    def _parts(self, source: TileSource, name: str) -> Give:
        """Return how the parts become a file of a tile, or of the whole, and of its time steps."""
        place, *numbers = name.split(".")
        steps = [int(number) for number in numbers]
        key = None
        if place != WHOLE:
            level, row, column = map(int, place.split(","))
            key = TileKey(level, row, column)
        if not all(0 <= step < source.scene.steps for step in steps):
            raise LookupError(name)

        async def content() -> Content:
            try:
                parts = await asyncio.wrap_future(source.ask(key, steps))
            except Stopped:  # of a scene that is not shown any more
                parts = {}
            except Exception as error:
                self._tell(key, error)
                raise FileNotFoundError(name) from error
            # Packing takes a while, and the loop has other pages to serve.
            body = await asyncio.get_running_loop().run_in_executor(None, parts_file, parts)
            return body, "application/octet-stream", None

        return content

    def _tell(self, key: TileKey | None, error: Exception) -> None:
        """Log, once each, what could not be made; coarser tiles are in the place of others."""
        if key not in self._told:
            self._told.add(key)
            what = "the surface" if key is None else f"tile {tuple(key)}"
            _log.warning("%s could not be made: %s", what, error)

    def _close_source(self) -> None:
        self._told.clear()
        if self._source is not None:
            self._source.close()
        self._source = None

    def _withdraw(self) -> None:
        self._routes.withdraw(f"parts-{self._published}")

    def _data(self) -> ClientData:
        scene = self.area.scene
        textures, background = scene.textures, rgb(self.viewport.background)
        colours = colours_of(scene, textures.geometry.field, background)
        return ClientData(textures, colours, pyramid=scene.pyramid, traces=True)

    def close(self) -> None:
        """End what goes on."""
        self._withdraw()
        self._close_source()
