"""WebGL2: what the client in the browser is handed, and the client itself (``client.js``)."""

from __future__ import annotations

from flowtex.renderers.webgl.assets import asset
from flowtex.renderers.webgl.header import Colours, camera_state
from flowtex.renderers.webgl.scene import FORMAT, Scene

__all__ = ["FORMAT", "Colours", "Scene", "asset", "camera_state"]
