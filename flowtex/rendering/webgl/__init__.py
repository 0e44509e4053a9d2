"""WebGL2: what the client in the browser is handed."""

from __future__ import annotations

from flowtex.rendering.webgl.client_data import ClientData, Colours, single, tile_parts
from flowtex.rendering.webgl.protocol import FORMAT
from flowtex.rendering.webgl.velocity import can_trace

__all__ = ["FORMAT", "ClientData", "Colours", "can_trace", "single", "tile_parts"]
