"""A page with the browser client on it, for tests: scenes in, pictures and errors out."""

from __future__ import annotations

import base64
import io
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from flowtex.host.view import TileSource, client_module
from flowtex.rendering.camera import Camera
from flowtex.rendering.webgl.client_data import ClientData
from flowtex.rendering.webgl.protocol import Parts, part_info, parts_file
from flowtex.textures.tiles.pyramid import TileKey

if TYPE_CHECKING:
    from playwright.sync_api import Page, Route

Pixels = NDArray[np.uint8]
TileMaker = Callable[[Any, Any], Parts]  #: Gives the parts of a tile, by its key and time steps.

HTML = """<!doctype html><meta charset="utf-8"><title>client</title>
<style>body { margin: 0 } .view { width: 300px; height: 200px }</style><body></body>"""

LOAD = """async (source) => {
  const url = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
  window.client = await import(url);
  window.viewers = [];
  window.events = [];
  window.bytes = (part) => Uint8Array.from(atob(part.data), (c) => c.charCodeAt(0));
  window.unpack = (parts) => Object.values(parts).map((part) => client.decoded(part, bytes(part)));
}"""

MOUNT = """([scenes, options, size]) => {
  const element = document.createElement("div");
  element.className = "view";
  if (size) element.style.cssText = `float: left; width: ${size[0]}px; height: ${size[1]}px`;
  document.body.append(element);
  const heard = {};
  for (const name of options.hear ?? []) heard[name] = (value) => events.push([name, value]);
  const load = async (key, steps) => {
    if (!key) {
      events.push(["load", ...steps]);
      return [];
    }
    const answer = await fetch(`http://tiles.test/${JSON.stringify([key, steps])}`);
    return client.partsOfFile(await answer.arrayBuffer());
  };
  const unpacked = [scenes].flat().map(({ header, parts }) => ({
    header, parts: unpack(parts), source: { load, hasSteps: Boolean(options.gives) },
  }));
  const viewer = client.mountPage(element, unpacked, { ...options, ...heard });
  viewers.push(viewer);
  return viewers.length - 1;
}"""

PIXELS = "(n) => viewers[n].canvas.toDataURL('image/png').split(',')[1]"


def state(camera: Camera) -> dict[str, Any]:
    """Return a camera as the client takes it."""
    return camera.to_dict()


def packed(scene: ClientData, header: Mapping[str, Any], steps: tuple[int, ...] = (0,)) -> Any:
    """Return header and parts as JSON."""
    arrays = dict(scene.surface())
    for step in sorted(set(steps)):
        arrays |= scene.step(step)
    parts = {
        # Without a digest views have nothing in common.
        name: {
            **part_info(name, array),
            "digest": "",
            "data": base64.b64encode(array.tobytes()).decode(),
        }
        for name, array in arrays.items()
    }
    return {"header": dict(header), "parts": parts}


def tile_maker(data: ClientData) -> TileMaker:
    """Return what makes the tiles of a surface when they are requested."""
    source = TileSource(data)
    return lambda key, steps: source.parts(TileKey(*key), steps)


@dataclass
class ClientPage:
    """A page that has loaded the client, with what it complained of and asked for."""

    page: Page
    errors: list[str] = field(default_factory=list)
    asked: list[str] = field(default_factory=list)
    tile: TileMaker = lambda key, steps: {}
    tiles: list[Any] = field(default_factory=list)

    def __post_init__(self) -> None:
        """Load the client."""
        self.page.on("console", lambda m: self._heard(m.text) if m.type == "error" else None)
        self.page.on("pageerror", lambda error: self._heard(str(error)))
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.route("http://tiles.test/*", self._send_tile)
        self.page.set_content(HTML)
        self.page.evaluate(LOAD, client_module())

    def _send_tile(self, route: Route) -> None:
        key, steps = json.loads(unquote(route.request.url.rsplit("/", 1)[1]))
        self.tiles.append(tuple(key))
        allowed = {"Access-Control-Allow-Origin": "*"}
        route.fulfill(body=parts_file(self.tile(key, steps)), headers=allowed)

    def _heard(self, text: str) -> None:
        self.errors.append(text)

    def mount(self, scene: Any, size: tuple[int, int] | None = None, **options: Any) -> int:
        """Show a scene, or several side by side; return the number of the first viewer."""
        return int(self.page.evaluate(MOUNT, [scene, options, size]))

    def sharp(self, viewer: int = 0) -> None:
        """Wait for the full picture."""
        self.page.wait_for_function(
            "(n) => viewers[n].sharp || viewers[n].root.dataset.failed", arg=viewer
        )
        failed = self.page.evaluate("(n) => viewers[n].root.dataset.failed", viewer)
        assert not failed, self.page.evaluate(
            "(n) => viewers[n].root.shadowRoot.querySelector('.note').textContent", viewer
        )

    def complete(self, viewer: int = 0) -> None:
        """Wait for all tiles that the view asks for, and the full picture."""
        self.page.wait_for_function(
            "(n) => viewers[n].sharp && !viewers[n].tiles.missing.length", arg=viewer
        )

    def picture(self, viewer: int = 0) -> Pixels:
        """Full picture of a viewer, (H, W, 3)."""
        self.sharp(viewer)
        return self.pixels(viewer)

    def pixels(self, viewer: int = 0) -> Pixels:
        """What a viewer shows now, (H, W, 3)."""
        data = base64.b64decode(self.page.evaluate(PIXELS, viewer))
        with Image.open(io.BytesIO(data)) as image:
            return np.asarray(image.convert("RGB"))

    def clear(self) -> None:
        """Dispose of all viewers."""
        self.page.evaluate(
            "() => { viewers.forEach((v) => v.dispose()); viewers.length = events.length = 0;"
            " document.body.replaceChildren(); }"
        )
