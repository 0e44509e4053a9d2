"""WebGL2: what the client in the browser is handed, and the client itself (``client.js``)."""

from __future__ import annotations

from flowtex.rendering.webgl.assets import asset
from flowtex.rendering.webgl.header import Colours, camera_state
from flowtex.rendering.webgl.scene import FORMAT, Scene

__all__ = ["FORMAT", "Colours", "Scene", "asset", "camera_state"]
