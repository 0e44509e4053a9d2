"""Drawing in the browser instead of on the server, with the client of the notebook widget.

The page asks for two kinds of files: the surface of a scene, and the slices of one of its times.
Each is one binary file: the length of a header as four bytes, the header in JSON with the names,
types, shapes and digests of the arrays, and the arrays one after the other. What the page has
already it knows by the digest. Camera, time and settings travel as state, both ways.
"""

from __future__ import annotations

import asyncio
import json
import struct
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex._util.cache import digest
from flowtex._util.colours import colour_table, rgb
from flowtex.app.controllers.part import Part
from flowtex.app.server.routes import Content, Routes
from flowtex.app.server.untrusted import number
from flowtex.app.streaming.scene import BACKGROUNDS
from flowtex.rendering.webgl import Colours, asset
from flowtex.rendering.webgl import Scene as BrowserScene
from flowtex.scene import steps_of
from flowtex.settings import TABLE

__all__ = ["RENDERERS", "Browser", "packed"]

#: Where the picture is drawn.
RENDERERS = ("server", "browser")

Parts = Mapping[str, NDArray[Any]]


class Browser(Part):
    """The same view, drawn by the browser.

    Parameters
    ----------
    app
        The application.
    """

    def __init__(self, app: Any) -> None:
        super().__init__(app)
        self._scene: BrowserScene | None = None
        self._generation = 0
        self._routes = Routes.of(app.server)
        self._look: tuple[Any, ...] = ()
        self._camera: dict[str, Any] = {}
        self._client = self._routes.give(
            "client.js", lambda: (asset("client.js"), "text/javascript", None)
        )

    def values(self) -> dict[str, Any]:
        """Return what the page begins with."""
        return {
            "rendering": RENDERERS[0],
            "there": None,
            "there_settings": {},
            "there_camera": None,
            "there_time": 0.0,
        }

    def watch(self) -> None:
        """Listen to the page, and to what would have been drawn here."""
        self.state.on("rendering")(self.take_renderer)
        self.area.stream.elsewhere = self.follow

    @property
    def active(self) -> bool:
        """Whether the browser draws."""
        return self._scene is not None

    def take_renderer(self) -> None:
        """Draw where the page asks for it; the camera stays the same."""
        wanted = self.state.get("rendering")
        if wanted not in RENDERERS:
            self.state.set(rendering=RENDERERS[int(self.active)])
        elif wanted == "browser" and not self.active:
            # Its client draws one view.
            self.state.set(compare="nothing")
            self.app.look.take_comparison()
            self._begin()
        elif wanted == "server":
            self.leave()

    def leave(self) -> None:
        """Draw here again."""
        if self.active:
            self._end()
            self.state.set(rendering="server")

    def refresh(self) -> None:
        """Follow another flow that is shown."""
        if self.active and self._look != self._present_look():
            self._begin()

    def follow(self) -> None:
        """Tell the client what has changed on this side."""
        if not self.active:
            return
        if self._look != self._present_look():
            self._begin()
            return
        camera = self.scene.canvas.camera()
        if camera != self._camera:
            self._camera = camera
            self.state.set(there_camera=camera)
            self.app.moves.show_scale()
            self.app.reader.follow_camera()
        self.state.send(there_settings=dict(self.area.settings), there_time=self.scene.handle.time)

    def take_camera(self, camera: Any) -> None:
        """Follow the camera of the browser."""
        if not self.active or not self.app.moves.take_camera(camera):
            return  # not of our client's making
        self._camera = self.scene.canvas.camera()
        self.app.moves.show_scale()
        self.app.reader.follow_camera()

    def take_time(self, time: Any) -> None:
        """Follow the time of the browser while it plays."""
        times = self.scene.field.times
        told = number(time, float(times[0]), float(times[-1]))
        if self.active and told is not None:
            self.scene.set_time(told)
            self.app.clockwork.show_time()

    def take_sharp(self, milliseconds: Any) -> None:
        """Follow how long the browser's last full picture took."""
        told = number(milliseconds, 0, 1e6)
        if self.active and told is not None:
            self.app.moves.show_sharp(f"{told:.0f} ms in the browser")

    def _present_look(self) -> tuple[Any, ...]:
        """Return all that the client cannot follow by itself."""
        settings = self.area.settings
        made = [getattr(settings, row.name) for row in TABLE.values() if row.affects != "uniform"]
        baked = () if settings.noise == "procedural" else (settings.seed, settings.tiles)
        return (
            *made,
            *baked,
            self.scene.field,
            self.scene.colour,
            self.scene.cmap,
            self.scene.colour_range,
            self.app.look.theme,
            self.app.look.background,
        )

    def _begin(self) -> None:
        """Hand a scene over, in place of an earlier one."""
        self._withdraw()
        self._look = self._present_look()
        self._scene = scene = BrowserScene(self.scene.handle.scene.textures, self._colours())
        self._generation += 1
        self._camera = self.scene.canvas.camera()
        self.area.stream.paused = True
        header = scene.header(self.area.settings, camera=self._camera, time=self.scene.handle.time)
        surface = self._give("surface", lambda: packed(scene.surface()))
        steps = [
            self._give(f"step-{step}", lambda step=step: packed(scene.step(step)))
            for step in range(scene.steps)
        ]
        self.state.send(
            there={
                "client": self._client,
                "header": {**header, "generation": self._generation},
                "surface": surface,
                "steps": steps,
            },
            there_settings=dict(self.area.settings),
            there_camera=self._camera,
            there_time=self.scene.handle.time,
            picture="moving",
            figures="drawn by the browser",
        )

    def _end(self) -> None:
        self._withdraw()
        self._scene = None
        self.area.stream.paused = False
        self.state.set(there=None)
        self.area.stream.changed()

    def _give(self, name: str, make: Any) -> str:
        async def content() -> Content:
            # Packing takes a while, and the loop has other pages to serve.
            made = await asyncio.get_running_loop().run_in_executor(None, make)
            return made, "application/octet-stream", None

        return self._routes.give(f"{name}-{self._generation}", content)

    def _withdraw(self) -> None:
        if self._scene is not None:
            self._routes.withdraw(f"surface-{self._generation}")
            for step in range(self._scene.steps):
                self._routes.withdraw(f"step-{step}-{self._generation}")

    def _colours(self) -> Colours:
        scene, look = self.scene, self.app.look
        behind = BACKGROUNDS[look.theme] if look.background == "theme" else look.background
        low, high = scene.colour_range
        return Colours(
            name=scene.colour or None,
            values=steps_of(scene.field, scene.colour) if scene.colour else None,
            low=low,
            high=high,
            table=colour_table(scene.cmap),
            plain=rgb(scene.plain),
            background=rgb(behind),
            lighting=not scene.flat if scene.lighting is None else scene.lighting,
        )

    def close(self) -> None:
        """End what goes on."""
        self._withdraw()
        self._scene = None


def packed(parts: Parts) -> bytes:
    """Return arrays as one binary file; the module says how it is laid out."""
    arrays = {name: np.ascontiguousarray(array) for name, array in parts.items()}
    header = [
        {
            "name": name,
            "dtype": array.dtype.name,
            "shape": list(array.shape),
            "bytes": array.nbytes,
            "digest": digest(array).hex(),
        }
        for name, array in arrays.items()
    ]
    text = json.dumps(header).encode()
    return b"".join((struct.pack("<I", len(text)), text, *(a.tobytes() for a in arrays.values())))
