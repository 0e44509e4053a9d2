"""WebGL2: the data for the client in the browser."""

from __future__ import annotations

from flowtex.rendering.webgl.client_data import ClientData, Colours, single, tile_parts
from flowtex.rendering.webgl.protocol import FORMAT
from flowtex.rendering.webgl.velocity import Packing, can_trace, packing_of

__all__ = [
    "FORMAT",
    "ClientData",
    "Colours",
    "Packing",
    "can_trace",
    "packing_of",
    "single",
    "tile_parts",
]
